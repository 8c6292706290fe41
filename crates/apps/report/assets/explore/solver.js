// What the page asks of the solver: the latest question alone, coarse while the hand moves and fine when it rests.

squama.solver = (() => {
  // A hand that has not moved for so long rests, ms.
  const REST = 160;
  // So long a question that nobody waits for any more may go on, ms: a new thread starts in less than a slow question takes.
  const GRACE = 60;
  let module, worker, listen, ready = false, asked = null, waiting = null, resting, giving = null, id = 0;

  const start = () => {
    worker?.terminate();
    [ready, asked, giving] = [false, null, null];
    const url = URL.createObjectURL(new Blob([squama.at("live-worker").textContent], { type: "text/javascript" }));
    worker = new Worker(url);
    URL.revokeObjectURL(url);
    worker.onmessage = ({ data }) => (data.ready ? begin() : take(data));
    worker.postMessage(module);
  };
  const begin = () => { ready = true; next(); };

  const take = (answer) => {
    clearTimeout(giving);
    giving = null;
    const question = asked;
    asked = null;
    if (answer.trapped) start();
    // What the hand has left behind is shown as long as it moves: it is the best there is.
    if (!waiting || !question?.fine) listen(answer, question);
    next();
  };

  const next = () => {
    if (!ready || asked || !waiting) return;
    [asked, waiting] = [waiting, null];
    worker.postMessage(asked.request);
  };

  const ask = (request, more = {}) => {
    id += 1;
    waiting = { request: { ...request, ...more, id }, fine: Boolean(more.fine || more.follow), at: performance.now() };
    if (asked?.fine) giving ??= setTimeout(start, GRACE);
    next();
  };

  return {
    begin: async (listener) => {
      listen = listener;
      // What stands on the page is drawn first, and answers to the hand meanwhile.
      await new Promise((drawn) => { requestAnimationFrame(() => setTimeout(drawn)); });
      try {
        module = await WebAssembly.compile(await squama.unpacked("live-module", "gzip").arrayBuffer());
        start();
      } catch (error) {
        listen({ error: `This browser cannot run the solver (${error.message}); use a current browser` });
      }
    },
    /** Solves for a request: at once without what takes long, and whole when the hand rests. */
    solve: (request) => {
      clearTimeout(resting);
      ask(request);
      resting = setTimeout(() => ask(request, { fine: true }), REST);
    },
    follow: (request, follow) => {
      clearTimeout(resting);
      ask(request, { follow });
    },
    idle: () => !asked && !waiting,
  };
})();

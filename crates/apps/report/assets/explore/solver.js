// Requests to the solver: only the latest one, fast during input and complete afterwards.

squama.solver = (() => {
  // Time without input before a complete answer is requested, ms.
  const REST = 160;
  // Grace time of an obsolete request, ms: restarting the thread is faster than a slow request.
  const GRACE = 60;
  // Time after which the page shows that it is solving, ms: layers may take seconds.
  const BUSY = 300;
  let module, worker, listen, ready = false, asked = null, waiting = null, resting, giving = null, busy, measuring = null, id = 0;

  const showBusy = (is) => squama.at("live").classList.toggle("busy", is);

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
    clearTimeout(busy);
    showBusy(false);
    giving = null;
    const question = asked;
    asked = null;
    if (answer.trapped) start();
    if (question?.resolve) {
      question.resolve(answer);
      return next();
    }
    // During input, outdated answers are shown too.
    if (!waiting || !question?.fine) listen(answer, question);
    next();
  };

  const next = () => {
    if (!ready || asked || !(waiting || measuring)) return;
    // Input comes before a search.
    if (waiting) [asked, waiting] = [waiting, null];
    else [asked, measuring] = [measuring, null];
    worker.postMessage(asked.request);
    // A complete answer after a fast one only adds details.
    if (!asked.request.fine) busy = setTimeout(showBusy, BUSY, true);
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
      // The page is drawn first, so that it responds meanwhile.
      await new Promise((drawn) => { requestAnimationFrame(() => setTimeout(drawn)); });
      try {
        module = await WebAssembly.compile(await squama.unpacked("live-module", "gzip").arrayBuffer());
        start();
      } catch (error) {
        listen({ error: `This browser cannot run the solver (${error.message}); use a current browser` });
      }
    },
    /** Solves a request: fast immediately, complete after a pause. */
    solve: (request) => {
      clearTimeout(resting);
      ask(request);
      resting = setTimeout(() => ask(request, { fine: true }), REST);
    },
    follow: (request, follow) => {
      clearTimeout(resting);
      ask(request, { follow });
    },
    /** Returns the measures of a design, for a search. */
    measure: (request) => new Promise((resolve) => {
      clearTimeout(resting);
      id += 1;
      measuring = { request: { ...request, bare: true, id }, resolve };
      next();
    }),
    idle: () => !asked && !waiting,
  };
})();

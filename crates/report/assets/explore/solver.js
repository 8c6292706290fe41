"use strict";
// What the page asks of the solver: the latest question alone, coarse while the hand moves and fine when it rests.

squama.solver = (() => {
  const FRAMES = 16;
  // A hand that has not moved for so long rests, ms.
  const REST = 140;
  let worker, ready = false, busy = false, waiting = null, timer, id = 0;
  let listen = () => {};

  const bytes = async () => {
    const packed = Uint8Array.from(atob(squama.at("module").textContent), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).arrayBuffer();
  };

  const begin = async () => {
    const script = new Blob([squama.at("worker").textContent], { type: "text/javascript" });
    worker = new Worker(URL.createObjectURL(script));
    [ready, busy] = [false, false];
    worker.onmessage = ({ data }) => {
      if (data.ready) { ready = true; next(); return; }
      busy = false;
      if (data.trapped) { worker.terminate(); begin(); }
      // An answer to a question that the hand has left behind is still the best that there is, if no later one waits.
      if (data.id === id || waiting === null || data.coarse) listen(data);
      next();
    };
    worker.postMessage({ module: await bytes() });
  };

  const next = () => {
    if (!ready || busy || waiting === null) return;
    busy = true;
    worker.postMessage(waiting);
    waiting = null;
  };

  const ask = (set, fine) => {
    id += 1;
    const measures = fine ? ["coverage", "puncture", "flexure", "sensitivity"] : ["coverage", "puncture", "flexure"];
    waiting = { id, definition: squama.data.definition, set, measures, frames: fine ? FRAMES : 1 };
    next();
  };

  return {
    begin: (listener) => { listen = listener; return begin(); },
    /** Solves for the settings `set`: at once without what takes long, and whole when the hand rests. */
    solve: (set) => {
      clearTimeout(timer);
      ask(set, false);
      timer = setTimeout(() => ask(set, true), REST);
    },
  };
})();

"use strict";
// Runs the solver in a worker thread, so that the page stays responsive. The worker handles one
// request at a time; requests and answers are JSON texts.
let solver;

const answer = (request) => {
  const text = new TextEncoder().encode(JSON.stringify(request));
  const room = solver.squama_room(text.length);
  new Uint8Array(solver.memory.buffer, room, text.length).set(text);
  const length = solver.squama_answer(text.length);
  // The memory may have grown, so the address of the answer is requested again.
  return JSON.parse(new TextDecoder().decode(new Uint8Array(solver.memory.buffer, solver.squama_room(0), length)));
};

self.onmessage = async ({ data }) => {
  if (data instanceof WebAssembly.Module) {
    solver = (await WebAssembly.instantiate(data, {})).exports;
    self.postMessage({ ready: true });
    return;
  }
  try {
    self.postMessage(answer(data));
  } catch (error) {
    // A module that has trapped cannot be used again, so the page starts another worker.
    self.postMessage({ id: data.id, error: `The solver stopped (${error.message}) and was started again`, trapped: true });
  }
};

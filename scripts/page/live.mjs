// Compares the module that pages carry with the native solver: node live.mjs ANSWERS, where ANSWERS is the example of the crate `live`.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";

const DESIGNS = 200;
/** The largest difference of two numbers, over the larger one or 1. */
const DIFFERENCE = 1e-9;

const packed = Buffer.from(readFileSync(new URL("../../crates/report/assets/explore/live.wasm.gz.base64", import.meta.url), "utf8"), "base64");
const solver = (await WebAssembly.instantiate(gunzipSync(packed), {})).instance.exports;
const answer = (request) => {
  const text = new TextEncoder().encode(request);
  const room = solver.squama_room(text.length);
  new Uint8Array(solver.memory.buffer, room, text.length).set(text);
  const length = solver.squama_answer(text.length);
  return new TextDecoder().decode(new Uint8Array(solver.memory.buffer, solver.squama_room(0), length));
};

// A sequence that fills the box of the paper, the same at every call.
const share = (k, base) => { let [result, part, rest] = [0, 1, k]; while (rest > 0) { part /= base; result += part * (rest % base); rest = Math.floor(rest / base); } return result; };
const requests = Array.from({ length: DESIGNS }, (_, k) => JSON.stringify({
  id: k, definition: "name = 'x'", measures: ["coverage", "puncture", "flexure"], frames: 2,
  set: [`designs.gap_over_t=${0.05 + 0.95 * share(k + 1, 2)}`, `designs.length_over_t=${0.1 + 0.9 * share(k + 1, 3)}`, `designs.slant_deg=${70 * share(k + 1, 5)}`],
}));

let largest = 0, numbers = 0;
const compare = (one, other, place) => {
  if (typeof one === "number" && typeof other === "number") {
    numbers += 1;
    largest = Math.max(largest, Math.abs(one - other) / Math.max(1, Math.abs(one), Math.abs(other)));
    return;
  }
  if (one === null || typeof one !== "object") {
    // Texts of numbers are those of the numbers beside them.
    if (!place.endsWith(".text")) assert.deepEqual(one, other, place);
    return;
  }
  assert.deepEqual(Object.keys(one), Object.keys(other), place);
  for (const key of Object.keys(one)) compare(one[key], other[key], `${place}.${key}`);
};

const native = spawnSync(process.argv[2], { input: requests.join("\n"), encoding: "utf8", maxBuffer: 1 << 30 });
assert.equal(native.status, 0, native.stderr);
const lines = native.stdout.trim().split("\n");
assert.equal(lines.length, DESIGNS);
for (const [k, request] of requests.entries()) {
  const [here, there] = [answer(request), lines[k]].map((text) => JSON.parse(text));
  assert.equal(here.error, undefined);
  compare(here, there, `design ${k}`);
}
assert.ok(numbers > 50 * DESIGNS, `${numbers} numbers`);
assert.ok(largest <= DIFFERENCE, `numbers differ by ${largest}`);
console.log(`${DESIGNS} designs, ${numbers} numbers: the module and the native solver differ by at most ${largest.toExponential(1)}`);

// Compares the WebAssembly module of the pages with the native solver.
//
//     node solver.mjs ANSWERS
//
// ANSWERS is the path of the compiled example `answers` of the crate `wasm`.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";

const DESIGNS = 200;
/** Largest accepted difference of two numbers, divided by the larger magnitude or 1. */
const DIFFERENCE = 1e-9;
/** Names of error estimates and numbers of steps. They depend on the compiler, so they are not compared. */
const NOT_COMPARED = /_error$|_iterations$|_points$/;

const packed = readFileSync(new URL("../../crates/apps/report/assets/explore/solver.wasm.gz", import.meta.url));
const solver = (await WebAssembly.instantiate(gunzipSync(packed), {})).instance.exports;
const answer = (request) => {
  const text = new TextEncoder().encode(request);
  const room = solver.squama_room(text.length);
  new Uint8Array(solver.memory.buffer, room, text.length).set(text);
  const length = solver.squama_answer(text.length);
  return new TextDecoder().decode(new Uint8Array(solver.memory.buffer, solver.squama_room(0), length));
};

/** Returns number `k` of the van der Corput sequence in `base`, which fills the interval from 0 to 1. */
const vanDerCorput = (k, base) => (k === 0 ? 0 : ((k % base) + vanDerCorput(Math.floor(k / base), base)) / base);
const definition = "name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\ndesigns.gap_over_t = 0.5\ndesigns.length_over_t = 0.5\ndesigns.slant_deg = 30";
// Every second design has a guided needle with friction.
const guided = (k) => (k % 2 ? { needle: "guided", needle_friction: 0.6 * vanDerCorput(k + 1, 7) } : {});
// Half of the designs have friction between scales, with needles of both kinds.
const withFriction = (k) => (k % 4 < 2 ? { friction: 0.4 * vanDerCorput(k + 1, 11) } : {});
// Every tenth design lies on a layer, which needs boundary elements.
const layered = (k) => (k % 10 === 9 ? { tissue_thickness_over_t: 0.5 + 5 * vanDerCorput(k + 1, 13) } : {});
const requests = Array.from({ length: DESIGNS }, (_, k) => JSON.stringify({
  id: k, definition, drawn: [1, 0.5],
  set: { gap_over_t: 0.05 + 0.95 * vanDerCorput(k + 1, 2), length_over_t: 0.1 + 0.9 * vanDerCorput(k + 1, 3), slant_deg: 70 * vanDerCorput(k + 1, 5), ...guided(k), ...withFriction(k), ...layered(k) },
}));

const { status, stdout, stderr } = spawnSync(process.argv[2], { input: requests.join("\n"), encoding: "utf8", maxBuffer: 1 << 30 });
assert.equal(status, 0, stderr);
const lines = stdout.trim().split("\n");
assert.equal(lines.length, DESIGNS);

let largest = 0, where = "", numbers = 0;
for (const [k, request] of requests.entries()) {
  const [here, there] = [answer(request), lines[k]].map((text) => JSON.parse(text));
  assert.equal(here.error, undefined);
  const values = (one) => one.values.filter(({ name }) => !NOT_COMPARED.test(name));
  assert.deepEqual(values(here).map(({ name }) => name), values(there).map(({ name }) => name), request);
  values(here).forEach(({ name, value, text }, place) => {
    const other = values(there)[place];
    if (value === null) return assert.equal(text, other.text, `${name} of ${request}`);
    numbers += 1;
    const difference = Math.abs(value - other.value) / Math.max(1, Math.abs(value), Math.abs(other.value));
    if (difference > largest) [largest, where] = [difference, `${name} of ${request}`];
  });
}
assert.ok(numbers > 20 * DESIGNS, `${numbers} numbers`);
assert.ok(largest <= DIFFERENCE, `numbers differ by ${largest}: ${where}; build the module again with scripts/wasm`);
console.log(`${DESIGNS} designs, ${numbers} numbers: the module and the native solver differ by at most ${largest.toExponential(1)}`);

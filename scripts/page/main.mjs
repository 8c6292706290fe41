// Runs all tests of the pages in a real browser. scripts/check-page writes the pages and starts
// this script. The environment variable ONLY selects the tests with this text in their names.
import assert from "node:assert/strict";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { start, table } from "./browser.mjs";
import charts from "./charts.mjs";
import choosing from "./choosing.mjs";
import designs from "./designs.mjs";
import explorer from "./explorer.mjs";
import fronts from "./fronts.mjs";
import randomTables from "./random-tables.mjs";
import sweeps from "./sweeps.mjs";
import window from "./window.mjs";

const [place, squama, chromium] = process.argv.slice(2);
const folder = (name) => join(place, name);
const folders = { someFailed: folder("some-failed"), allFailed: folder("all-failed"), axes: folder("axes"), front: folder("front"), folded: folder("folded"), large: folder("large") };
const results = folder("results");
const { open, openFile, run, stop, problems, requests } = await start({ place, squama, chromium });

const page = await open(results);
/** Returns the texts of elements, without the warning sign of folded designs. */
const texts = async (selector) => (await page.locator(selector).allTextContents()).map((own) => own.replace("⚠", ""));
const text = (selector) => page.locator(selector).textContent();
const detail = () => text("#detail-title");
const forget = () => page.evaluate(() => { document.getElementById("detail-title").textContent = ""; });
const column = async (name) => {
  const headers = (await texts("#table thead tr:first-child th")).map((header) => header.replace(/ [▲▼]$/, ""));
  assert.ok(headers.includes(name), name);
  return texts(`#table tbody tr[data-row] td:nth-child(${headers.indexOf(name) + 1})`);
};

/** Asserts that the detail of the selected design has parameters, values, drawing and command. */
const detailIsWhole = async () => {
  const design = (await detail()).replace("Design ", "");
  const { gap_over_t, length_over_t, slant_deg } = table(results, "designs.csv").find((row) => row.design === design);
  assert.deepEqual(await texts("#detail-parameters dd"), [gap_over_t, length_over_t, `${slant_deg}°`]);
  assert.ok(await page.locator("#detail-values dd").count() > 20);
  assert.ok(await page.locator("#drawing svg polygon").count() > 3);
  assert.match(await text("#detail-commands"), new RegExp(`squama design \\S+run\\.toml --design ${design}`));
};

const shared = { page, open, openFile, run, problems, place, squama, results, folders, text, texts, column, detail, forget, detailIsWhole };
const tests = {
  async "loads from a file without other requests"() {
    assert.match(await text("#title"), /54 designs/);
    assert.deepEqual(problems, []);
    assert.deepEqual(requests, [pathToFileURL(join(results, "report.html")).href]);
  },
  ...explorer(shared), ...charts(shared), ...designs(shared), ...choosing(shared), ...sweeps(shared), ...fronts(shared), ...window(shared), ...randomTables(shared),
  async "no errors and no requests except the pages"() {
    assert.deepEqual(problems, []);
    assert.ok(requests.every((url) => /^file:.*\/(report|explore|plain|pin|finger)\.html(#.*)?$/.test(url)), String(requests));
  },
};

let failed = 0;
const only = process.env.ONLY ?? "";
for (const [name, test] of Object.entries(tests).filter(([title]) => title.includes(only))) {
  try {
    await test();
    console.log(`ok      ${name}`);
  } catch (error) {
    failed++;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
await stop();
console.log(`page: ${failed} failed`);
process.exit(failed === 0 ? 0 : 1);

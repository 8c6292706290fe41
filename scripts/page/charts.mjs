// Tests of the charts and of the tetrahedron of weights.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { drawn, ready, shown, spots } from "./browser.mjs";

const CHARTS = ["critical-force", "stiffness", "penetration", "compliance", "coverage", "map", "pareto", "measure"];

export default ({ page, text, texts, detail, forget, detailIsWhole, run, place, results }) => ({
  async "every figure has a mark for every design"() {
    for (const id of CHARTS) {
      const marks = await spots(page, id);
      const rows = new Set(marks.map(({ row }) => row));
      assert.ok(rows.size >= (id === "pareto" ? 30 : 54), `${id}: ${rows.size}`);
    }
  },

  async "axes show symbols and units"() {
    const long = { "critical-force": [/aspect ratio L\/t, dimensionless/, /critical force Fc\*.*, dimensionless/], stiffness: [/largest stiffness Kmax\*/, /critical force Fc\*/], coverage: [/aspect ratio L\/t/, /gap d\/t/, /coverage λ/], pareto: [/coverage λ/, /resistance t\/umax/] };
    for (const [id, names] of Object.entries(long)) {
      const texts = await drawn(page, id);
      for (const name of names) assert.ok(texts.some((own) => name.test(own)), `${id}: ${name}`);
    }
  },

  async "the page shows the figures drawn by the program"() {
    // Page and command use the same renderer, so the marks of a figure have equal positions.
    run(`squama plot ${results}`, "--out", `${place}/figures`);
    for (const [id, file] of [["critical-force", "critical-force-by-gap-aspect-slant"], ["coverage", "coverage-maps-by-slant"], ["pareto", "pareto-fronts-pairwise"]]) {
      const svg = readFileSync(`${place}/figures/${file}.svg`, "utf8");
      const places = (text) => [...text.matchAll(/<(?:use|rect)[^>]*data-design="[^"]*"/g)].map(([tag]) => ["x", "y", "data-design"].map((name) => tag.match(new RegExp(` ${name}="([^"]*)"`))[1]).join()).sort();
      await shown(page, id);
      const own = await page.evaluate((kind) => squama.charts.find((chart) => chart.id === kind).svg.outerHTML, id);
      assert.ok(places(svg).length >= 30, file);
      assert.deepEqual(places(own), places(svg), id);
    }
  },

  async "a slant has one colour and one mark in every figure"() {
    const looks = new Map();
    for (const id of ["critical-force", "stiffness", "penetration", "compliance", "measure"]) {
      for (const { row, look } of await spots(page, id)) {
        const slant = await page.evaluate((own) => squama.cell(own, "slant_deg"), row);
        looks.set(slant, (looks.get(slant) ?? new Set()).add(look.replace(/-(open|folded)/, "")));
      }
    }
    assert.deepEqual([...looks.keys()].sort((a, b) => a - b), [0, 15, 30, 45, 60, 75]);
    for (const [slant, own] of looks) assert.equal(own.size, 1, `${slant}: ${[...own]}`);
  },

  async "no line of the compliance chart connects designs with and without contact"() {
    const lines = await drawn(page, "compliance", ".series path[fill=none]");
    assert.ok(lines.length > 10);
    // Contact reduces the compliance by decades. A panel of 190 px covers five decades, so a step of
    // 60 px would connect designs with and without contact.
    const heights = (line) => [...line.matchAll(/[ML]\S+ (\S+)/g)].map(([, y]) => Number(y));
    for (const line of lines) heights(line).slice(1).forEach((y, k) => assert.ok(y - heights(line)[k] < 60, line));
  },

  async "a click on a mark of any figure selects its design and draws a ring around the mark"() {
    for (const id of CHARTS) {
      const marks = (await spots(page, id)).filter(({ silent }) => !silent);
      const { x, y } = marks[7];
      await forget();
      await page.mouse.move(x, y);
      assert.ok(await page.locator("#tip").isVisible(), `${id}: no tip`);
      await page.mouse.click(x, y);
      const chosen = await page.evaluate(() => squama.state.design);
      assert.ok(marks.some((mark) => mark.row === chosen && Math.hypot(mark.x - x, mark.y - y) < 1.5), id);
      const rings = await page.locator(`#chart-${id} .ring`).evaluateAll((all) => all.map((one) => one.getBoundingClientRect()).map((box) => [box.x + box.width / 2, box.y + box.height / 2]));
      assert.ok(rings.some(([left, top]) => Math.hypot(left - x, top - y) < 2), `${id}: no ring around the mark`);
      await detailIsWhole();
    }
  },

  async "clicks on overlapping marks cycle through the designs"() {
    const marks = (await spots(page, "compliance")).filter(({ silent }) => !silent);
    const here = (one) => marks.filter(({ x, y }) => Math.hypot(x - one.x, y - one.y) < 1);
    const one = marks.find((mark) => here(mark).length > 2);
    const seen = new Set();
    for (let k = 0; k < here(one).length; k++) {
      await page.mouse.click(one.x, one.y);
      seen.add(await detail());
    }
    assert.equal(seen.size, here(one).length);
  },

  async "the arrow keys select the next or previous design in every figure"() {
    for (const id of CHARTS) {
      await page.locator(`#chart-${id}`).focus();
      await spots(page, id);
      const before = await detail();
      await page.keyboard.press("ArrowRight");
      const after = await detail();
      assert.notEqual(after, before, id);
      await page.keyboard.press("ArrowLeft");
      assert.equal(await detail(), before, id);
    }
  },

  async "maps have contours and show the selected column"() {
    for (const column of ["critical_force", "penetration", "compliance"]) {
      await page.locator("#map").selectOption(column);
      assert.ok((await spots(page, "map")).length >= 54, column);
      const [lines, values] = await Promise.all(["path", "text"].map((of) => page.locator(`#chart-map .contours ${of}`).count()));
      assert.ok(lines > 5 && values > 2, `${column}: ${lines} contours, ${values} values`);
    }
    assert.ok((await drawn(page, "map")).some((text) => /flexural compliance/.test(text)));
    await page.locator("#map").selectOption("critical_force");
  },

  async "a selected column is drawn"() {
    await page.locator("#measure").selectOption("max_moment");
    await shown(page, "measure");
    assert.ok((await drawn(page, "measure")).includes("max moment, dimensionless"));
  },

  async "a click on weights in the tetrahedron shows their best design, and the current weights are marked"() {
    await page.locator("#equal-weights").click();
    await page.waitForFunction(() => document.querySelector("#tetrahedron .now"));
    assert.equal(await page.locator("#tetrahedron .now").getAttribute("data-steps"), "4,5,5,6");
    await page.locator("#weight-m").fill("100");
    assert.equal(await page.locator("#tetrahedron .now").getAttribute("data-steps"), "20,0,0,0");
    const best = (await texts("#best tbody td:nth-child(2)"))[0];
    await forget();
    await page.locator("#tetrahedron .now").click();
    assert.equal(await detail(), `Design ${best}`);
    await detailIsWhole();
    await page.locator("#equal-weights").click();
    const colors = await page.locator("#tetrahedron [data-steps]").evaluateAll((all) => new Set(all.map((one) => getComputedStyle(one).fill)).size);
    assert.ok(colors >= await page.locator("#tetrahedron-legend button").count() - 1, `${colors}`);
  },

  async "the theme follows the button or the system, and printed pages are light"() {
    const colors = () => page.evaluate(() => {
      const style = getComputedStyle(document.body);
      const paper = document.querySelector("#tetrahedron svg > rect");
      return [style.backgroundColor, style.color, getComputedStyle(paper).fill];
    });
    const light = await colors();
    await page.locator("#theme").focus();
    await page.keyboard.press("Enter");
    const dark = await colors();
    dark.forEach((color, k) => assert.notEqual(color, light[k]));
    await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
    assert.deepEqual(await colors(), light);
    assert.ok(await page.evaluate(() => squama.charts.every(({ stale }) => !stale)), "a chart is missing on paper");
    await page.evaluate(() => dispatchEvent(new Event("afterprint")));
    assert.deepEqual(await colors(), dark);
    await page.keyboard.press("Enter");
    assert.deepEqual(await colors(), light);
    await page.emulateMedia({ colorScheme: "dark" });
    await page.reload();
    await ready(page);
    assert.deepEqual(await colors(), dark);
    await page.emulateMedia({ colorScheme: "light" });
    await page.locator("#theme").click();
    assert.match(await text("#theme"), /Dark/);
  },
});

// Charts and the tetrahedron.
import assert from "node:assert/strict";
import { ready, spots } from "./browser.mjs";

const CHARTS = ["critical-force", "stiffness", "penetration", "compliance", "coverage", "map", "pareto", "measure"];

export default ({ page, text, texts, detail, forget, detailIsWhole }) => ({
  async "every figure has a mark for every design"() {
    for (const id of CHARTS) {
      const marks = await spots(page, id);
      const rows = new Set(marks.map(({ row }) => row));
      assert.ok(rows.size >= (id === "pareto" ? 30 : 54), `${id}: ${rows.size}`);
    }
  },

  async "axes carry symbols and say that they are dimensionless"() {
    const named = await page.evaluate(() => squama.charts.map(({ id, make }) => {
      const { names = [], panels } = make(900);
      return [id, [...names.map(({ text: name }) => name), ...panels.flatMap(({ xName, yName }) => [xName, yName])].filter(Boolean)];
    }));
    for (const [id, names] of named) {
      assert.ok(names.length >= 2, id);
      for (const name of names) assert.match(name, id === "measure" ? /, dimensionless$/ : /\$.+\$.*, (dimensionless|degrees)$/, `${id}: ${name}`);
    }
  },

  async "a slant has one colour and one mark in every figure"() {
    const looks = await page.evaluate(() => squama.charts.filter(({ id }) => !["coverage", "map", "pareto"].includes(id)).flatMap(({ make }) =>
      make(900).panels.flatMap(({ marks }) => marks.map(({ row, color, path }) => `${squama.cell(row, "slant_deg")} ${color} ${path}`))));
    assert.deepEqual([...new Set(looks)].map((look) => look.split(" ")[0]).sort(), ["0", "15", "30", "45", "60", "75"]);
  },

  async "no line of compliance crosses the place where contact begins"() {
    const lines = await page.evaluate(() => squama.charts.find(({ id }) => id === "compliance").make(900).panels.flatMap(({ lines: own }) => own.map(({ points }) => points)));
    assert.ok(lines.length > 10);
    // A contact costs compliance decades.
    for (const points of lines) for (let k = 1; k < points.length; k++) assert.ok(points[k - 1][1] / points[k][1] < 30, JSON.stringify(points));
  },

  async "a click on a mark of any figure shows its design, and a ring stands around it"() {
    for (const id of CHARTS) {
      const marks = (await spots(page, id)).filter(({ silent }) => !silent);
      const { x, y } = marks[7];
      await forget();
      await page.mouse.move(x, y);
      assert.ok(await page.locator("#tip").isVisible(), `${id}: no tip`);
      await page.mouse.click(x, y);
      const chosen = await page.evaluate(() => squama.state.design);
      assert.ok(marks.some((mark) => mark.row === chosen && Math.hypot(mark.x - x, mark.y - y) < 1.5), id);
      const ring = await page.evaluate(([own, left, top]) => {
        const { over } = squama.charts.find((chart) => chart.id === own), box = over.getBoundingClientRect(), ratio = over.width / box.width;
        return over.getContext("2d").getImageData((left - box.x + 8.5) * ratio, (top - box.y) * ratio, 1, 1).data[3];
      }, [id, x, y]);
      assert.ok(ring > 0, `${id}: no ring around the mark`);
      await detailIsWhole();
    }
  },

  async "clicks on marks in one place go from design to design"() {
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

  async "the arrow keys go from design to design in every figure"() {
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

  async "a map has contours where its column has the values of its ticks"() {
    const { pieces, ticks } = await page.evaluate(() => {
      const { panels } = squama.charts.find(({ id }) => id === "map").make(900);
      const scale = squama.axesOf.critical_force, along = squama.panel.along;
      const at = ({ marks }, i, j) => along(scale, squama.cell(marks.find((mark) => mark.x === i && mark.y === j).row, "critical_force"));
      // At each end, a contour lies on an edge between two nodes; the value there comes from both.
      const valueAt = (panel, [x, y]) => {
        const [i, j] = [Math.floor(x), Math.floor(y)], [p, q] = [x - i, y - j];
        return p > 0 ? (1 - p) * at(panel, i, j) + p * at(panel, i + 1, j) : q > 0 ? (1 - q) * at(panel, i, j) + q * at(panel, i, j + 1) : at(panel, i, j);
      };
      return { pieces: panels.flatMap((panel) => panel.lines.flatMap(({ points }) => points.map((point) => valueAt(panel, point)))), ticks: scale.ticks.filter(({ label }) => label !== null).map(({ value }) => along(scale, value)) };
    });
    assert.ok(pieces.length > 20, `${pieces.length}`);
    for (const value of pieces) assert.ok(ticks.some((tick) => Math.abs(tick - value) < 1e-9), `${value}`);
    await page.locator("#mapX").selectOption("length_over_t");
    assert.match(await page.evaluate(() => squama.charts.find(({ id }) => id === "map").make(900).names[0].text), /aspect ratio/);
    await page.locator("#mapX").selectOption("gap_over_t");
  },

  async "a column of one's choice is drawn"() {
    await page.locator("#measure").selectOption("max_moment");
    const names = await page.evaluate(() => squama.charts.find(({ id }) => id === "measure").make(900).names.map(({ text: name }) => name));
    assert.equal(names[1], "max moment, dimensionless");
  },

  async "the tetrahedron turns under the mouse and by keys, and a click chooses"() {
    const area = page.locator("#tetrahedron canvas");
    await area.scrollIntoViewIfNeeded();
    const camera = () => page.evaluate(() => ({ ...squama.tetrahedron.camera }));
    const box = await area.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const before = await camera();
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 120, y + 30, { steps: 8 });
    await page.mouse.up();
    const turned = await camera();
    assert.notDeepEqual(turned, before);
    await page.locator("#tetrahedron").focus();
    await page.keyboard.press("ArrowLeft");
    assert.notDeepEqual(await camera(), turned);
    const dot = await page.evaluate(() => squama.tetrahedron.spots.at(-1));
    await forget();
    await page.mouse.click(box.x + dot.x, box.y + dot.y);
    assert.equal(await page.evaluate(() => squama.state.design), dot.row);
    await detailIsWhole();
  },

  async "the ring of the tetrahedron and the names of its corners are seen"() {
    const ring = () => page.evaluate(() => squama.tetrahedron.place(squama.weights()));
    const before = await ring();
    await page.locator("#weight-m").fill("100");
    const after = await ring();
    assert.ok(after.y < before.y - 50, `${before.y} ${after.y}`);
    await page.locator("#equal-weights").click();
    const size = await page.locator("#tetrahedron canvas").boundingBox();
    const corners = await page.evaluate(() => [0, 1, 2, 3].map((k) => squama.tetrahedron.place([0, 0, 0, 0].map((_, c) => (c === k ? 1.1 : 0)))));
    for (const { x, y } of corners) assert.ok(x > 0 && x < size.width && y > 0 && y < size.height, `${x} ${y}`);
  },

  async "light and dark, by the button and by what the system prefers; paper is light"() {
    const colors = () => page.evaluate(() => {
      const style = getComputedStyle(document.body);
      return [style.backgroundColor, style.color, squama.themeNow.paper];
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
    assert.ok((await texts("#slant-legend span")).length >= 6);
  },
});

// Tests of the section that compares the front of a search with the designs of a grid.
import assert from "node:assert/strict";
import { spots, table } from "./browser.mjs";

export default ({ open, page, place, folders }) => ({
  async "a front is drawn over the grid, joined by a line, with the active constraints of each design"() {
    assert.ok(!await page.locator("#front").isVisible() && !await page.locator("#front-link").isVisible(), "the report of a sweep without a search shows a front");
    const own = await open(folders.front), front = table(`${place}/found`, "front.csv"), grid = table(folders.front, "designs.csv");
    const marks = await spots(own, "front");
    assert.equal(marks.filter(({ row }) => row === null).length, front.length);
    assert.equal(new Set(marks.filter(({ row }) => row !== null).map(({ row }) => row)).size, grid.length);
    const line = (await own.locator("#chart-front .found .line").getAttribute("d")).split(/[ML] ?/).filter(Boolean).map((part) => part.trim().split(" ").map(Number));
    const diamonds = await own.locator("#chart-front [data-front]").evaluateAll((all) => all.map((one) => [Number(one.dataset.front), Number(one.getAttribute("x")), Number(one.getAttribute("y"))]));
    assert.deepEqual(line, diamonds.map(([, x, y]) => [x, y]));
    // The line runs from the smallest to the largest coverage, and diamonds have the right positions.
    assert.deepEqual(diamonds.map(([k]) => k), front.map((one, k) => [k, Number(one.coverage)]).sort((a, b) => a[1] - b[1]).map(([k]) => k));
    const slope = (name, at) => { const [a, b] = [diamonds[0], diamonds.at(-1)]; return (b[at] - a[at]) / (Number(front[b[0]][name]) - Number(front[a[0]][name])); };
    for (const [k, x, y] of diamonds) {
      assert.ok(Math.abs(x - diamonds[0][1] - slope("coverage", 1) * (front[k].coverage - front[diamonds[0][0]].coverage)) < 0.1);
      assert.ok(Math.abs(y - diamonds[0][2] - slope("gap_over_t", 2) * (front[k].gap_over_t - front[diamonds[0][0]].gap_over_t)) < 0.1);
    }
    // Designs that violate the requirement of the search, and folded designs, are pale and not compared.
    const allowed = grid.filter((one) => Number(one.slant_deg) <= 60 && !one.fold_force);
    const beaten = allowed.filter((one) => front.some((other) => {
      const better = ["coverage", "gap_over_t"].map((name) => Number(other[name]) - Number(one[name]));
      return better.every((more) => more > -1e-9) && better.some((more) => more > 1e-9);
    }));
    assert.ok(beaten.length > 4 && allowed.length < grid.length);
    const said = beaten.length === allowed.length ? "all" : beaten.length;
    assert.match(await own.locator("#front-words").textContent(), new RegExp(`largest coverage and largest gap d/t; slant_deg <= 60; .*Of the ${allowed.length} designs of the grid that meet them, ${said} are dominated`));
    const rows = await own.locator("#front-table tbody tr").allTextContents();
    assert.equal(rows.length, front.length);
    assert.ok(rows.some((row) => /slant_deg <= 60|upper end/.test(row)), rows.join());
    // A diamond shows its active constraints. A click on a diamond or on its table row opens the design
    // in the explorer; a click on a mark of the grid selects the design of the grid.
    const chosen = await own.locator("#detail-title").textContent();
    const diamond = marks.find(({ row }) => row === null);
    await own.mouse.move(diamond.x, diamond.y);
    assert.match(await own.locator("#tip").textContent(), /^Front \d+: .*Active constraints: /);
    const isInExplorer = async (k) => {
      const values = await own.evaluate(() => Object.fromEntries(squama.live.controls().map(({ key, value }) => [key, value])));
      for (const name of ["gap_over_t", "length_over_t", "slant_deg"]) assert.ok(Math.abs(values[name] - Number(front[k][name])) <= 1e-5 * values[name], `${name} of front ${k + 1}`);
    };
    await own.mouse.click(diamond.x, diamond.y);
    assert.equal(await own.locator("#detail-title").textContent(), chosen);
    await isInExplorer(Number(await own.evaluate(() => squama.charts.find(({ id }) => id === "front").marks.find(({ row }) => row === null).front)));
    await own.evaluate(() => squama.live.set({ critical_tilt_deg: 5 }));
    await own.locator('#front-table [data-found="1"]').click();
    await isInExplorer(1);
    assert.equal(await own.evaluate(() => squama.live.value("critical_tilt_deg")), 10, "parameters that the search did not vary keep the values of the definition");
    const far = marks.find(({ row, x, y }) => row !== null && marks.every((other) => other.row !== null || Math.hypot(other.x - x, other.y - y) > 20));
    await own.mouse.click(far.x, far.y);
    const now = await own.evaluate(() => squama.state.design);
    assert.ok(marks.some(({ row, x, y }) => row === now && Math.hypot(x - far.x, y - far.y) < 2));
    await own.close();
  },
});

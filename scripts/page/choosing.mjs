// Tests of requirements, criteria, weights, the ranking, and the state in the address.
import assert from "node:assert/strict";
import { shown, spots, table } from "./browser.mjs";

export default ({ page, text, texts, run, results, open }) => {
  const slide = (key, value) => page.locator(`#weight-${key}`).fill(String(value));
  const command = () => text("#rank-command code");
  const designs = () => texts("#best tbody td:nth-child(2)");
  const expected = () => table(results, "ranking.csv").slice(0, 15);

  return {
    async "the page and the command rank equally for any weights"() {
      for (const moves of [[], [["m", 60]], [["l", 10], ["n", 35]], [["n", 1]], [["k", 100]], [["m", 0]], [["l", 47]]]) {
        for (const [key, value] of moves) await slide(key, value);
        const weights = (await texts("#weights output")).map(Number);
        assert.equal(Math.round(weights.reduce((a, b) => a + b, 0) * 100), 100);
        assert.ok((await command()).endsWith(`--weights ${weights.join(",")}`), await command());
        run(await command());
        assert.deepEqual(await designs(), expected().map((row) => row.design), await command());
        assert.deepEqual(await texts("#best tbody td:nth-child(3)"), expected().map((row) => Number(row.fitness).toFixed(4)), await command());
      }
      await page.locator("#equal-weights").click();
    },

    async "the page and the command have the same winners and Pareto front"() {
      run(`squama rank ${results}`);
      await page.waitForFunction(() => document.querySelectorAll("#tetrahedron-legend button").length > 0);
      const winners = table(results, "winners.csv").slice(0, 10).map((row) => row.design);
      assert.deepEqual((await texts("#tetrahedron-legend button")).map((label) => label.slice(0, 4)), winners);
      const front = await page.evaluate(() => [...squama.ranking.front(squama.contest)].map(squama.number).sort());
      assert.deepEqual(front, table(results, "pareto.csv").map((row) => row.design).sort());
    },

    async "keys move the sliders and update the ranking"() {
      await page.locator("#weight-n").focus();
      for (let k = 0; k < 3; k++) await page.keyboard.press("ArrowRight");
      assert.equal((await texts("#weights output"))[1], "0.28");
      assert.match(await command(), /--weights 0\.24,0\.28,0\.24,0\.24/);
      await page.locator("#equal-weights").focus();
      await page.keyboard.press("Enter");
      assert.deepEqual(await texts("#weights output"), ["0.25", "0.25", "0.25", "0.25"]);
    },

    async "a requirement applies to ranking, tetrahedron, figures and table"() {
      await page.locator("#add-requirement").click();
      assert.equal(await page.locator("#requirement-list select").first().inputValue(), "coverage");
      await page.locator("#requirement-list input").fill("0.6");
      const rows = table(results, "designs.csv").filter((row) => Number(row.coverage) >= 0.6 - 1e-9);
      assert.ok(rows.length > 3 && rows.length < 50);
      assert.match(await text("#requirement-count"), new RegExp(`^${rows.length} of 54`));
      assert.match(await text("#table-count"), new RegExp(`^${rows.length} of 54`));
      const own = new Set(rows.map((row) => row.design));
      assert.ok((await designs()).every((design) => own.has(design)));
      assert.match(await command(), /--require 'coverage >= 0\.6'/);
      await page.waitForTimeout(300);
      assert.ok((await texts("#tetrahedron-legend button")).every((label) => own.has(label.slice(0, 4))));
      const marks = (await spots(page, "critical-force")).filter(({ silent }) => !silent);
      const colored = await page.evaluate((rows) => rows.map(squama.number), marks.map(({ row }) => row));
      assert.deepEqual(new Set(colored), own);
      // The fronts contain the remaining designs.
      await shown(page, "pareto");
      const front = await page.locator('#chart-pareto [data-criteria="coverage critical_force"] use:not([href="#dot"])').evaluateAll((all) => all.map((one) => one.dataset.design));
      const beaten = (one) => rows.some((other) => ["coverage", "critical_force"].every((name) => Number(other[name]) >= Number(one[name])) && ["coverage", "critical_force"].some((name) => Number(other[name]) > Number(one[name])));
      assert.deepEqual(front.sort(), rows.filter((row) => row.compliance !== "" && row.penetration !== "" && !beaten(row)).map((row) => row.design).sort());
    },

    async "limits accept a decimal point or comma; invalid limits are marked and ignored"() {
      const input = page.locator("#requirement-list input"), rows = table(results, "designs.csv");
      const meeting = (limit) => rows.filter((row) => Number(row.coverage) >= limit - 1e-9).length;
      const count = async () => Number((await text("#table-count")).match(/^\d+/)[0]);
      assert.ok(new Set([0.3, 0.7].map(meeting)).size === 2 && meeting(0.7) > 0 && meeting(0.7) < 54);
      for (const [typed, limit] of [["0,7", 0.7], ["0.7", 0.7], [" ,3", 0.3], ["7e-1", 0.7]]) {
        await input.fill(typed);
        assert.equal(await count(), meeting(limit), typed);
        assert.equal(await input.getAttribute("aria-invalid"), "false", typed);
      }
      for (const typed of ["abc", "2,5 N", "0.6..0.8", "", "0,7,1", "1e"]) {
        await input.fill("0.7");
        await input.fill(typed);
        assert.equal(await input.getAttribute("aria-invalid"), "true", typed);
        assert.equal(await count(), 54, `${typed}: a hidden limit is active`);
        assert.match(await text("#requirement-count"), /A limit that is not a number is ignored/);
        assert.ok(!(await command()).includes("--require"), typed);
      }
      const filter = page.locator('#table input[data-column="coverage"]');
      await page.locator("#clear-requirements").click();
      for (const [typed, limits] of [[">=0,7", [0.7, 2]], ["0,3..0,7", [0.3, 0.7]]]) {
        await filter.fill(typed);
        assert.equal(await count(), rows.filter((row) => row.coverage >= limits[0] && row.coverage <= limits[1]).length, typed);
      }
      await filter.fill(">=0,7x");
      assert.equal(await filter.getAttribute("aria-invalid"), "true");
      assert.equal(await count(), 54, "an invalid filter keeps the previous one active");
      await filter.fill("");
    },

    async "if no design meets the requirements, the nearest design and the obstacle are shown"() {
      await page.evaluate(() => squama.require([{ column: "coverage", sign: ">=", limit: 0.6 }, { column: "compliance", sign: ">=", limit: 7 }]));
      assert.match(await text("#requirement-count"), /No design meets all of them\. The nearest is \d{4}: .*The obstacle is compliance >= 7: some designs meet all other requirements/);
      assert.equal(await page.locator("#best tbody tr").count(), 0);
      await page.locator("#clear-requirements").click();
      assert.match(await text("#requirement-count"), /all 54 designs/);
    },

    async "criteria are added, reversed, removed and reset to the criteria of the paper"() {
      await page.locator("#add-criterion").selectOption("sink");
      assert.deepEqual((await texts("#weights output")).map(Number).reduce((a, b) => a + b, 0).toFixed(9), "1.000000000");
      assert.match(await command(), /--criteria max:coverage,max:critical_force,min:penetration,max:compliance,min:sink --weights/);
      assert.match(await text("#tetrahedron p"), /shows four criteria/);
      for (const name of ["small penetration of the bases", "large compliance", "large coverage"]) await page.locator(`button[aria-label="Leave out ${name}"]`).click();
      await page.locator("#scale").selectOption("linear");
      const rows = table(results, "designs.csv").filter((row) => row.sink !== "" && row.critical_force !== "");
      const scaled = (column, sign) => {
        const values = rows.map((row) => sign * Number(row[column])), low = Math.min(...values), high = Math.max(...values);
        return values.map((value) => (value - low) / (high - low));
      };
      const [force, sink] = [scaled("critical_force", 1), scaled("sink", -1)];
      const best = rows.map((row, k) => [row.design, 0.5 * force[k] + 0.5 * sink[k]]).sort((a, b) => b[1] - a[1]);
      assert.deepEqual(await designs(), best.slice(0, 15).map(([design]) => design));
      await page.locator('button[aria-label^="small sink: reverse"]').click();
      assert.match(await command(), /max:sink/);
      await page.locator("#usual-criteria").click();
      assert.match(await command(), /results --weights 0\.25,0\.25,0\.25,0\.25$/);
    },

    async "a link restores the state from the address"() {
      await page.evaluate(() => {
        squama.require([{ column: "coverage", sign: ">=", limit: 0.3 }, { column: "puncture_status", sign: "~", limit: "complete" }]);
        squama.setWeight(0, 40);
        squama.choose(squama.rowOf("0030"));
        squama.pin(squama.rowOf("0036"));
      });
      await page.locator("#table thead button").nth(4).click();
      await page.waitForTimeout(500);
      const address = new URL(page.url()).hash;
      const sent = await open(results, address);
      const state = (of) => of.evaluate(() => JSON.stringify(squama.state));
      assert.equal(await state(sent), await state(page));
      assert.equal(await sent.locator("#detail-title").textContent(), "Design 0030");
      assert.ok(await sent.locator("#compare").isVisible());
      // A new address takes effect immediately and cancels a pending update. Leading zeros of the design
      // number may be omitted.
      await sent.evaluate(() => { squama.setWeight(0, 70); location.hash = "design=33"; });
      // Wait until the page has written the address with the design number of the table.
      await sent.waitForFunction(() => location.hash === "#design=0033");
      assert.equal(await sent.locator("#detail-title").textContent(), "Design 0033");
      assert.ok(!await sent.locator("#unread").isVisible());
      await sent.close();
      // Invalid parts are ignored.
      const invalid = await open(results, "#require=nonsense&require=coverage+>=+x&weights=1,2&criteria=up:none&design=9999&show.width=3&scale=odd");
      assert.deepEqual(await invalid.evaluate(() => [squama.state.requirements, squama.state.weights, squama.state.scale]), [[], [25, 25, 25, 25], "paper"]);
      assert.match(await invalid.locator("#unread").textContent(), /nonsense; coverage >= x/);
      await invalid.close();
      await page.evaluate(() => { squama.pin(null); squama.require([]); });
      await page.locator("#equal-weights").click();
      await page.locator("#table thead button").first().click();
    },

    async "links within the page keep the state in the address"() {
      await page.waitForTimeout(400);
      const before = page.url();
      await page.locator('nav a[href="#designs"]').click();
      await page.waitForTimeout(400);
      assert.equal(page.url(), before);
    },
  };
};

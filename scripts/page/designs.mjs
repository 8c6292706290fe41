// Tests of the table, of the selected design, and of the comparison of two designs.
import assert from "node:assert/strict";
import { join } from "node:path";
import { table } from "./browser.mjs";

export default ({ page, text, texts, column, detail, detailIsWhole, run, place, results }) => {
  const sortBy = (name) => page.locator("#table thead button", { hasText: name }).first().click();
  const number = (title) => Number(title.replace("Design ", ""));
  const count = () => page.locator("#table tbody tr[data-row]").count();

  return {
    async "the table sorts both ways"() {
      const numbers = async () => (await column("critical force")).map(Number);
      await sortBy("critical force");
      const up = await numbers();
      assert.equal(up.length, 54);
      assert.deepEqual(up, [...up].sort((a, b) => a - b));
      await sortBy("critical force");
      assert.deepEqual(await numbers(), [...up].reverse());
      assert.equal(await page.locator('#table th[aria-sort="descending"]').count(), 1);
      await sortBy("design");
    },

    async "the table filters, and its filters are requirements"() {
      await page.locator('input[data-column="slant_deg"]').fill(">=60");
      assert.equal(await count(), 18);
      assert.deepEqual([...new Set(await column("slant α"))], ["60", "75"]);
      await page.locator('input[data-column="gap_over_t"]').fill("0.1..0.3");
      assert.equal(await count(), 12);
      await page.locator('input[data-column="puncture_status"]').fill("complete");
      assert.equal(await count(), 12);
      assert.match(await text("#table-count"), /^12 of 54/);
      assert.equal(await page.locator("#requirement-list li").count(), 4);
      assert.match(await text("#rank-command code"), /--require 'slant_deg >= 60' --require 'gap_over_t >= 0\.1' --require 'gap_over_t <= 0\.3' --weights/);
      await page.locator('input[data-column="coverage"]').fill(">0.");
      await page.locator('input[data-column="coverage"]').fill(">a");
      assert.equal(await page.locator('input[data-column="coverage"]').getAttribute("aria-invalid"), "true");
      await page.locator("#clear-filters").click();
      assert.equal(await count(), 54);
    },

    async "columns are shown and hidden"() {
      await page.locator("#designs summary").click();
      await page.locator('#column-list input[value="sink"]').check();
      assert.equal((await column("sink")).length, 54);
      await page.locator('#column-list input[value="sink"]').uncheck();
      await page.locator("#designs summary").click();
    },

    async "a row of the table is selected with the keyboard"() {
      await page.locator("#table thead input").last().focus();
      await page.keyboard.press("Tab");
      // Tab moves the focus from the last filter to the selected design.
      const from = number(await detail());
      await page.keyboard.press("ArrowDown");
      await page.keyboard.press("Enter");
      assert.equal(number(await detail()), from + 1);
      assert.equal((await texts("#table tr.chosen td"))[0], String(from + 1).padStart(4, "0"));
      await detailIsWhole();
    },

    async "the commands shown for a design can be run"() {
      const commands = await texts("#detail-commands code");
      assert.equal(commands.length, 4);
      const design = (await detail()).replace("Design ", "");
      assert.match(run(commands[0], "--out", join(place, "design")), new RegExp(`design ${design} of 54`));
      for (const command of commands.slice(1)) assert.match(run(command, "--out", join(place, "drawn")), /\.svg/);
    },

    async "the drawing of a design is enlarged with Enter and closed with Escape"() {
      await page.locator("#best tbody tr").first().focus();
      await page.keyboard.press("Enter");
      await page.locator("#drawing button").focus();
      await page.keyboard.press("Enter");
      await page.locator("dialog[open] svg").waitFor();
      await page.keyboard.press("Escape");
      assert.equal(await page.locator("dialog[open]").count(), 0);
    },

    async "a pinned design is compared with the next one: drawings, curves, numbers"() {
      assert.ok(!await page.locator("#compare").isVisible());
      const [first, second] = (await texts("#best tbody td:nth-child(2)"));
      await page.locator("#best tbody tr").first().click();
      await page.locator("#pin").focus();
      await page.keyboard.press("Enter");
      await page.locator("#best tbody tr").nth(1).click();
      assert.match(await text("#detail-gap"), /Gap 10 % smaller \/ larger.*coverage.*critical force/);
      assert.deepEqual((await texts("#compare-numbers thead th")).slice(1, 3), [first, second]);
      const designs = table(results, "designs.csv"), row = (design) => designs.find((one) => one.design === design);
      const force = page.locator("#compare-numbers tbody tr", { hasText: "critical force" }).first().locator("td");
      const values = (await force.allTextContents()).slice(0, 2).map(Number);
      values.forEach((value, k) => assert.ok(Math.abs(value / Number(row([first, second][k]).critical_force) - 1) < 1e-3));
      assert.equal(await page.locator("#compare-drawings > div").count(), 2);
      assert.ok(await page.locator("#compare-drawings svg polygon").count() > 6);
      // The curves of both designs are visible on linear and logarithmic axes. The curves of the pinned
      // design are dashed.
      const curves = () => page.locator("#compare-curves .curve.on").evaluateAll((all) => all.map((one) => ({ design: one.dataset.design, dash: one.style.strokeDasharray, wide: one.getBoundingClientRect().width })));
      for (const kind of ["linear", "logarithmic"]) {
        await page.waitForFunction((log) => document.querySelectorAll("#compare-curves .curve.on").length === 4 && document.querySelector("#compare-curves .drawn").dataset.log === String(log), kind === "logarithmic");
        const all = await curves();
        assert.deepEqual(all.map(({ design }) => design).sort(), [first, first, second, second].sort(), kind);
        for (const { design, dash, wide } of all) assert.ok(wide > 60 && (dash !== "none") === (design === first), `${kind} ${design} ${dash} ${wide}`);
        await page.locator("#log").check();
      }
      await page.locator("#log").uncheck();
      await page.locator("#unpin").click();
      assert.ok(!await page.locator("#compare").isVisible());
    },
  };
};

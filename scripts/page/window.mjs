// Tests of the report in narrow windows.
import assert from "node:assert/strict";
import { ready, spots, WIDE } from "./browser.mjs";

export default ({ page, open, folders }) => ({
  async "a narrow window needs no horizontal scrolling"() {
    for (const folder of [null, folders.axes, folders.folded, folders.someFailed]) {
      const own = folder ? await open(folder) : page;
      await own.evaluate(() => squama.pin(3));
      for (const width of [800, 390]) {
        await own.setViewportSize({ width, height: 900 });
        await own.waitForTimeout(300);
        assert.ok(await own.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${folder} ${width} px`);
      }
      await own.evaluate(() => squama.pin(null));
      if (folder) await own.close();
    }
  },

  async "on a phone the best designs come first, and touch targets are 44 px high"() {
    await page.setViewportSize({ width: 390, height: 844 });
    await page.reload();
    await ready(page);
    // Scroll to the top, because a reloaded page keeps its scroll position.
    await page.evaluate(() => scrollTo({ top: 0, behavior: "instant" }));
    const best = await page.locator("#live-best button").first().boundingBox();
    assert.ok(best.y > 0 && best.y < 844, `${best.y}`);
    const [summary, run] = await page.evaluate(() => ["summary", "run"].map((id) => document.getElementById(id).getBoundingClientRect().y));
    assert.ok(run > summary + 3000, "the record of the run is not at the end");
    const small = await page.evaluate(() => [...document.querySelectorAll("button, select, input:not([type=checkbox]), nav a, summary, label:has(input[type=checkbox]), #table tbody tr[data-row], #best tr[data-row]")]
      .filter((own) => own.checkVisibility()).map((own) => [own, own.getBoundingClientRect()]).filter(([, box]) => box.width > 0 && box.height < 43.9).map(([own, box]) => `${own.outerHTML.slice(0, 80)} ${box.height}`));
    assert.deepEqual(small, []);
    await page.setViewportSize(WIDE);
  },

  async "in a narrow window a click on a mark shows the drawing of the design within the view"() {
    await page.setViewportSize({ width: 800, height: 900 });
    await page.reload();
    await ready(page);
    assert.ok(!await page.locator("#drawing").isVisible());
    const { x, y } = (await spots(page, "stiffness"))[3];
    await page.mouse.click(x, y);
    const seen = await page.locator("#drawing svg").first().boundingBox();
    assert.ok(seen.y > 0 && seen.y + 50 < 900, JSON.stringify(seen));
    await page.locator("#fold").focus();
    await page.keyboard.press("Enter");
    assert.ok(!await page.locator("#drawing").isVisible());
    await page.setViewportSize(WIDE);
  },
});

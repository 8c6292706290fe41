// Narrow windows.
import assert from "node:assert/strict";
import { ready, spots, WIDE } from "./browser.mjs";

export default ({ page, open, folders }) => ({
  async "a narrow window needs no scrolling sideways"() {
    for (const folder of [null, folders.axes, folders.folded]) {
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

  async "in a narrow window a click shows the design where it is seen"() {
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

// Tests of the page in a real browser; see check-page, which runs them.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [place, squama, results, chromium] = process.argv.slice(2);
const { chromium: browserType } = createRequire(join(place, "package.json"))("playwright-core");

const profile = mkdtempSync(join(tmpdir(), "squama-page-"));
const context = await browserType.launchPersistentContext(profile, {
  executablePath: chromium,
  headless: true,
  viewport: { width: 1500, height: 1000 },
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

const problems = [];
const open = async (folder) => {
  const page = await context.newPage();
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) problems.push(`network: ${request.url()}`); });
  await page.goto(pathToFileURL(join(folder, "report.html")).href);
  await page.waitForFunction(() => document.querySelectorAll("#tetrahedron canvas").length > 0);
  return page;
};

const page = await open(results);
const texts = (selector) => page.locator(selector).allTextContents();
const column = async (name) => {
  const headers = (await texts("#table thead tr:first-child th")).map((text) => text.replace(/ [▲▼]$/, ""));
  return texts(`#table tbody td:nth-child(${headers.indexOf(name) + 1})`);
};
const sortBy = (name) => page.locator("#table thead button", { hasText: name }).first().click();
const detail = () => page.locator("#detail-title").textContent();

const tests = {
  async "loads from a file without an error and without a network"() {
    assert.deepEqual(problems, []);
    assert.match(await page.locator("#title").textContent(), /54 designs/);
  },

  async "every figure has marks"() {
    for (const id of ["critical-force", "stiffness", "penetration", "compliance", "pareto", "coverage"]) {
      assert.ok(await page.locator(`#chart-${id} .points path`).count() > 10, id);
    }
  },

  async "the table sorts both ways"() {
    const numbers = async () => (await column("critical force")).map(Number).filter(Number.isFinite);
    await sortBy("critical force");
    const up = await numbers();
    assert.deepEqual(up, [...up].sort((a, b) => a - b));
    await sortBy("critical force");
    const down = await numbers();
    assert.deepEqual(down, [...down].sort((a, b) => b - a));
    assert.equal(await page.locator('#table th[aria-sort="descending"]').count(), 1);
    await sortBy("design");
  },

  async "the table filters"() {
    const count = () => page.locator("#table tbody tr").count();
    await page.locator('input[data-column="slant_deg"]').fill(">=60");
    assert.equal(await count(), 18);
    await page.locator('input[data-column="gap_over_t"]').fill("0.1..0.3");
    assert.equal(await count(), 12);
    await page.locator('input[data-column="puncture_status"]').fill("complete");
    assert.equal(await count(), 12);
    await page.locator("#clear-filters").click();
    assert.equal(await count(), 54);
  },

  async "a row of the table can be chosen with the keyboard"() {
    await page.locator("#table tbody tr").nth(3).focus();
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    assert.equal(await detail(), "Design 0005");
    assert.match(await page.locator("#detail-commands").textContent(), /squama design .*run\.toml --design 0005/);
    assert.equal(await page.locator("#table tr.chosen").getAttribute("data-row"), "4");
  },

  async "the command of a design runs"() {
    const command = await page.locator("#detail-commands code").first().textContent();
    const [, ...words] = command.split(" ");
    const text = execFileSync(squama, [...words, "--out", join(place, "design")], { encoding: "utf8" });
    assert.match(text, /design 0005 of 54/);
  },

  async "a click on a mark chooses its design"() {
    for (const id of ["critical-force", "stiffness", "pareto", "coverage"]) {
      const mark = page.locator(`#chart-${id} .points path`).nth(7);
      await mark.scrollIntoViewIfNeeded();
      const row = await mark.evaluate((path) => path.__data__.data ?? path.__data__.trace?.customdata?.[path.__data__.i]);
      const box = await mark.boundingBox();
      await page.evaluate(() => { document.getElementById("detail-title").textContent = ""; });
      await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
      await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
      await page.waitForFunction(() => document.getElementById("detail-title").textContent !== "");
      assert.equal(await detail(), `Design ${String(row + 1).padStart(4, "0")}`, id);
    }
  },

  async "the arrow keys go from design to design in a figure"() {
    await page.locator("#chart-stiffness").focus();
    const before = await detail();
    await page.keyboard.press("ArrowRight");
    assert.notEqual(await detail(), before);
  },

  async "the ranking equals that of the command for any weights"() {
    const slide = (key, value) => page.locator(`#weight-${key}`).fill(String(value));
    for (const moves of [[], [["m", 60]], [["l", 10], ["n", 35]], [["k", 100]], [["m", 0]]]) {
      for (const [key, value] of moves) await slide(key, value);
      const outputs = (await texts("#weights output")).map(Number);
      assert.equal(Math.round(outputs.reduce((a, b) => a + b, 0) * 100), 100);
      const command = await page.locator("#rank-command").textContent();
      const [, ...words] = command.split(" ");
      execFileSync(squama, [...words, "--top", "15"], { encoding: "utf8" });
      const shown = await texts("#best tbody td:nth-child(2)");
      assert.deepEqual(shown, rankedByCommand().slice(0, shown.length), command);
    }
    await page.locator("#equal-weights").click();
  },

  async "the tetrahedron turns under the mouse and by keys, and a click chooses"() {
    const area = page.locator("#tetrahedron");
    await area.scrollIntoViewIfNeeded();
    const camera = () => area.evaluate((div) => JSON.stringify(div._fullLayout.scene._scene.getCamera().eye));
    const box = await area.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const before = await camera();
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 120, y + 30, { steps: 8 });
    await page.mouse.up();
    const turned = await camera();
    assert.notEqual(turned, before);
    await area.focus();
    await page.keyboard.press("ArrowLeft");
    await page.waitForTimeout(200);
    assert.notEqual(await camera(), turned);
    await page.evaluate(() => { document.getElementById("detail-title").textContent = ""; });
    // Some of these places carry a dot. The chart sees a button that is down while it draws.
    for (const [dx, dy] of [[0, 20], [10, 30], [-20, 40], [30, 0], [0, 60], [40, 40], [-40, 10], [15, -15], [-10, 70], [25, 55]]) {
      await page.mouse.move(x + dx - 3, y + dy);
      await page.mouse.move(x + dx, y + dy, { steps: 3 });
      await page.waitForTimeout(250);
      await page.mouse.down();
      await page.waitForTimeout(250);
      await page.mouse.up();
      if (await detail() !== "") break;
    }
    assert.match(await detail(), /^Design \d+$/);
  },

  async "light and dark"() {
    const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const light = await paper();
    await page.locator("#theme").click();
    assert.notEqual(await paper(), light);
    await page.locator("#theme").click();
    assert.equal(await paper(), light);
  },

  async "a narrow window needs no scrolling sideways"() {
    await page.setViewportSize({ width: 420, height: 900 });
    await page.waitForTimeout(500);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await page.setViewportSize({ width: 1500, height: 1000 });
  },

  async "failures are listed with their reasons"() {
    const stopped = await open(`${results}-stopped`);
    assert.match(await stopped.locator("#failure-list").textContent(), /too many points/);
    assert.match(await page.locator("#failure-list").textContent(), /None/);
  },

  async "nothing went wrong meanwhile"() {
    assert.deepEqual(problems, []);
  },
};

/** Design numbers of ranking.csv, the best first. */
function rankedByCommand() {
  const { readFileSync } = globalThis.process.getBuiltinModule("node:fs");
  const [header, ...rows] = readFileSync(join(results, "ranking.csv"), "utf8").trim().split("\n").map((line) => line.split(","));
  return rows.map((row) => row[header.indexOf("design")]);
}

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    await test();
    console.log(`ok      ${name}`);
  } catch (error) {
    failed++;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
await context.close();
rmSync(profile, { recursive: true, force: true });
console.log(`page: ${Object.keys(tests).length - failed} passed, ${failed} failed`);
process.exit(failed === 0 ? 0 : 1);

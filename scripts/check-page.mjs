// Tests of the page in a real browser; check-page makes the pages and runs this.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [place, squama, chromium] = process.argv.slice(2);
const { chromium: browserType } = createRequire(join(place, "package.json"))("playwright-core");
const [results, someFailed, allFailed] = ["results", "some-failed", "all-failed"].map((name) => join(place, name));
const WIDE = { width: 1500, height: 1000 };
const CHARTS = ["critical-force", "stiffness", "penetration", "compliance", "coverage", "pareto"];

const profile = mkdtempSync(join(tmpdir(), "squama-page-"));
const context = await browserType.launchPersistentContext(profile, {
  executablePath: chromium,
  headless: true,
  viewport: WIDE,
  colorScheme: "light",
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

const problems = [];
const requests = [];
const open = async (folder) => {
  const page = await context.newPage();
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("request", (request) => { if (!/^(data|blob):/.test(request.url())) requests.push(request.url()); });
  await page.goto(pathToFileURL(join(folder, "report.html")).href);
  // The last thing that a page does is to choose a design.
  await page.waitForFunction(() => document.getElementById("detail-title").textContent.startsWith("Design"));
  return page;
};

/** Rows of a table of a run, by header. */
const table = (folder, name) => {
  const [header, ...rows] = readFileSync(join(folder, name), "utf8").trim().split("\n").map((line) => line.split(","));
  return rows.map((row) => Object.fromEntries(header.map((key, k) => [key, row[k]])));
};

/** Runs a command as the page words it. */
const run = (command, ...more) => {
  const [program, ...words] = command.split(" ");
  assert.equal(program, "squama");
  return execFileSync(squama, [...words, ...more], { encoding: "utf8" });
};

const page = await open(results);
const texts = (selector) => page.locator(selector).allTextContents();
const text = (selector) => page.locator(selector).textContent();
const column = async (name) => {
  const headers = (await texts("#table thead tr:first-child th")).map((header) => header.replace(/ [▲▼]$/, ""));
  assert.ok(headers.includes(name), name);
  return texts(`#table tbody td:nth-child(${headers.indexOf(name) + 1})`);
};
const sortBy = (name) => page.locator("#table thead button", { hasText: name }).first().click();
const detail = () => text("#detail-title");
const forget = () => page.evaluate(() => { document.getElementById("detail-title").textContent = ""; });
const number = (title) => Number(title.replace("Design ", ""));

/** That the design which is shown has its parameters, values, drawing and command. */
const detailIsWhole = async () => {
  const design = (await detail()).replace("Design ", "");
  const { gap_over_t, length_over_t, slant_deg } = table(results, "designs.csv").find((row) => row.design === design);
  assert.deepEqual(await texts("#detail-parameters dd"), [gap_over_t, length_over_t, `${slant_deg}°`]);
  assert.ok(await page.locator("#detail-values dd").count() > 20);
  assert.ok(await page.locator("#drawing svg polygon").count() > 3);
  assert.match(await text("#detail-commands"), new RegExp(`squama design \\S+run\\.toml --design ${design}`));
};

const tests = {
  async "loads from a file and asks for nothing else"() {
    assert.match(await text("#title"), /54 designs/);
    assert.deepEqual(problems, []);
    assert.deepEqual(requests, [pathToFileURL(join(results, "report.html")).href]);
  },

  async "no chart offers to upload itself"() {
    const buttons = await page.locator(".modebar-btn").evaluateAll((all) => [...new Set(all.map((button) => button.dataset.title))]);
    assert.ok(buttons.length > 3);
    assert.deepEqual(buttons.filter((title) => /cloud|share|edit|send/i.test(title)), []);
  },

  async "every figure has a mark for every design"() {
    for (const id of CHARTS) {
      const marks = await page.locator(`#chart-${id} .points path`).count();
      assert.ok(marks >= (id === "pareto" ? 6 * 30 : 54), `${id}: ${marks}`);
    }
  },

  async "axes carry symbols and say that they are dimensionless"() {
    for (const id of CHARTS) {
      const labels = await texts(`#chart-${id} .xtitle, #chart-${id} .ytitle, #chart-${id} .annotation-text`);
      const axes = labels.filter((label) => /dimensionless/.test(label));
      assert.ok(axes.length >= 2, `${id}: ${labels}`);
    }
  },

  async "a slant has one colour in every figure"() {
    const pairs = await page.evaluate(() => squama.charts.filter(({ id }) => id !== "coverage").flatMap(({ area }) =>
      area.data.filter((trace) => Array.isArray(trace.marker.color) && trace.customdata)
        .flatMap((trace) => trace.customdata.map((row, k) => `${squama.cell(row, "slant_deg")} ${trace.marker.color[k]}`))));
    assert.deepEqual([...new Set(pairs)].map((pair) => pair.split(" ")[0]).sort(), ["0", "15", "30", "45", "60", "75"]);
  },

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

  async "the table filters"() {
    const count = () => page.locator("#table tbody tr").count();
    await page.locator('input[data-column="slant_deg"]').fill(">=60");
    assert.equal(await count(), 18);
    assert.deepEqual([...new Set(await column("slant α"))], ["60", "75"]);
    await page.locator('input[data-column="gap_over_t"]').fill("0.1..0.3");
    assert.equal(await count(), 12);
    await page.locator('input[data-column="puncture_status"]').fill("complete");
    assert.equal(await count(), 12);
    assert.match(await text("#table-count"), /^12 of 54/);
    await page.locator("#clear-filters").click();
    assert.equal(await count(), 54);
  },

  async "a row of the table is reached and chosen with keys alone"() {
    await page.locator('input[data-column="flexure_status"]').focus();
    await page.keyboard.press("Tab");
    // The design that is chosen is the one that Tab reaches.
    const from = number(await detail());
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    assert.equal(number(await detail()), from + 1);
    assert.equal(await page.locator("#table tr.chosen td").first().textContent(), String(from + 1).padStart(4, "0"));
    await detailIsWhole();
  },

  async "the commands of a design run"() {
    const commands = await texts("#detail-commands code");
    assert.equal(commands.length, 4);
    const design = (await detail()).replace("Design ", "");
    assert.match(run(commands[0], "--out", join(place, "design")), new RegExp(`design ${design} of 54`));
    for (const command of commands.slice(1)) assert.match(run(command, "--out", join(place, "drawn")), /\.svg/);
  },

  async "a click on a mark of any figure shows its design"() {
    for (const id of CHARTS) {
      const mark = page.locator(`#chart-${id} .points path`).nth(7);
      await mark.scrollIntoViewIfNeeded();
      const box = await mark.boundingBox();
      await forget();
      await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
      await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
      await page.waitForFunction(() => document.getElementById("detail-title").textContent !== "", null, { timeout: 5000 });
      // Marks may coincide: what was clicked stands where the ring does.
      const ring = await page.locator(`#chart-${id} .points path`).evaluateAll((paths, [x, y]) => paths.some((path) => {
        const own = path.getBoundingClientRect();
        return own.width > 15 && Math.hypot(own.x + own.width / 2 - x, own.y + own.height / 2 - y) < 1.5;
      }), [box.x + box.width / 2, box.y + box.height / 2]);
      assert.ok(ring, `${id}: no ring around the mark`);
      await detailIsWhole();
    }
  },

  async "the arrow keys go from design to design in every figure"() {
    for (const id of CHARTS) {
      await page.locator(`#chart-${id}`).focus();
      const before = await detail();
      await page.keyboard.press("ArrowRight");
      const after = await detail();
      assert.notEqual(after, before, id);
      await page.keyboard.press("ArrowLeft");
      assert.equal(await detail(), before, id);
    }
  },

  async "the drawing of a good design is enlarged, and Escape closes it"() {
    await page.locator("#best tbody tr").first().focus();
    await page.keyboard.press("Enter");
    await page.locator("#drawing button").focus();
    await page.keyboard.press("Enter");
    assert.ok(await page.locator("dialog[open] svg").isVisible());
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("dialog[open]").count(), 0);
  },

  async "the ranking equals that of the command for any weights"() {
    const slide = (key, value) => page.locator(`#weight-${key}`).fill(String(value));
    for (const moves of [[], [["m", 60]], [["l", 10], ["n", 35]], [["n", 1]], [["k", 100]], [["m", 0]], [["l", 47]]]) {
      for (const [key, value] of moves) await slide(key, value);
      const weights = (await texts("#weights output")).map(Number);
      assert.equal(Math.round(weights.reduce((a, b) => a + b, 0) * 100), 100);
      const command = await text("#rank-command");
      assert.ok(command.endsWith(`--weights ${weights.join(",")}`), command);
      run(command);
      const ranking = table(results, "ranking.csv").slice(0, 15);
      assert.deepEqual(await texts("#best tbody td:nth-child(2)"), ranking.map((row) => row.design), command);
      const fitness = ranking.map((row) => Number(row.fitness).toFixed(4));
      assert.deepEqual(await texts("#best tbody td:nth-child(6)"), fitness, command);
    }
    await page.locator("#equal-weights").click();
  },

  async "all of the ranking equals that of the command, and the designs that win"() {
    const all = await page.evaluate(() => squama.rank([0.4, 0.3, 0.2, 0.1]).map(({ row }) => squama.number(row)));
    run(`squama rank ${results} --weights 0.4,0.3,0.2,0.1`);
    assert.deepEqual(all, table(results, "ranking.csv").map((row) => row.design));
    const winners = table(results, "winners.csv").slice(0, 10).map((row) => row.design);
    assert.deepEqual((await texts("#tetrahedron-legend button")).map((label) => label.slice(0, 4)), winners);
    const front = await page.evaluate(() => [...squama.front].map(squama.number).sort());
    assert.deepEqual(front, table(results, "pareto.csv").map((row) => row.design).sort());
  },

  async "the ranking equals that of the command for random weights"() {
    // A generator with a seed of its own, so that a failure comes again.
    let state = 20211121;
    const random = () => (state = (1103515245 * state + 12345) % 2147483648) / 2147483648;
    for (let round = 0; round < 10; round++) {
      const parts = Array.from({ length: 4 }, () => (random() < 0.2 ? 0 : random()));
      const sum = parts.reduce((a, b) => a + b, 0) || 1;
      const hundredths = parts.map((part) => Math.floor((100 * part) / sum));
      hundredths[round % 4] += 100 - hundredths.reduce((a, b) => a + b, 0);
      const weights = hundredths.map((part) => part / 100);
      const ours = await page.evaluate((w) => squama.rank(w).map(({ row }) => squama.number(row)), weights);
      run(`squama rank ${results} --weights ${weights.join(",")}`);
      assert.deepEqual(ours, table(results, "ranking.csv").map((row) => row.design), weights.join());
    }
  },

  async "sliders move with keys, and the ranking with them"() {
    await page.locator("#weight-n").focus();
    for (let k = 0; k < 3; k++) await page.keyboard.press("ArrowRight");
    assert.equal((await texts("#weights output"))[1], "0.28");
    assert.match(await text("#rank-command"), /--weights 0\.24,0\.28,0\.24,0\.24/);
    await page.locator("#equal-weights").focus();
    await page.keyboard.press("Enter");
    assert.deepEqual(await texts("#weights output"), ["0.25", "0.25", "0.25", "0.25"]);
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
    await forget();
    // Some of these places carry a dot. The chart sees a button that is down while it draws.
    const places = [[0, 20], [10, 30], [-20, 40], [30, 0], [0, 60], [40, 40], [-40, 10], [15, -15], [-10, 70], [25, 55]];
    for (const [dx, dy] of places) {
      await page.mouse.move(x + dx - 3, y + dy);
      await page.mouse.move(x + dx, y + dy, { steps: 3 });
      await page.waitForTimeout(250);
      await page.mouse.down();
      await page.waitForTimeout(250);
      await page.mouse.up();
      if (await detail() !== "") break;
    }
    assert.match(await detail(), /^Design \d+$/);
    await detailIsWhole();
  },

  async "light and dark, by the button and by what the system prefers"() {
    const colors = () => page.evaluate(() => {
      const style = getComputedStyle(document.body);
      return [style.backgroundColor, style.color, squama.charts[0].area._fullLayout.paper_bgcolor];
    });
    const light = await colors();
    await page.locator("#theme").focus();
    await page.keyboard.press("Enter");
    const dark = await colors();
    dark.forEach((color, k) => assert.notEqual(color, light[k]));
    await page.keyboard.press("Enter");
    assert.deepEqual(await colors(), light);
    await page.emulateMedia({ colorScheme: "dark" });
    await page.reload();
    await page.waitForFunction(() => document.getElementById("detail-title").textContent.startsWith("Design"));
    assert.deepEqual(await colors(), dark);
    await page.emulateMedia({ colorScheme: "light" });
  },

  async "the ring of the tetrahedron and the names of its corners are seen"() {
    const notes = page.locator("#tetrahedron .annotation-text");
    assert.deepEqual(await notes.allTextContents(), ["coverage", "force", "resistance", "compliance", "◯"]);
    const ring = () => notes.last().boundingBox();
    const before = await ring();
    await page.locator("#weight-m").fill("100");
    const after = await ring();
    assert.ok(after.y < before.y - 50, `${before.y} ${after.y}`);
    await page.locator("#equal-weights").click();
    const area = await page.locator("#tetrahedron").boundingBox();
    for (const box of await Promise.all([0, 1, 2, 3].map((k) => notes.nth(k).boundingBox()))) {
      assert.ok(box.x >= area.x && box.x + box.width <= area.x + area.width, "a name leaves the chart");
    }
  },

  async "a narrow window needs no scrolling sideways"() {
    for (const width of [800, 420]) {
      await page.setViewportSize({ width, height: 900 });
      await page.waitForTimeout(500);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${width} px`);
    }
  },

  async "in a narrow window a click shows the design where it is seen"() {
    await page.setViewportSize({ width: 800, height: 900 });
    await page.reload();
    await page.waitForFunction(() => document.getElementById("detail-title").textContent.startsWith("Design"));
    assert.ok(!await page.locator("#drawing").isVisible());
    await page.locator("#chart-stiffness").scrollIntoViewIfNeeded();
    const box = await page.locator("#chart-stiffness .points path").nth(40).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    const seen = await page.locator("#drawing svg").first().boundingBox();
    assert.ok(seen.y > 0 && seen.y + 50 < 900, JSON.stringify(seen));
    await page.locator("#fold").focus();
    await page.keyboard.press("Enter");
    assert.ok(!await page.locator("#drawing").isVisible());
    await page.setViewportSize(WIDE);
  },

  async "failures are listed with their reasons, and lead to their designs"() {
    assert.match(await text("#failure-list"), /None/);
    const stopped = await open(someFailed);
    const expected = table(someFailed, "failures.csv");
    assert.ok(expected.length > 0 && expected.length < 12);
    const cells = (k) => stopped.locator(`#failure-list tbody td:nth-child(${k})`).allTextContents();
    assert.deepEqual((await cells(1)).map((title) => title.slice(0, 4)), expected.map((row) => row.design));
    assert.deepEqual(await cells(2), expected.map((row) => row.measure));
    assert.deepEqual(await cells(3), expected.map((row) => row.reason));
    await stopped.locator("#failure-list tbody tr").last().focus();
    await stopped.keyboard.press("Enter");
    assert.equal(await stopped.locator("#detail-title").textContent(), `Design ${expected.at(-1).design}`);
    assert.ok(await stopped.locator("#drawing svg polygon").count() > 3);
  },

  async "a run in which nothing can be ranked has a page too"() {
    const nothing = await open(allFailed);
    assert.match(await nothing.locator("#tetrahedron").textContent(), /nothing to rank/);
    assert.equal(await nothing.locator("#best tbody tr").count(), 0);
    assert.ok(await nothing.locator("#failure-list tbody tr").count() >= 12);
    assert.ok(await nothing.locator("#chart-coverage .points path").count() >= 12);
  },

  async "nothing went wrong meanwhile, and nothing was asked for but the pages"() {
    assert.deepEqual(problems, []);
    assert.ok(requests.every((url) => /^file:.*\/report\.html$/.test(url)), String(requests));
  },
};

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

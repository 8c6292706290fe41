// The browser, the pages that are open, and what tests read from them.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

export const WIDE = { width: 1500, height: 1000 };

/** Rows of a table of a run, by header. */
export const table = (folder, name) => {
  const [header, ...rows] = readFileSync(join(folder, name), "utf8").trim().split(/\r?\n/).map((line) => line.split(","));
  return rows.map((row) => Object.fromEntries(header.map((key, k) => [key, row[k]])));
};

/** Words of a command, of which some are in quotes. */
const words = (command) => [...command.matchAll(/'([^']*)'|(\S+)/g)].map(([, quoted, plain]) => quoted ?? plain);

/** Starts a browser; `squama` is the program under test. */
export const start = async ({ place, squama, chromium }) => {
  const { chromium: browserType } = createRequire(join(place, "package.json"))("playwright-core");
  const profile = mkdtempSync(join(tmpdir(), "squama-page-"));
  const context = await browserType.launchPersistentContext(profile, {
    executablePath: chromium,
    headless: true,
    viewport: WIDE,
    colorScheme: "light",
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
  const problems = [], requests = [];

  /** Opens a file, and notes what goes wrong and what is asked for. */
  const openFile = async (file, state = "") => {
    const page = await context.newPage();
    page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("request", (request) => { if (!/^(data|blob):/.test(request.url())) requests.push(request.url()); });
    await page.goto(pathToFileURL(file).href + state);
    return page;
  };

  /** Opens the page of a folder, with a state in its address. */
  const open = async (folder, state = "") => {
    const page = await openFile(join(folder, "report.html"), state);
    await ready(page);
    return page;
  };

  /** Runs a command as the page words it. */
  const run = (command, ...more) => {
    const [program, ...rest] = words(command);
    assert.equal(program, "squama");
    return execFileSync(squama, [...rest, ...more], { encoding: "utf8" });
  };

  const stop = async () => {
    await context.close();
    rmSync(profile, { recursive: true, force: true });
  };
  return { open, openFile, run, stop, problems, requests };
};

/** Waits until a page has chosen a design, which is the last thing that it does. */
export const ready = (page) => page.waitForFunction(() => document.getElementById("detail-title").textContent.startsWith("Design"));

/** Scrolls to a chart, and waits until it is drawn. */
export const shown = async (page, id) => {
  await page.locator(`#chart-${id}`).scrollIntoViewIfNeeded();
  await page.waitForFunction((own) => { const chart = squama.charts.find((one) => one.id === own); return !chart.stale && chart.svg; }, id);
};

/** Where the marks of a chart stand in the window, with their rows; the chart is scrolled to. */
export const spots = async (page, id) => {
  await shown(page, id);
  return page.evaluate((own) => {
    const { marks, svg } = squama.charts.find((chart) => chart.id === own), box = svg.getBoundingClientRect(), view = svg.viewBox.baseVal, scale = box.width / view.width;
    return marks.map(({ row, x, y, silent, element }) => ({ row, silent, x: box.x + scale * x, y: box.y + scale * (y - view.y), look: `${element.getAttribute("color")} ${element.getAttribute("href")}` }));
  }, id);
};

/** The texts of a chart, and the data of its lines. */
export const drawn = async (page, id, selector = "text") => {
  await shown(page, id);
  return page.locator(`#chart-${id} svg ${selector}`).evaluateAll((all) => all.map((one) => one.getAttribute("d") ?? one.textContent));
};

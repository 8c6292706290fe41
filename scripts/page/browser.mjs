// Starts the browser, opens pages, and reads tables and charts for the tests.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

export const WIDE = { width: 1500, height: 1000 };

/** Returns the rows of a CSV table of a run, each as an object with the headers as keys. */
export const table = (folder, name) => {
  const [header, ...rows] = readFileSync(join(folder, name), "utf8").trim().split(/\r?\n/).map((line) => line.split(","));
  return rows.map((row) => Object.fromEntries(header.map((key, k) => [key, row[k]])));
};

/** Splits a shell command into words; single quotes may enclose a word. */
const words = (command) => [...command.matchAll(/'([^']*)'|(\S+)/g)].map(([, quoted, plain]) => quoted ?? plain);

/** Starts a browser; `squama` is the path of the command under test, `place` the folder of the pages. */
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

  /** Opens a file in a new page, and records its errors in `problems` and its requests in `requests`. */
  const openFile = async (file, state = "") => {
    const page = await context.newPage();
    page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("request", (request) => { if (!/^(data|blob):/.test(request.url())) requests.push(request.url()); });
    await page.goto(pathToFileURL(file).href + state);
    return page;
  };

  /** Opens the report of a run; `state` is the part of the address that selects a state. */
  const open = async (folder, state = "") => {
    const page = await openFile(join(folder, "report.html"), state);
    await ready(page);
    return page;
  };

  /** Runs a command that a page shows, with further arguments, and returns its output. */
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

/** Waits until a page has selected a design, which is the last step of opening it. */
export const ready = (page) => page.waitForFunction(() => document.getElementById("detail-title").textContent.startsWith("Design"));

/** Scrolls to the chart with this `id`, and waits until it is drawn. */
export const shown = async (page, id) => {
  // The browser may stop drawing a page behind another one, and scrolling waits for drawn frames.
  await page.bringToFront();
  await page.locator(`#chart-${id}`).scrollIntoViewIfNeeded();
  await page.waitForFunction((own) => { const chart = squama.charts.find((one) => one.id === own); return !chart.stale && chart.svg; }, id);
};

/** Returns rows and positions (in the window, px) of the marks of a chart, after scrolling to it. */
export const spots = async (page, id) => {
  await shown(page, id);
  return page.evaluate((own) => {
    const { marks, svg } = squama.charts.find((chart) => chart.id === own), box = svg.getBoundingClientRect(), view = svg.viewBox.baseVal, scale = box.width / view.width;
    return marks.map(({ row, x, y, silent, element }) => ({ row, silent, x: box.x + scale * x, y: box.y + scale * (y - view.y), look: `${element.getAttribute("color")} ${element.getAttribute("href")}` }));
  }, id);
};

/** Returns path data or text of all elements of a chart that match `selector`. */
export const drawn = async (page, id, selector = "text") => {
  await shown(page, id);
  return page.locator(`#chart-${id} svg ${selector}`).evaluateAll((all) => all.map((one) => one.getAttribute("d") ?? one.textContent));
};

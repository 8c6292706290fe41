// Tests of the explorer, as a separate page and in the report of a run.
import assert from "node:assert/strict";
import { mkdtempSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const SIZES = [{ width: 1400, height: 900 }, { width: 390, height: 844 }];
const STATES = 12;
/** Page that is tested at each window width: on a half-space, and in millimetres on a layer. */
const PAGES = { 1400: "explore.html", 390: "finger.html" };

/** Waits until the solver has returned its final (fine) answer and is idle. */
const settled = (page) => page.waitForFunction(() => squama.live.answer?.fine && squama.solver.idle(), null, { timeout: 180_000 });
/** Calls `act`, and waits for the final answer of the solver to this action. */
const after = async (page, act) => {
  await page.evaluate(() => { squama.live.answer.fine = false; });
  await act();
  await settled(page);
};
/** Creates a reproducible random generator of numbers from 0 to 1. */
const random = (seed) => { let state = seed; return () => { state = (1664525 * state + 1013904223) % 4294967296; return state / 4294967296; }; };
/** Asserts that two numbers agree to six digits, or that both are zero up to round-off. */
const same = (one, other, name) => assert.ok(Math.abs(one - other) <= 1e-6 * Math.max(Math.abs(one), Math.abs(other)) + 1e-10, `${name}: ${one} and ${other}`);
/** Excludes error estimates and numbers of steps, which depend on round-off, from comparisons. */
const isMeasured = (name) => !/_(error|iterations|points)$/.test(name);

export default ({ openFile, open, place, results, run, problems }) => {
  const out = mkdtempSync(join(tmpdir(), "squama-explore-"));
  const explore = async (size, state = "", file = "explore.html") => {
    const page = await openFile(join(place, file), state);
    await page.evaluate(() => {
      globalThis.longTasks = [];
      new PerformanceObserver((list) => globalThis.longTasks.push(...list.getEntries().map(({ startTime, duration }) => [startTime, duration]))).observe({ type: "longtask", buffered: true });
    });
    await page.setViewportSize(size);
    await settled(page);
    return page;
  };
  const values = (page) => page.evaluate(() => Object.fromEntries(squama.live.answer.values.map(({ name, value }) => [name, value])));
  /** Runs a command and returns its measures, also with exit code 1 (a path ended early). */
  const solved = (command) => {
    try { return JSON.parse(run(command, "--json", "--out", out)).measures; } catch (error) {
      if (error.status !== 1) throw error;
      return JSON.parse(error.stdout).measures;
    }
  };
  const of = (tests) => Object.fromEntries(SIZES.flatMap((size) => tests(size)));

  return {
    ...of((size) => [[`the explorer gives the measures of the command for ${STATES} random designs, at ${size.width} pixels`, async () => {
      const page = await explore(size, "", PAGES[size.width]), next = random(size.width);
      for (let k = 0; k < STATES; k++) {
        const shares = Array.from({ length: 16 }, next);
        await after(page, () => page.evaluate((own) => {
          const pairs = squama.live.controls().filter(({ words }) => !words).map(({ key, min, max }, j) => [key, min + own[j] * (max - min)]);
          squama.live.set(Object.fromEntries(pairs));
        }, shares));
        const there = solved(await page.locator("#live-command").textContent());
        for (const [name, value] of Object.entries(await values(page))) {
          if (typeof value === "number" && typeof there[name] === "number" && isMeasured(name)) same(value, there[name], `${name} of ${await page.locator("#live-command").textContent()}`);
        }
      }
      await page.close();
    }], [`the median answer time during drags is below 1 s, at ${size.width} pixels`, async () => {
      const page = await explore(size);
      const opened = await page.evaluate(() => { squama.live.times.length = 0; return performance.now(); });
      for (const [id, far] of [["slant", -50], ["gap", 40], ["length", -30]]) {
        const spot = await page.locator(`#live-handle-${id} .grip`).boundingBox(), [x, y] = [spot.x + spot.width / 2, spot.y + spot.height / 2];
        await page.mouse.move(x, y);
        await page.mouse.down();
        for (let step = 1; step <= 30; step++) { await page.mouse.move(x + (far * step) / 30, y); await page.waitForTimeout(20); }
        await page.mouse.up();
        await settled(page);
      }
      const tasks = await page.evaluate(() => globalThis.longTasks);
      const listed = (own) => own.map(([, duration]) => `${Math.round(duration)} ms`).join(" ") || "none";
      console.log(`        tasks of the page above 50 ms: during opening ${listed(tasks.filter(([at]) => at < opened))}, during drags ${listed(tasks.filter(([at]) => at >= opened))}`);
      const times = (await page.evaluate(() => squama.live.times)).sort((a, b) => a - b), at = (share) => times[Math.floor(share * (times.length - 1))];
      console.log(`        ${times.length} answers to three drags: median ${at(0.5).toFixed(0)} ms, 90 % within ${at(0.9).toFixed(0)} ms, slowest ${at(1).toFixed(0)} ms`);
      assert.ok(times.length > 30 && at(0.5) < 1000, `${times.length} answers, ${at(0.5)} ms`);
      await page.close();
    }], [`handles, sliders and buttons are at least 44 px high and have names, at ${size.width} pixels`, async () => {
      const page = await explore(size);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), size.width);
      for (const one of await page.locator("#live button:visible, #live input[type=range]:visible, #live .handle .reach").all()) assert.ok((await one.boundingBox()).height >= 44);
      for (const one of await page.locator("#live [role=slider], #live input, #live button:visible").all()) assert.ok((await one.evaluate((own) => own.getAttribute("aria-label") ?? own.labels?.[0]?.textContent ?? own.textContent)).length > 0);
      assert.match(await page.locator("#live-set-gap_over_t").getAttribute("aria-valuetext"), /^[\d.]+ mm$/);
      await page.close();
    }], [`a typed sentence selects a design, and dragging the needle moves it sideways, at ${size.width} pixels`, async () => {
      const page = await explore(size, "", "pin.html"), found = page.locator("#live-found");
      const ask = async (sentence) => {
        await page.locator("#live-sentence").fill(sentence);
        await page.locator("#live-ask button").click();
        await page.waitForFunction(() => !/^$|^Searching/.test(squama.at("live-found").textContent), null, { timeout: 180_000 });
        await settled(page);
        return found.textContent();
      };
      assert.match(await ask("a unicorn"), /^Not understood: a unicorn/);
      assert.match(await ask("pin 3 mm, 2,5 N, bends to 25 mm"), /^This design meets the requirements/);
      const own = await values(page);
      assert.ok(own.failure_force_N >= 2.5 && own.bend_radius_mm <= 25, JSON.stringify(own));
      assert.match(await page.locator("#live-command").textContent(), /needle_radius_mm=1\.5/);
      assert.equal(await page.locator("#live-required .unmet").count(), 0);
      if (size.width > 1000) assert.match(await ask("5000 N"), /^None of \d+ solved designs meets the requirements.*failure force ≥ 5000 N/);
      const grip = page.locator("#live-handle-needle .grip"), { x, y, width } = await grip.boundingBox(), at = [x + width / 2, y + width / 2];
      const place = () => page.evaluate(() => squama.live.answer.puncture.load_position), before = await place();
      await after(page, async () => {
        await page.mouse.move(...at);
        await page.mouse.down();
        await page.mouse.move(at[0] - 10, at[1]);
        await page.mouse.up();
      });
      assert.ok(await place() < before - 0.02, `${await place()} and ${before}`);
      assert.match(await page.locator("#live-command").textContent(), /--set puncture\.load_position=/);
      await page.close();
    }], [`four measures and four sliders are visible first, and all after "more", at ${size.width} pixels`, async () => {
      const page = await explore(size);
      for (const card of await page.locator("#live-cards .card").all()) { const { y, height } = await card.boundingBox(); assert.ok(y + height <= size.height, `${y}`); }
      if (size.width < 1000) await page.locator("#live-sheet").click();
      const counts = async () => [await page.locator("#live .card:visible").count(), await page.locator("#live-controls .control:visible").count()];
      assert.deepEqual(await counts(), [4, 4]);
      await page.locator("#live-more").click();
      assert.ok((await counts()).every((count) => count > 6), String(await counts()));
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), size.width);
      await page.emulateMedia({ colorScheme: "dark" });
      await page.waitForFunction(() => getComputedStyle(document.body).backgroundColor === "rgb(20, 24, 29)");
      const printed = await page.pdf({ format: "A4" });
      assert.equal(printed.toString("latin1").match(/\/Type\s*\/Page\b/g).length, 1);
      await page.close();
    }]]),
    async "the drawn row lies on the arc of its body, and the radius can be typed and dragged"() {
      const size = SIZES[0], page = await explore(size);
      await page.locator("#live-more").click();
      const field = page.locator(".control", { hasText: "Body radius" }).locator("input[type=text]");
      const type = (text) => after(page, async () => { await field.fill(text); await field.press("Enter"); });
      /** Returns the base midpoints of the drawn scales relative to the punctured scale, left to right, px. */
      const bases = (id) => page.evaluate((own) => {
        const scales = [...document.querySelectorAll(`#${own} .scale:not(.ghost)`)].map((one) => ({ base: one.getAttribute("points").split(" ").slice(0, 2).map((point) => point.split(",").map(Number)), hit: one.classList.contains("punctured") }));
        const middle = ({ base: [[x, y], [u, v]] }) => [(x + u) / 2, (y + v) / 2], [x, y] = middle(scales.find(({ hit }) => hit));
        return scales.map(middle).map(([u, v]) => [u - x, y - v]);
      }, id);
      const force = async () => (await values(page)).critical_force, forces = {}, sides = {};
      for (const text of ["flat", "10", "-150"]) {
        await type(text);
        assert.equal(await field.getAttribute("aria-invalid"), "false", text);
        forces[text] = await force();
        const rest = await bases("live-rest");
        sides[text] = [rest[0], rest.at(-1)].map(([x, y]) => [Math.abs(x), y]);
        assert.equal(await page.locator("#live-bent .body").count(), text === "flat" ? 0 : 1);
        assert.match(await page.locator("#live-command").textContent(), { flat: /body\.curvature_times_t=0$/, 10: /^(?!.*body)/, "-150": /body\.radius_mm=-150$/ }[text]);
        if (process.env.SHOTS) await page.screenshot({ path: `${process.env.SHOTS}/body-${text}-${size.width}.png`, fullPage: true });
      }
      assert.ok(sides.flat.every(([, y]) => Math.abs(y) < 0.2) && sides["10"].every(([, y]) => y < -5) && sides["-150"].every(([, y]) => y > 0.5), JSON.stringify(sides));
      assert.ok(forces["10"] < forces.flat && forces["-150"] > forces.flat, JSON.stringify(forces));
      for (const text of ["1", "abc", "0", ""]) {
        await field.fill(text);
        await field.press("Enter");
        assert.equal(await field.getAttribute("aria-invalid"), "true", text);
      }
      // Nodes at rest lie on a circle, at x²/(R + √(R² − x²)) below the punctured scale.
      await type("20");
      const [scale, thickness] = await page.evaluate(() => { const [a, b] = [...document.querySelectorAll("#live-rest .scale.punctured")].flatMap((one) => one.getAttribute("points").split(" ").slice(0, 2).map((point) => Number(point.split(",")[0]))); return [(b - a) / squama.live.value("length_over_t"), squama.live.value("thickness_mm")]; });
      const radius = (scale * 20) / thickness;
      for (const [x, y] of await bases("live-rest")) if (Math.abs(x) < 0.9 * radius) assert.ok(Math.abs(y + (x * x) / (radius + Math.sqrt(radius * radius - x * x))) < 0.5, `${x} ${y} ${radius}`);
      await page.locator("#live-rest").scrollIntoViewIfNeeded();
      const grip = async () => { const { x, y, width, height } = await page.locator("#live-handle-gap .grip").boundingBox(); return [x + width / 2, y + height / 2]; };
      const [x, y] = await grip();
      await page.mouse.move(x, y);
      await page.mouse.down();
      for (let step = 1; step <= 5; step++) await page.mouse.move(x + 2 * step, y + step);
      const [right] = await grip();
      assert.ok(Math.abs(right - x - 10) < 3, `${right - x}`);
      await page.mouse.up();
      await settled(page);
      const address = await page.evaluate(() => location.hash), own = await force();
      assert.match(address, /live\.radius_mm=20(&|$)/);
      const other = await explore(size, address);
      assert.equal((await values(other)).critical_force, own);
      // The radius in mm does not change with the thickness. The end of the slider is a flat body.
      await after(page, () => page.evaluate(() => squama.live.set({ thickness_mm: 0.8 })));
      assert.equal(await field.inputValue(), "20");
      await after(page, () => page.evaluate(() => { const slider = document.querySelector("#live-set-radius_mm"); slider.value = 0.0004; slider.dispatchEvent(new Event("input")); }));
      assert.equal(await field.inputValue(), "flat");
      assert.equal(await page.locator("#live-set-radius_mm").getAttribute("aria-valuetext"), "flat");
      for (const one of [page, other]) await one.close();
    },
    async "a guided needle has its own sliders"() {
      const page = await explore(SIZES[0]);
      await page.locator("#live-more").click();
      const friction = page.locator("#live-set-needle_friction");
      assert.equal(await friction.count(), 1);
      assert.ok(!await page.locator("#live-dead-load").isVisible());
      await after(page, () => page.locator("#live-set-needle").selectOption("free"));
      assert.equal(await friction.count(), 0);
      assert.ok(await page.locator("#live-dead-load").isVisible());
      assert.match(await page.locator("#live-command").textContent(), /--set puncture\.needle=free/);
      await page.close();
    },
    async "the page shows 'solving …' until the solver answers"() {
      const page = await openFile(join(place, "explore.html"));
      await page.addInitScript(() => { globalThis.Worker = class { postMessage() {} terminate() {} }; });
      await page.reload();
      for (const id of ["live-needle-words", "live-bent-words"]) assert.equal(await page.locator(`#${id}`).textContent(), "solving …");
      assert.equal(await page.locator("#live-force text").count(), 0);
      await page.close();
    },
    async "a hidden drawing appears when it becomes visible"() {
      const page = await explore(SIZES[0]), spot = () => page.locator("#live-handle-slant .grip").getAttribute("cx"), before = await spot();
      await page.evaluate(() => { squama.at("live-rest").style.display = "none"; squama.live.set({ slant_deg: 20 }); });
      await page.evaluate(() => { squama.at("live-rest").style.display = ""; });
      await page.waitForFunction((own) => document.querySelector("#live-handle-slant .grip").getAttribute("cx") !== own, before);
      assert.deepEqual(problems, []);
      await page.close();
    },
    async "the numbers of sticking and slipping contacts match the drawn contacts"() {
      const page = await explore(SIZES[0]), legend = () => page.locator("#live-needle-stuck").textContent();
      assert.equal(await legend(), "");
      await after(page, () => page.evaluate(() => squama.live.set({ friction: 0.2, slant_deg: 50 })));
      const slip = await page.locator("#live-needle .contact.slips").count(), all = await page.locator("#live-needle .contact").count();
      assert.ok(slip > 0 && await legend() === `Where scales touch: ● ${all - slip} stick, ○ ${slip} slip`, await legend());
      await page.close();
    },
    async "typed values and arrow keys change the design, and invalid input is ignored"() {
      const page = await explore(SIZES[0]), gap = () => page.evaluate(() => squama.live.value("gap_over_t") * squama.live.value("thickness_mm"));
      const field = page.locator(".control", { hasText: "Gap" }).locator("input[type=text]");
      await after(page, async () => { await field.fill("0,3"); await field.press("Enter"); });
      assert.ok(Math.abs(await gap() - 0.3) < 1e-6);
      await field.fill("abc");
      await field.press("Enter");
      assert.equal(await field.getAttribute("aria-invalid"), "true");
      assert.ok(Math.abs(await gap() - 0.3) < 1e-6);
      await after(page, async () => { await page.locator("#live-handle-gap").focus(); await page.keyboard.press("ArrowRight"); await page.keyboard.press("ArrowRight"); });
      assert.ok(await gap() > 0.3);
      await page.close();
    },
    async "a dragged corner follows the pointer, and changes slant and thickness"() {
      const page = await explore(SIZES[0]), grip = async () => { const { x, y, width, height } = await page.locator("#live-handle-slant .grip").boundingBox(); return [x + width / 2, y + height / 2]; };
      const parameters = () => page.evaluate(() => [squama.live.value("slant_deg"), squama.live.value("thickness_mm"), squama.live.value("gap_over_t") * squama.live.millimetres()]);
      const [x, y] = await grip(), [slant, thickness, gap] = await parameters();
      await page.mouse.move(x, y);
      await page.mouse.down();
      for (let step = 1; step <= 10; step++) { await page.mouse.move(x - 3 * step, y - 2 * step); await page.waitForTimeout(20); }
      const [left, top] = await grip(), [less, thicker, same] = await parameters();
      assert.ok(Math.abs(left - x + 30) < 1.5 && Math.abs(top - y + 20) < 1.5, `${left - x} ${top - y}`);
      assert.ok(less < slant && thicker > thickness && Math.abs(same - gap) < 1e-5, `${less} ${thicker} ${same - gap}`);
      await page.mouse.up();
      await settled(page);
      await page.close();
    },
    async "an improvement arrow moves the design in one direction up to a limit, and the page names the limit"() {
      const page = await explore(SIZES[0]);
      const before = (await values(page)).failure_force;
      const arrow = page.locator(".control", { hasText: "Length" }).locator(".arrow");
      await page.evaluate(() => { globalThis.seen = []; squama.live.listen("moved", () => globalThis.seen.push(squama.live.value("length_over_t"))); });
      await after(page, () => arrow.click());
      const seen = await page.evaluate(() => globalThis.seen), signs = seen.slice(1).map((own, k) => Math.sign(own - seen[k]));
      assert.ok(seen.length > 10 && signs.every((sign) => sign === 0 || sign === signs.find(Boolean)), `${seen.length} steps`);
      assert.ok((await values(page)).failure_force >= before);
      assert.match(await page.locator("#live-said").textContent(), /^Length: /);
      await page.close();
    },
    async "on a phone the sheet leaves the skin and the needle visible"() {
      const page = await explore(SIZES[1]);
      await page.locator("#live-sheet").click();
      const sheet = (await page.locator("#live .sheet").boundingBox()).y;
      for (const id of ["live-rest", "live-needle"]) {
        const { y, height } = await page.locator(`#${id}`).boundingBox();
        assert.ok(y >= 0 && y + height <= sheet, `${id} from ${y} to ${y + height}, the sheet at ${sheet}`);
      }
      assert.ok(await page.locator("#live-set-gap_over_t").isVisible());
      await page.close();
    },
    async "a pinned design is compared, and the address contains the design"() {
      const page = await explore(SIZES[0]);
      await page.locator("#live-pin").click();
      await after(page, () => page.evaluate(() => squama.live.set({ slant_deg: 20 })));
      assert.match(await page.locator("#live-cards").textContent(), /% compared with the pinned design/);
      assert.ok(await page.locator("#live-rest .ghost").count() > 2);
      const address = await page.evaluate(() => location.hash), own = await values(page);
      const other = await explore(SIZES[0], address);
      assert.equal((await values(other)).critical_force, own.critical_force);
      await after(page, () => page.locator("#live-closest").click());
      const closest = await values(page);
      assert.ok([0.1, 0.2, 0.3, 0.4].includes(closest.gap_over_t) && [15, 30].includes(closest.slant_deg));
      for (const one of [page, other]) await one.close();
    },
    async "cards show a radius and both depths, with and without a thickness in mm"() {
      for (const [file, unit, radius] of [["explore.html", "mm", (own) => own.bend_radius_mm], ["plain.html", "t", (own) => 1 / own.contact_curvature]]) {
        const page = await openFile(join(place, file));
        await settled(page);
        const own = await values(page), card = (name) => page.locator(`#live [data-measure=${name}]`).textContent();
        const written = (number) => `${Number(number.toPrecision(4))} ${unit}`;
        assert.ok((await card("contact_curvature")).includes(`Bends freely to${written(radius(own))}`), await card("contact_curvature"));
        const depth = (name) => own[`${name}_mm`] ?? own[name];
        assert.ok((await card("penetration")).includes(`Penetration of bases${written(depth("penetration"))}`), await card("penetration"));
        assert.ok((await card("critical_displacement")).includes(`Needle depth${written(depth("critical_displacement"))}`), await card("critical_displacement"));
        // Arrows cannot improve a measure without a goal.
        assert.equal(await page.locator("#live-cards div[data-measure=critical_displacement]").count(), 1);
        await page.close();
      }
    },
    async "requirements are listed, and the drawings follow the chosen points of both paths"() {
      const page = await explore(SIZES[0]);
      assert.equal(await page.locator("#live-required li").count(), 2);
      const words = () => page.locator("#live-needle-words").textContent();
      const far = await words();
      await after(page, () => page.evaluate(() => squama.live.draw(0, 0.3)));
      assert.notEqual(await words(), far);
      await after(page, () => page.evaluate(() => squama.live.draw(1, 0.1)));
      assert.match(await page.locator("#live-bent-words").textContent(), /radius of [\d.]+ mm/);
      await page.close();
    },
    async "on the page of a run a selected design opens in the explorer"() {
      const page = await open(results);
      await settled(page);
      for (const row of [3, 40]) {
        await after(page, () => page.evaluate((own) => squama.choose(own), row));
        const [own, table] = [await values(page), await page.evaluate((one) => ["critical_force", "coverage", "compliance"].map((name) => squama.cell(one, name)), row)];
        ["critical_force", "coverage", "compliance"].forEach((name, k) => same(own[name], table[k], name));
      }
      await page.close();
    },
    async "the explorer is smaller than 0.9 MB and the report smaller than 2 MB"() {
      assert.ok(statSync(join(place, "explore.html")).size < 900_000, String(statSync(join(place, "explore.html")).size));
      assert.ok(statSync(join(results, "report.html")).size < 2_000_000);
    },
  };
};

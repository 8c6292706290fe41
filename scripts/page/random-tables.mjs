// The ranking of the page against that of the command, on random tables.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import vm from "node:vm";
import { table } from "./browser.mjs";

const TABLES = Number(process.env.TABLES ?? 1000);
const COLUMNS = ["coverage", "critical_force", "penetration", "compliance"];

/** The scripts of the page that rank, without the page. */
const scripts = () => {
  const source = ["ranking", "weightings"].map((name) => readFileSync(`crates/report/assets/page/scripts/${name}.js`, "utf8"));
  return vm.runInNewContext(`const squama = {}; ${source.join("\n")}; squama`);
};

/** A generator with a seed of its own, so that a failure comes again. */
const generator = (seed) => () => {
  seed = (1103515245 * seed + 12345) % 2147483648;
  return seed / 2147483648;
};

/** Designs with ties, gaps, zeros and values over decades. */
const randomDesigns = (random) => Array.from({ length: 2 + Math.floor(25 * random()) }, (_, k) => {
  const cell = (zero) => {
    if (random() < 0.06) return "";
    if (random() < zero) return "0";
    return String(random() < 0.4 ? Math.ceil(4 * random()) / 4 : Number((10 ** (6 * random() - 3)).toPrecision(6)));
  };
  return { design: String(k + 1).padStart(4, "0"), coverage: random() < 0.2 ? "0" : String(Math.ceil(20 * random()) / 20), critical_force: cell(0.02), penetration: cell(0.02), compliance: cell(0.02) };
});

/** Rows as the scripts of the page see a table. */
const asTable = (rows) => ({
  rows: rows.map((_, row) => row),
  has: (name) => name in rows[0],
  cell: (row, name) => rows[row][name] || null,
  numbers: (name) => Float64Array.from(rows, (row) => (row[name] === "" ? NaN : Number(row[name]))),
});

const randomWeights = (random) => {
  const parts = COLUMNS.map(() => (random() < 0.2 ? 0 : Math.ceil(100 * random())));
  const sum = parts.reduce((a, b) => a + b, 0) || 1;
  const hundredths = parts.map((part) => Math.floor((100 * part) / sum));
  hundredths[0] += 100 - hundredths.reduce((a, b) => a + b, 0);
  return hundredths.map((part) => part / 100);
};

export default ({ place, squama }) => ({
  async "on random tables the page ranks as the command: order, fitness, winners, front"() {
    const { ranking, weightings } = scripts(), random = generator(20211121), folder = join(place, "random");
    mkdirSync(folder, { recursive: true });
    let ranked = 0;
    for (let round = 0; round < TABLES; round++) {
      const rows = randomDesigns(random), weights = randomWeights(random), own = asTable(rows);
      writeFileSync(join(folder, "designs.csv"), ["design", ...COLUMNS].join() + "\n" + rows.map((row) => Object.values(row).join()).join("\n") + "\n");
      const criteria = ranking.PAPER.map((text) => ranking.criterion(own, text));
      const contest = ranking.contest(own, own.rows, criteria, "paper");
      let failed = null;
      try { execFileSync(squama, ["rank", folder, "--weights", weights.join(",")], { stdio: "pipe" }); } catch (error) { failed = error; }
      const what = `table ${round}, weights ${weights}`;
      assert.equal(failed !== null, contest.rows.length === 0, `${what}: ${failed}`);
      if (failed) continue;
      ranked++;
      const numbers = (all) => [...all].map((row) => rows[row].design);
      const order = ranking.order(contest, weights), expected = table(folder, "ranking.csv");
      assert.deepEqual(numbers(order.map(({ row }) => row)), expected.map(({ design }) => design), what);
      order.forEach(({ fitness }, k) => assert.ok(Math.abs(fitness - Number(expected[k].fitness)) < 1e-12, what));
      assert.deepEqual(numbers(weightings.winners(contest).regions.map(({ row }) => row)), table(folder, "winners.csv").map(({ design }) => design), what);
      assert.deepEqual(numbers(ranking.front(contest)).sort(), table(folder, "pareto.csv").map(({ design }) => design).sort(), what);
    }
    assert.ok(ranked > 0.8 * TABLES, `${ranked} tables were ranked`);
  },
});

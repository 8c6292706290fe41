// Compares the rankings of the page and the command on random tables.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import vm from "node:vm";
import { table } from "./browser.mjs";

const TABLES = Number(process.env.TABLES ?? 1000);
const COLUMNS = ["coverage", "critical_force", "penetration", "compliance"];

/** Loads the ranking scripts of the page without the page. */
const scripts = () => {
  const source = ["ranking", "weightings"].map((name) => readFileSync(`crates/apps/report/assets/page/scripts/${name}.js`, "utf8"));
  return vm.runInNewContext(`const squama = { measures: ${JSON.stringify(COLUMNS)}, criteria: ${JSON.stringify(COLUMNS.map((column) => ({ column, goal: column === "penetration" ? "min" : "max" })))} }; ${source.join("\n")}; squama`);
};

/** Creates a seeded random generator, so that failures can be reproduced. */
const generator = (seed) => () => {
  seed = (1103515245 * seed + 12345) % 2147483648;
  return seed / 2147483648;
};

/** Draws a table of designs with ties, empty cells, zeros and values over several decades. */
const randomDesigns = (random) => Array.from({ length: 2 + Math.floor(25 * random()) }, (_, k) => {
  const cell = (zero) => {
    if (random() < 0.06) return "";
    if (random() < zero) return "0";
    return String(random() < 0.4 ? Math.ceil(4 * random()) / 4 : Number((10 ** (6 * random() - 3)).toPrecision(6)));
  };
  return { design: String(k + 1).padStart(4, "0"), coverage: random() < 0.2 ? "0" : String(Math.ceil(20 * random()) / 20), critical_force: cell(0.02), penetration: cell(0.02), compliance: cell(0.02) };
});

/** Wraps rows in the table interface that the scripts of the page use. */
const asTable = (rows) => ({
  rows: rows.map((_, row) => row),
  has: (name) => name in rows[0],
  cell: (row, name) => rows[row][name] || null,
  numbers: (name) => Float64Array.from(rows, (row) => (row[name] === "" ? NaN : Number(row[name]))),
});

const pick = (random, all) => all[Math.floor(random() * all.length)];

/** Draws requirements, criteria, weights and a scale; in half of the cases those of the paper. */
const randomChoice = (random, rows) => {
  const columns = random() < 0.5 ? null : COLUMNS.filter(() => random() < 0.7);
  const criteria = columns?.length > 0 ? columns.map((column) => `${random() < 0.5 ? "max" : "min"}:${column}`) : null;
  const requirements = Array.from({ length: Math.floor(2.5 * random()) }, () => {
    const column = pick(random, COLUMNS);
    return `${column} ${pick(random, [">=", "<=", ">", "<", "=="])} ${Number(pick(random, rows)[column] || 0.5)}`;
  });
  const parts = (criteria ?? COLUMNS).map(() => (random() < 0.2 ? 0 : Math.ceil(100 * random())));
  parts[0] ||= 1;
  return { criteria, requirements, parts, scale: pick(random, ["paper", "paper", "linear", "log"]) };
};

const command = (folder, { criteria, requirements, weights, scale }) => ["rank", folder, ...requirements.flatMap((one) => ["--require", one]),
  ...(criteria ? ["--criteria", criteria.join(",")] : []), "--weights", weights.join(","), "--scale", scale];

/** Compares page and command for one table; returns true if the table could be ranked. */
const compare = ({ ranking, weightings }, squama, folder, rows, choice, what) => {
  const own = asTable(rows), criteria = (choice.criteria ?? ranking.USUAL).map((text) => ranking.criterion(own, text));
  const requirements = choice.requirements.map((text) => ranking.requirement(own, text));
  const meeting = ranking.meeting(own, requirements), contest = ranking.contest(own, meeting, criteria, choice.scale);
  let said = null;
  try { execFileSync(squama, command(folder, choice), { stdio: "pipe" }); } catch (error) { said = `${error.stdout}${error.stderr}`; }
  assert.equal(said !== null, contest.rows.length === 0, `${what}: ${said}`);
  const numbers = (all) => [...all].map((row) => rows[row].design);
  if (said !== null) {
    const { nearest } = ranking.unmet(own, own.rows, requirements);
    if (meeting.length === 0 && nearest !== null) assert.match(said, new RegExp(`\\b${rows[nearest].design}\\b`), `${what}: nearest`);
    return false;
  }
  const order = ranking.order(contest, choice.weights), expected = table(folder, "ranking.csv");
  assert.deepEqual(numbers(order.map(({ row }) => row)), expected.map(({ design }) => design), what);
  order.forEach(({ fitness, rank }, k) => {
    assert.ok(Math.abs(fitness - Number(expected[k].fitness)) < 1e-12, what);
    assert.equal(rank, Number(expected[k].rank), what);
  });
  assert.deepEqual(numbers(ranking.front(contest)).sort(), table(folder, "pareto.csv").map(({ design }) => design).sort(), what);
  if (criteria.length === 4) assert.deepEqual(numbers(weightings.winners(contest).regions.map(({ row }) => row)), table(folder, "winners.csv").map(({ design }) => design), what);
  return true;
};

export default ({ place, squama }) => ({
  async "page and command agree on random tables: requirements, order, ranks, fitness, winners, front, nearest"() {
    const own = scripts(), random = generator(20211121), folder = join(place, "random");
    mkdirSync(folder, { recursive: true });
    let ranked = 0;
    for (let round = 0; round < TABLES; round++) {
      const rows = randomDesigns(random), choice = randomChoice(random, rows);
      const sum = choice.parts.reduce((a, b) => a + b, 0);
      choice.weights = choice.parts.map((part) => part / sum);
      writeFileSync(join(folder, "designs.csv"), ["design", ...COLUMNS].join() + "\n" + rows.map((row) => Object.values(row).join()).join("\n") + "\n");
      ranked += compare(own, squama, folder, rows, choice, `table ${round}: ${JSON.stringify(choice)}`);
    }
    assert.ok(ranked > 0.5 * TABLES, `${ranked} tables were ranked`);
  },
});

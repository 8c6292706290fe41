"use strict";
// The designs that a search has found between those of the grid: a front over the grid's designs, and a table.

(() => {
  const { found, ranking } = squama;
  if (!found) return;
  const MARK = "M0 -8 L8 0 L0 8 L-8 0 Z";
  const rows = Array.from({ length: found.count }, (_, k) => k);
  const cell = (k, name) => found.values[name]?.[k] ?? null;
  const numbers = (name) => Float64Array.from(rows, (k) => (typeof cell(k, name) === "number" ? cell(k, name) : NaN));
  const columns = [...new Set([...found.variables, ...found.objectives.map(({ column }) => column), ...found.requirements.map(({ column }) => column)])];
  const isFront = found.objectives.length > 1;

  /** Designs of the grid that could have been found: those that keep the bounds of the search. */
  const could = new Set(ranking.meeting(squama, found.requirements.filter(({ column }) => squama.has(column)), (row) => !(found.sound && squama.folded(row))));

  /** Whether the design that was found is at least as good as one of the grid in every objective, and better in one. */
  const beats = (k, row) => {
    const better = found.objectives.map(({ column, goal }) => {
      const [own, other] = [cell(k, column), squama.numbers(column)[row]];
      return ranking.same(own, other) ? 0 : (goal === "max" ? 1 : -1) * Math.sign(own - other);
    });
    return better.every((sign) => sign >= 0) && better.some((sign) => sign > 0);
  };

  const words = () => {
    const objectives = found.objectives.map(({ column, goal }) => `${goal === "max" ? "largest" : "least"} ${squama.label(column)}`).join(" and ");
    const bounds = found.requirements.map(ranking.written).join(", ");
    const judged = [...could].filter((row) => found.objectives.every(({ column }) => !Number.isNaN(squama.numbers(column)[row])));
    const beaten = judged.filter((row) => rows.some((k) => beats(k, row))).length;
    const grid = judged.length === 0 ? "No design of the grid keeps them." : `Of the ${judged.length} designs of the grid that keep them, ${beaten === judged.length ? "all" : beaten} are beaten by one that was found.`;
    const made = found.made.length === 0 ? "" : ` Judged by what is made of each design, ${found.made.join(" and ")}, which stand in the table with their 95 % intervals; everything else shows designs as they are drawn.`;
    return `${isFront ? `${found.count} designs of a front` : "The best design"} between those of the grid, from ${found.folder}: ${objectives}${bounds === "" ? "" : `; ${bounds}`}${found.sound ? "; the surface does not fold" : ""}.${made} ${grid}`;
  };
  squama.at("front-words").textContent = words();
  squama.at("front-differences").hidden = found.differences.length === 0;
  squama.at("front-differences").textContent = `⚠ The search does not solve what the grid solves: ${found.differences.join(", ")}.`;

  const value = (k, name) => squama.short(cell(k, name));
  const title = (k) => `${isFront ? `Front ${k + 1}` : "Optimum"}: ${columns.map((name) => `${squama.label(name)} ${value(k, name)}`).join(", ")}`;
  const tip = (k) => squama.element("div", {}, title(k), " ", squama.element("small", {}, `Held by ${cell(k, "binding") || "nothing"}.`, ...(cell(k, "prices") ? [` ${cell(k, "prices")}`] : [])));

  /** Axes in pairs, a panel each. */
  const pairs = found.axes.flatMap((a, i) => found.axes.slice(i + 1).map((b) => [a, b]));
  const make = (width) => {
    const margin = { left: 70, right: 12, top: 12, bottom: 48 }, theme = squama.themeNow;
    const { places, height } = squama.panel.grid(pairs.length, width, { least: 300, height: pairs.length > 1 ? 260 : 360, gaps: [72, 62], margin });
    const faint = (row) => ({ row, path: "M-4 0 A4 4 0 1 1 4 0 A4 4 0 1 1 -4 0 Z", size: could.has(row) ? 5 : 4, color: could.has(row) ? theme.grey : theme.line, kind: "filled", silent: true });
    const panels = places.map((place, p) => {
      const [a, b] = pairs[p], [x, y] = [squama.numbers(a), squama.numbers(b)], [fx, fy] = [numbers(a), numbers(b)];
      const grid = squama.rows.filter((row) => !Number.isNaN(x[row]) && !Number.isNaN(y[row])).sort((one, other) => could.has(one) - could.has(other));
      const marks = [...grid.map((row) => ({ ...faint(row), x: x[row], y: y[row] })), ...rows.map((k) => ({ row: null, tip: k, x: fx[k], y: fy[k], path: MARK, size: 8, color: theme.front, kind: "filled" }))];
      const points = [...rows].sort((one, other) => fx[one] - fx[other]).map((k) => [fx[k], fy[k]]);
      const lines = found.objectives.length === 2 ? [{ color: theme.front, width: 2, points }] : [];
      return { ...place, x: found.axesOf[a], y: found.axesOf[b], xTicks: true, yTicks: true, xName: squama.axisName(a), yName: squama.axisName(b), marks, lines };
    });
    return { panels, height, rows: squama.rows };
  };
  squama.at("front").hidden = false;
  squama.at("front-link").hidden = false;
  squama.addChart({
    id: "front", into: squama.at("front-figure"), title: isFront ? "The front over the designs of the grid" : "The best design over those of the grid",
    description: "Diamonds: found by the search. Grey: designs of the grid; pale: those that do not keep the bounds of the search.", make, tip, says: (row) => found.axes.map((name) => `${squama.label(name)} ${squama.short(squama.cell(row, name))}`).join(", "),
  });

  const within = (k, name) => `${value(k, name)} (${value(k, `${name}_low`)} to ${value(k, `${name}_high`)})`;
  const head = [isFront ? "front" : "", ...columns.map(squama.label), ...found.made, "held by, and what that costs"];
  squama.at("front-table").append(
    squama.element("thead", {}, squama.element("tr", {}, ...head.map((text) => squama.element("th", { scope: "col" }, text)))),
    squama.element("tbody", {}, ...rows.map((k) => squama.element("tr", {}, squama.element("td", {}, String(k + 1)), ...columns.map((name) => squama.element("td", {}, value(k, name))), ...found.made.map((name) => squama.element("td", {}, within(k, name))),
      squama.element("td", { class: "words" }, cell(k, "binding") ?? "–", ...(cell(k, "prices") ? [squama.element("small", {}, ` (${cell(k, "prices")})`)] : []))))));
})();

// Designs found by a search: figure with the designs of the grid, and table.

(() => {
  const { found, ranking } = squama;
  if (!found) return;
  const rows = Array.from({ length: found.count }, (_, k) => k);
  const cell = (k, name) => found.values[name]?.[k] ?? null;
  const columns = [...new Set([...found.variables, ...found.objectives.map(({ column }) => column), ...found.requirements.map(({ column }) => column)])];
  const isFront = found.objectives.length > 1;

  /** Designs of the grid that meet the requirements of the search. */
  const feasible = new Set(ranking.meeting(squama, found.requirements.filter(({ column }) => squama.has(column)), (row) => !(found.sound && squama.folded(row))));

  /** Returns true if the found design dominates a design of the grid. */
  const dominates = (k, row) => {
    const better = found.objectives.map(({ column, goal }) => {
      const [own, other] = [cell(k, column), squama.numbers(column)[row]];
      return ranking.same(own, other) ? 0 : (goal === "max" ? 1 : -1) * Math.sign(own - other);
    });
    return better.every((sign) => sign >= 0) && better.some((sign) => sign > 0);
  };

  const words = () => {
    const objectives = found.objectives.map(({ column, goal }) => `${goal === "max" ? "largest" : "least"} ${squama.label(column)}`).join(" and ");
    const bounds = found.requirements.map(ranking.written).join(", ");
    const judged = [...feasible].filter((row) => found.objectives.every(({ column }) => !Number.isNaN(squama.numbers(column)[row])));
    const dominated = judged.filter((row) => rows.some((k) => dominates(k, row))).length;
    const grid = judged.length === 0 ? "No design of the grid meets them." : `Of the ${judged.length} designs of the grid that meet them, ${dominated === judged.length ? "all" : dominated} are dominated by a design found.`;
    const made = found.made.length === 0 ? "" : ` The search used statistics over samples, ${found.made.join(" and ")}, which the table lists with their 95 % intervals; all other values are nominal.`;
    return `${isFront ? `Front of ${found.count} designs` : "Best design"} found by the search in ${found.folder}: ${objectives}${bounds === "" ? "" : `; ${bounds}`}${found.sound ? "; the surface does not fold" : ""}.${made} ${grid}`;
  };
  squama.at("front-words").textContent = words();
  squama.at("front-differences").hidden = found.differences.length === 0;
  squama.at("front-differences").textContent = `⚠ Fixed parameters of the search differ from the grid: ${found.differences.join(", ")}.`;

  const value = (k, name) => squama.short(cell(k, name));
  const title = (k) => `${isFront ? `Front ${k + 1}` : "Optimum"}: ${columns.map((name) => `${squama.label(name)} ${value(k, name)}`).join(", ")}`;
  const tip = (k) => squama.element("div", {}, title(k), " ", squama.element("small", {}, `Active constraints: ${cell(k, "binding") || "none"}.`, ...(cell(k, "prices") ? [` ${cell(k, "prices")}`] : [])));

  const take = (k) => squama.take(found.variables.map((name) => [name, cell(k, name)]));

  squama.at("front").hidden = false;
  squama.at("front-link").hidden = false;
  squama.addChart({
    id: "front", into: squama.at("front-figure"), title: isFront ? "The front over the designs of the grid" : "The best design over the designs of the grid",
    description: "Diamonds: found by the search. Grey: designs of the grid; pale: outside the bounds of the search. Click a diamond to open it in the explorer.", tip, take, passes: (row) => feasible.has(row), columns: () => found.axes,
  });

  const within = (k, name) => `${value(k, name)} (${value(k, `${name}_low`)} to ${value(k, `${name}_high`)})`;
  const head = [isFront ? "front" : "", ...columns.map(squama.label), ...found.made, "active constraints (price)"];
  squama.at("front-table").append(
    squama.element("thead", {}, squama.element("tr", {}, ...head.map((text) => squama.element("th", { scope: "col" }, text)))),
    squama.element("tbody", {}, ...rows.map((k) => squama.element("tr", { "data-found": k, ...squama.pressed(() => take(k)) }, squama.element("td", {}, String(k + 1)), ...columns.map((name) => squama.element("td", {}, value(k, name))), ...found.made.map((name) => squama.element("td", {}, within(k, name))),
      squama.element("td", { class: "words" }, cell(k, "binding") ?? "–", ...(cell(k, "prices") ? [squama.element("small", {}, ` (${cell(k, "prices")})`)] : []))))));
})();

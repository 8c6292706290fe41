// Summary and failures.

(() => {
  const GROUPS = 4;
  squama.at("title").textContent = `${squama.name}: ${squama.count} designs`;
  const facts = (id, pairs) => squama.at(id).replaceChildren(...pairs.flatMap(([name, ...value]) => [squama.element("dt", {}, name), squama.element("dd", {}, ...value)]));
  const button = (row) => squama.element("button", { type: "button", onclick: () => squama.choose(row) }, ...squama.warning(row), squama.title(row));

  /** Describes the best design by a column, its ties and, if it has a fold, the best without a fold. */
  const bestOf = (all, name, column, goal) => {
    const numbers = squama.numbers(column), sign = goal === "max" ? 1 : -1;
    const leader = (rows) => rows.reduce((a, b) => (a === null || sign * numbers[b] > sign * numbers[a] && !squama.ranking.same(numbers[a], numbers[b]) ? b : a), null);
    const rows = all.filter((row) => !Number.isNaN(numbers[row]));
    const first = leader(rows);
    if (first === null) return [];
    const ties = rows.filter((row) => squama.ranking.same(numbers[row], numbers[first])).length - 1;
    const sound = squama.folded(first) && column.startsWith(squama.criticalForce) ? leader(rows.filter((row) => !squama.folded(row))) : null;
    return [[name, `${squama.short(numbers[first])}${squama.failing(column, first)}  `, button(first), ties > 0 ? ` and ${ties} ${ties > 1 ? "others" : "other"} as good` : "",
      ...(sound === null ? [] : [squama.element("br"), `without a fold: ${squama.short(numbers[sound])}  `, button(sound)])]];
  };

  /** Shows the best design by a column for each group of comparable designs. */
  const best = (name, column, goal) => {
    if (!squama.has(column)) return [];
    const differing = squama.comparable.differing(squama.rows, [{ column }]).map(({ parameter }) => parameter);
    const groups = squama.comparable.groups(squama.rows, [{ column }]);
    if (groups.length > GROUPS) return [[name, `not comparable between designs of different ${differing.map(squama.label).join(" and ")}`]];
    const words = (row) => differing.map((parameter) => `, ${squama.label(parameter)} ${squama.short(squama.cell(row, parameter))}`).join("");
    return groups.flatMap((rows) => bestOf(rows, `${name}${words(rows[0])}`, column, goal));
  };

  const folds = () => (squama.foldedRows.length > 0 ? [["valid critical force", `${squama.count - squama.foldedRows.length} designs; of ${squama.foldedRows.length}, marked ⚠, the surface folds before the critical tilt, so their critical force is not valid`]] : []);

  /** Shows the best design by a measure, in newtons or millimetres if the table has such a column. */
  const inUnits = (name, measure, goal) => {
    const column = squama.inUnits[measure] ?? measure;
    return best(column === measure ? name : `${name}, ${column.split("_").at(-1)}`, column, goal);
  };

  facts("summary-list", [
    ...best("best coverage", squama.coverage, "max"),
    ...inUnits("largest critical force", squama.criticalForce, "max"),
    ...inUnits("largest failure force", squama.failureForce, "max"),
    ...inUnits("least penetration of the bases", squama.penetration, "min"),
    ...best("largest compliance", squama.compliance, "max"),
    ...best("smallest bend radius, mm", "bend_radius_mm", "min"),
    ...best("least areal mass, kg/m²", squama.mass, "min"),
    ["covered designs", String(squama.numbers(squama.coverage).filter((value) => value > 0).length)],
    ["on the Pareto front", squama.element("span", { id: "front-count" }, "…")],
    ...folds(),
  ]);
  squama.at("notes").replaceChildren(...squama.notes.map((text) => squama.element("p", { class: "doubt" }, `⚠ ${text}`)));
  facts("run-list", squama.run);
  facts("shared-list", squama.shared.map(([key, value, meaning]) => [`${meaning} (${key})`, value]));

  let timer = null;
  squama.listen("selection", () => {
    clearTimeout(timer);
    timer = setTimeout(() => { squama.at("front-count").textContent = `${squama.ranking.front(squama.contest).size} of ${squama.contest.rows.length} that are ranked`; }, 120);
  });

  const statuses = squama.names.filter((name) => name.endsWith("_status"));
  const failed = squama.rows.flatMap((row) => statuses
    .filter((name) => { const text = squama.cell(row, name); return text !== null && text !== "complete"; })
    .map((name) => ({ row, measure: name.replace("_status", ""), reason: squama.cell(row, name) })));
  const list = squama.at("failure-list");
  if (failed.length === 0) {
    list.append(squama.element("p", {}, "None: every design has all requested values."));
  } else {
    list.append(squama.element("div", { class: "wide" }, squama.element("table", {},
      squama.element("thead", {}, squama.element("tr", {}, ...["design", "measure", "reason"].map((text) => squama.element("th", { scope: "col" }, text)))),
      squama.element("tbody", {}, ...failed.map(({ row, measure, reason }) => squama.element("tr", { "data-row": row, ...squama.chooser(row) },
        squama.element("td", {}, squama.title(row)), squama.element("td", {}, measure), squama.element("td", {}, reason)))))));
  }
})();

"use strict";
// Summary, failures, theme; and the design that is shown first.

(() => {
  document.getElementById("title").textContent = `${squama.name}: ${squama.rows.length} designs`;
  const facts = (id, pairs) => document.getElementById(id).replaceChildren(...pairs.flatMap(([name, value]) => [
    squama.element("dt", {}, name), squama.element("dd", {}, value)]));

  const best = (name, column, better) => {
    const rows = squama.rowsWith(column);
    if (rows.length === 0) return [];
    const row = rows.reduce((a, b) => (better(squama.cell(b, column), squama.cell(a, column)) ? b : a));
    const button = squama.element("button", { type: "button", onclick: () => squama.choose(row) }, squama.title(row));
    return [[name, squama.element("span", {}, `${squama.short(squama.cell(row, column))}  `, button)]];
  };
  const more = (a, b) => a > b, less = (a, b) => a < b;
  facts("summary-list", [
    ...squama.run.map(({ name, value }) => [name, value]),
    ["covered designs", String(squama.rowsWith("coverage").filter((row) => squama.cell(row, "coverage") > 0).length)],
    ["on the Pareto front", String(squama.front.size)],
    ...best("best coverage", "coverage", more),
    ...best("largest critical force", "critical_force", more),
    ...best("least penetration", "penetration", less),
    ...best("largest compliance", "compliance", more),
  ]);
  facts("shared-list", squama.shared.map(({ key, value, meaning }) => [`${meaning} (${key})`, value]));

  const statuses = squama.columns.map(({ name }) => name).filter((name) => name.endsWith("_status"));
  const failed = squama.rows.map((_, row) => row).flatMap((row) => statuses
    .filter((name) => { const text = squama.cell(row, name); return text !== null && text !== "complete"; })
    .map((name) => ({ row, measure: name.replace("_status", ""), reason: squama.cell(row, name) })));
  const list = document.getElementById("failure-list");
  if (failed.length === 0) {
    list.append(squama.element("p", {}, "None: every design that was asked for has every value."));
  } else {
    list.append(squama.element("table", {},
      squama.element("thead", {}, squama.element("tr", {}, ...["design", "measure", "reason"].map((text) => squama.element("th", { scope: "col" }, text)))),
      squama.element("tbody", {}, ...failed.map(({ row, measure, reason }) => squama.element("tr", { "data-row": row, ...squama.chooser(row) },
        squama.element("td", {}, squama.title(row)), squama.element("td", {}, measure), squama.element("td", {}, reason))))));
  }

  const button = document.getElementById("theme");
  const setTheme = (dark) => {
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    button.setAttribute("aria-pressed", String(dark));
    button.textContent = dark ? "Light" : "Dark";
    squama.redraw();
    squama.redrawTetrahedron?.();
  };
  button.addEventListener("click", () => setTheme(document.documentElement.dataset.theme !== "dark"));
  if (matchMedia("(prefers-color-scheme: dark)").matches) setTheme(true);

  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth === width) return;
    width = innerWidth;
    squama.redraw();
  });

  if (squama.rows.length > 0) squama.choose(squama.ranked.length > 0 ? squama.rank(squama.weights())[0].row : 0);
  squama.setFolded(true);
})();

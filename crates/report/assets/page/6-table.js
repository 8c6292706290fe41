"use strict";
// The table of designs: sorted by its headers, filtered by its second line.

(() => {
  const FIRST = 200;
  const shown = ["design", ...squama.axes, "coverage", "critical_force", "penetration", "compliance", "peak_force", "max_stiffness", "contacts", "flexure_contact", "membrane_strain_max", "puncture_status", "flexure_status"];
  const columns = [...new Set(shown)].filter((name) => squama.column(name) >= 0);
  const filters = new Map();
  let sort = { name: "design", down: false };
  let all = false;

  const table = document.getElementById("table");
  const body = squama.element("tbody");
  const buttons = new Map();
  const head = squama.element("tr", {}, ...columns.map((name) => {
    const { unit, meaning } = squama.columns[squama.column(name)];
    const button = squama.element("button", { type: "button", title: `${meaning}${unit === "-" ? "" : ` (${unit})`}`, onclick: () => sortBy(name) }, squama.label(name));
    const header = squama.element("th", { scope: "col" }, button);
    buttons.set(name, { button, header });
    return header;
  }));
  const filterRow = squama.element("tr", {}, ...columns.map((name) => squama.element("th", {},
    squama.element("input", { type: "text", "aria-label": `filter ${squama.label(name)}`, "data-column": name, oninput: (event) => { filters.set(name, event.target.value.trim()); show(); } }))));
  table.append(squama.element("thead", {}, head, filterRow), body);

  const sortBy = (name) => {
    sort = { name, down: sort.name === name ? !sort.down : false };
    show();
  };

  /** Whether a cell passes a filter. */
  const passes = (value, filter) => {
    if (filter === "") return true;
    const number = "[-+]?[0-9.]+(?:e[-+]?[0-9]+)?";
    const range = filter.match(new RegExp(`^(${number})\\.\\.(${number})$`, "i"));
    if (range) return typeof value === "number" && value >= Number(range[1]) && value <= Number(range[2]);
    const bound = filter.match(new RegExp(`^([<>]=?|=)\\s*(${number})$`, "i"));
    if (bound) {
      if (typeof value !== "number") return false;
      const limit = Number(bound[2]);
      return { "<": value < limit, "<=": value <= limit, ">": value > limit, ">=": value >= limit, "=": value === limit }[bound[1]];
    }
    if (typeof value === "number") return value === Number(filter);
    return String(value ?? "").toLowerCase().includes(filter.toLowerCase());
  };

  /** Order of two cells; those that do not exist come last either way. */
  const compare = (a, b) => {
    if (a === null || b === null) return (a === null) - (b === null);
    const order = typeof a === "number" && typeof b === "number" ? a - b : String(a) < String(b) ? -1 : String(a) > String(b) ? 1 : 0;
    return sort.down ? -order : order;
  };

  // One row at a time can be reached with Tab, the others from there with the arrow keys.
  const reach = () => {
    const rows = [...body.children];
    const here = rows.find((row) => row.classList.contains("chosen")) ?? rows[0];
    rows.forEach((row) => { row.tabIndex = row === here ? 0 : -1; });
  };

  const rowElement = (row) => squama.element("tr", { "data-row": row, tabindex: -1, class: row === squama.chosen ? "chosen" : "" },
    ...columns.map((name) => {
      const value = squama.cell(row, name);
      return squama.element("td", value === null ? {} : { title: String(value) }, squama.short(value));
    }));

  const show = () => {
    const active = [...filters].filter(([, filter]) => filter !== "");
    const rows = squama.rows.map((_, row) => row)
      .filter((row) => active.every(([name, filter]) => passes(squama.cell(row, name), filter)))
      .sort((a, b) => compare(squama.cell(a, sort.name), squama.cell(b, sort.name)) || a - b);
    const listed = all ? rows : rows.slice(0, FIRST);
    body.replaceChildren(...listed.map(rowElement));
    reach();
    for (const [name, { button, header }] of buttons) {
      const own = name === sort.name;
      header.setAttribute("aria-sort", own ? (sort.down ? "descending" : "ascending") : "none");
      button.textContent = squama.label(name) + (own ? (sort.down ? " ▼" : " ▲") : "");
    }
    document.getElementById("table-count").textContent = `${rows.length} of ${squama.rows.length} designs.`;
    const more = document.getElementById("more");
    more.hidden = listed.length === rows.length;
    more.textContent = `Show all ${rows.length} rows`;
  };

  body.addEventListener("click", (event) => {
    const row = event.target.closest("tr");
    if (row) squama.choose(Number(row.dataset.row));
  });
  body.addEventListener("keydown", (event) => {
    const row = event.target.closest("tr");
    if (event.key === "Enter" || event.key === " ") { event.preventDefault(); squama.choose(Number(row.dataset.row)); }
    const next = event.key === "ArrowDown" ? row.nextElementSibling : event.key === "ArrowUp" ? row.previousElementSibling : null;
    if (next) { event.preventDefault(); next.focus(); }
  });
  document.getElementById("more").addEventListener("click", () => { all = true; show(); });
  document.getElementById("clear-filters").addEventListener("click", () => {
    filters.clear();
    filterRow.querySelectorAll("input").forEach((input) => { input.value = ""; });
    show();
  });
  squama.onChoose.push((row) => {
    body.querySelectorAll("tr").forEach((element) => element.classList.toggle("chosen", Number(element.dataset.row) === row));
    reach();
  });
  show();
})();

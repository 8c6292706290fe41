// The table of designs. Its headers are buttons for sorting, and its second line contains filters.
// In long tables, only visible rows have elements.

(() => {
  const { state, filters } = squama;
  // Rows are taller for touch input.
  const coarse = matchMedia("(pointer: coarse), (max-width: 40rem)");
  const height = () => (coarse.matches ? 44 : 27);
  const AROUND = 12;
  const atFirst = [...new Set(["design", ...squama.axes, ...squama.shown.first, ...squama.names.filter(squama.physical), ...squama.names.filter((name) => name.endsWith("_p05")), ...squama.shown.last])].filter(squama.has);

  const table = squama.at("table"), scroll = table.parentElement;
  const body = squama.element("tbody"), head = squama.element("thead"), above = squama.element("tbody", { "aria-hidden": "true" }), below = squama.element("tbody", { "aria-hidden": "true" });
  table.append(head, above, body, below);
  let columns = [], headers = new Map(), rows = [];

  const chosenColumns = () => (state.columns === null ? atFirst : ["design", ...state.columns.split(",").filter((name) => squama.has(name) && name !== "design")]);

  const sorting = () => ({ name: state.sort.replace(/^-/, ""), down: state.sort.startsWith("-") });
  const sortBy = (name) => {
    state.sort = state.sort === name ? `-${name}` : name;
    show();
    squama.writeAddress();
  };

  /** Estimates the width of a column in characters, from its header and some of its cells. */
  const room = (name) => {
    const step = Math.max(1, Math.floor(squama.count / 300));
    const cells = squama.rows.filter((row) => row % step === 0).map((row) => squama.short(squama.cell(row, name)).length);
    return Math.max(6, squama.label(name).length + 3, ...cells) + (name === "design" ? 3 : 0);
  };

  const header = (name) => {
    const { unit, meaning } = squama.columns[squama.place.get(name)];
    const button = squama.element("button", { type: "button", title: `${meaning}${unit === "-" ? "" : ` (${unit})`}`, onclick: () => sortBy(name) }, squama.label(name));
    const cell = squama.element("th", { scope: "col" }, button);
    headers.set(name, { button, cell });
    return cell;
  };

  const filter = (name) => squama.element("input", { type: "text", "aria-label": `filter ${squama.label(name)}`, "data-column": name, oninput: (event) => {
    const requirements = filters.read(name, event.target.value.trim());
    event.target.setAttribute("aria-invalid", String(requirements === null));
    // Invalid input removes the requirement, so that only shown requirements have an effect.
    filters.set(name, requirements ?? []);
  } });

  const showHead = () => {
    columns = chosenColumns();
    headers = new Map();
    table.querySelector("colgroup")?.remove();
    const widths = columns.map((name) => room(name));
    table.prepend(squama.element("colgroup", {}, ...widths.map((width) => squama.element("col", { style: `width: ${width + 2}ch` }))));
    table.style.width = `${widths.reduce((sum, width) => sum + width + 2, 0)}ch`;
    head.replaceChildren(squama.element("tr", {}, ...columns.map(header)), squama.element("tr", {}, ...columns.map((name) => squama.element("th", {}, filter(name)))));
    for (const part of [above, below]) part.replaceChildren(squama.element("tr", {}, squama.element("td", { colspan: columns.length, class: "spacer" })));
  };

  /** Compares two rows by numbers; missing numbers are last in both directions. */
  const byNumbers = (numbers, sign) => (p, q) => {
    const [a, b] = [numbers[p], numbers[q]];
    if (a !== a || b !== b) return (a !== a) - (b !== b) || p - q;
    return sign * (a - b) || p - q;
  };

  /** Compares two rows by texts; missing texts are last in both directions. */
  const byTexts = (cells, sign) => (p, q) => {
    const [a, b] = [cells[p] ?? null, cells[q] ?? null];
    if (a === null || b === null) return (a === null) - (b === null) || p - q;
    return a === b ? p - q : sign * (String(a) < String(b) ? -1 : 1);
  };

  /** Returns the rows that meet the requirements, in the order of the table. */
  const sorted = () => {
    const { name, down } = sorting(), sign = down ? -1 : 1;
    const isNumeric = squama.numeric.includes(name) && name !== "design";
    return [...squama.meeting].sort(isNumeric ? byNumbers(squama.numbers(name), sign) : byTexts(squama.cells(name), sign));
  };

  const rowElement = (row, place) => squama.element("tr", { "data-row": row, "aria-rowindex": place + 3, tabindex: -1, class: [row === state.design ? "chosen" : "", row === state.pinned ? "pinned" : "", squama.folded(row) ? "folded" : ""].join(" ") },
    ...columns.map((name) => {
      const value = squama.cell(row, name);
      return squama.element("td", value === null ? {} : { title: String(value) }, ...(name === "design" ? squama.warning(row) : []), squama.short(value));
    }));

  // The Tab key reaches one row; from this row the arrow keys reach the other rows.
  const reach = () => {
    const elements = [...body.children];
    const here = elements.find((element) => element.classList.contains("chosen")) ?? elements[0];
    elements.forEach((element) => { element.tabIndex = element === here ? 0 : -1; });
  };

  let from = -1, to = -1;
  const window_ = () => {
    if (rows.length <= 150) return [0, rows.length];
    const first = Math.max(0, Math.floor(scroll.scrollTop / height()) - AROUND);
    return [first, Math.min(rows.length, first + Math.ceil(scroll.clientHeight / height()) + 2 * AROUND)];
  };

  /** Creates the elements of the visible rows, if other rows are visible than before. */
  const fill = (anew) => {
    const [first, last] = window_();
    if (!anew && first === from && last === to) return;
    [from, to] = [first, last];
    const focused = body.contains(document.activeElement) ? Number(document.activeElement.dataset.row) : null;
    body.replaceChildren(...rows.slice(first, last).map((row, k) => rowElement(row, first + k)));
    above.rows[0].cells[0].style.height = `${first * height()}px`;
    below.rows[0].cells[0].style.height = `${(rows.length - last) * height()}px`;
    [above.hidden, below.hidden] = [first === 0, last === rows.length];
    reach();
    if (focused !== null) body.querySelector(`[data-row="${focused}"]`)?.focus({ preventScroll: true });
  };

  const showHeaders = () => {
    const { name: by, down } = sorting();
    for (const [name, { button, cell }] of headers) {
      const own = name === by;
      cell.setAttribute("aria-sort", own ? (down ? "descending" : "ascending") : "none");
      button.textContent = squama.label(name) + (own ? (down ? " ▼" : " ▲") : "");
    }
    head.querySelectorAll("input").forEach((input) => {
      if (document.activeElement !== input) input.value = filters.text(input.dataset.column);
    });
  };

  const show = () => {
    if (columns.join() !== chosenColumns().join()) showHead();
    rows = sorted();
    table.setAttribute("aria-rowcount", rows.length + 2);
    fill(true);
    showHeaders();
    squama.at("table-count").textContent = `${rows.length} of ${squama.count} designs.`;
  };

  /** Focuses a row, and scrolls to it if necessary. */
  const focus = (place) => {
    if (place < 0 || place >= rows.length) return;
    const top = head.offsetHeight;
    if (place < from || place >= to) scroll.scrollTop = place * height() - scroll.clientHeight / 2 + top;
    fill();
    body.querySelector(`[data-row="${rows[place]}"]`)?.focus();
  };

  scroll.addEventListener("scroll", () => fill(), { passive: true });
  body.addEventListener("click", (event) => {
    const row = event.target.closest("tr");
    if (row) squama.choose(Number(row.dataset.row));
  });
  body.addEventListener("keydown", (event) => {
    const row = Number(event.target.closest("tr").dataset.row), place = rows.indexOf(row);
    if (event.key === "Enter" || event.key === " ") { event.preventDefault(); squama.choose(row); }
    const next = { ArrowDown: place + 1, ArrowUp: place - 1, Home: 0, End: rows.length - 1 }[event.key];
    if (next !== undefined) { event.preventDefault(); focus(next); }
  });
  squama.at("clear-filters").addEventListener("click", () => squama.require([]));

  const box = (name) => squama.element("label", {}, squama.element("input", { type: "checkbox", value: name, checked: chosenColumns().includes(name), onchange: () => {
    const ticked = [...squama.at("column-list").querySelectorAll("input:checked")].map(({ value }) => value);
    const wanted = squama.names.filter((one) => ticked.includes(one));
    state.columns = [...atFirst.filter((one) => wanted.includes(one)), ...wanted.filter((one) => !atFirst.includes(one))].filter((one) => one !== "design").join(",");
    show();
    squama.writeAddress();
  } }), ` ${squama.label(name)}`);
  squama.at("column-list").append(...squama.names.filter((name) => name !== "design").map(box));

  squama.listen("selection", show);
  squama.listen("design pinned", () => {
    body.querySelectorAll("tr").forEach((element) => {
      element.classList.toggle("chosen", Number(element.dataset.row) === state.design);
      element.classList.toggle("pinned", Number(element.dataset.row) === state.pinned);
    });
    reach();
  });
})();

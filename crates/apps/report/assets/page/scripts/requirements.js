// Requirements: bounds on designs, for ranking, tetrahedron, figures and table.

(() => {
  const { state, ranking } = squama;
  const list = squama.at("requirement-list"), text = squama.at("requirement-count"), adder = squama.at("add-requirement");
  const change = (k, part) => squama.require(state.requirements.map((one, other) => (other === k ? { ...one, ...part } : one)));

  const columns = (chosen) => squama.names.filter((name) => name !== "design" && (squama.numeric.includes(name) || name === chosen)).map((name) => [name, squama.label(name)]);

  /** Formats the smallest and the largest value of a column, as a hint. */
  const range = (column) => {
    const numbers = squama.numbers(column).filter((value) => !Number.isNaN(value));
    const [low, high] = numbers.reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
    return low <= high ? `${squama.short(low)} to ${squama.short(high)}` : "";
  };

  const row = (one, k) => {
    const label = squama.label(one.column), isText = one.sign === "~";
    return squama.element("li", {},
      squama.dropdown({ "aria-label": "Column", onchange: (event) => change(k, { column: event.target.value, sign: isText ? ">=" : one.sign, limit: isText ? 0 : one.limit }) }, columns(one.column), one.column),
      squama.dropdown({ "aria-label": `Relation of ${label} to its limit`, onchange: (event) => change(k, { sign: event.target.value }) },
        isText ? [["~", "has"]] : [[">=", "≥"], ["<=", "≤"], [">", ">"], ["<", "<"], ["==", "="]], one.sign),
      squama.element("input", { type: "text", inputmode: isText ? null : "decimal", value: one.limit, "aria-label": `Limit of ${label}`, oninput: (event) => {
        const limit = isText ? event.target.value : ranking.number(event.target.value), isRead = isText || Number.isFinite(limit);
        event.target.setAttribute("aria-invalid", String(!isRead));
        // Invalid input removes the limit, so that only limits that the page shows have an effect.
        change(k, { limit: isRead ? limit : null });
      } }),
      squama.element("small", {}, isText ? "" : range(one.column)),
      squama.element("button", { type: "button", "aria-label": `Remove the requirement on ${label}`, onclick: () => squama.require(state.requirements.filter((_, other) => other !== k)) }, "✕"));
  };

  // The list is rebuilt only if columns or signs change, so that an edited limit keeps the focus.
  const shape = () => JSON.stringify(state.requirements.map(({ column, sign }) => [column, sign]));
  let last = null;
  const showList = () => {
    if (shape() !== last) {
      last = shape();
      list.replaceChildren(...state.requirements.map(row));
    }
    list.querySelectorAll("input").forEach((input, k) => {
      const { limit } = state.requirements[k];
      if (document.activeElement !== input && limit !== null) input.value = limit;
    });
  };

  /** Returns a text on the nearest design and the binding requirements, if no design meets all. */
  const nearest = () => {
    const rows = squama.rows.filter((one) => !state.sound || !squama.folded(one));
    const { nearest: own, binding } = ranking.unmet(squama, rows, squama.required());
    const names = binding.map((one) => ranking.written(one)).join(" or ");
    return [
      "No design meets all of them. ",
      ...(own === null ? [] : ["The nearest is ", squama.element("button", { type: "button", onclick: () => squama.choose(own) }, squama.title(own)), ` with ${squama.required().filter(({ sign }) => sign !== "~").map(({ column }) => `${squama.label(column)} ${squama.short(squama.cell(own, column))}`).join(", ")}. `]),
      binding.length > 0 ? `The obstacle is ${names}: some designs meet all other requirements.` : "No single requirement is the obstacle: relax two or more.",
    ];
  };

  const show = () => {
    showList();
    const left = squama.meeting.length, unread = state.requirements.length - squama.required().length;
    const of = squama.required().length === 0 && !state.sound ? [`No requirements: all ${squama.count} designs are ranked.`]
      : left > 0 || squama.required().length === 0 ? [`${left} of ${squama.count} designs meet ${squama.required().length === 1 ? "it" : "them"}.`] : nearest();
    text.replaceChildren(...(unread > 0 ? [squama.element("strong", { class: "warning" }, "⚠ A limit that is not a number is ignored. ")] : []), ...of);
    squama.at("unread").hidden = squama.unread.length === 0;
    squama.at("unread").textContent = `⚠ Invalid requirements in the link are ignored: ${squama.unread.join("; ")}.`;
    squama.at("sound").checked = state.sound;
  };

  const first = [squama.coverage, `${squama.criticalForce}_N`, squama.criticalForce, ...squama.numeric].filter((name) => squama.numeric.includes(name) && name !== "design");
  adder.addEventListener("click", () => {
    const column = first.find((name) => !state.requirements.some((one) => one.column === name)) ?? first[0];
    const sign = ranking.plainGoal(squama, column) === "min" ? "<=" : ">=";
    // The initial limit is the median of the column.
    const numbers = squama.numbers(column).filter((value) => !Number.isNaN(value)).sort();
    squama.require([...state.requirements, { column, sign, limit: Number((numbers[Math.floor(numbers.length / 2)] ?? 0).toPrecision(2)) }]);
    list.querySelector("li:last-child input")?.focus();
  });
  squama.at("clear-requirements").addEventListener("click", () => {
    state.sound = false;
    squama.require([]);
  });
  squama.at("sound").addEventListener("change", (event) => {
    state.sound = event.target.checked;
    squama.refresh();
  });
  squama.at("sound-switch").hidden = squama.foldedRows.length === 0;
  squama.at("sound-count").textContent = `(${squama.foldedRows.length} of ${squama.count})`;
  squama.listen("selection", show);
})();

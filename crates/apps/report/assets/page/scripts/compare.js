// The pinned design beside the selected one: drawings, curves, numbers.

(() => {
  const { state } = squama;
  const section = squama.at("compare");
  const pair = () => [state.pinned, state.design];

  /** Formats the change from one number to another. */
  const ratio = (a, b) => {
    if (typeof a !== "number" || typeof b !== "number") return a === b ? "" : "≠";
    if (a === b) return "=";
    return a !== 0 && b / a > 0 ? `× ${squama.short(b / a)}` : squama.short(b - a).replace(/^(?=[0-9])/, "+");
  };

  const line = (rows) => ({ name, unit, meaning }) => {
    const [a, b] = rows.map((row) => squama.cell(row, name));
    return squama.element("tr", { class: a === b ? "same" : null }, squama.element("th", { scope: "row", title: meaning }, squama.label(name), ...squama.unit(name, unit)),
      ...[a, b].map((value) => squama.element("td", {}, `${squama.short(value)}${unit === "deg" && value !== null ? "°" : ""}`)), squama.element("td", {}, ratio(a, b)));
  };

  const numbers = (rows) => {
    const columns = squama.columns.filter(({ name }) => name !== "design" && rows.some((row) => squama.cell(row, name) !== null));
    squama.at("compare-numbers").replaceChildren(
      squama.element("thead", {}, squama.element("tr", {}, squama.element("th", { scope: "col" }, ""), ...rows.map((row) => squama.element("th", { scope: "col" }, ...squama.warning(row), squama.number(row))), squama.element("th", { scope: "col" }, "second to first"))),
      squama.element("tbody", {}, ...columns.map(line(rows))));
  };

  const drawings = (rows) => {
    const span = Math.max(...rows.map(squama.drawing.span));
    squama.at("compare-drawings").replaceChildren(...rows.map((row, k) => squama.element("div", {},
      squama.element("h3", {}, `${["Pinned", "Chosen"][k]}: `, squama.title(row)), ...squama.doubts(row).map((text) => squama.element("p", { class: "doubt" }, `⚠ ${text}`)), squama.drawing(row, span), ...squama.solvedDrawing(row))));
  };

  const drawing = squama.element("div", { class: "drawn", role: "img", "aria-label": "Curves of both designs: force against displacement, and moment against curvature." });
  const words = squama.element("div");
  const log = squama.element("input", { type: "checkbox", id: "log", onchange: (event) => { state.log = event.target.checked; curves(); squama.writeAddress(); } });
  const control = squama.element("label", {}, log, " Logarithmic force and moment");
  squama.at("compare-curves").append(control, drawing, words);

  /** Shows the curves of both designs if the page has them. The curve of the pinned design is dashed. */
  const curves = async () => {
    log.checked = state.log;
    const rows = pair(), missing = rows.filter((row) => !squama.solved(row)?.curves);
    control.hidden = drawing.hidden = missing.length === rows.length;
    words.replaceChildren(squama.element("p", { class: "note" }, `${missing.length > 0 ? `The page has the curves of only ${squama.drawings.length} designs: those that are best for some weights come first. ` : "Dashed: the pinned design. "}This command draws both with contacts, folds and energies:`),
      squama.command(`squama plot curves ${squama.folder}/run.toml --design ${[...new Set(rows.map(squama.number))].join(",")}`));
    const figure = squama.figures.find(({ kind, choice }) => kind === "curves" && (choice === "log") === state.log);
    if (!figure) return;
    drawing.innerHTML = await squama.unpacked(figure.svg).text();
    drawing.dataset.log = state.log;
    drawing.querySelectorAll(".panel").forEach(fit(rows));
  };

  /** Shows the curves of some designs in a panel, with the smallest axes that contain them. */
  const fit = (rows) => (panel) => {
    const shown = [...panel.querySelectorAll(".curve")].filter((curve) => rows.includes(squama.rowOf(curve.dataset.design)));
    const high = Object.fromEntries(["x", "y"].map((axis) => {
      const largest = Math.max(0, ...shown.map((curve) => Number(curve.dataset[axis]))), rungs = [...panel.querySelectorAll(`.rung[data-axis="${axis}"]`)];
      const rung = rungs.find((one) => Number(one.dataset.high) >= largest) ?? rungs.at(-1);
      rung.classList.add("on");
      return [axis, Number(rung.dataset.high)];
    }));
    for (const curve of shown) {
      const row = squama.rowOf(curve.dataset.design), [left, bottom] = panel.dataset.origin.split(" ").map(Number);
      const part = ["x", "y"].map((axis) => Number(curve.dataset[axis]) / high[axis]);
      curve.classList.add("on");
      curve.setAttribute("transform", `translate(${left} ${bottom}) scale(${part.join(" ")}) translate(${-left} ${-bottom})`);
      curve.style.stroke = squama.slant(row).color;
      curve.style.strokeDasharray = row === state.pinned ? "7 4" : "none";
    }
  };

  const show = () => {
    const rows = pair(), whole = rows.every((row) => row !== null);
    section.hidden = !whole;
    squama.at("compare-link").hidden = !whole;
    if (!whole) return;
    drawings(rows);
    numbers(rows);
    curves();
  };
  squama.listen("design pinned", show);
  squama.at("unpin").addEventListener("click", () => squama.pin(null));
})();

"use strict";
// The pinned design beside the chosen one: drawings, curves, numbers.

(() => {
  const { state } = squama;
  const section = squama.at("compare");
  const pair = () => [state.pinned, state.design];

  /** How two numbers stand to each other. */
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

  const CURVES = [
    ["puncture", "displacement $u/t$, dimensionless", "force $F^*$, dimensionless"],
    ["flexure", "curvature $κ^*$, dimensionless", "moment $M^*$, dimensionless"],
  ];
  const canvas = squama.element("canvas", { role: "img", "aria-label": "Curves of both designs: force against displacement, and moment against curvature." });
  const words = squama.element("div");
  const log = squama.element("input", { type: "checkbox", id: "log", onchange: (event) => { state.log = event.target.checked; curves(); squama.writeAddress(); } });
  const control = squama.element("label", {}, log, " Logarithmic force and moment");
  squama.at("compare-curves").append(control, canvas, words);

  /** An axis from zero, or where numbers fall below it from their least, for curves of two designs. */
  const axis = (own, of) => {
    const both = own.map((design) => design?.[of]).filter(Boolean);
    return both.length === 0 ? null : both.reduce((a, b) => (b.high - b.low > a.high - a.low ? b : a));
  };

  /** The logarithmic axis on which both curves are seen where they are highest. */
  const logarithmic = (own, measure) => {
    const highest = own.filter(Boolean).map(({ points }) => points.reduce((most, [, value]) => Math.max(most, value), 0)).filter((value) => value > 0);
    if (highest.length === 0) return null;
    const [low, high] = [Math.min(...highest) / 100, 1.3 * Math.max(...highest)];
    return { scale: "log", low, high, ticks: squama.logarithmic[measure].ticks.filter(({ value }) => value >= low && value <= high) };
  };

  // Straight pieces are curved on a logarithmic axis, most of all near zero.
  const PIECES = 24;
  const finer = (points) => points.slice(1).flatMap(([x, y], k) => Array.from({ length: PIECES }, (_, i) => {
    const [fromX, fromY] = points[k], part = ((i + 1) / PIECES) ** 3;
    return [fromX + part * (x - fromX), fromY + part * (y - fromY)];
  }));

  const curves = () => {
    log.checked = state.log;
    const rows = pair(), own = rows.map(squama.solved);
    const drawn = CURVES.filter(([measure]) => own.some((design) => design?.curves?.[measure]));
    canvas.hidden = control.hidden = drawn.length === 0;
    const missing = rows.filter((row) => !squama.solved(row)?.curves);
    words.replaceChildren(...(missing.length > 0 ? [squama.element("p", { class: "note" }, `The page holds the curves of ${squama.drawings.length} designs, those that are best for some weights before others. Both together are drawn by`), squama.command(`squama plot curves ${squama.folder}/run.toml --design ${[...new Set(rows.map(squama.number))].join(",")}`)] : []));
    if (drawn.length === 0) return;
    const width = canvas.clientWidth || 800, theme = squama.themeNow, margin = { left: 70, right: 16, top: 26, bottom: 48 };
    const { places, height } = squama.panel.grid(drawn.length, width, { least: 260, height: 220, gaps: [76, 66], margin });
    const context = squama.canvas(canvas, width, height);
    places.forEach((place, k) => {
      const [measure, xName, yName] = drawn[k], both = own.map((design) => design?.curves?.[measure]);
      const lines = both.map((curve, i) => curve && { points: curve.points, color: squama.slant(rows[i]).color, width: 2.2, dash: i === 0 ? [7, 4] : [] }).filter(Boolean);
      const y = (state.log && logarithmic(both, measure)) || axis(both, "y");
      if (y.scale === "log") for (const one of lines) one.points = finer(one.points).filter(([, value]) => value > 0);
      squama.panel.draw(context, { ...place, x: axis(both, "x"), y, xTicks: true, yTicks: true, xName, yName, title: rows.map((row, i) => both[i] && `${squama.number(row)} ${i === 0 ? "- - -" : "——"}`).filter(Boolean).join("   "), lines, marks: [] }, theme, []);
    });
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
  squama.listen("theme", () => { if (!section.hidden) curves(); });
  squama.at("unpin").addEventListener("click", () => squama.pin(null));
})();

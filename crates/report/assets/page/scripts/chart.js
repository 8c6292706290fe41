"use strict";
// What all charts share: the theme, pointing at marks, rings around the designs that are chosen and pinned, keys.

squama.charts = [];

squama.theme = () => {
  const style = getComputedStyle(document.documentElement);
  const names = ["paper", "ink", "faint", "line", "accent", "warning", "grey", "front"];
  return Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
};

/** Kind of mark of a design: crossed out where the surface folds. */
squama.kind = (row, open = false) => (open ? "open" : "") + (squama.folded(row) ? "folded" : open ? "" : "filled");

/** Mark of a design at a place: in the colour of its slant, or small and grey if it does not meet the requirements. */
squama.mark = (row, x, y, { size = 7, open = false, faint = false } = {}) => {
  const { color, path } = squama.slant(row);
  if (faint || !squama.passes[row]) return { row, x, y, path: "M-4 0 A4 4 0 1 1 4 0 A4 4 0 1 1 -4 0 Z", color: squama.themeNow.grey, size: 5, kind: "filled", silent: !squama.passes[row] };
  return { row, x, y, path, color, size, kind: squama.kind(row, open) };
};

/** Sets up a canvas for its width and the density of the screen; returns its context. */
squama.canvas = (canvas, width, height) => {
  const ratio = Math.max(1, devicePixelRatio);
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  canvas.style.height = `${height}px`;
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  return context;
};

(() => {
  const REACH = 14;
  const NAMED = 4;
  // Marks of a chart that are drawn, about, at most.
  const DRAWN = 10000;
  const tip = squama.element("div", { id: "tip", hidden: true, "aria-hidden": "true" });
  document.body.append(tip);

  /** Spots nearest to a place in a chart: one, or those of several designs that stand on each other. */
  const near = (chart, x, y) => {
    let nearest = null, least = REACH ** 2;
    for (const spot of chart.spots) {
      const away = (spot.at[0] - x) ** 2 + (spot.at[1] - y) ** 2;
      if (away <= least && (nearest === null || !spot.silent || nearest.silent)) [nearest, least] = [spot, away];
    }
    if (nearest === null) return [];
    const here = ({ at, silent }) => silent === nearest.silent && (at[0] - nearest.at[0]) ** 2 + (at[1] - nearest.at[1]) ** 2 < 2;
    const known = new Map(chart.spots.filter(here).map((spot) => [spot.row ?? `tip ${spot.tip}`, spot]));
    return [...known.values()].sort((a, b) => a.row - b.row);
  };

  /** What the tip says of a spot: a design of the table, or what the chart tells of others. */
  const line = (chart, { row, tip: own }) => (row === null ? chart.tip(own)
    : squama.element("div", {}, ...squama.warning(row), ` ${squama.title(row)} `, squama.element("small", {}, chart.says?.(row) ?? "")));

  const showTip = (chart, event) => {
    const spots = near(chart, event.offsetX, event.offsetY);
    tip.hidden = spots.length === 0;
    chart.canvas.style.cursor = spots.some(({ row }) => row !== null) ? "pointer" : "default";
    if (spots.length === 0) return;
    tip.replaceChildren(...spots.slice(0, NAMED).map((spot) => line(chart, spot)),
      ...(spots.length > NAMED ? [squama.element("div", {}, `and ${spots.length - NAMED} more in the same place`)] : []),
      ...(spots.some(({ row }) => row !== null && squama.folded(row)) ? [squama.element("small", {}, "⚠ The surface folds: the critical force is not to be trusted.")] : []));
    const left = Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 6);
    tip.style.left = `${Math.max(4, left)}px`;
    tip.style.top = `${event.clientY + 16 + tip.offsetHeight > innerHeight ? event.clientY - tip.offsetHeight - 8 : event.clientY + 16}px`;
  };

  /** A click chooses; another click on marks in one place goes to the next of them. */
  const click = (chart, event) => {
    const rows = near(chart, event.offsetX, event.offsetY).map(({ row }) => row).filter((row) => row !== null);
    if (rows.length === 0) return;
    squama.choose(rows[(rows.indexOf(squama.state.design) + 1) % rows.length]);
  };

  const key = (chart, event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    squama.step(step, chart.rows);
  };

  /** Rings around the design that is chosen and, dashed, the one that is pinned. */
  const rings = (chart) => {
    const context = squama.canvas(chart.over, chart.canvas.clientWidth, chart.height);
    context.lineWidth = 2.6;
    context.strokeStyle = squama.themeNow.accent;
    for (const [row, dash] of [[squama.state.pinned, [4, 3]], [squama.state.design, []]].filter(([own]) => own !== null)) {
      context.setLineDash(dash);
      for (const { at } of chart.spots.filter((spot) => spot.row === row)) {
        context.beginPath();
        context.arc(at[0], at[1], dash.length > 0 ? 11 : 8.5, 0, 2 * Math.PI);
        context.stroke();
      }
    }
  };

  const draw = (chart) => {
    // Nothing has been chosen while the scripts of the page are still being read.
    if (!squama.contest) return;
    chart.stale = false;
    const width = chart.canvas.clientWidth || 900;
    const { panels, height, names = [], rows, note = "" } = chart.make(width);
    const context = squama.canvas(chart.canvas, width, height), theme = squama.themeNow;
    Object.assign(chart, { height, spots: [], rows });
    chart.box.hidden = panels.length === 0;
    const every = Math.ceil(panels.reduce((sum, { marks }) => sum + marks.length, 0) / DRAWN);
    for (const panel of panels) squama.panel.draw(context, panel, theme, chart.spots, every);
    for (const { text, at, turn = 0 } of names) squama.lettering.write(context, text, at, { size: 13, align: 0.5, turn, color: theme.ink });
    const thinned = every > 1 && panels.some(({ marks }) => marks.some(({ cell }) => !cell)) ? `Drawn is a mark of every ${every} designs; pointing finds all.` : "";
    chart.caption.textContent = [chart.description, note, thinned].filter(Boolean).join(" ");
    rings(chart);
  };

  // A chart that is out of sight is drawn when it comes into sight.
  const seen = new IntersectionObserver((entries) => entries.forEach(({ target, isIntersecting }) => {
    const chart = squama.charts.find(({ area }) => area === target);
    chart.seen = isIntersecting;
    if (isIntersecting && chart.stale) draw(chart);
  }), { rootMargin: "300px" });

  /**
   * Adds a chart. `make(width)` returns its panels, their height, the names of shared axes, the rows that it shows in the
   * order of keys, and a note; `says(row)` returns what the tip says of a design, `tip(k)` that of a mark without one. `into` is
   * the element that it stands in.
   */
  squama.addChart = (chart) => {
    Object.assign(chart, {
      canvas: squama.element("canvas"), over: squama.element("canvas", { class: "over" }), caption: squama.element("figcaption"), spots: [], rows: [], stale: true, seen: false,
    });
    chart.area = squama.element("div", { class: "chart", id: `chart-${chart.id}`, tabindex: 0, role: "img", "aria-label": `${chart.title}. ${chart.description} The arrow keys go from design to design.` }, chart.canvas, chart.over);
    chart.box = squama.element("figure", { id: `figure-${chart.id}` }, squama.element("h3", {}, chart.title, ...(chart.controls ?? [])), chart.area, chart.caption);
    (chart.into ?? squama.at("figure-list")).append(chart.box);
    squama.charts.push(chart);
    chart.over.addEventListener("pointermove", (event) => showTip(chart, event));
    chart.over.addEventListener("pointerleave", () => { tip.hidden = true; });
    chart.over.addEventListener("click", (event) => click(chart, event));
    chart.area.addEventListener("keydown", (event) => key(chart, event));
    seen.observe(chart.area);
  };

  // One chart in each slice of time, so that what answers to the reader is not kept waiting.
  let waiting = null;
  const drawNext = () => {
    waiting = null;
    const next = squama.charts.find((chart) => chart.stale && chart.seen);
    if (!next) return;
    draw(next);
    later();
  };
  const later = () => {
    if (waiting === null) waiting = requestAnimationFrame(() => { waiting = setTimeout(drawNext); });
  };
  squama.redraw = () => {
    squama.themeNow = squama.theme();
    squama.charts.forEach((chart) => { chart.stale = true; });
    later();
  };
  /** Draws every chart, whether it is in sight or not. */
  squama.drawAll = () => {
    squama.themeNow = squama.theme();
    squama.charts.forEach(draw);
  };
  squama.listen("design pinned", () => squama.charts.filter(({ stale }) => !stale).forEach(rings));

  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth === width) return;
    width = innerWidth;
    squama.redraw();
  });
})();

squama.themeNow = squama.theme();

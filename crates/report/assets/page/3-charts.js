"use strict";
// What all charts share: colours of the theme, marks of the slants, clicks, keys.

squama.charts = [];

squama.themeColors = () => {
  const style = getComputedStyle(document.documentElement);
  const color = (name) => style.getPropertyValue(name).trim();
  return { paper: color("--paper"), ink: color("--ink"), faint: color("--faint"), line: color("--line"), accent: color("--accent") };
};

// Nothing leaves the page: without this the library offers to upload each chart.
squama.config = { displaylogo: false, responsive: true, showSendToCloud: false, plotlyServerURL: "", modeBarButtonsToRemove: ["select2d", "lasso2d"] };

/** Layout that follows the theme. */
squama.layout = (extra) => {
  const colors = squama.themeColors();
  const axis = { gridcolor: colors.line, linecolor: colors.faint, zerolinecolor: colors.line, tickcolor: colors.faint, showline: true, mirror: true, ticks: "inside", exponentformat: "power", minor: { ticks: "inside" } };
  const layout = {
    paper_bgcolor: colors.paper, plot_bgcolor: colors.paper,
    font: { color: colors.ink, size: 12 }, margin: { l: 64, r: 12, t: 34, b: 54 },
    showlegend: false, hovermode: "closest", ...extra,
  };
  for (const key of Object.keys(layout)) {
    if (/^[xy]axis\d*$/.test(key)) layout[key] = { ...axis, ...layout[key] };
  }
  return layout;
};

/** Markers of rows: colour and symbol by slant, open where `filled` says no. */
squama.markers = (rows, size = 7, filled = () => true) => ({
  size,
  color: rows.map((row) => squama.slant(row).color),
  symbol: rows.map((row) => squama.slant(row).symbol + (filled(row) ? "" : "-open")),
  line: { width: 0.6, color: squama.themeColors().paper },
});

/** A trace that rings the chosen design; `at` gives its place in the chart, or null. */
squama.ring = (axes = {}) => ({
  x: [], y: [], mode: "markers", hoverinfo: "skip", ...axes,
  marker: { size: 16, symbol: "circle-open", color: squama.themeColors().accent, line: { width: 3 } },
});

/**
 * Adds a chart. `traces` and `layout` are made anew for each theme and width; a point carries its row in
 * `customdata`. `rings` lists, for each ring trace from the end, where a row stands.
 */
squama.addChart = (chart) => {
  const box = squama.element("figure", { id: `figure-${chart.id}` });
  const area = squama.element("div", { class: "chart", id: `chart-${chart.id}`, tabindex: 0, role: "img", "aria-label": chart.description });
  box.append(squama.element("h3", {}, chart.title), area, squama.element("figcaption", {}, chart.description));
  document.getElementById("figure-list").append(box);
  chart.area = area;
  squama.charts.push(chart);
  squama.draw(chart);
  area.on("plotly_click", (event) => {
    const row = event.points[0]?.customdata;
    if (Number.isInteger(row)) squama.choose(row);
  });
  area.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    squama.step(step, chart.rows);
  });
};

/** Chooses the next design of `rows`. */
squama.step = (step, rows) => {
  const here = rows.indexOf(squama.chosen);
  const next = here < 0 ? 0 : (here + step + rows.length) % rows.length;
  squama.choose(rows[next]);
};

squama.draw = (chart) => {
  const width = chart.area.clientWidth || 900;
  const { traces, layout } = chart.make(width);
  chart.area.style.height = `${layout.height}px`;
  Plotly.react(chart.area, [...traces, ...chart.rings(squama.chosen)], squama.layout(layout), squama.config);
  chart.traces = traces.length;
};

squama.onChoose.push((row) => {
  for (const chart of squama.charts) {
    const rings = chart.rings(row);
    const numbers = rings.map((_, k) => chart.traces + k);
    Plotly.restyle(chart.area, { x: rings.map((ring) => ring.x), y: rings.map((ring) => ring.y) }, numbers);
  }
});

squama.redraw = () => squama.charts.forEach(squama.draw);

/** A mark as it stands in a legend. */
squama.symbol = (slant) => {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "-7 -7 14 14");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", slant.path);
  path.setAttribute("fill", slant.color);
  svg.append(path);
  return svg;
};

document.getElementById("slant-legend").append("slant α:", ...squama.slants.map((slant) =>
  squama.element("span", {}, squama.symbol(slant), `${slant.degrees}°`)));

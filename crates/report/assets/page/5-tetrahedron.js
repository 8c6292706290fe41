"use strict";
// The best design for every weighting, in a tetrahedron that turns.

(() => {
  // Steps from corner to corner, as `squama rank` has them.
  const RESOLUTION = 20;
  const LISTED = 10;
  // Distance of the eye, in sizes of the tetrahedron.
  const AWAY = 1.6;
  const CORNERS = [[0, 0, 1], [0.9428, 0, -0.3333], [-0.4714, 0.8165, -0.3333], [-0.4714, -0.8165, -0.3333]];
  const NAMES = ["coverage", "force", "resistance", "compliance"];
  const area = document.getElementById("tetrahedron");
  const place = (weights) => [0, 1, 2].map((axis) => weights.reduce((sum, weight, k) => sum + weight * CORNERS[k][axis], 0));

  if (squama.ranked.length === 0) {
    area.textContent = "No design has coverage and every value, so there is nothing to rank.";
    return;
  }

  // The part of the tetrahedron that is nearest to a weighting, by how many of its weights are zero.
  const CELLS = [72, 36, 14, 3];
  const winners = [];
  for (let m = 0; m <= RESOLUTION; m++) {
    for (let n = 0; n <= RESOLUTION - m; n++) {
      for (let k = 0; k <= RESOLUTION - m - n; k++) {
        const steps = [m, n, k, RESOLUTION - m - n - k];
        const weights = steps.map((step) => step / RESOLUTION);
        const cell = CELLS[steps.filter((step) => step === 0).length];
        winners.push({ weights, cell, at: place(weights), row: squama.best(weights) });
      }
    }
  }
  const cells = new Map();
  for (const { row, cell } of winners) cells.set(row, (cells.get(row) ?? 0) + cell);
  const regions = [...cells].sort((a, b) => b[1] - a[1] || a[0] - b[0]);
  // Regions of one slant differ in shade.
  const SHADES = [0, 0.5, -0.4, 0.25, -0.2, 0.75];
  const shaded = (color, part) => "#" + [1, 3, 5].map((k) => {
    const own = parseInt(color.slice(k, k + 2), 16), other = part > 0 ? 255 : 0;
    return Math.round(own + Math.abs(part) * (other - own)).toString(16).padStart(2, "0");
  }).join("");
  const colors = new Map();
  regions.forEach(([row], place) => {
    const slant = squama.slant(row);
    const before = regions.slice(0, place).filter(([other]) => squama.slant(other) === slant).length;
    colors.set(row, shaded(slant.color, SHADES[before % SHADES.length]));
  });
  document.getElementById("tetrahedron-legend").append(
    ...regions.slice(0, LISTED).map(([row, own]) => squama.element("button", { type: "button", onclick: () => squama.choose(row) },
      squama.symbol({ ...squama.slant(row), color: colors.get(row) }), `${squama.title(row)} (${((100 * own) / (12 * RESOLUTION ** 3)).toFixed(1)} %)`)),
    regions.length > LISTED ? `and ${regions.length - LISTED} more` : "");

  const traces = () => {
    const theme = squama.themeColors();
    const edges = { x: [], y: [], z: [], type: "scatter3d", mode: "lines", hoverinfo: "skip", line: { color: theme.faint, width: 3 } };
    for (const [a, b] of [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3], [3, 1]]) {
      [CORNERS[a], CORNERS[b], [null, null, null]].forEach(([x, y, z]) => { edges.x.push(x); edges.y.push(y); edges.z.push(z); });
    }
    const coordinate = (axis) => winners.map(({ at }) => at[axis]);
    const dots = {
      x: coordinate(0), y: coordinate(1), z: coordinate(2), type: "scatter3d", mode: "markers", customdata: winners.map(({ row }) => row),
      hoverinfo: "text", text: winners.map(({ row, weights }) => `${squama.title(row)}<br>best for ${weights.map((weight) => weight.toFixed(2)).join(", ")}`),
      // Dots alone: in space the library does not have the marks of the slants.
      marker: { size: 5, symbol: "circle", color: winners.map(({ row }) => colors.get(row)), line: { color: theme.paper, width: 0.5 } },
    };
    return [edges, dots];
  };

  // The names of the corners and the ring: above the dots, which would hide them.
  const notes = () => {
    const theme = squama.themeColors();
    const note = (text, [x, y, z], font) => ({ text, x, y, z, showarrow: false, font });
    const names = NAMES.map((name, k) => note(`<b>${name}</b>`, CORNERS[k].map((part) => 1.22 * part), { color: theme.ink, size: 13 }));
    return [...names, note("<b>◯</b>", place(squama.weights()), { color: theme.ink, size: 26 })];
  };

  // The camera, by its angles.
  const camera = { turn: 0.25, tip: 0.3 };
  const eye = () => ({
    eye: { x: AWAY * Math.cos(camera.tip) * Math.cos(camera.turn), y: AWAY * Math.cos(camera.tip) * Math.sin(camera.turn), z: AWAY * Math.sin(camera.tip) },
    center: { x: 0, y: 0, z: -0.06 },
  });
  const layout = () => {
    const axis = { visible: false };
    return squama.layout({
      margin: { l: 0, r: 0, t: 0, b: 0 }, uirevision: "kept",
      scene: { xaxis: axis, yaxis: axis, zaxis: axis, aspectmode: "data", camera: eye(), dragmode: "orbit", annotations: notes() },
    });
  };
  const draw = () => Plotly.react(area, traces(), layout(), squama.config);

  draw();
  area.on("plotly_click", (event) => {
    const row = event.points[0]?.customdata;
    if (Number.isInteger(row)) squama.choose(row);
  });
  area.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, 0.12], ArrowDown: [0, -0.12] }[event.key];
    if (!step) return;
    event.preventDefault();
    camera.turn += step[0];
    camera.tip = Math.max(-1.4, Math.min(1.4, camera.tip + step[1]));
    Plotly.relayout(area, { "scene.camera": eye() });
  });
  squama.onWeights.push(() => {
    Plotly.relayout(area, { "scene.annotations": notes() });
  });
  squama.redrawTetrahedron = draw;
})();

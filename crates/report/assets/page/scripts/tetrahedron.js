"use strict";
// The best design for every weighting of four criteria, in a tetrahedron that turns.

(() => {
  const LISTED = 10;
  const CORNERS = [[0, 0, 1], [0.9428, 0, -0.3333], [-0.4714, -0.8165, -0.3333], [-0.4714, 0.8165, -0.3333]];
  const EDGES = [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3], [3, 1]];
  // Regions of one slant differ in shade.
  const SHADES = [0, 0.5, -0.4, 0.25, -0.2, 0.75];
  const { state, lettering } = squama;
  const [area, canvas, legend] = [squama.at("tetrahedron"), squama.element("canvas"), squama.at("tetrahedron-legend")];
  const words = squama.element("p", { class: "note" });
  area.append(canvas, words);

  const camera = { turn: 0.72, tip: 0.22 };
  let regions = [], dots = [], colors = new Map(), spots = [];

  const place = (weights) => [0, 1, 2].map((axis) => weights.reduce((sum, weight, k) => sum + weight * CORNERS[k][axis], 0));

  /** A point of space on the canvas, and how near it is. */
  const projected = ([x, y, z]) => {
    const [width, height] = [canvas.clientWidth, canvas.clientHeight], size = Math.min(width / 2.4, height / 1.9);
    const across = y * Math.cos(camera.turn) - x * Math.sin(camera.turn), toward = x * Math.cos(camera.turn) + y * Math.sin(camera.turn);
    const up = z * Math.cos(camera.tip) - toward * Math.sin(camera.tip), depth = toward * Math.cos(camera.tip) + z * Math.sin(camera.tip);
    return { x: width / 2 + size * across, y: height * 0.6 - size * up, depth };
  };

  const shaded = (color, part) => "#" + [1, 3, 5].map((k) => {
    const own = parseInt(color.slice(k, k + 2), 16), other = part > 0 ? 255 : 0;
    return Math.round(own + Math.abs(part) * (other - own)).toString(16).padStart(2, "0");
  }).join("");

  const colored = () => {
    const counts = new Map();
    return new Map(regions.map(({ row }) => {
      const slant = squama.slant(row), before = counts.get(slant) ?? 0;
      counts.set(slant, before + 1);
      return [row, shaded(slant.color, SHADES[before % SHADES.length])];
    }));
  };

  const edges = (context, theme) => {
    context.strokeStyle = theme.faint;
    context.lineWidth = 1.2;
    for (const pair of EDGES) {
      const [a, b] = pair.map((k) => projected(CORNERS[k]));
      context.beginPath();
      context.moveTo(a.x, a.y);
      context.lineTo(b.x, b.y);
      context.stroke();
    }
  };

  /** A dot for each weighting, the far ones first and smaller. */
  const balls = (context, theme) => {
    spots = dots.map((dot) => ({ ...dot, ...projected(place(dot.weights)) })).sort((a, b) => a.depth - b.depth);
    context.strokeStyle = theme.paper;
    context.lineWidth = 0.6;
    for (const { x, y, depth, row } of spots) {
      context.fillStyle = colors.get(row);
      context.beginPath();
      context.arc(x, y, 5 + depth, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    }
  };

  const names = (context, theme) => state.criteria.forEach((criterion, k) => {
    const at = projected(CORNERS[k].map((part) => 1.1 * part)), text = squama.criterionName(criterion);
    const half = lettering.width(context, text, 13, true) / 2 + 6;
    const x = Math.min(canvas.clientWidth - half, Math.max(half, at.x)), y = Math.min(canvas.clientHeight - 6, Math.max(14, at.y + (k === 0 ? 0 : 14)));
    lettering.write(context, text, [x, y], { size: 13, align: 0.5, bold: true, color: theme.ink, halo: theme.paper });
  });

  /** The weighting of the sliders. */
  const ring = (context, theme) => {
    const { x, y } = projected(place(squama.weights()));
    for (const [color, width] of [[theme.paper, 6], [theme.ink, 2.5]]) {
      [context.strokeStyle, context.lineWidth] = [color, width];
      context.beginPath();
      context.arc(x, y, 11, 0, 2 * Math.PI);
      context.stroke();
    }
  };

  const draw = () => {
    if (dots.length === 0) return;
    const context = squama.canvas(canvas, area.clientWidth, area.clientWidth < 500 ? 330 : 440), theme = squama.themeNow;
    edges(context, theme);
    balls(context, theme);
    names(context, theme);
    ring(context, theme);
  };

  const list = () => legend.replaceChildren(
    ...regions.slice(0, LISTED).map(({ row, share }) => squama.element("button", { type: "button", onclick: () => squama.choose(row) },
      squama.symbol({ ...squama.slant(row), color: colors.get(row) }), ...squama.warning(row), `${squama.title(row)} (${(100 * share).toFixed(1)} %)`)),
    regions.length > LISTED ? `and ${regions.length - LISTED} more` : "");

  const show = () => {
    const possible = squama.contest.rows.length > 0 && state.criteria.length === 4;
    ({ dots, regions } = possible ? squama.weightings.winners(squama.contest) : { dots: [], regions: [] });
    colors = colored();
    canvas.hidden = !possible;
    words.hidden = possible;
    words.textContent = squama.contest.rows.length === 0 ? "There is nothing to rank." : "The tetrahedron shows four criteria.";
    squama.at("tetrahedron-figure").classList.toggle("empty", !possible);
    draw();
    list();
  };

  let timer = null;
  squama.listen("selection", () => {
    // After everything else, because it takes longest.
    clearTimeout(timer);
    timer = setTimeout(show, 30);
  });
  squama.listen("weights theme", draw);
  new ResizeObserver(draw).observe(area);

  const turn = (across, up) => {
    camera.turn += across;
    camera.tip = Math.max(-1.4, Math.min(1.4, camera.tip + up));
    draw();
  };
  area.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, 0.12], ArrowDown: [0, -0.12] }[event.key];
    if (!step) return;
    event.preventDefault();
    turn(...step);
  });
  let from = null;
  canvas.addEventListener("pointerdown", (event) => {
    from = { x: event.clientX, y: event.clientY, moved: false };
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (from === null) return;
    const [dx, dy] = [event.clientX - from.x, event.clientY - from.y];
    if (!from.moved && Math.hypot(dx, dy) < 4) return;
    from = { x: event.clientX, y: event.clientY, moved: true };
    turn(-0.008 * dx, 0.008 * dy);
  });
  canvas.addEventListener("pointerup", (event) => {
    const moved = from?.moved;
    from = null;
    if (moved) return;
    const hit = spots.findLast(({ x, y }) => Math.hypot(x - event.offsetX, y - event.offsetY) < 8);
    if (hit) squama.choose(hit.row);
  });
  squama.tetrahedron = { camera, place: (weights) => projected(place(weights)), get spots() { return spots; } };
})();

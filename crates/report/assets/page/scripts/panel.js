"use strict";
// One panel of a chart on a canvas: a frame with two axes, lines, and marks.

squama.panel = (() => {
  const TICK = 11;
  const { write, width: widthOf } = squama.lettering;

  /** Place of a value along an axis: 0 at its low end, 1 at its high end. */
  const along = ({ scale, low, high }, value) => (scale === "log" ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));

  const across = (panel, x) => panel.left + panel.width * along(panel.x, x);
  const down = (panel, y) => panel.top + panel.height * (1 - along(panel.y, y));
  const within = (part) => part > -1e-9 && part < 1 + 1e-9;

  const stroke = (context, color, width, points) => {
    context.strokeStyle = color;
    context.lineWidth = width;
    context.beginPath();
    points.forEach(([x, y], k) => (k === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.stroke();
  };

  const acrossTicks = (context, panel, theme) => {
    const bottom = panel.top + panel.height;
    let free = -Infinity;
    for (const { value, label } of panel.x.ticks) {
      const x = across(panel, value);
      if (label !== null && panel.x.scale !== "places") stroke(context, theme.line, 1, [[x, panel.top], [x, bottom]]);
      stroke(context, theme.faint, 1, [[x, bottom], [x, bottom - (label === null ? 2.5 : 5)]]);
      if (label === null || !panel.xTicks) continue;
      const half = widthOf(context, label, TICK) / 2;
      // A label that would touch the one before is left out.
      if (x - half <= free) continue;
      free = x + half + 5;
      write(context, label, [x, bottom + 15], { size: TICK, align: 0.5, color: theme.ink });
    }
  };

  const downTicks = (context, panel, theme) => {
    let free = Infinity;
    for (const { value, label } of panel.y.ticks) {
      const y = down(panel, value);
      if (label !== null && panel.y.scale !== "places") stroke(context, theme.line, 1, [[panel.left, y], [panel.left + panel.width, y]]);
      stroke(context, theme.faint, 1, [[panel.left, y], [panel.left + (label === null ? 2.5 : 5), y]]);
      if (label === null || !panel.yTicks || y + TICK / 2 >= free) continue;
      free = y - TICK / 2;
      write(context, label, [panel.left - 6, y + 4], { size: TICK, align: 1, color: theme.ink });
    }
  };

  /** Draws frame, ticks and title. */
  const frame = (context, panel, theme) => {
    acrossTicks(context, panel, theme);
    downTicks(context, panel, theme);
    context.strokeStyle = theme.faint;
    context.lineWidth = 1;
    context.strokeRect(panel.left, panel.top, panel.width, panel.height);
    if (panel.title) write(context, panel.title, [panel.left + panel.width / 2, panel.top - 7], { size: 12, align: 0.5, color: theme.ink });
    if (panel.xName) write(context, panel.xName, [panel.left + panel.width / 2, panel.top + panel.height + 36], { size: 13, align: 0.5, color: theme.ink });
    if (panel.yName) write(context, panel.yName, [panel.left - 52, panel.top + panel.height / 2], { size: 13, align: 0.5, turn: -90, color: theme.ink });
  };

  const lines = (context, panel) => {
    context.save();
    context.beginPath();
    context.rect(panel.left, panel.top, panel.width, panel.height);
    context.clip();
    for (const { color, points, width = 1.2, dash = [] } of panel.lines) {
      context.setLineDash(dash);
      stroke(context, color, width, points.map(([x, y]) => [across(panel, x), down(panel, y)]));
    }
    context.restore();
  };

  // Marks are drawn once for each kind, and then copied.
  const stamps = new Map();
  const stamp = ({ path, color, size, kind }, theme) => {
    const key = [path, color, size, kind, theme.paper].join();
    if (stamps.has(key)) return stamps.get(key);
    const ratio = Math.max(1, devicePixelRatio), side = Math.ceil(2.4 * size);
    const canvas = squama.element("canvas", { width: side * ratio, height: side * ratio });
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    context.translate(side / 2, side / 2);
    context.scale(size / 10, size / 10);
    paint(context, new Path2D(path), { color, kind }, theme);
    stamps.set(key, { canvas, side });
    return stamps.get(key);
  };

  const paint = (context, path, { color, kind }, theme) => {
    const open = kind.startsWith("open"), folded = kind.endsWith("folded");
    context.globalAlpha = folded ? 0.45 : 1;
    context.fillStyle = open ? theme.paper : color;
    context.fill(path);
    context.lineWidth = open ? 1.8 : 0.9;
    context.strokeStyle = open ? color : theme.paper;
    context.stroke(path);
    context.globalAlpha = 1;
    if (folded) stroke(context, theme.warning, 1.8, [[-6, 6], [6, -6]]);
  };

  /** Draws marks: of those that would hide each other anyway, one of `every` few. All have their spots. */
  const marks = (context, panel, theme, spots, every) => {
    for (const { row, tip, x, y, fill, cell, folded, ...style } of panel.marks) {
      if (!within(along(panel.x, x)) || !within(along(panel.y, y))) continue;
      const at = [across(panel, x), down(panel, y)];
      if (cell) {
        context.fillStyle = fill;
        context.fillRect(at[0] - cell[0] / 2, at[1] - cell[1] / 2, cell[0], cell[1]);
        if (folded) stroke(context, theme.warning, 1.4, [[at[0] - cell[0] / 2, at[1] + cell[1] / 2], [at[0] + cell[0] / 2, at[1] - cell[1] / 2]]);
      } else if (row === null || row % every === 0) {
        const { canvas, side } = stamp(style, theme);
        context.drawImage(canvas, at[0] - side / 2, at[1] - side / 2, side, side);
      }
      spots.push({ row, tip, at, silent: style.silent === true });
    }
  };

  /** Draws a panel, one of `every` few marks; adds to `spots` where each design stands. */
  const draw = (context, panel, theme, spots, every = 1) => {
    frame(context, panel, theme);
    if (!panel.linesOnTop) lines(context, panel);
    marks(context, panel, theme, spots, every);
    if (panel.linesOnTop) lines(context, panel);
  };

  /**
   * Panels in a grid, of a height and with gaps in px, as many in a row as there is room for: the place of each, which
   * of them have tick labels, and the height of all.
   */
  const grid = (count, width, { least, height, gaps, margin }) => {
    const room = Math.max(60, width - margin.left - margin.right);
    const columns = Math.max(1, Math.min(count, Math.floor((room + gaps[0]) / (least + gaps[0]))));
    const wide = (room - (columns - 1) * gaps[0]) / columns, rows = Math.ceil(count / columns);
    const places = Array.from({ length: count }, (_, k) => ({
      left: margin.left + (k % columns) * (wide + gaps[0]), top: margin.top + Math.floor(k / columns) * (height + gaps[1]), width: wide, height,
      xTicks: k + columns >= count, yTicks: k % columns === 0,
    }));
    return { places, height: margin.top + rows * height + (rows - 1) * gaps[1] + margin.bottom };
  };

  return { along, draw, grid };
})();

"use strict";
// Contours of values on a grid, by marching squares, as figures have them.

/** Pieces `[from, to]` of the line along which `value(i, j)` is `level` on a grid; none beside a node without a value. */
squama.contours = (() => {
  const CORNERS = [[0, 0], [1, 0], [1, 1], [0, 1]];

  const square = (i, j, value, level) => {
    const values = CORNERS.map(([a, b]) => value(i + a, j + b));
    if (values.some((one) => one === null || !Number.isFinite(one))) return [];
    const crossed = [0, 1, 2, 3].filter((k) => (values[k] < level) !== (values[(k + 1) % 4] < level)).map((k) => {
      const [from, to] = [CORNERS[k], CORNERS[(k + 1) % 4]], part = (level - values[k]) / (values[(k + 1) % 4] - values[k]);
      return [i + from[0] + part * (to[0] - from[0]), j + from[1] + part * (to[1] - from[1])];
    });
    const [a, b, c, d] = crossed;
    if (crossed.length === 2) return [[a, b]];
    if (crossed.length !== 4) return [];
    // The middle tells which two corners belong together.
    const middle = values.reduce((sum, one) => sum + one, 0) / 4;
    return (middle < level) === (values[0] < level) ? [[a, b], [c, d]] : [[d, a], [b, c]];
  };

  return ([across, up], value, level) => {
    const pieces = [];
    for (let i = 0; i + 1 < across; i++) for (let j = 0; j + 1 < up; j++) pieces.push(...square(i, j, value, level));
    return pieces;
  };
})();

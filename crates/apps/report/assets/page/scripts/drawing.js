// The row of a design at rest, to scale, with the coverage line.

/** Draws the row of a design. `span` returns the width of its drawing in units of `t`. */
squama.drawing = (() => {
  const WIDE = 350;

  const geometry = (row) => {
    const base = squama.cell(row, "base") ?? squama.shared.find(([key]) => key === "scale.base")?.[1] ?? "L";
    const length = squama.cell(row, "length_over_t"), gap = squama.cell(row, "gap_over_t");
    const half = base === "2L" ? length : length / 2;
    return { half, shift: Math.tan((squama.cell(row, "slant_deg") * Math.PI) / 180), pitch: 2 * half + gap };
  };

  const span = (row) => {
    const { shift, pitch } = geometry(row);
    return Math.max(4.5, shift + 2.5 * pitch);
  };

  const scales = ({ half, shift, pitch }, wide, at) => {
    const count = Math.min(200, Math.ceil(wide / pitch) + 1), left = Math.ceil(shift / pitch) + 1;
    return Array.from({ length: left + count }, (_, k) => {
      const x = half + (k - left) * pitch;
      return squama.svg("polygon", {
        points: [at(x - half, 0), at(x + half, 0), at(x + half + shift, 1), at(x - half + shift, 1)].join(" "),
        fill: k === left ? "var(--punctured)" : "var(--scale)", stroke: "var(--edge)", "stroke-width": 1,
      });
    });
  };

  /** Draws the coverage line across the thickness, with thick parts inside scales. */
  const cover = ({ half, shift, pitch }, scale) => {
    if (shift <= 1e-9) return [];
    const x = (scale * (2 * half + shift + 0.15)).toFixed(2), y = (level) => (scale * (1.25 - level)).toFixed(2);
    const line = (low, high, width, dash) => squama.svg("line", { x1: x, x2: x, y1: y(low), y2: y(high), stroke: "var(--cover)", "stroke-width": width, "stroke-dasharray": dash });
    const covered = Array.from({ length: Math.floor(shift / pitch + 1) }, (_, k) => {
      const level = (more) => (shift - (k + 1) * pitch + more) / shift;
      return [Math.max(0, level(0)), Math.min(1, level(2 * half))];
    });
    return [line(0, 1, 1.3, "4 3"), ...covered.filter(([low, high]) => high - low > 1e-9).map(([low, high]) => line(low, high, 4, "none"))];
  };

  const draw = (row, wide = span(row)) => {
    const own = geometry(row), scale = 340 / wide, height = scale * 1.35 + 26;
    const at = (x, y) => `${(scale * (x + 0.15)).toFixed(2)},${(scale * (1.25 - y)).toFixed(2)}`;
    return squama.svg("svg", { viewBox: `0 0 ${WIDE} ${height.toFixed(1)}`, role: "img", "aria-label": `row of scales of design ${squama.title(row)}, at rest` },
      squama.svg("rect", { x: 0, y: (scale * 1.25).toFixed(2), width: WIDE, height: (height - scale * 1.25).toFixed(2), fill: "var(--soil)" }),
      ...scales(own, wide, at), ...cover(own, scale));
  };

  return Object.assign(draw, { span });
})();

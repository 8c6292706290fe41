// Charts of force against depth and moment against curvature, with a mark at the drawn state.

(() => {
  const { svg, at, live } = squama;
  const [WIDE, HIGH, LEFT, BOTTOM, TOP, RIGHT] = [400, 200, 58, 38, 14, 18];

  const LOADS = [
    { id: "force", path: "puncture", names: (units) => [units.length ? "depth (mm)" : "depth u/t", units.force ? "force (N)" : "force F*"], factors: (units) => [units.length ?? 1, units.force ?? 1] },
    { id: "moment", path: "flexure", names: (units) => [units.length ? "curvature (1/mm)" : "curvature κt", units.moment ? "moment (N mm)" : "moment M*"], factors: (units) => [1 / (units.length ?? 1), units.moment ?? 1] },
  ];

  /** Lists about five round numbers from `low` to `high`. */
  const ticks = (low, high) => {
    const least = (high - low) / 5, size = 10 ** Math.floor(Math.log10(least));
    const step = [1, 2, 2.5, 5, 10].find((own) => own * size >= least) * size, first = Math.ceil(low / step - 1e-9);
    return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, k) => Number(((first + k) * step).toPrecision(10)));
  };

  const draw = ({ id, path, names, factors }, load) => {
    const slider = at(`live-${id}-share`);
    slider.value = live.drawn[load];
    slider.setAttribute("aria-valuetext", at(load === 0 ? "live-needle-words" : "live-bent-words").textContent);
    // Without a curve the axes have no range.
    if (!live.answer) return;
    const own = live.answer[path], before = live.pinned?.answer?.[path], { units } = live.answer;
    const lines = [own, before].map((one) => one?.path ?? []), all = lines.flat();
    const [low, high] = [[0, 1].map((k) => Math.min(0, ...all.map((point) => point[k]))), [0, 1].map((k) => Math.max(1e-12, ...all.map((point) => point[k])))];
    const spot = ([x, y]) => [LEFT + ((WIDE - LEFT - RIGHT) * (x - low[0])) / (high[0] - low[0]), HIGH - BOTTOM - ((HIGH - BOTTOM - TOP) * (y - low[1])) / (high[1] - low[1])];
    const line = (points, kind) => svg("polyline", { points: points.map((point) => spot(point).map((c) => c.toFixed(1)).join(",")).join(" "), class: kind });
    const cross = (point) => svg("path", { d: `M${spot(point).join(" ")} m-3 -3 l6 6 m0 -6 l-6 6`, class: "event" }, svg("title", {}, "A contact closes, opens or passes a corner"));
    const ring = ([cx, cy], r, kind) => svg("circle", { cx, cy, r, class: kind });
    const words = names(units), [x, y] = factors(units);
    const word = (left, top, anchor, text) => svg("text", { x: left, y: top, "text-anchor": anchor }, text);
    const floor = HIGH - BOTTOM;
    const across = ticks(low[0] * x, high[0] * x).map((own) => ({ own, left: spot([own / x, 0])[0] }));
    const up = ticks(low[1] * y, high[1] * y).map((own) => ({ own, top: spot([0, own / y])[1] }));
    const grid = [...across.map(({ left }) => `M${left} ${TOP} V${floor + 4}`), ...up.map(({ top }) => `M${LEFT - 4} ${top} H${WIDE - RIGHT}`)].join(" ");
    at(`live-${id}`).replaceChildren(svg("path", { d: grid, class: "grid" }), svg("path", { d: `M${LEFT} ${TOP} V${floor} H${WIDE - RIGHT}`, class: "axis" }),
      word((WIDE + LEFT) / 2, HIGH - 4, "middle", words[0]), word(LEFT + 8, TOP + 10, "start", words[1]),
      ...across.map(({ own, left }) => word(left, floor + 16, "middle", live.digits(own))), ...up.map(({ own, top }) => word(LEFT - 7, top + 4, "end", live.digits(own))),
      line(lines[1], "curve pinned"), line(lines[0], "curve"), ...(own?.events ?? []).map(cross), ...(own?.fold ? [ring(spot(own.fold), 7, "fold")] : []),
      ...(own ? [ring(spot(own.at ?? [0, 0]), 9, "marker")] : []));
    at(`live-${id}`).onpointerdown = at(`live-${id}`).onpointermove = (event) => {
      if (event.buttons !== 1 || !own?.path.length) return;
      const bounds = at(`live-${id}`).getBoundingClientRect(), ratio = WIDE / bounds.width;
      const far = (point) => Math.hypot(spot(point)[0] - ratio * (event.clientX - bounds.left), spot(point)[1] - ratio * (event.clientY - bounds.top));
      live.draw(load, own.path.reduce((best, point) => (far(point) < far(best) ? point : best))[2]);
    };
  };

  LOADS.forEach(({ id }, load) => {
    at(`live-${id}`).setAttribute("viewBox", `0 0 ${WIDE} ${HIGH}`);
    at(`live-${id}-share`).addEventListener("input", (event) => live.draw(load, Number(event.target.value)));
  });
  live.listen("answered", () => LOADS.forEach(draw));
})();

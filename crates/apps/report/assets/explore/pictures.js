// The skin to scale: at rest with handles to drag, under the needle, and bent.

(() => {
  const { svg, at, live } = squama;
  const radians = (degrees) => (degrees * Math.PI) / 180;
  let grabbed = null;

  /** Computes half-base, gap, tissue depth, shift of the top, pitch and curvature in units of t. */
  const form = (values) => {
    const half = live.value("length_over_t", values) / (live.data.base === "2L" ? 1 : 2), gap = live.value("gap_over_t", values);
    const tissue = live.control("tissue_thickness_over_t") ? live.value("tissue_thickness_over_t", values) : null;
    return { half, gap, tissue, shift: Math.tan(radians(values.slant_deg)), pitch: 2 * half + gap, curvature: live.curvature(values) };
  };
  const now = () => form(live.values());
  /** Computes the tangent frame of the body at an arc length: origin, cosine and sine of its clockwise rotation. */
  const frame = (curvature, arc) => {
    const angle = arc * curvature, [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    return { x: curvature ? sin / curvature : arc, y: curvature ? (cos - 1) / curvature : 0, cos, sin };
  };
  // Arc length up to which scales are solved, where the normal of the body is 80° from the load.
  const farthest = ({ curvature }) => radians(80) / Math.abs(curvature);

  const place = (view, [x, y]) => [view.left + view.scale * x, view.base - view.scale * y];
  const points = (view, line) => line.map((point) => place(view, point).map((c) => c.toFixed(1)).join(",")).join(" ");
  /** Computes the outline of a scale at a pose in a frame: node position and rotation. */
  const outline = ({ half, shift }, [x, y, turn], at = frame(0, 0)) => {
    const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
    const local = [[-half, 0], [half, 0], [half + shift, 1], [-half + shift, 1]].map(([u, v]) => [x + u * cos - v * sin, y + u * sin + v * cos]);
    return local.map(([u, v]) => [at.x + at.cos * u + at.sin * v, at.y + at.cos * v - at.sin * u]);
  };
  /** Returns true if a drawing has a size: a window in the background may have none yet. */
  const isShown = (id) => at(id).clientWidth > 0 && at(id).clientHeight > 0;
  const box = (id) => {
    const { width, height } = at(id).getBoundingClientRect();
    at(id).setAttribute("viewBox", `0 0 ${width} ${height}`);
    return { width, height };
  };
  /** Shows the legend of dots and rings, sticking and slipping contacts; empty without friction. */
  const stuck = (id, contacts) => {
    const known = contacts.filter(([, , slips]) => slips !== null), slipping = known.filter(([, , slips]) => slips).length;
    at(id).textContent = known.length > 0 ? `Where scales touch: ● ${known.length - slipping} stick, ○ ${slipping} slip` : "";
  };
  /** Lists points of the body at a depth below its surface, up to an arc length on both sides. */
  const surface = (own, most, depth = 0) => {
    const far = Math.min(most, farthest(own)), frames = Array.from({ length: 81 }, (_, k) => frame(own.curvature, ((k - 40) / 40) * far));
    return frames.map(({ x, y, cos, sin }) => [x - depth * sin, y - depth * cos]);
  };
  /** Draws the tissue, and the bone below the tissue if it lies above the centre of the body. */
  const soil = (view, own, { width, height }) => {
    const low = (view.base - height) / view.scale - 1, has_bone = own.tissue && own.tissue * own.curvature < 0.95;
    const filled = (line, kind) => svg("polygon", { points: points(view, [...line, [line.at(-1)[0], low], [line[0][0], low]]), class: kind });
    const wide = (2 * width) / view.scale;
    return [filled(surface(own, wide), "soil"), ...(has_bone ? [filled(surface(own, wide, own.tissue), "bone")] : [])];
  };
  const row = (view, own, poses, kind) => poses.map(({ number, pose }) =>
    svg("polygon", { points: points(view, outline(own, pose, frame(own.curvature, number * own.pitch))), class: `scale ${kind ?? (number === 0 ? "punctured" : "")}` }));
  const dots = (view, contacts) => contacts.map((contact) => {
    const [x, y, slips] = contact;
    const [cx, cy] = place(view, [x, y]);
    return svg("circle", { cx, cy, r: 4, class: slips ? "contact slips" : "contact" });
  });
  /** Lists the scales within a drawing of this width; scales that are not in `moved` are at rest. */
  const poses = (own, view, width, moved = new Map()) => {
    const ends = [-view.left / view.scale - own.half - own.shift, (width - view.left) / view.scale + own.half];
    // An arc is at most 1.5 times as long as its chord.
    const [first, last] = ends.map((x) => Math.max(-farthest(own), Math.min(farthest(own), own.curvature ? 1.5 * x : x)) / own.pitch);
    return Array.from({ length: Math.min(400, Math.floor(last) - Math.ceil(first) + 1) }, (_, k) => k + Math.ceil(first)).map((number) => {
      const [x, y, turn] = moved.get(number) ?? [0, 0, 0];
      return { number, pose: [x, y, radians(turn)] };
    });
  };
  /** Fits a row of about five scales into a drawing, with the height `sky`, in t, free above it. */
  const fitted = (own, { width, height }, most, sky = 0.37) => {
    const level = 1.53 + sky, wide = Math.min(width / Math.max(3.4, 4.5 * own.pitch + own.shift), height / level, most);
    // A body falls or rises from the punctured scale to the sides of the drawing.
    const drop = Math.max(-1, Math.min(1, frame(own.curvature, Math.min(width / 2 / wide, farthest(own))).y)), high = level + Math.abs(drop);
    const scale = Math.min(wide, height / high);
    return { scale, left: width / 2 - scale * own.shift / 2, base: (height * (1 + sky + Math.max(0, drop))) / high };
  };

  /** Lists the handles: position, and a function from a dragged position to parameters. */
  const handles = (own, scale) => {
    // The scale with the handle of the gap is far enough from the first handle for touch input.
    const far = Math.max(1, Math.ceil(130 / (scale * own.pitch))), { curvature } = own;
    const [corner] = outline(own, [0, 0, 0], frame(curvature, far * own.pitch));
    // Arc lengths from the node of a scale to its corner, and from the punctured scale to a point.
    const toCorner = (half) => (curvature ? Math.atan(curvature * half) / curvature : half);
    const toPoint = ([x, y]) => (curvature ? Math.atan2(curvature * x, 1 + curvature * y) / curvature : x);
    return [
      // The drawn base does not move, and the corner follows the pointer. Its height changes
      // the thickness or, without a thickness in mm, the length divided by the thickness.
      { id: "slant", key: "slant_deg", spot: [own.half + own.shift, 1], above: true,
        drag: ([x, y], _, { half, values }) => {
          const control = live.control("thickness_mm"), length = live.value("length_over_t", values);
          const least = 0.02, high = Math.max(least, control ? Math.min(control.max, Math.max(control.min, values.thickness_mm * y)) / values.thickness_mm : y);
          const others = control ? live.withThickness(values.thickness_mm * high, values) : { length_over_t: length / high };
          return { ...others, slant_deg: Math.atan2(Math.max(0, x - half), high) / radians(1) };
        } },
      { id: "length", key: "length_over_t", spot: [-own.half, 0],
        drag: ([x]) => ({ length_over_t: Math.max(0, -x) * (live.data.base === "2L" ? 1 : 2) }) },
      { id: "gap", key: "gap_over_t", spot: corner,
        drag: (point, { half }) => ({ gap_over_t: (toPoint(point) + toCorner(half)) / far - 2 * half }) },
    ];
  };
  /** Describes the parameters that a handle changes. */
  const words = ({ label }, id, key) => {
    const other = live.control("thickness_mm") ?? live.control("length_over_t");
    const more = grabbed?.id === id && id === "slant" ? ` · ${other.label.toLowerCase()} ${live.text(other.key)}` : "";
    return `${label.toLowerCase()} ${live.text(key)}${more}`;
  };
  /** Places a label at the side of a grip that has more space. */
  const besideGrip = (x, y, width, off) => (x < width / 2 ? { x: x + off, y: y + 5 } : { x: x - off, y: y + 5, "text-anchor": "end" });
  const handle = (view, width, { id, key, spot, above, beside, drag, drawing = "live-rest" }) => {
    const control = live.control(key), [x, y] = place(view, spot);
    return svg("g", {
      class: "handle", id: `live-handle-${id}`, tabindex: 0, role: "slider", "aria-label": `${control.label} of the scales, drag or use the arrow keys`,
      "aria-valuemin": control.min, "aria-valuemax": control.max, "aria-valuenow": live.current(control), "aria-valuetext": live.text(key),
      onpointerdown: (event) => { event.preventDefault(); grabbed = { view, id, drag, drawing, spot, off: [x - event.offsetX, y - event.offsetY], half: now().half, values: live.values(), current: live.current(control) }; },
      onkeydown: (event) => {
        const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
        if (!step) return;
        event.preventDefault();
        live.set({ [control.key]: live.current(control) + step * control.step });
        at(`live-handle-${id}`).focus();
      },
    }, svg("circle", { cx: x, cy: y, r: 24, class: "reach" }), svg("circle", { cx: x, cy: y, r: 9, class: "grip" }),
    svg("text", beside ? besideGrip(x, y, width, beside) : { x: Math.min(width - 60, Math.max(60, x)), y: y + (above ? -16 : 30), "text-anchor": "middle" }, words(control, id, key)));
  };

  const rest = () => {
    if (!isShown("live-rest")) return;
    const own = now(), size = box("live-rest"), isHere = grabbed?.drawing === "live-rest", view = { ...(isHere ? grabbed.view : fitted(own, size, 170)) };
    if (isHere && grabbed.id === "slant") view.scale = Math.min(view.scale * grabbed.half / own.half, 0.7 * size.height);
    const pinned = live.pinned ? row(view, form(live.pinned.values), poses(form(live.pinned.values), view, size.width), "ghost") : [];
    at("live-rest").replaceChildren(...soil(view, own, size), ...row(view, own, poses(own, view, size.width)), ...pinned, ...handles(own, view.scale).map((one) => handle(view, size.width, one)));
  };

  const needle = () => {
    if (!isShown("live-needle")) return;
    const own = now(), size = box("live-needle"), view = fitted(own, size, 110, 0.9), { puncture, units } = live.answer ?? {};
    const moved = new Map((puncture?.scales ?? []).map(([number, ...pose]) => [number, pose]));
    const stands = poses(own, view, size.width, moved), hit = stands.find(({ number }) => number === 0);
    const [, , right, left] = outline(own, hit?.pose ?? [0, 0, 0]), share = puncture?.load_position ?? 1;
    // A guided tip moves straight down; a free load follows its point on the scale.
    const [x, y] = place(view, puncture?.tip ?? [0, 1].map((k) => left[k] + share * (right[k] - left[k])));
    const round = view.scale * (puncture?.tip?.[2] ?? 0), shaft = Math.max(round, 5), nose = round || 16;
    const sideways = { id: "needle", key: "load_position", drawing: "live-needle", beside: Math.max(16, shaft + 8), spot: [(x - view.left) / view.scale, (view.base - Math.max(16, y - nose - 40)) / view.scale],
      drag: ([to], { half }, { spot: [from], current }) => ({ load_position: current + (to - from) / (2 * half) }) };
    const hasFocus = document.activeElement?.id === "live-handle-needle";
    at("live-needle").replaceChildren(...soil(view, own, size), ...row(view, own, poses(own, view, size.width), "ghost"), ...row(view, own, stands), ...dots(view, puncture?.contacts ?? []),
      svg("path", { d: `M${x} ${y} ${round ? `a${round} ${round} 0 0 1` : "l"}${-shaft} ${-nose} V0 h${2 * shaft} V${y - nose} ${round ? `a${round} ${round} 0 0 1 ${-round} ${round}` : ""} z`, class: round ? "needle round" : "needle" }),
      handle(view, size.width, sideways));
    if (hasFocus) at("live-handle-needle").focus();
    const [depth, force] = puncture?.at ?? [0, 0];
    const text = units?.force ? `${live.digits(force * units.force, 3)} N` : `F* = ${live.digits(force, 3)}`;
    const deep = units?.length ? `${live.digits(depth * units.length, 3)} mm` : `${live.digits(depth, 3)} t`;
    at("live-needle-words").textContent = live.solving() ?? (live.drawn[0] === 0 ? "at rest" : `${text} at a depth of ${deep}`);
    stuck("live-needle-stuck", puncture?.contacts ?? []);
    at("live-dead-load").hidden = live.guided();
  };

  const bent = () => {
    if (!isShown("live-bent")) return;
    const own = now(), size = box("live-bent"), { flexure, units } = live.answer ?? {};
    const still = Array.from({ length: 13 }, (_, k) => [(k - 6) * own.pitch, 0, 0]);
    const outlines = (flexure?.scales.length ? flexure.scales : still).map(([x, y, turn]) => outline(own, [x, y, radians(turn)]));
    const [xs, ys] = [0, 1].map((k) => outlines.flat().map((point) => point[k]));
    const [low, high] = [[Math.min(...xs), Math.min(...ys)], [Math.max(...xs), Math.max(...ys)]];
    const scale = Math.min((size.width - 24) / (high[0] - low[0]), (size.height - 24) / (high[1] - low[1]), 90);
    const view = { scale, left: size.width / 2 - (scale * (low[0] + high[0])) / 2, base: size.height / 2 + (scale * (low[1] + high[1])) / 2 };
    const outlined = outlines.map((line) => `M${points(view, line)}Z`).join(" ");
    const axes = (flexure?.membrane ?? []).map((line) => `M${points(view, line)}`).join(" ");
    const body = own.curvature ? [svg("polyline", { points: points(view, surface(own, high[0] - low[0])), class: "body" }, svg("title", {}, "The body"))] : [];
    at("live-bent").replaceChildren(...body, svg("path", { d: axes, class: "membrane" }), svg("path", { d: outlined, class: "scale" }), ...dots(view, flexure?.contacts ?? []));
    const [curvature] = flexure?.at ?? [0];
    const radius = curvature ? Math.abs(1 / curvature) * (units?.length ?? 1) : null;
    stuck("live-bent-stuck", flexure?.contacts ?? []);
    const worn = own.curvature ? " (dashed: the body)" : "";
    at("live-bent-words").textContent = live.solving() ?? (radius ? `to a radius of ${live.digits(radius, 3)} ${units?.length ? "mm" : "t"}` : "at rest") + worn;
  };

  addEventListener("pointermove", (event) => {
    if (!grabbed) return;
    const { view, drag, off, drawing } = grabbed, { left, top } = at(drawing).getBoundingClientRect();
    const spot = [(event.clientX - left + off[0] - view.left) / view.scale, (view.base - (event.clientY - top + off[1])) / view.scale];
    live.set(drag(spot, now(), grabbed));
  });
  for (const end of ["pointerup", "pointercancel"]) addEventListener(end, () => { if (grabbed) { grabbed = null; rest(); } });
  const loaded = () => { needle(); bent(); };
  new ResizeObserver(() => { rest(); loaded(); }).observe(at("live-rest"));
  live.listen("moved", rest);
  live.listen("answered", loaded);
})();

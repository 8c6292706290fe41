"use strict";
// The skin itself, to scale: at rest and loaded, with the corners that a hand may drag.

squama.scene = (() => {
  const { svg, at } = squama;
  const radians = (degrees) => degrees * Math.PI / 180;
  let view = { scale: 60, left: 0, base: 0 }, grabbed = null;

  /** Half the base, the gap, the shift of the top over the thickness. */
  const shape = () => {
    const value = squama.value;
    const half = value("length_over_t") / (squama.data.base === "2L" ? 1 : 2);
    return { half, gap: value("gap_over_t"), shift: Math.tan(radians(value("slant_deg"))), pitch: 2 * half + value("gap_over_t") };
  };
  const place = ([x, y]) => [view.left + view.scale * x, view.base - view.scale * y];
  const points = (corners) => corners.map((corner) => place(corner).map((c) => c.toFixed(2)).join(",")).join(" ");
  const corners = ({ half, shift }, [x, y, turn]) => [[-half, 0], [half, 0], [half + shift, 1], [-half + shift, 1]]
    .map(([u, v]) => [x + u * Math.cos(turn) - v * Math.sin(turn), y + u * Math.sin(turn) + v * Math.cos(turn)]);

  /** Where the scale that is punctured, and those about it, stand in a state; at rest without one. */
  const poses = (form, state, reach) => {
    const moved = new Map((state?.scales ?? []).map(([number, ...pose]) => [number, pose]));
    return Array.from({ length: 2 * reach + 1 }, (_, k) => k - reach).map((number) => {
      const [x, y, turn] = moved.get(number) ?? [0, 0, 0];
      return { number, pose: [number * form.pitch + x, y, radians(turn)] };
    });
  };

  const soil = (width, height) => svg("rect", { x: 0, y: view.base, width, height: Math.max(0, height - view.base), fill: "var(--soil)" });

  const bodies = (form, state, reach) => {
    const carrying = new Set();
    const parts = poses(form, state, reach).map(({ number, pose }) => {
      const polygon = svg("polygon", { points: points(corners(form, pose)), class: number === 0 ? "scale punctured" : "scale" });
      return polygon;
    });
    const first = state?.scales?.[0]?.[0] ?? 0;
    const contacts = (state?.contacts ?? []).map(([x, y]) => place([x + first * form.pitch, y]));
    contacts.forEach((spot) => carrying.add(spot));
    return [...parts, ...contacts.map(([cx, cy]) => svg("circle", { cx, cy, r: 4, class: "contact" }))];
  };

  const needle = (form, state, force) => {
    const pose = state?.scales?.find(([number]) => number === 0) ?? [0, 0, 0, 0];
    const [, , topRight, topLeft] = corners(form, [pose[1], pose[2], radians(pose[3])]);
    const share = squama.answer?.puncture?.load_position ?? 1;
    const [x, y] = place([0, 1].map((k) => topLeft[k] + share * (topRight[k] - topLeft[k])));
    return svg("g", { class: "needle" },
      svg("path", { d: `M${x} ${y} l-4 -12 v-46 h8 v46 z` }),
      ...(force ? [svg("text", { x: x + 10, y: y - 34 }, force)] : []));
  };

  /** The corners that a hand may drag, each with what it changes and how a key moves it. */
  const HANDLES = [
    { id: "corner", label: "Top corner: slant, and length", spot: ({ half, shift }) => [half + shift, 1], keys: ["slant_deg", "length_over_t"],
      drag: ([x, y], { half }) => {
        squama.set("slant_deg", Math.atan(Math.max(0, x - half)) * 180 / Math.PI);
        // A corner that is pulled up makes the scale thinner in proportion.
        if (Math.abs(y - 1) > 0.15) squama.set("length_over_t", squama.grabbedValue * Math.min(4, Math.max(0.25, 1 / Math.max(0.2, y))));
      } },
    { id: "foot", label: "Foot: length", spot: ({ half }) => [half, 0], keys: ["length_over_t"],
      drag: ([x]) => squama.set("length_over_t", Math.max(0, x) * (squama.data.base === "2L" ? 1 : 2)) },
    { id: "gap", label: "Foot of the next scale: gap", spot: ({ half, gap }) => [half + gap, 0], keys: ["gap_over_t"],
      drag: ([x], { half }) => squama.set("gap_over_t", x - half) },
  ];

  const handles = (form) => HANDLES.map((handle) => {
    const [cx, cy] = place(handle.spot(form));
    const move = (event) => {
      const box = at("scene").getBoundingClientRect();
      handle.drag([(event.clientX - box.left - view.left) / view.scale, (view.base - event.clientY + box.top) / view.scale], shape());
    };
    const element = svg("g", { class: "handle", tabindex: 0, role: "slider", "aria-label": handle.label,
      "aria-valuenow": squama.value(handle.keys[0]), "aria-valuetext": handle.keys.map(squama.text).join(", "),
      onpointerdown: (event) => {
        event.preventDefault();
        grabbed = { id: handle.id, move };
        squama.grabbedValue = squama.value("length_over_t");
      },
      onkeydown: (event) => {
        const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
        if (!step) return;
        event.preventDefault();
        squama.nudge(handle.keys[0], step);
      } },
      svg("circle", { cx, cy, r: 22, class: "reach" }), svg("circle", { cx, cy, r: 8, class: "grip" }));
    return element;
  });

  const puncture = (width, height) => {
    const form = shape();
    // Nine scales and their tops, or fewer where they would be too small to grasp.
    const span = Math.max(4, 5 * form.pitch + form.shift);
    const scale = grabbed ? view.scale : Math.min(width / span, height / 2.6);
    const reach = Math.min(40, Math.ceil(width / scale / form.pitch / 2) + 1 + Math.ceil(form.shift / form.pitch));
    view = { scale, left: width / 2 - scale * form.shift / 2, base: height * 0.62 };
    const state = squama.state();
    at("scene").replaceChildren(soil(width, height), ...bodies(form, state, reach), needle(form, state, squama.forceText()),
      ...(state ? [] : handles(form)));
  };

  const bending = (width, height) => {
    const form = shape(), state = squama.state();
    const scales = state?.scales ?? Array.from({ length: 9 }, (_, k) => [k * 0, 0, 0]);
    const nodes = scales.map(([x, y, turn], k) => [k * form.pitch + x, y, turn]);
    const outlines = nodes.map((pose) => corners(form, pose));
    const all = outlines.flat();
    const [xs, ys] = [all.map(([x]) => x), all.map(([, y]) => y)];
    const [w, h] = [Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys)];
    const scale = Math.min((width - 40) / w, (height - 60) / h, 90);
    view = { scale, left: width / 2 - scale * (Math.min(...xs) + w / 2), base: height / 2 + scale * (Math.min(...ys) + h / 2) };
    const axis = (state?.membrane ?? []).map((line) => svg("polyline", { points: points(line), class: "membrane" }));
    const contacts = (state?.contacts ?? []).map(([x, y]) => place([x, y]));
    at("scene").replaceChildren(...axis, ...outlines.map((outline) => svg("polygon", { points: points(outline), class: "scale" })),
      ...contacts.map(([cx, cy]) => svg("circle", { cx, cy, r: 3, class: "contact" })));
  };

  const draw = () => {
    const { width, height } = at("scene").getBoundingClientRect();
    at("scene").setAttribute("viewBox", `0 0 ${width} ${height}`);
    (squama.load === "bend" ? bending : puncture)(width, height);
  };
  addEventListener("pointermove", (event) => grabbed?.move(event));
  addEventListener("pointerup", () => { if (grabbed) { grabbed = null; draw(); } });
  addEventListener("resize", draw);
  return { draw, grabbed: () => grabbed !== null };
})();

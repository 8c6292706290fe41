"use strict";
// The figures of the sweep.

(() => {
  const PANELS = 15;
  const { view, state } = squama;
  const axisOf = (name) => (squama.axesOf[name] ? squama.axesOf[name] : { scale: "linear", low: 0, high: 1, ticks: [] });
  const values = (row, names) => names.map((name) => `${squama.label(name)} ${squama.short(squama.cell(row, name))}`).join(", ");
  const isNumber = (...names) => (row) => names.every((name) => !Number.isNaN(squama.numbers(name)[row]));

  /** The names of the axes that panels share: below and to the left of all. */
  const sharedNames = (x, y, width, height, margin) => [
    { text: x, at: [(width + margin.left - margin.right) / 2, height - 8] },
    { text: y, at: [16, (height + margin.top - margin.bottom) / 2], turn: -90 },
  ];

  const spread = (all) => (all.length <= PANELS ? all : Array.from({ length: PANELS }, (_, k) => all[Math.floor((k * (all.length - 1)) / (PANELS - 1))]));

  const contact = (row) => {
    const cell = squama.cell(row, "flexure_contact");
    return cell !== "false" && cell !== "no" && cell !== 0;
  };

  /** Lines through the designs of each slant; none across the place where contact begins in bending. */
  const linesOf = (rows, x, y, broken) => squama.slants.flatMap((slant) => {
    const own = rows.filter((row) => squama.slant(row) === slant).sort((a, b) => x[a] - x[b]);
    if (new Set(own.map((row) => x[row])).size < own.length) return [];
    const parts = [[]];
    own.forEach((row, k) => {
      if (broken && k > 0 && contact(row) !== contact(own[k - 1])) parts.push([]);
      parts.at(-1).push([x[row], y[row]]);
    });
    return parts.filter((part) => part.length > 1).map((points) => ({ color: slant.color, points }));
  });

  /** One value against a parameter, a panel for each value of another. `column()` may change. */
  const multiples = (id, column, title, description, { open = false, controls } = {}) => {
    const make = (width) => {
      const [along, across, name] = [view.against(), view.panels(), column()];
      const all = spread(across ? squama.different(across) : [null]);
      const rows = view.slice(view.free()).filter(isNumber(name, along)).filter((row) => !across || all.includes(squama.cell(row, across)));
      const margin = { left: 70, right: 12, top: 26, bottom: 48 };
      const { places, height } = squama.panel.grid(rows.length > 0 ? all.length : 0, width, { least: 150, height: 165, gaps: [10, 30], margin });
      const [x, y] = [squama.numbers(along), squama.numbers(name)];
      const panels = places.map((place, k) => {
        const own = across ? rows.filter((row) => squama.cell(row, across) === all[k]) : rows;
        return {
          ...place, x: axisOf(along), y: axisOf(name), title: across ? `${squama.axisName(across).replace(/,.*/, "")} = ${squama.short(all[k])}` : "",
          lines: linesOf(own, x, y, open), marks: own.map((row) => squama.mark(row, x[row], y[row], { size: 7, open: open && !contact(row) })),
        };
      });
      const held = view.fixed(view.free());
      const note = [held.length > 0 ? `Shown: ${view.words(held)}.` : "", across && all.length < squama.different(across).length ? `${all.length} of ${squama.different(across).length} panels.` : ""].filter(Boolean).join(" ");
      return { panels, height, rows, note, names: sharedNames(squama.axisName(along), squama.axisName(name), width, height, margin) };
    };
    squama.addChart({ id, title, description, make, controls, says: (row) => values(row, [column()]) });
  };

  /** Panels of one column against another. `front` adds the designs that no other beats in the two, and their line. */
  const scatter = (id, title, description, pairs, { front = false } = {}) => {
    const make = (width) => {
      const chosen = pairs();
      const slice = view.slice(view.free());
      const margin = { left: 70, right: 12, top: 12, bottom: 48 };
      const { places, height } = squama.panel.grid(chosen.length, width, { least: 250, height: chosen.length > 2 ? 240 : 300, gaps: [72, 62], margin });
      const panels = places.map((place, k) => {
        const [a, b] = chosen[k], [x, y] = [squama.numbers(a.column), squama.numbers(b.column)];
        const rows = slice.filter(isNumber(a.column, b.column));
        const all = front ? fronts(rows.filter((row) => squama.passes[row]), a, b) : [];
        const best = front ? new Set(all.flatMap((one) => [...one])) : null;
        const marks = rows.map((row) => squama.mark(row, x[row], y[row], { faint: best !== null && !best.has(row) }));
        // Those that stand out are drawn last.
        if (best) marks.sort((p, q) => best.has(p.row) - best.has(q.row));
        return { ...place, x: axisOf(a.column), y: axisOf(b.column), xTicks: true, yTicks: true, xName: squama.axisName(a.column), yName: squama.axisName(b.column), marks, lines: all.map((one) => line(one, x, y)) };
      });
      const held = view.fixed(view.free());
      const rows = slice.filter((row) => chosen.some(([a, b]) => isNumber(a.column, b.column)(row)));
      return { panels: rows.length > 0 ? panels : [], height, rows, note: held.length > 0 ? `Shown: ${view.words(held)}.` : "" };
    };
    squama.addChart({ id, title, description, make, says: (row) => values(row, [...new Set(pairs().flat().map(({ column }) => column))]) });
  };

  /** The designs that no other beats in two criteria: a front for each group of designs that can be compared. */
  const fronts = (rows, a, b) => squama.comparable.groups(rows, [a, b]).map((group) => squama.ranking.front(squama.ranking.contest(squama, group, [a, b], "linear")));
  const line = (best, x, y) => ({ color: squama.themeNow.faint, width: 1.4, points: [...best].sort((p, q) => x[p] - x[q] || y[p] - y[q]).map((row) => [x[row], y[row]]) });

  const shade = (value) => squama.shades[Math.max(0, Math.min(squama.shades.length - 1, Math.floor(value * squama.shades.length)))];

  /** An axis on which every value has a place of its own; labels as many as there is room for. */
  const placesAxis = (all, room) => {
    const every = Math.ceil(all.length / Math.max(1, room));
    return { scale: "places", low: -0.5, high: all.length - 0.5, ticks: all.map((value, k) => ({ value: k, label: k % every === 0 ? squama.short(value) : null })).filter(({ label }) => label !== null) };
  };

  /** Cells of one map, with the lines along which its column has the values of the ticks of its scale. */
  const mapped = (rows, name, [x, y], scale, blank) => {
    const [across, up] = [x, y].map((axis) => new Map(squama.different(axis).map((value, k) => [value, k])));
    const cells = new Map();
    const marks = rows.map((row) => {
      const value = squama.cell(row, name), at = [across.get(squama.cell(row, x)), up.get(squama.cell(row, y))];
      cells.set(at.join(), squama.panel.along(scale, value));
      const fill = blank(value) ? squama.themeNow.paper : squama.passes[row] ? shade(squama.panel.along(scale, value)) : squama.themeNow.line;
      return { row, x: at[0], y: at[1], fill, folded: name !== "coverage" && squama.folded(row), silent: !squama.passes[row] };
    });
    const levels = scale.ticks.filter(({ label }) => label !== null).map(({ value }) => squama.panel.along(scale, value));
    const value = (i, j) => cells.get(`${i},${j}`) ?? null;
    const pieces = levels.flatMap((level) => squama.contours([across.size, up.size], value, level));
    return { marks, lines: pieces.flatMap((points) => [{ points, color: "#ffffff", width: 2.6 }, { points, color: "#222222", width: 1.2 }]) };
  };

  /** A column over two parameters, a map for each value of a third; `axes()` names the three, `name()` the column. */
  const maps = (id, title, description, { axes, name, scale, blank = () => false, controls, shown = () => {} }) => {
    const make = (width) => {
      const [x, y, across] = axes(), free = [x, y, across].filter(Boolean), own = scale();
      const rows = view.slice(free).filter(isNumber(name(), ...free));
      const all = across ? spread(squama.different(across)) : [null];
      const margin = { left: 70, right: 12, top: 26, bottom: 48 };
      const { places, height } = squama.panel.grid(rows.length > 0 ? all.length : 0, width, { least: 190, height: all.length > 1 ? 190 : 320, gaps: [14, 34], margin });
      const [xs, ys] = [x, y].map(squama.different);
      const panels = places.map((place, k) => {
        const cell = [place.width / xs.length + 0.4, place.height / ys.length + 0.4];
        const { marks, lines } = mapped(rows.filter((row) => !across || squama.cell(row, across) === all[k]), name(), [x, y], own, blank);
        const part = across ? `${squama.axisName(across).replace(/,.*/, "")} = ${squama.short(all[k])}${across.endsWith("_deg") ? "°" : ""}` : "";
        return { ...place, x: placesAxis(xs, place.width / 36), y: placesAxis(ys, place.height / 18), title: part, marks: marks.map((mark) => ({ ...mark, cell })), lines, linesOnTop: true };
      });
      shown(own);
      const held = view.fixed(free);
      const note = [held.length > 0 ? `Shown: ${view.words(held)}.` : "", across && all.length < squama.different(across).length ? `${all.length} of ${squama.different(across).length} maps.` : ""].filter(Boolean).join(" ");
      return { panels, height, rows, note, names: sharedNames(squama.axisName(x), squama.axisName(y), width, height, margin) };
    };
    squama.addChart({ id, title, description, controls, make, says: (row) => values(row, [name()]) });
  };

  /** A scale of colours with its ends, which `show` sets. */
  const colorBar = () => {
    const [low, high] = [squama.element("span", { class: "end" }), squama.element("span", { class: "end" })];
    const bar = squama.element("span", { class: "shades" }, low, squama.element("span", { style: `background: linear-gradient(to right, ${squama.shades.join(", ")})` }), high);
    const show = (scale) => {
      low.textContent = squama.short(Number(scale.low.toPrecision(2)));
      high.textContent = `${squama.short(Number(scale.high.toPrecision(2)))}${scale.scale === "log" ? ", logarithmic" : ""}`;
    };
    return { bar, show };
  };

  const coverageMaps = () => {
    const { bar, show } = colorBar();
    const scale = { scale: "linear", low: 0, high: 1, ticks: [0.2, 0.4, 0.6, 0.8].map((value) => ({ value, label: String(value) })) };
    maps("coverage", "Coverage", "Coverage by gap, aspect ratio and slant, with contours at 0.2, 0.4, 0.6 and 0.8; empty: none; grey: does not meet the requirements.", {
      axes: () => ["length_over_t", "gap_over_t", "slant_deg"], name: () => "coverage", scale: () => scale, blank: (value) => value <= 0, controls: [bar], shown: show,
    });
  };

  /** A map of any column over any two parameters, a map for each value of a third. */
  const anyMap = () => {
    const choices = squama.varied.filter((name) => squama.numeric.includes(name));
    if (choices.length < 2 || measures.length === 0) return;
    const or = (chosen, others) => (choices.includes(chosen) ? chosen : others.find((name) => choices.includes(name)) ?? choices[0]);
    const x = () => or(state.mapX, ["gap_over_t"]);
    const y = () => (state.mapY !== x() && choices.includes(state.mapY) ? state.mapY : or(null, ["slant_deg", "length_over_t", ...choices].filter((name) => name !== x())));
    const across = () => ["length_over_t", "slant_deg", "gap_over_t", ...choices].find((name) => choices.includes(name) && name !== x() && name !== y());
    const name = () => (measures.includes(state.mapOf) ? state.mapOf : measures.includes("critical_force") ? "critical_force" : measures[0]);
    const { bar, show } = colorBar();
    const chooser = (key, label, options, chosen) => squama.dropdown({ id: key, "aria-label": label, onchange: (event) => { state[key] = event.target.value; squama.tell("view"); } }, options.map((one) => [one, squama.label(one)]), chosen());
    const all = [["mapOf", "Column", measures, name], ["mapX", "Parameter across", choices, x], ["mapY", "Parameter upwards", choices, y]];
    const [of, over, and] = all.map((one) => chooser(...one));
    squama.listen("view", () => all.forEach(([key, , , chosen]) => { squama.at(key).value = chosen(); }));
    maps("map", "Map: ", "Colours and contours; where contours crowd, a small change of a parameter changes much: a cliff. Struck through: the surface folds; grey: does not meet the requirements.", {
      axes: () => [x(), y(), across()], name, scale: () => axisOf(name()), controls: [of, " over ", over, " and ", and, bar], shown: show,
    });
  };

  const measures = squama.numeric.filter((name) => name !== "design" && !squama.axes.includes(name));
  const measure = () => (measures.includes(state.measure) ? state.measure : measures.find(squama.physical) ?? measures.find((name) => name === "sound_force") ?? measures[0]);

  const fixedMultiples = [
    ["critical-force", "critical_force", "Critical force", "Critical force for each slant."],
    ["penetration", "penetration", "Penetration", "Penetration at the critical tilt for each slant."],
    ["compliance", "compliance", "Flexural compliance", "Flexural compliance for each slant; open marks: no contact in bending. Without contact the slant does not matter, so that its marks coincide.", { open: true }],
  ].filter(([, column]) => squama.numeric.includes(column));

  const column = (name) => ({ column: name, goal: "max" });
  const draw = () => {
    const [first, ...others] = fixedMultiples;
    const put = ([id, name, ...more]) => multiples(id, () => name, ...more);
    if (first) put(first);
    const stiffnesses = ["max_stiffness", "secant_stiffness"].filter((name) => squama.numeric.includes(name) && squama.numeric.includes("critical_force"));
    if (stiffnesses.length > 0) scatter("stiffness", "Stiffness against critical force", "Puncture stiffness, the largest and that of the secant, against the critical force.", () => stiffnesses.map((name) => [column("critical_force"), column(name)]));
    others.forEach(put);
    if (["coverage", "length_over_t", "gap_over_t", "slant_deg"].every((name) => squama.numeric.includes(name))) coverageMaps();
    anyMap();
    const first4 = () => state.criteria.slice(0, 4);
    const pairs = () => first4().flatMap((a, i) => first4().slice(i + 1).map((b) => [a, b]));
    scatter("pareto", "Pareto fronts of two criteria", "In colour, on a line: designs that no other beats in both criteria, of those that meet the requirements.", pairs, { front: true });
    if (measures.length > 0) {
      const chooser = squama.dropdown({ id: "measure", "aria-label": "Column", onchange: (event) => { state.measure = event.target.value; squama.tell("view"); } }, measures.map((name) => [name, squama.label(name)]), measure());
      squama.listen("view", () => { chooser.value = measure(); });
      multiples("measure", measure, "Any column: ", "The column of your choice for each slant.", { controls: [chooser] });
    }
  };
  draw();
})();

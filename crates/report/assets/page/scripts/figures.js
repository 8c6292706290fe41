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
        const best = front ? fronts(rows.filter((row) => squama.passes[row]), a, b) : null;
        const marks = rows.map((row) => squama.mark(row, x[row], y[row], { faint: best !== null && !best.has(row) }));
        // Those that stand out are drawn last.
        if (best) marks.sort((p, q) => best.has(p.row) - best.has(q.row));
        return { ...place, x: axisOf(a.column), y: axisOf(b.column), xTicks: true, yTicks: true, xName: squama.axisName(a.column), yName: squama.axisName(b.column), marks, lines: best ? [line(best, x, y)] : [] };
      });
      const held = view.fixed(view.free());
      const rows = slice.filter((row) => chosen.some(([a, b]) => isNumber(a.column, b.column)(row)));
      return { panels: rows.length > 0 ? panels : [], height, rows, note: held.length > 0 ? `Shown: ${view.words(held)}.` : "" };
    };
    squama.addChart({ id, title, description, make, says: (row) => values(row, [...new Set(pairs().flat().map(({ column }) => column))]) });
  };

  const fronts = (rows, a, b) => squama.ranking.front(squama.ranking.contest(squama, rows, [a, b], "linear"));
  const line = (best, x, y) => ({ color: squama.themeNow.faint, width: 1.4, points: [...best].sort((p, q) => x[p] - x[q] || y[p] - y[q]).map((row) => [x[row], y[row]]) });

  const shade = (value) => squama.shades[Math.min(squama.shades.length - 1, Math.floor(value * squama.shades.length))];

  /** An axis on which every value has a place of its own; labels as many as there is room for. */
  const placesAxis = (all, room) => {
    const every = Math.ceil(all.length / Math.max(1, room));
    return { scale: "places", low: -0.5, high: all.length - 0.5, ticks: all.map((value, k) => ({ value: k, label: k % every === 0 ? squama.short(value) : null })).filter(({ label }) => label !== null) };
  };

  const coverageMaps = () => {
    const free = ["gap_over_t", "length_over_t", "slant_deg"];
    const [lengths, gaps] = [squama.different("length_over_t"), squama.different("gap_over_t")];
    const [across, up] = [lengths, gaps].map((all) => new Map(all.map((value, k) => [value, k])));
    const make = (width) => {
      const rows = view.slice(free).filter(isNumber("coverage", ...free));
      const margin = { left: 70, right: 12, top: 26, bottom: 48 };
      const { places, height } = squama.panel.grid(rows.length > 0 ? squama.slants.length : 0, width, { least: 190, height: 190, gaps: [14, 34], margin });
      const panels = places.map((place, k) => {
        const cell = [place.width / lengths.length + 0.4, place.height / gaps.length + 0.4];
        const own = rows.filter((row) => squama.slant(row) === squama.slants[k]);
        const marks = own.map((row) => {
          const value = squama.cell(row, "coverage");
          const fill = value <= 0 ? squama.themeNow.paper : squama.passes[row] ? shade(value) : squama.themeNow.line;
          return { row, x: across.get(squama.cell(row, "length_over_t")), y: up.get(squama.cell(row, "gap_over_t")), cell, fill, silent: !squama.passes[row] };
        });
        return { ...place, x: placesAxis(lengths, place.width / 36), y: placesAxis(gaps, place.height / 18), title: `$α$ = ${squama.slants[k].degrees}°`, marks, lines: [] };
      });
      const held = view.fixed(free);
      return { panels, height, rows, note: held.length > 0 ? `Shown: ${view.words(held)}.` : "", names: sharedNames(squama.axisName("length_over_t"), squama.axisName("gap_over_t"), width, height, margin) };
    };
    const bar = squama.element("span", { class: "shades" }, "0", squama.element("span", { style: `background: linear-gradient(to right, ${squama.shades.join(", ")})` }), "1");
    squama.addChart({ id: "coverage", title: "Coverage", description: "Coverage by gap, aspect ratio and slant; empty: none; grey: does not meet the requirements.", controls: [bar], make, says: (row) => values(row, ["coverage"]) });
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

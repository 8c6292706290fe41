// The figures, which the program has drawn. This script unpacks and shows them, hides designs that
// do not meet the requirements, and selects designs.

squama.charts = [];

(() => {
  const REACH = 14;
  const NAMED = 4;
  const { state, view } = squama;
  const tip = squama.element("div", { id: "tip", hidden: true, "aria-hidden": "true" });
  document.body.append(tip);

  /** Finds the figure of a chart for the selected variant and the shown parameter values. */
  const wanted = (chart) => squama.figures.find(({ kind, choice, part }) => kind === chart.id && (chart.choices.length === 0 || choice === chart.choice())
    && Object.entries(part).every(([name, value]) => view.shown(name) === value));

  /** Lists the marks of a drawing: element, row in the table or index in a front, and centre. */
  const marksOf = (svg) => [...svg.querySelectorAll("[data-design], [data-front]")].map((element) => {
    const [x, y, width, height] = ["x", "y", "width", "height"].map((name) => Number(element.getAttribute(name)));
    return { element, row: squama.rowOf(element.dataset.design), front: element.dataset.front, x: x + width / 2, y: y + height / 2 };
  });

  /** Hides designs that do not meet the requirements, and rings the selected and pinned designs. */
  const restyle = (chart) => {
    chart.stale = false;
    for (const mark of chart.marks) {
      mark.silent = mark.row !== null && !chart.passes(mark.row);
      mark.element.classList.toggle("out", mark.silent);
    }
    if (chart.svg) chart.restyle?.(chart);
    rings(chart);
  };

  const rings = (chart) => {
    chart.svg?.querySelectorAll(".ring").forEach((ring) => ring.remove());
    for (const [row, name, r] of [[state.pinned, "ring pinned", 11], [state.design, "ring", 8.5]].filter(([own]) => own !== null)) {
      chart.svg?.append(...chart.marks.filter((mark) => mark.row === row).map(({ x, y }) => squama.svg("circle", { class: name, cx: x, cy: y, r })));
    }
  };

  const isReady = (chart) => wanted(chart)?.text !== undefined || !wanted(chart);

  /** Shows the figure of a chart, if the figure is unpacked. */
  const draw = (chart) => {
    const figure = wanted(chart);
    if (!isReady(chart)) return;
    if (figure !== chart.figure || !chart.svg) {
      chart.figure = figure;
      chart.paper.innerHTML = figure?.text ?? "";
      chart.svg = chart.area.querySelector("svg");
      chart.marks = chart.svg ? marksOf(chart.svg) : [];
      chart.rows = [...new Set(chart.marks.map(({ row }) => row).filter((row) => row !== null))].sort((a, b) => a - b);
    }
    const missing = view.further.map((name) => `${squama.label(name)} ${squama.short(view.shown(name))}`).join(", ");
    chart.caption.textContent = figure ? chart.description : `The page has no figure for ${missing}. squama plot draws it from a run of these designs.`;
    restyle(chart);
  };

  // Only visible charts are drawn, one per time slice, so that the page stays responsive.
  const seen = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) squama.charts.find(({ area }) => area === target).seen = isIntersecting;
    later();
  }, { rootMargin: "300px" });
  let waiting = null;
  const drawNext = () => {
    waiting = null;
    const next = squama.contest && squama.charts.find((chart) => chart.stale && chart.seen && isReady(chart));
    if (!next) return;
    draw(next);
    later();
  };
  const later = () => {
    if (waiting === null) waiting = requestAnimationFrame(() => { waiting = setTimeout(drawNext); });
  };
  // Figures are unpacked one by one: visible ones first, then all others, which printing needs.
  const unpackNext = async () => {
    const next = squama.charts.filter(({ seen: own }) => own).map(wanted).find((figure) => figure && figure.text === undefined) ?? squama.figures.find(({ text }) => text === undefined);
    if (!next) return;
    next.text = await squama.unpacked(next.svg).text();
    later();
    unpackNext();
  };
  squama.redraw = () => {
    squama.charts.forEach((chart) => { chart.stale = true; });
    later();
  };
  /** Draws every chart, visible or not. */
  squama.drawAll = () => squama.charts.forEach(draw);
  squama.listen("selection view", squama.redraw);
  squama.listen("design pinned", () => squama.charts.forEach(rings));
  squama.listen("design", () => { if (view.further.length > 0) squama.redraw(); });

  /** Finds the mark nearest to the pointer, with other marks at the same position. */
  const near = (chart, event) => {
    if (!chart.svg) return [];
    const box = chart.svg.getBoundingClientRect(), scale = chart.svg.viewBox.baseVal.width / box.width, top = chart.svg.viewBox.baseVal.y;
    const [x, y] = [(event.clientX - box.x) * scale, (event.clientY - box.y) * scale + top];
    let nearest = null, least = (REACH * scale) ** 2;
    for (const mark of chart.marks) {
      const away = (mark.x - x) ** 2 + (mark.y - y) ** 2;
      if (away <= least && (nearest === null || !mark.silent || nearest.silent)) [nearest, least] = [mark, away];
    }
    const here = ({ x: left, y: down, silent }) => silent === nearest.silent && (left - nearest.x) ** 2 + (down - nearest.y) ** 2 < 2;
    const known = new Map(nearest === null ? [] : chart.marks.filter(here).map((mark) => [mark.front ?? mark.row, mark]));
    return [...known.values()].sort((a, b) => a.row - b.row);
  };

  const line = (chart, { row, front }) => (row === null ? chart.tip(Number(front))
    : squama.element("div", {}, ...squama.warning(row), ` ${squama.title(row)} `, squama.element("small", {}, chart.columns().map((name) => `${squama.label(name)} ${squama.short(squama.cell(row, name))}`).join(", "))));

  const showTip = (chart, event) => {
    const marks = near(chart, event);
    tip.hidden = marks.length === 0;
    chart.area.style.cursor = marks.length > 0 ? "pointer" : "default";
    if (marks.length === 0) return;
    tip.replaceChildren(...marks.slice(0, NAMED).map((mark) => line(chart, mark)),
      ...(marks.length > NAMED ? [squama.element("div", {}, `and ${marks.length - NAMED} more at the same position`)] : []),
      ...(marks.some(({ row }) => row !== null && squama.folded(row)) ? [squama.element("small", {}, "⚠ The surface folds: the critical force is not valid.")] : []));
    tip.style.left = `${Math.max(4, Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 6))}px`;
    tip.style.top = `${event.clientY + 16 + tip.offsetHeight > innerHeight ? event.clientY - tip.offsetHeight - 8 : event.clientY + 16}px`;
  };

  /** Selects the clicked design; more clicks cycle through overlapping marks. A design of a front opens in the explorer. */
  const click = (chart, event) => {
    const marks = near(chart, event), rows = marks.map(({ row }) => row).filter((row) => row !== null);
    if (rows.length > 0) squama.choose(rows[(rows.indexOf(state.design) + 1) % rows.length]);
    else if (marks.length > 0) chart.take(Number(marks[0].front));
  };

  const key = (chart, event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    squama.step(step, chart.rows);
  };

  /**
   * Adds a chart for a kind of figure, if the page has figures of this kind.
   *
   * `columns()` are the columns in the tooltip of a design. `tip(k)` is the tooltip of design `k` of
   * a front, and `take(k)` opens this design in the explorer. `passes(row)` is false for hidden
   * designs, and `restyle(chart)` updates everything else that depends on the requirements.
   */
  squama.addChart = ({ id, title, description, columns = () => [], passes = (row) => squama.passes[row], ...more }) => {
    const own = squama.figures.filter(({ kind }) => kind === id), choices = [...new Set(own.map(({ choice }) => choice))].filter(Boolean);
    if (own.length === 0) return;
    const choice = () => (choices.includes(state[id]) ? state[id] : choices[0]);
    const chooser = squama.dropdown({ id, "aria-label": "Column", onchange: (event) => { state[id] = event.target.value; squama.tell("view"); } }, choices.map((name) => [name, squama.label(name)]), choices[0]);
    squama.listen("view", () => { if (choices.length > 0) chooser.value = choice(); });
    const chart = { id, title, description, columns: () => [...columns(), ...choices.filter((name) => name === choice())], passes, choices, choice, ...more, marks: [], rows: [], stale: true, seen: false, caption: squama.element("figcaption") };
    // The height of the figure is reserved, so that the layout does not shift when it is drawn.
    chart.paper = squama.element("div", { style: `aspect-ratio: ${own[0].size.split(" ").slice(2).join("/")}` });
    chart.area = squama.element("div", { class: "chart drawn", id: `chart-${id}`, tabindex: 0, role: "img", "aria-label": `${title}. ${description} The arrow keys go from design to design.` }, chart.paper);
    (more.into ?? squama.at("figure-list")).append(squama.element("figure", { id: `figure-${id}` }, squama.element("h3", {}, title, ...(choices.length > 1 ? [" ", chooser] : [])), chart.area, chart.caption));
    squama.charts.push(chart);
    chart.area.addEventListener("pointermove", (event) => showTip(chart, event));
    chart.area.addEventListener("pointerleave", () => { tip.hidden = true; });
    chart.area.addEventListener("click", (event) => click(chart, event));
    chart.area.addEventListener("keydown", (event) => key(chart, event));
    seen.observe(chart.area);
  };

  const goalOf = (column) => squama.pareto.find((one) => one.column === column);

  /** Colours and connects the Pareto fronts of each comparable group of feasible designs. */
  const fronts = ({ svg }) => {
    const { rows } = squama.ranking.contest(squama, squama.rows.filter((row) => squama.passes[row]), squama.pareto, "paper");
    for (const panel of svg.querySelectorAll("[data-criteria]")) {
      const pair = panel.dataset.criteria.split(" ").map(goalOf);
      const best = squama.comparable.groups(rows, pair).map((group) => [...squama.ranking.front(squama.ranking.contest(squama, group, pair, "linear"))]);
      const all = new Set(best.flat()), marks = new Map();
      for (const element of panel.querySelectorAll("[data-design]")) {
        const row = squama.rowOf(element.dataset.design), { mark, color } = squama.slant(row), href = all.has(row) ? `#${mark}${squama.folded(row) ? "-folded" : ""}` : "#dot";
        if (element.getAttribute("href") !== href) squama.attributes(element, { href, color: all.has(row) ? color : "#b5b5b5" });
        if (all.has(row)) marks.set(row, element);
      }
      panel.append(...marks.values());
      const line = (group) => group.filter((row) => marks.has(row)).map((row) => ["x", "y"].map((name) => marks.get(row).getAttribute(name))).sort((a, b) => a[0] - b[0]);
      panel.querySelector(".line").setAttribute("d", best.map((group) => line(group).map(([x, y], k) => `${k === 0 ? "M" : "L"}${x} ${y}`).join(" ")).join(" "));
    }
  };

  const add = (id, title, description, ...columns) => squama.addChart({ id, title, description, columns: () => columns });
  add("critical-force", "Critical force", "Critical force for each slant.", squama.criticalForce);
  add("stiffness", "Stiffness against critical force", "Largest slope of the puncture path, and secant stiffness, against the critical force.", squama.criticalForce, ...squama.stiffnesses);
  add("penetration", "Penetration", "Penetration of the bases at the critical tilt for each slant; the needle goes deeper.", squama.penetration);
  add("compliance", "Flexural compliance", "Flexural compliance for each slant; open marks: no contact in bending. Without contact the slant does not matter, so that its marks coincide.", squama.compliance);
  add("coverage", "Coverage", "Coverage by gap, aspect ratio and slant, with contours; white: none.", squama.coverage);
  add("map", "Map: ", "Colours and contours; where contours are close, the column is sensitive to small changes. Struck through: the surface folds.");
  squama.addChart({ id: "pareto", title: "Pareto fronts of two criteria", description: "In colour, on a line: non-dominated designs in both criteria, among those that meet the requirements.", columns: () => squama.pareto.map(({ column }) => column), restyle: fronts });
  add("measure", "Any column: ", "The column of your choice for each slant.");
  unpackNext();
})();

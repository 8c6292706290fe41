// The best design for every weighting of four criteria: slices of the weight tetrahedron, with dots
// in the colours of designs.

(() => {
  const LISTED = 10;
  // Regions of designs with the same slant differ in shade.
  const SHADES = [0, 0.5, -0.4, 0.25, -0.2, 0.75];
  const { state, ranking } = squama;
  const [area, legend] = [squama.at("tetrahedron"), squama.at("tetrahedron-legend")];
  const words = squama.element("p", { class: "note" }), drawing = squama.element("div", { class: "drawn" });
  area.append(drawing, words);

  const shaded = (color, part) => `color-mix(in srgb, ${color}, ${part > 0 ? "white" : "black"} ${100 * Math.abs(part)}%)`;

  const colored = (regions) => {
    const counts = new Map();
    return new Map(regions.map(({ row }) => {
      const slant = squama.slant(row), before = counts.get(slant) ?? 0;
      counts.set(slant, before + 1);
      return [row, shaded(slant.color, SHADES[before % SHADES.length])];
    }));
  };

  const entry = (colors) => ({ row, share }) => squama.element("button", { type: "button", onclick: () => squama.choose(row) },
    squama.element("span", { class: "swatch", style: `background: ${colors.get(row)}` }), ...squama.warning(row), `${squama.title(row)}: ${(100 * share).toFixed(1)} %`);

  let winners = new Map();
  const weights = (dot) => dot.dataset.steps.split(",").map((step) => step / 20);

  /** Marks the dot nearest to the weights of the sliders with a ring. */
  const ring = () => {
    const dots = [...drawing.querySelectorAll("[data-steps]")], now = squama.weights();
    const away = (dot) => weights(dot).reduce((sum, weight, k) => sum + (weight - now[k]) ** 2, 0);
    const nearest = dots.length > 0 ? dots.reduce((a, b) => (away(b) < away(a) - 1e-12 ? b : a)) : null;
    dots.forEach((dot) => dot.classList.toggle("now", dot === nearest));
  };

  const show = () => {
    const isUsual = ranking.areUsual(state.criteria);
    const isDrawn = isUsual && squama.contest.rows.length > 0;
    drawing.hidden = !isDrawn;
    words.hidden = isDrawn;
    squama.at("tetrahedron-figure").classList.toggle("empty", !isDrawn);
    words.textContent = squama.contest.rows.length === 0 ? "There is nothing to rank." : isUsual ? "" : "The figure shows four criteria: the default ones.";
    legend.replaceChildren();
    if (!isDrawn) return;
    const { dots, regions } = squama.weightings.winners(squama.contest), colors = colored(regions);
    winners = new Map(dots.map(({ weights: own, row }) => [own.map((weight) => Math.round(20 * weight)).join(), row]));
    drawing.querySelectorAll("[data-steps]").forEach((dot) => { dot.style.fill = colors.get(winners.get(dot.dataset.steps)); });
    legend.append(...regions.slice(0, LISTED).map(entry(colors)));
    if (regions.length > LISTED) legend.append(squama.element("span", {}, `and ${regions.length - LISTED} more`));
    ring();
  };

  drawing.addEventListener("click", (event) => {
    const { steps } = event.target.dataset;
    if (steps) squama.choose(winners.get(steps));
  });
  let timer = null;
  squama.listen("selection", () => {
    clearTimeout(timer);
    timer = setTimeout(show, 30);
  });
  squama.listen("weights", ring);
  const figure = squama.figures.find(({ kind }) => kind === "weights");
  squama.unpacked(figure.svg).text().then((svg) => {
    drawing.innerHTML = svg;
    if (squama.contest) show();
  });
})();

// The address contains the state of the page: `#require=coverage >= 0.6&weights=40,30,20,10`.
// Initial values are omitted.

(() => {
  const DELAY = 250;
  const { ranking, state } = squama;

  const texts = {
    criteria: () => state.criteria.map(({ goal, column }) => `${goal}:${column}`).join(","),
    weights: () => state.weights.join(","),
  };
  const atFirst = Object.fromEntries(Object.entries(texts).map(([key, text]) => [key, text()]));

  /** Formats the state as the part of the address after `#`. */
  squama.written = () => {
    const parts = new URLSearchParams();
    squama.required().forEach((one) => parts.append("require", ranking.written(one)));
    for (const [key, text] of Object.entries(texts)) if (text() !== atFirst[key]) parts.set(key, text());
    if (state.scale !== "paper") parts.set("scale", state.scale);
    if (state.sound) parts.set("sound", "yes");
    if (state.log) parts.set("log", "yes");
    for (const key of ["measure", "map", "columns"]) if (state[key] !== null) parts.set(key, state[key]);
    for (const [axis, value] of Object.entries(state.shown)) parts.set(`show.${axis}`, String(value));
    if (state.sort !== "design") parts.set("sort", state.sort);
    for (const key of ["design", "pinned"]) if (state[key] !== null) parts.set(key, squama.number(state[key]));
    return [parts.toString(), squama.live?.written()].filter(Boolean).join("&");
  };

  const readCriteria = (parts, next) => {
    const criteria = parts.get("criteria")?.split(",").map((text) => ranking.criterion(squama, text)).filter(Boolean);
    if (criteria?.length > 0) next.criteria = criteria.slice(0, ranking.MOST_CRITERIA);
    const weights = parts.get("weights")?.split(",").map(Number) ?? [];
    const right = weights.length === next.criteria.length && weights.every((weight) => weight >= 0) && weights.some((weight) => weight > 0);
    next.weights = right ? squama.hundredths(weights) : squama.equalWeights(next.criteria.length);
  };

  /** Finds the value of an axis by its text. */
  const valueOf = (axis, text) => squama.different(axis).find((value) => String(value) === text);

  const readView = (parts, next) => {
    for (const key of ["measure", "map"]) if (squama.numeric.includes(parts.get(key))) next[key] = parts.get(key);
    for (const axis of squama.varied) {
      const value = valueOf(axis, parts.get(`show.${axis}`));
      if (value !== undefined) next.shown[axis] = value;
    }
    next.columns = parts.get("columns");
    if (squama.has((parts.get("sort") ?? "").replace("-", ""))) next.sort = parts.get("sort");
    for (const key of ["design", "pinned"]) next[key] = squama.rowOf(parts.get(key));
  };

  /** Reads the state from a text; invalid parts are ignored, and invalid requirements are reported. */
  squama.read = (text) => {
    const parts = new URLSearchParams(text), next = squama.initial();
    const asked = parts.getAll("require").map((one) => [one, ranking.requirement(squama, one)]);
    next.requirements = asked.map(([, one]) => one).filter(Boolean);
    squama.unread = asked.filter(([, one]) => one === null).map(([one]) => one);
    readCriteria(parts, next);
    if (ranking.SCALES.includes(parts.get("scale"))) next.scale = parts.get("scale");
    next.sound = parts.get("sound") === "yes";
    next.log = parts.get("log") === "yes";
    readView(parts, next);
    Object.assign(state, next);
  };

  /** Shows a new state: selects a design if none is selected, ranks, and notifies all listeners. */
  squama.showAll = () => {
    if (state.design === null && squama.count > 0) state.design = squama.ranking.order(squama.contestNow(), squama.weights(), 1)[0]?.row ?? 0;
    squama.refresh();
    ["view", "design", "pinned"].forEach(squama.tell);
  };

  // The address is written after a delay, because sliders change often and browsers limit the rate.
  let timer = null, own = null, known = location.hash;
  const write = () => {
    // An address that the user has changed has priority.
    if (location.hash !== known && location.hash.includes("=")) return;
    own = `#${squama.written()}`;
    try { history.replaceState(null, "", own); } catch { /* The page works without an address. */ }
    known = location.hash;
  };
  squama.writeAddress = () => {
    clearTimeout(timer);
    timer = setTimeout(write, DELAY);
  };
  addEventListener("hashchange", () => {
    if (location.hash === own || !location.hash.includes("=")) return;
    clearTimeout(timer);
    known = location.hash;
    squama.read(location.hash.slice(1));
    squama.showAll();
  });
})();

// Requirements as a sentence, and the search for the nearest design that meets these requirements.

(() => {
  const { at, live } = squama;
  const EXAMPLE = "pin 2 mm, 5 N, bends to 25 mm, gap 0.4 mm, covers 50 %";
  // Maximum number of designs that a search solves, and number of initial designs spread over the
  // ranges of the sliders.
  const MOST = 160, SPREAD = 40;
  // Number of sliders that a search moves.
  const VARIED = 4;
  // Number of bisections towards the present design. The last step is finer than a slider step.
  const HALVINGS = 7;
  // Shortfall of a missing value, larger than any other shortfall.
  const MISSING = 100;

  const force = () => live.data.measures[1].physical;
  // Clauses of a sentence: a pattern with a number, and the requirement or pin diameter that it means.
  const NUMBER = "(\\d+(?:[.,]\\d+)?)";
  const CLAUSES = [
    [`\\b(?:pin|needle|nail|tip)\\b.*?${NUMBER} ?mm`, (size) => ({ pin: size })],
    [`${NUMBER} ?N\\b`, (limit) => ({ requirement: `${force()} >= ${limit}` })],
    [`\\b(?:bend|curve|radius).*?${NUMBER} ?mm`, (limit) => ({ requirement: `bend_radius_mm <= ${limit}` })],
    [`\\bcover.*?${NUMBER} ?%`, (percent) => ({ requirement: `coverage >= ${percent / 100}` })],
    [`\\bcover.*?${NUMBER}$`, (limit) => ({ requirement: `coverage >= ${limit}` })],
    [`\\b(?:gap|clear).*?${NUMBER} ?mm`, (limit) => ({ requirement: `clearance_mm >= ${limit}` })],
    [`\\bde(?:ep|pth).*?${NUMBER} ?mm`, (limit) => ({ requirement: `critical_displacement_mm <= ${limit}` })],
    [`${NUMBER} ?kg`, (limit) => ({ requirement: `areal_mass_kg_m2 <= ${limit}` })],
  ];
  const PLAIN = /^\w+ ?(>=|<=|>|<) ?-?[\d.]+$/;

  /** Reads a clause such as "5 N", or a requirement such as "coverage >= 0.6"; null for other texts. */
  const clause = (text) => {
    if (PLAIN.test(text)) return { requirement: text };
    for (const [pattern, meaning] of CLAUSES) {
      const found = text.match(new RegExp(pattern, "i"));
      if (found) return meaning(Number(found[1].replace(",", ".")));
    }
    return null;
  };
  /** Reads a sentence: the clauses, and the parts that are not understood. */
  const read = (sentence) => {
    const parts = sentence.split(/,(?!\d)|;|\band\b/).map((part) => part.trim()).filter(Boolean);
    const meanings = parts.map(clause);
    return { known: meanings.filter(Boolean), unknown: parts.filter((_, k) => !meanings[k]) };
  };

  // The parameters to which the message on the page applies.
  let about = "";
  const say = (text) => {
    at("live-found").textContent = text;
    about = JSON.stringify(live.values());
  };
  const refused = ({ known, unknown }) => {
    if (unknown.length > 0 || known.length === 0) return `Not understood: ${unknown.join(", ") || "an empty sentence"}. An example: ${EXAMPLE}`;
    const isInMm = ({ pin, requirement }) => pin || /_(mm|N|kg)/.test(requirement);
    if (known.some(isInMm) && !live.millimetres()) return "Millimetres need thickness_mm in the [material] of the definition.";
    if (known.some(({ requirement }) => requirement?.includes("_N ")) && !live.answer?.units.force) return "Newtons need substrate_modulus_MPa in the [material] of the definition.";
    if (known.some(({ pin }) => pin) && !live.control("needle_radius_over_t")) return "This page has no control for the radius of the needle.";
    return "";
  };

  /** Returns the largest violation of a requirement, relative to its limit; at most 0 if all are met. */
  const shortfall = ({ error, requirements }) => {
    if (error) return Infinity;
    const known = requirements.filter(({ margin }) => margin !== null);
    return MISSING * (requirements.length - known.length) + Math.max(...known.map(({ margin }) => -margin), -1);
  };

  /** Returns number `k` of the Halton sequence with this base, which fills 0 to 1 evenly. */
  const halton = (k, base) => (k === 0 ? 0 : ((k % base) + halton(Math.floor(k / base), base)) / base);
  const distance = (one, other) => Math.hypot(...one.map((own, j) => own - other[j]));
  const between = (one, other, share) => one.map((own, j) => own + share * (other[j] - own));

  const share = ({ min, max }, value) => (value - min) / (max - min);
  /** Lists points where a search may start: solved designs of the sweep, otherwise an even spread. */
  const starts = (varied, present) => {
    const { columns, rows } = live.data.solved, at = (key) => columns.indexOf(key);
    if (rows.length === 0) return Array.from({ length: SPREAD }, (_, k) => varied.map((_, j) => halton(k + 1, [2, 3, 5, 7][j])));
    const required = live.required().map((text) => text.match(/^(\w+) ?(\S+?) ?(\S+)$/));
    const misses = (row) => Math.max(...required.map(([, column, sign, limit]) => {
      const value = row[at(column)];
      return value === null || value === undefined ? MISSING : ((sign[0] === ">" ? 1 : -1) * (limit - value)) / Math.abs(limit);
    }));
    const point = (row) => varied.map((control, j) => (at(control.key) < 0 ? present[j] : share(control, row[at(control.key)])));
    const candidates = rows.map((row) => ({ miss: Math.max(0, misses(row)), far: distance(point(row), present), point: point(row) }));
    return candidates.sort((one, other) => one.miss - other.miss || one.far - other.far).slice(0, SPREAD / 4).map((one) => one.point);
  };

  let searching = null;
  /** Searches for the nearest design that meets the requirements, by moving the first sliders. */
  const search = async () => {
    const own = {}, values = live.values(), varied = live.controls().slice(0, VARIED);
    searching = own;
    const settings = (point) => Object.fromEntries(varied.map(({ key, min, max }, j) => [key, Number((min + point[j] * (max - min)).toPrecision(6))]));
    let count = 0;
    const evaluate = async (point) => {
      count += 1;
      say(`Searching … ${count} of at most ${MOST} designs`);
      const answer = await squama.solver.measure(live.request({ ...values, ...settings(point) }));
      if (searching !== own) throw own;
      return { point, answer, miss: shortfall(answer) };
    };
    const better = (one, other) => (other.miss < one.miss ? other : one);
    const present = await evaluate(varied.map((control) => share(control, control.value)));
    let best = present, tried = [present];
    for (const point of present.miss > 0 ? starts(varied, present.point) : []) tried.push(await evaluate(point));
    const met = tried.filter(({ miss }) => miss <= 0).sort((one, other) => distance(one.point, present.point) - distance(other.point, present.point));
    best = met[0] ?? tried.reduce(better);
    // Pattern search from the best three: moves one slider at a time, and halves the step.
    tried = tried.sort((one, other) => one.miss - other.miss).slice(0, 3);
    for (let local of best.miss > 0 ? tried : []) {
      for (let step = 0.16; step > 0.004 && best.miss > 0 && count < MOST - HALVINGS; step /= 2) {
        for (let j = 0, still = 0; still < 2 * varied.length && local.miss > 0 && count < MOST - HALVINGS; j += 1) {
          const side = j % 2 ? -step : step, axis = Math.floor(j / 2) % varied.length;
          const next = await evaluate(local.point.map((own, k) => Math.min(1, Math.max(0, k === axis ? own + side : own))));
          still = next.miss < local.miss ? 0 : still + 1;
          local = better(local, next);
        }
        best = better(best, local);
      }
    }
    // Bisects the line to the present design, down to the nearest design that meets the requirements.
    if (best.miss <= 0 && present.miss > 0) {
      for (let k = 0, [near, far] = [0, 1], from = best.point; k < HALVINGS; k += 1) {
        const middle = (near + far) / 2, next = await evaluate(between(present.point, from, middle));
        if (next.miss <= 0) [far, best] = [middle, next];
        else near = middle;
      }
    }
    return { present, best, count, settings: settings(best.point) };
  };

  const missed = ({ requirements, error }) => (error ? [error] : requirements.filter(({ met }) => !met)
    .map(({ text, value }) => `${live.inWords(text)}, here ${live.digits(value, 3)}`)).join("; ");
  const find = async () => {
    const meaning = read(live.sentence), problem = refused(meaning);
    if (problem) return say(problem);
    live.wanted = meaning.known.map(({ requirement }) => requirement).filter(Boolean);
    const pin = meaning.known.find((one) => one.pin)?.pin;
    if (pin) {
      const control = live.control("needle_radius_over_t"), radius = pin / 2 / (control.unit === "mm" ? 1 : live.millimetres());
      control.max = Math.max(control.max, radius);
      live.set({ needle: "guided", [control.key]: radius });
    } else live.set({});
    try {
      const { present, best, count, settings } = await search();
      if (best !== present) live.set(settings);
      else live.solve();
      if (present.miss <= 0) say("The present design meets the requirements.");
      else if (best.miss <= 0) say(`This design meets the requirements. It is the nearest of ${count} solved designs.`);
      else say(`None of ${count} solved designs meets the requirements. The nearest one is shown: ${missed(best.answer)}. The command squama optimise searches longer.`);
    } catch (stopped) {
      if (!(stopped instanceof Error)) say("Search stopped.");
      else throw stopped;
    }
  };

  /** Shows a sentence and its requirements, without a search. */
  live.ask = (sentence) => {
    at("live-sentence").value = live.sentence = sentence;
    live.wanted = read(sentence).known.map(({ requirement }) => requirement).filter(Boolean);
  };
  at("live-ask").addEventListener("submit", (event) => {
    event.preventDefault();
    live.sentence = at("live-sentence").value.trim();
    find();
  });
  live.listen("moved", () => {
    if (JSON.stringify(live.values()) === about) return;
    searching = null;
    say("");
  });
  at("live-sentence").placeholder = EXAMPLE;
  // The page of a run has requirements of its own.
  at("live-ask").hidden = Boolean(squama.state);
})();

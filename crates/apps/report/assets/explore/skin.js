// State of the explorer: parameters, pinned design, last answer, and its form in the address.

squama.live = (() => {
  const data = JSON.parse(squama.at("live-data").textContent);
  const controls = new Map(data.controls.map((control) => [control.key, control]));
  const listeners = { moved: [], answered: [] };
  const live = { data, answer: null, pinned: null, drawn: [1, 1], chosen: data.measures[1].name, said: "", times: [] };

  // True if the user changed the design since it was opened.
  live.moved = false;
  live.listen = (topic, listener) => listeners[topic].push(listener);
  const tell = (topic) => listeners[topic].forEach((listener) => listener());
  live.show = () => tell("answered");
  /** Returns a placeholder until there is an answer, otherwise null. */
  live.solving = () => (live.answer ? null : live.error ? "no answer" : "solving …");

  live.guided = () => controls.get("needle")?.value === "guided";
  /** Lists the active controls: some apply only to one kind of needle. */
  live.controls = () => [...controls.values()].filter(({ only }) => !only || live.guided() === (only === "guided"));
  live.control = (key) => controls.get(key);
  live.value = (key) => controls.get(key).value;
  live.values = () => Object.fromEntries([...controls.values()].map(({ key, value }) => [key, value]));

  live.digits = (number, count = 4) => (number === null || number === undefined ? "–" : String(Number(number.toPrecision(count))));
  /** Returns the thickness in mm, the unit of lengths over t, if it is known. */
  live.millimetres = () => controls.get("thickness_mm")?.value ?? data.thickness;
  /** Returns the display factor and unit of a control. */
  live.shownAs = ({ unit }) => {
    const thickness = live.millimetres();
    if (unit === "t" && thickness) return [thickness, "mm"];
    return [1, { "-": "", deg: "°" }[unit] ?? unit];
  };
  live.text = (key) => {
    const control = controls.get(key), [factor, unit] = live.shownAs(control);
    if (control.words) return control.value;
    if (control.is_radius) return control.value === 0 ? "flat" : `${control.value < 0 ? "concave" : "convex"}, ${live.digits(Math.abs(factor / control.value), 3)} ${unit}`;
    return `${live.digits(control.value * factor, 3)}${unit === "°" ? "" : " "}${unit}`.trim();
  };

  /** Returns the requirements: of the page of a run, otherwise of the definition. */
  live.required = () => squama.required?.().filter(({ sign }) => sign !== "~").map(squama.ranking.written) ?? data.requirements;

  // The control of a radius holds a curvature, because its range contains a flat body.
  const holdsCurvature = ({ is_radius, key }) => is_radius && key !== "curvature_times_t";
  const isFlat = (control) => control.is_radius && control.value === 0;
  /** Returns the value of a parameter for the value that its control holds. */
  const outside = (control, value) => {
    if (!holdsCurvature(control)) return value;
    return value === 0 ? "flat" : Number((1 / value).toPrecision(6));
  };
  /** Returns the value that a control holds for the value of its parameter. */
  const inside = (control, value) => {
    if (!holdsCurvature(control)) return value;
    return value === "flat" ? 0 : 1 / value;
  };
  live.inside = inside;
  /** Returns the curvature of the body in 1/t. */
  live.curvature = (values) => {
    const { key, unit } = [...controls.values()].find(({ is_radius }) => is_radius);
    return values[key] * (unit === "mm" ? values.thickness_mm ?? data.thickness : 1);
  };

  const request = () => ({
    definition: data.definition, require: live.required(), drawn: live.drawn,
    set: Object.fromEntries(live.controls().map((control) => (isFlat(control) ? ["curvature_times_t", 0] : [control.key, outside(control, control.value)]))),
  });
  live.solve = () => squama.solver.solve(request());

  // Rounded to six digits, as in the address.
  const clamped = (control, value) => {
    const { words, min, max } = control;
    if (words) return words.includes(value) ? value : words[0];
    if (control.is_radius) return inside(control, outside(control, Math.min(max, Math.max(min, value))));
    return Number(Math.min(max, Math.max(min, value)).toPrecision(6));
  };
  for (const control of controls.values()) control.value = clamped(control, control.value);
  live.opened = live.values();
  // Duration of an animated change to a limit, ms: slow enough to follow.
  const WALK = 1200;
  let walking = null;
  /** Sets parameters within their ranges, and solves. User input ends an animated change. */
  live.set = (values, said = "", isStep = false) => {
    if (!isStep) cancelAnimationFrame(walking);
    for (const [key, value] of Object.entries(values)) {
      const control = controls.get(key);
      if (control && (control.words || Number.isFinite(value))) control.value = clamped(control, value);
    }
    live.said = said;
    live.moved = true;
    tell("moved");
    live.solve();
    if (!isStep) live.remember();
  };
  /** Draws puncture or bending at a fraction of its path. */
  live.draw = (load, share) => {
    live.drawn[load] = Math.min(1, Math.max(0, share));
    tell("moved");
    live.solve();
  };
  /** Moves a parameter until the chosen measure stops improving or a limit is reached. */
  live.follow = (key, up) => {
    const { min, max } = controls.get(key);
    squama.solver.follow(request(), { key, to: up ? max : min, measure: live.chosen });
  };
  live.pin = () => {
    live.pinned = live.pinned ? null : { answer: live.answer, values: live.values() };
    tell("moved");
    tell("answered");
  };

  const walk = ({ key, value, reason }) => {
    const { label, value: from } = controls.get(key), begun = performance.now(), time = matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : WALK;
    const step = (now) => {
      const share = time > 0 ? Math.min(1, Math.max(0, (now - begun) / time)) : 1, is = share < 1;
      live.set({ [key]: from + share * (value - from) }, is ? `${label}: moving` : `${label}: ${reason}`, is);
      if (is) walking = requestAnimationFrame(step);
    };
    step(begun);
  };

  live.take = (answer, question) => {
    if (question) live.times.push(performance.now() - question.at);
    if (answer.follow) return walk(answer.follow);
    live.error = answer.error ?? null;
    // Fast answers have no derivatives: the last ones are shown until the next complete answer.
    if (!answer.error) live.answer = answer.fine ? answer : { ...answer, slopes: live.answer?.slopes ?? [] };
    tell("answered");
  };

  const KEY = "live.";
  /** Formats the parameters for the address. */
  live.written = () => (live.moved ? [...controls.values()].map((control) => `${KEY}${control.key}=${outside(control, control.value)}`).join("&") : "");
  live.read = (text) => {
    const parts = new URLSearchParams(text);
    for (const control of controls.values()) {
      const value = parts.get(KEY + control.key);
      if (value === null || value === "") continue;
      const number = inside(control, value === "flat" ? value : Number(value));
      if (control.words || Number.isFinite(number)) control.value = clamped(control, control.words ? value : number);
    }
  };
  live.remember = () => {
    // The page of a run writes its own address, which includes these parameters.
    if (squama.writeAddress) squama.writeAddress();
    else try { history.replaceState(null, "", `#${live.written()}`); } catch { /* The page works without an address. */ }
  };
  return live;
})();

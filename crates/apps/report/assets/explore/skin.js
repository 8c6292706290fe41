// State of the explorer: parameters, pinned design and last answer of the solver. The address
// contains the parameters.

squama.live = (() => {
  const data = JSON.parse(squama.at("live-data").textContent);
  const controls = new Map(data.controls.map((control) => [control.key, control]));
  // Controls of lengths in mm are also found by the key of the length divided by the thickness.
  const over = new Map(data.controls.map((control) => [control.over_t, control]));
  const listeners = { moved: [], answered: [] };
  const live = { data, answer: null, pinned: null, drawn: [1, 1], chosen: data.measures[1].name, said: "", times: [] };

  // True if the user has changed the design since the page was opened.
  live.moved = false;
  live.listen = (topic, listener) => listeners[topic].push(listener);
  const tell = (topic) => listeners[topic].forEach((listener) => listener());
  live.show = () => tell("answered");
  /** Returns a placeholder text until the solver has answered, then null. */
  live.solving = () => (live.answer ? null : live.error ? "no answer" : "solving …");

  live.guided = () => controls.get("needle")?.value === "guided";
  /** Lists the active controls: some apply only to one kind of needle. */
  live.controls = () => [...controls.values()].filter(({ only }) => !only || live.guided() === (only === "guided"));
  live.control = (key) => controls.get(key) ?? over.get(key);
  live.values = () => Object.fromEntries([...controls.values()].map(({ key, value }) => [key, value]));
  /** Returns the value of the parameter `key`; converts a length in mm if `key` is a ratio to t. */
  live.value = (key, values = live.values()) => {
    const control = live.control(key);
    return values[control.key] / (key === control.key ? 1 : values.thickness_mm ?? data.thickness);
  };
  /** Returns the value of a control; a needle that was not dragged has the position in the last answer. */
  live.current = ({ value, max }) => value ?? live.answer?.puncture?.load_position ?? max;

  live.digits = (number, count = 4) => (number === null || number === undefined ? "–" : String(Number(number.toPrecision(count))));
  /** Returns the thickness in mm, or null if it is unknown. */
  live.millimetres = () => controls.get("thickness_mm")?.value ?? data.thickness;
  /** Returns the display factor and unit of a control. */
  live.shownAs = ({ unit }) => {
    const thickness = live.millimetres();
    if (unit === "t" && thickness) return [thickness, "mm"];
    return [1, { "-": "", deg: "°" }[unit] ?? unit];
  };
  live.text = (key) => {
    const control = live.control(key), [factor, unit] = live.shownAs(control);
    if (control.words) return control.value;
    if (control.zero && control.value === 0) return control.zero;
    if (control.is_radius) return `${control.value < 0 ? "concave" : "convex"}, ${live.digits(Math.abs(factor / control.value), 3)} ${unit}`;
    return `${live.digits(live.current(control) * factor, 3)}${unit === "°" ? "" : " "}${unit}`.trim();
  };

  // A requirement of the sentence replaces the requirement of the definition on the same column.
  live.wanted = [];
  const columnOf = (requirement) => requirement.match(/^\w+/)[0];
  const others = () => data.requirements.filter((own) => !live.wanted.some((wanted) => columnOf(wanted) === columnOf(own)));
  /** Returns the requirements of the page of a run, otherwise of the definition and the sentence. */
  live.required = () => squama.required?.().filter(({ sign }) => sign !== "~").map(squama.ranking.written) ?? [...others(), ...live.wanted];

  // The control of a radius contains a curvature, because the range includes a flat body.
  const holdsCurvature = ({ is_radius, key }) => is_radius && key !== "curvature_times_t";
  /** Converts the value of a control to the value of its parameter. */
  const outside = (control, value) => {
    if (!holdsCurvature(control)) return value;
    return value === 0 ? "flat" : Number((1 / value).toPrecision(6));
  };
  /** Converts the value of a parameter to the value of its control. */
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

  const setting = (control, value) => (control.is_radius && value === 0 ? ["curvature_times_t", 0] : [control.key, outside(control, value)]);
  // The parameter is absent from a request if its value is null, or 0 for a sharp needle.
  const isSet = (control, value) => value !== null && (control.is_radius || !control.zero || value !== 0);
  /** Returns a request to solve the design with these values. */
  live.request = (values = live.values()) => {
    const set = live.controls().filter((control) => isSet(control, values[control.key])).map((control) => setting(control, values[control.key]));
    return { definition: data.definition, require: live.required(), drawn: live.drawn, set: Object.fromEntries(set) };
  };
  live.solve = () => squama.solver.solve(live.request());

  // Limits a value to the range of its control, and rounds it to six digits, as in the address.
  const clamped = (control, value) => {
    const { words, min, max } = control;
    if (value === null) return null;
    if (words) return words.includes(value) ? value : words[0];
    if (control.is_radius) return inside(control, outside(control, Math.min(max, Math.max(min, value))));
    return Number(Math.min(max, Math.max(min, value)).toPrecision(6));
  };
  for (const control of controls.values()) control.value = clamped(control, control.value);
  live.opened = live.values();
  // Duration of an animated change of a parameter, ms: slow enough to watch.
  const ANIMATION = 1200;
  let animation = null;
  /** Sets parameters within their ranges, and solves. User input ends an animated change. */
  live.set = (values, said = "", isStep = false) => {
    if (!isStep) cancelAnimationFrame(animation);
    for (const [key, value] of Object.entries(values)) {
      const control = live.control(key);
      if (!control || !(control.words || value === null || Number.isFinite(value))) continue;
      control.value = clamped(control, key === control.key ? value : value * live.millimetres());
    }
    live.said = said;
    live.moved = true;
    tell("moved");
    live.solve();
    if (!isStep) live.remember();
  };
  /** Returns the settings of another thickness that leave the lengths of `values` unchanged in mm. */
  live.withThickness = (thickness, values) => {
    const ratio = values.thickness_mm / thickness, isScaled = ({ key, unit }) => unit === "t" && values[key] !== null;
    const scaled = [...controls.values()].filter(isScaled).map(({ key, is_radius }) => [key, is_radius ? values[key] / ratio : values[key] * ratio]);
    return { thickness_mm: thickness, ...Object.fromEntries(scaled) };
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
    squama.solver.follow(live.request(), { key, to: up ? max : min, measure: live.chosen });
  };
  live.pin = () => {
    live.pinned = live.pinned ? null : { answer: live.answer, values: live.values() };
    tell("moved");
    tell("answered");
  };

  const animate = ({ key, value, reason }) => {
    const { label } = controls.get(key), from = live.current(controls.get(key)), begun = performance.now(), time = matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : ANIMATION;
    const step = (now) => {
      const share = time > 0 ? Math.min(1, Math.max(0, (now - begun) / time)) : 1, is = share < 1;
      live.set({ [key]: from + share * (value - from) }, is ? `${label}: moving` : `${label}: ${reason}`, is);
      if (is) animation = requestAnimationFrame(step);
    };
    step(begun);
  };

  live.take = (answer, question) => {
    if (question) live.times.push(performance.now() - question.at);
    if (answer.follow) return animate(answer.follow);
    live.error = answer.error ?? null;
    // A fast answer has no derivatives: the page keeps the previous ones until a complete answer.
    if (!answer.error) live.answer = answer.fine ? answer : { ...answer, slopes: live.answer?.slopes ?? [] };
    tell("answered");
  };

  const KEY = "live.";
  /** Formats the parameters for the address. */
  live.written = () => {
    const moved = live.moved ? [...controls.values()].filter(({ value }) => value !== null) : [];
    const parts = moved.map((control) => `${KEY}${control.key}=${outside(control, control.value)}`);
    if (live.sentence) parts.push(`${KEY}sentence=${encodeURIComponent(live.sentence)}`);
    return parts.join("&");
  };
  live.read = (text) => {
    const parts = new URLSearchParams(text);
    live.ask?.(parts.get(`${KEY}sentence`) ?? "");
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

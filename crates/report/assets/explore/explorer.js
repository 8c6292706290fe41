"use strict";
// Sliders, measures, curves and the hand that moves them.

(() => {
  const { element, svg, at } = squama;
  const controls = new Map(squama.data.controls.map((control) => [control.key, control]));
  squama.load = "puncture";
  squama.answer = null;
  let position = 1, chosen = "critical_force", pinned = null;

  const digits = (number) => (number === null ? "–" : Number(number.toPrecision(4)).toString());
  squama.value = (key) => controls.get(key)?.value ?? squama.data.fixed[key];
  squama.text = (key) => {
    const control = controls.get(key);
    return control ? `${control.label} ${digits(control.value)} ${control.unit === "-" ? "" : control.unit}`.trim() : key;
  };

  /** Moves a parameter, within its range, and solves. */
  squama.set = (key, value) => {
    const control = controls.get(key);
    if (!control || !Number.isFinite(value)) return;
    control.value = Number(Math.min(control.max, Math.max(control.min, value)).toPrecision(5));
    control.show();
    position = 1;
    squama.scene.draw();
    squama.solver.solve(settings());
    history.replaceState(null, "", address());
  };
  squama.nudge = (key, steps) => squama.set(key, squama.value(key) + steps * controls.get(key).step);

  const settings = () => [...controls.values()].map(({ key, section, value }) => `${section}.${key}=${value}`);
  const address = () => `#${[...controls.values()].map(({ key, value }) => `${key}=${value}`).join("&")}`;
  const fromAddress = () => {
    for (const [key, value] of new URLSearchParams(location.hash.slice(1))) {
      const control = controls.get(key), number = Number(value.replace(",", "."));
      if (control && value !== "" && Number.isFinite(number)) control.value = Math.min(control.max, Math.max(control.min, number));
    }
  };

  const path = () => squama.answer?.[squama.load === "bend" ? "flexure" : "puncture"];

  /** The state that is drawn: the one of the frames that the position is nearest to; none at rest. */
  squama.state = () => {
    const frames = path()?.frames ?? [];
    if (position === 0 || frames.length === 0 || squama.scene.grabbed()) return null;
    return frames[Math.max(0, Math.ceil(position * frames.length) - 1)];
  };
  const named = (name) => squama.answer?.values?.find((value) => value.name === name);
  const inNewtons = () => {
    const [dimensionless, physical] = [named("critical_force")?.value, named("critical_force_N")?.value];
    return dimensionless && physical ? physical / dimensionless : null;
  };
  squama.forceText = () => {
    const force = squama.state()?.force;
    if (force === undefined) return "";
    const unit = inNewtons();
    return unit ? `${digits(force * unit)} N` : `F* ${digits(force)}`;
  };

  const slider = (control) => {
    const id = `control-${control.key}`;
    const range = element("input", { type: "range", id, min: control.min, max: control.max, step: "any",
      oninput: () => squama.set(control.key, Number(range.value)) });
    const field = element("input", { type: "text", inputmode: "decimal", "aria-label": control.label,
      onchange: () => {
        const number = Number(field.value.trim().replace(",", "."));
        const reads = field.value.trim() !== "" && Number.isFinite(number) && number >= control.min && number <= control.max;
        field.setAttribute("aria-invalid", String(!reads));
        field.title = reads ? "" : `a number from ${control.min} to ${control.max}`;
        if (reads) squama.set(control.key, number);
      } });
    const slope = element("button", { type: "button", class: "slope", hidden: true, onclick: () => squama.follow(control.key) });
    control.show = () => {
      range.value = control.value;
      field.value = digits(control.value);
      field.setAttribute("aria-invalid", "false");
      range.setAttribute("aria-valuetext", squama.text(control.key));
    };
    control.slope = slope;
    const unit = control.unit === "-" ? "" : control.unit;
    return element("div", { class: "control" }, element("label", { for: id }, control.label), range, field, element("span", { class: "unit" }, unit), slope);
  };

  /** The arrows: which way the chosen measure grows, and by how much for one per cent. */
  const showSlopes = () => {
    for (const control of controls.values()) {
      const slope = squama.answer?.slopes?.find((s) => s.parameter === control.key && s.measure === chosen);
      const better = squama.data.small.includes(chosen) ? -1 : 1;
      const sides = [slope?.left, slope?.right].filter((side) => side !== null && side !== undefined);
      control.slope.hidden = sides.length === 0;
      if (control.slope.hidden) continue;
      const gain = better * sides[sides.length - 1];
      const label = slope.kink ? `kink: ${slope.kink}` : `${gain > 0 ? "increase" : "decrease"} ${control.label} for a better ${chosen.replaceAll("_", " ")}`;
      control.direction = Math.sign(gain);
      control.slope.textContent = slope.kink ? "◆" : gain > 0 ? "▲" : gain < 0 ? "▼" : "–";
      control.slope.title = label;
      control.slope.setAttribute("aria-label", label);
    }
  };
  /** Goes a step of five per cent of the range in the direction in which the chosen measure grows. */
  squama.follow = (key) => {
    const control = controls.get(key);
    squama.set(key, control.value + control.direction * 0.05 * (control.max - control.min));
  };

  const card = ({ name, label, physical }) => {
    const shown = (physical && named(physical)) || named(name);
    const other = physical && named(physical) ? named(name) : null;
    const before = pinned?.find((value) => value.name === shown?.name)?.value;
    const compared = shown?.value && before ? `${((shown.value / before - 1) * 100).toFixed(0)} % against the pinned` : "";
    const unit = shown && shown.unit !== "-" ? shown.unit : "";
    return element("button", { type: "button", class: "card", "aria-pressed": String(chosen === name), title: shown?.meaning ?? "",
      onclick: () => { chosen = name; show(); } },
    element("span", { class: "name" }, label), element("span", { class: "value" }, shown ? `${digits(shown.value)} ${unit}` : "–"),
    element("span", { class: "other" }, compared || (other ? `${digits(other.value)} ${other.unit === "-" ? "" : other.unit}` : "")));
  };

  const requirement = (text) => {
    const [, name, sign, limit] = /^\s*(\S+?)\s*(>=|<=|=|>|<)\s*(\S+)\s*$/.exec(text) ?? [];
    const value = named(name)?.value;
    const met = value === undefined || value === null ? null : { ">=": value >= limit, "<=": value <= limit, "=": value === Number(limit), ">": value > limit, "<": value < limit }[sign];
    const mark = met === null ? "?" : met ? "✓" : "✗";
    return element("li", { class: met === false ? "unmet" : met ? "met" : "" }, `${mark} ${text}${value === undefined || value === null ? "" : ` (${digits(value)})`}`);
  };

  const warnings = () => {
    if (squama.answer?.error) return [squama.answer.error];
    const said = [];
    for (const status of ["puncture_status", "flexure_status"]) {
      const value = named(status);
      if (value && value.text !== "complete") said.push(`${status === "puncture_status" ? "Puncture" : "Bending"}: ${value.text}.`);
    }
    if (named("fold_force")) said.push(`The surface between two scales folds over at a force of ${digits(named("fold_force").value)}: beyond it the numbers are not to be trusted.`);
    return said;
  };

  /** A curve with a mark where the drawing stands; a press or a drag on it goes there. */
  const curve = (host, data, names, marker) => {
    const [w, h, left, bottom, top, right] = [360, 200, 46, 34, 10, 12];
    const points = data?.path ?? [];
    const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
    const [x1, y1] = [Math.max(1e-12, ...xs), Math.max(1e-12, ...ys)];
    const place = ([x, y]) => [left + (w - left - right) * x / x1, h - bottom - (h - bottom - top) * y / y1];
    const line = points.map((p) => place(p).map((c) => c.toFixed(1)).join(",")).join(" ");
    const marks = (data?.events ?? []).map((event) => svg("path", { d: `M${place(event).join(" ")} m-3 -3 l6 6 m0 -6 l-6 6`, class: "event" }));
    const fold = data?.fold ? [svg("circle", { cx: place(data.fold)[0], cy: place(data.fold)[1], r: 6, class: "fold" })] : [];
    const spot = marker ? [svg("circle", { cx: place(marker)[0], cy: place(marker)[1], r: 5, class: "marker" })] : [];
    at(host).setAttribute("viewBox", `0 0 ${w} ${h}`);
    at(host).replaceChildren(
      svg("path", { d: `M${left} ${top} V${h - bottom} H${w - right}`, class: "axis" }),
      svg("text", { x: w - right, y: h - 6, "text-anchor": "end" }, names[0]), svg("text", { x: left, y: top + 4, dx: 6 }, names[1]),
      svg("text", { x: w - right, y: h - bottom + 14, "text-anchor": "end", class: "tick" }, digits(x1)), svg("text", { x: left - 4, y: top + 8, "text-anchor": "end", class: "tick" }, digits(y1)),
      svg("polyline", { points: line, class: "curve" }), ...marks, ...fold, ...spot);
  };

  const show = () => {
    const { answer } = squama;
    at("cards").replaceChildren(...squama.data.measures.map(card));
    at("requirements").replaceChildren(...squama.data.requirements.map(requirement));
    at("requirements-box").hidden = squama.data.requirements.length === 0;
    const said = warnings();
    at("warnings").hidden = said.length === 0;
    at("warnings").replaceChildren(...said.map((text) => element("p", {}, text)));
    showSlopes();
    const state = squama.state();
    curve("force", answer?.puncture, ["depth u/t", "force F*"], squama.load === "puncture" && state ? [state.displacement, state.force] : null);
    curve("moment", answer?.flexure, ["curvature κt", "moment M*"], squama.load === "bend" && state ? [state.curvature, state.moment] : null);
    at("position").value = position;
    at("command").textContent = command();
    squama.scene.draw();
  };
  const command = () => `squama design ${squama.data.file} ${settings().map((setting) => `--set ${setting}`).join(" ")}`;
  const toml = () => {
    const sections = Map.groupBy([...controls.values()], ({ section }) => section);
    return [`name = "explored"`, ...[...sections].map(([section, of]) => `\n[${section}]\n${of.map(({ key, value }) => `${key} = ${value}`).join("\n")}`)].join("\n");
  };
  const copy = (button, text) => async () => {
    const before = button.textContent;
    try { await navigator.clipboard.writeText(text()); button.textContent = "Copied"; } catch { button.textContent = "Copying is not allowed here"; }
    setTimeout(() => { button.textContent = before; }, 1500);
  };

  fromAddress();
  at("name").textContent = squama.data.name;
  at("controls").append(...[...controls.values()].map(slider));
  for (const control of controls.values()) control.show();
  for (const load of ["puncture", "bend"]) {
    at(`load-${load}`).addEventListener("change", () => { squama.load = load; position = 1; show(); });
  }
  at("position").addEventListener("input", () => { position = Number(at("position").value); squama.scene.draw(); show(); });
  at("pin").addEventListener("click", () => { pinned = pinned ? null : squama.answer?.values; at("pin").setAttribute("aria-pressed", String(Boolean(pinned))); show(); });
  at("copy-toml").addEventListener("click", copy(at("copy-toml"), toml));
  at("copy-command").addEventListener("click", copy(at("copy-command"), command));
  at("copy-link").addEventListener("click", copy(at("copy-link"), () => location.href));
  addEventListener("hashchange", () => { fromAddress(); for (const control of controls.values()) control.show(); squama.solver.solve(settings()); });
  squama.scene.draw();
  squama.solver.begin((answer) => { squama.answer = answer.error ? { ...squama.answer, error: answer.error } : answer; show(); });
  squama.solver.solve(settings());
})();

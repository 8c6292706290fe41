// Sliders: one for each parameter, with an input field and an arrow that shows how to improve.

(() => {
  const { element, at, live } = squama;

  const choice = (control) => {
    const chosen = element("select", { id: `live-set-${control.key}`, onchange: () => live.set({ [control.key]: chosen.value }) },
      ...control.words.map((word) => element("option", { value: word }, word)));
    control.show = () => { chosen.value = control.value; };
    return element("div", { class: "control" }, element("label", { for: `live-set-${control.key}` }, control.label), chosen);
  };

  /** Parses the number in the text of a field, which may end with a unit. */
  const numberIn = (text) => Number(text.trim().replace(",", ".").replace("−", "-").replace(/\s*(mm|MPa|t|°)$/, ""));
  /** Parses a radius or "flat", and returns the curvature; null if it is invalid or out of range. */
  const typedRadius = (control, text) => {
    const radius = numberIn(text) / live.shownAs(control)[0], curvature = 1 / radius, slack = 1e-9 * (control.max - control.min);
    return text.trim() !== "" && curvature >= control.min - slack && curvature <= control.max + slack ? curvature : null;
  };
  /** Describes the accepted values of a control. */
  const accepted = (control) => {
    const [factor, unit] = live.shownAs(control), { min, max } = control;
    if (!control.is_radius) return `a number from ${live.digits(min * factor)} to ${live.digits(max * factor)} ${unit}`;
    return `"flat", a radius of at least ${live.digits(factor / max)} ${unit}, or of at most ${live.digits(factor / min)} ${unit} for a concave body`;
  };
  /** Parses a number with a decimal point or comma; null if it is invalid or out of range. */
  const typed = (control, text) => {
    if (control.zero && text.trim().toLowerCase() === control.zero) return 0;
    if (control.is_radius) return typedRadius(control, text);
    const number = numberIn(text) / live.shownAs(control)[0];
    const slack = 1e-9 * (control.max - control.min);
    return text.trim() !== "" && number >= control.min - slack && number <= control.max + slack ? number : null;
  };

  /** Returns true if a word replaces the value 0. */
  const isZero = ({ zero, value }) => Boolean(zero) && value === 0;
  /** Returns the value of a slider; a nearly flat body becomes flat. */
  const snapped = ({ is_radius, step }, value) => (is_radius && Math.abs(value) < 0.99 * step ? 0 : value);

  const slider = (control) => {
    const range = element("input", { type: "range", id: `live-set-${control.key}`, min: control.min, max: control.max, step: control.step,
      oninput: () => live.set({ [control.key]: snapped(control, Number(range.value)) }) });
    const field = element("input", { type: "text", inputmode: "decimal", "aria-label": `${control.label}, type a value`,
      onchange: () => {
        const number = typed(control, field.value);
        field.setAttribute("aria-invalid", String(number === null));
        field.title = number === null ? accepted(control) : "";
        if (number !== null) live.set({ [control.key]: number });
      } });
    const unit = element("span", { class: "unit" });
    // The body is not part of the design, so its control has no arrow.
    control.arrow = control.is_radius ? null : element("button", { type: "button", class: "arrow", onclick: () => live.follow(control.key, control.better > 0) });
    control.show = () => {
      const [factor, name] = live.shownAs(control);
      // The step is "any", because a fixed step would round values that were typed or dragged.
      Object.assign(range, { min: control.min, max: control.max, step: "any", value: live.current(control) });
      range.setAttribute("aria-valuetext", live.text(control.key));
      if (document.activeElement !== field || field.getAttribute("aria-invalid") !== "true") {
        const number = control.is_radius ? factor / control.value : live.current(control) * factor;
        field.value = isZero(control) ? control.zero : live.digits(number);
        field.setAttribute("aria-invalid", "false");
      }
      unit.textContent = isZero(control) ? "" : name;
    };
    range.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
      if (!step) return;
      event.preventDefault();
      live.set({ [control.key]: snapped(control, live.current(control) + step * control.step) });
    });
    return element("div", { class: "control" }, element("label", { for: range.id }, control.label), range, field, unit, ...(control.arrow ? [control.arrow] : []));
  };

  const showArrow = (control) => {
    if (!control.arrow) return;
    const measure = live.data.measures.find(({ name }) => name === live.chosen);
    const slope = live.answer?.slopes.find((one) => one.parameter === control.key && one.measure === live.chosen);
    control.better = slope?.better ?? 0;
    const direction = { 1: "larger", [-1]: "smaller", 0: "" }[control.better];
    const words = slope ? (control.better === 0 ? `${control.label} is at its best value for ${measure.label.toLowerCase()}` : `A ${direction} ${control.label.toLowerCase()} improves ${measure.label.toLowerCase()}`) : "";
    control.arrow.style.visibility = slope ? "visible" : "hidden";
    control.arrow.disabled = control.better === 0;
    control.arrow.textContent = { 1: "▶", [-1]: "◀", 0: "●" }[control.better];
    control.arrow.title = words + (slope?.gain ? ` (${live.digits(slope.gain, 2)} % per 1 %). Press to move until a limit is reached.` : "");
    control.arrow.setAttribute("aria-label", words);
  };

  // Number of controls that are always shown; the other controls appear on request.
  const FIRST = 4;
  let listed = "";
  /** Updates the active controls, and rebuilds their list if it has changed. */
  const show = () => {
    const acting = live.controls(), keys = acting.map(({ key }) => key).join();
    if (keys !== listed) {
      listed = keys;
      const rows = acting.map((control) => (control.words ? choice : slider)(control));
      rows.slice(FIRST).forEach((row) => row.classList.add("extra"));
      at("live-controls").replaceChildren(...rows);
      acting.forEach(showArrow);
    }
    acting.forEach((control) => control.show());
  };
  live.listen("moved", show);
  live.listen("answered", () => live.controls().forEach((control) => {
    showArrow(control);
    if (control.value === null) control.show?.();
  }));
})();

// Measures, requirements and warnings.

(() => {
  const { element, at, live } = squama;
  const named = (answer, name) => answer?.values.find((value) => value.name === name);
  /** Converts a dimensionless curvature κt to a radius, in thicknesses of a scale. */
  const radius = (value, { words }) => value && { value: value.value > 0 ? 1 / value.value : null, unit: "t", meaning: words };
  /** Returns a measure in physical units if the material is known, otherwise dimensionless. */
  const shown = (answer, measure) => {
    const plain = named(answer, measure.name);
    return named(answer, measure.physical) ?? (measure.is_curvature ? radius(plain, measure) : plain);
  };
  // Dimensionless units other than t are hidden, because the page does not explain their symbols.
  const unitOf = (value) => (/^(N|mm|t$)/.test(value.unit) ? value.unit : "");

  const compared = (value, measure) => {
    const before = live.pinned ? shown(live.pinned.answer, measure)?.value : null;
    if (!before || !value) return "";
    const change = 100 * (value.value / before - 1);
    return `${change < 0 ? "−" : "+"}${Math.abs(change).toFixed(Math.abs(change) < 10 ? 1 : 0)} % compared with the pinned design`;
  };

  const card = (measure) => {
    const value = shown(live.answer, measure), pressed = live.chosen === measure.name;
    const mode = measure.mode ? named(live.answer, measure.mode)?.text : null, words = mode ? `first failure: ${mode}` : measure.words;
    const choose = () => { live.chosen = measure.name; live.show(); document.querySelector('#live .card[aria-pressed="true"]').focus(); };
    // The arrows of the sliders only improve measures with a goal, so other cards are not buttons.
    const [tag, choice] = measure.has_goal ? ["button", { type: "button", "aria-pressed": String(pressed), onclick: choose }] : ["div", {}];
    return element(tag, { class: "card", "data-measure": measure.name, title: value?.meaning ?? measure.label, ...choice },
    element("span", { class: "name" }, measure.label), element("span", { class: "value" }, value ? live.digits(value.value) : "–", element("small", {}, ` ${value ? unitOf(value) : ""}`)),
    element("span", { class: "other" }, compared(value, measure) || words));
  };

  /** Formats a requirement such as `critical_force_N >= 2` in words. */
  live.inWords = (text) => text.replace(/(?:_(N|mm|deg))? (>=|<=|==|>|<) (\S+)$/, (_, unit, sign, limit) =>
    ` ${{ ">=": "≥", "<=": "≤", "==": "=" }[sign] ?? sign} ${limit}${unit ? ` ${unit}` : ""}`).replaceAll("_", " ");

  const requirement = ({ text, value, met, limits }) => element("li", { class: met ? "met" : "unmet" },
    `${met ? "✓" : "✗"} ${live.inWords(text)}, here ${live.digits(value, 3)}${limits ? (met ? " (tightest requirement)" : " (the obstacle)") : ""}`);

  live.listen("answered", () => {
    const { answer } = live;
    const cards = live.data.measures.map(card), first = live.data.first_measures;
    at("live-cards").replaceChildren(...cards.slice(0, first));
    at("live-other-cards").replaceChildren(...cards.slice(first));
    const said = [...(live.error ? [live.error] : []), ...(answer?.warnings ?? [])];
    at("live-warnings").replaceChildren(...said.map((text) => element("p", { class: "doubt" }, `⚠ ${text}`)));
    at("live-required").replaceChildren(...(answer?.requirements ?? []).map(requirement));
    const hint = answer?.fine && answer.slopes.length === 0 ? "No arrows: derivatives on a layer with full coupling take too long." : `Arrows show how to improve ${live.data.measures.find(({ name }) => name === live.chosen).label.toLowerCase()}; press one to move there.`;
    at("live-said").textContent = live.said || hint;
  });
})();

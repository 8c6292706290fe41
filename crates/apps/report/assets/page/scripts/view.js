// Parameters besides gap, aspect ratio and slant; figures show one value of each.

squama.view = (() => {
  const { state } = squama;
  const further = squama.varied.filter((name) => !["gap_over_t", "length_over_t", "slant_deg"].includes(name));

  /** Returns the value of a parameter in figures, by default the value of the selected design. */
  const shown = (name) => state.shown[name] ?? (state.design === null ? squama.different(name)[0] : squama.cell(state.design, name));

  const show = () => {
    const choose = (name) => (event) => {
      state.shown[name] = squama.different(name).find((value) => String(value) === event.target.value);
      squama.tell("view");
    };
    const held = (name) => squama.element("label", {}, `${squama.label(name)} `, squama.dropdown({ id: `view-${name}`, onchange: choose(name) },
      squama.different(name).map((value) => [String(value), squama.short(value)]), String(shown(name))));
    squama.at("view").replaceChildren(...(further.length > 0 ? [squama.element("span", {}, "Shown:"), ...further.map(held)] : []));
    squama.at("view").hidden = further.length === 0;
  };

  squama.listen("design", () => {
    for (const name of further) delete state.shown[name];
    show();
  });
  squama.listen("view", show);
  return { further, shown };
})();

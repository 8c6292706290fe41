"use strict";
// What the figures show: the parameter along their axis, the one from panel to panel, and one value of every other, so
// that marks of different designs do not stand on each other.

squama.view = (() => {
  const { state } = squama;
  const LENGTHS = ["length_over_t", "gap_over_t"];
  const numeric = squama.varied.filter((name) => squama.numeric.includes(name) && name !== "slant_deg");
  const known = LENGTHS.filter((name) => squama.different(name).length > 0);
  const count = (name) => squama.different(name).length;

  /** Parameters that may stand along an axis, those with most values first; aspect ratio and gap before others. */
  const choices = [
    ...known.filter((name) => count(name) > 1).sort((a, b) => count(b) - count(a)),
    ...numeric.filter((name) => !LENGTHS.includes(name)).sort((a, b) => count(b) - count(a)),
    ...known.filter((name) => count(name) <= 1),
  ];

  const against = () => (choices.includes(state.against) ? state.against : choices[0]);
  const panels = () => (choices.includes(state.panels) && state.panels !== against() ? state.panels : choices.find((name) => name !== against()));

  /** The value of a parameter that figures show: the one that is set, else that of the design that is chosen. */
  const shown = (name) => state.shown[name] ?? (state.design === null ? squama.different(name)[0] : squama.cell(state.design, name));

  /** Parameters of which figures that leave `free` ones show one value. */
  const fixed = (free) => squama.varied.filter((name) => !free.includes(name));

  /** Rows that have the shown value of every parameter that is not free. */
  const slice = (free) => {
    const held = fixed(free).map((name) => [squama.cells(name), shown(name)]).filter(([, value]) => value !== "all");
    return squama.rows.filter((row) => held.every(([cells, value]) => cells[row] === value));
  };

  const free = () => [against(), panels(), "slant_deg"];

  /** The values of parameters that are held, in words. */
  const words = (held) => held.map((name) => `${squama.label(name)} ${shown(name) === "all" ? "all" : squama.short(shown(name))}`).join(", ");

  return { choices, against, panels, shown, fixed, slice, free, words };
})();

(() => {
  const { state, view } = squama;
  const set = (change) => {
    change();
    squama.tell("view");
  };
  const labelled = (text, control) => squama.element("label", {}, `${text} `, control);

  const axis = (text, key, chosen) => labelled(text, squama.dropdown({ id: `view-${key}`, onchange: (event) => set(() => { state[key] = event.target.value; }) },
    view.choices.map((name) => [name, squama.label(name)]), chosen));

  const held = (name) => {
    const values = [...squama.different(name).map((value) => [String(value), squama.short(value)]), ["all", "all"]];
    const take = (text) => { state.shown[name] = text === "all" ? "all" : squama.different(name).find((value) => String(value) === text); };
    return labelled(squama.label(name), squama.dropdown({ id: `view-${name}`, onchange: (event) => set(() => take(event.target.value)) }, values, String(view.shown(name))));
  };

  const show = () => {
    const others = view.fixed(view.free());
    const controls = [
      ...(view.choices.length > 2 ? [axis("Along the axis", "against", view.against()), axis("a panel for each", "panels", view.panels())] : []),
      ...(others.length > 0 ? [squama.element("span", {}, "Shown:"), ...others.map(held)] : []),
    ];
    squama.at("view").replaceChildren(...controls);
    squama.at("view").hidden = controls.length === 0;
  };

  // The figures follow the design that is chosen, where it has other values than those that they show.
  const key = () => JSON.stringify(squama.varied.map(view.shown));
  let last = "";
  const follow = () => {
    if (key() === last) return;
    last = key();
    show();
    squama.redraw();
  };
  squama.listen("design", () => {
    for (const name of squama.varied) {
      if (state.shown[name] !== undefined && state.shown[name] !== "all") state.shown[name] = squama.cell(state.design, name);
    }
    if (view.fixed(view.free()).length > 0) follow();
  });
  squama.listen("view", () => {
    last = key();
    show();
    squama.redraw();
  });
  squama.listen("selection", () => squama.redraw());

  const passed = (kind) => squama.symbol({ color: "var(--ink)", path: "M-5 0 A5 5 0 1 1 5 0 A5 5 0 1 1 -5 0 Z" }, kind);
  squama.at("slant-legend").append("slant α:", ...squama.slants.map((slant) => squama.element("span", {}, squama.symbol(slant), `${slant.degrees}°`)),
    ...(squama.foldedRows.length > 0 ? [squama.element("span", { class: "warning" }, passed("folded"), "crossed out: the surface folds")] : []),
    squama.element("span", {}, squama.symbol({ color: "var(--grey)", path: "M-3 0 A3 3 0 1 1 3 0 A3 3 0 1 1 -3 0 Z" }), "does not meet the requirements"));
})();

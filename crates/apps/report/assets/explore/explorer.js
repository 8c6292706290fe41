// Buttons and the initial state.

(() => {
  const { at, live } = squama;
  const showBriefly = (button, text) => {
    const before = button.dataset.text ?? button.textContent;
    Object.assign(button.dataset, { text: before });
    button.textContent = text;
    setTimeout(() => { button.textContent = before; }, 1500);
  };
  const copies = (id, text) => at(id).addEventListener("click", async () => {
    try { await navigator.clipboard.writeText(text()); showBriefly(at(id), "Copied"); }
    catch { prompt("Copy this", text()); }
  });
  const command = () => `squama design ${live.data.source} ${(live.answer?.settings ?? []).join(" ")}`;
  copies("live-link", () => `${location.href.split("#")[0]}#${squama.written?.() ?? live.written()}`);
  copies("live-copy-command", command);
  copies("live-copy-toml", () => live.answer?.toml ?? "");
  at("live-more").addEventListener("click", () => {
    const open = at("live").classList.toggle("more");
    at("live-more").setAttribute("aria-expanded", String(open));
    at("live-more").textContent = open ? "Fewer sliders and measures" : "More sliders and measures";
  });
  at("live-print").addEventListener("click", () => print());
  at("live-pin").addEventListener("click", live.pin);
  at("live-back").addEventListener("click", () => live.set(live.pinned.values));
  at("live-sheet").addEventListener("click", () => {
    const open = at("live-sheet").getAttribute("aria-expanded") !== "true";
    at("live-sheet").setAttribute("aria-expanded", String(open));
    // Keeps the drawing visible above the sliders.
    if (open) at("live-rest").scrollIntoView();
  });

  /** Opens a design by keys and values of parameters; other parameters get their initial values. */
  squama.take = (pairs) => {
    const given = pairs.filter(([key, value]) => value !== null && live.control(key));
    const known = given.map(([key, value]) => [key, live.inside(live.control(key), value)]);
    // Values of a search may exceed the range of the sweep.
    for (const [control, value] of known.map(([key, own]) => [live.control(key), own])) Object.assign(control, { min: Math.min(control.min, value), max: Math.max(control.max, value) });
    live.set({ ...live.opened, ...Object.fromEntries(known) });
  };
  const chosen = () => {
    squama.take(live.controls().map(({ key }) => [key, squama.cell(squama.state.design, key)]));
    live.moved = false;
  };
  at("live-closest").addEventListener("click", () => {
    const { closest } = live.answer, row = squama.rowOf?.(closest.design) ?? null;
    if (row === null) squama.take(closest.values);
    else squama.choose(row);
  });

  live.listen("answered", () => {
    const { closest } = live.answer ?? {};
    at("live-closest").hidden = !closest;
    if (closest) at("live-closest").textContent = `Closest design of the sweep: ${closest.design}`;
    at("live-pin").setAttribute("aria-pressed", String(Boolean(live.pinned)));
    at("live-pin").textContent = live.pinned ? "Unpin" : "Pin to compare";
    at("live-back").hidden = !live.pinned;
    at("live-command").textContent = command();
    at("live").classList.toggle("waiting", live.solving() !== null);
  });

  /** Uses the dark or light colours of the system, and light colours in print. */
  const setTheme = () => {
    const root = document.documentElement, dark = matchMedia("(prefers-color-scheme: dark)");
    const show = () => { root.dataset.theme = dark.matches ? "dark" : "light"; };
    dark.addEventListener("change", show);
    show();
    addEventListener("beforeprint", () => { root.dataset.theme = "light"; });
    addEventListener("afterprint", show);
  };

  /** On the page of a run: lists the best designs, and opens a selected design. */
  const joinPage = () => {
    squama.listen("design", chosen);
    squama.listen("selection", () => {
      const best = squama.ranking.order(squama.contest, squama.weights(), 3).map(({ row }) => row);
      at("live-best").replaceChildren(best.length > 0 ? "Best designs that meet the requirements: " : "No design meets the requirements.",
        ...best.map((row) => squama.element("button", { type: "button", onclick: () => squama.choose(row) }, ...squama.warning(row), squama.title(row))));
      live.solve();
    });
    squama.refresh();
  };

  addEventListener("hashchange", () => {
    if (!location.hash.includes("live.")) return;
    live.read(location.hash.slice(1));
    live.set({});
  });
  // The page of a run sets its own theme.
  if (!squama.state) setTheme();
  const asked = location.hash.slice(1);
  if (squama.state) joinPage();
  if (squama.state && squama.state.design !== null) chosen();
  live.read(asked);
  live.show();
  live.set({});
  live.moved = asked.includes("live.");
  squama.solver.begin(live.take);
})();

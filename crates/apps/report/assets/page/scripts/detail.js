// The selected design: parameters, values, drawing, commands.

(() => {
  const { state } = squama;
  const aside = squama.at("detail"), fold = squama.at("fold");

  const fact = ({ name, unit, meaning }, row) => [
    squama.element("dt", { title: meaning }, squama.label(name)),
    squama.element("dd", {}, ...squama.withUnit(name, squama.cell(row, name), unit)),
  ];

  /** Shows a drawing as large as the window; Escape or a click closes the enlarged drawing. */
  const enlarge = async (svg) => {
    const large = squama.at("large");
    large.querySelector("div").innerHTML = await svg;
    large.showModal();
  };
  squama.at("large").addEventListener("click", (event) => event.currentTarget.close());

  /** Creates a button with the drawing of a design, which a click enlarges; empty without a drawing. */
  squama.solvedDrawing = (row) => {
    const number = squama.number(row), solved = squama.solved(row);
    if (!solved?.svg) return [];
    const drawn = squama.unpacked(solved.svg).text();
    const button = squama.element("button", { type: "button", class: "solved", "aria-label": `Enlarge the drawing of design ${number}`, onclick: () => enlarge(drawn) });
    drawn.then((svg) => { button.innerHTML = svg; });
    return [button, squama.element("p", { class: "note" }, "At rest and at the critical tilt; a click enlarges it.")];
  };

  /** Lists warnings about the validity of the results of a design. */
  squama.doubts = (row) => {
    const doubts = [];
    if (squama.folded(row)) {
      const [at, whole] = [squama.fold, squama.criticalForce].map((name) => squama.cell(row, name));
      const part = typeof at === "number" && typeof whole === "number" && whole > 0 ? ` (${Math.round((100 * at) / whole)} % of the critical force)` : "";
      doubts.push(`The critical force of this design is not valid: at a force of ${squama.short(at)}${part} the modelled surface folds, which is physically impossible. Results below this force are valid.`);
    }
    if (squama.cell(row, squama.strain) > 0.2) doubts.push("The membrane strain exceeds 20 %, beyond the range of its small-strain law.");
    for (const name of squama.names.filter((one) => one.endsWith("_status"))) {
      const status = squama.cell(row, name);
      if (status !== null && status !== "complete") doubts.push(`The ${name.replace("_status", "")} was not solved to its end: ${status}.`);
    }
    return doubts;
  };

  // In a narrow window, this section is at the lower edge; a selected design opens it.
  squama.setFolded = (folded) => {
    aside.classList.toggle("closed", folded);
    fold.setAttribute("aria-expanded", String(!folded));
    fold.textContent = folded ? "Show" : "Hide";
  };
  fold.addEventListener("click", () => squama.setFolded(!aside.classList.contains("closed")));

  const pin = squama.at("pin");
  const showPin = () => {
    const own = state.pinned !== null && state.pinned === state.design;
    pin.setAttribute("aria-pressed", String(own));
    pin.textContent = own ? "Unpin" : "Pin";
  };
  pin.addEventListener("click", () => squama.pin(state.pinned === state.design ? null : state.design));
  squama.listen("pinned", showPin);

  const commands = (number) => {
    const definition = `${squama.folder}/run.toml`;
    return [
      squama.element("h3", {}, "Run it again"),
      squama.command(`squama design ${definition} --design ${number}`),
      squama.element("h3", {}, "Draw it"),
      squama.command(`squama draw ${definition} --design ${number}`),
      squama.command(`squama draw ${definition} --design ${number} --flexure`),
      squama.command(`squama plot curves ${definition} --design ${number}`),
    ];
  };

  const show = () => {
    const row = state.design;
    if (row === null) return;
    squama.setFolded(false);
    const number = squama.number(row);
    squama.at("detail-title").textContent = `Design ${number}`;
    squama.at("drawing").replaceChildren(squama.drawing(row), squama.element("p", { class: "note" }, "At rest; the thick parts of the dashed line are covered."), ...squama.solvedDrawing(row));
    const columns = squama.columns.filter(({ name }) => name !== "design"), isAxis = ({ name }) => squama.axes.includes(name);
    const isFirst = ({ name }) => squama.physical(name) || [...squama.shown.first, squama.fold].includes(name);
    const values = columns.filter((column) => !isAxis(column));
    squama.at("detail-doubts").replaceChildren(...squama.doubts(row).map((text) => squama.element("p", { class: "doubt" }, `⚠ ${text}`)));
    const moves = squama.gap.known(row);
    squama.at("detail-gap").replaceChildren(...(moves.length === 0 ? [] : [
      squama.element("h3", {}, "Gap 10 % smaller / larger"), ...squama.gap.warning(row).map((text) => squama.element("p", { class: "doubt" }, `⚠ ${text}`)),
      squama.element("dl", { class: "facts" }, ...moves.flatMap(({ column, factors }) => [squama.element("dt", {}, squama.label(column)), squama.element("dd", {}, squama.gap.both(factors))])),
    ]));
    squama.at("detail-parameters").replaceChildren(...columns.filter(isAxis).flatMap((column) => fact(column, row)));
    squama.at("detail-values").replaceChildren(...[...values.filter(isFirst), ...values.filter((column) => !isFirst(column))].flatMap((column) => fact(column, row)));
    squama.at("detail-commands").replaceChildren(...commands(number));
    squama.at("announce").textContent = `Design ${squama.title(row)}${squama.folded(row) ? ", folded" : ""}`;
    showPin();
  };
  squama.listen("design", show);
  const near = () => (squama.meeting.length > 0 ? squama.meeting : squama.rows);
  squama.at("previous").addEventListener("click", () => squama.step(-1, near()));
  squama.at("next").addEventListener("click", () => squama.step(1, near()));
})();

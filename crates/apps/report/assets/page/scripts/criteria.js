// Criteria and their weights: sliders, the best designs, and the equivalent command.

(() => {
  const LISTED = 15;
  const LETTERS = ["m", "n", "k", "l"];
  const { state, ranking } = squama;
  const isUsual = () => ranking.areUsual(state.criteria);

  /** Sets one weight; the others keep their proportions and fill the remainder. */
  squama.setWeight = (which, value) => {
    const others = state.weights.map((_, k) => k).filter((k) => k !== which);
    if (others.length === 0) return squama.tell("weights");
    const parts = squama.hundredths(others.map((k) => state.weights[k]), 100 - value);
    state.weights[which] = value;
    others.forEach((k, i) => { state.weights[k] = parts[i]; });
    squama.tell("weights");
  };

  const setCriteria = (criteria, weights = squama.equalWeights(criteria.length)) => {
    Object.assign(state, { criteria, weights });
    squama.refresh();
  };

  /** Names a criterion. Only the default criteria have names, such as penetration resistance. */
  squama.criterionName = ({ column, goal }) => {
    if (isUsual()) return squama.criteria.find((one) => one.column === column)?.name ?? squama.label(column);
    return `${goal === "max" ? "large " : "small "}${squama.label(column)}`;
  };

  const fieldset = squama.at("weights"), rows = squama.element("div");
  fieldset.append(rows);
  let sliders = [];
  const weightRow = (criterion, k) => {
    const id = `weight-${LETTERS[k] ?? k + 1}`;
    const input = squama.element("input", { type: "range", min: 0, max: 100, step: 1, id, oninput: (event) => squama.setWeight(k, Number(event.target.value)) });
    const output = squama.element("output", { for: id });
    const turn = () => setCriteria(state.criteria.map((one, other) => (other === k ? { ...one, goal: one.goal === "max" ? "min" : "max" } : one)), state.weights);
    const remove = () => setCriteria(state.criteria.filter((_, other) => other !== k));
    sliders.push({ input, output });
    return squama.element("div", { class: "weight" },
      squama.element("label", { for: id }, ...(isUsual() ? [squama.element("i", {}, LETTERS[k]), " "] : []), squama.criterionName(criterion)), input, output,
      squama.element("button", { type: "button", title: "Large or small values are good", "aria-label": `${squama.criterionName(criterion)}: reverse which values are good`, onclick: turn }, criterion.goal === "max" ? "↑" : "↓"),
      squama.element("button", { type: "button", "aria-label": `Leave out ${squama.criterionName(criterion)}`, onclick: remove, disabled: state.criteria.length === 1 }, "✕"));
  };

  const adder = squama.at("add-criterion");
  const showCriteria = () => {
    sliders = [];
    rows.replaceChildren(...state.criteria.map(weightRow));
    const others = squama.numeric.filter((name) => name !== "design" && !state.criteria.some(({ column }) => column === name));
    adder.replaceChildren(squama.element("option", { value: "" }, "Add a criterion …"), ...others.map((name) => squama.element("option", { value: name }, squama.label(name))));
    adder.disabled = state.criteria.length >= ranking.MOST_CRITERIA;
    squama.at("scale").value = state.scale;
    squama.at("usual-criteria").hidden = isUsual() && state.scale === "paper";
  };
  adder.addEventListener("change", () => {
    if (adder.value !== "") setCriteria([...state.criteria, { column: adder.value, goal: ranking.plainGoal(squama, adder.value) }]);
  });
  squama.at("usual-criteria").addEventListener("click", () => {
    const { criteria, scale } = squama.initial();
    state.scale = scale;
    setCriteria(criteria);
  });
  squama.at("equal-weights").addEventListener("click", () => {
    state.weights = squama.equalWeights(state.criteria.length);
    squama.tell("weights");
  });
  squama.at("scale").addEventListener("change", (event) => {
    state.scale = event.target.value;
    squama.refresh();
  });

  const quoted = (text) => `'${text}'`;

  /** Returns the command with the same ranking, without text filters, which only the page has. */
  squama.rankCommand = () => [
    `squama rank ${squama.folder}`,
    ...squama.required().filter(({ sign }) => sign !== "~").map((one) => `--require ${quoted(ranking.written(one))}`),
    ...squama.comparable.now().map(({ parameter, value }) => `--require ${quoted(`${parameter} == ${value}`)}`),
    // The surface folds over if the gap between two bases closes.
    ...(state.sound ? [`--require ${quoted(`${squama.tightest} > 0`)}`] : []),
    ...(isUsual() ? [] : [`--criteria ${state.criteria.map(({ goal, column }) => `${goal}:${column}`).join(",")}`]),
    `--weights ${squama.weights().join(",")}`,
    ...(state.scale === "paper" ? [] : [`--scale ${state.scale}`]),
  ].join(" ");

  const body = squama.at("best").tBodies[0], head = squama.at("best").tHead.rows[0];
  const titled = ["gap_over_t", "length_over_t", "slant_deg", ...squama.varied].filter((name, k, all) => squama.has(name) && all.indexOf(name) === k);
  const shown = () => [...new Set([...titled, ...state.criteria.map(({ column }) => column), ...state.requirements.map(({ column }) => column)])];

  const showHead = () => {
    const column = (name) => squama.element("th", { scope: "col" }, squama.label(name));
    head.replaceChildren(...["rank", "design"].map((text) => squama.element("th", { scope: "col" }, text)), squama.element("th", { scope: "col" }, "fitness ", squama.element("i", {}, "f")), ...shown().map(column));
  };

  const entry = ({ row, fitness, rank }) => {
    const cell = (name) => squama.short(squama.cell(row, name)) + (name === "slant_deg" ? "°" : "");
    const own = squama.element("td", {}, ...squama.warning(row), squama.number(row));
    return squama.element("tr", { "data-row": row, class: row === state.design ? "chosen" : null, ...squama.chooser(row) },
      squama.element("td", {}, String(rank)), own, squama.element("td", {}, fitness.toFixed(4)), ...shown().map((name) => squama.element("td", {}, cell(name))));
  };

  /** Shows the best design without a fold, if the winner has a fold. */
  const showSound = (best) => {
    const note = squama.at("best-sound");
    note.hidden = !(best && squama.folded(best.row));
    if (note.hidden) return;
    const other = ranking.order(squama.contest, squama.weights()).find(({ row }) => !squama.folded(row));
    note.replaceChildren("⚠ The surface folds under the best design before its critical tilt, so its critical force is not valid. ",
      ...(other ? ["Best design without a fold: ", squama.element("button", { type: "button", onclick: () => squama.choose(other.row) }, squama.title(other.row)), `, fitness ${other.fitness.toFixed(4)}.`] : []));
  };

  /** States which designs are ranked, if not all of them can be compared. */
  const showIncomparable = () => {
    const found = squama.comparable.now();
    const note = squama.at("incomparable");
    note.hidden = found.length === 0;
    const show = (parameter, values, text) => {
      state.shown[parameter] = values.find((value) => String(value) === text);
      squama.tell("view");
    };
    const chooser = ({ parameter, values, value }) => squama.element("label", {}, ` ${squama.label(parameter)} `, squama.dropdown({ onchange: (event) => show(parameter, values, event.target.value) },
      values.map((one) => [String(one), squama.short(one)]), String(value)));
    const why = ({ column, parameter }) => `${squama.label(column)} is measured differently for designs of different ${squama.label(parameter)}`;
    note.replaceChildren("Ranked: designs of", ...found.map(chooser), `, because ${found.map(why).join(", and ")}.`);
  };

  /** Shows the sensitivity of the best design to its gap, if known. */
  const showGap = (best) => {
    const note = squama.at("best-gap"), isKnown = best && squama.gap.known(best.row).length > 0;
    note.hidden = !isKnown;
    if (!isKnown) return;
    const isCliff = squama.gap.cliffs(best.row).length > 0;
    note.className = isCliff ? "doubt" : "note";
    note.textContent = `${isCliff ? "⚠ The best design is sensitive to its gap. " : ""}${squama.gap.sentence(best.row)}`;
  };

  const show = () => {
    const weights = squama.weights();
    sliders.forEach(({ input, output }, k) => {
      input.value = state.weights[k];
      input.setAttribute("aria-valuetext", weights[k].toFixed(2));
      output.textContent = weights[k].toFixed(2);
    });
    squama.at("rank-command").replaceChildren(squama.command(squama.rankCommand()));
    const best = ranking.order(squama.contest, weights, LISTED);
    body.replaceChildren(...best.map(entry));
    showSound(best[0]);
    showGap(best[0]);
  };

  squama.listen("selection", () => {
    showCriteria();
    showHead();
    showIncomparable();
    const { length } = squama.contest.rows;
    squama.at("ranking-count").textContent = `${length} designs are ranked; the other ${squama.count - length} ${squama.meeting.length < squama.count ? "do not meet the requirements, or " : ""}${squama.comparable.now().length > 0 ? "are measured under other parameters, or " : ""}lack coverage or a value.`;
    show();
  });
  squama.listen("weights", show);
  squama.listen("design", () => body.querySelectorAll("tr").forEach((element) => element.classList.toggle("chosen", Number(element.dataset.row) === state.design)));
})();

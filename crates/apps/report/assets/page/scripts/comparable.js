// Comparable designs: criteria can be compared only if they are measured under the same parameters.
// The data of the page list these parameters; `squama rank` reports an error if they differ.

squama.comparable = (() => {
  const { state } = squama;
  const measuredBy = (column) => squama.columns[squama.place.get(column)].measuredBy;
  const valuesOf = (rows, parameter) => [...new Set(rows.map((row) => squama.cell(row, parameter)))].sort((a, b) => a - b);

  /** Lists parameters that affect the measurement of criteria and differ between the rows. */
  const differing = (rows, criteria) => {
    const found = new Map();
    for (const { column } of criteria) for (const parameter of measuredBy(column)) if (!found.has(parameter)) found.set(parameter, column);
    return [...found].map(([parameter, column]) => ({ parameter, column, values: valuesOf(rows, parameter) })).filter(({ values }) => values.length > 1);
  };

  /** Selects the value for the ranking: the value shown in figures, if any design has it. */
  const held = ({ parameter, values }) => (values.includes(squama.view.shown(parameter)) ? squama.view.shown(parameter) : values[0]);

  /** Filters the rows for the ranking: one value of each parameter that affects measurements. */
  const ranked = (rows, criteria) => differing(rows, criteria)
    .reduce((left, one) => left.filter((row) => squama.cell(row, one.parameter) === held(one)), rows);

  /** Groups rows that can be compared with each other. */
  const groups = (rows, criteria) => {
    const parameters = differing(rows, criteria).map(({ parameter }) => parameter), found = new Map();
    for (const row of rows) {
      const key = parameters.map((parameter) => squama.cell(row, parameter)).join();
      if (!found.has(key)) found.set(key, []);
      found.get(key).push(row);
    }
    return [...found.values()];
  };

  /** Lists the parameters that limit the current ranking to one of their values, with this value. */
  const now = () => differing(squama.meeting, state.criteria).map((one) => ({ ...one, value: held(one) }));

  // A change of the shown values changes the ranking.
  let last = "";
  squama.listen("view design", () => {
    const key = JSON.stringify(now().map(({ value }) => value));
    if (key !== last) squama.refresh();
  });
  squama.listen("selection", () => { last = JSON.stringify(now().map(({ value }) => value)); });

  return { differing, ranked, groups, now };
})();

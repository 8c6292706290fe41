// Comparable designs: criteria can be compared only if they are measured under the same parameters.
// The program provides these parameters; `squama rank` reports an error if they differ.

squama.comparable = (() => {
  const { state } = squama;
  const measuredBy = (column) => squama.columns[squama.place.get(column)].measuredBy;
  const valuesOf = (rows, parameter) => [...new Set(rows.map((row) => squama.cell(row, parameter)))].sort((a, b) => a - b);

  /** Parameters by which criteria are measured and in which rows differ, each with its column and the values. */
  const differing = (rows, criteria) => {
    const found = new Map();
    for (const { column } of criteria) for (const parameter of measuredBy(column)) if (!found.has(parameter)) found.set(parameter, column);
    return [...found].map(([parameter, column]) => ({ parameter, column, values: valuesOf(rows, parameter) })).filter(({ values }) => values.length > 1);
  };

  /** The value among which designs are ranked: the one that figures show, if any design has it. */
  const held = ({ parameter, values }) => (values.includes(squama.view.shown(parameter)) ? squama.view.shown(parameter) : values[0]);

  /** Of some rows those that are ranked: of one value of each parameter that measures. */
  const ranked = (rows, criteria) => differing(rows, criteria)
    .reduce((left, one) => left.filter((row) => squama.cell(row, one.parameter) === held(one)), rows);

  /** Rows apart, so that those within a group can be compared. */
  const groups = (rows, criteria) => {
    const parameters = differing(rows, criteria).map(({ parameter }) => parameter), found = new Map();
    for (const row of rows) {
      const key = parameters.map((parameter) => squama.cell(row, parameter)).join();
      if (!found.has(key)) found.set(key, []);
      found.get(key).push(row);
    }
    return [...found.values()];
  };

  /** The parameters among whose values designs are ranked now, each with its value. */
  const now = () => differing(squama.meeting, state.criteria).map((one) => ({ ...one, value: held(one) }));

  // Another value is shown: another ranking.
  let last = "";
  squama.listen("view design", () => {
    const key = JSON.stringify(now().map(({ value }) => value));
    if (key !== last) squama.refresh();
  });
  squama.listen("selection", () => { last = JSON.stringify(now().map(({ value }) => value)); });

  return { differing, ranked, groups, now };
})();

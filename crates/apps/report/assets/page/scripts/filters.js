// Filters below the headers of the table: short forms of requirements, `>0.5`, `0.1..0.5`, or a
// part of a text.

squama.filters = (() => {
  const { number } = squama.ranking;

  /** Parses the filter of a column as requirements; null if the filter is incomplete. */
  const read = (column, filter) => {
    if (filter === "") return [];
    const ends = filter.split("..").map(number);
    if (ends.length === 2 && ends.every(Number.isFinite)) return [{ column, sign: ">=", limit: ends[0] }, { column, sign: "<=", limit: ends[1] }];
    const [, sign, rest] = filter.match(/^([<>]=?|==?)?(.*)$/), limit = number(rest), isText = !squama.numeric.includes(column) || column === "design";
    if (isText) return [{ column, sign: "~", limit: filter }];
    return Number.isFinite(limit) ? [{ column, sign: { undefined: "==", "=": "==" }[sign] ?? sign, limit }] : null;
  };

  /** Formats the requirements on a column as a filter. */
  const text = (column) => {
    const own = squama.state.requirements.filter((one) => one.column === column);
    if (own.length === 2 && own[0].sign === ">=" && own[1].sign === "<=") return `${own[0].limit}..${own[1].limit}`;
    return own.map(({ sign, limit }) => ({ "~": `${limit}`, "==": `${limit}` }[sign] ?? `${sign}${limit}`)).join(" ");
  };

  /** Replaces the requirements on a column. */
  const set = (column, requirements) => squama.require([...squama.state.requirements.filter((one) => one.column !== column), ...requirements]);

  return { read, text, set };
})();

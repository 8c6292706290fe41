"use strict";
// Filters under the headers of the table: another way to write requirements, `>0.5`, `0.1..0.5` or a part of a text.

squama.filters = (() => {
  const NUMBER = "[-+]?[0-9.]+(?:e[-+]?[0-9]+)?";
  const RANGE = new RegExp(`^(${NUMBER})\\.\\.(${NUMBER})$`, "i");
  const BOUND = new RegExp(`^([<>]=?|==?)?\\s*(${NUMBER})$`, "i");

  /** Requirements that a filter on a column means; null while it is not whole. */
  const read = (column, filter) => {
    if (filter === "") return [];
    const range = filter.match(RANGE);
    if (range) return [{ column, sign: ">=", limit: Number(range[1]) }, { column, sign: "<=", limit: Number(range[2]) }];
    const bound = filter.match(BOUND), isText = !squama.numeric.includes(column) || column === "design";
    if (isText) return [{ column, sign: "~", limit: filter }];
    if (!bound || !Number.isFinite(Number(bound[2]))) return null;
    const sign = { undefined: "==", "=": "==" }[bound[1]] ?? bound[1];
    return [{ column, sign, limit: Number(bound[2]) }];
  };

  /** The filter that means the requirements on a column. */
  const text = (column) => {
    const own = squama.state.requirements.filter((one) => one.column === column);
    if (own.length === 2 && own[0].sign === ">=" && own[1].sign === "<=") return `${own[0].limit}..${own[1].limit}`;
    return own.map(({ sign, limit }) => ({ "~": `${limit}`, "==": `${limit}` }[sign] ?? `${sign}${limit}`)).join(" ");
  };

  /** Puts requirements in the place of those on a column. */
  const set = (column, requirements) => squama.require([...squama.state.requirements.filter((one) => one.column !== column), ...requirements]);

  return { read, text, set };
})();

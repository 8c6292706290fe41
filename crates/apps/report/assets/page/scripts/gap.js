// Sensitivity to the gap, for designs solved again with a gap 10 % smaller and larger.

squama.gap = (() => {
  // A design is sensitive if a measure changes by at least this factor.
  const CLIFF = 1.5;
  // Larger changes are shown as factors, smaller changes in percent.
  const LARGE = 2;

  /** Returns the changes of a row: `{ column, factors }` for the smaller and the larger gap. */
  const known = (row) => squama.solved(row)?.gapFactors ?? [];

  /** Formats a factor in words. */
  const words = (factor) => {
    if (factor === null) return "no value";
    if (Math.abs(factor - 1) < 5e-4) return "unchanged";
    if (factor >= LARGE) return `× ${squama.short(Number(factor.toPrecision(2)))}`;
    if (factor > 0 && factor <= 1 / LARGE) return `÷ ${squama.short(Number((1 / factor).toPrecision(2)))}`;
    return `${factor < 1 ? "−" : "+"}${Math.abs(100 * (factor - 1)).toFixed(1)} %`;
  };

  const isSteep = (factor) => factor !== null && factor > 0 && Math.max(factor, 1 / factor) >= CLIFF;

  /** Lists the columns of a row that are sensitive to the gap. */
  const cliffs = (row) => known(row).filter(({ factors }) => factors.some(isSteep)).map(({ column }) => column);

  const both = (factors) => factors.map(words).join(" / ");

  /** Returns a warning if a row is sensitive to its gap; empty otherwise. */
  const warning = (row) => {
    const steep = known(row).filter(({ factors }) => factors.some(isSteep));
    return steep.length === 0 ? [] : [`This design is sensitive to its gap: for a gap 10 % smaller / larger, ${steep.map(({ column, factors }) => `${squama.label(column)} changes by ${both(factors)}`).join(", ")}.`];
  };

  /** Describes all changes of a row in one sentence. */
  const sentence = (row) => `Sensitivity of ${squama.number(row)} to a gap 10 % smaller / larger: ${known(row).map(({ column, factors }) => `${squama.label(column)} ${both(factors)}`).join(", ")}.`;

  return { known, both, cliffs, warning, sentence };
})();

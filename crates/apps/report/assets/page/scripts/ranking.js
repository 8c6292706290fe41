// Ranking: requirements, criteria, fitness, fronts, independent of the page. `squama rank` uses the
// same order of operations; scripts/check-page compares the two rankings.

squama.ranking = (() => {
  const ROUND_OFF = 1e-9;
  const SIGNS = [">=", "<=", "==", ">", "<"];
  const SCALES = ["paper", "linear", "log"];
  const USUAL = squama.criteria.map(({ column, goal }) => `${goal}:${column}`);
  const [COVERAGE] = squama.measures;
  const MOST_CRITERIA = 8;

  /** Returns true if criteria are the default ones, in their order. */
  const areUsual = (criteria) => criteria.map(({ goal, column }) => `${goal}:${column}`).join() === USUAL.join();

  /** Returns true if two numbers are equal up to round-off. */
  const same = (a, b) => Math.abs(a - b) <= ROUND_OFF * Math.max(Math.abs(a), Math.abs(b));

  /** Returns true if a number satisfies a bound; NaN satisfies no bound. */
  const keeps = (value, sign, limit) => {
    if (Number.isNaN(value)) return false;
    const equal = same(value, limit);
    if (sign === "==") return equal;
    const beyond = sign[0] === ">" ? value > limit : value < limit;
    return sign.length === 2 ? equal || beyond : !equal && beyond;
  };

  /** Returns true if a row meets a requirement: a bound, or with the sign `~` a part of a text. */
  const meets = (table, { column, sign, limit }, row) => (sign === "~"
    ? String(table.cell(row, column) ?? "").toLowerCase().includes(limit.toLowerCase())
    : keeps(table.numbers(column)[row], sign, limit));

  /** Parses `COLUMN OP LIMIT`; null if the text is not a requirement on a column of the table. */
  const requirement = (table, text) => {
    const sign = [...SIGNS, "~"].find((one) => text.includes(one));
    if (!sign) return null;
    const at = text.indexOf(sign);
    const column = text.slice(0, at).trim(), rest = text.slice(at + sign.length).trim();
    const limit = sign === "~" ? rest : number(rest);
    return table.has(column) && rest !== "" && (sign === "~" || Number.isFinite(limit)) ? { column, sign, limit } : null;
  };

  /** Parses a number with a decimal point or comma; NaN if the text is invalid. */
  const number = (text) => (/^[-+]?([0-9]+([.,][0-9]*)?|[.,][0-9]+)(e[-+]?[0-9]+)?$/i.test(text.trim()) ? Number(text.trim().replace(",", ".")) : NaN);

  /** Formats a requirement as on the command line. */
  const written = ({ column, sign, limit }) => `${column} ${sign} ${limit}`;

  /** Parses `max:COLUMN` or `min:COLUMN`; null if the table has no such column. */
  const criterion = (table, text) => {
    const [goal, column] = text.split(":");
    return (goal === "max" || goal === "min") && table.has(column) ? { column, goal } : null;
  };

  /** Returns the default direction of a column. */
  const plainGoal = (table, column) => table.goal(column) ?? "max";

  /** Converts a value so that larger is better (R1); NaN if the value has no inverse or logarithm. */
  const worth = (scale, goal, value) => {
    if (scale === "linear" || (scale === "paper" && goal === "max")) return goal === "max" ? value : -value;
    if (!(value > 0)) return NaN;
    const result = scale === "paper" ? 1 / value : goal === "max" ? Math.log(value) : -Math.log(value);
    return Number.isFinite(result) ? result : NaN;
  };

  /** Returns the rows that meet all requirements and the condition `also`. */
  const meeting = (table, requirements, also = () => true) =>
    table.rows.filter((row) => also(row) && requirements.every((one) => meets(table, one, row)));

  /** Returns the smallest and the largest number. */
  const ends = (numbers) => {
    let low = Infinity, high = -Infinity;
    for (let i = 0; i < numbers.length; i++) {
      low = Math.min(low, numbers[i]);
      high = Math.max(high, numbers[i]);
    }
    return [low, high];
  };

  /** Returns the numbers of the given rows. */
  const picked = (numbers, rows) => {
    const own = new Float64Array(rows.length);
    for (let i = 0; i < own.length; i++) own[i] = numbers[rows[i]];
    return own;
  };

  /** Rescales numbers from 0 (worst) to 1 (best) (R2); if all are equal, every result is 1. */
  const rescaled = (numbers, isTie) => {
    const [low, high] = ends(numbers);
    return numbers.map((value) => (isTie || !(high > low) ? 1 : (value - low) / (high - low)));
  };

  /**
   * Returns the ranked designs: the `rows` with a value of every criterion, and with positive
   * coverage if it is a criterion. `worths` and `terms` hold one list for each criterion.
   */
  const contest = (table, rows, criteria, scale) => {
    const all = criteria.map(({ column, goal }) => table.numbers(column).map((value) => worth(scale, goal, value)));
    const covered = criteria.some(({ column }) => column === COVERAGE) ? table.numbers(COVERAGE) : null;
    const ranked = rows.filter((row) => !(covered && covered[row] <= 0) && all.every((values) => !Number.isNaN(values[row])));
    const worths = all.map((values) => picked(values, ranked));
    // Ties are found in the values, because a relative comparison fails for logarithms near 0.
    const isTie = criteria.map(({ column }) => same(...ends(picked(table.numbers(column), ranked))));
    const terms = worths.map((values, c) => rescaled(values, isTie[c])).map((values) => (scale === "paper" ? values.map(Math.log) : values));
    return { rows: ranked, worths, terms, scale };
  };

  /** Computes the scores of ranked designs. A weight of 0 skips its criterion, even a term of −∞. */
  const scores = ({ rows, terms }, weights) => {
    const sums = new Float64Array(rows.length);
    terms.forEach((values, c) => {
      const weight = weights[c];
      if (weight > 0) for (let i = 0; i < sums.length; i++) sums[i] += weight * values[i];
    });
    return sums;
  };

  /** Returns true if a score equals the best one up to round-off. */
  const isAsGood = (score, best) => score >= best - ROUND_OFF;

  /** Sorts indices by score, the best first; ties up to round-off are in the order of the table. */
  const inOrder = (places, sums) => {
    const sorted = places.sort((a, b) => (sums[a] === sums[b] ? a - b : sums[b] - sums[a])), groups = [];
    for (const place of sorted) {
      if (groups.length > 0 && isAsGood(sums[place], sums[groups.at(-1).best])) groups.at(-1).places.push(place);
      else groups.push({ best: place, places: [place] });
    }
    let before = 0;
    return groups.flatMap(({ places: equals }) => {
      const rank = before + 1;
      before += equals.length;
      return equals.sort((a, b) => a - b).map((place) => ({ place, rank }));
    });
  };

  /** Returns the first `most` ranked designs with fitness and rank, the best first. */
  const order = (own, weights, most = Infinity) => {
    const sums = scores(own, weights);
    let places = own.rows.map((_, i) => i);
    if (most < places.length / 8) {
      // Skip designs that cannot be among the first.
      const bound = Float64Array.from(sums).sort()[sums.length - most];
      places = places.filter((i) => isAsGood(sums[i], bound));
    }
    const fitness = (sum) => (own.scale === "paper" ? Math.exp(sum) : sum);
    return inOrder(places, sums).slice(0, most).map(({ place, rank }) => ({ row: own.rows[place], rank, fitness: fitness(sums[place]) }));
  };

  /** Returns true if `p` dominates `q`: worse in no criterion, and better in at least one (R6). */
  const beats = (worths, p, q) => {
    let better = false;
    for (const values of worths) {
      if (values[p] < values[q]) return false;
      better ||= values[p] > values[q];
    }
    return better;
  };

  /** Returns the non-dominated rows. */
  const front = ({ rows, worths }) => {
    const sorted = rows.map((_, i) => i).sort((a, b) => {
      for (const values of worths) if (values[a] !== values[b]) return values[b] - values[a];
      return a - b;
    });
    const kept = [];
    for (const i of sorted) {
      const by = kept.findIndex((other) => beats(worths, other, i));
      if (by < 0) kept.push(i);
      // A design that dominates one design is likely to dominate others, so test this design first.
      else [kept[0], kept[by]] = [kept[by], kept[0]];
    }
    return new Set(kept.map((i) => rows[i]));
  };

  /**
   * Explains requirements that no row meets, by the nearest row and the binding requirements. A
   * shortfall is relative to its limit. The nearest row is the row with the smallest value of its
   * largest shortfall, then of the sum of its shortfalls. A requirement is binding if some rows meet
   * all other requirements.
   */
  const unmet = (table, rows, requirements) => {
    const bounds = requirements.filter(({ sign }) => sign !== "~");
    const sizes = bounds.map(({ column, limit }) => {
      const largest = () => table.numbers(column).reduce((most, value) => Math.max(most, Math.abs(value) || 0), 0);
      return (limit === 0 ? largest() : Math.abs(limit)) || 1;
    });
    const shortfall = (row, { column, sign, limit }, k) => {
      const value = table.numbers(column)[row];
      if (keeps(value, sign, limit)) return 0;
      return Number.isNaN(value) ? Infinity : Math.max(Math.abs(value - limit) / sizes[k], Number.MIN_VALUE);
    };
    let nearest = null, least = [Infinity, Infinity];
    for (const row of rows) {
      const missing = bounds.map((one, k) => shortfall(row, one, k));
      const [largest, sum] = [Math.max(0, ...missing), missing.reduce((a, b) => a + b, 0)];
      if (largest < least[0] || (largest === least[0] && sum < least[1])) [nearest, least] = [row, [largest, sum]];
    }
    const others = (k) => requirements.filter((_, other) => other !== k);
    const binding = requirements.filter((_, k) => rows.some((row) => others(k).every((one) => meets(table, one, row))));
    return { nearest, binding };
  };

  return { ROUND_OFF, SIGNS, SCALES, USUAL, areUsual, MOST_CRITERIA, same, number, meets, requirement, written, criterion, plainGoal, meeting, contest, scores, order, front, unmet };
})();

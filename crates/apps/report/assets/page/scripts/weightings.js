// All weightings of four criteria, and the best design for each.

squama.weightings = (() => {
  // Number of steps along an edge of the tetrahedron, as in `squama rank`.
  const RESOLUTION = 20;
  // Relative volume of the region nearest to a weighting with 0, 1, 2 or 3 zero weights.
  const CELLS = [72, 36, 14, 3];

  const nodes = [];
  for (let m = 0; m <= RESOLUTION; m++) {
    for (let n = 0; n <= RESOLUTION - m; n++) {
      for (let k = 0; k <= RESOLUTION - m - n; k++) {
        const steps = [m, n, k, RESOLUTION - m - n - k];
        nodes.push({ weights: steps.map((step) => step / RESOLUTION), cell: CELLS[steps.filter((step) => step === 0).length] });
      }
    }
  }

  /** Returns the index of the largest weighted sum of terms; of sums equal up to round-off, the first. */
  const best = ([a, b, c, d], [m, n, k, l], sums) => {
    let most = -Infinity;
    for (let i = 0; i < a.length; i++) {
      // Terms are added in the same order as in `scores`, without zero weights, so that sums have
      // the same round-off.
      let sum = 0;
      if (m > 0) sum += m * a[i];
      if (n > 0) sum += n * b[i];
      if (k > 0) sum += k * c[i];
      if (l > 0) sum += l * d[i];
      sums[i] = sum;
      if (sum > most) most = sum;
    }
    const bound = most - squama.ranking.ROUND_OFF;
    return sums.findIndex((sum) => sum >= bound);
  };

  /** Returns the best row at each node, and these rows sorted by their fraction of the weightings. */
  const winners = ({ rows, terms }) => {
    const sums = new Float64Array(rows.length);
    const dots = nodes.map(({ weights, cell }) => ({ weights, cell, row: rows[best(terms, weights, sums)] }));
    const cells = new Map();
    for (const { row, cell } of dots) cells.set(row, (cells.get(row) ?? 0) + cell);
    const regions = [...cells].sort((a, b) => b[1] - a[1] || a[0] - b[0]);
    return { dots, regions: regions.map(([row, own]) => ({ row, share: own / (12 * RESOLUTION ** 3) })) };
  };

  return { winners };
})();

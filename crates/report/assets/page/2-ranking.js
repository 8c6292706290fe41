"use strict";
// The ranking: f = Π criterion^weight. The program embeds the criteria, rescaled to [0, 1], and the Pareto front.

squama.criteria = [
  { key: "m", name: "coverage" },
  { key: "n", name: "critical force" },
  { key: "k", name: "penetration resistance" },
  { key: "l", name: "flexural compliance" },
];

/** Rows that take part: designs with coverage and every criterion. */
squama.ranked = squama.ranking.rows;

/** Rows that no other beats in all criteria. */
squama.front = new Set(squama.ranking.front);

/** Criteria of a row that takes part, larger being better. */
squama.criteriaOf = (() => {
  const criteria = new Map(squama.ranked.map((row, i) => [row, squama.ranking.criteria[i]]));
  return (row) => criteria.get(row);
})();

/** Logarithms of the rescaled criteria of the rows that take part. */
squama.logs = squama.ranking.rescaled.map((criteria) => criteria.map(Math.log));

/**
 * Logarithm of the fitness of the `i`-th row that takes part. A weight of 0 leaves its criterion out.
 * `squama rank` sums in the same order, so that designs as good as equal stand in the same order too.
 */
squama.logFitness = (i, weights) =>
  squama.logs[i].reduce((sum, log, k) => (weights[k] > 0 ? sum + weights[k] * log : sum), 0);

/** The rows that take part with their fitness, the best first; of equals the first design first. */
squama.rank = (weights) => squama.ranked
  .map((row, i) => ({ row, log: squama.logFitness(i, weights) }))
  // Two that are as bad as can be are both -∞, whose difference is no number.
  .sort((a, b) => (a.log === b.log ? a.row - b.row : b.log - a.log))
  .map(({ row, log }) => ({ row, fitness: Math.exp(log) }));

/** The best row for a weighting. */
squama.best = (weights) => {
  let best = 0, most = -Infinity;
  for (let i = 0; i < squama.ranked.length; i++) {
    const log = squama.logFitness(i, weights);
    if (log > most) [best, most] = [i, log];
  }
  return squama.ranked[best];
};

// Weights are whole hundredths that sum to one, so that the command repeats them exactly.
squama.hundredths = [25, 25, 25, 25];
squama.weights = () => squama.hundredths.map((h) => h / 100);
squama.onWeights = [];

/** Sets one weight; the others share what is left in their old proportions. */
squama.setWeight = (which, value) => {
  const others = [0, 1, 2, 3].filter((k) => k !== which);
  const left = 100 - value;
  const sum = others.reduce((total, k) => total + squama.hundredths[k], 0);
  const ideal = others.map((k) => (sum > 0 ? (left * squama.hundredths[k]) / sum : left / 3));
  const parts = ideal.map(Math.floor);
  // What rounding has left over goes to the largest remainders.
  const order = [0, 1, 2].sort((a, b) => (ideal[b] - parts[b]) - (ideal[a] - parts[a]) || a - b);
  for (let spare = left - parts.reduce((a, b) => a + b, 0), i = 0; spare > 0; spare--, i++) parts[order[i]]++;
  squama.hundredths[which] = value;
  others.forEach((k, i) => { squama.hundredths[k] = parts[i]; });
  squama.onWeights.forEach((tell) => tell());
};

(() => {
  const LISTED = 15;
  const fieldset = document.getElementById("weights");
  const inputs = squama.criteria.map((criterion, k) => {
    const input = squama.element("input", {
      type: "range", min: 0, max: 100, step: 1, id: `weight-${criterion.key}`,
      oninput: (event) => squama.setWeight(k, Number(event.target.value)),
    });
    const output = squama.element("output", { for: input.id });
    fieldset.append(squama.element("div", { class: "weight" },
      squama.element("label", { for: input.id }, squama.element("i", {}, criterion.key), ` ${criterion.name}`), input, output));
    return { input, output };
  });
  document.getElementById("equal-weights").addEventListener("click", () => {
    squama.hundredths = [25, 25, 25, 25];
    squama.onWeights.forEach((tell) => tell());
  });

  const left = squama.rows.length - squama.ranked.length;
  document.getElementById("ranking-count").textContent =
    `${squama.ranked.length} designs take part; ${left} without coverage or without every value are left out.`;

  const body = document.querySelector("#best tbody");
  const show = () => {
    const weights = squama.weights();
    inputs.forEach(({ input, output }, k) => {
      input.value = squama.hundredths[k];
      input.setAttribute("aria-valuetext", weights[k].toFixed(2));
      output.textContent = weights[k].toFixed(2);
    });
    document.getElementById("rank-command").textContent = `squama rank ${squama.folder} --weights ${weights.join(",")}`;
    body.replaceChildren(...squama.rank(weights).slice(0, LISTED).map(({ row, fitness }, place) =>
      squama.element("tr", { "data-row": row, ...squama.chooser(row) },
      ...[place + 1, squama.number(row), squama.cell(row, "gap_over_t"), squama.cell(row, "length_over_t"), `${squama.cell(row, "slant_deg")}°`, fitness.toFixed(4)]
        .map((cell) => squama.element("td", {}, String(cell))))));
  };
  squama.onWeights.push(show);
  show();
})();

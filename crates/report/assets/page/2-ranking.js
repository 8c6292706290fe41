"use strict";
// The ranking: every criterion rescaled to [0, 1], f = Π criterion^weight.

squama.criteria = [
  { key: "m", name: "coverage", label: "m  coverage", value: (row) => squama.cell(row, "coverage") },
  { key: "n", name: "critical force", label: "n  critical force", value: (row) => squama.cell(row, "critical_force") },
  { key: "k", name: "penetration resistance", label: "k  penetration resist.", value: (row) => 1 / squama.cell(row, "penetration") },
  { key: "l", name: "flexural compliance", label: "l  flexural compliance", value: (row) => squama.cell(row, "compliance") },
];

/** Rows that take part: designs with coverage and every criterion. */
squama.ranked = squama.rowsWith("coverage", "critical_force", "penetration", "compliance")
  .filter((row) => squama.cell(row, "coverage") > 0 && squama.cell(row, "penetration") > 0);

/** Rescaled criteria of the rows that take part. */
squama.rescaled = (() => {
  const columns = squama.criteria.map((criterion) => {
    const values = squama.ranked.map(criterion.value);
    const low = values.reduce((a, b) => Math.min(a, b), Infinity);
    const high = values.reduce((a, b) => Math.max(a, b), -Infinity);
    return values.map((value) => (high > low ? (value - low) / (high - low) : 1));
  });
  return squama.ranked.map((_, i) => columns.map((column) => column[i]));
})();

/** Fitness of the `i`-th row that takes part. A weight of 0 leaves its criterion out. */
squama.fitness = (i, weights) =>
  squama.rescaled[i].reduce((product, value, k) => product * Math.pow(value, weights[k]), 1);

/** The rows that take part with their fitness, the best first; of equals the first design first. */
squama.rank = (weights) => squama.ranked
  .map((row, i) => ({ row, fitness: squama.fitness(i, weights) }))
  .sort((a, b) => b.fitness - a.fitness || a.row - b.row);

/** The best row for a weighting. */
squama.best = (weights) => {
  let best = -1, most = -1;
  for (let i = 0; i < squama.ranked.length; i++) {
    const fitness = squama.fitness(i, weights);
    if (fitness > most) [best, most] = [squama.ranked[i], fitness];
  }
  return best;
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
      squama.element("label", { for: input.id }, criterion.label), input, output));
    return { input, output };
  });
  document.getElementById("equal-weights").addEventListener("click", () => {
    squama.hundredths = [25, 25, 25, 25];
    squama.onWeights.forEach((tell) => tell());
  });

  const left = squama.rows.length - squama.ranked.length;
  document.getElementById("ranking-note").textContent =
    `f = coverage^m · critical force^n · penetration resistance^k · compliance^l, each rescaled to [0, 1]. ${squama.ranked.length} designs take part; ${left} without coverage or without every value are left out.`;

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
      squama.element("tr", {
        "data-row": row, tabindex: 0,
        onclick: () => squama.choose(row),
        onkeydown: (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); squama.choose(row); } },
      },
      ...[place + 1, squama.number(row), squama.cell(row, "gap_over_t"), squama.cell(row, "length_over_t"), `${squama.cell(row, "slant_deg")}°`, fitness.toFixed(4)]
        .map((cell) => squama.element("td", {}, String(cell))))));
  };
  squama.onWeights.push(show);
  show();
})();

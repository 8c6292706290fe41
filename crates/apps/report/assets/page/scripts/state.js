// State of the page, and functions that change this state and notify listeners.

squama.listeners = new Map();

/** Calls `tell` at changes of any of the `topics`: selection, weights, view, design, pinned. */
squama.listen = (topics, tell) => topics.split(" ").forEach((topic) => {
  squama.listeners.set(topic, [...(squama.listeners.get(topic) ?? []), tell]);
});

squama.tell = (topic) => {
  (squama.listeners.get(topic) ?? []).forEach((tell) => tell());
  squama.writeAddress?.();
};

// Returns integers with the sum `whole` in the proportions of `weights`. The largest remainders are
// rounded up.
squama.hundredths = (weights, whole = 100) => {
  const sum = weights.reduce((a, b) => a + b, 0);
  const ideal = weights.map((weight) => (sum > 0 ? (whole * weight) / sum : whole / weights.length));
  const parts = ideal.map((part) => Math.floor(part + 1e-9));
  const order = ideal.map((_, k) => k).sort((a, b) => (ideal[b] - parts[b]) - (ideal[a] - parts[a]) || a - b);
  for (let spare = whole - parts.reduce((a, b) => a + b, 0), i = 0; spare > 0; spare--, i++) parts[order[i]]++;
  return parts;
};

/** Returns `count` integers with the sum 100 that are as equal as possible. */
squama.equalWeights = (count) => squama.hundredths(Array(count).fill(1));

squama.initial = () => {
  const criteria = squama.ranking.USUAL.map((text) => squama.ranking.criterion(squama, text))
    .filter((one) => one && squama.numeric.includes(one.column));
  return {
    requirements: [], criteria, weights: squama.equalWeights(criteria.length), scale: "paper", sound: false,
    shown: {}, measure: null, map: null, log: false, sort: "design", columns: null, design: null, pinned: null,
  };
};

squama.state = squama.initial();

/** Returns the weights of the criteria, with the sum 1. */
squama.weights = () => squama.state.weights.map((hundredth) => hundredth / 100);

/** Returns the requirements with valid limits. */
squama.required = () => squama.state.requirements.filter(({ limit }) => limit !== null);

/** Invalid requirements of a link. */
squama.unread = [];

/** Returns the designs ranked in the current state. */
squama.contestNow = () => {
  const { criteria, scale, sound } = squama.state;
  squama.meeting = squama.ranking.meeting(squama, squama.required(), (row) => !sound || !squama.folded(row));
  return squama.ranking.contest(squama, criteria.length > 0 ? squama.comparable.ranked(squama.meeting, criteria) : [], criteria, scale);
};

/** Recomputes the ranking from requirements, criteria and the switch for folds, and notifies listeners. */
squama.refresh = () => {
  squama.contest = squama.contestNow();
  squama.passes = new Uint8Array(squama.count);
  squama.meeting.forEach((row) => { squama.passes[row] = 1; });
  squama.tell("selection");
};

/** Sets the requirements. */
squama.require = (requirements) => {
  squama.state.requirements = requirements;
  squama.refresh();
};

squama.choose = (row) => {
  squama.state.design = row;
  squama.tell("design");
};

/** Selects the design that is `step` rows after the selected design in `rows`. */
squama.step = (step, rows) => {
  if (rows.length === 0) return;
  const here = rows.indexOf(squama.state.design);
  squama.choose(rows[here < 0 ? 0 : (here + step + rows.length) % rows.length]);
};

squama.pin = (row) => {
  squama.state.pinned = row;
  squama.tell("pinned");
};

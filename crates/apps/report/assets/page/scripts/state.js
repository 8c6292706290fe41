// State of the page, its listeners, and its form in the address.

squama.listeners = new Map();

/** Calls `tell` on changes of `topics`: selection, weights, view, design, pinned, theme. */
squama.listen = (topics, tell) => topics.split(" ").forEach((topic) => {
  squama.listeners.set(topic, [...(squama.listeners.get(topic) ?? []), tell]);
});

squama.tell = (topic) => {
  (squama.listeners.get(topic) ?? []).forEach((tell) => tell());
  squama.writeAddress?.();
};

/** Whole hundredths in the proportion of `weights` that sum to 100; what rounding leaves over goes to the largest remainders. */
squama.hundredths = (weights, whole = 100) => {
  const sum = weights.reduce((a, b) => a + b, 0);
  const ideal = weights.map((weight) => (sum > 0 ? (whole * weight) / sum : whole / weights.length));
  const parts = ideal.map((part) => Math.floor(part + 1e-9));
  const order = ideal.map((_, k) => k).sort((a, b) => (ideal[b] - parts[b]) - (ideal[a] - parts[a]) || a - b);
  for (let spare = whole - parts.reduce((a, b) => a + b, 0), i = 0; spare > 0; spare--, i++) parts[order[i]]++;
  return parts;
};

/** Whole hundredths that are as equal as can be and sum to 100. */
squama.equalWeights = (count) => squama.hundredths(Array(count).fill(1));

squama.initial = () => {
  const criteria = squama.ranking.PAPER.map((text) => squama.ranking.criterion(squama, text))
    .filter((one) => one && squama.numeric.includes(one.column));
  return {
    requirements: [], criteria, weights: squama.equalWeights(criteria.length), scale: "paper", sound: false,
    shown: {}, measure: null, map: null, log: false, sort: "design", columns: null, design: null, pinned: null,
  };
};

squama.state = squama.initial();

/** Weights of the criteria, as parts of one. */
squama.weights = () => squama.state.weights.map((hundredth) => hundredth / 100);

/** The requirements whose limits can be read. */
squama.required = () => squama.state.requirements.filter(({ limit }) => limit !== null);

/** Invalid requirements of a link. */
squama.unread = [];

/** The designs that are ranked by the state as it is. */
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

/** Chooses the next design of `rows`. */
squama.step = (step, rows) => {
  if (rows.length === 0) return;
  const here = rows.indexOf(squama.state.design);
  squama.choose(rows[here < 0 ? 0 : (here + step + rows.length) % rows.length]);
};

squama.pin = (row) => {
  squama.state.pinned = row;
  squama.tell("pinned");
};

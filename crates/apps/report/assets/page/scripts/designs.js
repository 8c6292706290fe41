// The table of the sweep: columns, cells and their names.

/** Columns of the criteria of the paper. */
[squama.coverage, squama.criticalForce, squama.penetration, squama.compliance] = squama.paper.map(({ column }) => column);

/** All rows, from the top. */
squama.rows = Array.from({ length: squama.count }, (_, row) => row);

/** Names of the columns. */
squama.names = squama.columns.map(({ name }) => name);

squama.place = new Map(squama.names.map((name, place) => [name, place]));

/** Whether there is a column. */
squama.has = (name) => squama.place.has(name);

/** Direction of improvement of a column, "max" or "min"; null if undefined. */
squama.goal = (name) => squama.columns[squama.place.get(name)]?.goal ?? null;

/** Cell of a row: a number, a text, or null. */
squama.cell = (row, name) => {
  const value = squama.values[squama.place.get(name)]?.[row] ?? null;
  return Number.isNaN(value) ? null : value;
};

/** Cells of a column, from the top. */
squama.cells = (name) => (squama.has(name) ? squama.rows.map((row) => squama.cell(row, name)) : []);

/** Numbers of a column, from the top; where a cell is none, NaN. */
squama.numbers = (() => {
  const known = new Map();
  const made = (name) => Float64Array.from(squama.cells(name), (value) => (typeof value === "number" ? value : NaN));
  return (name) => {
    if (!known.has(name)) known.set(name, made(name));
    return known.get(name);
  };
})();

/** Number of a design, as the tables write it. */
squama.number = (row) => squama.cell(row, "design");

/** Row of a design by its number, or null; zeros before it do not matter. */
squama.rowOf = (() => {
  const plain = (number) => String(number).replace(/^0+(?=.)/, "");
  const known = new Map(squama.cells("design").map((number, row) => [plain(number), row]));
  return (number) => known.get(plain(number)) ?? null;
})();

/** Drawing and curves of a design that was solved again; undefined for others. */
squama.solved = (() => {
  const known = new Map(squama.drawings.map((own) => [own.design, own]));
  return (row) => known.get(squama.number(row));
})();

/** The different values of a column, sorted. */
squama.different = (() => {
  const known = new Map();
  const order = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a) < String(b) ? -1 : 1);
  return (name) => {
    if (!known.has(name)) known.set(name, [...new Set(squama.cells(name).filter((value) => value !== null))].sort(order));
    return known.get(name);
  };
})();

/** Axes of the grid that vary. */
squama.varied = squama.axes.filter((name) => squama.different(name).length > 1);

/** Whether the surface of the substrate folds before the puncture of a design ends. */
squama.folded = (row) => squama.cell(row, squama.fold) !== null;
squama.foldedRows = squama.has(squama.fold) ? squama.rows.filter(squama.folded) : [];

/** A number to four digits. */
squama.short = (value) => {
  if (value === null || value === undefined || value === "") return "–";
  if (typeof value !== "number") return String(value);
  const size = Math.abs(value);
  if (value === 0 || (Number.isInteger(value) && size < 1e6)) return String(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(3) : String(Number(value.toPrecision(4)));
};

// Units that end the name of a column, the longest first.
const UNITS = { N_mm2: "N mm²", kg_m2: "kg/m²", N_mm: "N mm", MPa: "MPa", mm: "mm", N: "N", deg: "°" };

/** Unit at the end of a name, as [key, text]; null without one. Where the table says what the unit is, as there. */
squama.unitOf = (name) => {
  const found = Object.entries(UNITS).find(([key]) => name.endsWith(`_${key}`));
  if (!found) return null;
  const said = squama.columns[squama.place.get(name)]?.unit ?? "-";
  return [found[0], said === "-" || said === "deg" ? found[1] : said.replaceAll("^2", "²")];
};

/** Whether a column has a physical unit; angles have none. */
squama.physical = (name) => (squama.unitOf(name)?.[0] ?? "deg") !== "deg";

// Parameters that are called by their symbols.
const SYMBOLS = { gap_over_t: "gap d/t", length_over_t: "length L/t", width_over_t: "width b/t", slant_deg: "slant α" };

/** A column as people call it. */
squama.label = (name) => {
  if (SYMBOLS[name]) return SYMBOLS[name];
  const unit = squama.unitOf(name);
  const plain = unit ? name.slice(0, -unit[0].length - 1) : name;
  return plain.replaceAll("_over_t", "/t").replaceAll("_", " ") + (unit ? ` (${unit[1]})` : "");
};

/** The unit of a column; nothing for lengths over t, and where the name of the column says it. */
squama.unit = (name, unit) => {
  if (unit === "-" || unit === "deg" || name.endsWith("_over_t") || squama.physical(name)) return [];
  const pretty = unit.replaceAll("nu", "ν").replaceAll("^2", "²").replaceAll("-", "−");
  const parts = pretty.split(/_([a-z]+)/).map((part, k) => (k % 2 ? squama.element("sub", {}, part) : part));
  return [" ", squama.element("small", {}, ...parts)];
};

/** A value with its unit. */
squama.withUnit = (name, value, unit) => {
  const text = squama.short(value);
  if (text === "–") return [text];
  return unit === "deg" ? [`${text}°`] : [text, ...squama.unit(name, unit)];
};

/** Colour and mark of the slant of a design: the same everywhere. */
squama.slant = (() => {
  const known = new Map(squama.slants.map((slant) => [slant.degrees, slant]));
  const none = { degrees: null, color: "#888888", mark: "circle" };
  return (row) => known.get(squama.cell(row, "slant_deg")) ?? none;
})();

// Parameters that every title names, and their symbols; those that vary besides are named too.
const SHORT = { gap_over_t: "d/t", length_over_t: "L/t", slant_deg: "α", width_over_t: "b/t", membrane_thickness_over_t: "h/t", contact_modulus_over_substrate: "Ect/Es", contact_modulus_over_membrane: "Ect/Em", critical_tilt_deg: "θc" };
const TITLED = [...new Set(["gap_over_t", "length_over_t", "slant_deg", ...squama.varied])].filter(squama.has);

/** Parameters that identify a design. */
squama.parameters = (row) => TITLED
  .map((name) => `${SHORT[name] ?? squama.label(name).replace(/ \(°\)$/, "")} ${squama.short(squama.cell(row, name))}${name.endsWith("_deg") ? "°" : ""}`)
  .join(", ");

/** One line that names a design. */
squama.title = (row) => `${squama.number(row)}: ${squama.parameters(row)}`;

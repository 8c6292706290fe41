// The table of the sweep: columns, cells and their names.

/** Columns of the measures of the paper. */
[squama.coverage, squama.criticalForce, squama.penetration, squama.compliance] = squama.measures;

/** All rows, from the top. */
squama.rows = Array.from({ length: squama.count }, (_, row) => row);

/** Names of the columns. */
squama.names = squama.columns.map(({ name }) => name);

squama.place = new Map(squama.names.map((name, place) => [name, place]));

/** Returns true if the column exists. */
squama.has = (name) => squama.place.has(name);

/** Returns the direction of improvement of a column, "max" or "min"; null if undefined. */
squama.goal = (name) => squama.columns[squama.place.get(name)]?.goal ?? null;

/** Returns a cell: a number, a text, or null. */
squama.cell = (row, name) => {
  const value = squama.values[squama.place.get(name)]?.[row] ?? null;
  return Number.isNaN(value) ? null : value;
};

/** Returns the mode of a failure force as ", across"; empty for columns without a mode. */
squama.failing = (name, row) => {
  const mode = squama.modes[name] ? squama.cell(row, squama.modes[name]) : null;
  return mode === null ? "" : `, ${mode}`;
};

/** Returns the cells of a column, from the top. */
squama.cells = (name) => (squama.has(name) ? squama.rows.map((row) => squama.cell(row, name)) : []);

/** Returns the numbers of a column, from the top; NaN for other cells. */
squama.numbers = (() => {
  const known = new Map();
  const made = (name) => Float64Array.from(squama.cells(name), (value) => (typeof value === "number" ? value : NaN));
  return (name) => {
    if (!known.has(name)) known.set(name, made(name));
    return known.get(name);
  };
})();

/** Returns the number of a design, as in the tables. */
squama.number = (row) => squama.cell(row, "design");

/** Finds the row of a design by its number, or null; leading zeros are ignored. */
squama.rowOf = (() => {
  const plain = (number) => String(number).replace(/^0+(?=.)/, "");
  const known = new Map(squama.cells("design").map((number, row) => [plain(number), row]));
  return (number) => known.get(plain(number)) ?? null;
})();

/** Returns drawing and curves of a design that was solved again; undefined for other designs. */
squama.solved = (() => {
  const known = new Map(squama.drawings.map((own) => [own.design, own]));
  return (row) => known.get(squama.number(row));
})();

/** Returns the distinct values of a column, sorted. */
squama.different = (() => {
  const known = new Map();
  const order = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a) < String(b) ? -1 : 1);
  return (name) => {
    if (!known.has(name)) known.set(name, [...new Set(squama.cells(name).filter((value) => value !== null))].sort(order));
    return known.get(name);
  };
})();

/** Axes of the grid with several values. */
squama.varied = squama.axes.filter((name) => squama.different(name).length > 1);

/** Returns true if the surface folds during the puncture of a design. */
squama.folded = (row) => squama.cell(row, squama.fold) !== null;
squama.foldedRows = squama.has(squama.fold) ? squama.rows.filter(squama.folded) : [];

/** Formats a number with four significant digits. */
squama.short = (value) => {
  if (value === null || value === undefined || value === "") return "–";
  if (typeof value !== "number") return String(value);
  const size = Math.abs(value);
  if (value === 0 || (Number.isInteger(value) && size < 1e6)) return String(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(3) : String(Number(value.toPrecision(4)));
};

// Unit suffixes of column names, the longest first.
const UNITS = { N_mm2: "N mm²", kg_m2: "kg/m²", N_mm: "N mm", MPa: "MPa", mm: "mm", N: "N", deg: "°" };

/** Returns the unit suffix of a name as [key, text], or null; the unit in the table has priority. */
squama.unitOf = (name) => {
  const found = Object.entries(UNITS).find(([key]) => name.endsWith(`_${key}`));
  if (!found) return null;
  const said = squama.columns[squama.place.get(name)]?.unit ?? "-";
  return [found[0], said === "-" || said === "deg" ? found[1] : said.replaceAll("^2", "²")];
};

/** Returns true if a column has a physical unit; angles have none. */
squama.physical = (name) => (squama.unitOf(name)?.[0] ?? "deg") !== "deg";

// Labels of parameters with symbols.
const SYMBOLS = { gap_over_t: "gap d/t", length_over_t: "length L/t", width_over_t: "width b/t", slant_deg: "slant α" };

// Labels of two depths that are easily confused: the needle moves deeper than the bases of scales.
const DEPTHS = { penetration: "penetration of the bases", critical_displacement: "needle depth" };

/** Returns the label of a column. */
squama.label = (name) => {
  if (SYMBOLS[name]) return SYMBOLS[name];
  const unit = squama.unitOf(name);
  const plain = unit ? name.slice(0, -unit[0].length - 1) : name;
  return (DEPTHS[plain] ?? plain).replaceAll("_over_t", "/t").replaceAll("_", " ") + (unit ? ` (${unit[1]})` : "");
};

/** Returns the unit of a column; empty if the label contains the unit, and for lengths in t. */
squama.unit = (name, unit) => {
  if (unit === "-" || unit === "deg" || name.endsWith("_over_t") || squama.physical(name)) return [];
  const pretty = unit.replaceAll("nu", "ν").replaceAll("^2", "²").replaceAll("-", "−");
  const parts = pretty.split(/_([a-z]+)/).map((part, k) => (k % 2 ? squama.element("sub", {}, part) : part));
  return [" ", squama.element("small", {}, ...parts)];
};

/** Formats a value with its unit. */
squama.withUnit = (name, value, unit) => {
  const text = squama.short(value);
  if (text === "–") return [text];
  return unit === "deg" ? [`${text}°`] : [text, ...squama.unit(name, unit)];
};

/** Returns the colour and mark for the slant of a design, the same in all figures. */
squama.slant = (() => {
  const known = new Map(squama.slants.map((slant) => [slant.degrees, slant]));
  const none = { degrees: null, color: "#888888", mark: "circle" };
  return (row) => known.get(squama.cell(row, "slant_deg")) ?? none;
})();

// Symbols of parameters in the titles of designs. Titles also contain all other varied parameters.
const SHORT = { gap_over_t: "d/t", length_over_t: "L/t", slant_deg: "α", width_over_t: "b/t", membrane_thickness_over_t: "h/t", contact_modulus_over_substrate: "Ect/Es", contact_modulus_over_membrane: "Ect/Em", critical_tilt_deg: "θc" };
const TITLED = [...new Set(["gap_over_t", "length_over_t", "slant_deg", ...squama.varied])].filter(squama.has);

/** Formats the parameters that identify a design. */
squama.parameters = (row) => TITLED
  .map((name) => `${SHORT[name] ?? squama.label(name).replace(/ \(°\)$/, "")} ${squama.short(squama.cell(row, name))}${name.endsWith("_deg") ? "°" : ""}`)
  .join(", ");

/** Formats the title of a design: number and parameters. */
squama.title = (row) => `${squama.number(row)}: ${squama.parameters(row)}`;

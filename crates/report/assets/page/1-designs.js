"use strict";
// The table of the sweep, and the design that is chosen.

const squama = JSON.parse(document.getElementById("data").textContent);

/** Column number of a header, -1 if there is none. */
squama.column = (name) => squama.columns.findIndex((column) => column.name === name);

/** Cell of a row: a number, a text, or null. */
squama.cell = (row, name) => squama.rows[row][squama.column(name)] ?? null;

/** Design numbers, by row. */
squama.number = (row) => squama.cell(row, "design");

/** Rows that have a number in each of the columns. */
squama.rowsWith = (...names) => {
  const columns = names.map(squama.column);
  if (columns.includes(-1)) return [];
  const all = squama.rows.map((_, row) => row);
  return all.filter((row) => columns.every((column) => typeof squama.rows[row][column] === "number"));
};

/** The different numbers of a column, sorted. */
squama.values = (name) => {
  const column = squama.column(name);
  const numbers = squama.rows.map((row) => row[column]).filter((value) => typeof value === "number");
  return [...new Set(numbers)].sort((a, b) => a - b);
};

/** A number to four digits. */
squama.short = (value) => {
  if (value === null || value === undefined || value === "") return "–";
  if (typeof value !== "number") return String(value);
  const size = Math.abs(value);
  if (value === 0 || (Number.isInteger(value) && size < 1e6)) return String(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(3) : String(Number(value.toPrecision(4)));
};

/** A column as people call it. */
squama.label = (name) => ({
  gap_over_t: "gap d/t", length_over_t: "length L/t", width_over_t: "width b/t", slant_deg: "slant α",
}[name] ?? name.replaceAll("_", " "));

/** A value with its unit; lengths over t are numbers. */
squama.withUnit = (name, value, unit) => {
  const text = squama.short(value);
  if (unit === "deg" && text !== "–") return [`${text}°`];
  if (unit === "-" || text === "–" || name.endsWith("_over_t")) return [text];
  const pretty = unit.replaceAll("nu", "ν").replaceAll("^2", "²").replaceAll("-", "−");
  const parts = pretty.split(/_([a-z]+)/).map((part, k) => (k % 2 ? squama.element("sub", {}, part) : part));
  return [`${text} `, squama.element("small", {}, ...parts)];
};

/** Colour and symbol of a slant: the same everywhere. */
squama.slant = (row) => squama.slants.find((slant) => slant.degrees === squama.cell(row, "slant_deg"))
  ?? { color: "#888888", symbol: "circle" };

/** One line that names a design. */
squama.title = (row) => `${squama.number(row)}: d/t ${squama.cell(row, "gap_over_t")}, L/t ${squama.cell(row, "length_over_t")}, α ${squama.cell(row, "slant_deg")}°`;

squama.chosen = null;
squama.onChoose = [];

/** Chooses a design and tells everyone who shows it. */
squama.choose = (row) => {
  squama.chosen = row;
  squama.onChoose.forEach((tell) => tell(row));
};

/** An element with attributes and children. */
squama.element = (name, attributes = {}, ...children) => {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
};

/** What makes an element choose a row, by click or by key. */
squama.chooser = (row) => ({
  tabindex: 0,
  onclick: () => squama.choose(row),
  onkeydown: (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    squama.choose(row);
  },
});

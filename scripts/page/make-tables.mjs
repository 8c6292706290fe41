// Derives two tables for tests of the page from the table of a run: one with folds and physical
// units, one with 20,000 designs.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const [place] = process.argv.slice(2);
const [header, ...rows] = readFileSync(join(place, "results", "designs.csv"), "utf8").trim().split(/\r?\n/).map((line) => line.split(","));
const column = (name) => header.indexOf(name);

const write = (name, headers, lines, definition = (text) => text) => {
  mkdirSync(join(place, name), { recursive: true });
  writeFileSync(join(place, name, "designs.csv"), [headers, ...lines].map((line) => line.join()).join("\n") + "\n");
  writeFileSync(join(place, name, "run.toml"), definition(readFileSync(join(place, "results", "run.toml"), "utf8")));
};

// Let every seventh design fold at a third of its critical force.
const force = (row) => Number(row[column("critical_force")]);
const more = (row, k) => {
  const folded = k % 7 === 3;
  return {
    gap_stretch_min: folded ? -1.5 : 0.5, fold_force: folded ? force(row) / 3 : "", sound_force: folded ? force(row) / 3 : force(row),
    critical_force_N: 0.3 * force(row), penetration_mm: row[column("penetration")], bend_radius_mm: 5 + k, areal_mass_kg_m2: 0.5 + 0.01 * k,
  };
};
const added = Object.keys(more(rows[0], 0)), headers = [...new Set([...header, ...added])];
write("folded", headers, rows.map((row, k) => {
  const own = { ...Object.fromEntries(header.map((name, place) => [name, row[place]])), ...more(row, k) };
  return headers.map((name) => own[name]);
}));

// Repeat the designs with different widths, and vary their values.
const COPIES = Math.ceil(20000 / rows.length), at = column("slant_deg");
const widths = Array.from({ length: COPIES }, (_, k) => Number((0.2 + 0.01 * k).toFixed(2)));
const copies = rows.flatMap((row) => widths.map((width) => ({ row, width })));
const lines = copies.map(({ row, width }, k) => {
  const own = [...row];
  own[0] = String(k + 1).padStart(5, "0");
  for (const name of ["critical_force", "penetration", "compliance"]) own[column(name)] = String(Number(row[column(name)]) * (1 + 0.1 * Math.sin(7 * k) + 0.1 * width));
  return [...own.slice(0, at), width, ...own.slice(at)];
});
const widen = (text) => text.replace(/^width_over_t = .*\n/m, "").replace(/^slant_deg = /m, `width_over_t = [${widths.join(", ")}]\nslant_deg = `);
write("large", [...header.slice(0, at), "width_over_t", ...header.slice(at)], lines, widen);

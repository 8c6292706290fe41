//! Measured curves: two columns of a CSV file, whose names say what they are and in which unit.

use std::path::Path;

use results::{Quantity, bending_units, puncture_units};
use sweep::{Case, read_input};
use text::reason;

/// The test that a curve was measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    /// Force over displacement of a needle.
    Puncture,
    /// Moment over curvature of a strip.
    Bending,
}

/// A column that is understood: its name, its test, whether it is the first or the second axis, and what one of it is worth in mm, N,
/// 1/mm or N mm; nothing, if it is in the units of the model (`u*`, `F*`, `κ*`, `M*`), as in the tables of `squama design`.
type Column = (&'static str, Test, usize, Option<f64>);

const COLUMNS: [Column; 15] = [
    ("displacement_mm", Test::Puncture, 0, Some(1.0)),
    ("displacement_um", Test::Puncture, 0, Some(1e-3)),
    ("displacement_m", Test::Puncture, 0, Some(1e3)),
    ("displacement", Test::Puncture, 0, None),
    ("force_N", Test::Puncture, 1, Some(1.0)),
    ("force_mN", Test::Puncture, 1, Some(1e-3)),
    ("force_kN", Test::Puncture, 1, Some(1e3)),
    ("force", Test::Puncture, 1, None),
    ("curvature_per_mm", Test::Bending, 0, Some(1.0)),
    ("curvature_per_m", Test::Bending, 0, Some(1e-3)),
    ("curvature", Test::Bending, 0, None),
    ("moment_N_mm", Test::Bending, 1, Some(1.0)),
    ("moment_mN_m", Test::Bending, 1, Some(1.0)),
    ("moment_N_m", Test::Bending, 1, Some(1e3)),
    ("moment", Test::Bending, 1, None),
];

impl Test {
    /// The name in a definition.
    pub fn name(self) -> &'static str {
        match self {
            Self::Puncture => "puncture",
            Self::Bending => "bending",
        }
    }

    /// What its two axes are, with their units.
    pub fn axes(self) -> [(&'static str, &'static str); 2] {
        match self {
            Self::Puncture => [("displacement", "mm"), ("force", "N")],
            Self::Bending => [("curvature", "1/mm"), ("moment", "N mm")],
        }
    }

    /// What the units of the model are worth in mm, N, 1/mm and N mm.
    ///
    /// # Errors
    /// The keys of the material that this takes, if one is missing.
    pub fn units(self, case: &Case) -> Result<[f64; 2], String> {
        let (units, load) = match self {
            Self::Puncture => (puncture_units(case), Quantity::Force),
            Self::Bending => (bending_units(case), Quantity::Moment),
        };
        let keys = || load.needs().iter().map(|key| format!("material.{key}")).collect::<Vec<_>>();
        units.map(|[x, y, _]| [x, y]).ok_or_else(|| keys().join(" and "))
    }
}

/// A measured curve.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    /// The name of its file.
    pub file: String,
    /// The test.
    pub test: Test,
    /// Whether it is in mm, N, 1/mm and N mm, and not in the units of the model.
    pub is_physical: bool,
    /// What one of the unit of the file is worth on the first axis.
    pub(crate) x_unit: f64,
    /// Lines in which both cells are empty: gaps of the recording.
    pub left_out: usize,
    /// Its points, in the order of the file.
    pub points: Vec<[f64; 2]>,
}

/// Largest file of a measured curve: a million points with ten columns.
const MAX_BYTES: u64 = 1 << 28;

/// A file of measurements that cannot be understood.
#[derive(Debug, thiserror::Error)]
#[error("{file}{}: {problem}", line.map(|line| format!(":{line}")).unwrap_or_default())]
pub struct InvalidMeasured {
    file: String,
    line: Option<u64>,
    problem: String,
}

impl MeasuredCurve {
    /// The curve in the file at `path`. `columns` name its first columns, where its first line does not.
    ///
    /// # Errors
    /// If the file cannot be read, has no two columns of one test, or not a number in each line of them.
    pub fn read(path: &Path, columns: Option<&[String]>) -> Result<Self, InvalidMeasured> {
        let file = path.display().to_string();
        match read_input(path, MAX_BYTES) {
            Ok(text) => Self::parse(&text, &file, columns),
            Err(error) => {
                let problem = format!("cannot be read ({}), expected a CSV file", reason(&error));
                Err(InvalidMeasured { file, line: None, problem })
            }
        }
    }

    /// The curve that the `text` of a `file` holds, as [`Self::read`].
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(
        text: &str,
        file: &str,
        columns: Option<&[String]>,
    ) -> Result<Self, InvalidMeasured> {
        let wrong =
            |line, problem: String| InvalidMeasured { file: file.to_owned(), line, problem };
        let (rows, separator) = rows(text);
        let rows = rows.map_err(|error| wrong(None, error.to_string()))?;
        let header = Header::find(&rows, columns, separator);
        let Header { names, lines, unnamed } = header;
        let [(x, of_x), (y, of_y)] = pair(&names).map_err(|problem| wrong(None, problem))?;
        let (mut points, mut left_out) = (Vec::new(), 0);
        for row in &rows[lines..] {
            let line = row.position().map(csv::Position::line);
            // A decimal comma between commas would make two cells of one number.
            let beyond = row.iter().skip(names.len());
            if !unnamed && beyond.clone().any(|cell| !cell.is_empty()) {
                let (found, columns) = (row.len(), names.len());
                let problem = format!(
                    "has {found} cells under {columns} columns, expected as many (with a decimal comma, ; between cells)"
                );
                return Err(wrong(line, problem));
            }
            let cell = |column: usize| row.get(column).unwrap_or_default();
            if [x, y].iter().all(|&column| cell(column).is_empty()) {
                left_out += 1;
                continue;
            }
            let read = |column: usize, worth: Option<f64>| {
                let text = cell(column);
                let read = number(text, separator).map(|number| number * worth.unwrap_or(1.0));
                let expected = "is not accepted, expected a number";
                read.ok_or_else(|| wrong(line, format!("{}: {text:?} {expected}", names[column])))
            };
            points.push([read(x, of_x.3)?, read(y, of_y.3)?]);
        }
        if points.is_empty() {
            return Err(wrong(None, "holds no points, expected a line for each".to_owned()));
        }
        let (test, is_physical) = (of_x.1, of_x.3.is_some());
        let x_unit = of_x.3.unwrap_or(1.0);
        Ok(Self { file: file.to_owned(), test, is_physical, x_unit, left_out, points })
    }
}

/// What the first lines of a file say of its columns.
struct Header {
    names: Vec<String>,
    /// Lines before the first one of numbers.
    lines: usize,
    /// Whether the names come from elsewhere, and perhaps not for all columns.
    unnamed: bool,
}

/// A header stands in one of so many lines: what a testing machine writes before is no longer.
const LONGEST_PREAMBLE: usize = 100;

impl Header {
    /// The names that were given, or those of the first line that names two columns of a test, with the units that the next one has.
    fn find(rows: &[csv::StringRecord], given: Option<&[String]>, separator: char) -> Self {
        let is_text = |row: &csv::StringRecord| row.iter().all(|c| number(c, separator).is_none());
        let texts = |from: usize| from + rows[from..].iter().take_while(|row| is_text(row)).count();
        if let Some(names) = given {
            return Self { names: names.to_vec(), lines: texts(0), unnamed: true };
        }
        let candidates = (0..rows.len().min(LONGEST_PREAMBLE)).flat_map(|i| {
            let units = rows.get(i + 1).filter(|row| is_text(row));
            // With units first: `Force` above `(N)` is in newtons, and alone it has no unit.
            [units.map(|units| (i, Some(units))), Some((i, None))].into_iter().flatten()
        });
        let mut named = candidates.map(|(i, units)| {
            let unit = |k: usize| units.and_then(|row| row.get(k)).unwrap_or_default();
            let cells = rows[i].iter().enumerate();
            let names = cells.map(|(k, cell)| spelled(&format!("{cell} {}", unit(k)))).collect();
            Self { names, lines: texts(i), unnamed: false }
        });
        // If no line names two columns, the first is what the refusal shows.
        named.find(|header| pair(&header.names).is_ok()).unwrap_or_else(|| {
            let first = rows.first().filter(|row| is_text(row)).into_iter().flatten();
            Self { names: first.map(str::to_owned).collect(), lines: texts(0), unnamed: false }
        })
    }
}

/// The name of a column as it is known: `Force [N]`, `force (N)` and `Force, N` are `force_N`, `Curvature (1/m)` is `curvature_per_m`.
fn spelled(name: &str) -> String {
    let name = name.replace("1/", "per ").replace(['µ', 'μ'], "u");
    let mut words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let first = words.next().unwrap_or_default().to_lowercase();
    words.fold(first, |name, word| format!("{name}_{word}"))
}

/// The rows of a CSV text, and the character between its cells.
fn rows(text: &str) -> (Result<Vec<csv::StringRecord>, csv::Error>, char) {
    let text = text.trim_start_matches('\u{feff}');
    // What a machine writes first may have any sign in its sentences; the last line holds numbers.
    let is_row = |line: &&str| !line.starts_with('#') && !line.trim().is_empty();
    let last = text.lines().rfind(is_row).unwrap_or_default();
    // Where the decimal sign is a comma, as on machines in much of Europe, a semicolon stands between cells.
    let separator = [';', '\t'].into_iter().find(|c| last.contains(*c)).unwrap_or(',');
    let reader = csv::ReaderBuilder::new()
        .delimiter(separator as u8)
        .comment(Some(b'#'))
        .has_headers(false)
        // What stands before the header has as many cells as it likes.
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    (reader.into_records().collect(), separator)
}

/// The number that a cell holds.
fn number(cell: &str, separator: char) -> Option<f64> {
    // With a point in it a comma may separate thousands: such a cell is refused, not guessed.
    let is_comma = separator != ',' && !cell.contains('.');
    let cell = if is_comma { cell.replace(',', ".") } else { cell.to_owned() };
    cell.parse().ok().filter(|number: &f64| number.is_finite())
}

/// The columns that are known, with their places, of the first axis or the second.
fn known(names: &[String], axis: usize) -> impl Iterator<Item = (usize, &'static Column)> {
    let of = move |name: &String| COLUMNS.iter().find(|c| c.0 == name && c.2 == axis);
    names.iter().enumerate().filter_map(move |(k, name)| Some((k, of(name)?)))
}

/// The places of the two columns of one test, in one system of units, and what is known of them; or why there are none.
fn pair(names: &[String]) -> Result<[(usize, &'static Column); 2], String> {
    let mut pairs = known(names, 0).flat_map(|x| known(names, 1).map(move |y| [x, y]));
    let found = pairs.find(|[(_, x), (_, y)]| x.1 == y.1 && x.3.is_some() == y.3.is_some());
    // Refused: the first would be taken, and the other may have been meant.
    let count = |column: &Column| names.iter().filter(|name| *name == column.0).count();
    let twice = found.and_then(|pair| pair.into_iter().find(|(_, column)| count(column) > 1));
    if let Some((_, column)) = twice {
        return Err(format!(
            "has several columns {0}, expected one: give the others another name",
            column.0
        ));
    }
    found.ok_or_else(|| {
        let all = COLUMNS.map(|(name, ..)| name).join(" ");
        let names = if names.is_empty() { "none".to_owned() } else { names.join(" ") };
        format!("its columns are {names}, expected two of one test: {all}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> MeasuredCurve {
        MeasuredCurve::parse(text, "a.csv", None).expect("a curve")
    }

    fn refused(text: &str) -> String {
        MeasuredCurve::parse(text, "a.csv", None).expect_err("no curve").to_string()
    }

    #[test]
    fn columns_are_found_by_name_and_come_in_mm_and_newtons() {
        let curve = parsed("time_s,force_mN,displacement_um\n0,0,0\n1,20,500\n");
        assert_eq!((curve.test, curve.is_physical), (Test::Puncture, true));
        assert_eq!(curve.points, [[0.0, 0.0], [0.5, 0.02]]);
        let curve = parsed("curvature_per_m;moment_N_mm\n# by hand\n12,5;0,25\n");
        assert_eq!((curve.test, &*curve.points), (Test::Bending, &[[0.0125, 0.25]][..]));
        let curve = parsed(
            "Specimen;3\nSpeed;5;mm/min\nTime;Weg;Displacement;Force\n(s);;(mm);(N)\n0;9;0;0\n;;;\n1;9;0,5;2\n",
        );
        assert_eq!(
            (curve.is_physical, curve.left_out, &*curve.points),
            (true, 1, &[[0.0, 0.0], [0.5, 2.0]][..])
        );
        let curve = parsed("Displacement [µm],Force (mN),\n500,20,\n");
        assert_eq!(curve.points, [[0.5, 0.02]]);
        assert_eq!(parsed("Curvature (1/m),Moment [N·mm]\n1,2\n").points, [[1e-3, 2.0]]);
        assert!(!parsed("displacement,force,tilt_deg\n0.1,2,3\n").is_physical);
    }

    #[test]
    fn columns_may_be_named_from_outside() {
        let names = ["displacement_mm", "force_N"].map(str::to_owned);
        for text in ["Weg,Kraft\n0.5,2\n", "0.5,2\n"] {
            let curve = MeasuredCurve::parse(text, "a.csv", Some(&names)).expect("a curve");
            assert_eq!(curve.points, [[0.5, 2.0]]);
        }
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        let missing = refused("displacement_mm,moment_N_mm\n1,2\n");
        assert!(missing.starts_with("a.csv: its columns are displacement_mm moment_N_mm, expected two of one test: displacement_mm"), "{missing}");
        assert!(refused("displacement,force_N\n1,2\n").contains("expected two of one test"));
        assert!(refused("").contains("its columns are none"));
        assert_eq!(
            refused("displacement_mm,force_N\n"),
            "a.csv: holds no points, expected a line for each"
        );
        assert_eq!(
            refused("displacement_mm,force_N\n0,0\n1,x\n"),
            "a.csv:3: force_N: \"x\" is not accepted, expected a number"
        );
        assert!(refused("displacement_mm,force_N\n1\n").contains("force_N: \"\" is not accepted"));
        assert!(
            refused("displacement_mm,force_N\n0,5,2,0\n")
                .starts_with("a.csv:2: has 4 cells under 2 columns")
        );
        assert!(
            refused("displacement_mm,force_N,force_N\n1,2,3\n").contains("several columns force_N")
        );
        assert!(refused("displacement_mm,force_N\n1,nan\n").contains("expected a number"));
    }
}

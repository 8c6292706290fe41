//! Measured curves: two columns of a CSV file, named by quantity and unit.

use std::path::Path;

use results::{Quantity, bending_units, puncture_units};
use sweep::{Case, read_input};
use text::reason;

/// Kind of test in which a curve was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    /// Force over displacement of a needle.
    Puncture,
    /// Moment over curvature of a strip.
    Bending,
}

/// A known column: its name, its test, its axis (0 or 1) and its unit.
///
/// The unit is in mm, N, 1/mm or N mm. `None` stands for the units of the model (`u*`, `F*`, `κ*`,
/// `M*`), as in the tables of `squama design`.
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
    /// Returns the name used in definitions.
    pub fn name(self) -> &'static str {
        match self {
            Self::Puncture => "puncture",
            Self::Bending => "bending",
        }
    }

    /// Returns the quantities on the two axes, with their units.
    pub fn axes(self) -> [(&'static str, &'static str); 2] {
        match self {
            Self::Puncture => [("displacement", "mm"), ("force", "N")],
            Self::Bending => [("curvature", "1/mm"), ("moment", "N mm")],
        }
    }

    /// Returns the units of the model on both axes, in mm and N or in 1/mm and N mm.
    ///
    /// # Errors
    ///
    /// If material keys are missing; the error lists them.
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
    /// Name of the file.
    pub file: String,
    /// Kind of test.
    pub test: Test,
    /// True for mm and N or 1/mm and N mm, false for units of the model.
    pub is_physical: bool,
    /// Unit of the first column of the file, in units of [`Self::points`].
    pub(crate) x_unit: f64,
    /// Number of lines with both cells empty, which are gaps in the recording.
    pub left_out: usize,
    /// Displacement or curvature, then force or moment, in the order of the file.
    pub points: Vec<[f64; 2]>,
}

/// Largest file of a measured curve: a million points with ten columns.
const MAX_BYTES: u64 = 1 << 28;

/// Error in a file of measurements.
#[derive(Debug, thiserror::Error)]
#[error("{file}{}: {problem}", line.map(|line| format!(":{line}")).unwrap_or_default())]
pub struct InvalidMeasured {
    file: String,
    line: Option<u64>,
    problem: String,
}

impl MeasuredCurve {
    /// Reads the curve in the file at `path`.
    ///
    /// `columns` names the first columns of the file. Without it, the header of the file does.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, no two columns belong to one test, or a cell is not a number.
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

    /// Reads the curve from the `text` of `file`; see [`Self::read`].
    ///
    /// # Errors
    ///
    /// See [`Self::read`].
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
            // A number with a decimal comma between commas would become two cells.
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

/// Column names of a file, and the end of its header.
struct Header {
    names: Vec<String>,
    /// Number of lines before the first line of numbers.
    lines: usize,
    /// True if the names come from the definition. It may name only the first columns.
    unnamed: bool,
}

/// Number of lines searched for a header. Preambles of machines are shorter.
const LONGEST_PREAMBLE: usize = 100;

impl Header {
    /// Finds the header: the given names, or the first line with two columns of a test.
    ///
    /// Units in the line below are appended to the names.
    fn find(rows: &[csv::StringRecord], given: Option<&[String]>, separator: char) -> Self {
        let is_text = |row: &csv::StringRecord| row.iter().all(|c| number(c, separator).is_none());
        let texts = |from: usize| from + rows[from..].iter().take_while(|row| is_text(row)).count();
        if let Some(names) = given {
            return Self { names: names.to_vec(), lines: texts(0), unnamed: true };
        }
        let candidates = (0..rows.len().min(LONGEST_PREAMBLE)).flat_map(|i| {
            let units = rows.get(i + 1).filter(|row| is_text(row));
            // Try with units first: `Force` above `(N)` is in newtons, but alone it has no unit.
            [units.map(|units| (i, Some(units))), Some((i, None))].into_iter().flatten()
        });
        let mut named = candidates.map(|(i, units)| {
            let unit = |k: usize| units.and_then(|row| row.get(k)).unwrap_or_default();
            let cells = rows[i].iter().enumerate();
            let names = cells.map(|(k, cell)| spelled(&format!("{cell} {}", unit(k)))).collect();
            Self { names, lines: texts(i), unnamed: false }
        });
        // If no line names two columns, the error message shows the first line.
        named.find(|header| pair(&header.names).is_ok()).unwrap_or_else(|| {
            let first = rows.first().filter(|row| is_text(row)).into_iter().flatten();
            Self { names: first.map(str::to_owned).collect(), lines: texts(0), unnamed: false }
        })
    }
}

/// Normalises a column name.
///
/// `Force [N]`, `force (N)` and `Force, N` become `force_N`; `Curvature (1/m)` becomes
/// `curvature_per_m`.
fn spelled(name: &str) -> String {
    let name = name.replace("1/", "per ").replace(['µ', 'μ'], "u");
    let mut words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let first = words.next().unwrap_or_default().to_lowercase();
    words.fold(first, |name, word| format!("{name}_{word}"))
}

/// Returns the rows of a CSV text, and the separator of its cells.
fn rows(text: &str) -> (Result<Vec<csv::StringRecord>, csv::Error>, char) {
    let text = text.trim_start_matches('\u{feff}');
    // Decide by the last line, which holds numbers: a preamble may contain any character.
    let is_row = |line: &&str| !line.starts_with('#') && !line.trim().is_empty();
    let last = text.lines().rfind(is_row).unwrap_or_default();
    // Machines that write decimal commas separate cells with semicolons.
    let separator = [';', '\t'].into_iter().find(|c| last.contains(*c)).unwrap_or(',');
    let reader = csv::ReaderBuilder::new()
        .delimiter(separator as u8)
        .comment(Some(b'#'))
        .has_headers(false)
        // Lines of a preamble have any number of cells.
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    (reader.into_records().collect(), separator)
}

/// Returns the number in a cell.
fn number(cell: &str, separator: char) -> Option<f64> {
    // In a cell with a point, a comma may separate thousands. Such a cell is refused.
    let is_comma = separator != ',' && !cell.contains('.');
    let cell = if is_comma { cell.replace(',', ".") } else { cell.to_owned() };
    cell.parse().ok().filter(|number: &f64| number.is_finite())
}

/// Returns the known columns of an axis, with their indices.
fn known(names: &[String], axis: usize) -> impl Iterator<Item = (usize, &'static Column)> {
    let of = move |name: &String| COLUMNS.iter().find(|c| c.0 == name && c.2 == axis);
    names.iter().enumerate().filter_map(move |(k, name)| Some((k, of(name)?)))
}

/// Returns the first two columns of one test in one system of units, with indices.
///
/// # Errors
///
/// If there is no such pair, or one of the names occurs twice.
fn pair(names: &[String]) -> Result<[(usize, &'static Column); 2], String> {
    let mut pairs = known(names, 0).flat_map(|x| known(names, 1).map(move |y| [x, y]));
    let found = pairs.find(|[(_, x), (_, y)]| x.1 == y.1 && x.3.is_some() == y.3.is_some());
    // Refuse repeated names: taking the first column might be wrong.
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
    fn columns_are_found_by_name_and_converted_to_mm_and_newtons() {
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
    fn the_definition_may_name_the_columns() {
        let names = ["displacement_mm", "force_N"].map(str::to_owned);
        for text in ["Weg,Kraft\n0.5,2\n", "0.5,2\n"] {
            let curve = MeasuredCurve::parse(text, "a.csv", Some(&names)).expect("a curve");
            assert_eq!(curve.points, [[0.5, 2.0]]);
        }
    }

    #[test]
    fn errors_name_the_column_and_the_line() {
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

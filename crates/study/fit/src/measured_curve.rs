//! Measured curves: two columns of a CSV file, named by quantity and unit.

use std::path::Path;

use results::{Quantity, bending_units, puncture_units};
use sweep::{Case, read_input_bytes};
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

const COLUMNS: [Column; 21] = [
    ("displacement_mm", Test::Puncture, 0, Some(1.0)),
    ("displacement_um", Test::Puncture, 0, Some(1e-3)),
    ("displacement_cm", Test::Puncture, 0, Some(10.0)),
    ("displacement_m", Test::Puncture, 0, Some(1e3)),
    ("displacement_in", Test::Puncture, 0, Some(25.4)),
    ("displacement", Test::Puncture, 0, None),
    ("force_N", Test::Puncture, 1, Some(1.0)),
    ("force_mN", Test::Puncture, 1, Some(1e-3)),
    ("force_cN", Test::Puncture, 1, Some(1e-2)),
    ("force_kN", Test::Puncture, 1, Some(1e3)),
    ("force_gf", Test::Puncture, 1, Some(9.806_65e-3)),
    ("force_kgf", Test::Puncture, 1, Some(9.806_65)),
    ("force_lbf", Test::Puncture, 1, Some(4.448_221_615_260_5)),
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
        let wrong = |problem| InvalidMeasured { file: file.clone(), line: None, problem };
        let bytes = read_input_bytes(path, MAX_BYTES).map_err(|error| {
            wrong(format!("cannot be read ({}), expected a CSV file", reason(&error)))
        })?;
        let text = decoded(bytes).ok_or_else(|| {
            wrong("is no text in UTF-8, UTF-16 or Windows-1252, expected a CSV file".to_owned())
        })?;
        Self::parse(&text, &file, columns)
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
        let decimal = decimal(&rows, separator);
        // An open quote takes the rest of the file into one cell.
        let last = rows.last().filter(|row| row.iter().any(|cell| cell.contains('\n')));
        if let Some(row) = last.filter(|_| text.matches('"').count() % 2 == 1) {
            let line = row.position().map(csv::Position::line);
            return Err(wrong(line, "a quote (\") is not closed, expected it in pairs".to_owned()));
        }
        let header = Header::find(Rows { all: &rows, decimal }, columns);
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
                let read = number(text, decimal).map(|number| number * worth.unwrap_or(1.0));
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

/// Characters of Windows-1252 for the bytes 0x80 to 0x9f; undefined bytes stand for themselves.
const WINDOWS_1252: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}',
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// Decodes UTF-8, UTF-16 with a byte-order mark, or otherwise Windows-1252.
///
/// `None` for bytes that are no text.
fn decoded(bytes: Vec<u8>) -> Option<String> {
    match bytes.as_slice() {
        [0xff, 0xfe, text @ ..] => return utf_16(text, u16::from_le_bytes),
        [0xfe, 0xff, text @ ..] => return utf_16(text, u16::from_be_bytes),
        _ => {}
    }
    // Texts hold no zero bytes, pictures and workbooks do.
    let bytes = (!bytes.contains(&0)).then_some(bytes)?;
    // Text in Windows-1252 with a letter beyond ASCII is almost never valid UTF-8.
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|error| error.as_bytes().iter().copied().map(windows_1252).collect());
    Some(text)
}

fn utf_16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Option<String> {
    let units = bytes.chunks_exact(2).map(|two| unit([two[0], two[1]]));
    char::decode_utf16(units).collect::<Result<_, _>>().ok()
}

fn windows_1252(byte: u8) -> char {
    match byte {
        0x80..=0x9f => WINDOWS_1252[usize::from(byte - 0x80)],
        _ => char::from(byte),
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
    fn find(rows: Rows<'_>, given: Option<&[String]>) -> Self {
        if let Some(names) = given {
            return Self { names: names.to_vec(), lines: rows.numbers(), unnamed: true };
        }
        for i in 0..rows.all.len().min(LONGEST_PREAMBLE) {
            let header = Self::at(rows, i, rows.units(i));
            if pair(&header.names).is_ok() {
                return header;
            }
            // A row of text below `force_N` is a remark. Below `force` it holds units, which must
            // not be ignored.
            let header = Self::at(rows, i, None);
            if pair(&header.names).is_ok_and(|[(_, x), _]| x.3.is_some()) {
                return header;
            }
        }
        // The error message shows the line above the numbers.
        let end = rows.numbers();
        let has_units = end >= 2 && rows.units(end - 2).is_some() && rows.is_text(end - 2);
        match end.checked_sub(if has_units { 2 } else { 1 }) {
            Some(i) => Self::at(rows, i, rows.units(i)),
            None => Self { names: Vec::new(), lines: 0, unnamed: false },
        }
    }

    /// Returns the header in row `i`, with `units` from the row below.
    fn at(rows: Rows<'_>, i: usize, units: Option<&csv::StringRecord>) -> Self {
        let mut names = Vec::new();
        for (k, name) in rows.all[i].iter().enumerate() {
            let unit = units.and_then(|row| row.get(k)).unwrap_or_default();
            names.push(spelled(&format!("{name} {unit}")));
        }
        Self { names, lines: rows.end_of_texts(i), unnamed: false }
    }
}

/// Rows of a file, with their decimal sign.
#[derive(Clone, Copy)]
struct Rows<'a> {
    all: &'a [csv::StringRecord],
    decimal: char,
}

impl<'a> Rows<'a> {
    /// Returns true if no cell of a row is a number.
    fn is_text(self, row: usize) -> bool {
        self.all[row].iter().all(|cell| number(cell, self.decimal).is_none())
    }

    /// Returns the end of the rows of text that begin at `row`.
    fn end_of_texts(self, row: usize) -> usize {
        (row..self.all.len()).find(|row| !self.is_text(*row)).unwrap_or(self.all.len())
    }

    /// Returns the row below `row` if it is text, because it may hold units.
    fn units(self, row: usize) -> Option<&'a csv::StringRecord> {
        self.all.get(row + 1).filter(|_| self.is_text(row + 1))
    }

    /// Returns the index of the first row of the table of numbers.
    ///
    /// A preamble may contain numbers, so a table begins with two rows of equally many cells with
    /// at least two numbers each.
    fn numbers(self) -> usize {
        let mut counts = self.all.iter().map(|row| {
            let numbers = row.iter().filter(|cell| number(cell, self.decimal).is_some()).count();
            (row.len(), numbers >= 2)
        });
        let mut before = counts.next();
        let first = counts.position(|count| before.replace(count) == Some(count) && count.1);
        first.unwrap_or_else(|| self.end_of_texts(0))
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

/// Returns the decimal sign of a file with this separator: a comma or a point.
fn decimal(rows: &[csv::StringRecord], separator: char) -> char {
    // In quotes a comma is no separator.
    let is_comma = separator != ',' || rows.iter().flatten().any(has_decimal_comma);
    if is_comma { ',' } else { '.' }
}

/// Returns true for a number with a comma that does not separate thousands.
fn has_decimal_comma(cell: &str) -> bool {
    let Some((whole, fraction)) = cell.trim_start_matches('-').split_once(',') else {
        return false;
    };
    let is_thousands = fraction.len() == 3 && whole != "0";
    let mut digits = whole.bytes().chain(fraction.bytes());
    !is_thousands && !whole.is_empty() && digits.all(|byte| byte.is_ascii_digit())
}

/// Returns the number in a cell.
fn number(cell: &str, decimal: char) -> Option<f64> {
    // In a cell with a point, a comma may separate thousands. Such a cell is refused.
    let is_comma = decimal == ',' && !cell.contains('.');
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
        format!(
            "its columns are {names}, expected two of one test: {all}; \
             columns = [...] in [[curve]], or --measured-columns, names the columns otherwise"
        )
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
    fn an_open_quote_is_refused_at_its_line() {
        let message = refused("displacement_mm,force_N\n0,0\n\"1,2\n3,4\n5,6\n");
        assert_eq!(message, "a.csv:3: a quote (\") is not closed, expected it in pairs");
        // Quoted line ends in a header, and inch marks in a preamble, are no mistakes.
        let curve = parsed("3\" needle\n\"Displacement\n[mm]\",\"Force\n[N]\"\n0,0\n1,2\n");
        assert_eq!(curve.points, [[0.0, 0.0], [1.0, 2.0]]);
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
    fn units_in_their_own_row_are_converted_or_refused() {
        let curve = parsed("Displacement,Force\n(in),(lbf)\n1,1\n");
        assert_eq!((curve.is_physical, curve.points[0]), (true, [25.4, 4.448_221_615_260_5]));
        assert_eq!(parsed("Displacement,Force\n(mm),(cN)\n1,50\n").points, [[1.0, 0.5]]);
        let message = refused("Displacement,Force\n(ft),(oz)\n1,2\n3,4\n");
        assert!(message.starts_with("a.csv: its columns are displacement_ft force_oz,"), "{message}");
        // A row without units is no row of units.
        assert!(!parsed("displacement,force\n,\n1,2\n").is_physical);
    }

    #[test]
    fn preambles_with_numbers_are_skipped() {
        let text =
            "Rate,2.0,mm/min\nDiameter,2.0,mm\nTime,Extension,Load\n(sec),(mm),(N)\n0,1,2\n1,3,4\n";
        let message = refused(text);
        assert!(message.contains("its columns are time_sec extension_mm load_N,"), "{message}");
        let names = ["time", "displacement_mm", "force_N"].map(str::to_owned);
        let curve = MeasuredCurve::parse(text, "a.csv", Some(&names)).expect("a curve");
        assert_eq!(curve.points, [[1.0, 2.0], [3.0, 4.0]]);
    }

    #[test]
    fn decimal_commas_in_quotes_are_read() {
        let curve = parsed("\"displacement_mm\",\"force_N\"\n\"0,5\",\"-0,25\"\n\"1,125\",\"2\"\n");
        assert_eq!(curve.points, [[0.5, -0.25], [1.125, 2.0]]);
        assert!(refused("displacement_mm,force_N\n\"1,000\",2\n").contains("expected a"));
    }

    #[test]
    fn texts_of_other_encodings_are_decoded() {
        let text = "Prüfling;–\nDisplacement;Force\n(µm);(N)\n500;2\n";
        let utf_16: Vec<u16> = std::iter::once(0xfeff).chain(text.encode_utf16()).collect();
        let big: Vec<u8> = utf_16.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        let little: Vec<u8> = utf_16.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let windows = b"Pr\xfcfling;\x96\nDisplacement;Force\n(\xb5m);(N)\n500;2\n".to_vec();
        for bytes in [text.as_bytes().to_vec(), big, little, windows] {
            assert_eq!(decoded(bytes).as_deref(), Some(text));
        }
        assert_eq!(parsed(text).points, [[0.5, 2.0]]);
        assert_eq!(decoded(b"\x89PNG\0".to_vec()), None);
        assert_eq!(decoded(b"\xff\xfe\0\xd8".to_vec()), None);
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

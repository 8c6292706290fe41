//! Measured curves: two columns of a text file, named by quantity and unit.

mod columns;
mod header;
mod loading;
mod mean;
mod number_table;

use std::path::Path;

use results::{Quantity, bending_units, puncture_units};
use sweep::{Case, read_input_bytes};
use text::reason;

use self::columns::CurveColumns;
use self::header::Header;
pub(crate) use self::loading::Branches;
pub use self::loading::{CurveEvent, CurveEventKind};
pub use self::mean::MeanCurve;
use self::number_table::{NumberTable, Row, Rows};

/// Kind of test in which a curve was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    /// Force on a needle as a function of its displacement.
    Puncture,
    /// Moment on a strip as a function of its curvature.
    Bending,
}

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

    /// Returns the size of one model unit on each axis, in mm and N or in 1/mm and N mm.
    ///
    /// # Errors
    ///
    /// If material keys are missing; the error lists them.
    pub fn units(self, case: &Case) -> Result<[f64; 2], String> {
        let (units, load) = match self {
            Self::Puncture => (puncture_units(case), Quantity::Force),
            Self::Bending => (bending_units(case), Quantity::Moment),
        };
        units.map(|[x, y, _]| [x, y]).ok_or_else(|| {
            let keys = load.needs().iter().map(|key| format!("material.{key}"));
            keys.collect::<Vec<_>>().join(" and ")
        })
    }
}

/// A measured curve.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    /// Name of the file, followed by the specimen if the file holds several.
    pub file: String,
    /// Name of the specimen in the file, if the file holds several.
    pub specimen: Option<String>,
    /// Kind of test.
    pub test: Test,
    /// True for mm and N or 1/mm and N mm, false for units of the model.
    pub is_physical: bool,
    /// Unit of the first column of the file, in units of [`Self::points`].
    pub(crate) x_unit: f64,
    /// Numbers of the lines that were left out: remarks, footers, and gaps in the recording.
    ///
    /// If a table has several specimens, only the first one lists the lines outside of the table.
    pub skipped_lines: Vec<u64>,
    /// Displacement or curvature, then force or moment, in the order of the file.
    pub points: Vec<[f64; 2]>,
    /// Line number of each point.
    lines: Vec<u64>,
    /// True for each axis on which the signs of the file were reversed.
    pub reversed: [bool; 2],
}

/// Maximum size of a file of measured curves in bytes: a million points in ten columns.
const MAX_BYTES: u64 = 1 << 28;

/// Largest offset that is searched, as a fraction of the largest absolute value on its axis.
const FARTHEST_OFFSET: f64 = 0.25;
/// Fraction of the largest force above which a force is certainly contact, not noise.
const TOUCHING: f64 = 0.1;

/// Error in a file of measurements.
#[derive(Debug, thiserror::Error)]
#[error("{file}{}: {problem}", line.map(|line| format!(":{line}")).unwrap_or_default())]
pub struct InvalidMeasured {
    file: String,
    line: Option<u64>,
    problem: String,
}

impl MeasuredCurve {
    /// Reads the curves of all specimens in the file at `path`.
    ///
    /// `columns` names the first columns of the file. If it is `None`, the header of the file names
    /// the columns.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, no two columns belong to one kind of test, or a cell is not a
    /// number.
    pub fn read(path: &Path, columns: Option<&[String]>) -> Result<Vec<Self>, InvalidMeasured> {
        let file = path.display().to_string();
        match read_text(path) {
            Ok(text) => Self::parse(&text, &file, columns),
            Err(problem) => Err(InvalidMeasured { file, line: None, problem }),
        }
    }

    /// Reads the curves from the `text` of `file`; see [`Self::read`].
    ///
    /// # Errors
    ///
    /// See [`Self::read`].
    pub fn parse(
        text: &str,
        file: &str,
        columns: Option<&[String]>,
    ) -> Result<Vec<Self>, InvalidMeasured> {
        let wrong =
            |line, problem: String| InvalidMeasured { file: file.to_owned(), line, problem };
        let rows = Rows::new(text).map_err(|error| wrong(None, error.to_string()))?;
        if rows.open_quote.is_some() {
            let problem = "a quote (\") is not closed, expected quotes in pairs".to_owned();
            return Err(wrong(rows.open_quote, problem));
        }
        let tables = tables(&rows, columns.is_some());
        if tables.is_empty() {
            let header = Header::find(&rows, 0..rows.all.len(), columns);
            header.curves().map_err(|problem| wrong(header.line(&rows), problem))?;
            return Err(wrong(None, "holds no points, expected a line for each point".to_owned()));
        }
        let (mut curves, mut specimens) = (Vec::new(), Vec::new());
        for table in &tables {
            let header = Header::find(&rows, table.above.clone(), columns);
            let line = header.line(&rows);
            let specimens_here = header.curves().map_err(|problem| wrong(line, problem))?;
            let width = table.rows.first().map_or(0, |row| rows.all[*row].cells.len());
            let is_named = tables.len() > 1 || specimens_here.len() > 1;
            let mut from = 0;
            for (index, columns) in specimens_here.into_iter().enumerate() {
                // A header may name more specimens than the table has columns. Skip the others.
                if index > 0 && columns.indices.iter().all(|column| *column >= width) {
                    continue;
                }
                let end = columns.indices[0].max(columns.indices[1]) + 1;
                let name = header.specimen(&rows, from..end);
                from = end;
                let name_row = header.named(&rows).filter(|_| is_named);
                let skipped_lines = match index {
                    0 => header.skipped_lines(&rows, table, name_row),
                    _ => Vec::new(),
                };
                let curve = Self::in_table(&rows, (table, skipped_lines), &header, columns);
                curves.push(curve.map_err(|(line, problem)| wrong(Some(line), problem))?);
                specimens.push(name);
            }
        }
        let has_several = curves.len() > 1;
        for (index, (curve, name)) in curves.iter_mut().zip(specimens).enumerate() {
            let name = if name.is_empty() { (index + 1).to_string() } else { name };
            curve.specimen = has_several.then_some(name);
            curve.set_file(file);
        }
        Ok(curves)
    }

    /// Sets the name of the file, followed by the specimen if the file holds several.
    pub(crate) fn set_file(&mut self, file: &str) {
        self.file = match &self.specimen {
            Some(name) if name.to_lowercase().starts_with("specimen") => format!("{file}, {name}"),
            Some(name) => format!("{file}, specimen {name}"),
            None => file.to_owned(),
        };
    }

    /// Reads one curve from a table; an error has its line number and a description.
    fn in_table(
        rows: &Rows,
        (table, mut skipped_lines): (&NumberTable, Vec<u64>),
        header: &Header,
        columns: CurveColumns,
    ) -> Result<Self, (u64, String)> {
        let CurveColumns { indices, test, units } = columns;
        let names = &header.names;
        let (mut points, mut lines) = (Vec::new(), Vec::new());
        let last = table.rows.iter().copied().rfind(|row| rows.are_numbers(*row, indices));
        for &row in &table.rows {
            let Row { line, cells, .. } = &rows.all[row];
            if !header.is_given {
                check_width(cells, names.len()).map_err(|problem| (*line, problem))?;
            }
            let pair = indices.map(|index| rows.all[row].cell(index));
            if pair == ["", ""] {
                // Empty cells after the last point belong to a specimen that is shorter than its
                // neighbours in the table. Empty cells before the last point are gaps.
                if last.is_some_and(|last| row < last) {
                    skipped_lines.push(*line);
                }
                continue;
            }
            // Leave out rows of results after the last point, and remarks: rows with text in a
            // column that has a number in the first row of the table.
            let is_result = last.is_some_and(|last| row > last) && rows.number(pair[0]).is_none();
            if is_result || (rows.are_numbers(row, indices) && !rows.is_like(row, table.rows[0])) {
                skipped_lines.push(*line);
                continue;
            }
            let mut point = [0.0; 2];
            for axis in 0..2 {
                let number = rows.number(pair[axis]).ok_or_else(|| {
                    let (name, cell) = (&names[indices[axis]], pair[axis]);
                    let expected = "is not accepted, expected a number";
                    (*line, format!("{name}: {cell:?} {expected}"))
                })?;
                point[axis] = number * units.map_or(1.0, |units| units[axis]);
            }
            points.push(point);
            lines.push(*line);
        }
        skipped_lines.sort_unstable();
        let reversed = loading::reversed_signs(&points);
        for point in &mut points {
            for axis in (0..2).filter(|axis| reversed[*axis]) {
                point[axis] = -point[axis];
            }
        }
        Ok(Self {
            file: String::new(),
            specimen: None,
            test,
            is_physical: units.is_some(),
            x_unit: units.map_or(1.0, |units| units[0]),
            skipped_lines,
            points,
            lines,
            reversed,
        })
    }

    /// Returns the range in which the offset of an axis is searched.
    ///
    /// The range of a displacement offset includes the end of a long approach without force.
    pub(crate) fn offset_range(&self, axis: usize) -> [f64; 2] {
        let [largest_x, largest_load] = [0, 1].map(|axis| {
            // The bounds must differ, even if all values are zero.
            let sizes = self.points.iter().map(|point| point[axis].abs());
            sizes.fold(f64::MIN_POSITIVE, f64::max)
        });
        let to = FARTHEST_OFFSET * if axis == 0 { largest_x } else { largest_load };
        let force = TOUCHING * largest_load;
        let touching = self.points.iter().position(|point| point[1].abs() > force);
        let (Some(touching), 0) = (touching, axis) else { return [-to, to] };
        let [first, x] = [0, touching].map(|index| self.points[index][0]);
        let near = FARTHEST_OFFSET * loading::range(&self.points);
        if touching > 0 && first.abs() > to && near > 0.0 {
            // The machine measures the displacement from a distant origin: search around the first
            // value.
            return [first - near, x.max(first + near)];
        }
        // Contact may begin anywhere before `x`, because the force may rise slowly.
        if x > to {
            [-to, x + 0.1 * to]
        } else if x < -to {
            [x - 0.1 * to, to]
        } else {
            [-to, to]
        }
    }

    /// Returns the points of the first loading branch, without holds.
    pub fn loading(&self) -> Vec<[f64; 2]> {
        self.branches().loading.into_iter().map(|index| self.points[index]).collect()
    }

    /// Divides the curve into its loading and unloading branches, and detects events.
    pub(crate) fn branches(&self) -> Branches {
        loading::branches(&self.points, &self.lines)
    }
}

/// Finds the tables of the specimens in a file.
fn tables(rows: &Rows, are_columns_named: bool) -> Vec<NumberTable> {
    let tables = rows.tables(|row| Header::known(rows, row).is_some());
    if !are_columns_named {
        return tables;
    }
    // If the definition names the columns, their header in the file is unknown text. A repetition
    // of the row of text above the longest table then begins another specimen.
    let longest = tables.iter().find(|table| table.is_longest);
    let repeated = longest.and_then(|table| table.above.clone().last());
    let repeated = repeated.filter(|row| rows.is_text(*row)).map(|row| &rows.all[row].cells);
    rows.tables(|row| Some(&rows.all[row].cells) == repeated)
}

/// Refuses a row with more cells than columns.
///
/// In a file with commas between cells, a decimal comma would split a number into two cells.
fn check_width(cells: &csv::StringRecord, columns: usize) -> Result<(), String> {
    if cells.iter().skip(columns).all(str::is_empty) {
        return Ok(());
    }
    Err(format!(
        "has {} cells under {columns} columns, expected one cell for each column; with decimal commas, separate the cells by semicolons",
        cells.len()
    ))
}

/// Reads a text file. An error is a description of the problem.
fn read_text(path: &Path) -> Result<String, String> {
    let bytes = read_input_bytes(path, MAX_BYTES)
        .map_err(|error| format!("cannot be read ({}), expected a CSV file", reason(&error)))?;
    decoded(&bytes).ok_or_else(|| {
        "is not text in UTF-8, UTF-16 or Windows-1252, expected a CSV file".to_owned()
    })
}

/// Decodes text in UTF-8 or UTF-16, and other text as Windows-1252.
///
/// `None` for bytes that are not text.
fn decoded(bytes: &[u8]) -> Option<String> {
    if let Some((encoding, mark)) = encoding_rs::Encoding::for_bom(bytes) {
        let text = encoding.decode_without_bom_handling_and_without_replacement(&bytes[mark..])?;
        return Some(text.into_owned());
    }
    if bytes.contains(&0) {
        let encoding = utf_16_without_mark(bytes)?;
        let text = encoding.decode_without_bom_handling_and_without_replacement(bytes)?;
        return Some(text.into_owned());
    }
    // Text in Windows-1252 with a letter beyond ASCII is almost never valid UTF-8.
    let text = std::str::from_utf8(bytes).map(str::to_owned);
    Some(text.unwrap_or_else(|_| encoding_rs::WINDOWS_1252.decode(bytes).0.into_owned()))
}

/// Detects UTF-16 without a byte-order mark by the zero bytes of its letters and digits.
///
/// `None` for other bytes with zeros, such as pictures and workbooks.
fn utf_16_without_mark(bytes: &[u8]) -> Option<&'static encoding_rs::Encoding> {
    let most = bytes.len() / 4;
    let mut zeros = [0, 0];
    for (index, _) in bytes.iter().enumerate().filter(|(_, byte)| **byte == 0) {
        zeros[index % 2] += 1;
    }
    match zeros {
        [0, odd] if odd > most => Some(encoding_rs::UTF_16LE),
        [even, 0] if even > most => Some(encoding_rs::UTF_16BE),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> MeasuredCurve {
        let mut curves = MeasuredCurve::parse(text, "a.csv", None).expect("a curve");
        assert_eq!(curves.len(), 1);
        curves.swap_remove(0)
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
            (curve.is_physical, curve.skipped_lines.clone(), &*curve.points),
            (true, vec![1, 2, 6], &[[0.0, 0.0], [0.5, 2.0]][..])
        );
        let curve = parsed("Displacement [µm],Force (mN),\n500,20,\n");
        assert_eq!(curve.points, [[0.5, 0.02]]);
        assert_eq!(parsed("Curvature (1/m),Moment [N·mm]\n1,2\n").points, [[1e-3, 2.0]]);
        assert!(!parsed("displacement,force,tilt_deg\n0.1,2,3\n").is_physical);
    }

    #[test]
    fn an_open_quote_is_refused_at_its_line() {
        let message = refused("displacement_mm,force_N\n0,0\n\"1,2\n3,4\n5,6\n");
        assert_eq!(message, "a.csv:3: a quote (\") is not closed, expected quotes in pairs");
        // Quoted line ends in a header, and inch marks in a preamble, are accepted.
        let curve = parsed("3\" needle\n\"Displacement\n[mm]\",\"Force\n[N]\"\n0,0\n1,2\n");
        assert_eq!(curve.points, [[0.0, 0.0], [1.0, 2.0]]);
    }

    #[test]
    fn the_definition_may_name_the_columns() {
        let names = ["displacement_mm", "force_N"].map(str::to_owned);
        for text in ["Weg,Kraft\n0.5,2\n", "0.5,2\n"] {
            let curve = MeasuredCurve::parse(text, "a.csv", Some(&names)).expect("a curve");
            assert_eq!(curve[0].points, [[0.5, 2.0]]);
        }
    }

    #[test]
    fn units_in_their_own_row_are_converted_or_refused() {
        let curve = parsed("Displacement,Force\n(in),(lbf)\n1,1\n");
        assert_eq!((curve.is_physical, curve.points[0]), (true, [25.4, 4.448_221_615_260_5]));
        assert_eq!(parsed("Displacement,Force\n(mm),(cN)\n1,50\n").points, [[1.0, 0.5]]);
        // The units may be below a row of remarks.
        assert_eq!(parsed("Displacement,Force\nActuator,Cell\nmm,cN\n1,50\n").points, [[1.0, 0.5]]);
        let message = refused("Displacement,Force\nActuator,Cell\nft,oz\n1,50\n");
        assert!(message.contains("displacement_Actuator has no known unit"), "{message}");
        let message = refused("Displacement,Force\n(ft),(oz)\n1,2\n3,4\n");
        assert!(
            message.starts_with("a.csv:1: its columns are displacement_ft force_oz: displacement_ft has no known unit,"),
            "{message}"
        );
        // An empty row below the header is not a row of units.
        assert!(!parsed("displacement,force\n,\n1,2\n").is_physical);
    }

    #[test]
    fn preambles_with_numbers_are_skipped() {
        let text =
            "Rate,2.0,mm/min\nDiameter,2.0,mm\nTime,Extension,Load\n(sec),(mm),(N)\n0,1,2\n1,3,4\n";
        let curve = parsed(text);
        assert_eq!(
            (&*curve.skipped_lines, &*curve.points),
            (&[1, 2][..], &[[1.0, 2.0], [3.0, 4.0]][..])
        );
        let unknown = text.replace("Extension", "Gauge");
        let message = refused(&unknown);
        let expected = "a.csv:3: its columns are time_sec gauge_mm load_N: no column is a displacement or a curvature;";
        assert!(message.starts_with(expected), "{message}");
        let names = ["time", "displacement_mm", "force_N"].map(str::to_owned);
        let message = MeasuredCurve::parse(&text.replace("(N)", "(lbf)"), "a.csv", Some(&names));
        let message = message.expect_err("another unit").to_string();
        assert_eq!(
            message,
            "a.csv:3: column 3 is force_lbf according to its unit in the file, but is named force_N; expected the same unit"
        );
        let curve = MeasuredCurve::parse(text, "a.csv", Some(&names)).expect("a curve");
        assert_eq!(curve[0].points, [[1.0, 2.0], [3.0, 4.0]]);
    }

    #[test]
    fn specimens_of_a_file_are_named() {
        let side_by_side = "A;;B 7;\nWeg mm;Kraft N;Weg mm;Kraft N\n1;2;3;4\n5;6;;\n";
        let below = "Weg mm;Kraft N\n1;2\n5;6\n\nEnd\nWeg mm;Kraft N\n3;4\n";
        let curves = MeasuredCurve::parse(side_by_side, "a.csv", None).expect("curves");
        let files: Vec<_> = curves.iter().map(|curve| curve.file.as_str()).collect();
        assert_eq!(files, ["a.csv, specimen A", "a.csv, specimen B 7"]);
        assert_eq!(curves[0].points, [[1.0, 2.0], [5.0, 6.0]]);
        // Empty cells after the last point of the shorter second specimen are not left-out lines.
        assert_eq!((&*curves[1].points, &*curves[1].skipped_lines), (&[[3.0, 4.0]][..], &[][..]));
        // A header with a single row of numbers below it is not a specimen.
        assert_eq!(parsed(below).skipped_lines, [5, 6, 7]);
        let below = format!("{below}7;8\n");
        let curves = MeasuredCurve::parse(&below, "a.csv", None).expect("curves");
        assert_eq!(curves[1].file, "a.csv, specimen End");
        assert_eq!(curves[1].points, [[3.0, 4.0], [7.0, 8.0]]);
        let names = ["displacement_mm", "force_N"].map(str::to_owned);
        let curves = MeasuredCurve::parse(&below, "a.csv", Some(&names)).expect("curves");
        assert_eq!(curves.len(), 2);
    }

    #[test]
    fn footers_and_single_rows_of_numbers_are_left_out() {
        let curve = parsed("x,y\n25,100\n\nDisplacement (mm),Force (N)\n1,2\n3,4\n\nEnd of test\n");
        assert_eq!((&*curve.skipped_lines, curve.points.len()), (&[1, 2, 8][..], 2));
    }

    #[test]
    fn summary_rows_above_or_below_the_data_are_left_out() {
        let results = "Results\n,\"Maximum Load\",\"Extension\"\n,(N),(mm)\n1,9,8\n2,7,6\n";
        let data = "Time,Extension,Load\n(s),(mm),(N)\n0,1,2\n1,3,4\n2,5,6\n";
        let points = [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]];
        assert_eq!(parsed(&format!("{results}\n{data}")).points, points);
        assert_eq!(parsed(&format!("{data}\n{results}")).points, points);
        for footer in ["Mean,3,4\nSD,1,1\n", "Maximum,5,6\n", "Maximum,x,6\n", ",Maximum,6\n"] {
            let curve = parsed(&format!("{data}{footer}"));
            assert_eq!((&*curve.points, curve.skipped_lines[0]), (&points[..], 6), "{footer}");
            assert_eq!(parsed(&format!("{data}\n{footer}")).points, points);
        }
    }

    #[test]
    fn specimen_names_above_their_first_column_are_read() {
        let rows = "Zeit;Weg;Kraft;Zeit;Weg;Kraft\ns;mm;N;s;mm;N\n0;1;2;0;3;4\n1;5;6;1;7;8\n";
        let text = format!("Probe 7;;;Probe 9;;\n{rows}");
        let curves = MeasuredCurve::parse(&text, "a.csv", None).expect("curves");
        let names: Vec<_> = curves.iter().map(|c| (c.specimen.as_deref(), &*c.file)).collect();
        assert_eq!(names[1], (Some("Probe 9"), "a.csv, specimen Probe 9"));
        assert_eq!((names[0].0, curves[1].points[1]), (Some("Probe 7"), [7.0, 8.0]));
        assert!(curves[0].skipped_lines.is_empty());
    }

    #[test]
    fn negative_compression_is_read_as_positive() {
        let curve = parsed("displacement_mm,force_N\n-0.1,-1\n-0.2,-3\n");
        assert_eq!((curve.reversed, &*curve.points), ([true; 2], &[[0.1, 1.0], [0.2, 3.0]][..]));
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
            assert_eq!(decoded(&bytes).as_deref(), Some(text));
        }
        assert_eq!(parsed(text).points, [[0.5, 2.0]]);
        // UTF-16 without a byte-order mark is recognised, too.
        let units: Vec<u16> = "Weg mm\tKraft kN\r\n0,5\t0,002\r\n".encode_utf16().collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        for bytes in [big, little] {
            let text = decoded(&bytes).expect("a text");
            assert_eq!(parsed(&text).points, [[0.5, 2.0]]);
        }
        assert_eq!(decoded(b"\x89PNG\0"), None);
        assert_eq!(decoded(b"\xff\xfe\0\xd8"), None);
    }

    #[test]
    fn errors_name_the_column_and_the_line() {
        let missing = refused("displacement_mm,moment_N_mm\n1,2\n");
        assert!(missing.starts_with("a.csv:1: its columns are displacement_mm moment_N_mm: no two columns belong to one test; expected displacement_mm (_um _cm _m _in) and force_N"), "{missing}");
        assert!(
            refused("displacement,force_N\n1,2\n").contains(": displacement has no known unit;")
        );
        assert!(refused("").contains("a.csv: has no header; expected displacement_mm"));
        assert_eq!(
            refused("displacement_mm,force_N\n"),
            "a.csv: holds no points, expected a line for each point"
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

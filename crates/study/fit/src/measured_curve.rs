//! Measured curves: two columns of a text file, named by quantity and unit.

mod columns;
mod loading;
mod mean;
mod number_table;

use std::ops::Range;
use std::path::Path;

use results::{Quantity, bending_units, puncture_units};
use sweep::{Case, read_input_bytes};
use text::reason;

use self::columns::{CurveColumns, curves, spelled};
pub(crate) use self::loading::Branches;
pub use self::loading::{CurveEvent, CurveEventKind};
pub use self::mean::MeanCurve;
use self::number_table::{NumberTable, Rows};

/// Kind of test in which a curve was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    /// Force over displacement of a needle.
    Puncture,
    /// Moment over curvature of a strip.
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
    /// Lines that were left out: remarks, footers, and gaps in the recording.
    ///
    /// Only the first specimen of a table lists the lines outside of the table.
    pub left_out: Vec<u64>,
    /// Displacement or curvature, then force or moment, in the order of the file.
    pub points: Vec<[f64; 2]>,
    /// Line of each point.
    lines: Vec<u64>,
    /// Whether the signs of the file were reversed, on both axes.
    pub reversed: [bool; 2],
}

/// Largest file of measured curves: a million points with ten columns.
const MAX_BYTES: u64 = 1 << 28;

/// Bounds of an offset, as a fraction of the largest value on its axis.
const FARTHEST_OFFSET: f64 = 0.25;
/// Fraction of the largest force that the noise before contact does not reach.
const TOUCHING: f64 = 0.1;

/// Number of rows above a table that are searched for a header.
const LONGEST_PREAMBLE: usize = 100;

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
    /// `columns` names the first columns of the file. Without it, the header of the file does.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, no two columns belong to one test, or a cell is not a number.
    pub fn read(path: &Path, columns: Option<&[String]>) -> Result<Vec<Self>, InvalidMeasured> {
        let file = path.display().to_string();
        let wrong = |problem| InvalidMeasured { file: file.clone(), line: None, problem };
        let bytes = read_input_bytes(path, MAX_BYTES).map_err(|error| {
            wrong(format!("cannot be read ({}), expected a CSV file", reason(&error)))
        })?;
        let text = decoded(&bytes).ok_or_else(|| {
            wrong("is no text in UTF-8, UTF-16 or Windows-1252, expected a CSV file".to_owned())
        })?;
        Self::parse(&text, &file, columns)
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
            let problem = "a quote (\") is not closed, expected it in pairs".to_owned();
            return Err(wrong(rows.open_quote, problem));
        }
        let mut tables = rows.tables(|row| Header::known(&rows, row).is_some());
        // Under given names, a further specimen repeats the row above the first table.
        let repeated = tables.first().and_then(|table| table.above.clone().last());
        if let Some(repeated) = repeated.filter(|row| columns.is_some() && rows.is_text(*row)) {
            tables = rows.tables(|row| rows.all[row].cells == rows.all[repeated].cells);
        }
        let Some(first) = tables.first() else {
            let header = Header::find(&rows, 0..rows.all.len(), columns);
            header.curves().map_err(|problem| wrong(None, problem))?;
            return Err(wrong(None, "holds no points, expected a line for each".to_owned()));
        };
        let mut header = Header::find(&rows, first.above.clone(), columns);
        let (mut curves, mut specimens) = (Vec::new(), Vec::new());
        for table in &tables {
            // A table without a header of its own has the columns of the table above.
            let known = Header::known_in(&rows, table.above.clone());
            header = known.filter(|_| columns.is_none()).unwrap_or(header);
            let specimens_here = header.curves().map_err(|problem| wrong(None, problem))?;
            let width = table.rows.first().map_or(0, |row| rows.all[*row].cells.len());
            for (index, columns) in specimens_here.into_iter().enumerate() {
                // A header may name more specimens than the table has columns.
                if index > 0 && columns.indices.iter().all(|column| *column >= width) {
                    continue;
                }
                let left_out = if index == 0 { &*table.left_out } else { &[] };
                let curve = Self::in_table(&rows, (table, left_out), &header, columns);
                curves.push(curve.map_err(|(line, problem)| wrong(Some(line), problem))?);
                specimens.push(header.specimen(&rows, columns));
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
            Some(specimen) => format!("{file}, specimen {specimen}"),
            None => file.to_owned(),
        };
    }

    /// Reads one curve from a table.
    fn in_table(
        rows: &Rows,
        (table, left_out): (&NumberTable, &[u64]),
        header: &Header,
        columns: CurveColumns,
    ) -> Result<Self, (u64, String)> {
        let CurveColumns { indices, test, units } = columns;
        let names = &header.names;
        let (mut points, mut lines) = (Vec::new(), Vec::new());
        let mut left_out = left_out.to_vec();
        for row in table.rows.iter().map(|row| &rows.all[*row]) {
            // A number with a decimal comma between commas would become two cells.
            let mut beyond = row.cells.iter().skip(names.len());
            if !header.is_given && beyond.any(|cell| !cell.is_empty()) {
                let (found, columns) = (row.cells.len(), names.len());
                let problem = format!(
                    "has {found} cells under {columns} columns, expected as many (with a decimal comma, ; between cells)"
                );
                return Err((row.line, problem));
            }
            let cells = indices.map(|index| row.cells.get(index).unwrap_or_default());
            if cells == ["", ""] {
                left_out.push(row.line);
                continue;
            }
            let mut point = [0.0; 2];
            for axis in 0..2 {
                let number = rows.number(cells[axis]).ok_or_else(|| {
                    let (name, cell) = (&names[indices[axis]], cells[axis]);
                    let expected = "is not accepted, expected a number";
                    (row.line, format!("{name}: {cell:?} {expected}"))
                })?;
                point[axis] = number * units.map_or(1.0, |units| units[axis]);
            }
            points.push(point);
            lines.push(row.line);
        }
        left_out.sort_unstable();
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
            left_out,
            points,
            lines,
            reversed,
        })
    }

    /// Returns the range in which the offset of an axis is searched.
    ///
    /// A displacement offset is also searched up to the end of a long approach without force.
    pub(crate) fn offset_range(&self, axis: usize) -> [f64; 2] {
        let largest = |axis: usize| {
            // A curve of zeros also needs bounds that differ.
            let sizes = self.points.iter().map(|point| point[axis].abs());
            sizes.fold(f64::MIN_POSITIVE, f64::max)
        };
        let to = FARTHEST_OFFSET * largest(axis);
        let force = TOUCHING * largest(1);
        let touching = self.points.iter().find(|point| point[1].abs() > force);
        match touching {
            // The force may begin anywhere before, or rise slowly from the beginning.
            Some([x, _]) if axis == 0 && *x > to => [-to, x + 0.1 * to],
            Some([x, _]) if axis == 0 && *x < -to => [x - 0.1 * to, to],
            _ => [-to, to],
        }
    }

    /// Returns the points of the first loading branch, without holds.
    pub fn loading(&self) -> Vec<[f64; 2]> {
        self.branches().loading.into_iter().map(|index| self.points[index]).collect()
    }

    /// Divides the curve into its branches.
    pub(crate) fn branches(&self) -> Branches {
        loading::branches(&self.points, &self.lines)
    }
}

/// Decodes UTF-8, UTF-16 with a byte-order mark, or otherwise Windows-1252.
///
/// `None` for bytes that are no text.
fn decoded(bytes: &[u8]) -> Option<String> {
    if let Some((encoding, mark)) = encoding_rs::Encoding::for_bom(bytes) {
        let text = encoding.decode_without_bom_handling_and_without_replacement(&bytes[mark..])?;
        return Some(text.into_owned());
    }
    // Texts hold no zero bytes, pictures and workbooks do.
    if bytes.contains(&0) {
        return None;
    }
    // Text in Windows-1252 with a letter beyond ASCII is almost never valid UTF-8.
    let text = std::str::from_utf8(bytes).map(str::to_owned);
    Some(text.unwrap_or_else(|_| encoding_rs::WINDOWS_1252.decode(bytes).0.into_owned()))
}

/// Column names above a table.
struct Header {
    names: Vec<String>,
    /// True if the names come from the definition. It may name only the first columns.
    is_given: bool,
    /// Row of the names in the file.
    row: Option<usize>,
}

impl Header {
    /// Finds the header of the table below `above`: the given names, or the nearest row of names.
    ///
    /// Units in the row below are appended to the names.
    fn find(rows: &Rows, above: Range<usize>, given: Option<&[String]>) -> Self {
        if let Some(names) = given {
            let row = above.last().filter(|row| rows.is_text(*row));
            return Self { names: names.to_vec(), is_given: true, row };
        }
        let start = above.start.max(above.end.saturating_sub(LONGEST_PREAMBLE));
        if let Some(header) = Self::known_in(rows, start..above.end) {
            return header;
        }
        // The error message shows the row above the numbers.
        let last = above.end.checked_sub(1).filter(|row| above.contains(row));
        let Some(last) = last else {
            return Self { names: Vec::new(), is_given: false, row: None };
        };
        let has_units = last > above.start && rows.is_text(last) && rows.is_text(last - 1);
        let same_width = has_units && rows.all[last - 1].cells.len() == rows.all[last].cells.len();
        if same_width { Self::at(rows, last - 1, true) } else { Self::at(rows, last, false) }
    }

    /// Returns the last header with two columns of a test.
    fn known_in(rows: &Rows, range: Range<usize>) -> Option<Self> {
        range.rev().find_map(|row| Self::known(rows, row))
    }

    /// Returns the header in a row if it names two columns of a test.
    fn known(rows: &Rows, row: usize) -> Option<Self> {
        if !rows.is_text(row) {
            return None;
        }
        let below = row + 1;
        let has_units = below < rows.all.len() && rows.is_text(below);
        let with_units = has_units.then(|| Self::at(rows, row, true));
        if let Some(header) = with_units.filter(|header| header.curves().is_ok()) {
            return Some(header);
        }
        // A row of text below `force_N` is a remark. Below `force` it holds units, which must not
        // be ignored.
        let header = Self::at(rows, row, false);
        let curves = header.curves().ok()?;
        (!has_units || curves[0].units.is_some()).then_some(header)
    }

    /// Returns the header in a row, with units from the row below.
    fn at(rows: &Rows, row: usize, has_units: bool) -> Self {
        let units = rows.all.get(row + 1).filter(|_| has_units);
        let mut names = Vec::new();
        for (column, name) in rows.all[row].cells.iter().enumerate() {
            let unit = units.and_then(|row| row.cells.get(column)).unwrap_or_default();
            names.push(spelled(&format!("{name} {unit}")));
        }
        Self { names, is_given: false, row: Some(row) }
    }

    fn curves(&self) -> Result<Vec<CurveColumns>, String> {
        curves(&self.names)
    }

    /// Returns the name of a specimen from the row above the header; empty if there is none.
    fn specimen(&self, rows: &Rows, columns: CurveColumns) -> String {
        let above = self.row.and_then(|row| row.checked_sub(1)).map(|row| &rows.all[row].cells);
        let named = |cells: &csv::StringRecord| {
            let cells = columns.indices.map(|index| cells.get(index).unwrap_or_default());
            cells.into_iter().find(|cell| !cell.is_empty()).unwrap_or_default().to_owned()
        };
        above.map(named).unwrap_or_default()
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
            (curve.is_physical, curve.left_out.clone(), &*curve.points),
            (true, vec![6], &[[0.0, 0.0], [0.5, 2.0]][..])
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
            assert_eq!(curve[0].points, [[0.5, 2.0]]);
        }
    }

    #[test]
    fn units_in_their_own_row_are_converted_or_refused() {
        let curve = parsed("Displacement,Force\n(in),(lbf)\n1,1\n");
        assert_eq!((curve.is_physical, curve.points[0]), (true, [25.4, 4.448_221_615_260_5]));
        assert_eq!(parsed("Displacement,Force\n(mm),(cN)\n1,50\n").points, [[1.0, 0.5]]);
        let message = refused("Displacement,Force\n(ft),(oz)\n1,2\n3,4\n");
        assert!(
            message.starts_with("a.csv: its columns are displacement_ft force_oz,"),
            "{message}"
        );
        // A row without units is no row of units.
        assert!(!parsed("displacement,force\n,\n1,2\n").is_physical);
    }

    #[test]
    fn preambles_with_numbers_are_skipped() {
        let text =
            "Rate,2.0,mm/min\nDiameter,2.0,mm\nTime,Extension,Load\n(sec),(mm),(N)\n0,1,2\n1,3,4\n";
        let curve = parsed(text);
        assert_eq!((curve.left_out.len(), &*curve.points), (0, &[[1.0, 2.0], [3.0, 4.0]][..]));
        let unknown = text.replace("Extension", "Gauge");
        let message = refused(&unknown);
        assert!(message.contains("its columns are time_sec gauge_mm load_N,"), "{message}");
        let names = ["time", "displacement_mm", "force_N"].map(str::to_owned);
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
        assert_eq!((&*curves[1].points, &*curves[1].left_out), (&[[3.0, 4.0]][..], &[4][..]));
        // A single row of numbers is no specimen.
        assert_eq!(parsed(below).left_out, [5, 6, 7]);
        let below = format!("{below}7;8\n");
        let curves = MeasuredCurve::parse(&below, "a.csv", None).expect("curves");
        assert_eq!(curves[1].file, "a.csv, specimen End");
        assert_eq!(curves[1].points, [[3.0, 4.0], [7.0, 8.0]]);
        let names = ["displacement_mm", "force_N"].map(str::to_owned);
        let curves = MeasuredCurve::parse(&below, "a.csv", Some(&names)).expect("curves");
        assert_eq!(curves.len(), 2);
    }

    #[test]
    fn footers_and_lone_numbers_are_left_out() {
        let curve = parsed("x,y\n25,100\n\nDisplacement (mm),Force (N)\n1,2\n3,4\n\nEnd of test\n");
        assert_eq!((&*curve.left_out, curve.points.len()), (&[2, 8][..], 2));
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
        assert_eq!(decoded(b"\x89PNG\0"), None);
        assert_eq!(decoded(b"\xff\xfe\0\xd8"), None);
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

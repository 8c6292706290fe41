//! Tables of numbers in text files of testing machines.
//!
//! Machines write preambles, rows of units, empty lines and footers around their readings. The
//! table is the longest run of rows of numbers with the same number of cells.

use std::ops::Range;

/// Separators of cells, in the order of preference. Adjacent blanks count as one separator.
const SEPARATORS: [char; 4] = [';', '\t', ',', ' '];

/// Number of bytes at the beginning of a text from which its separator is detected.
const SAMPLE: usize = 1 << 20;

/// A line of a file, split into cells.
#[derive(Debug)]
pub(super) struct Row {
    /// Number of the line, as an editor shows it.
    pub(super) line: u64,
    /// True if the line above is empty.
    is_after_blank: bool,
    pub(super) cells: csv::StringRecord,
}

impl Row {
    /// Returns the cell in a column; empty if the row has fewer columns.
    pub(super) fn cell(&self, column: usize) -> &str {
        self.cells.get(column).unwrap_or_default()
    }

    fn is_empty(&self) -> bool {
        self.cells.iter().all(str::is_empty)
    }
}

/// Rows of a file, with their decimal sign.
#[derive(Debug)]
pub(super) struct Rows {
    pub(super) all: Vec<Row>,
    decimal: char,
    /// Line of a quote that is not closed.
    pub(super) open_quote: Option<u64>,
}

impl Rows {
    /// Splits a text into rows, with the separator that gives the longest table.
    pub(super) fn new(text: &str) -> Result<Self, csv::Error> {
        let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n");
        let end = (SAMPLE..text.len()).find(|end| text.is_char_boundary(*end));
        let sample = &text[..end.unwrap_or(text.len())];
        let mut best = ((0, 0), ',');
        for separator in SEPARATORS {
            let rows = Self::split(sample, separator)?;
            let longest = longest(&rows.runs(2));
            // A wrong separator leaves cells such as `20;2`, so count rows of numbers only.
            let pure = longest.clone().filter(|row| rows.has_numbers_only(*row)).count();
            if (pure, longest.len()) > best.0 {
                best = ((pure, longest.len()), separator);
            }
        }
        Self::split(&text, best.1)
    }

    fn split(text: &str, separator: char) -> Result<Self, csv::Error> {
        let all = match separator {
            ' ' => split_at_blanks(text),
            separator => split_at(text, separator)?,
        };
        // If commas separate cells, only a cell in quotes can contain a decimal comma.
        let is_comma =
            separator != ',' || all.iter().flat_map(|row| row.cells.iter()).any(has_decimal_comma);
        // An open quote makes the rest of the file a single cell, with line breaks in it.
        let last = all.last().filter(|row| row.cells.iter().any(|cell| cell.contains('\n')));
        let is_open = text.matches('"').count() % 2 == 1;
        let open_quote = last.filter(|_| is_open).map(|row| row.line);
        Ok(Self { all, decimal: if is_comma { ',' } else { '.' }, open_quote })
    }

    /// Returns the finite number in a cell; `None` for other cells.
    pub(super) fn number(&self, cell: &str) -> Option<f64> {
        // Word processors write a minus sign or a dash instead of a hyphen.
        if let Some(digits) = cell.strip_prefix(['\u{2212}', '\u{2013}']) {
            return self.number(digits).map(|number| -number);
        }
        let number = match [',', '.'].map(|sign| cell.find(sign)) {
            // The rightmost of comma and point is the decimal sign; the other separates thousands.
            [Some(comma), Some(point)] => {
                let (group, decimal) = if comma < point { (',', '.') } else { ('.', ',') };
                ungrouped(cell, group, decimal)?.parse()
            }
            [Some(_), None] if self.decimal == ',' => cell.replace(',', ".").parse(),
            _ => cell.parse(),
        };
        number.ok().filter(|number: &f64| number.is_finite())
    }

    /// Returns true if all cells of a row are numbers or empty.
    fn has_numbers_only(&self, row: usize) -> bool {
        let mut cells = self.all[row].cells.iter();
        cells.all(|cell| cell.is_empty() || self.number(cell).is_some())
    }

    /// Returns true if the cells of a row in both columns are numbers.
    pub(super) fn are_numbers(&self, row: usize, columns: [usize; 2]) -> bool {
        columns.iter().all(|column| self.number(self.all[row].cell(*column)).is_some())
    }

    /// Returns true if a row has no text in columns in which the row `like` has a number.
    pub(super) fn is_like(&self, row: usize, like: usize) -> bool {
        let mut cells = self.all[row].cells.iter().zip(&self.all[like].cells);
        cells.all(|(cell, other)| {
            cell.is_empty() || self.number(cell).is_some() || self.number(other).is_none()
        })
    }

    fn count_numbers(&self, row: usize) -> usize {
        self.all[row].cells.iter().filter(|cell| self.number(cell).is_some()).count()
    }

    /// Returns true if no cell of a row is a number.
    pub(super) fn is_text(&self, row: usize) -> bool {
        self.count_numbers(row) == 0
    }

    /// Returns true if `row` follows the row above without an empty line, with as many cells.
    fn continues(&self, row: usize) -> bool {
        let (before, row) = (&self.all[row - 1], &self.all[row]);
        !row.is_after_blank && row.cells.len() == before.cells.len()
    }

    /// Lists the runs of rows with equal numbers of cells and at least `least` numbers in each row.
    ///
    /// Rows of empty cells are gaps in a recording and do not end a run.
    fn runs(&self, least: usize) -> Vec<Range<usize>> {
        let mut runs: Vec<Range<usize>> = Vec::new();
        for row in 0..self.all.len() {
            let run = runs.last_mut().filter(|run| run.end == row && self.continues(row));
            match run {
                Some(run) if self.count_numbers(row) >= least || self.all[row].is_empty() => {
                    run.end = row + 1;
                }
                _ if self.count_numbers(row) >= least => runs.push(row..row + 1),
                _ => {}
            }
        }
        runs
    }

    /// Lists the tables of the file, each with its rows of numbers.
    ///
    /// The longest run of rows is a table. Runs with the same number of cells continue a table if
    /// only empty lines and remarks lie between. Further tables begin at a row for which
    /// `is_header` returns true. Other runs, such as sizes or results, and single rows of numbers
    /// are left out.
    pub(super) fn tables(&self, is_header: impl Fn(usize) -> bool) -> Vec<NumberTable> {
        let mut runs = self.runs(2);
        let mut longest = longest(&runs);
        if longest.is_empty() {
            // No row has two numbers. Use rows with one number, so that the caller can report the
            // mistake in the other cell with its line.
            runs = self.runs(1);
            longest = runs.first().cloned().unwrap_or(0..0);
        }
        let width = self.all.get(longest.start).map_or(0, |row| row.cells.len());
        runs.retain(|run| {
            run.len() >= longest.len().min(2)
                && self.all[run.start].cells.len() == width
                && self.is_like(run.start, longest.start)
        });
        let mut tables: Vec<NumberTable> = Vec::new();
        let mut end = 0;
        for run in runs {
            // Skip a run that the previous run already contains after its rows with mistakes.
            if run.start < end {
                continue;
            }
            let between = end..run.start;
            // A row with a single number continues the run: another of its cells has a mistake.
            let mistaken = (run.end..self.all.len())
                .take_while(|row| self.continues(*row) && !self.is_text(*row));
            let is_longest = run.contains(&longest.start);
            let run = run.start..run.end + mistaken.count();
            end = run.end;
            let has_header = between.clone().any(&is_header);
            let is_apart = between.clone().any(|row| self.begins_another_table(row, width));
            match tables.last_mut() {
                Some(table) if !has_header && !is_apart => {
                    table.skipped_lines.extend(between.map(|row| self.all[row].line));
                    table.rows.extend(run);
                    table.is_longest |= is_longest;
                }
                _ => tables.push(NumberTable {
                    above: between,
                    rows: run.collect(),
                    has_header,
                    is_longest,
                    skipped_lines: Vec::new(),
                }),
            }
        }
        let mut tables = readings(tables);
        if let Some(table) = tables.last_mut() {
            let last = table.rows.last().map_or(0, |row| row + 1);
            table.skipped_lines.extend(self.all[last..].iter().map(|row| row.line));
        }
        tables
    }

    /// Returns true if a row of text between two runs separates their tables.
    ///
    /// Such a row is a title, which follows an empty line, or a header, which has several names in
    /// `width` cells. Other rows of text are remarks within a table.
    fn begins_another_table(&self, row: usize, width: usize) -> bool {
        let Row { cells, is_after_blank, .. } = &self.all[row];
        let names = cells.iter().filter(|cell| !cell.is_empty()).count();
        self.is_text(row) && (*is_after_blank || (cells.len() == width && names > 1))
    }
}

/// Keeps the longest table and the tables with a header.
///
/// Rows of a removed table are added to the rows above the next kept table.
fn readings(tables: Vec<NumberTable>) -> Vec<NumberTable> {
    let mut readings: Vec<NumberTable> = Vec::new();
    for mut table in tables {
        if table.has_header || table.is_longest {
            let last = readings.last().and_then(|table| table.rows.last());
            table.above.start = last.map_or(0, |row| row + 1);
            readings.push(table);
        }
    }
    readings
}

/// Returns the first of the longest runs, or an empty run if `runs` is empty.
fn longest(runs: &[Range<usize>]) -> Range<usize> {
    runs.iter().rev().max_by_key(|run| run.len()).cloned().unwrap_or(0..0)
}

/// A table of numbers in a file.
#[derive(Debug)]
pub(super) struct NumberTable {
    /// Rows between this table and the table above, or the beginning of the file.
    pub(super) above: Range<usize>,
    /// Rows of numbers.
    pub(super) rows: Vec<usize>,
    /// True if a header lies above the rows of numbers.
    has_header: bool,
    /// True if the table contains the longest run of numbers.
    pub(super) is_longest: bool,
    /// Lines between and below the rows that do not belong to the table.
    pub(super) skipped_lines: Vec<u64>,
}

fn split_at(text: &str, separator: char) -> Result<Vec<Row>, csv::Error> {
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator as u8)
        .comment(Some(b'#'))
        .has_headers(false)
        // Lines of a preamble have any number of cells.
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut position = LineCounter { text, byte: 0, line: 1 };
    let mut rows = Vec::new();
    for cells in reader.records() {
        let cells = cells?;
        let byte = cells.position().map_or(0, csv::Position::byte) as usize;
        let (line, is_after_blank) = position.advance(byte);
        rows.push(Row { line, is_after_blank, cells });
    }
    Ok(rows)
}

fn split_at_blanks(text: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut is_after_blank = false;
    for (index, line) in text.lines().enumerate() {
        if line.trim().is_empty() {
            is_after_blank = true;
        } else if !line.starts_with('#') {
            let cells = line.split_whitespace().collect();
            rows.push(Row { line: index as u64 + 1, is_after_blank, cells });
            is_after_blank = false;
        }
    }
    rows
}

/// Counts the lines of a text up to a byte.
struct LineCounter<'a> {
    text: &'a str,
    byte: usize,
    line: u64,
}

impl LineCounter<'_> {
    /// Returns the line number of the record for which the CSV reader reports the start `byte`.
    ///
    /// This byte may precede empty lines and comments, which the reader skips before the record.
    /// Also returns true if the reader skipped an empty line.
    fn advance(&mut self, byte: usize) -> (u64, bool) {
        while self.byte < byte {
            self.skip_line();
        }
        let mut has_blank = false;
        while let Some(first) = self.text.as_bytes().get(self.byte) {
            let is_blank = *first == b'\n';
            if !is_blank && *first != b'#' {
                break;
            }
            has_blank |= is_blank;
            self.skip_line();
        }
        (self.line, has_blank)
    }

    fn skip_line(&mut self) {
        let length = self.text[self.byte..].find('\n').map(|end| end + 1);
        self.byte = length.map_or(self.text.len(), |length| self.byte + length);
        self.line += 1;
    }
}

/// Removes the signs `group` between thousands, and replaces the sign `decimal` with a point.
///
/// Example: `1.047,60` becomes `1047.60`. `None` if a group after the first does not have three
/// digits.
fn ungrouped(cell: &str, group: char, decimal: char) -> Option<String> {
    let (whole, fraction) = cell.split_once(decimal)?;
    let mut groups = whole.trim_start_matches(['-', '+']).split(group);
    let first = groups.next().map_or(0, str::len);
    let is_grouped = (1..=3).contains(&first) && groups.all(|group| group.len() == 3);
    is_grouped.then(|| format!("{}.{fraction}", whole.replace(group, "")))
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the line numbers of the rows and of the left-out lines of each table.
    fn lines(text: &str) -> Vec<(Vec<u64>, Vec<u64>)> {
        let rows = Rows::new(text).expect("rows");
        let tables = rows.tables(|row| rows.all[row].cells.iter().any(|cell| cell == "x"));
        tables
            .into_iter()
            .map(|table| {
                (table.rows.iter().map(|row| rows.all[*row].line).collect(), table.skipped_lines)
            })
            .collect()
    }

    #[test]
    fn the_longest_run_of_numbers_is_the_table() {
        let text = "size,2,3\n\nx,y\n25,100\n\n1,2\n3,4\n\nEnd of test\n";
        assert_eq!(lines(text), [(vec![6, 7], vec![9])]);
    }

    #[test]
    fn tables_of_sizes_and_results_are_left_out() {
        let text = "Calibration\n0,0\n1,10\n\nx,y\n1,2\n3,4\n5,6\n\nName,Peak\n1,5\n2,6\n";
        assert_eq!(lines(text), [(vec![6, 7, 8], vec![10, 11, 12])]);
        let text = "x,y\n1,2\n3,4\n5,6\n\nResults\n1,5\n2,6\n";
        assert_eq!(lines(text), [(vec![2, 3, 4], vec![6, 7, 8])]);
        // Rows that begin with text are not readings: the first column of this table is numeric.
        let text = "x,y,z\n1,2,3\n3,4,5\n5,6,7\n\nMean,5,6\nSD,6,7\n";
        assert_eq!(lines(text), [(vec![2, 3, 4], vec![6, 7])]);
    }

    #[test]
    fn the_last_sign_of_a_grouped_number_is_the_decimal_sign() {
        let rows = Rows::new("x;y\n1,5;2\n").expect("rows");
        for (cell, number) in [
            ("1.047,60", Some(1047.6)),
            ("-1,013.1", Some(-1013.1)),
            ("1.234.567,5", Some(1_234_567.5)),
            ("12.34,5", None),
            ("1,5.5", None),
            ("\u{2212}0,5", Some(-0.5)),
            ("\u{2013}0,5", Some(-0.5)),
            ("1,5,5", None),
        ] {
            assert_eq!(rows.number(cell), number, "{cell}");
        }
    }

    #[test]
    fn remarks_do_not_end_a_table_and_headers_begin_another() {
        assert_eq!(lines("x,y\n1,2\n3,4\nhold\n5,6\n7,8\n"), [(vec![2, 3, 5, 6], vec![4])]);
        let text = "x;y\n1;2\n3;4\n\nx;y\n5;6\n7;8\n";
        assert_eq!(lines(text), [(vec![2, 3], vec![]), (vec![6, 7], vec![])]);
    }

    #[test]
    fn every_separator_and_line_ending_is_read() {
        for separator in [";", "\t", ",", "   "] {
            for end in ["\n", "\r\n", "\r"] {
                let text = ["x", "y", "# a remark", "1", "2", "3", "4"];
                let [x, y, remark, a, b, c, d] = text;
                let text = format!(
                    "{x}{separator}{y}{end}{remark}{end}{a}{separator}{b}{end}{end}{c}{separator}{d}{end}"
                );
                let rows = Rows::new(&text).expect("rows");
                let lines: Vec<_> = rows.all.iter().map(|row| row.line).collect();
                assert_eq!(lines, [1, 3, 5], "{text:?}");
                assert!(rows.all[2].is_after_blank && !rows.all[1].is_after_blank);
            }
        }
    }
}

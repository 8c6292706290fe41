//! Cells of a table, stored by column. Numbers take a third of the memory of texts.

use std::borrow::Cow;

use text::number;

/// The cells of a table below its header.
///
/// Cells read back exactly as written, whether a column is stored as numbers or as texts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    header: Vec<String>,
    columns: Vec<Column>,
    length: usize,
}

/// The cells of one column, from the top.
#[derive(Clone, Debug, PartialEq)]
enum Column {
    /// A column that was not read.
    Unread,
    /// Numbers, if [`number::text`] reproduces every cell. NaN represents an empty cell.
    Numbers(Vec<f64>),
    /// Texts, if the column has any other cell.
    Texts(Texts),
}

/// Texts stored in one string.
#[derive(Clone, Debug, Default, PartialEq)]
struct Texts {
    all: String,
    /// End of each text.
    ends: Vec<usize>,
}

impl Texts {
    fn push(&mut self, text: &str) {
        self.all.push_str(text);
        self.ends.push(self.all.len());
    }

    fn get(&self, row: usize) -> &str {
        let begin = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.all[begin..self.ends[row]]
    }
}

impl<T: AsRef<str>> FromIterator<T> for Texts {
    fn from_iter<I: IntoIterator<Item = T>>(all: I) -> Self {
        let mut texts = Self::default();
        for text in all {
            texts.push(text.as_ref());
        }
        texts
    }
}

impl Column {
    fn push(&mut self, cell: &str) {
        match self {
            Self::Unread => {}
            Self::Texts(texts) => texts.push(cell),
            Self::Numbers(numbers) => {
                if let Some(number) = number_of(cell) {
                    numbers.push(number);
                } else {
                    // The cell is a word, or a number in another notation. Store the whole column
                    // as texts, so that the cell reads back as written.
                    *self = Self::Texts(numbers.iter().map(|number| text_of(*number)).collect());
                    self.push(cell);
                }
            }
        }
    }

    fn text(&self, row: usize) -> Cow<'_, str> {
        match self {
            Self::Unread => Cow::default(),
            Self::Numbers(numbers) => text_of(numbers[row]).into(),
            Self::Texts(texts) => texts.get(row).into(),
        }
    }

    fn only(&self, rows: &[usize]) -> Self {
        match self {
            Self::Unread => Self::Unread,
            Self::Numbers(numbers) => Self::Numbers(rows.iter().map(|row| numbers[*row]).collect()),
            Self::Texts(texts) => Self::Texts(rows.iter().map(|row| texts.get(*row)).collect()),
        }
    }
}

/// Returns the number in a cell, if the number reproduces the text of the cell.
fn number_of(cell: &str) -> Option<f64> {
    if cell.is_empty() {
        return Some(f64::NAN);
    }
    let number = cell.parse().ok().filter(|number: &f64| number.is_finite())?;
    (number::text(number) == cell).then_some(number)
}

fn text_of(number: f64) -> String {
    if number.is_nan() { String::new() } else { number::text(number) }
}

impl Table {
    /// Creates an empty table that stores the columns for which `is_read` returns true.
    ///
    /// The first column holds the names of the rows and is always stored.
    pub fn new(header: Vec<String>, is_read: impl Fn(&str) -> bool) -> Self {
        let columns = header
            .iter()
            .enumerate()
            .map(|(index, name)| match index {
                // Store names as texts, because `7` and `007` are names of different rows.
                0 => Column::Texts(Texts::default()),
                _ if is_read(name) => Column::Numbers(Vec::new()),
                _ => Column::Unread,
            })
            .collect();
        Self { header, columns, length: 0 }
    }

    /// Appends a row, with one cell per column.
    pub fn push<'c>(&mut self, cells: impl IntoIterator<Item = &'c str>) {
        for (column, cell) in self.columns.iter_mut().zip(cells) {
            column.push(cell);
        }
        self.length += 1;
    }

    /// Returns a table with only the rows at these positions.
    #[must_use]
    pub fn only(&self, rows: &[usize]) -> Self {
        let columns = self.columns.iter().map(|column| column.only(rows)).collect();
        Self { header: self.header.clone(), columns, length: rows.len() }
    }

    /// Returns the names of the columns.
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// Returns the index of the column `name`.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }

    /// Returns the number of rows.
    pub fn length(&self) -> usize {
        self.length
    }

    /// Returns the name of a row: its first cell.
    pub fn name(&self, row: usize) -> &str {
        match self.columns.first() {
            Some(Column::Texts(texts)) => texts.get(row),
            _ => "",
        }
    }

    /// Returns the text of a cell.
    pub fn text(&self, row: usize, column: usize) -> Cow<'_, str> {
        self.columns[column].text(row)
    }

    /// Returns true if a cell is empty.
    pub fn is_empty(&self, row: usize, column: usize) -> bool {
        // Test for a number first: formatting a number as text is slow, and a cell with a number is
        // not empty.
        self.number(row, column).is_none() && self.text(row, column).is_empty()
    }

    /// Returns the finite number in a cell, if there is one.
    pub fn number(&self, row: usize, column: usize) -> Option<f64> {
        let number = match &self.columns[column] {
            Column::Unread => return None,
            Column::Numbers(numbers) => numbers[row],
            // Rust parses `inf` and `NaN` as numbers, but no table of squama contains them.
            Column::Texts(texts) => texts.get(row).parse().ok()?,
        };
        number.is_finite().then_some(number)
    }

    /// Returns the numbers of a column, with NaN for empty cells.
    ///
    /// `None` if the column has texts or was not read.
    pub fn numbers(&self, column: usize) -> Option<&[f64]> {
        match &self.columns[column] {
            Column::Numbers(numbers) => Some(numbers),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_read_back_exactly() {
        let rows =
            [["1", "", "1e-7", "0.5"], ["02", "", "0.30000000000000004", "-0"], ["3", "", "", "x"]];
        let mut table = Table::new(["n", "a", "b", "c"].map(str::to_owned).to_vec(), |_| true);
        for row in &rows {
            table.push(*row);
        }
        for (k, row) in rows.iter().enumerate() {
            assert_eq!([0, 1, 2, 3].map(|column| table.text(k, column)), *row);
            assert_eq!((table.name(k), table.is_empty(k, 1)), (row[0], true));
        }
        assert!(table.numbers(2).is_some() && table.numbers(3).is_none());
        assert_eq!([0, 1, 2].map(|row| table.number(row, 3)), [Some(0.5), Some(-0.0), None]);
        let some = table.only(&[2, 0]);
        assert_eq!((some.length(), some.text(1, 2).as_ref(), some.name(0)), (2, "1e-7", "3"));
    }

    #[test]
    fn an_unread_column_has_no_values() {
        let mut table = Table::new(["n", "a"].map(str::to_owned).to_vec(), |name| name != "a");
        table.push(["1", "2"]);
        assert_eq!((table.length(), table.number(0, 1)), (1, None));
    }
}

//! The rows of a long table, packed: a million rows of a record each take three times the room.

/// Rows with the same number of cells, in one text.
#[derive(Clone, Debug, Default)]
pub(super) struct PackedRows {
    text: String,
    /// The end of each cell in the text, row after row.
    ends: Vec<usize>,
    /// The number of cells of a row.
    columns: usize,
}

impl PackedRows {
    pub fn push<'c>(&mut self, cells: impl Iterator<Item = &'c str>) {
        let before = self.ends.len();
        for cell in cells {
            self.text.push_str(cell);
            self.ends.push(self.text.len());
        }
        self.columns = self.ends.len() - before;
    }

    /// The number of rows.
    pub fn len(&self) -> usize {
        self.ends.len() / self.columns.max(1)
    }

    /// A cell; empty if there is none.
    pub fn cell(&self, row: usize, column: usize) -> &str {
        let place = row * self.columns + column;
        // Beyond the last column would stand the first cell of the next row.
        let Some(end) = self.ends.get(place).filter(|_| column < self.columns) else { return "" };
        let begin = if place > 0 { self.ends[place - 1] } else { 0 };
        &self.text[begin..*end]
    }

    /// The rows at these places, those that are there.
    pub fn only(&self, rows: impl Iterator<Item = usize>) -> Self {
        let mut kept = Self::default();
        for row in rows.filter(|row| *row < self.len()) {
            kept.push((0..self.columns).map(|column| self.cell(row, column)));
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_found_again() {
        let mut rows = PackedRows::default();
        for row in [["1", "", "x"], ["2", "ab", ""], ["3", "", "y"]] {
            rows.push(row.into_iter());
        }
        let cells = |rows: &PackedRows, row| [0, 1, 2, 3].map(|c| rows.cell(row, c).to_owned());
        assert_eq!((rows.len(), cells(&rows, 1)), (3, ["2", "ab", "", ""].map(str::to_owned)));
        assert_eq!(rows.cell(3, 0), "");
        let some = rows.only([2, 7, 0].into_iter());
        assert_eq!((some.len(), cells(&some, 0)), (2, ["3", "", "y", ""].map(str::to_owned)));
    }
}

//! The cells of a row as one line of text, as journals keep them.

use std::borrow::Cow;

/// The cells of a row, joined by commas. No cell holds a comma, a quote or the end of a line: cells
/// are numbers, words of closed lists, and settings.
pub fn join(cells: impl IntoIterator<Item = String>) -> String {
    let mut row = String::new();
    for (place, cell) in cells.into_iter().enumerate() {
        if place > 0 {
            row.push(',');
        }
        row.push_str(&harmless(&cell));
    }
    row
}

/// The cells of a row.
pub fn cells(row: &str) -> impl Iterator<Item = &str> {
    row.split(',')
}

/// The cell of a row at `place`.
pub fn cell(row: &str, place: usize) -> Option<&str> {
    cells(row).nth(place)
}

fn harmless(cell: &str) -> Cow<'_, str> {
    let is_harmful = |c: char| c == ',' || c == '"' || c.is_control();
    if cell.contains(is_harmful) { cell.replace(is_harmful, ";").into() } else { cell.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_stay_apart() {
        let row = join(["1", "", "a,b\n\"c\"", "2"].map(str::to_owned));
        assert_eq!(row, "1,,a;b;;c;,2");
        assert_eq!((cell(&row, 3), cell(&row, 4)), (Some("2"), None));
    }
}

//! Notes on measured curves, for `squama fit` and `squama plot curves`.

use crate::print::counted;

/// Maximum number of ranges of omitted lines that a note lists.
const SHOWN_RANGES: usize = 5;

/// Properties of a measured curve that its notes describe.
pub struct Reading<'a> {
    /// Names of the quantities on the horizontal and the vertical axis.
    pub axes: [&'a str; 2],
    /// True if the columns have physical units.
    pub is_physical: bool,
    /// Numbers of the lines of the file that were omitted.
    pub skipped_lines: &'a [u64],
    /// For each axis, true if the signs of its values were reversed.
    pub reversed: [bool; 2],
}

impl Reading<'_> {
    /// Returns notes on missing units, omitted lines and reversed signs, if there are any.
    pub fn notes(&self) -> Vec<String> {
        let Self { axes: [x, y], is_physical, skipped_lines, reversed } = *self;
        let mut notes = Vec::new();
        if !is_physical {
            notes.push(format!("{x} and {y} have no units in the file; they are read as dimensionless, as in the tables of squama design"));
        }
        if !skipped_lines.is_empty() {
            let lines = counted(skipped_lines.len() as u64, "line");
            let ranges = ranges(skipped_lines);
            let more = if ranges.len() > SHOWN_RANGES { ", …" } else { "" };
            let first = &ranges[..ranges.len().min(SHOWN_RANGES)];
            notes.push(format!(
                "{lines} outside the table of numbers left out: {}{more}",
                first.join(", ")
            ));
        }
        let axes = match reversed {
            [false, false] => return notes,
            [true, true] => format!("{x} and {y}"),
            [is_x, _] => (if is_x { x } else { y }).to_owned(),
        };
        notes.push(format!(
            "the signs of {axes} are reversed, because the test counts compression as negative"
        ));
        notes
    }
}

/// Formats line numbers; consecutive numbers are joined to ranges such as `2 to 5`.
fn ranges(lines: &[u64]) -> Vec<String> {
    let mut ranges = Vec::new();
    for range in lines.chunk_by(|line, next| *next == line + 1) {
        ranges.push(match range {
            [first, .., last] => format!("{first} to {last}"),
            line => line.iter().map(u64::to_string).collect(),
        });
    }
    ranges
}

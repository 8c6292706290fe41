//! Recognises tables that another program has saved again with the same values.

use std::iter;

use journal::sha256;
use text::number;

use super::csv_format::CsvFormat;

/// Separators that spreadsheets write.
const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];

/// Returns the bytes that squama wrote, if `bytes` contain the same values in another notation.
///
/// A spreadsheet may add blanks and empty cells, remove leading zeros, and write other quotes, line
/// ends, separators and notations of numbers. `digest` is the SHA-256 of the bytes as written.
pub fn as_written(bytes: &[u8], digest: &str) -> Option<Vec<u8>> {
    let text = std::str::from_utf8(bytes).ok()?.trim_start_matches('\u{feff}');
    let rows = rows(text)?;
    // Try several widths of the design numbers, because a spreadsheet replaces 0007 by 7.
    let longest = rows.iter().skip(1).map(|row| row[0].len()).max()?.max(4);
    let widths = iter::once(0).chain(longest..longest + 3);
    widths
        .flat_map(|width| CsvFormat::ALL.map(|format| write(&rows, format, width)))
        .find(|written| written.as_ref().is_some_and(|written| sha256(written) == digest))?
}

/// Reads the header and rows of a table, with cells in the notation of squama.
fn rows(text: &str) -> Option<Vec<Vec<String>>> {
    let header = text.lines().next()?;
    let separator =
        SEPARATORS.into_iter().max_by_key(|s| header.bytes().filter(|byte| byte == s).count())?;
    let mut csv = csv::ReaderBuilder::new();
    csv.delimiter(separator).has_headers(false).flexible(true).trim(csv::Trim::All);
    let mut rows: Vec<Vec<String>> = Vec::new();
    for record in csv.from_reader(text.as_bytes()).records() {
        let record = record.ok()?;
        let cells = record.iter().enumerate();
        let filled = cells.filter(|(_, cell)| !cell.is_empty()).last();
        let Some((filled, _)) = filled else { continue };
        let width = rows.first().map_or(filled + 1, Vec::len);
        if filled >= width {
            return None;
        }
        let cells = record.iter().chain(iter::repeat("")).take(width).enumerate();
        rows.push(cells.map(|(column, text)| cell(text, column, separator)).collect());
    }
    Some(rows)
}

/// Returns the text of a cell as squama writes it.
fn cell(text: &str, column: usize, separator: u8) -> String {
    // Keep the text of the first column: a design number, such as 0007, is a name.
    if column == 0 {
        return text.to_owned();
    }
    let decimal = if separator == b',' { text.to_owned() } else { text.replace(',', ".") };
    let number = decimal.parse().ok().filter(|number: &f64| number.is_finite());
    number.map_or_else(|| text.to_owned(), number::text)
}

/// Writes a table with numbers of designs of at least `width` digits.
fn write(rows: &[Vec<String>], format: CsvFormat, width: usize) -> Option<Vec<u8>> {
    let mut csv = format.writer(format.mark().to_vec());
    for (k, row) in rows.iter().enumerate() {
        let is_number = k > 0 && row[0].bytes().all(|byte| byte.is_ascii_digit());
        let width = if is_number { width } else { 0 };
        let first = format!("{:0>width$}", row[0]);
        let others = row[1..].iter().map(|cell| format.cell(cell));
        csv.write_record(
            iter::once(first.into())
                .chain(others)
                .map(|c: std::borrow::Cow<'_, str>| c.into_owned()),
        )
        .ok()?;
    }
    csv.into_inner().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WRITTEN: &str = "design,gap_over_t,base,status\r\n0001,0.1,2L,complete\r\n\
                           0002,0.00001,L,\"tilt, then \"\"off\"\"\"\r\n0003,1e-7,,\r\n";

    #[test]
    fn a_table_saved_again_holds_the_same_values() {
        let digest = sha256(WRITTEN);
        let quotes = WRITTEN.replace("0.1,2L", "\"0.1\",\"2L\"").replace("\r\n", "\n");
        let blanks = WRITTEN.replace("0.1,2L", " 0.10 , 2L");
        let notations = WRITTEN.replace("0.00001", "1.00E-05").replace("0002", "2");
        let numbers = WRITTEN.replace("\r\n000", "\r\n").replace("1e-7,,", "0.0000001,,,,,");
        let in_excel = "\u{feff}design;gap_over_t;base;status\r\n1;0,1;2L;complete\r\n\
                        2;1,00E-05;L;\"tilt, then \"\"off\"\"\"\r\n3;0,0000001;;\r\n;;;\r\n";
        for text in [&quotes, &blanks, &notations, &numbers, in_excel] {
            let found = as_written(text.as_bytes(), &digest);
            assert_eq!(found.as_deref(), Some(WRITTEN.as_bytes()), "{text}");
        }
    }

    #[test]
    fn a_resaved_table_with_another_value_is_refused() {
        let digest = sha256(WRITTEN);
        let changes =
            [("0.1", "0.2"), ("0.1", "0.10000000000000001e1"), ("2L", "L"), ("0003", "4")];
        for (from, to) in changes {
            assert_eq!(as_written(WRITTEN.replace(from, to).as_bytes(), &digest), None, "{to}");
        }
        assert_eq!(as_written(b"", &digest), None);
        assert_eq!(as_written(&[0xff, 0xfe], &digest), None);
    }
}

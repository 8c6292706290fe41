//! Windows onto a journal: a few parts of the file in memory, so that lines are read from a few places in turn.
//!
//! Designs are read in their order, and their lines stand in the order in which they were done: several threads take turns,
//! and reruns stand far behind.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};

/// Windows that are kept.
const COUNT: usize = 4;

/// Bytes of a window, unless a line is longer.
const LENGTH: u64 = 1 << 16;

/// Windows onto one file.
#[derive(Debug)]
pub struct Windows {
    file: File,
    /// The one that was used last stands at the end.
    windows: Vec<Window>,
}

/// A part of the file.
#[derive(Debug)]
struct Window {
    start: u64,
    bytes: Vec<u8>,
}

impl Window {
    /// The line at `offset` with its end, if all of it is here.
    fn line(&self, offset: u64) -> Option<&[u8]> {
        let start = usize::try_from(offset.checked_sub(self.start)?).ok()?;
        let rest = self.bytes.get(start..)?;
        let end = rest.iter().position(|byte| *byte == b'\n')?;
        rest.get(..=end)
    }
}

impl Windows {
    /// Windows onto `file`.
    pub fn new(file: File) -> Self {
        Self { file, windows: Vec::new() }
    }

    /// The line at `offset`, with its end if it has one.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn line(&mut self, offset: u64) -> io::Result<Vec<u8>> {
        let known = self.windows.iter().position(|window| window.line(offset).is_some());
        let window = match known {
            Some(place) => self.windows.remove(place),
            None => self.open(offset)?,
        };
        let line = window.line(offset).unwrap_or(&window.bytes).to_vec();
        self.windows.push(window);
        Ok(line)
    }

    /// A window that begins at `offset` and holds a whole line, in place of the one that was used longest ago.
    fn open(&mut self, offset: u64) -> io::Result<Window> {
        let mut bytes =
            if self.windows.len() < COUNT { Vec::new() } else { self.windows.remove(0).bytes };
        bytes.clear();
        self.file.seek(SeekFrom::Start(offset))?;
        loop {
            let read = (&mut self.file).take(LENGTH).read_to_end(&mut bytes)?;
            if read == 0 || bytes.contains(&b'\n') {
                return Ok(Window { start: offset, bytes });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    #[test]
    fn lines_are_read_in_any_order() {
        let mut file = tempfile::tempfile().expect("a file");
        let long = "x".repeat(200_000);
        let texts = (0..3000).map(|k| if k == 7 { long.clone() } else { format!("line {k}") });
        let mut lines = Vec::new();
        let mut offset = 0;
        for text in texts.map(|text| format!("{text}\n")) {
            file.write_all(text.as_bytes()).expect("writable");
            lines.push((offset, text.clone()));
            offset += text.len() as u64;
        }
        let mut windows = Windows::new(file);
        for k in 0..3000 {
            // Five places in turn.
            let (offset, text) = &lines[(k * 611) % 3000];
            assert_eq!(windows.line(*offset).expect("a line"), text.as_bytes());
        }
        assert_eq!(windows.line(offset).expect("the end"), b"");
    }
}

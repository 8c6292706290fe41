//! Cache for reading the lines of a journal in any order.
//!
//! Designs are read in the order of their numbers, but the journal contains their lines in the
//! order of completion. So several parts of the file are read alternately: lines of parallel
//! threads are mixed, and lines of rerun designs are at the end of the file.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};

/// Number of windows in the cache.
const COUNT: usize = 4;

/// Size of a window in bytes, unless a line is longer.
const LENGTH: u64 = 1 << 16;

/// Cache of a few parts (windows) of one file.
#[derive(Debug)]
pub struct Windows {
    file: File,
    /// The most recently used window is last.
    windows: Vec<Window>,
}

/// Contiguous part of the file, held in memory.
#[derive(Debug)]
struct Window {
    /// Offset of the first byte in the file.
    start: u64,
    bytes: Vec<u8>,
}

impl Window {
    /// Returns the line that starts at `offset` in the file, including its line end.
    ///
    /// `None` if this window does not contain the whole line.
    fn line(&self, offset: u64) -> Option<&[u8]> {
        let start = usize::try_from(offset.checked_sub(self.start)?).ok()?;
        let rest = self.bytes.get(start..)?;
        let end = rest.iter().position(|byte| *byte == b'\n')?;
        rest.get(..=end)
    }
}

impl Windows {
    /// Creates an empty cache for `file`.
    pub fn new(file: File) -> Self {
        Self { file, windows: Vec::new() }
    }

    /// Reads the line that starts at `offset`, including its line end if it has one.
    ///
    /// # Errors
    ///
    /// If the file cannot be read.
    pub fn line(&mut self, offset: u64) -> io::Result<Vec<u8>> {
        let cached = self.windows.iter().position(|window| window.line(offset).is_some());
        let window = match cached {
            Some(index) => self.windows.remove(index),
            None => self.open(offset)?,
        };
        let line = window.line(offset).unwrap_or(&window.bytes).to_vec();
        self.windows.push(window);
        Ok(line)
    }

    /// Reads a window that starts at `offset` and contains at least one whole line.
    ///
    /// If the cache is full, the least recently used window is removed.
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
            // Read from five parts of the file in turn, one more than the cache can hold.
            let (offset, text) = &lines[(k * 611) % 3000];
            assert_eq!(windows.line(*offset).expect("a line"), text.as_bytes());
        }
        assert_eq!(windows.line(offset).expect("the end"), b"");
    }
}

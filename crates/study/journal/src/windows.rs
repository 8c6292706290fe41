//! Cache of parts of a journal, to read lines from several positions in turn.
//!
//! Designs are read in the order of their numbers, but their lines are in the order of completion:
//! lines of several threads alternate, and reruns are far behind.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};

/// Number of windows in the cache.
const COUNT: usize = 4;

/// Size of a window in bytes, unless a line is longer.
const LENGTH: u64 = 1 << 16;

/// Cached windows of one file.
#[derive(Debug)]
pub struct Windows {
    file: File,
    /// The most recently used window is last.
    windows: Vec<Window>,
}

/// A part of the file in memory.
#[derive(Debug)]
struct Window {
    start: u64,
    bytes: Vec<u8>,
}

impl Window {
    /// Returns the line at `offset` if this window holds all of it.
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

    /// Reads the line at `offset`, including its line end if there is one.
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

    /// Reads a window that starts at `offset` and contains a whole line.
    ///
    /// A full cache loses its least recently used window.
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
            // Read from five positions in turn.
            let (offset, text) = &lines[(k * 611) % 3000];
            assert_eq!(windows.line(*offset).expect("a line"), text.as_bytes());
        }
        assert_eq!(windows.line(offset).expect("the end"), b"");
    }
}

//! Splits a journal into lines of limited length.

use std::io::{self, BufRead, Read as _};

/// Maximum length of a line in bytes.
///
/// The header of a definition with a million values has a third of this length.
const LONGEST: u64 = 1 << 26;

/// Reader that returns the lines of a source one after the other, including their line ends.
pub(crate) struct Lines<R> {
    source: R,
    bytes: Vec<u8>,
    /// Number of the last line read, from 1.
    number: u64,
}

impl<R: BufRead> Lines<R> {
    /// Splits `source` into lines.
    pub fn new(source: R) -> Self {
        Self { source, bytes: Vec::new(), number: 0 }
    }

    /// Returns the number of the last line read, from 1.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Returns true if the source begins with `bytes`, or is itself a prefix of `bytes`.
    pub fn begin_with(&mut self, bytes: &[u8]) -> io::Result<bool> {
        let head = self.source.fill_buf()?;
        Ok(head.starts_with(bytes) || bytes.starts_with(head))
    }

    /// Reads the next line; returns `None` at the end of the source.
    ///
    /// For a line longer than `LONGEST` an empty slice is returned.
    pub fn next(&mut self) -> io::Result<Option<&mut [u8]>> {
        self.bytes.clear();
        let read = self.piece()?;
        self.number += 1;
        if read == LONGEST as usize && !self.bytes.ends_with(b"\n") {
            self.pass_over()?;
        }
        Ok((read > 0).then_some(self.bytes.as_mut_slice()))
    }

    /// Skips the rest of a line that is too long, and clears the buffer.
    fn pass_over(&mut self) -> io::Result<()> {
        loop {
            self.bytes.clear();
            if self.piece()? == 0 || self.bytes.ends_with(b"\n") {
                self.bytes.clear();
                return Ok(());
            }
        }
    }

    /// Appends the bytes up to the next line end, at most `LONGEST` bytes, to the buffer.
    ///
    /// Returns the number of bytes read.
    fn piece(&mut self) -> io::Result<usize> {
        (&mut self.source).take(LONGEST).read_until(b'\n', &mut self.bytes)
    }
}

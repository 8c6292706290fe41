//! The lines of a journal as bytes, of which no one takes more memory than a line can have.

use std::io::{self, BufRead, Read as _};

/// The longest line of a journal: a definition with a million values takes a third of it.
const LONGEST: u64 = 1 << 26;

/// The lines of a source, with their ends.
pub(crate) struct Lines<R> {
    source: R,
    bytes: Vec<u8>,
    /// Number of the line that was read last, from 1.
    number: u64,
}

impl<R: BufRead> Lines<R> {
    /// The lines of `source`.
    pub fn new(source: R) -> Self {
        Self { source, bytes: Vec::new(), number: 0 }
    }

    /// Number of the line that was read last, from 1.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Whether the source begins with `bytes`, or ends within them.
    pub fn begin_with(&mut self, bytes: &[u8]) -> io::Result<bool> {
        let head = self.source.fill_buf()?;
        Ok(head.starts_with(bytes) || bytes.starts_with(head))
    }

    /// The next line. One that is too long has no end.
    pub fn next(&mut self) -> io::Result<Option<&mut [u8]>> {
        self.bytes.clear();
        let read = self.piece()?;
        self.number += 1;
        if read == LONGEST as usize && !self.bytes.ends_with(b"\n") {
            self.pass_over()?;
        }
        Ok((read > 0).then_some(self.bytes.as_mut_slice()))
    }

    /// Reads on to the end of a line that is too long.
    fn pass_over(&mut self) -> io::Result<()> {
        loop {
            self.bytes.clear();
            if self.piece()? == 0 || self.bytes.ends_with(b"\n") {
                self.bytes.clear();
                return Ok(());
            }
        }
    }

    fn piece(&mut self) -> io::Result<usize> {
        (&mut self.source).take(LONGEST).read_until(b'\n', &mut self.bytes)
    }
}

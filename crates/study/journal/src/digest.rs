//! SHA-256 of texts and files, as 64 hexadecimal digits.

use std::fmt::Write as _;
use std::io::{self, Read};

use sha2::{Digest as _, Sha256};

/// Maximum number of bytes in one read from a source.
const PIECE: usize = 1 << 16;

/// Returns the SHA-256 of `bytes`.
pub fn sha256(bytes: impl AsRef<[u8]>) -> String {
    digits(Sha256::new_with_prefix(bytes))
}

/// Returns the SHA-256 of all bytes of `source`.
///
/// # Errors
///
/// If `source` cannot be read.
pub fn sha256_of(mut source: impl Read) -> io::Result<String> {
    let (mut hasher, mut piece) = (Sha256::new(), vec![0; PIECE]);
    loop {
        match source.read(&mut piece) {
            Ok(0) => return Ok(digits(hasher)),
            Ok(read) => hasher.update(&piece[..read]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// Returns the digest of `hasher` as lower-case hexadecimal digits.
pub(crate) fn digits(hasher: Sha256) -> String {
    let mut text = String::new();
    for byte in hasher.finalize() {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests the published example of a one-block message, "abc", for FIPS 180-4.
    #[test]
    fn sha256_matches_the_published_example() {
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256("abc"), known);
        assert_eq!(sha256_of("abc".as_bytes()).expect("text"), known);
    }
}

//! Lines of a journal, each with a checksum.

use serde::Serialize;
use serde::de::DeserializeOwned;
use text::one_line;

/// Bytes before the checksum, at the start of each line.
pub(crate) const BEFORE: &[u8] = b"{\"crc\":\"";
/// Bytes between the checksum and the content.
const AFTER: &[u8] = b"\",";
/// Number of hexadecimal digits of the checksum.
const DIGITS: usize = 8;

/// Computes and verifies the checksums of the lines of one journal.
///
/// The checksum of each line after the header also covers definition and program in the header. A
/// line copied from the journal of another definition or program is therefore detected as damaged.
#[derive(Clone, Debug, Default)]
pub struct Seal {
    hasher: crc32fast::Hasher,
}

impl Seal {
    /// Creates a seal with checksums that also cover `texts` from the header of the journal.
    pub fn over(texts: &[&str]) -> Self {
        let mut hasher = crc32fast::Hasher::new();
        for text in texts {
            hasher.update(text.as_bytes());
        }
        Self { hasher }
    }

    /// Returns the CRC-32 of the header texts and `content`, as hexadecimal digits.
    fn checksum(&self, content: &[u8]) -> String {
        let mut hasher = self.hasher.clone();
        hasher.update(content);
        format!("{:0DIGITS$x}", hasher.finalize())
    }

    /// Serialises `content`, a struct or a map, as a line with checksum and line end.
    pub fn seal(&self, content: &impl Serialize) -> Vec<u8> {
        // Serialisation cannot fail: `content` consists of texts, numbers and lists.
        let object = serde_json::to_vec(content).unwrap_or_default();
        let content = object.get(1..).unwrap_or_default();
        [BEFORE, self.checksum(content).as_bytes(), AFTER, content, b"\n"].concat()
    }

    /// Verifies the checksum of a line and returns its JSON object.
    ///
    /// The line may end with CR LF, because some tools that synchronise files convert line ends.
    /// The first bytes of the line are overwritten.
    ///
    /// # Errors
    ///
    /// If the line has no line end, or its checksum does not match.
    pub fn open<'b>(&self, bytes: &'b mut [u8]) -> Result<&'b [u8], String> {
        let [content @ .., b'\n'] = bytes else {
            return Err("it has no line end".to_owned());
        };
        let end = content.len() - usize::from(content.ends_with(b"\r"));
        let content = &mut content[..end];
        let start = BEFORE.len() + DIGITS + AFTER.len();
        let checksum = content.get(BEFORE.len()..BEFORE.len() + DIGITS).unwrap_or_default();
        let rest = content.get(start..).unwrap_or_default();
        let framed = content.starts_with(BEFORE)
            && content.get(start - AFTER.len()..start) == Some(AFTER)
            && checksum == self.checksum(rest).as_bytes();
        if !framed {
            return Err("its checksum does not match".to_owned());
        }
        // The JSON object consists of `{` and `rest`. Write the brace over the byte before `rest`.
        content[start - 1] = b'{';
        Ok(&content[start - 1..])
    }

    /// Verifies the checksum of a line and deserialises its content.
    ///
    /// # Errors
    ///
    /// If the line has no line end, its checksum does not match, or its content is not a `T`.
    pub fn read<T: DeserializeOwned>(&self, bytes: &mut [u8]) -> Result<T, String> {
        let content = serde_json::from_slice(self.open(bytes)?);
        content.map_err(|error| one_line(&error.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;

    type Line = BTreeMap<String, f64>;

    fn line() -> Line {
        BTreeMap::from([("coverage".to_owned(), 0.1 + 0.2), ("design".to_owned(), 417.0)])
    }

    #[test]
    fn lines_are_json_and_can_be_read_again() {
        let mut bytes = Seal::default().seal(&line());
        let text = "{\"crc\":\"3966396f\",\"coverage\":0.30000000000000004,\"design\":417.0}\n";
        assert_eq!(String::from_utf8_lossy(&bytes), text);
        assert_eq!(Seal::default().read(&mut bytes), Ok(line()));
    }

    #[test]
    fn lines_may_end_with_crlf() {
        let mut bytes = Seal::default().seal(&line());
        bytes.insert(bytes.len() - 1, b'\r');
        assert_eq!(Seal::default().read(&mut bytes), Ok(line()));
    }

    #[test]
    fn lines_of_another_journal_are_refused() {
        let (first, second) = (Seal::over(&["a"]), Seal::over(&["b"]));
        assert!(first.read::<Line>(&mut second.seal(&line())).is_err());
    }

    proptest! {
        #[test]
        fn lines_with_a_flipped_bit_are_refused(at in 0..1000_usize, bit in 0..8_u32) {
            let mut bytes = Seal::default().seal(&line());
            let index = at % bytes.len();
            bytes[index] ^= 1 << bit;
            prop_assert!(Seal::default().read::<Line>(&mut bytes).is_err());
        }

        #[test]
        fn arbitrary_lines_never_panic(mut bytes: Vec<u8>, text in "\\{\"crc\":\"[0-9a-f]{8}\",.{0,20}\n") {
            let _ = Seal::default().read::<Line>(&mut bytes);
            let _ = Seal::default().read::<Line>(&mut text.into_bytes());
        }
    }
}

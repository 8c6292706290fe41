//! Lines with a checksum.

use serde::Serialize;
use serde::de::DeserializeOwned;
use text::one_line;

/// The bytes before the checksum of a line.
pub(crate) const BEFORE: &[u8] = b"{\"crc\":\"";
/// The bytes between the checksum and the content.
const AFTER: &[u8] = b"\",";
/// Digits of the checksum.
const DIGITS: usize = 8;

/// The seal that makes the lines of one journal differ from those of others: the checksums of all lines but
/// the first cover the first line too, so a line of another journal is as good as damaged.
#[derive(Clone, Debug, Default)]
pub struct Seal {
    hasher: crc32fast::Hasher,
}

impl Seal {
    /// The seal of the journals whose first line says `texts`.
    pub fn over(texts: &[&str]) -> Self {
        let mut hasher = crc32fast::Hasher::new();
        for text in texts {
            hasher.update(text.as_bytes());
        }
        Self { hasher }
    }

    fn checksum(&self, content: &[u8]) -> String {
        let mut hasher = self.hasher.clone();
        hasher.update(content);
        format!("{:0DIGITS$x}", hasher.finalize())
    }

    /// The bytes of a line that holds `content`, a struct or a map, its end included.
    pub fn seal(&self, content: &impl Serialize) -> Vec<u8> {
        // Text, numbers and lists of them always have a form in JSON.
        let object = serde_json::to_vec(content).unwrap_or_default();
        let content = object.get(1..).unwrap_or_default();
        [BEFORE, self.checksum(content).as_bytes(), AFTER, content, b"\n"].concat()
    }

    /// The JSON object that `bytes`, with the end of the line, hold, once their checksum is
    /// verified. An end of CR LF is an end too: tools that synchronise files write it.
    ///
    /// # Errors
    /// If the line has no end, or its checksum does not match.
    pub fn open<'b>(&self, bytes: &'b mut [u8]) -> Result<&'b [u8], String> {
        let [content @ .., b'\n'] = bytes else {
            return Err("it has no end".to_owned());
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
        // The object without its checksum.
        content[start - 1] = b'{';
        Ok(&content[start - 1..])
    }

    /// The content of the line that `bytes`, with the end of the line, hold.
    ///
    /// # Errors
    /// As [`Self::open`], or if the content is no `T`.
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
    fn a_line_is_json_and_reads_back() {
        let mut bytes = Seal::default().seal(&line());
        let text = "{\"crc\":\"3966396f\",\"coverage\":0.30000000000000004,\"design\":417.0}\n";
        assert_eq!(String::from_utf8_lossy(&bytes), text);
        assert_eq!(Seal::default().read(&mut bytes), Ok(line()));
    }

    #[test]
    fn a_line_that_ends_as_on_windows_is_a_line() {
        let mut bytes = Seal::default().seal(&line());
        bytes.insert(bytes.len() - 1, b'\r');
        assert_eq!(Seal::default().read(&mut bytes), Ok(line()));
    }

    #[test]
    fn a_line_of_another_journal_is_damaged() {
        let (own, other) = (Seal::over(&["a"]), Seal::over(&["b"]));
        assert!(own.read::<Line>(&mut other.seal(&line())).is_err());
    }

    proptest! {
        #[test]
        fn a_line_that_is_changed_anywhere_is_refused(at in 0..1000_usize, bit in 0..8_u32) {
            let mut bytes = Seal::default().seal(&line());
            let place = at % bytes.len();
            bytes[place] ^= 1 << bit;
            prop_assert!(Seal::default().read::<Line>(&mut bytes).is_err());
        }

        #[test]
        fn anything_is_read_or_refused(mut bytes: Vec<u8>, text in "\\{\"crc\":\"[0-9a-f]{8}\",.{0,20}\n") {
            let _ = Seal::default().read::<Line>(&mut bytes);
            let _ = Seal::default().read::<Line>(&mut text.into_bytes());
        }
    }
}

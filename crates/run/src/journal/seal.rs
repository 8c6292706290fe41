//! Lines with a checksum.

use serde::{Deserialize, Serialize};

use super::entry::{JournalEntry, SessionStart};
use super::header::JournalHeader;

/// The bytes before the checksum of a line.
pub(super) const BEFORE: &[u8] = b"{\"crc\":\"";
/// The bytes between the checksum and the content.
const AFTER: &[u8] = b"\",";
/// Digits of the checksum.
const DIGITS: usize = 8;

/// A line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Line {
    /// The first.
    #[serde(rename = "journal")]
    Header(JournalHeader),
    /// A session begins.
    Session(SessionStart),
    /// A design is done.
    Design(Box<JournalEntry>),
}

/// The seal that makes the lines of one journal differ from those of others: the checksums of all lines but
/// the first cover the first line too, so a line of another journal is as good as damaged.
#[derive(Clone, Debug, Default)]
pub struct Seal {
    hasher: crc32fast::Hasher,
}

impl Seal {
    /// The seal of the journals with that header, whatever part of the designs they hold.
    pub(crate) fn of(header: &JournalHeader) -> Self {
        Self::over(&[&header.definition_sha256, &header.version, &header.revision])
    }

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

    /// The bytes of `line`, its end included.
    pub(crate) fn write(&self, line: &Line) -> Vec<u8> {
        self.seal(line)
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

    /// The line that `bytes`, with the end of the line, hold.
    pub(crate) fn read(&self, bytes: &mut [u8]) -> Result<Line, String> {
        Line::parse(self.open(bytes)?)
    }
}

impl Line {
    /// The line that a JSON object stands for.
    pub fn parse(object: &[u8]) -> Result<Self, String> {
        let line = serde_json::from_slice(object);
        line.map_err(|error| sweep::toml_source::one_line(&error.to_string()))
    }

    /// The format that the JSON object of a first line names, whatever else it holds.
    pub fn format_of(object: &[u8]) -> Option<u64> {
        let line: serde_json::Value = serde_json::from_slice(object).ok()?;
        line.get("journal")?.get("format")?.as_u64()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use results::DesignResult;

    use super::*;

    fn line() -> Line {
        let settings = "solver.max_step=0.01".to_owned();
        let result =
            DesignResult { coverage: Some(0.1 + 0.2), settings, ..DesignResult::default() };
        Line::Design(Box::new(JournalEntry {
            design: 417,
            rerun: 1,
            at: 1.5,
            seconds: 0.25,
            result,
        }))
    }

    #[test]
    fn a_line_is_json_and_reads_back() {
        let mut bytes = Seal::default().write(&line());
        insta::assert_snapshot!(String::from_utf8_lossy(&bytes), @r#"
        {"crc":"bbd5f1e4","design":{"design":417,"rerun":1,"at":1.5,"seconds":0.25,"result":{"coverage":0.30000000000000004,"settings":"solver.max_step=0.01"}}}
        "#);
        assert!(serde_json::from_slice::<serde_json::Value>(&bytes).is_ok());
        assert_eq!(Seal::default().read(&mut bytes), Ok(line()));
    }

    #[test]
    fn a_line_that_ends_as_on_windows_is_a_line() {
        let mut bytes = Seal::default().write(&line());
        bytes.insert(bytes.len() - 1, b'\r');
        assert_eq!(Seal::default().read(&mut bytes), Ok(line()));
    }

    proptest! {
        /// Every number of a result comes back with all its bits.
        #[test]
        fn numbers_are_read_back_bit_by_bit(number in any::<f64>().prop_filter("finite", |x| x.is_finite())) {
            let result = DesignResult { coverage: Some(number), ..DesignResult::default() };
            let entry = JournalEntry { design: 1, rerun: 0, at: 0.0, seconds: 0.0, result };
            let mut bytes = Seal::default().write(&Line::Design(Box::new(entry)));
            let Ok(Line::Design(entry)) = Seal::default().read(&mut bytes) else {
                return Err(TestCaseError::fail("no design"));
            };
            prop_assert_eq!(entry.result.coverage.map(f64::to_bits), Some(number.to_bits()));
        }

        #[test]
        fn a_line_that_is_changed_anywhere_is_refused(at in 0..1000_usize, bit in 0..8_u32) {
            let mut bytes = Seal::default().write(&line());
            let place = at % bytes.len();
            bytes[place] ^= 1 << bit;
            prop_assert!(Seal::default().read(&mut bytes).is_err());
        }

        #[test]
        fn anything_is_read_or_refused(mut bytes: Vec<u8>, text in "\\{\"crc\":\"[0-9a-f]{8}\",.{0,20}\n") {
            let _ = Seal::default().read(&mut bytes);
            let _ = Seal::default().read(&mut text.into_bytes());
        }
    }
}

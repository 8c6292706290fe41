//! Lines with a checksum.

use serde::{Deserialize, Serialize};

use super::entry::{Entry, Session};
use super::header::Header;

/// What stands before the checksum of a line.
const BEFORE: &[u8] = b"{\"crc\":\"";
/// What stands between the checksum and the content.
const AFTER: &[u8] = b"\",";
/// Digits of the checksum.
const DIGITS: usize = 8;

/// A line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Line {
    /// The first.
    #[serde(rename = "journal")]
    Header(Header),
    /// A session begins.
    Session(Session),
    /// A design is done.
    Design(Entry),
}

/// What makes the lines of one journal differ from those of others: the checksums of all lines but
/// the first cover the first line too, so a line of another journal is as good as damaged.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seal {
    hasher: crc32fast::Hasher,
}

impl Seal {
    /// The seal of the journals with that header, whatever part of the designs they hold.
    pub fn of(header: &Header) -> Self {
        let mut hasher = crc32fast::Hasher::new();
        for text in [&header.definition_sha256, &header.version, &header.revision] {
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
    pub fn write(&self, line: &Line) -> Vec<u8> {
        // Text, numbers and lists of them always have a form in JSON.
        let object = serde_json::to_vec(line).unwrap_or_default();
        let content = object.get(1..).unwrap_or_default();
        [BEFORE, self.checksum(content).as_bytes(), AFTER, content, b"\n"].concat()
    }

    /// The line that `bytes`, its end included, holds.
    pub fn read(&self, bytes: &mut [u8]) -> Result<Line, String> {
        let [content @ .., b'\n'] = bytes else {
            return Err("it has no end".to_owned());
        };
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
        let line = serde_json::from_slice(&content[start - 1..]);
        line.map_err(|error| sweep::toml_source::one_line(&error.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn line() -> Line {
        let failures = vec!["0417,no convergence".to_owned()];
        let row = "0417,0.1,\u{e9}".to_owned();
        Line::Design(Entry { design: 417, at: 1.5, seconds: 0.25, rerun: 0, row, failures })
    }

    #[test]
    fn a_line_is_json_and_reads_back() {
        let mut bytes = Seal::default().write(&line());
        insta::assert_snapshot!(String::from_utf8_lossy(&bytes), @r#"
        {"crc":"72aaabda","design":{"design":417,"at":1.5,"seconds":0.25,"row":"0417,0.1,é","failures":["0417,no convergence"]}}
        "#);
        assert!(serde_json::from_slice::<serde_json::Value>(&bytes).is_ok());
        assert_eq!(Seal::default().read(&mut bytes), Ok(line()));
    }

    proptest! {
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

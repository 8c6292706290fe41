//! Whatever is read, nothing panics: definitions, settings and journals, random and nearly right.
//! `scripts/fuzz` runs these for as long as one likes.

use std::fmt::Write as _;
use std::io::Cursor;
use std::path::Path;
use std::sync::OnceLock;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use sweep::{Archive, PARAMETERS, Setting, Sweep};

/// Section and key of a parameter.
fn parameter() -> impl Strategy<Value = (&'static str, &'static str)> {
    (0..PARAMETERS.len()).prop_map(|i| (PARAMETERS[i].section, PARAMETERS[i].key))
}

/// Words that definitions are made of, and what does not belong there.
fn word() -> impl Strategy<Value = String> {
    let key = parameter().prop_map(|(_, key)| key.to_owned());
    let section = parameter().prop_map(|(section, _)| section.to_owned());
    let fixed = vec![
        "name",
        "measures",
        "designs",
        "from",
        "to",
        "step",
        "coverage",
        "puncture",
        "flexure",
        "=",
        ".",
        ",",
        "[",
        "]",
        "[[",
        "{",
        "}",
        "'",
        "\"",
        "'''",
        "#",
        "\n",
        "\r\n",
        " ",
        "true",
        "nan",
        "inf",
        "2L",
        "1979-05-27",
        "0x1F",
        "1e308",
        "-1e-320",
        "9223372036854775808",
        "\u{0}",
        "\u{feff}",
        "é",
    ];
    prop_oneof![
        4 => select(fixed).prop_map(str::to_owned),
        2 => key,
        1 => section,
        1 => any::<f64>().prop_map(|number| number.to_string()),
        1 => any::<i64>().prop_map(|number| number.to_string()),
        1 => (0..20_i32).prop_map(|number| format!("0.{number}")),
    ]
}

/// A value as someone may write it.
fn value() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<f64>().prop_map(|number| number.to_string()),
        (-5..2000_i32).prop_map(|number| number.to_string()),
        (-50..2000_i32).prop_map(|number| format!("{}", f64::from(number) / 100.0)),
        vec(-1.0..90.0, 0..5).prop_map(|list| format!("{list:?}")),
        (any::<i32>(), any::<i32>(), any::<i16>(), -9..3_i32).prop_map(|(from, to, step, e)| {
            format!("{{ from = {from}e{e}, to = {to}e{e}, step = {step}e{e} }}")
        }),
        (0..9_u8, 1..9_u8).prop_map(|(to, step)| format!(
            "{{ from = 0, to = {}, step = {step} }}",
            u32::from(to) * u32::from(step)
        )),
        vec(word(), 0..6).prop_map(|words| words.concat()),
    ]
}

/// A definition with a line for each of some parameters, as axis or in its section.
fn definition() -> impl Strategy<Value = String> {
    let line = (parameter(), any::<bool>(), value()).prop_map(|((section, key), axis, value)| {
        let section = if axis { "designs" } else { section };
        format!("{section}.{key} = {value}\n")
    });
    vec(line, 0..6).prop_map(|lines| format!("name = 'x'\n{}", lines.concat()))
}

/// `text` with some bytes replaced, removed or doubled.
fn damaged(text: &'static [u8]) -> impl Strategy<Value = Vec<u8>> {
    let change = (any::<Index>(), 0..40_usize, 0..3_u8, any::<u8>());
    vec(change, 1..4).prop_map(move |changes| {
        let mut bytes = text.to_vec();
        for (at, length, kind, byte) in changes {
            let at = at.index(bytes.len());
            let end = (at + length).min(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 if bytes.len() > 100 => drop(bytes.drain(at..end)),
                _ => {
                    let piece = bytes[at..end].to_vec();
                    bytes.splice(at..at, piece);
                }
            }
        }
        bytes
    })
}

fn paper() -> &'static [u8] {
    include_bytes!("../../../../sweeps/paper.toml")
}

/// Reads a definition; what is understood must have designs, and read back from its complete form.
fn read(text: &str) -> Result<(), TestCaseError> {
    match Sweep::parse(text, "x.toml", &[]) {
        Ok(sweep) => {
            let (grid, complete) = (sweep.grid(), sweep.to_toml());
            for index in [0, grid.len() / 2, grid.len() - 1] {
                let case = grid.case(index);
                prop_assert_eq!(grid.find(&case), Some(index), "{}", complete);
            }
            let again = Sweep::parse(&complete, "x.toml", &[]).map(|sweep| sweep.to_toml());
            prop_assert_eq!(again.map_err(|error| error.to_string()), Ok(complete));
        }
        Err(error) => prop_assert_eq!(error.to_string().lines().count(), 1, "{}", error),
    }
    Ok(())
}

/// The lines of a sound journal, without their checksums: a header, a session, designs.
fn journal() -> &'static [String] {
    static LINES: OnceLock<Vec<String>> = OnceLock::new();
    LINES.get_or_init(|| {
        let place = tempfile::tempdir().expect("a folder");
        crate::journals::resume(place.path()).expect("a run");
        let text = std::fs::read_to_string(place.path().join("journal.jsonl")).expect("text");
        text.lines().take(8).map(|line| line[CHECKSUM..].to_owned()).collect()
    })
}

/// Bytes of `{"crc":"01234567",`.
const CHECKSUM: usize = 18;

/// The journal with these contents, each line with the checksum that it must have.
fn sealed(contents: &[String]) -> Vec<u8> {
    let header: serde_json::Value =
        serde_json::from_str(&format!("{{{}", contents[0])).unwrap_or_default();
    let mut seal = crc32fast::Hasher::new();
    for key in ["definition_sha256", "version", "revision"] {
        seal.update(header["journal"][key].as_str().unwrap_or_default().as_bytes());
    }
    let mut text = String::new();
    for (line, content) in contents.iter().enumerate() {
        let mut hasher = if line == 0 { crc32fast::Hasher::new() } else { seal.clone() };
        hasher.update(content.as_bytes());
        let _ = writeln!(text, "{{\"crc\":\"{:08x}\",{content}", hasher.finalize());
    }
    text.into_bytes()
}

/// Reads a journal; what is refused is refused in one line that names its own.
fn open(bytes: Vec<u8>) -> Result<(), TestCaseError> {
    match Archive::read_from(Cursor::new(bytes), Path::new("journal.jsonl")) {
        Ok(None) => {}
        Ok(Some(archive)) => {
            let missing: u64 = archive.missing().iter().map(|range| range.end - range.start).sum();
            prop_assert_eq!(archive.done() + missing, archive.selection().len());
        }
        Err(error) => {
            let error = error.to_string();
            prop_assert_eq!(error.lines().count(), 1, "{}", error);
            let line = error.strip_prefix("journal.jsonl:").and_then(|rest| rest.split(':').next());
            prop_assert!(line.is_some_and(|line| line.parse::<u64>().is_ok()), "{}", error);
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn definitions_of_random_words(words in vec(word(), 0..60)) {
        read(&words.concat())?;
    }

    #[test]
    fn definitions_of_random_bytes(bytes in vec(any::<u8>(), 0..200)) {
        read(&String::from_utf8_lossy(&bytes))?;
    }

    #[test]
    fn definitions_that_are_nearly_right(text in definition()) {
        read(&text)?;
    }

    #[test]
    fn definitions_that_were_damaged(bytes in damaged(paper())) {
        read(&String::from_utf8_lossy(&bytes))?;
    }

    #[test]
    fn settings((section, key) in parameter(), axis: bool, value in value()) {
        let section = if axis { "designs" } else { section };
        if let Ok(setting) = Setting::parse(&format!("{section}.{key}={value}")) {
            let _ = Sweep::parse("name = 'x'", "x.toml", &[setting]);
        }
    }

    #[test]
    fn journals_of_random_bytes(bytes in vec(any::<u8>(), 0..200)) {
        open(bytes)?;
    }

    #[test]
    fn journals_that_were_damaged(
        at: Index, length in 0..30_usize, piece in vec(any::<u8>(), 0..30)
    ) {
        let mut bytes = sealed(journal());
        let at = at.index(bytes.len());
        let end = (at + length).min(bytes.len());
        bytes.splice(at..end, piece);
        open(bytes)?;
    }

    /// The checksums are right, so that all else is read too.
    #[test]
    fn journals_that_somebody_has_written(
        line: Index, at: Index, length in 0..12_usize, piece in "[-0-9a-z{}\\[\\]:,.\"\\\\]{0,12}"
    ) {
        let mut contents = journal().to_vec();
        let line = line.index(contents.len());
        let content = &mut contents[line];
        let at = at.index(content.len());
        let end = (at + length).min(content.len());
        content.replace_range(at..end, &piece);
        open(sealed(&contents))?;
    }

    #[test]
    fn journals_with_numbers_that_nobody_expects(
        line: Index, at: Index, number: u64, shift in 0..64_u32
    ) {
        let mut contents = journal().to_vec();
        let line = line.index(contents.len());
        let content = &mut contents[line];
        let digits: Vec<_> = content.match_indices(|c: char| c.is_ascii_digit()).collect();
        let at = digits[at.index(digits.len())].0;
        content.replace_range(at..=at, &(number >> shift).to_string());
        open(sealed(&contents))?;
    }
}

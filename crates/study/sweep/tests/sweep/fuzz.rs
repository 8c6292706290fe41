//! Fuzz tests: random and nearly valid definitions and settings never cause a panic.
//!
//! `scripts/fuzz` runs these tests for any length of time.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use sweep::{PARAMETERS, Setting, Sweep};

/// Generates the section and the key of a parameter.
fn parameter() -> impl Strategy<Value = (&'static str, &'static str)> {
    (0..PARAMETERS.len()).prop_map(|i| (PARAMETERS[i].section, PARAMETERS[i].key))
}

/// Generates a word, number or symbol. Most of them occur in definitions.
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

/// Generates a value as a user may write it.
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

/// Generates a definition of up to five random parameters, each an axis or in its section.
fn definition() -> impl Strategy<Value = String> {
    let line = (parameter(), any::<bool>(), value()).prop_map(|((section, key), axis, value)| {
        let section = if axis { "designs" } else { section };
        format!("{section}.{key} = {value}\n")
    });
    vec(line, 0..6).prop_map(|lines| format!("name = 'x'\n{}", lines.concat()))
}

/// Generates `text` with up to three changes, which replace, remove or repeat some bytes.
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
    include_bytes!("../../../../../sweeps/paper.toml")
}

/// Parses a definition and checks the result.
///
/// For a valid definition, checks that its designs are found by their parameters, and that its
/// complete form reads back as the same definition. For an invalid definition, checks that each
/// line of the error names the file.
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
        Err(error) => {
            let message = error.to_string();
            let is_one_line_each = message.lines().all(|line| line.starts_with("x.toml"));
            prop_assert!(!message.is_empty() && is_one_line_each, "{}", message);
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn definitions_of_random_words_never_panic(words in vec(word(), 0..60)) {
        read(&words.concat())?;
    }

    #[test]
    fn definitions_of_random_bytes_never_panic(bytes in vec(any::<u8>(), 0..200)) {
        read(&String::from_utf8_lossy(&bytes))?;
    }

    #[test]
    fn nearly_valid_definitions_never_panic(text in definition()) {
        read(&text)?;
    }

    #[test]
    fn damaged_definitions_never_panic(bytes in damaged(paper())) {
        read(&String::from_utf8_lossy(&bytes))?;
    }

    #[test]
    fn random_settings_never_panic((section, key) in parameter(), axis: bool, value in value()) {
        let section = if axis { "designs" } else { section };
        if let Ok(setting) = Setting::parse(&format!("{section}.{key}={value}")) {
            let _ = Sweep::parse("name = 'x'", "x.toml", &[setting]);
        }
    }
}

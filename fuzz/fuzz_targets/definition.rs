//! Fuzzes the reader of definitions: it accepts an input, or reports each error on one line.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sweep::{Setting, Sweep};

fuzz_target!(|text: &str| {
    let (setting, definition) = text.split_once('\n').unwrap_or(("", text));
    let settings: Vec<_> = Setting::parse(setting).into_iter().collect();
    match Sweep::parse(definition, "x.toml", &settings) {
        // The reader accepts an accepted definition after it is written as TOML.
        Ok(sweep) => assert!(Sweep::parse(&sweep.to_toml(), "x.toml", &[]).is_ok()),
        Err(error) => assert!(error.to_string().lines().all(|mistake| mistake.contains(": "))),
    }
});

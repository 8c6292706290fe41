//! Definitions and settings are accepted, or rejected with one line per error.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sweep::{Setting, Sweep};

fuzz_target!(|text: &str| {
    let (setting, definition) = text.split_once('\n').unwrap_or(("", text));
    let settings: Vec<_> = Setting::parse(setting).into_iter().collect();
    match Sweep::parse(definition, "x.toml", &settings) {
        // An accepted definition can be written and read again.
        Ok(sweep) => assert!(Sweep::parse(&sweep.to_toml(), "x.toml", &[]).is_ok()),
        Err(error) => assert!(error.to_string().lines().all(|mistake| mistake.contains(": "))),
    }
});

//! Definitions of sweeps, and settings: read, or refused in one line.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sweep::{Setting, Sweep};

fuzz_target!(|text: &str| {
    let (setting, definition) = text.split_once('\n').unwrap_or(("", text));
    let settings: Vec<_> = Setting::parse(setting).into_iter().collect();
    match Sweep::parse(definition, "x.toml", &settings) {
        // What was read can be written and read again.
        Ok(sweep) => assert!(Sweep::parse(&sweep.to_toml(), "x.toml", &[]).is_ok()),
        Err(error) => assert_eq!(error.to_string().lines().count(), 1),
    }
});

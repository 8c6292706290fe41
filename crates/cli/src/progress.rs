//! The bar on the terminal.

use std::io::{IsTerminal as _, stderr};
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use run::Progress;

/// Shows how far a run is: rate, remaining time and failures so far.
pub struct ProgressDisplay {
    bar: ProgressBar,
    failed: u64,
}

impl ProgressDisplay {
    /// A bar; none when `quiet` or when nobody watches.
    pub fn new(quiet: bool) -> Self {
        let hidden = quiet || !stderr().is_terminal();
        let bar = if hidden { ProgressBar::hidden() } else { ProgressBar::new(0) };
        let template = "{wide_bar} {pos}/{len} designs  {per_sec}  {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message("0 failed");
        Self { bar, failed: 0 }
    }

    /// Shows the progress of the run.
    pub fn show(&mut self, progress: Progress, stop: &AtomicBool) {
        match progress {
            Progress::Begun { designs, done } => {
                self.bar.set_length(designs);
                self.bar.set_position(done);
                self.bar.reset_eta();
            }
            Progress::Done { failed } => {
                self.failed += u64::from(failed);
                self.bar.inc(1);
            }
        }
        let ending = if stop.load(Ordering::Relaxed) { ", ending" } else { "" };
        self.bar.set_message(format!("{} failed{ending}", self.failed));
    }
}

impl Drop for ProgressDisplay {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

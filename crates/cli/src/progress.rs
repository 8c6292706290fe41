//! The bar on the terminal.

use std::io::{IsTerminal as _, stderr};
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use run::News;

/// Shows how far a run is: rate, remaining time and failures so far.
pub struct Progress {
    bar: ProgressBar,
    failed: u64,
}

impl Progress {
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

    /// Shows what is new.
    pub fn show(&mut self, news: News<'_>, stop: &AtomicBool) {
        match news {
            News::Begun { designs, done } => {
                self.bar.set_length(designs);
                self.bar.set_position(done);
                self.bar.reset_eta();
            }
            News::Done(entry) => {
                self.failed += u64::from(entry.failed());
                self.bar.inc(1);
            }
        }
        let ending = if stop.load(Ordering::Relaxed) { ", ending" } else { "" };
        self.bar.set_message(format!("{} failed{ending}", self.failed));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

//! The progress bar of runs, searches and fits.

use std::io::{IsTerminal as _, stderr};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use optimisation::SearchProgress;
use run::{Progress, WorkMeter};

use crate::interrupt::Interrupt;
use crate::print::time;

/// Interval between updates of the bar and checks for a signal.
// Short enough for an immediate response to Ctrl-C.
const PAUSE: Duration = Duration::from_millis(100);

/// Resolution of the bar, which counts integers.
const PARTS: u64 = 10_000;

/// Message after the first signal, for work that `--resume` continues.
pub const RESUMED: &str =
    "ending after the designs in progress; a second signal ends at once; --resume continues";

/// Work with observable progress.
pub trait Watched: Send + Sync + 'static {
    /// Returns the completed fraction and a description of the progress after `elapsed`.
    fn look(&self, elapsed: Duration) -> (f64, String);

    /// Returns new messages, each printed on its own line.
    fn news(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Shows the progress of work until dropped.
///
/// A thread polls the progress, because a single design may take a minute.
pub struct Display<W> {
    watched: Arc<W>,
    watcher: Option<(Sender<()>, JoinHandle<()>)>,
}

/// Progress of a run: rate, remaining time and failures.
pub type ProgressDisplay = Display<Counts>;

/// Counters of a run.
#[derive(Debug, Default)]
pub struct Counts {
    work: WorkMeter,
    designs: AtomicU64,
    /// Designs completed in earlier sessions.
    before: AtomicU64,
    done: AtomicU64,
    failed: AtomicU64,
}

impl<W: Watched> Display<W> {
    /// Starts the bar, unless `quiet`; prints `ending` after a termination signal.
    pub fn new(quiet: bool, interrupt: &Interrupt, watched: Arc<W>, ending: &'static str) -> Self {
        let watcher = (!quiet).then(|| {
            let (sender, ended) = channel();
            let (interrupt, watched) = (interrupt.clone(), Arc::clone(&watched));
            (sender, std::thread::spawn(move || watch(&*watched, &interrupt, ending, &ended)))
        });
        Self { watched, watcher }
    }

    /// Returns the observed work.
    pub fn watched(&self) -> &W {
        &self.watched
    }
}

/// Runs work of `units` units with a progress bar. Signals end the process at once.
pub fn with_bar<T>(units: usize, work: impl FnOnce(&WorkMeter) -> T) -> T {
    let meter = Arc::<WorkMeter>::default();
    meter.begin(units as u64);
    // This interrupt is never set: such work has nothing to finish.
    let display = Display::new(false, &Interrupt::default(), meter, "");
    work(display.watched())
}

impl<W> Drop for Display<W> {
    fn drop(&mut self) {
        if let Some((sender, watcher)) = self.watcher.take() {
            // Closing the channel ends the watcher; joining first would deadlock.
            drop(sender);
            // A panic of the watcher affects only the bar.
            let _ = watcher.join();
        }
    }
}

impl Watched for SearchProgress {
    fn look(&self, elapsed: Duration) -> (f64, String) {
        let (part, done, tasks) = self.progress();
        let share = self.share();
        let left = left(share, elapsed);
        (share, format!("{}: {done}/{tasks}  {} designs{left}", part.words(), self.designs()))
    }

    fn news(&self) -> Vec<String> {
        self.slow().take_slow()
    }
}

impl Watched for WorkMeter {
    fn look(&self, elapsed: Duration) -> (f64, String) {
        let share = self.share();
        (share, format!("{:.0} %{}", 100.0 * share, left(share, elapsed)))
    }

    fn news(&self) -> Vec<String> {
        self.take_slow()
    }
}

impl Counts {
    /// Returns the meter of the work.
    pub fn work(&self) -> &WorkMeter {
        &self.work
    }

    /// Updates the counters.
    pub fn show(&self, progress: Progress) {
        match progress {
            Progress::Begun { designs, done } => {
                self.designs.store(designs, Ordering::Relaxed);
                self.before.store(done, Ordering::Relaxed);
            }
            Progress::Done { failed } => {
                self.failed.fetch_add(u64::from(failed), Ordering::Relaxed);
                self.done.fetch_add(1, Ordering::Relaxed);
            }
        }
    }
}

/// Draws the bar until `ended` is closed.
fn watch(watched: &dyn Watched, interrupt: &Interrupt, ending: &str, ended: &Receiver<()>) {
    // If stderr is a file, only messages are written.
    let bar = if stderr().is_terminal() { ProgressBar::new(PARTS) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {msg}") {
        bar.set_style(style);
    }
    let begun = Instant::now();
    let mut is_ending = false;
    // Waiting on the channel, unlike sleeping, returns as soon as the work ends.
    while ended.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
        if interrupt.exit_code().is_some() && !is_ending {
            is_ending = true;
            bar.suspend(|| eprintln!("{ending}"));
        }
        for line in watched.news() {
            // Suspended, because printing over the bar would garble the line.
            bar.suspend(|| eprintln!("{line}"));
        }
        let (share, text) = watched.look(begun.elapsed());
        bar.set_position((share * PARTS as f64) as u64);
        bar.set_message(text);
    }
    bar.finish_and_clear();
}

impl Watched for Counts {
    fn look(&self, elapsed: Duration) -> (f64, String) {
        let share = self.work.share();
        (share, self.text(share, elapsed))
    }

    fn news(&self) -> Vec<String> {
        self.work.take_slow()
    }
}

impl Counts {
    /// Describes the progress of a run that completed the fraction `share` in `elapsed`.
    fn text(&self, share: f64, elapsed: Duration) -> String {
        // Relaxed: the counts are only displayed.
        let [designs, before, done, failed] =
            [&self.designs, &self.before, &self.done, &self.failed]
                .map(|count| count.load(Ordering::Relaxed));
        // Designs of earlier sessions do not count for the rate.
        let rate = done as f64 / elapsed.as_secs_f64();
        // A rate below 1 would be printed as 0/s.
        let rate = if rate >= 1.0 { format!("  {rate:.0}/s") } else { String::new() };
        let left = left(share, elapsed);
        format!("{}/{designs} designs{rate}{left}  {failed} failed", before + done)
    }
}

/// Extrapolates the remaining time; empty before any work is done.
fn left(share: f64, elapsed: Duration) -> String {
    let left = elapsed.as_secs_f64() * (1.0 - share) / share;
    // Before any work is done this is infinite or NaN, which `Duration` rejects.
    let left = Duration::try_from_secs_f64(left.ceil()).ok();
    left.map_or(String::new(), |left| format!("  {} left", time(left)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remaining_time_depends_on_work_not_on_the_number_of_designs() {
        let counts = Counts::default();
        counts.designs.store(12, Ordering::Relaxed);
        counts.before.store(2, Ordering::Relaxed);
        let text = |share, seconds| counts.text(share, Duration::from_secs(seconds));
        assert_eq!(text(0.0, 3), "2/12 designs  0 failed");
        counts.done.store(8, Ordering::Relaxed);
        counts.failed.store(1, Ordering::Relaxed);
        // 10 of 12 designs, but a tenth of the work.
        assert_eq!(text(0.1, 20), "10/12 designs  3m left  1 failed");
        assert_eq!(text(0.5, 2), "10/12 designs  4/s  2.00 s left  1 failed");
    }
}

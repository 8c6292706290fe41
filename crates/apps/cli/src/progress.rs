//! Shows a progress bar during runs, searches, fits and other long computations.

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

/// Interval between updates of the bar, and between checks for a signal.
// This interval is short enough for a prompt response to Ctrl-C.
const PAUSE: Duration = Duration::from_millis(100);

/// Number of steps of the bar, which takes integer positions.
const PARTS: u64 = 10_000;

/// Message that is printed after the first termination signal, if `--resume` can continue.
pub const RESUMED: &str =
    "ending without the designs in progress; a second signal ends at once; --resume continues";

/// Smallest completed fraction from which the remaining time is extrapolated.
const ENOUGH: f64 = 0.05;

/// Number of increases of the completed fraction after which the remaining time is extrapolated,
/// even if the fraction is below [`ENOUGH`].
// The work of one design varies by a factor of ten and more, so a few designs do not predict the
// remaining time.
const ADVANCES: usize = 30;

/// Work that reports its progress to the bar.
pub trait Watched: Send + Sync + 'static {
    /// Returns the completed fraction, from 0 to 1.
    fn completed_fraction(&self) -> f64;

    /// Describes the progress after the time `elapsed`.
    ///
    /// `remaining` is two spaces and the remaining time; it is empty if the time is unknown.
    fn text(&self, remaining: &str, elapsed: Duration) -> String;

    /// Returns the messages since the last call; each is printed on its own line.
    fn news(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Shows the progress of work until the display is dropped.
///
/// A thread polls the progress, so that the bar also moves while a single design takes a minute.
pub struct Display<W> {
    watched: Arc<W>,
    watcher: Option<(Sender<()>, JoinHandle<()>)>,
}

/// Display for a run: designs, rate, remaining time and failures.
pub type ProgressDisplay = Display<Counts>;

/// Counts the designs of a run and measures its work.
#[derive(Debug, Default)]
pub struct Counts {
    work: WorkMeter,
    /// Number of designs of the run.
    designs: AtomicU64,
    /// Number of designs completed before this process began.
    before: AtomicU64,
    /// Number of designs completed by this process.
    done: AtomicU64,
    /// Number of failed designs among `done`.
    failed: AtomicU64,
}

impl<W: Watched> Display<W> {
    /// Starts the bar unless `quiet`; prints the message `ending` after a termination signal.
    pub fn new(quiet: bool, interrupt: &Interrupt, watched: Arc<W>, ending: &'static str) -> Self {
        let watcher = (!quiet).then(|| {
            let (sender, ended) = channel();
            let (interrupt, watched) = (interrupt.clone(), Arc::clone(&watched));
            (sender, std::thread::spawn(move || watch(&*watched, &interrupt, ending, &ended)))
        });
        Self { watched, watcher }
    }

    /// Returns the work that the bar shows.
    pub fn watched(&self) -> &W {
        &self.watched
    }
}

/// Runs `work`, which consists of `units` units, with a progress bar.
///
/// The first termination signal ends the process.
pub fn with_bar<T>(units: usize, work: impl FnOnce(&WorkMeter) -> T) -> T {
    let meter = Arc::<WorkMeter>::default();
    meter.begin(units as u64);
    // Pass an interrupt that is never set: a signal ends the process, because there is nothing to
    // save.
    let display = Display::new(false, &Interrupt::default(), meter, "");
    work(display.watched())
}

impl<W> Drop for Display<W> {
    fn drop(&mut self) {
        if let Some((sender, watcher)) = self.watcher.take() {
            // Close the channel, which ends the thread; joining the thread first would deadlock.
            drop(sender);
            // Ignore a panic of the thread, because it affects only the bar.
            let _ = watcher.join();
        }
    }
}

impl Watched for SearchProgress {
    fn completed_fraction(&self) -> f64 {
        self.completed_fraction()
    }

    fn text(&self, remaining: &str, _: Duration) -> String {
        let (part, done, tasks) = self.progress();
        format!("{}: {done}/{tasks}  {} designs{remaining}", part.description(), self.designs())
    }

    fn news(&self) -> Vec<String> {
        self.slow().take_slow()
    }
}

impl Watched for WorkMeter {
    fn completed_fraction(&self) -> f64 {
        self.completed_fraction()
    }

    fn text(&self, remaining: &str, _: Duration) -> String {
        format!("{:.0} %{remaining}", 100.0 * self.completed_fraction())
    }

    fn news(&self) -> Vec<String> {
        self.take_slow()
    }
}

impl Counts {
    /// Returns the meter that records the completed work.
    pub fn work(&self) -> &WorkMeter {
        &self.work
    }

    /// Updates the counters after an event of the run.
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

/// Draws the bar until the channel `ended` is closed.
fn watch(watched: &dyn Watched, interrupt: &Interrupt, ending: &str, ended: &Receiver<()>) {
    // If stderr is not a terminal, hide the bar and print only the messages.
    let bar = if stderr().is_terminal() { ProgressBar::new(PARTS) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {msg}") {
        bar.set_style(style);
    }
    let begun = Instant::now();
    let mut remaining = Remaining::default();
    let mut farthest = 0.0_f64;
    let mut is_ending = false;
    loop {
        // Wait on the channel instead of sleeping, to return as soon as the work ends.
        let is_done = ended.recv_timeout(PAUSE) != Err(RecvTimeoutError::Timeout);
        // Check for a signal before leaving the loop, because a signal and the end of the work may
        // fall within the same pause.
        if interrupt.exit_code().is_some() && !is_ending {
            is_ending = true;
            bar.suspend(|| eprintln!("{ending}"));
        }
        if is_done {
            break;
        }
        for line in watched.news() {
            // Suspend the bar: text printed over the bar would be garbled.
            bar.suspend(|| eprintln!("{line}"));
        }
        let (fraction, elapsed) = (watched.completed_fraction(), begun.elapsed());
        // The fraction decreases when a search needs more work than expected; keep the bar at its
        // farthest position.
        farthest = farthest.max(fraction);
        bar.set_position((farthest * PARTS as f64) as u64);
        bar.set_message(watched.text(&remaining.text(fraction, elapsed), elapsed));
    }
    bar.finish_and_clear();
}

impl Watched for Counts {
    fn completed_fraction(&self) -> f64 {
        self.work.completed_fraction()
    }

    fn text(&self, remaining: &str, elapsed: Duration) -> String {
        // Relaxed ordering suffices, because the counts are only displayed.
        let [designs, before, done, failed] =
            [&self.designs, &self.before, &self.done, &self.failed]
                .map(|count| count.load(Ordering::Relaxed));
        // The rate includes only designs completed by this process.
        let rate = done as f64 / elapsed.as_secs_f64();
        // Omit rates below 1, which would be rounded to 0/s or 1/s.
        let rate = if rate >= 1.0 { format!("  {rate:.0}/s") } else { String::new() };
        format!("{}/{designs} designs{rate}{remaining}  {failed} failed", before + done)
    }

    fn news(&self) -> Vec<String> {
        self.work.take_slow()
    }
}

/// Extrapolates the remaining time from the last increase of the completed fraction.
#[derive(Debug, Default)]
struct Remaining {
    /// Completed fraction, from 0 to 1.
    fraction: f64,
    /// Elapsed time at the last increase of `fraction`.
    at: Duration,
    /// Number of increases of `fraction`.
    advances: usize,
}

impl Remaining {
    /// Updates the completed fraction `fraction`, and formats the remaining time.
    ///
    /// Returns an empty text until there is enough progress for an extrapolation.
    fn text(&mut self, fraction: f64, elapsed: Duration) -> String {
        if fraction != self.fraction {
            (self.fraction, self.at) = (fraction, elapsed);
            self.advances += 1;
        }
        if self.fraction < ENOUGH && self.advances < ADVANCES {
            return String::new();
        }
        // Between two increases the remaining time counts down, but not below the time since the
        // last increase, because a slow design may need the same time once more.
        let waited = elapsed.saturating_sub(self.at).as_secs_f64();
        let expected = self.at.as_secs_f64() * (1.0 - self.fraction) / self.fraction;
        let left = if self.fraction < 1.0 { (expected - waited).max(waited) } else { 0.0 };
        // A fraction near zero may give more seconds than a `Duration` can represent.
        let left = Duration::try_from_secs_f64(left.ceil()).ok();
        left.map_or(String::new(), |left| format!("  {} left", time(left)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(counts: &Counts, fraction: f64, seconds: u64) -> String {
        let elapsed = Duration::from_secs(seconds);
        counts.text(&Remaining::default().text(fraction, elapsed), elapsed)
    }

    #[test]
    fn remaining_time_depends_on_work_not_on_the_number_of_designs() {
        let counts = Counts::default();
        counts.designs.store(12, Ordering::Relaxed);
        counts.before.store(2, Ordering::Relaxed);
        assert_eq!(line(&counts, 0.0, 3), "2/12 designs  0 failed");
        counts.done.store(8, Ordering::Relaxed);
        counts.failed.store(1, Ordering::Relaxed);
        // 10 of 12 designs are done, but only a tenth of the work.
        assert_eq!(line(&counts, 0.1, 20), "10/12 designs  3m left  1 failed");
        assert_eq!(line(&counts, 0.5, 2), "10/12 designs  4/s  2.00 s left  1 failed");
    }

    #[test]
    fn remaining_time_needs_progress_and_counts_down_between_advances() {
        let mut remaining = Remaining::default();
        for (fraction, seconds, text) in [
            // No time is shown yet: an extrapolation of the fraction 0.002 would give 33 minutes
            // after 4 s, and 100 minutes after 12 s.
            (0.002, 4, ""),
            (0.002, 12, ""),
            (0.2, 40, "  2m 40s left"),
            (0.2, 70, "  2m 10s left"),
            // 200 s after the last increase, the remaining time is at least 200 s.
            (0.2, 240, "  3m 20s left"),
            (1.0, 250, "  0.00 s left"),
        ] {
            assert_eq!(remaining.text(fraction, Duration::from_secs(seconds)), text);
        }
        let mut remaining = Remaining::default();
        for k in 1..=30_u32 {
            let text = remaining.text(f64::from(k) * 1e-3, Duration::from_secs(k.into()));
            assert_eq!(text.is_empty(), k < 30, "{text}");
        }
    }
}

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
    "ending without the designs in progress; a second signal ends at once; --resume continues";

/// Minimum completed fraction for an extrapolation of the remaining time.
const ENOUGH: f64 = 0.05;

/// Number of advances that suffice for an extrapolation at a smaller fraction, too.
// The work of one design varies by a factor of ten and more, so a few designs do not predict the
// remaining time.
const ADVANCES: usize = 30;

/// Work with observable progress.
pub trait Watched: Send + Sync + 'static {
    /// Returns the completed fraction, from 0 to 1.
    fn share(&self) -> f64;

    /// Describes the progress after `elapsed`; `left` is the remaining time.
    fn text(&self, left: &str, elapsed: Duration) -> String;

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
    // This interrupt is never set, because the work leaves nothing to finish after a signal.
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
    fn share(&self) -> f64 {
        self.share()
    }

    fn text(&self, left: &str, _: Duration) -> String {
        let (part, done, tasks) = self.progress();
        format!("{}: {done}/{tasks}  {} designs{left}", part.words(), self.designs())
    }

    fn news(&self) -> Vec<String> {
        self.slow().take_slow()
    }
}

impl Watched for WorkMeter {
    fn share(&self) -> f64 {
        self.share()
    }

    fn text(&self, left: &str, _: Duration) -> String {
        format!("{:.0} %{left}", 100.0 * self.share())
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
    let mut remaining = Remaining::default();
    let mut farthest = 0.0_f64;
    let mut is_ending = false;
    loop {
        // Waiting on the channel, unlike sleeping, returns as soon as the work ends.
        let is_done = ended.recv_timeout(PAUSE) != Err(RecvTimeoutError::Timeout);
        // Check for a signal before the end of the work, because both may occur within one pause.
        if interrupt.exit_code().is_some() && !is_ending {
            is_ending = true;
            bar.suspend(|| eprintln!("{ending}"));
        }
        if is_done {
            break;
        }
        for line in watched.news() {
            // Suspended, because printing over the bar would garble the line.
            bar.suspend(|| eprintln!("{line}"));
        }
        let (share, elapsed) = (watched.share(), begun.elapsed());
        // The fraction may decrease if a search takes longer than expected, but a bar does not.
        farthest = farthest.max(share);
        bar.set_position((farthest * PARTS as f64) as u64);
        bar.set_message(watched.text(&remaining.text(share, elapsed), elapsed));
    }
    bar.finish_and_clear();
}

impl Watched for Counts {
    fn share(&self) -> f64 {
        self.work.share()
    }

    fn text(&self, left: &str, elapsed: Duration) -> String {
        // Relaxed: the counts are only displayed.
        let [designs, before, done, failed] =
            [&self.designs, &self.before, &self.done, &self.failed]
                .map(|count| count.load(Ordering::Relaxed));
        // Designs of earlier sessions do not count for the rate.
        let rate = done as f64 / elapsed.as_secs_f64();
        // A rate below 1 would be printed as 0/s.
        let rate = if rate >= 1.0 { format!("  {rate:.0}/s") } else { String::new() };
        format!("{}/{designs} designs{rate}{left}  {failed} failed", before + done)
    }

    fn news(&self) -> Vec<String> {
        self.work.take_slow()
    }
}

/// Extrapolates the remaining time from the last advance of the completed fraction.
#[derive(Debug, Default)]
struct Remaining {
    share: f64,
    /// Time of the last advance.
    at: Duration,
    advances: usize,
}

impl Remaining {
    /// Formats the remaining time.
    ///
    /// Empty until there is enough progress to extrapolate from.
    fn text(&mut self, share: f64, elapsed: Duration) -> String {
        if share != self.share {
            (self.share, self.at) = (share, elapsed);
            self.advances += 1;
        }
        if self.share < ENOUGH && self.advances < ADVANCES {
            return String::new();
        }
        // Between advances the time counts down, but not to zero while a slow design is solved.
        let waited = elapsed.saturating_sub(self.at).as_secs_f64();
        let expected = self.at.as_secs_f64() * (1.0 - self.share) / self.share;
        let left = if self.share < 1.0 { (expected - waited).max(waited) } else { 0.0 };
        // A fraction near zero may give more seconds than `Duration` can hold.
        let left = Duration::try_from_secs_f64(left.ceil()).ok();
        left.map_or(String::new(), |left| format!("  {} left", time(left)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(counts: &Counts, share: f64, seconds: u64) -> String {
        let elapsed = Duration::from_secs(seconds);
        counts.text(&Remaining::default().text(share, elapsed), elapsed)
    }

    #[test]
    fn remaining_time_depends_on_work_not_on_the_number_of_designs() {
        let counts = Counts::default();
        counts.designs.store(12, Ordering::Relaxed);
        counts.before.store(2, Ordering::Relaxed);
        assert_eq!(line(&counts, 0.0, 3), "2/12 designs  0 failed");
        counts.done.store(8, Ordering::Relaxed);
        counts.failed.store(1, Ordering::Relaxed);
        // 10 of 12 designs, but a tenth of the work.
        assert_eq!(line(&counts, 0.1, 20), "10/12 designs  3m left  1 failed");
        assert_eq!(line(&counts, 0.5, 2), "10/12 designs  4/s  2.00 s left  1 failed");
    }

    #[test]
    fn remaining_time_needs_progress_and_counts_down_between_advances() {
        let mut remaining = Remaining::default();
        for (share, seconds, text) in [
            // A fraction of 0.002 after 4 s would be 33 minutes, and 100 minutes 8 s later.
            (0.002, 4, ""),
            (0.002, 12, ""),
            (0.2, 40, "  2m 40s left"),
            (0.2, 70, "  2m 10s left"),
            // A stalled design takes at least as long as it has taken.
            (0.2, 240, "  3m 20s left"),
            (1.0, 250, "  0.00 s left"),
        ] {
            assert_eq!(remaining.text(share, Duration::from_secs(seconds)), text);
        }
        let mut remaining = Remaining::default();
        for k in 1..=30_u32 {
            let text = remaining.text(f64::from(k) * 1e-3, Duration::from_secs(k.into()));
            assert_eq!(text.is_empty(), k < 30, "{text}");
        }
    }
}

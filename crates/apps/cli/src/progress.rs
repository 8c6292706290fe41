//! The bar on the terminal, of runs and of searches.

use std::io::{IsTerminal as _, stderr};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use optimisation::SearchMeter;
use run::{Progress, WorkMeter};

use crate::interrupt::Interrupt;
use crate::print::time;

/// How often the bar is drawn, and a signal looked for.
// Short enough for Ctrl-C to seem answered at once.
const PAUSE: Duration = Duration::from_millis(100);

/// The parts of the bar.
// The bar counts whole numbers, and the share of the work is a fraction.
const PARTS: u64 = 10_000;

/// What is said when the first signal has come, of work that `--resume` continues.
pub const RESUMED: &str =
    "ending after the designs in progress; a second signal ends at once, and --resume continues";

/// Work that can be looked at while it is done.
pub trait Watched: Send + Sync + 'static {
    /// The part of the work that is done, and a few words about it after `elapsed`.
    fn look(&self, elapsed: Duration) -> (f64, String);

    /// What is to be told in lines of its own.
    fn news(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Shows how far work is, until it is dropped. A thread looks at it, because a single design may take a minute.
pub struct Display<W> {
    watched: Arc<W>,
    watcher: Option<(Sender<()>, JoinHandle<()>)>,
}

/// How far a run is: rate, remaining time and failures so far.
pub type ProgressDisplay = Display<Counts>;

/// How far the run is.
#[derive(Debug, Default)]
pub struct Counts {
    work: WorkMeter,
    designs: AtomicU64,
    /// Designs that were done before the run began.
    before: AtomicU64,
    done: AtomicU64,
    failed: AtomicU64,
}

impl<W: Watched> Display<W> {
    /// A bar, unless `quiet` or nobody watches; and `ending` when a signal asks the work to end, unless `quiet`.
    pub fn new(quiet: bool, interrupt: &Interrupt, watched: Arc<W>, ending: &'static str) -> Self {
        let watcher = (!quiet).then(|| {
            let (sender, ended) = channel();
            let (interrupt, watched) = (interrupt.clone(), Arc::clone(&watched));
            (sender, std::thread::spawn(move || watch(&*watched, &interrupt, ending, &ended)))
        });
        Self { watched, watcher }
    }

    /// Where the work tells how far it is.
    pub fn watched(&self) -> &W {
        &self.watched
    }
}

/// Does work of so many units behind a bar. Signals end it as they end any command.
pub fn with_bar<T>(units: usize, work: impl FnOnce(&WorkMeter) -> T) -> T {
    let meter = Arc::<WorkMeter>::default();
    meter.begin(units as u64);
    // No signal sets this interrupt: such work has nothing to finish, and ends at once.
    let display = Display::new(false, &Interrupt::default(), meter, "");
    work(display.watched())
}

impl<W> Drop for Display<W> {
    fn drop(&mut self) {
        if let Some((sender, watcher)) = self.watcher.take() {
            // The watcher ends when its channel is closed: joined first, it would never end.
            drop(sender);
            // The bar is all that a watcher that has ended badly leaves unfinished.
            let _ = watcher.join();
        }
    }
}

impl Watched for SearchMeter {
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
    /// Where the run tells of its work.
    pub fn work(&self) -> &WorkMeter {
        &self.work
    }

    /// Takes the progress of the run into account.
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

/// Draws the bar until the work has `ended`.
fn watch(watched: &dyn Watched, interrupt: &Interrupt, ending: &str, ended: &Receiver<()>) {
    // A file has no bar, but it has the lines about slow designs and about the end.
    let bar = if stderr().is_terminal() { ProgressBar::new(PARTS) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {msg}") {
        bar.set_style(style);
    }
    let begun = Instant::now();
    let mut is_ending = false;
    // The channel is a clock that stops at once: work that ends does not wait for the pause.
    while ended.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
        if interrupt.exit_code().is_some() && !is_ending {
            is_ending = true;
            bar.suspend(|| eprintln!("{ending}"));
        }
        for line in watched.news() {
            // Written across a bar, a line would be torn.
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
    /// How far a run is that has done `share` of its work in `elapsed`.
    fn text(&self, share: f64, elapsed: Duration) -> String {
        // These counts are shown and not relied on, so that their order does not matter.
        let [designs, before, done, failed] =
            [&self.designs, &self.before, &self.done, &self.failed]
                .map(|count| count.load(Ordering::Relaxed));
        // Designs of an earlier session took none of this time.
        let rate = done as f64 / elapsed.as_secs_f64();
        // A rate below one would read 0/s.
        let rate = if rate >= 1.0 { format!("  {rate:.0}/s") } else { String::new() };
        let left = left(share, elapsed);
        format!("{}/{designs} designs{rate}{left}  {failed} failed", before + done)
    }
}

/// The time that the rest of the work takes if it goes on as it has begun, in words; nothing before it has begun.
fn left(share: f64, elapsed: Duration) -> String {
    let left = elapsed.as_secs_f64() * (1.0 - share) / share;
    // Before anything is done this is infinite or no number, which no duration takes.
    let left = Duration::try_from_secs_f64(left.ceil()).ok();
    left.map_or(String::new(), |left| format!("  {} left", time(left)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_follows_the_work_and_not_the_designs() {
        let counts = Counts::default();
        counts.designs.store(12, Ordering::Relaxed);
        counts.before.store(2, Ordering::Relaxed);
        let text = |share, seconds| counts.text(share, Duration::from_secs(seconds));
        assert_eq!(text(0.0, 3), "2/12 designs  0 failed");
        counts.done.store(8, Ordering::Relaxed);
        counts.failed.store(1, Ordering::Relaxed);
        // Ten of twelve designs, but a tenth of the work.
        assert_eq!(text(0.1, 20), "10/12 designs  3m left  1 failed");
        assert_eq!(text(0.5, 2), "10/12 designs  4/s  2.00 s left  1 failed");
    }
}

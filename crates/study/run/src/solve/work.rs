//! Measures the progress of a run, including progress within a design.
//!
//! An imperfect design, which has many samples, may take a thousand times as long as a perfect one.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use skin::flexure::{Method, whole_gaps};
use solver::{PathProgress, report_progress};
use sweep::{Case, Measure};

/// Time after which the progress within a design is reported.
const PATIENCE: Duration = Duration::from_secs(5);

/// Total and completed work of a run, counted by all threads.
///
/// The unit is one path: of a row in puncture, or of a gap in bending.
#[derive(Debug, Default)]
pub struct WorkMeter {
    all: AtomicU64,
    done: AtomicU64,
    slow: Arc<Mutex<Vec<String>>>,
}

/// Calls `work` for a design, and calls `report` with its progress if it takes over five seconds.
pub fn report_slow<T>(
    design: &str,
    report: impl Fn(String) + 'static,
    work: impl FnOnce() -> T,
) -> T {
    report_after(PATIENCE, design, report, work)
}

fn report_after<T>(
    patience: Duration,
    design: &str,
    report: impl Fn(String) + 'static,
    work: impl FnOnce() -> T,
) -> T {
    let design = design.to_owned();
    let describe = move |progress: PathProgress| {
        // At rest the fraction may be −0.0; adding 0.0 avoids the text "-0.0 %".
        let (seconds, percent) = (progress.elapsed.as_secs_f64(), 100.0 * progress.fraction + 0.0);
        let PathProgress { points, .. } = progress;
        report(format!(
            "{design}: {seconds:.0} s so far, {points} points, at {percent:.1} % of the final angle"
        ));
    };
    report_progress(patience, describe, work)
}

impl WorkMeter {
    /// Returns the messages about slow designs, and clears them.
    pub fn take_slow(&self) -> Vec<String> {
        std::mem::take(&mut *self.slow.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Calls `work` for a design, and stores messages about its progress if it is slow.
    ///
    /// [`Self::take_slow`] returns these messages.
    pub fn track<T>(&self, design: &str, work: impl FnOnce() -> T) -> T {
        let slow = Arc::clone(&self.slow);
        let report = move |text| slow.lock().unwrap_or_else(PoisonError::into_inner).push(text);
        report_slow(design, report, work)
    }

    /// Returns the completed fraction of the work, from 0 to 1.
    pub fn completed_fraction(&self) -> f64 {
        let [done, all] = [&self.done, &self.all].map(|units| units.load(Ordering::Relaxed));
        if all > 0 { (done as f64 / all as f64).min(1.0) } else { 0.0 }
    }

    /// Sets the total work to `all` units and the completed work to 0.
    pub fn begin(&self, all: u64) {
        self.done.store(0, Ordering::Relaxed);
        self.all.store(all, Ordering::Relaxed);
    }

    /// Subtracts units that need no work, so that they do not affect the estimated time.
    pub fn leave_out(&self, units: u64) {
        self.all.fetch_sub(units.min(self.all.load(Ordering::Relaxed)), Ordering::Relaxed);
    }

    /// Adds completed units.
    pub fn count(&self, units: u64) {
        self.done.fetch_add(units, Ordering::Relaxed);
    }
}

/// Part of the work with an expected number of units.
///
/// In total exactly the expected number is counted: excess units are ignored, and missing units are
/// added when the piece is dropped.
pub struct WorkPiece<'m> {
    meter: &'m WorkMeter,
    remaining: Cell<u64>,
}

impl<'m> WorkPiece<'m> {
    /// Creates a piece of work with an expected number of units.
    pub fn new(meter: &'m WorkMeter, units: u64) -> Self {
        Self { meter, remaining: Cell::new(units) }
    }

    /// Counts completed units, up to the expected number.
    pub fn count(&self, units: u64) {
        // The limit keeps the completed fraction of the run at 1 or below.
        let units = units.min(self.remaining.get());
        self.remaining.set(self.remaining.get() - units);
        self.meter.count(units);
    }
}

impl Drop for WorkPiece<'_> {
    fn drop(&mut self) {
        self.count(u64::MAX);
    }
}

/// Expected work of a design, in paths, and its number of samples.
#[derive(Clone, Copy, Debug)]
struct Parts {
    /// Work on the design without scatter.
    ideal: u64,
    /// Work on the puncture of one imperfect row.
    row: u64,
    /// Work on one imperfect strip, in which each gap is solved.
    strip: u64,
    /// Number of imperfect samples.
    samples: u64,
}

impl Parts {
    fn count(case: &Case, measures: &[Measure]) -> Self {
        let has = |measure| u64::from(measures.contains(&measure));
        let places = case.puncture.places.unwrap_or(0) as u64;
        let (punctures, bends) = (has(Measure::Puncture) * (1 + places), has(Measure::Flexure));
        let is_chain = case.flexure.method == Method::Chain;
        let samples = if case.imperfection.is_none() { 0 } else { case.samples.count as u64 };
        let row = case.design.row().ok().filter(|_| bends > 0 && (is_chain || samples > 0));
        let gaps = row.map_or(1, |row| whole_gaps(&row, &case.flexure) as u64);
        // Every path counts as one unit, although paths differ in time: the meter shows fractions
        // only, so only the ratios between designs matter.
        let ideal = 1 + punctures + bends * if is_chain { gaps } else { 1 };
        Self { ideal, row: punctures, strip: bends * gaps, samples }
    }

    fn sum(self) -> u64 {
        self.ideal.saturating_add(self.samples.saturating_mul(self.row + self.strip))
    }
}

/// Returns the expected work of a design solved for `measures`, in paths.
pub(crate) fn work_of(case: &Case, measures: &[Measure]) -> u64 {
    Parts::count(case, measures).sum()
}

/// Counts the work of one design while it is solved.
pub(crate) struct DesignWork<'m> {
    piece: WorkPiece<'m>,
    parts: Parts,
}

impl<'m> DesignWork<'m> {
    /// Creates the count for `case`, with its expected work.
    pub fn new(meter: &'m WorkMeter, case: &Case, measures: &[Measure]) -> Self {
        let parts = Parts::count(case, measures);
        Self { piece: WorkPiece::new(meter, parts.sum()), parts }
    }

    /// Adds the work of an imperfect row.
    pub fn row_done(&self) {
        self.piece.count(self.parts.row);
    }

    /// Adds the work of an imperfect strip.
    pub fn strip_done(&self) {
        self.piece.count(self.parts.strip);
    }
}

#[cfg(test)]
mod tests {
    use sweep::Sweep;

    use super::*;

    fn case(text: &str) -> Case {
        let text = format!("name = 'x'\n[designs]\ngap_over_t = 0.1\nlength_over_t = 0.9\n{text}");
        Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep").grid().case(0)
    }

    #[test]
    fn imperfect_designs_and_load_positions_count_as_more_work() {
        let perfect = case("slant_deg = 0");
        let uneven =
            case("slant_deg = 0\ngap_cv = 0.1\n[imperfection]\nsamples = 7\n[flexure]\ngaps = 50");
        assert_eq!(work_of(&perfect, &[Measure::Coverage]), 1);
        assert_eq!(work_of(&perfect, &Measure::ALL), 3);
        assert_eq!(work_of(&uneven, &Measure::ALL), 3 + 7 * (1 + 50));
        assert_eq!(work_of(&uneven, &[Measure::Puncture]), 2 + 7);
        let places = case("slant_deg = 0\n[puncture]\nplaces = 11");
        assert_eq!(work_of(&places, &[Measure::Puncture]), 1 + 12);
    }

    #[test]
    fn slow_designs_report_their_progress() {
        let text = "name = 'x'\n[designs]\ngap_over_t = 0.1\nlength_over_t = 0.9\nslant_deg = 60";
        let sweep = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
        let (case, number) = (sweep.grid().case(0), sweep.grid().number(0));
        let evaluator = crate::Evaluator::new(&[Measure::Puncture]);
        let messages = Arc::<Mutex<Vec<String>>>::default();
        let collected = Arc::clone(&messages);
        let report = move |text| collected.lock().expect("a lock").push(text);
        report_after(Duration::ZERO, "design 0417", report, || evaluator.solve(number, &case));
        let messages = messages.lock().expect("a lock").join("\n");
        assert!(messages.starts_with("design 0417: 0 s so far, 1 points, at 0.0 %"), "{messages}");
    }

    #[test]
    fn work_is_counted_within_a_design_and_completed_at_its_end() {
        let uneven = case("slant_deg = 0\ngap_cv = 0.1\n[imperfection]\nsamples = 4");
        let meter = WorkMeter::default();
        assert_eq!(meter.completed_fraction(), 0.0);
        meter.begin(2 * work_of(&uneven, &[Measure::Puncture]));
        let work = DesignWork::new(&meter, &uneven, &[Measure::Puncture]);
        work.row_done();
        assert_eq!(meter.completed_fraction(), 1.0 / 12.0);
        work.row_done();
        assert_eq!(meter.completed_fraction(), 2.0 / 12.0);
        drop(work);
        assert_eq!(meter.completed_fraction(), 0.5);
    }
}

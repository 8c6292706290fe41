//! Progress reports of long paths.

use std::cell::RefCell;
use std::time::{Duration, Instant};

/// Progress of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathProgress {
    /// Time since the work began.
    pub elapsed: Duration,
    /// Number of points of the current path.
    pub points: usize,
    /// Control parameter over its target.
    pub fraction: f64,
}

struct Watch {
    begun: Instant,
    due: Duration,
    report: Box<dyn Fn(PathProgress)>,
}

thread_local! {
    // Thread-local rather than an argument of each model: a path stays on its thread, and only the
    // outermost caller wants the reports.
    static WATCH: RefCell<Option<Watch>> = const { RefCell::new(None) };
}

/// Runs `work`, which follows paths on this thread, and reports its progress.
///
/// The first report comes after `patience`, each further one after twice the elapsed time.
pub fn report_progress<T>(
    patience: Duration,
    report: impl Fn(PathProgress) + 'static,
    work: impl FnOnce() -> T,
) -> T {
    let watch = Watch { begun: Instant::now(), due: patience, report: Box::new(report) };
    WATCH.with_borrow_mut(|slot| *slot = Some(watch));
    let done = work();
    WATCH.take();
    done
}

/// Reports the progress of a path if a report is due.
pub(crate) fn report_if_due(points: usize, fraction: f64) {
    WATCH.with_borrow_mut(|slot| {
        let Some(watch) = slot else { return };
        let elapsed = watch.begun.elapsed();
        if elapsed >= watch.due {
            watch.due = elapsed * 2;
            (watch.report)(PathProgress { elapsed, points, fraction });
        }
    });
}

//! Progress reports while a long path is computed.

use std::cell::RefCell;
use std::time::{Duration, Instant};

/// Content of a progress report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathProgress {
    /// Time since [`report_progress`] was called.
    pub elapsed: Duration,
    /// Number of points of the current path.
    pub points: usize,
    /// Control parameter of the current path, divided by its scale.
    pub fraction: f64,
}

/// Schedule and receiver of the reports of a thread.
struct Watch {
    /// Time of the call of [`report_progress`].
    begun: Instant,
    /// Time after `begun` at which the next report is due.
    due: Duration,
    /// Receiver of the reports.
    report: Box<dyn Fn(PathProgress)>,
}

thread_local! {
    // Thread-local, not an argument of each model, because a path stays on its thread and only the
    // outermost caller receives the reports.
    static WATCH: RefCell<Option<Watch>> = const { RefCell::new(None) };
}

/// Runs `work`, which follows paths on this thread, and calls `report` with its progress.
///
/// The first report is due after `patience`. After each report, the next one is due when the
/// elapsed time has doubled.
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

/// Reports the progress of the current path if a report is due.
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

//! How far a path is, told while it is followed.

use std::cell::RefCell;
use std::time::{Duration, Instant};

/// How far work is that takes long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathProgress {
    /// The time since the work began.
    pub elapsed: Duration,
    /// The points of the path in hand.
    pub points: usize,
    /// The control parameter over its target.
    pub share: f64,
}

struct Watch {
    begun: Instant,
    due: Duration,
    tell: Box<dyn Fn(PathProgress)>,
}

thread_local! {
    // Not an argument of each model: whoever waits is above all that solves, and a path stays on its thread.
    static WATCH: RefCell<Option<Watch>> = const { RefCell::new(None) };
}

/// Does `work`, which follows paths on this thread, and tells how far it is once it has taken longer than `patience`, and
/// whenever it has taken twice as long as at the last time.
pub fn report_progress<T>(
    patience: Duration,
    tell: impl Fn(PathProgress) + 'static,
    work: impl FnOnce() -> T,
) -> T {
    let watch = Watch { begun: Instant::now(), due: patience, tell: Box::new(tell) };
    WATCH.with_borrow_mut(|slot| *slot = Some(watch));
    let done = work();
    WATCH.take();
    done
}

/// Tells how far a path is, if it is time to.
pub(crate) fn report_if_due(points: usize, share: f64) {
    WATCH.with_borrow_mut(|slot| {
        let Some(watch) = slot else { return };
        let elapsed = watch.begun.elapsed();
        if elapsed >= watch.due {
            watch.due = elapsed * 2;
            (watch.tell)(PathProgress { elapsed, points, share });
        }
    });
}

//! Ends the paths in progress when the process is asked to end.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};

// One flag for the process rather than an argument of each model: a signal ends all its paths.
static REQUESTED: AtomicBool = AtomicBool::new(false);

thread_local! {
    // A model follows several paths, and only its caller discards the result.
    static INTERRUPTED: Cell<bool> = const { Cell::new(false) };
}

/// Ends all paths of this process at their next steps, for good.
pub fn interrupt_paths() {
    REQUESTED.store(true, Ordering::Relaxed);
}

/// Runs `work`, which follows paths on this thread, and returns its result.
///
/// `None` if a path was interrupted: the result is then meaningless.
pub fn uninterrupted<T>(work: impl FnOnce() -> T) -> Option<T> {
    INTERRUPTED.set(false);
    let done = work();
    (!INTERRUPTED.get()).then_some(done)
}

/// Returns true if the path in progress must end, and marks the work of this thread.
pub(crate) fn is_interrupted() -> bool {
    let is_requested = REQUESTED.load(Ordering::Relaxed);
    if is_requested {
        INTERRUPTED.set(true);
    }
    is_requested
}

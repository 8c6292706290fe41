//! Interruption of the paths in progress, for a process that is about to end.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};

// One flag for the whole process, not an argument of each model, because a signal ends all paths.
static REQUESTED: AtomicBool = AtomicBool::new(false);

thread_local! {
    // True after a path on this thread was interrupted. A model follows several paths, so the
    // function that discards its result, `uninterrupted`, needs this record.
    static INTERRUPTED: Cell<bool> = const { Cell::new(false) };
}

/// Ends all paths of this process at their next step, and every path started later.
pub fn interrupt_paths() {
    REQUESTED.store(true, Ordering::Relaxed);
}

/// Runs `work`, which follows paths on this thread, and returns the result of `work`.
///
/// Returns `None` if a path was interrupted, because the result is then meaningless.
pub fn uninterrupted<T>(work: impl FnOnce() -> T) -> Option<T> {
    INTERRUPTED.set(false);
    let done = work();
    (!INTERRUPTED.get()).then_some(done)
}

/// Returns true if the path in progress must end, and records the interruption for this thread.
pub(crate) fn is_interrupted() -> bool {
    let is_requested = REQUESTED.load(Ordering::Relaxed);
    if is_requested {
        INTERRUPTED.set(true);
    }
    is_requested
}

//! Worker threads that solve designs and can be stopped.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, Scope};

use solver::uninterrupted;

use crate::progress::RunError;

/// Maximum number of results that wait to be written to the journal.
// Enough that workers do not wait for the disk; the memory stays at a few megabytes.
const WAITING: usize = 1024;

/// Solves the designs in `groups` on `threads` threads, and passes each result to `sink`.
///
/// Results arrive in any order. The first error of `sink` ends the work. After `stop` is set,
/// started designs are finished, unless their paths are interrupted. Each thread solves one group
/// at a time, because the designs of a group share springs that are slow to compute. When no group
/// is left, idle threads solve designs from the groups of other threads.
///
/// # Errors
///
/// If a thread cannot be started, or if `sink` returns an error.
pub(crate) fn solve<T: Send>(
    threads: usize,
    stop: &AtomicBool,
    groups: impl Iterator<Item = Vec<u64>> + Send,
    solve: impl Fn(u64) -> T + Sync,
    mut sink: impl FnMut(T) -> Result<(), RunError>,
) -> Result<(), RunError> {
    let abandoned = AtomicBool::new(false);
    let queue = Mutex::new(Queue { groups, open: vec![VecDeque::new(); threads] });
    let next = |worker| {
        let ended = abandoned.load(Ordering::Relaxed) || stop.load(Ordering::Relaxed);
        // A poisoned lock is safe, because every change leaves the queue consistent.
        let mut queue = queue.lock().unwrap_or_else(PoisonError::into_inner);
        if ended { None } else { queue.next(worker) }
    };
    thread::scope(|scope| {
        let (sender, results) = sync_channel(WAITING);
        for worker in 0..threads {
            let (sender, next, solve) = (sender.clone(), &next, &solve);
            // If a thread cannot be started, the other threads must end, because the scope waits
            // for all of them.
            start(scope, move || work(|| next(worker), solve, &sender)).map_err(|error| {
                abandoned.store(true, Ordering::Relaxed);
                RunError::Threads { count: threads, reason: text::reason(&error) }
            })?;
        }
        // The channel must close when the last worker ends.
        drop(sender);
        let taken = results.into_iter().try_for_each(&mut sink);
        abandoned.store(taken.is_err(), Ordering::Relaxed);
        taken
    })
}

fn start<'s>(scope: &'s Scope<'s, '_>, work: impl FnOnce() + Send + 's) -> std::io::Result<()> {
    thread::Builder::new().spawn_scoped(scope, work).map(|_| ())
}

/// Solves designs on one thread until `next` returns `None`, and sends the results.
fn work<T>(next: impl Fn() -> Option<u64>, solve: impl Fn(u64) -> T, sender: &SyncSender<T>) {
    while let Some(design) = next() {
        // A design is interrupted only after `stop` was set, and counts as not solved.
        let Some(solved) = uninterrupted(|| solve(design)) else { return };
        // The receiver is dropped only if `sink` returned an error.
        if sender.send(solved).is_err() {
            return;
        }
    }
}

/// Groups that no worker has taken, and the remaining designs of the group of each worker.
struct Queue<G> {
    groups: G,
    open: Vec<VecDeque<u64>>,
}

impl<G: Iterator<Item = Vec<u64>>> Queue<G> {
    /// Returns the next design for `worker`: from its group, a new group, or the largest other
    /// group.
    fn next(&mut self, worker: usize) -> Option<u64> {
        if self.open[worker].is_empty()
            && let Some(group) = self.groups.next()
        {
            self.open[worker] = group.into();
        }
        // Take own designs from the front and designs of another worker from the back, so that the
        // remaining designs of both workers are neighbours.
        let next = self.open[worker].pop_front();
        next.or_else(|| self.open.iter_mut().max_by_key(|group| group.len())?.pop_back())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicU64;

    use super::*;

    fn groups(count: u64) -> impl Iterator<Item = Vec<u64>> {
        (0..count).map(|group| (6 * group..6 * group + 6).collect())
    }

    /// Returns an error that a sink could return.
    fn full() -> RunError {
        RunError::Threads { count: 0, reason: "full".to_owned() }
    }

    #[test]
    fn every_design_is_solved_once_by_any_number_of_threads() {
        for threads in [1, 2, 8] {
            let stop = AtomicBool::new(false);
            let mut results = Vec::new();
            let sink = |result| {
                results.push(result);
                Ok(())
            };
            solve(threads, &stop, groups(2_000), |design| design * 3, sink).expect("no error");
            results.sort_unstable();
            assert!(results.iter().copied().eq((0..12_000).map(|design| design * 3)));
        }
    }

    #[test]
    fn idle_threads_take_designs_of_other_groups() {
        let mut queue = Queue { groups: groups(1), open: vec![VecDeque::new(); 2] };
        let taken: Vec<_> = [0, 1, 0, 1].into_iter().map(|worker| queue.next(worker)).collect();
        assert_eq!(taken, [Some(0), Some(5), Some(1), Some(4)]);
    }

    #[test]
    fn the_first_error_of_the_sink_ends_the_work() {
        let stop = AtomicBool::new(false);
        let mut left = 10;
        let sink = |_| {
            left -= 1;
            if left == 0 { Err(full()) } else { Ok(()) }
        };
        let error = solve(2, &stop, groups(u64::MAX / 6), |design| design, sink).expect_err("full");
        assert!(error.to_string().contains("full"));
    }

    #[test]
    fn started_designs_are_finished_after_a_stop() {
        let stop = AtomicBool::new(false);
        let begun = AtomicU64::new(0);
        let mut done = 0;
        let begin = |_| begun.fetch_add(1, Ordering::Relaxed);
        solve(2, &stop, groups(u64::MAX / 6), begin, |_| {
            done += 1;
            stop.store(done >= 10, Ordering::Relaxed);
            Ok(())
        })
        .expect("no error");
        assert_eq!(done, begun.load(Ordering::Relaxed));
    }
}

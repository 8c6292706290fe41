//! Parallel work, a bounded number of jobs at a time, that can be told to stop.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;

use rayon::ThreadPool;

/// Jobs that are handed out and not yet done are never more than this, however many there will be.
const WINDOW: usize = 1024;

/// How far ahead of a job its preparation is handed out, so that jobs which share one seldom wait.
const LEAD: usize = 256;

/// What is done for each of many numbers.
pub(crate) struct Jobs<'a, P, S> {
    /// Something slow that later jobs may share.
    pub prepare: P,
    /// The job.
    pub solve: S,
    /// Told from outside to begin no more jobs.
    pub stop: &'a AtomicBool,
}

impl<P: Fn(u64) + Sync, S: Fn(u64) -> T + Sync, T: Send> Jobs<'_, P, S> {
    /// Does the jobs in `pool` and hands each result to `sink` as soon as it is there. The first
    /// error of `sink` ends the work; once told to stop, jobs in hand are finished.
    pub fn run<E>(
        &self,
        pool: &ThreadPool,
        numbers: impl Iterator<Item = u64>,
        mut sink: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let abandoned = AtomicBool::new(false);
        let ended = || abandoned.load(Ordering::Relaxed) || self.stop.load(Ordering::Relaxed);
        let (sender, results) = mpsc::channel();
        pool.in_place_scope_fifo(|scope| {
            let ended = &ended;
            let prepare = |number: u64| {
                scope.spawn_fifo(move |_| {
                    if !ended() {
                        (self.prepare)(number);
                    }
                });
            };
            let launch = |number: u64, sender: mpsc::Sender<T>| {
                scope.spawn_fifo(move |_| {
                    if !ended() {
                        // Nobody listens any more only when the work is abandoned.
                        let _ = sender.send((self.solve)(number));
                    }
                });
            };
            let mut numbers = Ahead { numbers, queue: VecDeque::new() };
            // Dropped with the last job, so that the results end when the jobs have.
            let mut sender = Some(sender);
            let mut hand_out = || match (numbers.next(prepare), &sender) {
                (Some(number), Some(sender)) if !ended() => launch(number, sender.clone()),
                _ => sender = None,
            };
            (0..WINDOW).for_each(|_| hand_out());
            for result in results {
                hand_out();
                if let Err(error) = sink(result) {
                    abandoned.store(true, Ordering::Relaxed);
                    return Err(error);
                }
            }
            Ok(())
        })
    }
}

/// Numbers, each prepared a while before its turn.
struct Ahead<I> {
    numbers: I,
    queue: VecDeque<u64>,
}

impl<I: Iterator<Item = u64>> Ahead<I> {
    fn next(&mut self, prepare: impl Fn(u64)) -> Option<u64> {
        while self.queue.len() < LEAD
            && let Some(number) = self.numbers.next()
        {
            prepare(number);
            self.queue.push_back(number);
        }
        self.queue.pop_front()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pool(threads: usize) -> ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
    }

    #[test]
    fn every_job_is_done_once_by_any_number_of_threads() {
        for threads in [1, 2, 8] {
            let stop = AtomicBool::new(false);
            let jobs = Jobs { prepare: |_| (), solve: |number| number * 3, stop: &stop };
            let mut results = Vec::new();
            let sink = |result| {
                results.push(result);
                Ok::<(), ()>(())
            };
            jobs.run(&pool(threads), 0..10_000, sink).expect("no error");
            results.sort_unstable();
            assert!(results.iter().copied().eq((0..10_000).map(|number| number * 3)));
        }
    }

    #[test]
    fn the_first_error_ends_the_work() {
        let stop = AtomicBool::new(false);
        let jobs = Jobs { prepare: |_| (), solve: |number| number, stop: &stop };
        let mut left = 10;
        let sink = |_| {
            left -= 1;
            if left == 0 { Err("full") } else { Ok(()) }
        };
        assert_eq!(jobs.run(&pool(2), 0..u64::MAX, sink), Err("full"));
    }

    #[test]
    fn who_is_told_to_stop_finishes_what_is_in_hand() {
        let stop = AtomicBool::new(false);
        let begun = std::sync::atomic::AtomicU64::new(0);
        let solve = |_| begun.fetch_add(1, Ordering::Relaxed);
        let jobs = Jobs { prepare: |_| (), solve, stop: &stop };
        let mut done = 0;
        let sink = |_| {
            done += 1;
            stop.store(done >= 10, Ordering::Relaxed);
            Ok::<(), ()>(())
        };
        jobs.run(&pool(2), 0..u64::MAX, sink).expect("no error");
        assert_eq!(done, begun.load(Ordering::Relaxed));
    }
}

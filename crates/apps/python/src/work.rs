//! Work without the interpreter lock, with interrupts and progress.

use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread::{self, available_parallelism};
use std::time::Duration;

use optimisation::SearchProgress;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyBool;
use rayon::{ThreadPool, ThreadPoolBuilder};
use run::{Progress, WorkMeter};

use crate::error::{self, OrFailed as _};

/// Interval between checks for signals and progress reports.
const PAUSE: Duration = Duration::from_millis(50);

/// Maximum time that an interrupted call waits for designs in progress, so that Ctrl-C responds.
const GRACE: Duration = Duration::from_millis(600);

/// The progress of running work.
#[derive(Debug, Default)]
pub struct Watch {
    /// Set to request the end of the work.
    pub stop: AtomicBool,
    /// Number of completed designs.
    pub done: AtomicUsize,
    /// Number of all designs.
    pub all: AtomicUsize,
    /// Progress of a run.
    pub run: WorkMeter,
    /// Progress of a search.
    pub search: SearchProgress,
}

impl Watch {
    /// Updates the counters from the progress of a run.
    pub fn update(&self, progress: Progress) {
        match progress {
            Progress::Begun { designs, done } => {
                self.all.store(designs as usize, Ordering::Relaxed);
                self.done.store(done as usize, Ordering::Relaxed);
            }
            Progress::Done { .. } => {
                self.done.fetch_add(1, Ordering::Relaxed);
            }
        }
    }

    /// Returns the completed fraction and a description.
    fn progress(&self) -> (f64, String) {
        let (part, _, tasks) = self.search.progress();
        if tasks > 0 {
            return (self.search.completed_fraction(), part.description().to_owned());
        }
        let (done, all) = (self.done.load(Ordering::Relaxed), self.all.load(Ordering::Relaxed));
        let fraction = if self.run.completed_fraction() > 0.0 {
            self.run.completed_fraction()
        } else {
            done as f64 / all.max(1) as f64
        };
        (fraction, format!("{done}/{all} designs"))
    }
}

/// The accepted numbers of threads, as for the option `--threads` of the command.
const THREADS: RangeInclusive<usize> = 1..=1024;

/// Returns the whole number `value`, or raises `InvalidParameter` if it is outside of `range`.
pub fn whole(key: &str, value: &Bound<'_, PyAny>, range: RangeInclusive<usize>) -> PyResult<usize> {
    let number = if value.is_instance_of::<PyBool>() { None } else { value.extract().ok() };
    number.filter(|number| range.contains(number)).ok_or_else(|| {
        let expected = format!("a whole number from {} to {}", range.start(), range.end());
        error::invalid_parameter(value.py(), key, Some(value.clone()), &expected)
    })
}

/// Returns the number of threads of the argument `threads`; `None` means one for each core.
pub fn threads(given: Option<&Bound<'_, PyAny>>) -> PyResult<usize> {
    match given {
        Some(given) => whole("threads", given, THREADS),
        None => Ok(available_parallelism().map_or(1, usize::from)),
    }
}

/// Returns the exception of Ctrl-C.
pub fn interrupted() -> PyErr {
    PyKeyboardInterrupt::new_err(())
}

/// Creates a thread pool, for work that does not create its own threads.
pub fn pool(given: Option<&Bound<'_, PyAny>>) -> PyResult<ThreadPool> {
    ThreadPoolBuilder::new().num_threads(threads(given)?).build().or_failed("threads")
}

/// Runs `work` in its own thread, while the calling thread handles signals and reports `progress`.
///
/// Ctrl-C stops the work; a single long design continues in the background until it ends.
pub fn watched<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Bound<'_, PyAny>>,
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let watch = Arc::<Watch>::default();
    let (sender, mut receiver) = sync_channel(1);
    let watched = Arc::clone(&watch);
    thread::Builder::new().spawn(move || {
        // The receiver is gone if the call was interrupted.
        let _ = sender.send(work(&watched));
    })?;
    loop {
        let waiting = &mut receiver;
        match py.detach(move || waiting.recv_timeout(PAUSE)) {
            Ok(done) => return Ok(done),
            // The thread ended without a result, so it panicked.
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err(
                    "internal error of squama; please report the call",
                ));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        let reported =
            progress.as_ref().map_or(Ok(()), |report| report.call1(watch.progress()).map(|_| ()));
        if let Err(interrupted) = py.check_signals().and(reported) {
            watch.stop.store(true, Ordering::Relaxed);
            let _ = py.detach(move || receiver.recv_timeout(GRACE));
            return Err(interrupted);
        }
    }
}

//! Evaluations of points: each solved once, and kept in a journal.

mod journal;

use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use results::{DesignResult, DesignRow, OutputError};
use run::{Evaluator, Program};
use sweep::{DesignNumber, Measure};

use crate::error::OptimisationError;
use crate::goal::DesignGoal;
use crate::space::{DesignSpace, SpacePoint};
pub use journal::EVALUATIONS;
use journal::{EvaluationJournal, JournalLine};

/// Why no more is evaluated.
#[derive(Debug)]
pub(crate) enum Halt {
    /// The process is asked to end.
    Interrupted,
    /// The journal cannot be written.
    Output(OutputError),
}

/// Whether a point is solved with the derivatives of its measures, and which point it is, to the last bit.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct EvaluationKey {
    differentiated: bool,
    shares: Vec<u64>,
    chosen: Vec<usize>,
}

impl EvaluationKey {
    fn of(point: &SpacePoint, differentiated: bool) -> Self {
        let shares = point.shares.iter().map(|share| share.to_bits()).collect();
        Self { differentiated, shares, chosen: point.chosen.clone() }
    }
}

/// Solves points of a space, each once: what an earlier session has solved is read from its journal.
pub(crate) struct Evaluations<'a> {
    space: &'a DesignSpace,
    plain: Evaluator,
    differentiating: Evaluator,
    known: Mutex<HashMap<EvaluationKey, Arc<DesignResult>>>,
    journal: Mutex<EvaluationJournal>,
    stop: &'a AtomicBool,
}

impl<'a> Evaluations<'a> {
    /// The evaluations of `goal` by `program`, with the journal in `folder`.
    pub fn begin(
        goal: &'a DesignGoal,
        folder: &Path,
        start: run::Start,
        program: &Program,
        stop: &'a AtomicBool,
    ) -> Result<Self, OptimisationError> {
        let (journal, lines) = EvaluationJournal::begin(folder, goal.to_toml(), program, start)?;
        let measures: Vec<Measure> = goal.space.sweep().measures().to_vec();
        let measures: Vec<Measure> =
            measures.into_iter().filter(|measure| *measure != Measure::Sensitivity).collect();
        let all = [measures.as_slice(), &[Measure::Sensitivity]].concat();
        let known = lines.into_iter().map(|line| {
            let point = SpacePoint { shares: line.shares, chosen: line.chosen };
            (EvaluationKey::of(&point, line.differentiated), Arc::new(line.result))
        });
        Ok(Self {
            space: &goal.space,
            plain: Evaluator::new(&measures),
            differentiating: Evaluator::new(&all),
            known: Mutex::new(known.collect()),
            journal: Mutex::new(journal),
            stop,
        })
    }

    /// The row of the design at `point`, as number `index` of a table.
    pub fn row(&self, index: u64, point: &SpacePoint, result: &DesignResult) -> DesignRow {
        let number = self.number(index);
        DesignRow { number, case: self.space.case(point), result: result.clone() }
    }

    fn number(&self, index: u64) -> DesignNumber {
        self.space.sweep().grid().number(index)
    }

    /// The result of the design at `point`.
    ///
    /// # Errors
    /// If the process is asked to end, or the journal cannot be written.
    pub fn solve(
        &self,
        point: &SpacePoint,
        differentiated: bool,
    ) -> Result<Arc<DesignResult>, Halt> {
        let key = EvaluationKey::of(point, differentiated);
        if let Some(known) = lock(&self.known).get(&key) {
            return Ok(Arc::clone(known));
        }
        if self.stop.load(Ordering::Relaxed) {
            return Err(Halt::Interrupted);
        }
        let evaluator = if differentiated { &self.differentiating } else { &self.plain };
        let mut result = evaluator.solve(self.number(0), &self.space.case(point)).row.result;
        result.sensitivity.retain(|d| self.space.parameters().any(|p| p.key == d.parameter));
        // Few of the parameters vary, and every result is kept to the end.
        result.sensitivity.shrink_to_fit();
        let line = JournalLine {
            differentiated,
            shares: point.shares.clone(),
            chosen: point.chosen.clone(),
            result,
        };
        lock(&self.journal).append(&line).map_err(Halt::Output)?;
        let result = Arc::new(line.result);
        lock(&self.known).insert(key, Arc::clone(&result));
        Ok(result)
    }

    /// Forces the journal to the disk.
    pub fn sync(&self) -> Result<(), OutputError> {
        lock(&self.journal).sync()
    }

    /// The number of points that were solved, in this session and before.
    pub fn count(&self) -> usize {
        lock(&self.known).len()
    }
}

/// The value behind a mutex; nothing that is done under these locks leaves it half-done.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

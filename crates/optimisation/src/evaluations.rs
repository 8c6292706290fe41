//! Evaluations of points and of samples of their designs: each solved once, and kept in a journal.

mod journal;

use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};
use results::{DesignResult, DesignRow, OutputError};
use run::{Evaluator, Program};
use sweep::{Case, DesignNumber, Measure};
use tolerance::Sampler;

use crate::error::OptimisationError;
use crate::goal::DesignGoal;
use crate::sample::{SampleJudge, Samples};
use crate::space::{DesignSpace, SpacePoint};
use journal::{EvaluationJournal, JournalLine, SkinsLine, SolvedLine};

/// Samples that no search sees: those of `squama tolerance` have numbers from 1 on, and are a test of what a search has chosen.
const BEFORE: u64 = 1 << 32;

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
    /// The number of the sample whose batch it is; `None` of the nominal design.
    sample: Option<u64>,
    point: PointKey,
}

/// A point, to the last bit.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct PointKey {
    shares: Vec<u64>,
    chosen: Vec<usize>,
}

/// A point, and the first and the count of its samples.
type SamplesKey = (PointKey, u64, usize);

impl PointKey {
    fn of(point: &SpacePoint) -> Self {
        let shares = point.shares.iter().map(|share| share.to_bits()).collect();
        Self { shares, chosen: point.chosen.clone() }
    }
}

/// Solves points of a space, each once: what an earlier session has solved is read from its journal.
pub(crate) struct Evaluations<'a> {
    space: &'a DesignSpace,
    plain: Evaluator,
    differentiating: Evaluator,
    sampler: Sampler,
    known: Mutex<HashMap<EvaluationKey, Arc<DesignResult>>>,
    sampled: Mutex<HashMap<SamplesKey, Arc<Samples>>>,
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
        let mut evaluations = Self {
            space: &goal.space,
            plain: Evaluator::new(&measures),
            differentiating: Evaluator::new(&all),
            sampler: Sampler::new(&measures, goal.space.sweep().deviations()),
            known: Mutex::default(),
            sampled: Mutex::default(),
            journal: Mutex::new(journal),
            stop,
        };
        for line in lines {
            evaluations.recall(line);
        }
        Ok(evaluations)
    }

    /// Takes what a line of the journal holds as solved.
    fn recall(&mut self, line: JournalLine) {
        match line {
            JournalLine::Solved(line) => {
                let SolvedLine { differentiated, skin: sample, shares, chosen, result } = *line;
                let point = PointKey::of(&SpacePoint { shares, chosen });
                let key = EvaluationKey { differentiated, sample, point };
                lock(&self.known).insert(key, Arc::new(result));
            }
            JournalLine::Skins(SkinsLine { first, shares, chosen, values }) => {
                let key = (PointKey::of(&SpacePoint { shares, chosen }), first, values.len());
                lock(&self.sampled).insert(key, Arc::new(Samples(values)));
            }
        }
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
        let evaluator = if differentiated { &self.differentiating } else { &self.plain };
        self.known_or(point, differentiated, None, &self.space.case(point), evaluator)
    }

    /// As [`Self::solve`] with derivatives, of the sample of that number, but for its scatter from scale to scale; `None` if there is no
    /// such sample.
    pub fn even_sample(
        &self,
        point: &SpacePoint,
        sample: u64,
    ) -> Result<Option<Arc<DesignResult>>, Halt> {
        let case = self.even_case(&self.space.case(point), sample);
        let solved =
            case.map(|case| self.known_or(point, true, Some(sample), &case, &self.differentiating));
        solved.transpose()
    }

    /// The case of the sample of that number of the design of `nominal`, but for its scatter from scale to scale.
    pub fn even_case(&self, nominal: &Case, sample: u64) -> Option<Case> {
        self.sampler.even_case(nominal, BEFORE + sample)
    }

    /// The result of a case that belongs to a point, solved if it is not known.
    fn known_or(
        &self,
        point: &SpacePoint,
        differentiated: bool,
        sample: Option<u64>,
        case: &Case,
        evaluator: &Evaluator,
    ) -> Result<Arc<DesignResult>, Halt> {
        let key = EvaluationKey { differentiated, sample, point: PointKey::of(point) };
        if let Some(known) = lock(&self.known).get(&key) {
            return Ok(Arc::clone(known));
        }
        self.go_on()?;
        let mut result = evaluator.solve(self.number(0), case).row.result;
        // Where material varies, a sample with another thickness or modulus moves in other parameters, too.
        let has_material = self.space.parameters().any(|p| p.section == "material");
        let is_variable = |key| self.space.parameters().any(|p| p.key == key);
        let moves_more = sample.is_some() && has_material;
        result.sensitivity.retain(|d| moves_more || is_variable(d.parameter));
        // Few of the parameters vary, and every result is kept to the end.
        result.sensitivity.shrink_to_fit();
        let SpacePoint { shares, chosen } = point.clone();
        let line = SolvedLine { differentiated, skin: sample, shares, chosen, result };
        lock(&self.journal).append(&line).map_err(Halt::Output)?;
        let result = Arc::new(line.result);
        lock(&self.known).insert(key, Arc::clone(&result));
        Ok(result)
    }

    /// The values by which `judge` judges `count` samples of the design at `point`, from number `first` on, solved in parallel.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn samples(
        &self,
        point: &SpacePoint,
        first: u64,
        count: usize,
        judge: &SampleJudge,
    ) -> Result<Arc<Samples>, Halt> {
        let key = (PointKey::of(point), first, count);
        if let Some(known) = lock(&self.sampled).get(&key) {
            return Ok(Arc::clone(known));
        }
        let (case, last) = (self.space.case(point), first + count as u64);
        let values = (first..last).into_par_iter().map(|sample| {
            self.go_on()?;
            let sampled = self.sampler.solve(self.number(0), &case, BEFORE + sample);
            Ok(sampled.map_or_else(|| judge.no_values(), |sampled| judge.values(&sampled.row)))
        });
        let values: Vec<Vec<Option<f64>>> = values.collect::<Result<_, Halt>>()?;
        let SpacePoint { shares, chosen } = point.clone();
        let line = SkinsLine { first, shares, chosen, values };
        lock(&self.journal).append(&line).map_err(Halt::Output)?;
        let samples = Arc::new(Samples(line.values));
        lock(&self.sampled).insert(key, Arc::clone(&samples));
        Ok(samples)
    }

    /// Refuses to go on once the process is asked to end.
    fn go_on(&self) -> Result<(), Halt> {
        if self.stop.load(Ordering::Relaxed) { Err(Halt::Interrupted) } else { Ok(()) }
    }

    /// Forces the journal to the disk.
    pub fn sync(&self) -> Result<(), OutputError> {
        lock(&self.journal).sync()
    }

    /// The number of points that were solved, in this session and before, and of samples.
    pub fn count(&self) -> usize {
        let samples: usize = lock(&self.sampled).values().map(|samples| samples.0.len()).sum();
        lock(&self.known).len() + samples
    }
}

/// The value behind a mutex; nothing that is done under these locks leaves it half-done.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

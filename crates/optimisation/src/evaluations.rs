//! Evaluations of points and of skins made of their designs: each solved once, and kept in a journal.

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
use crate::made::{MadeJudge, Skins};
use crate::space::{DesignSpace, SpacePoint};
use journal::{EvaluationJournal, JournalLine, SkinsLine, SolvedLine};

/// Skins that no search sees: those that `squama tolerance` makes have numbers from 1 on, and are a test of what a search has chosen.
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
    /// The number of the skin whose batch it is; `None` of the design as it is drawn.
    skin: Option<u64>,
    point: PointKey,
}

/// A point, to the last bit.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct PointKey {
    shares: Vec<u64>,
    chosen: Vec<usize>,
}

/// A point, and the first and the count of its skins.
type SkinsKey = (PointKey, u64, usize);

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
    made: Mutex<HashMap<SkinsKey, Arc<Skins>>>,
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
            made: Mutex::default(),
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
                let SolvedLine { differentiated, skin, shares, chosen, result } = *line;
                let point = PointKey::of(&SpacePoint { shares, chosen });
                let key = EvaluationKey { differentiated, skin, point };
                lock(&self.known).insert(key, Arc::new(result));
            }
            JournalLine::Skins(SkinsLine { first, shares, chosen, values }) => {
                let key = (PointKey::of(&SpacePoint { shares, chosen }), first, values.len());
                lock(&self.made).insert(key, Arc::new(Skins(values)));
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

    /// As [`Self::solve`] with derivatives, of the skin of that number that is made of the design, but for its scatter from scale
    /// to scale; `None` if there is no such skin.
    pub fn even_skin(
        &self,
        point: &SpacePoint,
        skin: u64,
    ) -> Result<Option<Arc<DesignResult>>, Halt> {
        let case = self.even_case(&self.space.case(point), skin);
        let solved =
            case.map(|case| self.known_or(point, true, Some(skin), &case, &self.differentiating));
        solved.transpose()
    }

    /// The case of the skin of that number that is made of the design of `drawn`, but for its scatter from scale to scale.
    pub fn even_case(&self, drawn: &Case, skin: u64) -> Option<Case> {
        self.sampler.even_case(drawn, BEFORE + skin)
    }

    /// The result of a case that belongs to a point, solved if it is not known.
    fn known_or(
        &self,
        point: &SpacePoint,
        differentiated: bool,
        skin: Option<u64>,
        case: &Case,
        evaluator: &Evaluator,
    ) -> Result<Arc<DesignResult>, Halt> {
        let key = EvaluationKey { differentiated, skin, point: PointKey::of(point) };
        if let Some(known) = lock(&self.known).get(&key) {
            return Ok(Arc::clone(known));
        }
        self.go_on()?;
        let mut result = evaluator.solve(self.number(0), case).row.result;
        // Where material varies, a skin with another thickness or modulus moves in other parameters, too.
        let has_material = self.space.parameters().any(|p| p.section == "material");
        let is_variable = |key| self.space.parameters().any(|p| p.key == key);
        let moves_more = skin.is_some() && has_material;
        result.sensitivity.retain(|d| moves_more || is_variable(d.parameter));
        // Few of the parameters vary, and every result is kept to the end.
        result.sensitivity.shrink_to_fit();
        let SpacePoint { shares, chosen } = point.clone();
        let solved = result.clone();
        let line = SolvedLine { differentiated, skin, shares, chosen, result: solved };
        let line = JournalLine::Solved(Box::new(line));
        lock(&self.journal).append(line).map_err(Halt::Output)?;
        let result = Arc::new(result);
        lock(&self.known).insert(key, Arc::clone(&result));
        Ok(result)
    }

    /// The values by which `made` judges `count` skins of the design at `point`, from number `first` on, solved in parallel.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn skins(
        &self,
        point: &SpacePoint,
        first: u64,
        count: usize,
        made: &MadeJudge,
    ) -> Result<Arc<Skins>, Halt> {
        let key = (PointKey::of(point), first, count);
        if let Some(known) = lock(&self.made).get(&key) {
            return Ok(Arc::clone(known));
        }
        let (case, last) = (self.space.case(point), first + count as u64);
        let none = vec![None; made.bounds.len() + made.columns.len()];
        let values = (first..last).into_par_iter().map(|skin| {
            self.go_on()?;
            let skin = self.sampler.solve(self.number(0), &case, BEFORE + skin);
            Ok(skin.map_or_else(|| none.clone(), |skin| made.values(&skin.row)))
        });
        let values: Vec<Vec<Option<f64>>> = values.collect::<Result<_, Halt>>()?;
        let SpacePoint { shares, chosen } = point.clone();
        let line = SkinsLine { first, shares, chosen, values: values.clone() };
        lock(&self.journal).append(JournalLine::Skins(line)).map_err(Halt::Output)?;
        let skins = Arc::new(Skins(values));
        lock(&self.made).insert(key, Arc::clone(&skins));
        Ok(skins)
    }

    /// Refuses to go on once the process is asked to end.
    fn go_on(&self) -> Result<(), Halt> {
        if self.stop.load(Ordering::Relaxed) { Err(Halt::Interrupted) } else { Ok(()) }
    }

    /// Forces the journal to the disk.
    pub fn sync(&self) -> Result<(), OutputError> {
        lock(&self.journal).sync()
    }

    /// The number of points that were solved, in this session and before, and of skins.
    pub fn count(&self) -> usize {
        let skins: usize = lock(&self.made).values().map(|skins| skins.0.len()).sum();
        lock(&self.known).len() + skins
    }
}

/// The value behind a mutex; nothing that is done under these locks leaves it half-done.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

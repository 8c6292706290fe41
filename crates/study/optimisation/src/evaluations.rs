//! Evaluates points and samples; each is solved once and kept in a journal.

mod evaluation_journal;

use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use journal::Journal;
use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};
use results::{DesignResult, DesignRow, OutputError, changed_parameters, neighbours};
use run::{Evaluator, Program, PunctureEnd, uninterrupted};
use sweep::{Case, DesignNumber, Measure, Parameter};
use uncertainty::Sampler;

use crate::error::OptimisationError;
use crate::goal::DesignGoal;
use crate::progress::SearchProgress;
use crate::sample::{SampleJudge, Samples};
use crate::space::{DesignSpace, SpacePoint};
use evaluation_journal::{EvaluationKey, FarLine, JournalLine, PointKey, SamplesLine, SolvedLine};
pub(crate) use evaluation_journal::{Known, Positions, read_journal};

/// Offset of sample numbers in a search.
///
/// `squama tolerance` uses numbers from 1, which remain independent of the search.
const BEFORE: u64 = 1 << 32;

/// Largest critical tilt, degrees, up to which corners represent all load positions.
///
/// In 1,089 random designs with a critical tilt up to this limit, the weakest of eleven positions
/// was a corner. With a critical tilt of 30°, positions between the corners are weaker in some
/// designs, and a search by corners ended at such a design.
const MOST_TILT: f64 = 10.0;

/// Number of load positions if only the corners are solved.
const CORNERS: usize = 2;

/// Reason to stop evaluating.
#[derive(Debug)]
pub(crate) enum Halt {
    /// A stop was requested.
    Interrupted,
    /// The journal cannot be written.
    Output(OutputError),
    /// A gradient search no longer moves.
    Stalled,
}

/// A point, and the load positions of its puncture.
type EndKey = (PointKey, Positions);

/// Solves each point of a space once, and stores the results in a journal.
///
/// Results of earlier sessions are read from it.
pub(crate) struct Evaluations<'a> {
    space: &'a DesignSpace,
    plain: Evaluator,
    differentiating: Evaluator,
    /// Solves reported designs with all measures.
    reporting: Evaluator,
    sampler: Sampler,
    /// Ends of punctures followed from rest, for similar designs.
    ends: Mutex<HashMap<EndKey, Option<PunctureEnd>>>,
    journal: Mutex<Journal<Known>>,
    stop: &'a AtomicBool,
    progress: &'a SearchProgress,
}

impl<'a> Evaluations<'a> {
    /// Opens the journal in `folder` for the evaluations of `goal`.
    pub fn begin(
        goal: &'a DesignGoal,
        folder: &Path,
        start: run::Start,
        program: &Program,
        (stop, progress): (&'a AtomicBool, &'a SearchProgress),
    ) -> Result<Self, OptimisationError> {
        let journal = evaluation_journal::begin(folder, goal.to_toml(), program, start)?;
        let measures = goal.space.sweep().plain_measures();
        let all = [measures.as_slice(), &[Measure::Sensitivity]].concat();
        let sampling = Evaluator::for_columns(&measures, goal.measured_columns());
        let deviations = goal.space.sweep().deviations();
        Ok(Self {
            space: &goal.space,
            plain: Evaluator::for_columns(&measures, goal.measured_columns()),
            differentiating: Evaluator::for_columns(&all, goal.measured_columns()),
            reporting: Evaluator::new(&measures),
            sampler: Sampler::with(sampling, deviations),
            ends: Mutex::default(),
            journal: Mutex::new(journal),
            stop,
            progress,
        })
    }

    /// Returns the intervals that only scale columns in physical units, not measures.
    pub fn scaling_intervals(&self) -> Vec<usize> {
        self.space.scaling_intervals()
    }

    /// Returns the common representative of points that differ by scaling only.
    ///
    /// These points share one result.
    fn unscaled(&self, point: &SpacePoint) -> SpacePoint {
        let mut unscaled = point.clone();
        for j in self.scaling_intervals() {
            // Any constant would do: points that differ only by scaling get the same key.
            unscaled.shares[j] = 0.0;
        }
        unscaled
    }

    /// Returns the row of the design at `point`, as number `index` of a table.
    pub fn row(&self, index: u64, point: &SpacePoint, result: &DesignResult) -> DesignRow {
        let number = self.number(index);
        DesignRow { number, case: self.space.case(point), result: result.clone() }
    }

    /// Solves the design at `point` with all measures, for a table.
    ///
    /// # Errors
    ///
    /// If a stop was requested.
    pub fn reported_row(&self, point: &SpacePoint) -> Result<DesignRow, Halt> {
        let case = self.space.case(&self.unscaled(point));
        let row = self.solved(|| self.reporting.row(self.number(0), &case))?;
        Ok(self.row(0, point, &row.result))
    }

    fn number(&self, index: u64) -> DesignNumber {
        self.space.sweep().grid().number(index)
    }

    /// Returns the load positions by which a search compares the design at `point` with others.
    ///
    /// If the goal requests several positions, the weakest one is a corner of the top as long as
    /// the critical tilt is small. A search then compares designs by both corners.
    pub fn compared_positions(&self, point: &SpacePoint) -> Positions {
        let puncture = self.space.case(point).punctured();
        let is_at_corner = puncture.places.is_some_and(|places| places > CORNERS)
            && puncture.critical_tilt_deg <= MOST_TILT
            && self.has_ends(point);
        if is_at_corner { Positions::Corners } else { Positions::All }
    }

    /// Returns the case at `point`, with the puncture at these load positions.
    fn case_with(&self, point: &SpacePoint, positions: Positions) -> Case {
        let mut case = self.space.case(point);
        if positions == Positions::Corners {
            case.puncture.places = Some(CORNERS);
        }
        case
    }

    /// Solves the design at `point` from rest, or returns its known result.
    ///
    /// # Errors
    ///
    /// If a stop was requested, or the journal cannot be written.
    pub fn solve(
        &self,
        point: &SpacePoint,
        differentiated: bool,
        positions: Positions,
    ) -> Result<Arc<DesignResult>, Halt> {
        let point = self.unscaled(point);
        let case = self.case_with(&point, positions);
        let changed = differentiated.then(|| self.changed(&case));
        self.known_or(&point, changed.as_deref(), None, &case, positions)
    }

    /// Solves the design at `point` from the end of the puncture at the point `near`.
    ///
    /// `None` if its path must be followed from rest. See [`Self::solve`].
    pub fn solve_near(
        &self,
        point: &SpacePoint,
        differentiated: bool,
        near: &SpacePoint,
        positions: Positions,
    ) -> Result<Option<Arc<DesignResult>>, Halt> {
        let [point, near] = [point, near].map(|point| self.unscaled(point));
        let key = EvaluationKey {
            differentiated,
            positions,
            near: Some(PointKey::of(&near)),
            sample: None,
            point: PointKey::of(&point),
        };
        if let Some(known) = self.journal().records().solved.get(&key) {
            return Ok(Some(Arc::clone(known)));
        }
        if self.journal().records().is_far(&key) {
            return Ok(None);
        }
        self.go_on()?;
        let case = self.case_with(&point, positions);
        let evaluator = if differentiated { &self.differentiating } else { &self.plain };
        let changed = if differentiated { self.changed(&case) } else { Vec::new() };
        let row = uninterrupted(|| {
            let end = self.end(&near, positions)?;
            evaluator.row_near(self.number(0), &case, &changed, &end)
        });
        let row = row.ok_or(Halt::Interrupted)?;
        let SpacePoint { shares, chosen } = point;
        let mut journal = self.journal();
        let Some(row) = row else {
            let line = FarLine { shares, near: near.shares, chosen };
            journal.append(JournalLine::Far(line)).map_err(Halt::Output)?;
            return Ok(None);
        };
        let (near, sample, result) = (Some(near.shares), None, row.result);
        let line = SolvedLine { differentiated, positions, near, sample, shares, chosen, result };
        journal.append(JournalLine::Solved(Box::new(line))).map_err(Halt::Output)?;
        Ok(Some(Arc::clone(&journal.records().solved[&key])))
    }

    /// Returns true if the design at `point` may be solved from the end of a similar one.
    pub fn has_ends(&self, point: &SpacePoint) -> bool {
        self.plain.has_ends(&self.space.case(point))
    }

    /// Returns the end of the puncture at `point`, which is followed if it is unknown.
    fn end(&self, point: &SpacePoint, positions: Positions) -> Option<PunctureEnd> {
        let key = (PointKey::of(point), positions);
        if let Some(known) = self.ends().get(&key) {
            return known.clone();
        }
        // After a restart the journal provides the result of this point, but not its path end.
        let end = self.plain.puncture_end(&self.case_with(point, positions));
        self.ends().insert(key, end.clone());
        end
    }

    /// Locks the ends.
    ///
    /// A poisoned lock is safe, because no operation under it leaves partial state.
    fn ends(&self) -> MutexGuard<'_, HashMap<EndKey, Option<PunctureEnd>>> {
        self.ends.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the parameters that the variables change.
    fn changed(&self, case: &Case) -> Vec<&'static Parameter> {
        let mut changed = Vec::new();
        for interval in self.space.intervals() {
            changed.extend(DesignRow::changed_by(case, interval.parameter));
        }
        changed
    }

    /// Solves a sample with derivatives, without scatter between scales.
    ///
    /// `None` if the sample does not exist. See [`Self::solve`].
    pub fn even_sample(
        &self,
        point: &SpacePoint,
        sample: u64,
    ) -> Result<Option<Arc<DesignResult>>, Halt> {
        let nominal = self.space.case(point);
        let Some(case) = self.even_case(&nominal, sample) else { return Ok(None) };
        // Deviations move with the variables: a modulus that varies changes the ratio of moduli.
        let mut changed = Vec::new();
        for interval in self.space.intervals() {
            for moved in neighbours(&nominal, interval.parameter) {
                let moved = self.even_case(&moved, sample);
                changed.extend(moved.iter().flat_map(|to| changed_parameters(&case, to)));
            }
        }
        self.known_or(point, Some(&changed), Some(sample), &case, Positions::All).map(Some)
    }

    /// Returns the case of a sample of `nominal`, without scatter between scales.
    pub fn even_case(&self, nominal: &Case, sample: u64) -> Option<Case> {
        self.sampler.even_case(nominal, BEFORE + sample)
    }

    /// Returns the result of a case, and solves it from rest if it is unknown.
    ///
    /// `changed` lists the parameters of the derivatives, if the result has any.
    fn known_or(
        &self,
        point: &SpacePoint,
        changed: Option<&[&'static Parameter]>,
        sample: Option<u64>,
        case: &Case,
        positions: Positions,
    ) -> Result<Arc<DesignResult>, Halt> {
        // Results with and without derivatives are separate, because derivatives cost more and are
        // often unnecessary.
        let differentiated = changed.is_some();
        let (near, of_point) = (None, PointKey::of(point));
        let key = EvaluationKey { differentiated, positions, near, sample, point: of_point };
        if let Some(known) = self.journal().records().solved.get(&key) {
            return Ok(Arc::clone(known));
        }
        self.go_on()?;
        // Solved without the lock: two threads may solve the same point and append the same line.
        let evaluator = if differentiated { &self.differentiating } else { &self.plain };
        let mut end = None;
        let result = self.solved(|| {
            let (row, found) = evaluator.row_and_end(self.number(0), case, changed);
            end = found;
            row
        });
        let result = result?.result;
        if sample.is_none() {
            self.ends().insert((PointKey::of(point), positions), end);
        }
        let SpacePoint { shares, chosen } = point.clone();
        let near = None;
        let line = SolvedLine { differentiated, positions, near, sample, shares, chosen, result };
        let mut journal = self.journal();
        journal.append(JournalLine::Solved(Box::new(line))).map_err(Halt::Output)?;
        Ok(Arc::clone(&journal.records().solved[&key]))
    }

    /// Solves a design, and reports it if it is slow.
    fn solved(&self, solve: impl FnOnce() -> DesignRow) -> Result<DesignRow, Halt> {
        let row = uninterrupted(|| self.progress.slow().track("a design of the search", solve));
        row.ok_or(Halt::Interrupted)
    }

    /// Returns the values of samples of the design at `point`.
    ///
    /// `count` samples from number `first` are solved in parallel.
    ///
    /// # Errors
    ///
    /// See [`Self::solve`].
    pub fn samples(
        &self,
        point: &SpacePoint,
        first: u64,
        count: usize,
        judge: &SampleJudge,
    ) -> Result<Arc<Samples>, Halt> {
        // Samples of a scaled design differ, so do not use `unscaled`.
        let key = (PointKey::of(point), first, count);
        if let Some(known) = self.journal().records().sampled.get(&key) {
            return Ok(Arc::clone(known));
        }
        let (case, last) = (self.space.case(point), first + count as u64);
        let end =
            self.has_ends(point).then(|| self.end(&self.unscaled(point), Positions::All)).flatten();
        let values = (first..last).into_par_iter().map(|sample| {
            self.go_on()?;
            let (number, sample) = (self.number(0), BEFORE + sample);
            let sampled = uninterrupted(|| {
                self.progress.slow().track("a sample of the search", || {
                    self.sampler.solve_near(number, &case, sample, end.as_ref())
                })
            });
            let sampled = sampled.ok_or(Halt::Interrupted)?;
            Ok(sampled.map_or_else(|| judge.no_values(), |sampled| judge.values(&sampled.row)))
        });
        let values: Vec<Vec<Option<f64>>> = values.collect::<Result<_, Halt>>()?;
        let SpacePoint { shares, chosen } = point.clone();
        let line = SamplesLine { first, shares, chosen, values: Samples(values) };
        let mut journal = self.journal();
        journal.append(JournalLine::Samples(line)).map_err(Halt::Output)?;
        Ok(Arc::clone(&journal.records().sampled[&key]))
    }

    /// Returns an error once a stop was requested.
    fn go_on(&self) -> Result<(), Halt> {
        if self.stop.load(Ordering::Relaxed) { Err(Halt::Interrupted) } else { Ok(()) }
    }

    /// Writes the journal to disk.
    pub fn sync(&self) -> Result<(), OutputError> {
        self.journal().sync()
    }

    /// Returns the number of solved points and samples, of this and earlier sessions.
    pub fn count(&self) -> usize {
        let journal = self.journal();
        let known = journal.records();
        let samples: usize = known.sampled.values().map(|samples| samples.0.len()).sum();
        known.solved.len() + samples
    }

    /// Locks the journal.
    ///
    /// A poisoned lock is safe, because no operation under it leaves partial state.
    fn journal(&self) -> MutexGuard<'_, Journal<Known>> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

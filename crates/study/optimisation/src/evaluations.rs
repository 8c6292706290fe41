//! Solves points and samples, and stores the results in a journal, so that none is solved twice.

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
pub(crate) use evaluation_journal::{JournalContent, Positions, read_journal};

/// Offset of the sample numbers in a search.
///
/// `squama tolerance` uses numbers from 1, so its samples are independent of samples of the search.
const SAMPLE_OFFSET: u64 = 1 << 32;

/// Largest critical tilt, degrees, up to which corners represent all load positions.
///
/// In 1,089 random designs with a critical tilt up to this limit, the weakest of eleven positions
/// was a corner. With a critical tilt of 30°, the weakest position of some designs lies between the
/// corners, and a search that solved only the corners returned such a design.
const MAX_CORNER_TILT_DEG: f64 = 10.0;

/// Number of load positions if only the corners are solved.
const CORNERS: usize = 2;

/// Reason to stop evaluating.
#[derive(Debug)]
pub(crate) enum Halt {
    /// The user requested a stop.
    Interrupted,
    /// The journal cannot be written.
    Output(OutputError),
    /// The steps of a gradient search became too small.
    Stalled,
}

/// Key of a path end: the point, and the load positions of its puncture.
type EndKey = (PointKey, Positions);

/// Solves points of a space and their samples, and stores the results in a journal.
///
/// Results of earlier sessions are read from the journal.
pub(crate) struct Evaluations<'a> {
    space: &'a DesignSpace,
    plain: Evaluator,
    differentiating: Evaluator,
    /// Evaluator for reported designs, with all columns.
    reporting: Evaluator,
    sampler: Sampler,
    /// Ends of puncture paths that were followed from rest.
    ///
    /// Paths of similar designs can start at these ends. `None` if an end is not suitable.
    ends: Mutex<HashMap<EndKey, Option<PunctureEnd>>>,
    journal: Mutex<Journal<JournalContent>>,
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

    /// Returns the indices of the intervals that only change the scale of physical columns.
    ///
    /// The parameters of these intervals do not change dimensionless measures.
    pub fn scaling_intervals(&self) -> Vec<usize> {
        self.space.scaling_intervals()
    }

    /// Returns `point` with the fraction 0 for each scaling interval.
    ///
    /// Points that differ only in scaling intervals share one result, which is stored at this
    /// point.
    fn unscaled(&self, point: &SpacePoint) -> SpacePoint {
        let mut unscaled = point.clone();
        for j in self.scaling_intervals() {
            // Any constant is suitable, because the result does not depend on this variable.
            unscaled.fractions[j] = 0.0;
        }
        unscaled
    }

    /// Returns `result` as a row: the design at `point` with the number `index`.
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

    /// Returns the design number with this index.
    fn number(&self, index: u64) -> DesignNumber {
        self.space.sweep().grid().number(index)
    }

    /// Returns the load positions at which the design at `point` is compared with other designs.
    ///
    /// If the goal requests several positions, the weakest one is a corner of the top as long as
    /// the critical tilt is small. A search then compares designs by both corners.
    pub fn compared_positions(&self, point: &SpacePoint) -> Positions {
        let case = self.space.case(point);
        let is_at_corner = case.puncture.places.is_some_and(|places| places > CORNERS)
            && case.punctured().critical_tilt_deg <= MAX_CORNER_TILT_DEG
            && self.plain.has_ends(&case);
        if is_at_corner { Positions::Corners } else { Positions::All }
    }

    /// Returns the case of the design at `point`, punctured at the load positions `positions`.
    fn case_with(&self, point: &SpacePoint, positions: Positions) -> Case {
        let mut case = self.space.case(point);
        if positions == Positions::Corners {
            case.puncture.places = Some(CORNERS);
        }
        case
    }

    /// Solves the design at `point` from rest, or returns its stored result.
    ///
    /// `differentiated` requests derivatives with respect to the variables.
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

    /// Solves the design at `point`, starting from the end of the puncture path at `near`.
    ///
    /// `near` is the point of a similar design. Returns `None` if the path of the design must be
    /// followed from rest. See [`Self::solve`] for `differentiated` and errors.
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
        let SpacePoint { fractions, chosen } = point;
        let mut journal = self.journal();
        let Some(row) = row else {
            let line = FarLine { fractions, near: near.fractions, chosen };
            journal.append(JournalLine::Far(line)).map_err(Halt::Output)?;
            return Ok(None);
        };
        let (near, sample, result) = (Some(near.fractions), None, row.result);
        let line =
            SolvedLine { differentiated, positions, near, sample, fractions, chosen, result };
        journal.append(JournalLine::Solved(Box::new(line))).map_err(Halt::Output)?;
        Ok(Some(Arc::clone(&journal.records().solved[&key])))
    }

    /// Returns true if the design at `point` may be solved from the path end of a similar design.
    pub fn has_ends(&self, point: &SpacePoint) -> bool {
        self.plain.has_ends(&self.space.case(point))
    }

    /// Returns the end of the puncture path at `point`. An unknown path is followed from rest.
    ///
    /// `None` if similar designs cannot start from this end.
    fn end(&self, point: &SpacePoint, positions: Positions) -> Option<PunctureEnd> {
        let key = (PointKey::of(point), positions);
        if let Some(known) = self.ends().get(&key) {
            return known.clone();
        }
        // In a resumed search the journal contains the result of this point, but not its path end.
        let end = self.plain.puncture_end(&self.case_with(point, positions));
        self.ends().insert(key, end.clone());
        end
    }

    /// Locks the path ends.
    ///
    /// If another thread panicked while it held the lock, the data are still consistent.
    fn ends(&self) -> MutexGuard<'_, HashMap<EndKey, Option<PunctureEnd>>> {
        self.ends.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the parameters of `case` that change with the continuous variables.
    fn changed(&self, case: &Case) -> Vec<&'static Parameter> {
        let mut changed = Vec::new();
        for interval in self.space.intervals() {
            changed.extend(DesignRow::changed_by(case, interval.parameter));
        }
        changed
    }

    /// Solves sample number `sample` of the design at `point` with derivatives.
    ///
    /// The sample has batch deviations only, without scatter between scales. `None` if no
    /// deviations within the bounds of the parameters are found. See [`Self::solve`] for errors.
    pub fn even_sample(
        &self,
        point: &SpacePoint,
        sample: u64,
    ) -> Result<Option<Arc<DesignResult>>, Halt> {
        let nominal = self.space.case(point);
        let Some(case) = self.even_case(&nominal, sample) else { return Ok(None) };
        // A variable may change several parameters of the sample. For example, a modulus also
        // changes the ratio of moduli.
        let mut changed = Vec::new();
        for interval in self.space.intervals() {
            for moved in neighbours(&nominal, interval.parameter) {
                let moved = self.even_case(&moved, sample);
                changed.extend(moved.iter().flat_map(|to| changed_parameters(&case, to)));
            }
        }
        self.known_or(point, Some(&changed), Some(sample), &case, Positions::All).map(Some)
    }

    /// Returns the case of a sample of `nominal` without scatter between scales.
    ///
    /// `None` if no deviations within the bounds of the parameters are found.
    pub fn even_case(&self, nominal: &Case, sample: u64) -> Option<Case> {
        self.sampler.even_case(nominal, SAMPLE_OFFSET + sample)
    }

    /// Returns the stored result of `case`, or solves it from rest.
    ///
    /// `case` is the design at `point`, or sample number `sample` of this design. `changed` are the
    /// parameters of the requested derivatives; `None` for a result without derivatives.
    fn known_or(
        &self,
        point: &SpacePoint,
        changed: Option<&[&'static Parameter]>,
        sample: Option<u64>,
        case: &Case,
        positions: Positions,
    ) -> Result<Arc<DesignResult>, Halt> {
        // Results with and without derivatives are stored separately, because derivatives are
        // expensive and often unnecessary.
        let differentiated = changed.is_some();
        let (near, of_point) = (None, PointKey::of(point));
        let key = EvaluationKey { differentiated, positions, near, sample, point: of_point };
        if let Some(known) = self.journal().records().solved.get(&key) {
            return Ok(Arc::clone(known));
        }
        self.go_on()?;
        // The journal is not locked while the design is solved. So two threads may solve one point
        // and append equal lines, which is harmless.
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
        let SpacePoint { fractions, chosen } = point.clone();
        let near = None;
        let line =
            SolvedLine { differentiated, positions, near, sample, fractions, chosen, result };
        let mut journal = self.journal();
        journal.append(JournalLine::Solved(Box::new(line))).map_err(Halt::Output)?;
        Ok(Arc::clone(&journal.records().solved[&key]))
    }

    /// Calls `solve` to solve a design. The progress display reports the design if it is slow.
    fn solved(&self, solve: impl FnOnce() -> DesignRow) -> Result<DesignRow, Halt> {
        let row = uninterrupted(|| self.progress.slow().track("a design of the search", solve));
        row.ok_or(Halt::Interrupted)
    }

    /// Returns the values of samples `first` to `first + count − 1` of the design at `point`.
    ///
    /// Samples that are not stored are solved in parallel. `judge` selects the columns.
    ///
    /// # Errors
    ///
    /// If a stop was requested, or the journal cannot be written.
    pub fn samples(
        &self,
        point: &SpacePoint,
        first: u64,
        count: usize,
        judge: &SampleJudge,
    ) -> Result<Arc<Samples>, Halt> {
        // Do not use `unscaled`: samples of points that differ only by scaling are different.
        let key = (PointKey::of(point), first, count);
        if let Some(known) = self.journal().records().sampled.get(&key) {
            return Ok(Arc::clone(known));
        }
        let (case, last) = (self.space.case(point), first + count as u64);
        let end =
            self.has_ends(point).then(|| self.end(&self.unscaled(point), Positions::All)).flatten();
        let values = (first..last).into_par_iter().map(|sample| {
            self.go_on()?;
            let (number, sample) = (self.number(0), SAMPLE_OFFSET + sample);
            let sampled = uninterrupted(|| {
                self.progress.slow().track("a sample of the search", || {
                    self.sampler.solve_near(number, &case, sample, end.as_ref())
                })
            });
            let sampled = sampled.ok_or(Halt::Interrupted)?;
            Ok(sampled.map_or_else(|| judge.no_values(), |sampled| judge.values(&sampled.row)))
        });
        let values: Vec<Vec<Option<f64>>> = values.collect::<Result<_, Halt>>()?;
        let SpacePoint { fractions, chosen } = point.clone();
        let line = SamplesLine { first, fractions, chosen, values: Samples(values) };
        let mut journal = self.journal();
        journal.append(JournalLine::Samples(line)).map_err(Halt::Output)?;
        Ok(Arc::clone(&journal.records().sampled[&key]))
    }

    /// Returns an error if a stop was requested.
    fn go_on(&self) -> Result<(), Halt> {
        if self.stop.load(Ordering::Relaxed) { Err(Halt::Interrupted) } else { Ok(()) }
    }

    /// Flushes the journal to the disk.
    pub fn sync(&self) -> Result<(), OutputError> {
        self.journal().sync()
    }

    /// Returns the number of solved points and samples in this session and earlier sessions.
    pub fn count(&self) -> usize {
        let journal = self.journal();
        let known = journal.records();
        let samples: usize = known.sampled.values().map(|samples| samples.0.len()).sum();
        known.solved.len() + samples
    }

    /// Locks the journal.
    ///
    /// If another thread panicked while it held the lock, the data are still consistent.
    fn journal(&self) -> MutexGuard<'_, Journal<JournalContent>> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

//! Journal of a search, with one line for each solved point or set of samples.
//!
//! The state of the search is not stored. A resumed search repeats its decisions, and reads results
//! from the journal until it reaches points that have not been solved.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use journal::{Journal, JournalError, Records, lock_journal};
use results::{Claim, DesignResult, Maker, ResultsFolder};
use run::{JournalHeader, Program, Start};
use serde::{Deserialize, Serialize};
use sweep::Subset;

use crate::error::OptimisationError;
use crate::sample::Samples;
use crate::space::SpacePoint;

/// A line of the journal after the header.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum JournalLine {
    Solved(Box<SolvedLine>),
    Samples(SamplesLine),
    Far(FarLine),
}

/// Load positions at which a search solves a design, if the goal requests several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Positions {
    /// The requested positions.
    #[default]
    All,
    /// The left and the right corner of the top.
    Corners,
}

impl Positions {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
    fn is_all(&self) -> bool {
        *self == Self::All
    }
}

/// A solved point.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SolvedLine {
    /// True if the result includes derivatives.
    pub differentiated: bool,
    /// Load positions of the puncture.
    #[serde(default, skip_serializing_if = "Positions::is_all")]
    pub positions: Positions,
    /// Fractions of the intervals of a similar design, if the puncture starts from its end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near: Option<Vec<f64>>,
    /// Number of the sample; `None` for the nominal design.
    ///
    /// The sample has the batch deviations only, without scatter between scales.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<u64>,
    /// Fractions of the intervals.
    pub shares: Vec<f64>,
    /// Indices of the choices.
    pub chosen: Vec<usize>,
    /// Result of the design.
    pub result: DesignResult,
}

/// A point that cannot be solved from the path end at another point.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FarLine {
    /// Fractions of the intervals.
    pub shares: Vec<f64>,
    /// Fractions of the intervals at the other point.
    pub near: Vec<f64>,
    /// Indices of the choices, equal at both points.
    pub chosen: Vec<usize>,
}

/// Samples of the design at a point.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SamplesLine {
    /// Number of the first sample.
    pub first: u64,
    /// Fractions of the intervals.
    pub shares: Vec<f64>,
    /// Indices of the choices.
    pub chosen: Vec<usize>,
    /// Values of each sample in the columns by which it is judged.
    pub values: Samples,
}

/// Identifies a solved point.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct EvaluationKey {
    pub differentiated: bool,
    pub positions: Positions,
    /// Point of a similar design, if the puncture starts from its end.
    pub near: Option<PointKey>,
    /// Number of the sample; `None` for the nominal design.
    pub sample: Option<u64>,
    pub point: PointKey,
}

/// Identifies a point by the bits of its fractions.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct PointKey {
    shares: Vec<u64>,
    chosen: Vec<usize>,
}

/// A point, the number of its first sample and the count.
type SamplesKey = (PointKey, u64, usize);

impl PointKey {
    pub fn of(point: &SpacePoint) -> Self {
        Self::new(&point.shares, &point.chosen)
    }

    fn new(shares: &[f64], chosen: &[usize]) -> Self {
        // Exact, because a repeated search requests exactly the same points.
        let shares = shares.iter().map(|share| share.to_bits()).collect();
        Self { shares, chosen: chosen.to_vec() }
    }
}

/// Results in the journal.
pub(crate) struct Known {
    header: JournalHeader,
    pub solved: HashMap<EvaluationKey, Arc<DesignResult>>,
    /// Points of nominal designs in the order in which they were solved, each once.
    pub order: Vec<(SpacePoint, Arc<DesignResult>)>,
    points: HashSet<PointKey>,
    /// Pairs of points: the first one cannot be solved from the path end at the second one.
    far: HashSet<[PointKey; 2]>,
    pub sampled: HashMap<SamplesKey, Arc<Samples>>,
}

impl Known {
    /// Returns true if a point is known to be too far from the path end at another point.
    pub fn is_far(&self, key: &EvaluationKey) -> bool {
        let near = key.near.as_ref();
        near.is_some_and(|near| self.far.contains(&[key.point.clone(), near.clone()]))
    }
}

impl Records for Known {
    type Line = JournalLine;

    type Designs = Subset;

    const KEY: &'static str = "optimisation";

    fn begin(header: JournalHeader, _length: u64, _path: &Path) -> Result<Self, String> {
        let (solved, sampled) = (HashMap::new(), HashMap::new());
        let (points, far) = (HashSet::new(), HashSet::new());
        Ok(Self { header, solved, order: Vec::new(), points, far, sampled })
    }

    fn take(&mut self, line: JournalLine, _bytes: Range<u64>) -> Result<(), String> {
        match line {
            JournalLine::Solved(line) => {
                let SolvedLine { differentiated, positions, near, sample, shares, chosen, result } =
                    *line;
                let point = SpacePoint { shares, chosen };
                let of_point = PointKey::of(&point);
                let near = near.map(|shares| PointKey::new(&shares, &point.chosen));
                let result = Arc::new(result);
                let key = EvaluationKey {
                    differentiated,
                    positions,
                    near,
                    sample,
                    point: of_point.clone(),
                };
                self.solved.insert(key, Arc::clone(&result));
                // The journal may contain several results of one point: with and without
                // derivatives, solved from rest or from a neighbouring end. List the point once.
                if sample.is_none() && self.points.insert(of_point) {
                    self.order.push((point, result));
                }
            }
            JournalLine::Far(FarLine { shares, near, chosen }) => {
                self.far.insert([shares, near].map(|shares| PointKey::new(&shares, &chosen)));
            }
            JournalLine::Samples(SamplesLine { first, shares, chosen, values }) => {
                let point = PointKey::of(&SpacePoint { shares, chosen });
                self.sampled.insert((point, first, values.0.len()), Arc::new(values));
            }
        }
        Ok(())
    }

    fn header(&self) -> &JournalHeader {
        &self.header
    }

    fn is_empty(&self) -> bool {
        self.solved.is_empty() && self.sampled.is_empty()
    }
}

/// Reads the journal at `path` without a lock; a search may be writing to it.
///
/// Returns `None` if the first line is incomplete.
pub(crate) fn read_journal(path: &Path) -> Result<Option<Known>, JournalError> {
    journal::read(path)
}

/// Opens the journal in `folder` for the search of `goal`.
pub(super) fn begin(
    folder: &Path,
    goal: &str,
    program: &Program,
    start: Start,
) -> Result<Journal<Known>, OptimisationError> {
    let folder = ResultsFolder::new(folder);
    folder.require_own(Maker::Search, start)?;
    // Refuse existing files that have the names of results but were not written by a search: one of
    // them may be the goal itself.
    Claim::check(&folder, Maker::Search)?;
    folder.make()?;
    let path = folder.file(ResultsFolder::EVALUATIONS);
    if start == Start::Fresh {
        // Remove the tables before the journal. Otherwise a kill in between would leave the optimum
        // of one goal beside the journal of another.
        let _alone = lock_journal(&path)?;
        Claim::release(&folder, Maker::Search);
    }
    let header = JournalHeader::new(goal.to_owned(), Subset::default(), program);
    Ok(Journal::begin(&path, header, start)?)
}

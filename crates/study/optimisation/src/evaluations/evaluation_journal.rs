//! Journal of a search, with one line for each solved point or set of samples.
//!
//! The state of the search is not stored. A resumed search starts again and makes the same
//! decisions, but reads results from the journal until it reaches points without a stored result.

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

/// Content of a line of the journal after the header.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum JournalLine {
    /// A solved point.
    Solved(Box<SolvedLine>),
    /// Values of consecutive samples of the design at a point of the design space.
    Samples(SamplesLine),
    /// A pair of points: the first point cannot be solved from the path end at the second point.
    Far(FarLine),
}

/// Load positions at which a search solves a design, if the goal requests several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Positions {
    /// All load positions that the goal requests.
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

/// Result of a solved point.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SolvedLine {
    /// True if the result includes derivatives.
    pub differentiated: bool,
    /// Load positions of the puncture.
    #[serde(default, skip_serializing_if = "Positions::is_all")]
    pub positions: Positions,
    /// Continuous variables of the similar design from which the path started.
    ///
    /// The path started at the end of the puncture path of this design. The values are fractions of
    /// the intervals of the variables. `None` for a path from rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near: Option<Vec<f64>>,
    /// Number of the sample; `None` for the nominal design.
    ///
    /// The sample has only batch deviations, without scatter between scales.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<u64>,
    /// Values of the continuous variables, as fractions of their intervals.
    #[serde(rename = "shares")]
    pub fractions: Vec<f64>,
    /// Index of the value of each discrete variable.
    pub chosen: Vec<usize>,
    /// Result of the design or sample.
    pub result: DesignResult,
}

/// Pair of points: the first point cannot be solved from the path end at the second point.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FarLine {
    /// Continuous variables at the first point, as fractions of their intervals.
    #[serde(rename = "shares")]
    pub fractions: Vec<f64>,
    /// Continuous variables at the second point, as fractions of their intervals.
    pub near: Vec<f64>,
    /// Index of the value of each discrete variable, equal at both points.
    pub chosen: Vec<usize>,
}

/// Values of consecutive samples of the design at a point.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SamplesLine {
    /// Number of the first sample.
    pub first: u64,
    /// Values of the continuous variables, as fractions of their intervals.
    #[serde(rename = "shares")]
    pub fractions: Vec<f64>,
    /// Index of the value of each discrete variable.
    pub chosen: Vec<usize>,
    /// Values of each sample in the columns that the goal needs.
    pub values: Samples,
}

/// Key that identifies the result of a solved point.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct EvaluationKey {
    /// True if the result includes derivatives.
    pub differentiated: bool,
    pub positions: Positions,
    /// Point of the similar design. The solution started from the path end of this design.
    ///
    /// `None` if the path was followed from rest.
    pub near: Option<PointKey>,
    /// Number of the sample; `None` for the nominal design.
    pub sample: Option<u64>,
    pub point: PointKey,
}

/// Key that identifies a point: the bits of its fractions, and the indices of its choices.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct PointKey {
    fractions: Vec<u64>,
    chosen: Vec<usize>,
}

/// Key of samples: the point, the number of the first sample, and the number of samples.
type SamplesKey = (PointKey, u64, usize);

impl PointKey {
    /// Returns the key of `point`.
    pub fn of(point: &SpacePoint) -> Self {
        Self::new(&point.fractions, &point.chosen)
    }

    fn new(fractions: &[f64], chosen: &[usize]) -> Self {
        // No tolerance is needed: a resumed search requests exactly the same points.
        let fractions = fractions.iter().map(|fraction| fraction.to_bits()).collect();
        Self { fractions, chosen: chosen.to_vec() }
    }
}

/// Content of the journal: results of points and samples.
pub(crate) struct JournalContent {
    header: JournalHeader,
    pub solved: HashMap<EvaluationKey, Arc<DesignResult>>,
    /// Nominal designs in the order in which they were solved; each point is listed once.
    pub order: Vec<(SpacePoint, Arc<DesignResult>)>,
    /// Keys of the points in `order`.
    points: HashSet<PointKey>,
    /// Pairs of points: the first point cannot be solved from the path end at the second point.
    far: HashSet<[PointKey; 2]>,
    pub sampled: HashMap<SamplesKey, Arc<Samples>>,
}

impl JournalContent {
    /// Returns true if the point in `key` cannot be solved from the path end at `key.near`.
    pub fn is_far(&self, key: &EvaluationKey) -> bool {
        let near = key.near.as_ref();
        near.is_some_and(|near| self.far.contains(&[key.point.clone(), near.clone()]))
    }
}

impl Records for JournalContent {
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
                let SolvedLine {
                    differentiated,
                    positions,
                    near,
                    sample,
                    fractions,
                    chosen,
                    result,
                } = *line;
                let point = SpacePoint { fractions, chosen };
                let of_point = PointKey::of(&point);
                let near = near.map(|fractions| PointKey::new(&fractions, &point.chosen));
                let result = Arc::new(result);
                let key = EvaluationKey {
                    differentiated,
                    positions,
                    near,
                    sample,
                    point: of_point.clone(),
                };
                self.solved.insert(key, Arc::clone(&result));
                // The journal may contain several results of one point: with or without
                // derivatives, from rest or from another path end. List the point only once.
                if sample.is_none() && self.points.insert(of_point) {
                    self.order.push((point, result));
                }
            }
            JournalLine::Far(FarLine { fractions, near, chosen }) => {
                self.far
                    .insert([fractions, near].map(|fractions| PointKey::new(&fractions, &chosen)));
            }
            JournalLine::Samples(SamplesLine { first, fractions, chosen, values }) => {
                let point = PointKey::of(&SpacePoint { fractions, chosen });
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

/// Reads the journal at `path` without a lock, so a search may be writing to it.
///
/// Returns `None` if the first line is incomplete.
pub(crate) fn read_journal(path: &Path) -> Result<Option<JournalContent>, JournalError> {
    journal::read(path)
}

/// Creates or continues the journal of a search in `folder`.
///
/// `goal` is the goal in TOML.
pub(super) fn begin(
    folder: &Path,
    goal: &str,
    program: &Program,
    start: Start,
) -> Result<Journal<JournalContent>, OptimisationError> {
    let folder = ResultsFolder::new(folder);
    folder.require_own(Maker::Search, start)?;
    // Refuse a folder with files that have the names of results but were not written by a search.
    // Such a file may be the goal itself.
    Claim::check(&folder, Maker::Search)?;
    folder.make()?;
    let path = folder.file(ResultsFolder::EVALUATIONS);
    if start == Start::Fresh {
        // Remove the tables before the journal. If the process is killed in between, the folder
        // never contains tables of one goal and the journal of another.
        let _alone = lock_journal(&path)?;
        Claim::release(&folder, Maker::Search);
    }
    let header = JournalHeader::new(goal.to_owned(), Subset::default(), program);
    Ok(Journal::begin(&path, header, start)?)
}

//! The journal of an optimisation: every point that was solved, a line each.
//!
//! The search itself is not written down: it does the same again, and finds what it asks for in the journal until it comes to
//! points that nobody has solved yet.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use journal::{Journal, Records, lock_journal};
use results::{Claim, DesignResult, Maker, ResultsFolder};
use run::{JournalHeader, Program, Start};
use serde::{Deserialize, Serialize};
use sweep::Subset;

use crate::error::OptimisationError;
use crate::sample::Samples;
use crate::space::SpacePoint;

/// A line of the journal behind the first.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum JournalLine {
    Solved(Box<SolvedLine>),
    Samples(SamplesLine),
}

/// A point that was solved.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SolvedLine {
    /// Whether its measures have derivatives.
    pub differentiated: bool,
    /// The number of the sample of its design, with the deviations of the batch; none of the nominal design.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<u64>,
    /// Shares of the intervals.
    pub shares: Vec<f64>,
    /// Indices of the choices.
    pub chosen: Vec<usize>,
    /// The result.
    pub result: DesignResult,
}

/// Samples of the design of a point.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SamplesLine {
    /// The number of the first sample.
    pub first: u64,
    /// Shares of the intervals.
    pub shares: Vec<f64>,
    /// Indices of the choices.
    pub chosen: Vec<usize>,
    /// The values of each sample in the columns that it is judged by.
    pub values: Samples,
}

/// Whether a point is solved with the derivatives of its measures, and which point it is, to the last bit.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct EvaluationKey {
    pub differentiated: bool,
    /// The number of the sample whose batch it is; `None` of the nominal design.
    pub sample: Option<u64>,
    pub point: PointKey,
}

/// A point, to the last bit.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct PointKey {
    shares: Vec<u64>,
    chosen: Vec<usize>,
}

/// A point, and the first and the count of its samples.
type SamplesKey = (PointKey, u64, usize);

impl PointKey {
    pub fn of(point: &SpacePoint) -> Self {
        // No tolerance: a search that is done again asks for the very same points.
        let shares = point.shares.iter().map(|share| share.to_bits()).collect();
        Self { shares, chosen: point.chosen.clone() }
    }
}

/// What was solved.
pub(super) struct Known {
    header: JournalHeader,
    pub solved: HashMap<EvaluationKey, Arc<DesignResult>>,
    pub sampled: HashMap<SamplesKey, Arc<Samples>>,
}

impl Records for Known {
    type Line = JournalLine;

    type Designs = Subset;

    const KEY: &'static str = "optimisation";

    fn begin(header: JournalHeader, _length: u64, _path: &Path) -> Result<Self, String> {
        Ok(Self { header, solved: HashMap::new(), sampled: HashMap::new() })
    }

    fn take(&mut self, line: JournalLine, _bytes: Range<u64>) -> Result<(), String> {
        match line {
            JournalLine::Solved(line) => {
                let SolvedLine { differentiated, sample, shares, chosen, result } = *line;
                let point = PointKey::of(&SpacePoint { shares, chosen });
                let key = EvaluationKey { differentiated, sample, point };
                self.solved.insert(key, Arc::new(result));
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

/// The journal in `folder` of the search for `goal`.
pub(super) fn begin(
    folder: &Path,
    goal: &str,
    program: &Program,
    start: Start,
) -> Result<Journal<Known>, OptimisationError> {
    let folder = ResultsFolder::new(folder);
    folder.require_own(Maker::Search, start)?;
    // A file of our names that no search has written here may be the very goal that is searched for.
    Claim::check(&folder, Maker::Search)?;
    folder.make()?;
    let path = folder.file(ResultsFolder::EVALUATIONS);
    if start == Start::Fresh {
        // Before the old journal goes: a kill in between would leave the optimum of one goal beside the journal of another.
        let _alone = lock_journal(&path)?;
        Claim::release(&folder, Maker::Search);
    }
    let header = JournalHeader::new(goal.to_owned(), Subset::default(), program);
    Ok(Journal::begin(&path, header, start)?)
}

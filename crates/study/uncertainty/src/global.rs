//! Global sensitivity: variance contributions of all variables to every measure.

use std::sync::atomic::AtomicBool;

use results::columns::parameter_of;
use run::{Evaluator, Program, uninterrupted};
use sweep::{Case, Sweep};
use text::number;

use crate::analysis::header;
use crate::analysis_error::AnalysisError;
use crate::draw;
use crate::measured_columns::MeasuredColumns;
use crate::sample_store::{SampleStore, SolvedSample};
use crate::sampled_spread::SampledSpread;
use crate::sobol::{Evaluation, SobolIndices, sobol_indices};

/// File label of the samples.
const LABEL: &str = "global";

/// Global sensitivity analysis of the variables of a sweep.
pub struct GlobalAnalysis<'a> {
    /// Sweep with one design and with variables.
    pub sweep: &'a Sweep,
    /// Number of samples, each with two points more than the number of variables.
    pub samples: usize,
    /// Set to stop the analysis.
    pub stop: &'a AtomicBool,
    /// Program that runs the analysis.
    pub program: Program,
}

/// Sobol' indices of all measures that depend on the variables.
#[derive(Clone, Debug)]
pub struct GlobalSensitivity {
    /// Keys of the variables.
    pub variables: Vec<&'static str>,
    /// Indices of each measure that varies.
    pub measures: Vec<MeasureIndices>,
    /// Column names of the measures that are constant.
    pub constant: Vec<String>,
}

/// Sobol' indices of one measure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureIndices {
    /// Column name.
    pub name: String,
    /// Standard deviation over the box of variables.
    pub spread: f64,
    /// Indices of each variable.
    pub indices: Vec<SobolIndices>,
    /// Number of samples with all values.
    pub samples: usize,
    /// Number of samples with a missing value, which are excluded.
    pub failed: usize,
}

impl GlobalAnalysis<'_> {
    /// Computes the indices of all measures.
    ///
    /// Reads the samples found in `store`, and stores newly solved ones there.
    ///
    /// # Errors
    ///
    /// After `stop`, or if samples cannot be read or written.
    pub fn solve(&self, store: &SampleStore) -> Result<GlobalSensitivity, AnalysisError> {
        let evaluator = Evaluator::new(self.sweep.measures());
        let (number, case) = (self.sweep.grid().number(0), self.sweep.grid().case(0));
        // Only used to find columns with text.
        let middle = uninterrupted(|| evaluator.row(number, &case));
        let middle = middle.ok_or(AnalysisError::Stopped { done: 0, of: self.samples })?;
        let measured = MeasuredColumns::of(self.sweep, &middle);
        let names: Vec<String> = measured.iter().map(|column| column.name.to_string()).collect();
        let points = self.points();
        let columns: Vec<String> = points
            .iter()
            .flat_map(|p| names.iter().map(move |name| format!("{name} {p}")))
            .collect();
        let label = (LABEL, header(self.program, self.sweep));
        let samples = store.samples(label, &columns, self.samples, self.stop, |sample| {
            points
                .iter()
                .flat_map(|point| {
                    let row = evaluator.row(number, &self.case(&case, sample, point));
                    measured.values(&row)
                })
                .collect()
        })?;
        let measures =
            names.iter().cloned().enumerate().filter(|(_, name)| parameter_of(name).is_none());
        let (mut varied, mut constant) = (Vec::new(), Vec::new());
        for (k, name) in measures {
            if is_constant(k, names.len(), &samples) {
                constant.push(name);
            } else {
                varied.extend(indices(name, k, names.len(), &samples));
            }
        }
        let variables = self.sweep.variables().iter().map(|v| v.parameter().key).collect();
        Ok(GlobalSensitivity { variables, measures: varied, constant })
    }

    /// Returns the names of the points of a sample.
    ///
    /// They are `A`, `B`, and `A` with the key of the variable taken from `B`.
    fn points(&self) -> Vec<String> {
        let mixed = self.sweep.variables().iter().map(|v| format!("A {}", v.parameter().key));
        ["A".to_owned(), "B".to_owned()].into_iter().chain(mixed).collect()
    }

    /// Returns the case at a point of a sample.
    fn case(&self, base: &Case, sample: u64, point: &str) -> Case {
        let mut case = *base;
        for variable in self.sweep.variables() {
            let key = variable.parameter().key;
            let from =
                if point == "B" || point.strip_prefix("A ") == Some(key) { "B" } else { "A" };
            // Seeded by point and key: adding a variable does not change the values of the others.
            let share = draw::uniform(base, sample, &format!("{from} {key}"));
            variable.set(&mut case, variable.at(share));
        }
        case
    }
}

/// Returns true if column `k` has the same value at all points up to round-off.
fn is_constant(k: usize, columns: usize, samples: &[SolvedSample]) -> bool {
    let points = samples.iter().flat_map(|sample| sample.values.chunks(columns));
    let mut values = points.filter_map(|point| point[k]);
    values.next().is_some_and(|first| values.all(|value| number::same(value, first)))
}

/// Computes the indices of column `k`.
///
/// `None` if it is constant or has too few values.
fn indices(
    name: String,
    k: usize,
    columns: usize,
    samples: &[SolvedSample],
) -> Option<MeasureIndices> {
    let evaluations = samples.iter().filter_map(|sample| {
        let values: Option<Vec<f64>> =
            sample.values.chunks(columns).map(|point| point[k]).collect();
        // Exclude samples with a missing point: an index compares the points of a sample.
        let values = values?;
        let [first, second, mixed @ ..] = values.as_slice() else { return None };
        Some(Evaluation { first: *first, second: *second, mixed: mixed.to_vec() })
    });
    let whole: Vec<Evaluation> = evaluations.collect();
    let indices = sobol_indices(&whole)?;
    let both: Vec<f64> = whole.iter().flat_map(|e| [e.first, e.second]).collect();
    let spread = SampledSpread::of(&both)?.spread;
    let (solved, failed) = (whole.len(), samples.len() - whole.len());
    Some(MeasureIndices { name, spread, indices, samples: solved, failed })
}

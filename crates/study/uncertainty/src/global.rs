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

/// First part of the file names of the samples.
const LABEL: &str = "global";

/// Global sensitivity analysis of the variables of a sweep.
pub struct GlobalAnalysis<'a> {
    /// Sweep with one design and with variables.
    pub sweep: &'a Sweep,
    /// Number of samples. For `n` variables each sample has `n + 2` points.
    pub samples: usize,
    /// Flag that another thread sets to `true` to stop the analysis.
    pub stop: &'a AtomicBool,
    /// Version of the program, recorded in the journal of the samples.
    pub program: Program,
}

/// Sobol' indices of all measures that depend on the variables.
#[derive(Clone, Debug)]
pub struct GlobalSensitivity {
    /// Keys of the variables.
    pub variables: Vec<&'static str>,
    /// Indices of each measure that varies within the ranges of the variables.
    pub measures: Vec<MeasureIndices>,
    /// Column names of the measures that are constant within the ranges of the variables.
    pub constant: Vec<String>,
}

/// Sobol' indices of one measure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureIndices {
    /// Column name.
    pub name: String,
    /// Standard deviation of the measure over the ranges of the variables.
    pub spread: f64,
    /// Indices of each variable, in the order of [`GlobalSensitivity::variables`].
    pub indices: Vec<SobolIndices>,
    /// Number of samples with a value of the measure at every point.
    pub samples: usize,
    /// Number of samples that lack a value at some point; they are excluded.
    pub failed: usize,
}

impl GlobalAnalysis<'_> {
    /// Computes the indices of all measures.
    ///
    /// Samples that `store` already contains are read; missing samples are solved and stored.
    ///
    /// # Errors
    ///
    /// If `stop` is set, or samples cannot be read or written.
    pub fn solve(&self, store: &SampleStore) -> Result<GlobalSensitivity, AnalysisError> {
        let evaluator = Evaluator::new(self.sweep.measures());
        let (number, case) = (self.sweep.grid().number(0), self.sweep.grid().case(0));
        // Solve one design only to find the columns that contain text.
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

    /// Returns the names of the points of a sample: `A`, `B`, and `A key` for each variable.
    ///
    /// Point `A key` is point `A` with the variable `key` taken from `B`.
    fn points(&self) -> Vec<String> {
        let mixed = self.sweep.variables().iter().map(|v| format!("A {}", v.parameter().key));
        ["A".to_owned(), "B".to_owned()].into_iter().chain(mixed).collect()
    }

    /// Returns `base` with the variables at a point of sample number `sample`.
    ///
    /// `point` is one of the names that [`Self::points`] returns.
    fn case(&self, base: &Case, sample: u64, point: &str) -> Case {
        let mut case = *base;
        for variable in self.sweep.variables() {
            let key = variable.parameter().key;
            let from =
                if point == "B" || point.strip_prefix("A ") == Some(key) { "B" } else { "A" };
            // The random number depends on the key, so a new variable does not change the values of
            // other variables.
            let share = draw::uniform(base, sample, &format!("{from} {key}"));
            variable.set(&mut case, variable.at(share));
        }
        case
    }
}

/// Returns true if all known values of column `k` agree up to round-off.
///
/// `samples` hold `columns` values for each point. The result is false if no value is known.
fn is_constant(k: usize, columns: usize, samples: &[SolvedSample]) -> bool {
    let points = samples.iter().flat_map(|sample| sample.values.chunks(columns));
    let mut values = points.filter_map(|point| point[k]);
    values.next().is_some_and(|first| values.all(|value| number::same(value, first)))
}

/// Computes the Sobol' indices of column `k`, named `name`.
///
/// `samples` hold `columns` values for each point. Returns `None` if the column is constant, or if
/// fewer than two samples have all values.
fn indices(
    name: String,
    k: usize,
    columns: usize,
    samples: &[SolvedSample],
) -> Option<MeasureIndices> {
    let evaluations = samples.iter().filter_map(|sample| {
        let values: Option<Vec<f64>> =
            sample.values.chunks(columns).map(|point| point[k]).collect();
        // An index compares the points of a sample, so exclude samples that lack a value.
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

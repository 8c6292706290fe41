//! Global sensitivity: the parts that the variables of a definition have in the variance of every measure.

use std::sync::atomic::AtomicBool;

use results::columns::parameter_of;
use run::{Evaluator, Program};
use sweep::{Case, Sweep};

use crate::analysis::header;
use crate::analysis_error::AnalysisError;
use crate::draw;
use crate::measured_columns::MeasuredColumns;
use crate::sample_store::{SampleStore, SolvedSample};
use crate::sampled_spread::SampledSpread;
use crate::sobol::{Evaluation, SobolIndices, sobol_indices};

/// The label under which the samples are kept.
const LABEL: &str = "global";

/// The global sensitivity of the design whose variables a sweep has.
pub struct GlobalAnalysis<'a> {
    /// The sweep, of one design but for its variables.
    pub sweep: &'a Sweep,
    /// Samples; each is solved at as many points as there are variables, and two more.
    pub samples: usize,
    /// Set once the work is to stop.
    pub stop: &'a AtomicBool,
    /// The program that does it.
    pub program: Program,
}

/// The parts of the variables in every measure that they change.
#[derive(Clone, Debug)]
pub struct GlobalSensitivity {
    /// Keys of the variables.
    pub variables: Vec<&'static str>,
    /// The measures.
    pub measures: Vec<MeasureIndices>,
}

/// The parts of the variables in one measure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureIndices {
    /// Name of its column.
    pub name: String,
    /// Standard deviation over the box.
    pub spread: f64,
    /// The indices of each variable.
    pub indices: Vec<SobolIndices>,
    /// Samples that have all their values.
    pub samples: usize,
    /// Samples that lack a value, which are left out.
    pub failed: usize,
}

impl GlobalAnalysis<'_> {
    /// The indices of all measures. Samples are taken from `store` as far as they are there, and kept there.
    ///
    /// # Errors
    /// If the work is to stop, or the disk does not take the samples.
    pub fn solve(&self, store: &SampleStore) -> Result<GlobalSensitivity, AnalysisError> {
        let evaluator = Evaluator::new(self.sweep.measures());
        let (number, case) = (self.sweep.grid().number(0), self.sweep.grid().case(0));
        // Tells which columns hold text; its values are not used.
        let middle = evaluator.row(number, &case);
        let measured = MeasuredColumns::of(self.sweep, &middle);
        let names: Vec<String> = measured.iter().map(|column| column.name.to_string()).collect();
        let points = self.points();
        let columns: Vec<String> = points
            .iter()
            .flat_map(|p| names.iter().map(move |name| format!("{name} {p}")))
            .collect();
        let solve = |sample: u64| {
            let point = |point: &String| {
                let row = evaluator.row(number, &self.case(&case, sample, point));
                measured.values(&row)
            };
            points.iter().flat_map(point).collect()
        };
        let label = (LABEL, header(self.program, self.sweep));
        let samples = store.samples(label, &columns, self.samples, self.stop, solve)?;
        let is_measure = |(_, name): &(usize, String)| parameter_of(name).is_none();
        let measures = names.iter().cloned().enumerate().filter(is_measure);
        let measures = measures.filter_map(|(k, name)| indices(name, k, names.len(), &samples));
        let variables = self.sweep.variables().iter().map(|v| v.parameter().key).collect();
        Ok(GlobalSensitivity { variables, measures: measures.collect() })
    }

    /// The points of a sample: `A`, `B`, and `A` with one variable of `B`, by its key.
    fn points(&self) -> Vec<String> {
        let mixed = self.sweep.variables().iter().map(|v| format!("A {}", v.parameter().key));
        ["A".to_owned(), "B".to_owned()].into_iter().chain(mixed).collect()
    }

    /// The case at a point of a sample.
    fn case(&self, base: &Case, sample: u64, point: &str) -> Case {
        let mut case = *base;
        for variable in self.sweep.variables() {
            let key = variable.parameter().key;
            let from =
                if point == "B" || point.strip_prefix("A ") == Some(key) { "B" } else { "A" };
            // By point and key: one variable more changes the points of no other.
            let share = draw::share(base, sample, &format!("{from} {key}"));
            variable.set(&mut case, variable.at(share));
        }
        case
    }
}

/// The indices of column `k` of `columns`; `None` if it is constant or has hardly any values.
fn indices(
    name: String,
    k: usize,
    columns: usize,
    samples: &[SolvedSample],
) -> Option<MeasureIndices> {
    let evaluation = |sample: &SolvedSample| {
        let values: Option<Vec<f64>> =
            sample.values.chunks(columns).map(|point| point[k]).collect();
        // All points of a sample or none: indices compare them with each other.
        let values = values?;
        let [first, second, mixed @ ..] = values.as_slice() else { return None };
        Some(Evaluation { first: *first, second: *second, mixed: mixed.to_vec() })
    };
    let whole: Vec<Evaluation> = samples.iter().filter_map(evaluation).collect();
    let indices = sobol_indices(&whole)?;
    let both: Vec<f64> = whole.iter().flat_map(|e| [e.first, e.second]).collect();
    let spread = SampledSpread::of(&both)?.spread;
    let (solved, failed) = (whole.len(), samples.len() - whole.len());
    Some(MeasureIndices { name, spread, indices, samples: solved, failed })
}

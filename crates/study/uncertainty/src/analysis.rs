//! The tolerances of the designs of a sweep.

use std::sync::atomic::AtomicBool;

use ranking::Requirement;
use results::DesignRow;
use results::columns::{measure_name, name, parameter_of};
use run::{Evaluator, JournalHeader, Program};
use skin::Imperfection;
use sweep::{Case, Measure, Subset, Sweep};

use crate::analysis_error::AnalysisError;
use crate::draw;
use crate::linear::{Gradients, LinearSpread};
use crate::measured_columns::MeasuredColumns;
use crate::sample_store::{SampleStore, SolvedSample};
use crate::sampled_spread::SampledSpread;
use crate::sampler::Sampler;
use crate::yields::{RequirementYield, yields};

/// The tolerances of the designs of a sweep.
pub struct Analysis<'a> {
    /// The sweep, with its deviations.
    pub sweep: &'a Sweep,
    /// Bounds that samples must keep.
    pub requirements: &'a [Requirement],
    /// Samples of each design; with 0, derivatives alone tell.
    pub samples: usize,
    /// Set once the work is to stop.
    pub stop: &'a AtomicBool,
    differentiating: Evaluator,
    sampler: Sampler,
    program: Program,
}

/// A design without deviations, with what its samples are looked at for.
struct Nominal {
    index: u64,
    /// The case with the imperfection of its own, which the samples have too.
    case: Case,
    row: DesignRow,
    measured: MeasuredColumns,
    /// The places of the required columns among those that are measured.
    required: Vec<usize>,
}

/// Everything that is known of a design with its deviations.
#[derive(Clone, Debug)]
pub struct DesignTolerance {
    /// The nominal design.
    pub nominal: DesignRow,
    /// The spread of its measures.
    pub measures: Vec<MeasureTolerance>,
    /// The yield of every requirement, and of all together behind them.
    pub yields: Vec<RequirementYield>,
    /// Names of the values of a sample: the deviations, then the columns.
    pub columns: Vec<String>,
    /// The samples.
    pub samples: Vec<SolvedSample>,
}

/// A measure and its spread.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureTolerance {
    /// Name of its column.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// The value of the nominal design.
    pub value: Option<f64>,
    /// The spread that the derivatives predict.
    pub linear: Option<LinearSpread>,
    /// The spread over solved samples.
    pub sampled: Option<SampledSpread>,
    /// Samples without a value.
    pub failed: usize,
}

impl MeasureTolerance {
    /// How far the linear prediction is off: its spread over that of the samples, less 1.
    pub fn discrepancy(&self) -> Option<f64> {
        // To samples that do not spread no prediction has a ratio.
        let sampled = self.sampled.as_ref().filter(|sampled| sampled.spread > 0.0)?;
        Some(self.linear.as_ref()?.spread / sampled.spread - 1.0)
    }

    /// Whether the prediction is off by more than the statistical error of the samples explains, two standard errors.
    pub fn is_off(&self) -> bool {
        let error = |sampled: &SampledSpread| 2.0 * sampled.spread_error / sampled.spread;
        let error = self.sampled.as_ref().map(error);
        self.discrepancy().zip(error).is_some_and(|(off, error)| off.abs() > error)
    }
}

impl<'a> Analysis<'a> {
    /// The analysis of the designs of `sweep`, by `program`, until `stop` is set.
    pub fn new(
        sweep: &'a Sweep,
        requirements: &'a [Requirement],
        samples: usize,
        program: Program,
        stop: &'a AtomicBool,
    ) -> Self {
        let mut measures = sweep.plain_measures();
        let sampler = Sampler::new(&measures, sweep.deviations());
        measures.push(Measure::Sensitivity);
        let differentiating = Evaluator::new(&measures);
        Self { sweep, requirements, samples, stop, differentiating, sampler, program }
    }

    /// The tolerances of design `index`, from 0. Its samples are taken from `store` as far as they are there, and kept there.
    ///
    /// # Errors
    /// If the work is to stop, a requirement is about no column, or the disk is at fault.
    pub fn design(
        &self,
        index: u64,
        store: &SampleStore,
    ) -> Result<DesignTolerance, AnalysisError> {
        let nominal = self.nominal(index, store)?;
        let columns = self.columns(&nominal.measured);
        let samples = self.samples(&nominal, &columns, store)?;
        let measures = self.measures(&nominal, &samples);
        let yields = self.yields(&nominal, &measures, &samples);
        Ok(DesignTolerance { nominal: nominal.row, measures, yields, columns, samples })
    }

    /// Solves a design without deviations, and looks for the columns that are required.
    fn nominal(&self, index: u64, store: &SampleStore) -> Result<Nominal, AnalysisError> {
        let (number, case) = (self.sweep.grid().number(index), self.sweep.grid().case(index));
        // Imperfect samples of its own would be solved for nothing.
        let straight = Case { imperfection: Imperfection::default(), ..case };
        let solve = || self.differentiating.row(number, &straight);
        let row = store.work().track(&format!("design {number}"), solve);
        let measured = MeasuredColumns::of(self.sweep, &row);
        let asked = self.sweep.measures();
        let place = |r: &Requirement| measured.required(&r.column, &row, asked);
        let required = self.requirements.iter().map(place).collect::<Result<_, _>>()?;
        Ok(Nominal { index, case, row, measured, required })
    }

    /// The names of the values of a sample.
    fn columns(&self, measured: &MeasuredColumns) -> Vec<String> {
        let deviations = self.sweep.deviations().iter();
        let keys = deviations.map(|deviation| format!("{}_deviation", deviation.key()));
        keys.chain(measured.iter().map(|column| column.name.to_string())).collect()
    }

    /// The samples of a design: those that are kept, and behind them those that are solved now.
    fn samples(
        &self,
        nominal: &Nominal,
        columns: &[String],
        store: &SampleStore,
    ) -> Result<Vec<SolvedSample>, AnalysisError> {
        let (design, case) = (nominal.row.number, &nominal.case);
        let solve = |sample: u64| match self.sampler.solve(design, case, sample) {
            Some(skin) => [skin.deviations, nominal.measured.values(&skin.row)].concat(),
            // A sample for which no deviations are found is one that fails, with no values.
            None => vec![None; columns.len()],
        };
        let number = nominal.row.number.to_string();
        // Of this design alone: another design of the sweep makes no samples stale.
        let header = header(self.program, &self.sweep.only(nominal.index));
        store.samples((&number, header), columns, self.samples, self.stop, solve)
    }

    /// The values of a column in all samples; deviations stand before the columns.
    fn values(&self, column: usize, samples: &[SolvedSample]) -> Vec<Option<f64>> {
        let place = self.sweep.deviations().len() + column;
        samples.iter().map(|sample| sample.values.get(place).copied().flatten()).collect()
    }

    /// The spread of every measure that has derivatives or is required.
    fn measures(&self, nominal: &Nominal, samples: &[SolvedSample]) -> Vec<MeasureTolerance> {
        let deviations = self.sweep.deviations();
        let mut scattered = DesignRow { case: nominal.case, ..nominal.row.clone() };
        draw::scatter(&mut scattered.case, deviations);
        // Derivatives with respect to single scales cost a solve for each kind of scale.
        let scatters = !scattered.case.imperfection.is_none();
        let single =
            if scatters { self.differentiating.scatter(&nominal.case) } else { Vec::new() };
        let gradients = Gradients { design: &scattered, deviations, single: &single };
        let mut measures = Vec::new();
        for (place, column) in nominal.measured.iter().enumerate() {
            let has_derivatives = has_derivatives(&column.name, &nominal.row);
            // Parameters and counts are columns, too: told only where a requirement names them.
            if !has_derivatives && !nominal.required.contains(&place) {
                continue;
            }
            let value = column.cell(&nominal.row).number();
            // A parameter, in its own unit or another, follows from the deviations without being solved for.
            let is_known = has_derivatives || parameter_of(&column.name).is_some();
            let is_predicted = is_known && value.is_some();
            let values = self.values(place, samples);
            let known: Vec<f64> = values.iter().copied().flatten().collect();
            measures.push(MeasureTolerance {
                name: column.name.to_string(),
                unit: column.unit,
                value,
                linear: is_predicted.then(|| gradients.spread(column)).flatten(),
                sampled: SampledSpread::of(&known),
                failed: values.len() - known.len(),
            });
        }
        measures
    }

    /// The yield of every requirement, and of all together.
    fn yields(
        &self,
        nominal: &Nominal,
        measures: &[MeasureTolerance],
        samples: &[SolvedSample],
    ) -> Vec<RequirementYield> {
        let predicted = |requirement: &Requirement| {
            let measure = measures.iter().find(|measure| measure.name == requirement.column)?;
            Some((measure.value?, measure.linear.as_ref()?.spread))
        };
        let predicted: Vec<_> = self.requirements.iter().map(predicted).collect();
        let values = nominal.required.iter().map(|&column| self.values(column, samples));
        yields(self.requirements, &values.collect::<Vec<_>>(), &predicted)
    }
}

/// Whether a column is about a measure with derivatives, or about the mass, which parameters alone make.
fn has_derivatives(name: &str, nominal: &DesignRow) -> bool {
    let measure = measure_name(name);
    let mut derivatives = nominal.result.sensitivity.iter();
    measure == name::AREAL_MASS || derivatives.any(|d| d.measure == measure)
}

/// The header of the journal of the samples of a sweep.
pub(crate) fn header(program: Program, sweep: &Sweep) -> JournalHeader {
    JournalHeader::new(sweep.to_toml(), Subset::default(), &program)
}

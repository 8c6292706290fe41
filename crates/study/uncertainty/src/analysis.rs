//! Tolerance analysis of the designs of a sweep.

use std::sync::atomic::AtomicBool;

use ranking::Requirement;
use results::DesignRow;
use results::columns::{measure_name, name, parameter_of};
use run::{Evaluator, JournalHeader, Program, uninterrupted};
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

/// Tolerance analysis of the designs of a sweep.
pub struct Analysis<'a> {
    /// Sweep, with its deviations.
    pub sweep: &'a Sweep,
    /// Requirements that determine the yield.
    pub requirements: &'a [Requirement],
    /// Number of samples per design; 0 for a prediction from derivatives only.
    pub samples: usize,
    /// Set to stop the analysis.
    pub stop: &'a AtomicBool,
    differentiating: Evaluator,
    sampler: Sampler,
    program: Program,
}

/// A solved nominal design, without deviations.
struct Nominal {
    index: u64,
    /// Case with the imperfection of the definition, which its samples have too.
    case: Case,
    row: DesignRow,
    measured: MeasuredColumns,
    /// Indices of the columns of the requirements in `measured`.
    required: Vec<usize>,
}

/// Tolerances of a design.
#[derive(Clone, Debug)]
pub struct DesignTolerance {
    /// Nominal design.
    pub nominal: DesignRow,
    /// Spread of each measure of the design.
    pub measures: Vec<MeasureTolerance>,
    /// Yield of every requirement, then of all together.
    pub yields: Vec<RequirementYield>,
    /// Names of the values of a sample: the deviations, then the columns.
    pub columns: Vec<String>,
    /// Solved samples.
    pub samples: Vec<SolvedSample>,
}

/// Spread of a measure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureTolerance {
    /// Column name.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Value of the nominal design.
    pub value: Option<f64>,
    /// Spread predicted by derivatives.
    pub linear: Option<LinearSpread>,
    /// Spread over solved samples.
    pub sampled: Option<SampledSpread>,
    /// Number of samples without a value.
    pub failed: usize,
}

impl MeasureTolerance {
    /// Returns the relative error of the linear prediction, compared to the samples.
    pub fn discrepancy(&self) -> Option<f64> {
        // Undefined if the samples have no spread.
        let sampled = self.sampled.as_ref().filter(|sampled| sampled.spread > 0.0)?;
        Some(self.linear.as_ref()?.spread / sampled.spread - 1.0)
    }

    /// Returns true if the prediction is off by more than two standard errors.
    pub fn is_off(&self) -> bool {
        let sampled = self.sampled.as_ref();
        let error = sampled.map(|sampled| 2.0 * sampled.spread_error / sampled.spread);
        self.discrepancy().zip(error).is_some_and(|(off, error)| off.abs() > error)
    }
}

impl<'a> Analysis<'a> {
    /// Creates the analysis of the designs of `sweep` with `program`.
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

    /// Analyses design `index`, counted from 0.
    ///
    /// Reads the samples found in `store`, and stores newly solved ones there.
    ///
    /// # Errors
    ///
    /// After `stop`, if a requirement names an unknown column, or if files cannot be read or
    /// written.
    pub fn design(
        &self,
        index: u64,
        store: &SampleStore,
    ) -> Result<DesignTolerance, AnalysisError> {
        let nominal = self.nominal(index, store)?;
        let columns = self.columns(&nominal.measured);
        let samples = self.samples(&nominal, &columns, store)?;
        let measures = self.measures(&nominal, &samples)?;
        let yields = self.yields(&nominal, &measures, &samples);
        Ok(DesignTolerance { nominal: nominal.row, measures, yields, columns, samples })
    }

    /// Solves the design without deviations, and finds the required columns.
    fn nominal(&self, index: u64, store: &SampleStore) -> Result<Nominal, AnalysisError> {
        let (number, case) = (self.sweep.grid().number(index), self.sweep.grid().case(index));
        // Imperfections only matter for samples; the nominal design is solved without them.
        let straight = Case { imperfection: Imperfection::default(), ..case };
        let row = uninterrupted(|| {
            let name = format!("design {number}");
            store.work().track(&name, || self.differentiating.row(number, &straight))
        });
        let row = row.ok_or_else(|| self.stopped())?;
        let measured = MeasuredColumns::of(self.sweep, &row);
        let asked = self.sweep.measures();
        let required = self.requirements.iter().map(|r| measured.required(&r.column, &row, asked));
        let required = required.collect::<Result<_, _>>()?;
        Ok(Nominal { index, case, row, measured, required })
    }

    /// Returns the names of the values of a sample.
    fn columns(&self, measured: &MeasuredColumns) -> Vec<String> {
        let deviations = self.sweep.deviations().iter();
        let keys = deviations.map(|deviation| format!("{}_deviation", deviation.key()));
        keys.chain(measured.iter().map(|column| column.name.to_string())).collect()
    }

    /// Returns the samples of a design, and solves those that are not stored.
    fn samples(
        &self,
        nominal: &Nominal,
        columns: &[String],
        store: &SampleStore,
    ) -> Result<Vec<SolvedSample>, AnalysisError> {
        let (design, case) = (nominal.row.number, &nominal.case);
        let number = nominal.row.number.to_string();
        // The header contains this design only, so other designs of the sweep may change.
        let header = header(self.program, &self.sweep.only(nominal.index));
        store.samples((&number, header), columns, self.samples, self.stop, |sample| {
            match self.sampler.solve(design, case, sample) {
                Some(skin) => [skin.deviations, nominal.measured.values(&skin.row)].concat(),
                // A sample without valid deviations is a failed sample, without values.
                None => vec![None; columns.len()],
            }
        })
    }

    /// Returns the error of an analysis that is interrupted outside its samples.
    fn stopped(&self) -> AnalysisError {
        AnalysisError::Stopped { done: 0, of: self.samples }
    }

    /// Returns the values of a column in all samples. Deviations precede the columns.
    fn values(&self, column: usize, samples: &[SolvedSample]) -> Vec<Option<f64>> {
        let place = self.sweep.deviations().len() + column;
        samples.iter().map(|sample| sample.values.get(place).copied().flatten()).collect()
    }

    /// Returns the spread of every measure that has derivatives or a requirement.
    fn measures(
        &self,
        nominal: &Nominal,
        samples: &[SolvedSample],
    ) -> Result<Vec<MeasureTolerance>, AnalysisError> {
        let deviations = self.sweep.deviations();
        let mut scattered = DesignRow { case: nominal.case, ..nominal.row.clone() };
        draw::scatter(&mut scattered.case, deviations);
        // Derivatives with respect to single scales cost a solution for each kind of scale. Skip
        // them if there is no scatter.
        let scatters = !scattered.case.imperfection.is_none();
        let single = if scatters {
            uninterrupted(|| self.differentiating.scatter(&nominal.case))
        } else {
            Some(Vec::new())
        };
        let single = single.ok_or_else(|| self.stopped())?;
        let gradients = Gradients { design: &scattered, deviations, single: &single };
        let mut measures = Vec::new();
        for (place, column) in nominal.measured.iter().enumerate() {
            let has_derivatives = has_derivatives(&column.name, &nominal.row);
            // Columns of parameters and counts are only reported if a requirement names them.
            if !has_derivatives && !nominal.required.contains(&place) {
                continue;
            }
            let value = column.cell(&nominal.row).number();
            // Parameters, in any unit, follow from the deviations directly.
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
        Ok(measures)
    }

    /// Returns the yield of every requirement, then of all together.
    fn yields(
        &self,
        nominal: &Nominal,
        measures: &[MeasureTolerance],
        samples: &[SolvedSample],
    ) -> Vec<RequirementYield> {
        let predicted = self.requirements.iter().map(|requirement| {
            let measure = measures.iter().find(|measure| measure.name == requirement.column)?;
            Some((measure.value?, measure.linear.as_ref()?.spread))
        });
        let values = nominal.required.iter().map(|&column| self.values(column, samples));
        let (values, predicted): (Vec<_>, Vec<_>) = (values.collect(), predicted.collect());
        yields(self.requirements, &values, &predicted)
    }
}

/// Returns true for the columns of a measure with derivatives, and for the mass.
///
/// The mass has none, but is a function of the parameters.
fn has_derivatives(name: &str, nominal: &DesignRow) -> bool {
    let measure = measure_name(name);
    let mut derivatives = nominal.result.sensitivity.iter();
    measure == name::AREAL_MASS || derivatives.any(|d| d.measure == measure)
}

/// Creates the journal header for the samples of a sweep.
pub(crate) fn header(program: Program, sweep: &Sweep) -> JournalHeader {
    JournalHeader::new(sweep.to_toml(), Subset::default(), &program)
}

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
    /// Requirements on columns; their yields are reported.
    pub requirements: &'a [Requirement],
    /// Number of samples per design; 0 for a prediction from derivatives only.
    pub samples: usize,
    /// Flag that another thread sets to `true` to stop the analysis.
    pub stop: &'a AtomicBool,
    differentiating: Evaluator,
    sampler: Sampler,
    program: Program,
}

/// Nominal design, solved without deviations.
struct Nominal {
    index: u64,
    /// Case of the design, including the imperfection of the definition.
    ///
    /// Samples are drawn from this case.
    case: Case,
    row: DesignRow,
    measured: MeasuredColumns,
    /// For each requirement, the index of its column in `measured`.
    required: Vec<usize>,
}

/// Effect of the deviations on one design: spreads, yields and samples.
#[derive(Clone, Debug)]
pub struct DesignTolerance {
    /// Nominal design.
    pub nominal: DesignRow,
    /// Spread of each measure of the design.
    pub measures: Vec<MeasureTolerance>,
    /// Yield of each requirement, then the yield of all requirements together.
    pub yields: Vec<RequirementYield>,
    /// Names of the values of a sample: first the deviations, then the measured columns.
    pub columns: Vec<String>,
    /// Solved samples.
    pub samples: Vec<SolvedSample>,
}

/// Predicted and sampled spread of one measure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureTolerance {
    /// Column name.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Value of the nominal design.
    pub value: Option<f64>,
    /// Spread predicted by derivatives; `None` if a derivative is missing.
    pub linear: Option<LinearSpread>,
    /// Spread of the solved samples; `None` if fewer than two have a value.
    pub sampled: Option<SampledSpread>,
    /// Number of samples without a value.
    pub failed: usize,
}

impl MeasureTolerance {
    /// Returns the relative error of the predicted spread: predicted / sampled − 1.
    ///
    /// `None` without a predicted spread, or if the sampled spread is missing or 0.
    pub fn discrepancy(&self) -> Option<f64> {
        let sampled = self.sampled.as_ref().filter(|sampled| sampled.spread > 0.0)?;
        Some(self.linear.as_ref()?.spread / sampled.spread - 1.0)
    }

    /// Returns true if the predicted spread differs significantly from the sampled spread.
    ///
    /// The difference is significant if it exceeds two standard errors of the sampled spread.
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
    /// Samples that `store` already contains are read; missing samples are solved and stored.
    ///
    /// # Errors
    ///
    /// If `stop` is set, a requirement names an unknown column, or files cannot be read or written.
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

    /// Solves design `index` without deviations, and finds the columns of the requirements.
    fn nominal(&self, index: u64, store: &SampleStore) -> Result<Nominal, AnalysisError> {
        let (number, case) = (self.sweep.grid().number(index), self.sweep.grid().case(index));
        // Solve the nominal design without imperfections, which only its samples have.
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

    /// Returns the names of the values of a sample: deviations, then measured columns.
    fn columns(&self, measured: &MeasuredColumns) -> Vec<String> {
        let deviations = self.sweep.deviations().iter();
        let keys = deviations.map(|deviation| format!("{}_deviation", deviation.key()));
        keys.chain(measured.iter().map(|column| column.name.to_string())).collect()
    }

    /// Returns the samples of a design. Samples missing in `store` are solved first.
    fn samples(
        &self,
        nominal: &Nominal,
        columns: &[String],
        store: &SampleStore,
    ) -> Result<Vec<SolvedSample>, AnalysisError> {
        let (design, case) = (nominal.row.number, &nominal.case);
        let number = nominal.row.number.to_string();
        // The header contains this design only. Stored samples therefore stay valid when a user
        // changes other designs of the sweep.
        let header = header(self.program, &self.sweep.only(nominal.index));
        store.samples((&number, header), columns, self.samples, self.stop, |sample| {
            match self.sampler.solve(design, case, sample) {
                Some(solved) => [solved.deviations, nominal.measured.values(&solved.row)].concat(),
                // No deviations within the bounds of the parameters were found, so the sample has
                // no values.
                None => vec![None; columns.len()],
            }
        })
    }

    /// Returns the error for an interruption while no samples are being solved.
    fn stopped(&self) -> AnalysisError {
        AnalysisError::Stopped { done: 0, of: self.samples }
    }

    /// Returns the values of the measured column with index `column` in all samples.
    ///
    /// The values of a sample start with the deviations, followed by the measured columns.
    fn values(&self, column: usize, samples: &[SolvedSample]) -> Vec<Option<f64>> {
        let index = self.sweep.deviations().len() + column;
        samples.iter().map(|sample| sample.values.get(index).copied().flatten()).collect()
    }

    /// Returns the spread of each column that has derivatives or a requirement.
    fn measures(
        &self,
        nominal: &Nominal,
        samples: &[SolvedSample],
    ) -> Result<Vec<MeasureTolerance>, AnalysisError> {
        let deviations = self.sweep.deviations();
        let mut scattered = DesignRow { case: nominal.case, ..nominal.row.clone() };
        draw::scatter(&mut scattered.case, deviations);
        // Derivatives with respect to single scales are expensive, because rows with one perturbed
        // scale must be solved. Skip these derivatives if gaps and slants do not scatter.
        let scatters = !scattered.case.imperfection.is_none();
        let single = if scatters {
            uninterrupted(|| self.differentiating.scatter(&nominal.case))
        } else {
            Some(Vec::new())
        };
        let single = single.ok_or_else(|| self.stopped())?;
        let gradients = Gradients { design: &scattered, deviations, single: &single };
        let mut measures = Vec::new();
        for (index, column) in nominal.measured.iter().enumerate() {
            let has_derivatives = has_derivatives(&column.name, &nominal.row);
            // Report columns of parameters and counts only if a requirement names them.
            if !has_derivatives && !nominal.required.contains(&index) {
                continue;
            }
            let value = column.cell(&nominal.row).number();
            // The spread of a parameter follows from the deviations without derivatives.
            let is_known = has_derivatives || parameter_of(&column.name).is_some();
            let is_predicted = is_known && value.is_some();
            let values = self.values(index, samples);
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

    /// Returns the yield of each requirement, then the yield of all requirements together.
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

/// Returns true if derivatives predict the spread of the column `name`.
///
/// Returns true for the columns of measures with derivatives in `nominal`, and for the areal mass,
/// which is a function of the parameters.
fn has_derivatives(name: &str, nominal: &DesignRow) -> bool {
    let measure = measure_name(name);
    let mut derivatives = nominal.result.sensitivity.iter();
    measure == name::AREAL_MASS || derivatives.any(|d| d.measure == measure)
}

/// Returns the journal header for samples of `sweep` solved by `program`.
pub(crate) fn header(program: Program, sweep: &Sweep) -> JournalHeader {
    JournalHeader::new(sweep.to_toml(), Subset::default(), &program)
}

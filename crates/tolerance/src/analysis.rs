//! The tolerances of the designs of a sweep.

use std::sync::atomic::AtomicBool;

use ranking::Requirement;
use results::DesignRow;
use results::columns::{AREAL_MASS, measure_name};
use run::{Evaluator, JournalHeader, Program};
use skin::Imperfection;
use sweep::{Case, Measure, Subset, Sweep};

use crate::draw;
use crate::linear::{Gradients, LinearSpread};
use crate::measured::MeasuredColumns;
use crate::no_analysis::NoAnalysis;
use crate::sampled::Sampled;
use crate::sampler::Sampler;
use crate::store::{SampleStore, SolvedSample};
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
    plain: Evaluator,
    sampler: Sampler,
    program: Program,
}

/// Everything that is known of a design with its deviations.
#[derive(Clone, Debug)]
pub struct DesignTolerance {
    /// The design as it is drawn.
    pub drawn: DesignRow,
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
    /// The value of the design as it is drawn.
    pub value: Option<f64>,
    /// The spread that the derivatives predict.
    pub linear: Option<LinearSpread>,
    /// The spread over solved samples.
    pub sampled: Option<Sampled>,
    /// Samples without a value.
    pub failed: usize,
}

impl MeasureTolerance {
    /// How far the linear prediction is off: its spread over that of the samples, less 1.
    pub fn discrepancy(&self) -> Option<f64> {
        let sampled = self.sampled.as_ref().filter(|sampled| sampled.spread > 0.0)?;
        Some(self.linear.as_ref()?.spread / sampled.spread - 1.0)
    }

    /// Whether the prediction is off by more than the statistical error of the samples explains, two standard errors.
    pub fn is_off(&self) -> bool {
        let error = |sampled: &Sampled| 2.0 * sampled.spread_error / sampled.spread;
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
        let mut measures = sweep.measures().to_vec();
        measures.retain(|measure| *measure != Measure::Sensitivity);
        let plain = Evaluator::new(&measures);
        let sampler = Sampler::new(&measures, sweep.deviations());
        measures.push(Measure::Sensitivity);
        let differentiating = Evaluator::new(&measures);
        Self { sweep, requirements, samples, stop, differentiating, plain, sampler, program }
    }

    /// The tolerances of design `index`, from 0. Its samples are taken from `store` as far as they are there, and kept there.
    ///
    /// # Errors
    /// If the work is to stop, a requirement is about no column, or the disk is at fault.
    pub fn design(&self, index: u64, store: &SampleStore) -> Result<DesignTolerance, NoAnalysis> {
        let (number, case) = (self.sweep.grid().number(index), self.sweep.grid().case(index));
        // Imperfect samples of its own would be solved for nothing.
        let straight = Case { imperfection: Imperfection::default(), ..case };
        let drawn = self.differentiating.solve(number, &straight).row;
        let measured = MeasuredColumns::of(self.sweep, &drawn);
        let asked = self.sweep.measures();
        let place = |r: &Requirement| measured.required(&r.column, &drawn, asked);
        let required = self.requirements.iter().map(place).collect::<Result<Vec<_>, _>>()?;
        let deviations = self.sweep.deviations();
        let keys = deviations.iter().map(|d| format!("{}_deviation", d.key()));
        let names = measured.iter().map(|column| column.name.to_string());
        let columns: Vec<String> = keys.chain(names).collect();
        let solve = |sample: u64| {
            let solved = self.solved(index, &case, &measured, sample);
            solved.unwrap_or_else(|| vec![None; columns.len()])
        };
        let label = (&*number.to_string(), header(self.program, &self.sweep.only(index)));
        let samples = store.samples(label, &columns, self.samples, self.stop, solve)?;
        let of = |column: usize| -> Vec<Option<f64>> {
            let place = deviations.len() + column;
            samples.iter().map(|sample| sample.values.get(place).copied().flatten()).collect()
        };
        let measures = self.measures(&case, &drawn, &measured, &required, &of);
        let linear = |&column: &usize| {
            let name = measured.iter().nth(column)?.name.as_ref();
            let measure = measures.iter().find(|measure| measure.name == name)?;
            Some((measure.value?, measure.linear.as_ref()?.spread))
        };
        let predicted: Vec<_> = required.iter().map(linear).collect();
        let values: Vec<_> = required.iter().map(|&column| of(column)).collect();
        let yields = yields(self.requirements, &values, &predicted);
        Ok(DesignTolerance { drawn, measures, yields, columns, samples })
    }

    /// The spread of every measure that has derivatives or is required.
    fn measures(
        &self,
        case: &Case,
        drawn: &DesignRow,
        measured: &MeasuredColumns,
        required: &[usize],
        samples: &dyn Fn(usize) -> Vec<Option<f64>>,
    ) -> Vec<MeasureTolerance> {
        let mut scattered = DesignRow { case: *case, ..drawn.clone() };
        draw::scatter(&mut scattered.case, self.sweep.deviations());
        let scatters = !scattered.case.imperfection.is_none();
        let single = if scatters { self.plain.scatter(case) } else { Vec::new() };
        let deviations = self.sweep.deviations();
        let gradients = Gradients { design: &scattered, deviations, single: &single };
        let values = measured.values(drawn);
        let measure = |(k, column): (usize, &results::Column<DesignRow>)| {
            let name = column.name.as_ref();
            let has_derivatives = has_derivatives(name, drawn);
            let is_listed = required.contains(&k) || has_derivatives;
            is_listed.then(|| {
                let all = samples(k);
                let with_value: Vec<f64> = all.iter().copied().flatten().collect();
                MeasureTolerance {
                    name: name.to_owned(),
                    unit: column.unit,
                    value: values[k],
                    linear: values[k]
                        .filter(|_| has_derivatives)
                        .and_then(|_| gradients.spread(column)),
                    sampled: Sampled::of(&with_value),
                    failed: all.len() - with_value.len(),
                }
            })
        };
        measured.iter().enumerate().filter_map(measure).collect()
    }

    /// The deviations and values of a sample; `None` if there is no such skin.
    fn solved(
        &self,
        index: u64,
        case: &Case,
        measured: &MeasuredColumns,
        sample: u64,
    ) -> Option<Vec<Option<f64>>> {
        let number = self.sweep.grid().number(index);
        let skin = self.sampler.solve(number, case, sample)?;
        let mut values = skin.deviations;
        values.extend(measured.values(&skin.row));
        Some(values)
    }
}

/// Whether a column is about a measure with derivatives, or about the mass, which parameters alone make.
fn has_derivatives(name: &str, drawn: &DesignRow) -> bool {
    let measure = measure_name(name);
    let mut derivatives = drawn.result.sensitivity.iter();
    measure == AREAL_MASS || derivatives.any(|d| d.measure == measure)
}

/// The header of the journal of the samples of a sweep.
pub(crate) fn header(program: Program, sweep: &Sweep) -> JournalHeader {
    JournalHeader::new(sweep.to_toml(), Subset::default(), &program)
}

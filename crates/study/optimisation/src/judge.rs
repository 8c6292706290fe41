//! Judges designs by a goal, and differentiates the judgement.

mod parts;

use ranking::{Goal, Requirement, Worth};
use results::{DesignResult, DesignRow};
use sweep::{Case, DesignNumber, Measure, Parameter};

use crate::column::NumberColumn;
use crate::evaluated_row::{EvaluatedRow, StatisticUse};
use crate::judgement::{Judgement, NominalWorth};
use crate::requirement_bounds::{Bound, has_folded};
use crate::sample::{SampleJudge, Samples};
use crate::slopes::Slopes;
use crate::statistic::Statistic;

/// Source of the value of an objective or requirement.
enum Source {
    /// A column of the nominal design.
    Nominal(NumberColumn),
    /// Smallest margin of the nominal design over all requirements.
    Margin,
    /// The statistic over samples with this index.
    Statistic(usize),
}

/// Judges designs by a goal: computes their objectives and their margins to the requirements.
pub struct Judge {
    objectives: Vec<(Goal, Source)>,
    requirements: Vec<Bound<Source>>,
    /// Index of the requirement of an unfolded surface, if any.
    soundness: Option<usize>,
    /// Measures that the goal depends on.
    measures: Vec<Measure>,
    samples: SampleJudge,
}

impl Judge {
    /// Returns the judge of samples; `None` if the goal contains no statistics over samples.
    pub(crate) fn samples(&self) -> Option<&SampleJudge> {
        Some(&self.samples).filter(|samples| !samples.statistics.is_empty())
    }

    /// Returns each objective and requirement that is a statistic, with the index of the statistic.
    pub(crate) fn uses(&self) -> impl Iterator<Item = (StatisticUse, usize)> {
        let objectives = self.objectives.iter().map(|(_, source)| source).enumerate();
        let objectives = objectives.map(|(k, source)| (StatisticUse::Objective(k), source));
        let required = self.requirements.iter().map(|required| &required.column).enumerate();
        let required = required.map(|(k, source)| (StatisticUse::Requirement(k), source));
        objectives.chain(required).filter_map(|(of, source)| match source {
            Source::Statistic(q) => Some((of, *q)),
            Source::Nominal(_) | Source::Margin => None,
        })
    }

    /// Returns the names and definitions of the reported statistics, each name once.
    pub fn statistics(&self) -> Vec<(String, Statistic)> {
        let mut all: Vec<(String, Statistic)> = Vec::new();
        for used in &self.samples.statistics {
            if !all.iter().any(|(name, _)| *name == used.name) {
                all.push((used.name.clone(), used.statistic.clone()));
            }
        }
        all
    }

    /// Returns true if the objective or requirement `of` is a statistic.
    pub(crate) fn is_statistic(&self, of: StatisticUse) -> bool {
        self.uses().any(|(other, _)| other == of)
    }

    /// Returns true if the objective or requirement `of` is a yield.
    pub(crate) fn is_yield(&self, of: StatisticUse) -> bool {
        self.uses().any(|(other, q)| other == of && self.samples.statistics[q].is_yield())
    }

    /// Returns the requirements of the goal, then the requirement of an unfolded surface, if any.
    pub fn requirements(&self) -> impl Iterator<Item = &Requirement> {
        self.requirements.iter().map(|required| &required.requirement)
    }

    /// Returns true if requirement `k` is the requirement of an unfolded surface.
    pub fn is_soundness(&self, k: usize) -> bool {
        self.soundness == Some(k)
    }

    /// Returns true if designs with a folded surface are excluded.
    pub(crate) fn requires_unfolded(&self) -> bool {
        self.soundness.is_some()
    }

    /// Returns true if the goal depends on `measure`.
    pub(crate) fn depends_on(&self, measure: Measure) -> bool {
        self.measures.contains(&measure)
    }

    /// Returns true if coverage peaks divide the space into regions that matter for the goal.
    ///
    /// This is true for a goal with any measure, because contacts in puncture and bending depend on
    /// the same lengths as the coverage.
    pub(crate) fn has_regions(&self) -> bool {
        !self.measures.is_empty()
    }

    /// Returns the requirements on columns, each with its value in a partly known `result`.
    ///
    /// A value is `None` if `result` does not contain it.
    pub(crate) fn known(
        &self,
        case: &Case,
        number: DesignNumber,
        result: DesignResult,
    ) -> Vec<(&Requirement, Option<f64>)> {
        let row = DesignRow { number, case: *case, result };
        let bounds = &self.samples.bounds;
        let values: Vec<Option<f64>> = bounds.values(&row).collect();
        bounds.all.iter().map(|bound| &bound.requirement).zip(values).collect()
    }

    /// Returns 1 if objective `k` is maximised, −1 if minimised.
    pub fn sign(&self, k: usize) -> f64 {
        if self.objectives[k].0 == Goal::Maximize { 1.0 } else { -1.0 }
    }

    /// Returns the number of objectives.
    pub fn objectives(&self) -> usize {
        self.objectives.len()
    }

    /// Judges a design without samples.
    ///
    /// If the goal contains statistics over samples, only the requirements on columns are judged.
    pub fn verdict(&self, row: &DesignRow) -> Judgement {
        self.verdict_with(row, None)
    }

    /// Judges a design with its samples, if they are known.
    pub(crate) fn verdict_with(&self, row: &DesignRow, samples: Option<&Samples>) -> Judgement {
        if let Some(failure) = row.result.failures.first() {
            return Judgement::Failed(failure.outcome);
        }
        let no_samples = Samples::default();
        let worth = match (self.samples(), samples) {
            (Some(_), None) => return self.nominal_verdict(row),
            (_, samples) => self.worth(row, samples.unwrap_or(&no_samples)),
        };
        match worth {
            // Check for folds only if the design is otherwise feasible. The shortfall of an
            // infeasible design guides the search, even if the surface has folded.
            Ok(worth) if worth.met && self.requires_unfolded() && has_folded(row) => {
                Judgement::Folded
            }
            Ok(worth) => Judgement::Judged(worth),
            Err(column) => Judgement::Missing(column),
        }
    }

    /// Judges a design without samples by the requirements on columns.
    ///
    /// The goal contains statistics over samples, so the objectives are unknown.
    fn nominal_verdict(&self, row: &DesignRow) -> Judgement {
        let bounds = &self.samples.bounds;
        let values: Vec<Option<f64>> = bounds.values(row).collect();
        if let Some(missing) = values.iter().position(Option::is_none) {
            return Judgement::Missing(bounds.all[missing].column.name().to_owned());
        }
        let margin = bounds.margin(values.iter().copied());
        // Check for folds last, as for sampled designs, so that other shortfalls are reported
        // first.
        if margin >= 0.0 && self.requires_unfolded() && has_folded(row) {
            return Judgement::Folded;
        }
        let required = values.into_iter().flatten().collect();
        Judgement::Nominal(NominalWorth { shortfall: (-margin).max(0.0), required })
    }

    /// Returns true if a design is complete and meets the requirement of an unfolded surface.
    pub(crate) fn is_whole(&self, row: &DesignRow) -> bool {
        let bounds = &self.samples.bounds;
        let is_open = bounds.soundness.is_none_or(|k| {
            let open = &bounds.all[k];
            let value = open.column.value(row);
            !has_folded(row) && value.is_some_and(|value| open.requirement.is_met(value))
        });
        row.result.failures.is_empty() && is_open
    }

    /// Computes objectives and margins of a complete design.
    ///
    /// The error is the name of a column without a value.
    fn worth(&self, row: &DesignRow, samples: &Samples) -> Result<Worth, String> {
        let objectives = self.objectives.iter().map(|(_, source)| self.value(source, row, samples));
        let objectives: Vec<f64> = objectives.collect::<Result<_, _>>()?;
        let compared = self.objectives.iter().zip(&objectives);
        let compared = compared.map(|((_, source), value)| match source {
            Source::Statistic(q) => self.samples.compared(*q, samples).unwrap_or(*value),
            Source::Nominal(_) | Source::Margin => *value,
        });
        let required = self.requirements.iter();
        let required = required.map(|required| self.value(&required.column, row, samples));
        let required: Vec<f64> = required.collect::<Result<_, _>>()?;
        let bounds = self.requirements.iter().zip(&required);
        Ok(Worth {
            margins: bounds
                .clone()
                .map(|(bound, value)| self.margin(bound, *value, samples))
                .collect(),
            // Do not use the margins: for a strict inequality, the margin of a value that barely
            // meets the requirement is negative.
            met: bounds.clone().all(|(bound, value)| bound.requirement.is_met(*value)),
            compared: compared.collect(),
            objectives,
            required,
        })
    }

    /// Returns the margin to `bound`, relative to the limit, for this `value` of its column.
    ///
    /// Quantiles and yields have margins that are computed from `samples`.
    fn margin(&self, bound: &Bound<Source>, value: f64, samples: &Samples) -> f64 {
        let of_samples = match bound.column {
            Source::Statistic(q) => self.samples.requirement_margin(q, &bound.requirement, samples),
            Source::Nominal(_) | Source::Margin => None,
        };
        of_samples.unwrap_or_else(|| bound.requirement.margin(value))
    }

    /// Returns the value of a design from `source`. The error is the name of an empty column.
    fn value(&self, source: &Source, row: &DesignRow, samples: &Samples) -> Result<f64, String> {
        match source {
            Source::Nominal(column) => column.value(row).ok_or_else(|| column.name().to_owned()),
            Source::Margin => {
                let bounds = &self.samples.bounds;
                let margin = Some(bounds.margin(bounds.values(row)));
                margin.filter(|m| m.is_finite()).ok_or_else(|| Statistic::MARGIN.to_owned())
            }
            Source::Statistic(q) => {
                let value = self.samples.value(*q, samples);
                value.ok_or_else(|| self.samples.statistics[*q].name.clone())
            }
        }
    }

    /// Returns the derivatives of an objective or of the column of a requirement.
    fn slopes(&self, of: StatisticUse, row: &EvaluatedRow, parameter: &Parameter) -> Slopes {
        let source = match of {
            StatisticUse::Objective(k) => &self.objectives[k].1,
            StatisticUse::Requirement(k) => &self.requirements[k].column,
        };
        match source {
            Source::Nominal(column) => column.slopes(&row.nominal, parameter),
            Source::Margin => self.samples.bounds.margin_slopes(&row.nominal, parameter),
            Source::Statistic(_) => row.statistic_slopes(of, parameter),
        }
    }

    /// Returns the derivatives of objective `k`, with changed sign if the objective is minimised.
    pub(crate) fn objective_slopes(
        &self,
        k: usize,
        row: &EvaluatedRow,
        parameter: &Parameter,
    ) -> Slopes {
        self.slopes(StatisticUse::Objective(k), row, parameter).scaled(self.sign(k))
    }

    /// Returns the derivative of objective `k` at a nominal design.
    ///
    /// `None` at a kink, for a design without derivatives, and for a statistic.
    pub fn objective_slope(&self, k: usize, row: &DesignRow, parameter: &Parameter) -> Option<f64> {
        let row = EvaluatedRow { nominal: row.clone(), statistics: Vec::new() };
        self.slopes(StatisticUse::Objective(k), &row, parameter).smooth()
    }

    /// Returns the derivatives of the margin to requirement `k`, relative to the limit.
    pub(crate) fn margin_slopes(
        &self,
        k: usize,
        row: &EvaluatedRow,
        parameter: &Parameter,
    ) -> Slopes {
        let of = StatisticUse::Requirement(k);
        // The derivatives of a yield are derivatives of a margin, which is already relative.
        let rate =
            if self.is_yield(of) { 1.0 } else { self.requirements[k].requirement.margin_rate() };
        self.slopes(of, row, parameter).scaled(rate)
    }
}

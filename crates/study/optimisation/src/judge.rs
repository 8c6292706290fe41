//! The judge of a goal: what a design is worth by it, and how that changes with the variables.

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

/// What a design is judged by.
enum Source {
    /// A column of the nominal design.
    Nominal(NumberColumn),
    /// The least margin of the nominal design over all bounds.
    Margin,
    /// A statistic over samples, by its index.
    Statistic(usize),
}

/// Judges designs by a goal.
pub struct Judge {
    objectives: Vec<(Goal, Source)>,
    requirements: Vec<Bound<Source>>,
    /// The index of the requirement that the surface has not folded, if that is wanted.
    soundness: Option<usize>,
    /// The measures that the goal is about.
    measures: Vec<Measure>,
    samples: SampleJudge,
}

impl Judge {
    /// What is judged of samples, if the goal is about them.
    pub(crate) fn samples(&self) -> Option<&SampleJudge> {
        Some(&self.samples).filter(|samples| !samples.statistics.is_empty())
    }

    /// The uses of statistics, each with the index of its statistic.
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

    /// The statistics that are told, each name once.
    pub fn statistics(&self) -> Vec<(String, Statistic)> {
        let mut all: Vec<(String, Statistic)> = Vec::new();
        for used in &self.samples.statistics {
            if !all.iter().any(|(name, _)| *name == used.name) {
                all.push((used.name.clone(), used.statistic.clone()));
            }
        }
        all
    }

    /// Whether a use is that of a statistic.
    pub(crate) fn is_statistic(&self, of: StatisticUse) -> bool {
        self.uses().any(|(other, _)| other == of)
    }

    /// Whether a use is that of a yield.
    pub(crate) fn is_yield(&self, of: StatisticUse) -> bool {
        self.uses().any(|(other, q)| other == of && self.samples.statistics[q].is_yield())
    }

    /// The requirements: those of the goal, then that the surface has not folded.
    pub fn requirements(&self) -> impl Iterator<Item = &Requirement> {
        self.requirements.iter().map(|required| &required.requirement)
    }

    /// Whether requirement `k` is that the surface has not folded.
    pub fn is_soundness(&self, k: usize) -> bool {
        self.soundness == Some(k)
    }

    /// Whether only designs count whose surface has not folded.
    pub(crate) fn wants_sound(&self) -> bool {
        self.soundness.is_some()
    }

    /// Whether a measure counts.
    pub(crate) fn is_about(&self, measure: Measure) -> bool {
        self.measures.contains(&measure)
    }

    /// Whether the peaks of coverage tell regions of the space apart: contacts go with the same lengths, in bending and puncture.
    pub(crate) fn has_regions(&self) -> bool {
        !self.measures.is_empty()
    }

    /// The requirements of columns, each with the value that a case and what is known of its result have there.
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

    /// 1 if objective `k` is to be large, −1 if it is to be small.
    pub fn sign(&self, k: usize) -> f64 {
        if self.objectives[k].0 == Goal::Maximize { 1.0 } else { -1.0 }
    }

    /// The number of objectives.
    pub fn objectives(&self) -> usize {
        self.objectives.len()
    }

    /// The verdict on a design, of a goal that is about samples by the nominal design alone.
    pub fn verdict(&self, row: &DesignRow) -> Judgement {
        self.verdict_with(row, None)
    }

    /// The verdict on a design with these samples.
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
            // Only of a design that meets all else: one that falls short still tells a search the way, folded or not.
            Ok(worth) if worth.met && self.wants_sound() && has_folded(row) => Judgement::Folded,
            Ok(worth) => Judgement::Judged(worth),
            Err(column) => Judgement::Missing(column),
        }
    }

    /// The verdict on a design of which no samples are known.
    fn nominal_verdict(&self, row: &DesignRow) -> Judgement {
        let bounds = &self.samples.bounds;
        let values: Vec<Option<f64>> = bounds.values(row).collect();
        if let Some(missing) = values.iter().position(Option::is_none) {
            return Judgement::Missing(bounds.all[missing].column.name().to_owned());
        }
        let margin = bounds.margin(values.iter().copied());
        // As of a design with samples: whoever falls short otherwise is told by how much.
        if margin >= 0.0 && self.wants_sound() && has_folded(row) {
            return Judgement::Folded;
        }
        let required = values.into_iter().flatten().collect();
        Judgement::Nominal(NominalWorth { shortfall: (-margin).max(0.0), required })
    }

    /// Whether a design is complete, and its surface open all the way if that is wanted.
    pub(crate) fn is_whole(&self, row: &DesignRow) -> bool {
        let bounds = &self.samples.bounds;
        let is_open = bounds.soundness.is_none_or(|k| {
            let open = &bounds.all[k];
            let value = open.column.value(row);
            !has_folded(row) && value.is_some_and(|value| open.requirement.is_met(value))
        });
        row.result.failures.is_empty() && is_open
    }

    /// The worth of a complete design, or the column in which it has no value.
    fn worth(&self, row: &DesignRow, samples: &Samples) -> Result<Worth, String> {
        let value = |source: &Source| self.value(source, row, samples);
        let objectives = self.objectives.iter().map(|(_, source)| value(source));
        let objectives: Vec<f64> = objectives.collect::<Result<_, _>>()?;
        let compared = self.objectives.iter().zip(&objectives);
        let compared = compared.map(|((_, source), value)| match source {
            Source::Statistic(q) => self.samples.compared(*q, samples).unwrap_or(*value),
            Source::Nominal(_) | Source::Margin => *value,
        });
        let required = self.requirements.iter().map(|required| value(&required.column));
        let required: Vec<f64> = required.collect::<Result<_, _>>()?;
        let margin = |(Bound { requirement, column }, value): (&Bound<Source>, &f64)| {
            let of_samples = match column {
                Source::Statistic(q) => self.samples.requirement_margin(*q, requirement, samples),
                Source::Nominal(_) | Source::Margin => None,
            };
            of_samples.unwrap_or_else(|| requirement.margin(*value))
        };
        let all = || self.requirements.iter().zip(&required);
        Ok(Worth {
            margins: all().map(margin).collect(),
            // By values: margins of strict limits are below 0 a little before the limit.
            met: all().all(|(r, value)| r.requirement.is_met(*value)),
            compared: compared.collect(),
            objectives,
            required,
        })
    }

    /// The value of a design, or the name of the column in which it has none.
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

    /// The derivatives of what a design is judged by.
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

    /// The derivatives of objective `k`, turned so that it is to be large.
    pub(crate) fn objective_slopes(
        &self,
        k: usize,
        row: &EvaluatedRow,
        parameter: &Parameter,
    ) -> Slopes {
        self.slopes(StatisticUse::Objective(k), row, parameter).scaled(self.sign(k))
    }

    /// The derivative of objective `k` of a nominal design with respect to a parameter; `None` at a kink, of a row without derivatives,
    /// or of a statistic.
    pub fn objective_slope(&self, k: usize, row: &DesignRow, parameter: &Parameter) -> Option<f64> {
        let row = EvaluatedRow { nominal: row.clone(), statistics: Vec::new() };
        self.slopes(StatisticUse::Objective(k), &row, parameter).smooth()
    }

    /// The derivatives of how far the design is within requirement `k`, relative to the limit.
    pub(crate) fn margin_slopes(
        &self,
        k: usize,
        row: &EvaluatedRow,
        parameter: &Parameter,
    ) -> Slopes {
        let of = StatisticUse::Requirement(k);
        // The margin of the sample that has to meet is relative already.
        let rate =
            if self.is_yield(of) { 1.0 } else { self.requirements[k].requirement.margin_rate() };
        self.slopes(of, row, parameter).scaled(rate)
    }
}

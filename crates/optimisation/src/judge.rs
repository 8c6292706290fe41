//! The worth of a design: its objectives, and how far it is from every requirement.

use ranking::{Goal, Relation, Requirement};
use results::columns::{design_columns, measure_of};
use results::{DesignRow, Outcome};
use sweep::{Measure, Parameter};

use crate::fitness::{CriterionEnds, Fitness};
use crate::goal::DesignGoal;
use crate::number_column::NumberColumn;
use crate::slopes::Slopes;

/// The requirement that the surface of the substrate has not folded: no gap has closed at the critical tilt.
const SOUND: (&str, Relation, f64) = ("gap_stretch_min", Relation::AtLeast, 0.0);

/// The judgement of a design by a goal.
#[derive(Clone, Debug, PartialEq)]
pub enum Judgement {
    /// The design has every objective and every column that is required.
    Judged(Worth),
    /// The surface folded on the way and is open again at the end.
    Folded,
    /// A measure has no value.
    Failed(Outcome),
    /// The design is complete, and has no value in the column of an objective or a requirement.
    Missing(String),
}

/// The worth of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Worth {
    /// The objectives in their units.
    pub objectives: Vec<f64>,
    /// The values of the columns that are required.
    pub required: Vec<f64>,
    /// How far it is beyond each requirement, relative to the limit; above 0 where it falls short.
    pub excess: Vec<f64>,
    /// Whether it meets every requirement.
    pub met: bool,
}

impl Worth {
    /// The columns of the objectives of `goal`, then of its requirements, each with the value of the design.
    pub fn values<'a>(&'a self, goal: &'a DesignGoal) -> impl Iterator<Item = (&'a str, f64)> {
        let objectives = goal.objectives.iter().map(|objective| objective.column.as_ref());
        let columns = objectives.chain(goal.requirements.iter().map(|r| r.column.as_str()));
        columns.zip(self.objectives.iter().chain(&self.required).copied())
    }
}

/// A requirement with its column.
struct RequiredColumn {
    requirement: Requirement,
    column: NumberColumn,
}

/// Judges designs by a goal.
pub struct Judge {
    objectives: Vec<(Goal, NumberColumn)>,
    requirements: Vec<RequiredColumn>,
    sound: bool,
    bends: bool,
}

impl Judge {
    /// A judge by `goal`, in whose fitness those criteria are rescaled that have their ends there.
    pub fn new(goal: &DesignGoal) -> Self {
        Self::rescaling(goal, goal.fitness.as_ref().map_or(&[], |fitness| &fitness.ends))
    }

    /// A judge by `goal`, in whose fitness the criteria are rescaled between these ends.
    pub fn rescaling(goal: &DesignGoal, ends: &[CriterionEnds]) -> Self {
        let sweep = goal.space.sweep();
        let column = |name: &str| {
            if let (Fitness::COLUMN, Some(fitness)) = (name, &goal.fitness) {
                return Some(NumberColumn::Fitness(Fitness::new(fitness, sweep, ends)));
            }
            let mut columns = design_columns(sweep).into_iter();
            columns.find(|column| column.name == name).map(NumberColumn::Known)
        };
        let objectives = goal.objectives.iter();
        let objectives = objectives.filter_map(|o| Some((o.goal, column(&o.column)?))).collect();
        let sound = goal.sound && sweep.measures().contains(&Measure::Puncture);
        let mut wanted = goal.requirements.clone();
        let (name, relation, limit) = SOUND;
        wanted.extend(sound.then(|| Requirement { column: name.to_owned(), relation, limit }));
        let criteria = goal.fitness.iter().flat_map(|fitness| &fitness.criteria);
        let criteria = goal.objectives.iter().chain(criteria).map(|c| c.column.as_ref());
        let mut columns = criteria.chain(wanted.iter().map(|r| r.column.as_str()));
        let bends = columns.any(|column| measure_of(column) == Some(Measure::Flexure));
        let required = |requirement: Requirement| {
            let column = column(&requirement.column)?;
            Some(RequiredColumn { requirement, column })
        };
        let requirements = wanted.into_iter().filter_map(required).collect();
        Self { objectives, requirements, sound, bends }
    }

    /// The requirements: those of the goal, then that the surface has not folded.
    pub fn requirements(&self) -> impl Iterator<Item = &Requirement> {
        self.requirements.iter().map(|required| &required.requirement)
    }

    /// Whether requirement `k` is that the surface has not folded.
    pub fn is_soundness(&self, k: usize) -> bool {
        self.sound && k + 1 == self.requirements.len()
    }

    /// Whether only designs count whose surface has not folded.
    pub(crate) fn wants_sound(&self) -> bool {
        self.sound
    }

    /// Whether bending counts.
    pub(crate) fn bends(&self) -> bool {
        self.bends
    }

    /// 1 if objective `k` is to be large, −1 if it is to be small.
    pub fn sign(&self, k: usize) -> f64 {
        if self.objectives[k].0 == Goal::Maximize { 1.0 } else { -1.0 }
    }

    /// The number of objectives.
    pub fn objectives(&self) -> usize {
        self.objectives.len()
    }

    /// The verdict on a design.
    pub fn verdict(&self, row: &DesignRow) -> Judgement {
        if let Some(failure) = row.result.failures.first() {
            return Judgement::Failed(failure.outcome);
        }
        match self.worth(row) {
            Ok(worth) if worth.met && self.sound && has_folded(row) => Judgement::Folded,
            Ok(worth) => Judgement::Judged(worth),
            Err(column) => Judgement::Missing(column),
        }
    }

    /// Whether a design is complete, and its surface open all the way if that is wanted.
    pub(crate) fn is_whole(&self, row: &DesignRow) -> bool {
        let is_open = |required: &RequiredColumn| {
            let value = required.column.value(row);
            !has_folded(row) && value.is_some_and(|value| required.requirement.is_met(value))
        };
        let soundness = self.requirements.last().filter(|_| self.sound);
        row.result.failures.is_empty() && soundness.is_none_or(is_open)
    }

    /// The worth of a complete design, or the column in which it has no value.
    fn worth(&self, row: &DesignRow) -> Result<Worth, String> {
        let value =
            |column: &NumberColumn| column.value(row).ok_or_else(|| column.name().to_owned());
        let objectives = self.objectives.iter().map(|(_, column)| value(column));
        let objectives = objectives.collect::<Result<_, _>>()?;
        let required = self.requirements.iter().map(|required| value(&required.column));
        let required: Vec<f64> = required.collect::<Result<_, _>>()?;
        let all = || self.requirements.iter().zip(&required);
        Ok(Worth {
            excess: all().map(|(r, value)| excess(&r.requirement, *value)).collect(),
            met: all().all(|(r, value)| r.requirement.is_met(*value)),
            objectives,
            required,
        })
    }

    /// The derivatives of objective `k`, turned so that it is to be large.
    pub(crate) fn objective_slopes(
        &self,
        k: usize,
        row: &DesignRow,
        parameter: &Parameter,
    ) -> Slopes {
        self.objectives[k].1.slopes(row, parameter).scaled(self.sign(k))
    }

    /// The derivative of objective `k` with respect to a parameter; `None` at a kink, or of a row without derivatives.
    pub fn objective_slope(&self, k: usize, row: &DesignRow, parameter: &Parameter) -> Option<f64> {
        self.objectives[k].1.slopes(row, parameter).smooth()
    }

    /// The derivatives of how far the design is within requirement `k`, relative to the limit.
    pub(crate) fn margin_slopes(&self, k: usize, row: &DesignRow, parameter: &Parameter) -> Slopes {
        let RequiredColumn { requirement, column } = &self.requirements[k];
        column.slopes(row, parameter).scaled(direction(requirement) / size(requirement))
    }
}

/// Whether the surface of a design folds on the way.
pub(crate) fn has_folded(row: &DesignRow) -> bool {
    row.result.puncture.is_some_and(|puncture| puncture.measures.fold_force.is_some())
}

/// 1 if values are to be above the limit, −1 if they are to be below.
pub(crate) fn direction(requirement: &Requirement) -> f64 {
    match requirement.relation {
        Relation::AtLeast | Relation::Above | Relation::Equal => 1.0,
        Relation::AtMost | Relation::Below => -1.0,
    }
}

/// The size that shortfalls are relative to: the limit, or 1 if that is 0.
pub(crate) fn size(requirement: &Requirement) -> f64 {
    if requirement.limit == 0.0 { 1.0 } else { requirement.limit.abs() }
}

/// How far a value is beyond a requirement, relative to its size. A strict one is aimed at a little within.
fn excess(requirement: &Requirement, value: f64) -> f64 {
    let excess = direction(requirement) * (requirement.limit - value) / size(requirement);
    match requirement.relation {
        Relation::Above | Relation::Below => excess + 1e-8,
        _ => excess,
    }
}

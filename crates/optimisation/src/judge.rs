//! The worth of a design: its objectives, and how far it is from every requirement.

mod parts;

use ranking::{Goal, Relation, Requirement};
use results::{DesignRow, Outcome};
use sweep::Parameter;

use crate::fitness::CriterionEnds;
use crate::goal::DesignGoal;
use crate::looked::LookedRow;
use crate::made::{MadeJudge, MadeQuantity, Skins, Stake};
use crate::number_column::NumberColumn;
use crate::slopes::Slopes;
use parts::JudgeParts;

/// The judgement of a design by a goal.
#[derive(Clone, Debug, PartialEq)]
pub enum Judgement {
    /// The design has every objective and every column that is required.
    Judged(Worth),
    /// The goal is about what is made, and of this design only what is drawn is known.
    Drawn(DrawnWorth),
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
    /// The objectives as designs are compared by them: a yield, which is a staircase, with the part of its next step.
    pub compared: Vec<f64>,
    /// The values of the columns that are required.
    pub required: Vec<f64>,
    /// How far it is beyond each requirement, relative to the limit; above 0 where it falls short.
    pub excess: Vec<f64>,
    /// Whether it meets every requirement.
    pub met: bool,
}

/// The worth of a design as it is drawn, by the requirements that the skins made of it are to meet, too.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnWorth {
    /// The values of the columns that are required, without those of what is made.
    pub required: Vec<f64>,
    /// The largest shortfall, relative to the limit; 0 where every requirement is met.
    pub shortfall: f64,
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
pub(crate) struct RequiredColumn<C> {
    pub requirement: Requirement,
    pub column: C,
}

/// A column that a design is judged by: of what is drawn, or a quantity over what is made, by its index.
enum GoalColumn {
    Drawn(NumberColumn),
    Made(usize),
}

/// Judges designs by a goal.
pub struct Judge {
    objectives: Vec<(Goal, GoalColumn)>,
    requirements: Vec<RequiredColumn<GoalColumn>>,
    sound: bool,
    bends: bool,
    made: Option<MadeJudge>,
}

impl Judge {
    /// A judge by `goal`, in whose fitness those criteria are rescaled that have their ends there.
    pub fn new(goal: &DesignGoal) -> Self {
        Self::rescaling(goal, goal.fitness.as_ref().map_or(&[], |fitness| &fitness.ends))
    }

    /// A judge by `goal`, in whose fitness the criteria are rescaled between these ends.
    pub fn rescaling(goal: &DesignGoal, ends: &[CriterionEnds]) -> Self {
        JudgeParts { goal, ends }.judge()
    }

    /// A judge by what `goal` says of designs as they are drawn.
    pub(crate) fn as_drawn(goal: &DesignGoal, ends: &[CriterionEnds]) -> Self {
        JudgeParts { goal: &goal.as_drawn(), ends }.judge()
    }

    /// What is judged of skins that are made, if the goal is about them.
    pub(crate) fn made(&self) -> Option<&MadeJudge> {
        self.made.as_ref()
    }

    /// The objectives and requirements that are about what is made, each with the index of its quantity.
    pub(crate) fn stakes(&self) -> impl Iterator<Item = (Stake, usize)> {
        let quantity = |column: &GoalColumn| match column {
            GoalColumn::Made(q) => Some(*q),
            GoalColumn::Drawn(_) => None,
        };
        let objectives = self.objectives.iter().enumerate();
        let objectives =
            objectives.filter_map(move |(k, (_, c))| Some((Stake::Objective(k), quantity(c)?)));
        let required = self.requirements.iter().enumerate();
        let required =
            required.filter_map(move |(k, r)| Some((Stake::Requirement(k), quantity(&r.column)?)));
        objectives.chain(required)
    }

    /// The quantities over what is made that are told, each name once.
    pub fn quantities(&self) -> Vec<(String, MadeQuantity)> {
        let mut all: Vec<(String, MadeQuantity)> = Vec::new();
        for used in self.made.iter().flat_map(|made| &made.quantities) {
            if !all.iter().any(|(name, _)| *name == used.name) {
                all.push((used.name.clone(), used.quantity.clone()));
            }
        }
        all
    }

    /// Whether requirement `k` is about a yield.
    pub(crate) fn is_yield(&self, k: usize) -> bool {
        let name = &self.requirements[k].requirement.column;
        self.made.is_some() && name == MadeQuantity::YIELD
    }

    /// Whether objective `k` is a yield.
    pub(crate) fn is_yield_objective(&self, k: usize) -> bool {
        let is_yield =
            |made: &MadeJudge, q: usize| made.quantities[q].quantity == MadeQuantity::Yield;
        match (&self.objectives[k].1, &self.made) {
            (GoalColumn::Made(q), Some(made)) => is_yield(made, *q),
            _ => false,
        }
    }

    /// Whether objective `k` is about what is made.
    pub(crate) fn is_made_objective(&self, k: usize) -> bool {
        matches!(self.objectives[k].1, GoalColumn::Made(_))
    }

    /// Whether requirement `k` is about what is made.
    pub(crate) fn is_made(&self, k: usize) -> bool {
        matches!(self.requirements[k].column, GoalColumn::Made(_))
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

    /// The verdict on a design, of a goal that is about what is made by what is drawn alone.
    pub fn verdict(&self, row: &DesignRow) -> Judgement {
        self.verdict_with(row, None)
    }

    /// The verdict on a design of which these skins are made.
    pub(crate) fn verdict_with(&self, row: &DesignRow, skins: Option<&Skins>) -> Judgement {
        if let Some(failure) = row.result.failures.first() {
            return Judgement::Failed(failure.outcome);
        }
        if let (Some(made), None) = (&self.made, skins) {
            return made.as_drawn(row);
        }
        let no_skins = Skins::default();
        match self.worth(row, skins.unwrap_or(&no_skins)) {
            Ok(worth) if worth.met && self.sound && has_folded(row) => Judgement::Folded,
            Ok(worth) => Judgement::Judged(worth),
            Err(column) => Judgement::Missing(column),
        }
    }

    /// Whether a design is complete, and its surface open all the way if that is wanted.
    pub(crate) fn is_whole(&self, row: &DesignRow) -> bool {
        let is_open = |required: &RequiredColumn<GoalColumn>| {
            let value = match &required.column {
                GoalColumn::Drawn(column) => column.value(row),
                GoalColumn::Made(_) => None,
            };
            !has_folded(row) && value.is_some_and(|value| required.requirement.is_met(value))
        };
        let soundness = self.requirements.last().filter(|_| self.sound);
        row.result.failures.is_empty() && soundness.is_none_or(is_open)
    }

    /// The worth of a complete design, or the column in which it has no value.
    fn worth(&self, row: &DesignRow, skins: &Skins) -> Result<Worth, String> {
        let objectives = self.objectives.iter().map(|(_, column)| self.value(column, row, skins));
        let objectives: Vec<f64> = objectives.collect::<Result<_, _>>()?;
        let compared = self.objectives.iter().zip(&objectives);
        let compared = compared.map(|((_, column), value)| match (column, &self.made) {
            (GoalColumn::Made(q), Some(made)) => made.compared(*q, skins).unwrap_or(*value),
            _ => *value,
        });
        let required = self.requirements.iter().map(|r| self.value(&r.column, row, skins));
        let required: Vec<f64> = required.collect::<Result<_, _>>()?;
        let all = || self.requirements.iter().zip(&required);
        Ok(Worth {
            excess: all().map(|(r, value)| self.excess(r, *value, skins)).collect(),
            met: all().all(|(r, value)| r.requirement.is_met(*value)),
            compared: compared.collect(),
            objectives,
            required,
        })
    }

    /// The value of a design in a column, or the name of the column in which it has none.
    fn value(&self, column: &GoalColumn, row: &DesignRow, skins: &Skins) -> Result<f64, String> {
        match (column, &self.made) {
            (GoalColumn::Drawn(column), _) => {
                column.value(row).ok_or_else(|| column.name().to_owned())
            }
            (GoalColumn::Made(q), Some(made)) => {
                made.value(*q, skins).ok_or_else(|| made.quantities[*q].name.clone())
            }
            (GoalColumn::Made(_), None) => Err(MadeQuantity::YIELD.to_owned()),
        }
    }

    /// How far a design is beyond a requirement, relative to its size.
    fn excess(&self, of: &RequiredColumn<GoalColumn>, value: f64, skins: &Skins) -> f64 {
        let made = match (&of.column, &self.made) {
            (GoalColumn::Made(q), Some(made)) => made.excess(*q, &of.requirement, skins),
            _ => None,
        };
        made.unwrap_or_else(|| excess(&of.requirement, value))
    }

    /// The derivatives of objective `k`, turned so that it is to be large.
    pub(crate) fn objective_slopes(
        &self,
        k: usize,
        row: &LookedRow,
        parameter: &Parameter,
    ) -> Slopes {
        let slopes = match &self.objectives[k].1 {
            GoalColumn::Drawn(column) => column.slopes(&row.drawn, parameter),
            GoalColumn::Made(_) => row.made_slopes(Stake::Objective(k), parameter),
        };
        slopes.scaled(self.sign(k))
    }

    /// The derivative of objective `k`, a column of what is drawn, with respect to a parameter; `None` at a kink, or of a row without
    /// derivatives.
    pub fn objective_slope(&self, k: usize, row: &DesignRow, parameter: &Parameter) -> Option<f64> {
        match &self.objectives[k].1 {
            GoalColumn::Drawn(column) => column.slopes(row, parameter).smooth(),
            GoalColumn::Made(_) => None,
        }
    }

    /// The derivatives of how far the design is within requirement `k`, relative to the limit.
    pub(crate) fn margin_slopes(&self, k: usize, row: &LookedRow, parameter: &Parameter) -> Slopes {
        let RequiredColumn { requirement, column } = &self.requirements[k];
        let slopes = match column {
            GoalColumn::Drawn(column) => column.slopes(&row.drawn, parameter),
            GoalColumn::Made(_) => row.made_slopes(Stake::Requirement(k), parameter),
        };
        // The margin of the skin that has to meet is relative already.
        slopes.scaled(if self.is_yield(k) { 1.0 } else { margin_rate(requirement) })
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

/// How fast the margin of a requirement, relative to its size, grows with the value.
pub(crate) fn margin_rate(requirement: &Requirement) -> f64 {
    direction(requirement) / size(requirement)
}

/// The size that shortfalls are relative to: the limit, or 1 if that is 0.
pub(crate) fn size(requirement: &Requirement) -> f64 {
    if requirement.limit == 0.0 { 1.0 } else { requirement.limit.abs() }
}

/// How far a value is beyond a requirement, relative to its size. A strict one is aimed at a little within.
pub(crate) fn excess(requirement: &Requirement, value: f64) -> f64 {
    let excess = direction(requirement) * (requirement.limit - value) / size(requirement);
    match requirement.relation {
        Relation::Above | Relation::Below => excess + 1e-8,
        _ => excess,
    }
}

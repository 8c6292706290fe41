//! The worth of a design: its objectives, and how far it is from every requirement.

use ranking::{Goal, Relation, Requirement};
use results::columns::{design_columns, measure_of};
use results::{Column, DesignRow, Outcome, SlopeSide};
use sweep::{Measure, Parameter};

use crate::goal::DesignGoal;

/// The requirement that the surface of the substrate has not folded: no gap has closed at the critical tilt.
const SOUND: (&str, Relation, f64) = ("gap_stretch_min", Relation::AtLeast, 0.0);

/// Step of the differences along extrapolated rows, relative to the size of the parameter.
const STEP: f64 = 1e-6;

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

/// A column of numbers.
struct NumberColumn(Column<DesignRow>);

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

/// The derivatives of a value on both sides of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slopes {
    pub left: Option<f64>,
    pub right: Option<f64>,
}

impl NumberColumn {
    fn value(&self, row: &DesignRow) -> Option<f64> {
        self.0.cell(row).number()
    }

    /// The derivatives with respect to a parameter, from rows that are extrapolated by those of the measures.
    fn slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        let on = |side| {
            let step = STEP * parameter.size(&row.case)?;
            let at = |by| self.value(&row.extrapolated_by(parameter, by, side)?);
            Some((at(step)? - at(-step)?) / (2.0 * step))
        };
        Slopes { left: on(SlopeSide::Left), right: on(SlopeSide::Right) }
    }
}

impl Slopes {
    fn scaled(self, factor: f64) -> Self {
        Self { left: self.left.map(|x| x * factor), right: self.right.map(|x| x * factor) }
    }

    /// The slope of the side on which the value rises the most, 0 if it falls on both. Of two sides that are the same, or one that is
    /// missing, the other. `None` if both are.
    pub fn uphill(self) -> Option<f64> {
        let (left, right) = (self.left.or(self.right)?, self.right.or(self.left)?);
        let (gain_left, gain_right) = (-left, right);
        Some(match (gain_left > 0.0, gain_right > 0.0) {
            _ if left == right => left,
            (false, false) => 0.0,
            _ if gain_left > gain_right => left,
            _ => right,
        })
    }

    /// The one slope; `None` at a kink.
    pub fn smooth(self) -> Option<f64> {
        let (left, right) = (self.left.or(self.right)?, self.right.or(self.left)?);
        let size = left.abs().max(right.abs());
        ((left - right).abs() <= 1e-6 * size).then_some(left)
    }
}

impl Judge {
    /// A judge by `goal`.
    pub fn new(goal: &DesignGoal) -> Self {
        let sweep = goal.space.sweep();
        let column = |name: &str| {
            let mut columns = design_columns(sweep).into_iter();
            columns.find(|column| column.name == name).map(NumberColumn)
        };
        let objectives = goal.objectives.iter();
        let objectives = objectives.filter_map(|o| Some((o.goal, column(&o.column)?))).collect();
        let sound = goal.sound && sweep.measures().contains(&Measure::Puncture);
        let mut wanted = goal.requirements.clone();
        let (name, relation, limit) = SOUND;
        wanted.extend(sound.then(|| Requirement { column: name.to_owned(), relation, limit }));
        let objective_columns = goal.objectives.iter().map(|objective| objective.column.as_ref());
        let mut columns = objective_columns.chain(wanted.iter().map(|r| r.column.as_str()));
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

    /// The worth of a complete design, or the column in which it has no value.
    fn worth(&self, row: &DesignRow) -> Result<Worth, String> {
        let value =
            |column: &NumberColumn| column.value(row).ok_or_else(|| column.0.name.to_string());
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_a_kink_the_way_up_counts() {
        let slopes = |left, right| Slopes { left, right };
        assert_eq!(slopes(Some(2.0), Some(2.0)).uphill(), Some(2.0));
        assert_eq!(slopes(Some(1.0), Some(-3.0)).uphill(), Some(0.0));
        assert_eq!(slopes(Some(-1.0), Some(3.0)).uphill(), Some(3.0));
        assert_eq!(slopes(Some(-4.0), Some(3.0)).uphill(), Some(-4.0));
        assert_eq!(slopes(Some(-4.0), Some(-3.0)).uphill(), Some(-4.0));
        assert_eq!(slopes(None, Some(-3.0)).uphill(), Some(-3.0));
        assert_eq!(slopes(None, None).uphill(), None);
        assert_eq!(slopes(Some(1.0), Some(1.1)).smooth(), None);
        assert_eq!(slopes(Some(1.0), Some(1.0)).smooth(), Some(1.0));
    }
}

//! What a judge is made of.

use ranking::{Goal, Relation, Requirement};
use results::columns::{GAP_STRETCH_MIN, design_columns, measure_of};
use sweep::Measure;

use super::{GoalColumn, Judge, RequiredColumn};
use crate::fitness::{CriterionEnds, Fitness};
use crate::goal::DesignGoal;
use crate::made::{MadeJudge, MadeQuantity, UsedQuantity};
use crate::number_column::NumberColumn;

/// The requirement that the surface of the substrate has not folded: no gap has closed at the critical tilt.
const SOUND: (&str, Relation, f64) = (GAP_STRETCH_MIN, Relation::AtLeast, 0.0);

/// A goal, and the ends between which the criteria of its fitness are rescaled.
pub(super) struct JudgeParts<'a> {
    pub goal: &'a DesignGoal,
    pub ends: &'a [CriterionEnds],
}

impl JudgeParts<'_> {
    pub fn judge(&self) -> Judge {
        let quantities = self.quantities();
        let column = |name: &str, large: bool| {
            let is_it = |used: &UsedQuantity| used.name == name && used.large == large;
            let made = quantities.iter().position(is_it).map(GoalColumn::Made);
            made.or_else(|| self.column(name).map(GoalColumn::Drawn))
        };
        let objectives = self.goal.objectives.iter().filter_map(|objective| {
            let large = objective.goal == Goal::Maximize;
            Some((objective.goal, column(&objective.column, large)?))
        });
        let soundness = self.soundness();
        let required = |requirement: Requirement| {
            let large = super::direction(&requirement) > 0.0;
            let column = column(&requirement.column, large)?;
            Some(RequiredColumn { requirement, column })
        };
        let mut requirements: Vec<_> =
            self.goal.requirements.iter().cloned().filter_map(required).collect();
        requirements.extend(soundness.clone().and_then(|sound| {
            let of_skins = |used: &UsedQuantity| MadeQuantity::base(&used.name) == sound.column;
            let made = quantities.iter().rposition(of_skins).map(GoalColumn::Made);
            let column = made.or_else(|| self.column(&sound.column).map(GoalColumn::Drawn))?;
            Some(RequiredColumn { requirement: sound, column })
        }));
        Judge {
            objectives: objectives.collect(),
            requirements,
            sound: soundness.is_some(),
            bends: self.bends(),
            made: self.goal.is_about_skins().then(|| self.made(quantities)),
        }
    }

    /// The column of that name of a design as it is drawn; of a margin how far the design is within its bounds.
    fn column(&self, name: &str) -> Option<NumberColumn> {
        let sweep = self.goal.space.sweep();
        match (name, &self.goal.fitness) {
            (Fitness::COLUMN, Some(fitness)) => {
                Some(NumberColumn::Fitness(Fitness::new(fitness, sweep, self.ends)))
            }
            (MadeQuantity::MARGIN, _) => Some(NumberColumn::Margin(self.bounds())),
            _ => {
                let mut columns = design_columns(sweep).into_iter();
                columns.find(|column| column.name == name).map(NumberColumn::Known)
            }
        }
    }

    /// The requirements of what is drawn, then that the surface has not folded if that is wanted.
    fn bounds(&self) -> Vec<RequiredColumn<NumberColumn>> {
        let requirements = self.goal.requirements.iter();
        let plain =
            requirements.filter(|requirement| self.goal.quantity(&requirement.column).is_none());
        let bound = |requirement: Requirement| {
            let column = self.column(&requirement.column)?;
            Some(RequiredColumn { requirement, column })
        };
        plain.cloned().chain(self.soundness()).filter_map(bound).collect()
    }

    fn soundness(&self) -> Option<Requirement> {
        let sound =
            self.goal.sound && self.goal.space.sweep().measures().contains(&Measure::Puncture);
        let (name, relation, limit) = SOUND;
        sound.then(|| Requirement { column: name.to_owned(), relation, limit })
    }

    /// The quantities over skins: those that the goal names, the yield if there is something to meet, and that surfaces stay open.
    fn quantities(&self) -> Vec<UsedQuantity> {
        if !self.goal.is_about_skins() {
            return Vec::new();
        }
        let objectives = self.goal.objectives.iter().filter_map(|o| {
            Some(UsedQuantity::of_objective(&o.column, self.goal.quantity(&o.column)?, o.goal))
        });
        let required =
            self.goal.requirements.iter().filter_map(|r| {
                Some(UsedQuantity::of_requirement(r, self.goal.quantity(&r.column)?))
            });
        let mut used: Vec<UsedQuantity> = objectives.chain(required).collect();
        let plain = self.goal.requirements.iter().any(|r| self.goal.quantity(&r.column).is_none());
        let is_yield = |used: &UsedQuantity| used.quantity == MadeQuantity::Yield;
        if plain && !used.iter().any(is_yield) {
            let name = MadeQuantity::YIELD;
            used.push(UsedQuantity::of_objective(name, MadeQuantity::Yield, Goal::Maximize));
        }
        let open = self.soundness().and_then(|r| UsedQuantity::of_soundness(&r.column, &used));
        used.extend(open);
        used
    }

    fn made(&self, quantities: Vec<UsedQuantity>) -> MadeJudge {
        let bases = quantities.iter().filter_map(|used| match &used.quantity {
            MadeQuantity::Quantile { column, .. } => self.column(column),
            MadeQuantity::Yield => None,
        });
        MadeJudge {
            bounds: self.bounds(),
            columns: bases.collect(),
            quantities,
            sound: self.soundness().is_some(),
            skins: self.goal.skins,
        }
    }

    /// Whether a column of bending is part of the goal.
    fn bends(&self) -> bool {
        let criteria = self.goal.fitness.iter().flat_map(|fitness| &fitness.criteria);
        let criteria = self.goal.objectives.iter().chain(criteria).map(|c| c.column.as_ref());
        let required = self.goal.requirements.iter().map(|r| r.column.as_str());
        let mut columns = criteria.chain(required).map(MadeQuantity::base);
        columns.any(|column| measure_of(column) == Some(Measure::Flexure))
    }
}

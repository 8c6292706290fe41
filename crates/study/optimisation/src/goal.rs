//! The goal of an optimisation as it is written: variables, objectives, requirements.

mod bounds;
mod fitness_section;
mod reader;
mod refusal;
mod section;
mod statistics;

use ranking::{Criterion, FitnessGoal, Requirement, Standard, Worth};

use crate::space::DesignSpace;
use crate::statistic::Statistic;

/// Times as many samples as of any design are taken of those near the best.
const MORE: usize = 5;

/// The goal of an optimisation: the space in which designs are searched, and what is good there.
#[derive(Clone, Debug)]
pub struct DesignGoal {
    /// The variables, and what all designs share.
    pub space: DesignSpace,
    /// The columns that are to be large or small: one gives an optimum, two to four a front.
    pub objectives: Vec<Criterion>,
    /// The bounds that columns must keep.
    pub requirements: Vec<Requirement>,
    /// The standards of which requirements are levels.
    pub standards: Vec<&'static Standard>,
    /// The criteria of the fitness, if the goal names it.
    pub fitness: Option<FitnessGoal>,
    /// Whether only designs count whose surface has not folded.
    pub sound: bool,
    /// The number of points that fill the space before any is improved.
    pub samples: usize,
    /// The number of points of a front.
    pub points: usize,
    /// The number of samples of each design, `skins` in the file, if the goal is about them.
    pub realisations: usize,
    /// The seed of the points that fill the space.
    pub seed: u64,
    text: String,
}

impl DesignGoal {
    /// The name of the goal, which is also that of the folder of its results.
    pub fn name(&self) -> &str {
        self.space.sweep().name()
    }

    /// The goal in TOML, which reads back as the same.
    pub fn to_toml(&self) -> &str {
        &self.text
    }

    /// The columns of the objectives, then of the requirements, each with the value of a design.
    pub fn values<'a>(&'a self, worth: &'a Worth) -> impl Iterator<Item = (&'a str, f64)> {
        let objectives = self.objectives.iter().map(|objective| objective.column.as_ref());
        let columns = objectives.chain(self.requirements.iter().map(|r| r.column.as_str()));
        columns.zip(worth.objectives.iter().chain(&worth.required).copied())
    }

    /// The statistic over samples that a column of this goal stands for; `None` of a column of `designs.csv` or the fitness.
    pub fn statistic(&self, column: &str) -> Option<Statistic> {
        let sweep = self.space.sweep();
        // With imperfections such names are columns of tables, about the random rows of a design.
        let has_samples = !sweep.deviations().is_empty() && !sweep.is_imperfect();
        Statistic::named(column).filter(|_| has_samples)
    }

    /// Whether the goal is about samples, not only about nominal designs.
    pub fn is_about_samples(&self) -> bool {
        let objectives = self.objectives.iter().map(|objective| objective.column.as_ref());
        let required = self.requirements.iter().map(|requirement| requirement.column.as_str());
        objectives.chain(required).any(|column| self.statistic(column).is_some())
    }

    /// The goal for nominal designs, that the search begins with: quantiles are those columns themselves, a yield as an objective is left
    /// for the margin, and a yield that is required for nothing.
    #[must_use]
    pub fn nominal(&self) -> Self {
        let mut goal = self.clone();
        for objective in &mut goal.objectives {
            match self.statistic(&objective.column) {
                Some(Statistic::Quantile { column, .. }) => objective.column = column.into(),
                Some(Statistic::Yield) => objective.column = Statistic::MARGIN.into(),
                None => {}
            }
        }
        goal.requirements.retain(|r| self.statistic(&r.column) != Some(Statistic::Yield));
        for requirement in &mut goal.requirements {
            if let Some(Statistic::Quantile { column, .. }) = self.statistic(&requirement.column) {
                requirement.column = column;
            }
        }
        goal
    }

    /// The goal with more samples of each design.
    #[must_use]
    pub(crate) fn finer(&self) -> Self {
        Self { realisations: MORE * self.realisations, ..self.clone() }
    }
}

//! Goal of an optimisation: variables, objectives and requirements.

mod bounds;
mod fitness_section;
mod reader;
mod refusal;
pub(crate) mod section;
mod statistics;

use ranking::{Criterion, FitnessGoal, Requirement, Standard, Worth};

use crate::space::DesignSpace;
use crate::statistic::Statistic;

/// Factor by which [`DesignGoal::finer`] increases the number of samples of each design.
const MORE: usize = 5;

/// Goal of an optimisation: design space, objectives and requirements.
#[derive(Clone, Debug)]
pub struct DesignGoal {
    /// Variables, and the values of all other parameters.
    pub space: DesignSpace,
    /// Columns to maximise or minimise.
    ///
    /// One objective gives an optimum, two to four give a front.
    pub objectives: Vec<Criterion>,
    /// Bounds on columns that a design must meet.
    pub requirements: Vec<Requirement>,
    /// Standards to which the levels in the key `protects` belong, e.g. for `needle 2`.
    pub standards: Vec<&'static Standard>,
    /// Criteria of the fitness, if it is an objective or requirement.
    pub fitness: Option<FitnessGoal>,
    /// True if designs with a folded surface are excluded.
    pub sound: bool,
    /// True if the best design must also meet the requirements in the checks with finer models.
    pub confirm: bool,
    /// Step to which the lengths of the best design are rounded; `None` without rounding.
    ///
    /// In mm, or divided by the thickness of a scale if the goal states no thickness in mm.
    pub round: Option<f64>,
    /// Number of space-filling points.
    pub samples: usize,
    /// Number of points of a front.
    pub points: usize,
    /// Number of samples of each design, used if the goal contains a quantile or yield.
    ///
    /// The key in the file is `skins`.
    pub samples_per_design: usize,
    /// Seed of the space-filling points.
    pub seed: u64,
    text: String,
}

impl DesignGoal {
    /// Returns the name of the goal, which is also the name of its results folder.
    pub fn name(&self) -> &str {
        self.space.sweep().name()
    }

    /// Returns the goal in TOML, including settings that override keys of the file.
    pub fn to_toml(&self) -> &str {
        &self.text
    }

    /// Returns each column of objectives and requirements with its value for a design.
    ///
    /// `worth` holds the values of the design.
    pub fn values<'a>(&'a self, worth: &'a Worth) -> impl Iterator<Item = (&'a str, f64)> {
        self.columns().zip(worth.objectives.iter().chain(&worth.required).copied())
    }

    /// Returns the statistic over samples with the name `column`, e.g. `critical_force_p05`.
    ///
    /// `None` for columns of `designs.csv` and for the fitness.
    pub fn statistic(&self, column: &str) -> Option<Statistic> {
        let sweep = self.space.sweep();
        // In a sweep with imperfections these names are columns of `designs.csv`: quantiles over
        // the imperfect rows of a design.
        let has_samples = !sweep.deviations().is_empty() && !sweep.is_imperfect();
        Statistic::named(column).filter(|_| has_samples)
    }

    /// Returns the columns of the objectives, then the columns of the requirements.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        let objectives = self.objectives.iter().map(|objective| objective.column.as_ref());
        objectives.chain(self.requirements.iter().map(|requirement| requirement.column.as_str()))
    }

    /// Returns the columns of objectives, requirements and criteria of the fitness, in this order.
    pub(crate) fn measured_columns(&self) -> impl Iterator<Item = &str> {
        let criteria = self.fitness.iter().flat_map(|fitness| &fitness.criteria);
        self.columns().chain(criteria.map(|criterion| criterion.column.as_ref()))
    }

    /// Returns true if an objective or requirement is a statistic over samples.
    pub fn is_about_samples(&self) -> bool {
        self.columns().any(|column| self.statistic(column).is_some())
    }

    /// Returns true if the goal requires a yield.
    pub(crate) fn requires_yield(&self) -> bool {
        let mut required = self.requirements.iter();
        required.any(|requirement| self.statistic(&requirement.column) == Some(Statistic::Yield))
    }

    /// Returns the goal for nominal designs, which a search optimises first.
    ///
    /// A quantile of a column is replaced by the column. A yield as objective is replaced by the
    /// smallest margin over the requirements (`Statistic::MARGIN`). A required yield is dropped.
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

    /// Returns the goal with five times as many samples of each design.
    #[must_use]
    pub(crate) fn finer(&self) -> Self {
        Self { samples_per_design: MORE * self.samples_per_design, ..self.clone() }
    }
}

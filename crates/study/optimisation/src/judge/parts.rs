//! Builds a judge from a goal.

use ranking::{CriterionEnds, Goal, Requirement};
use results::columns::measure_of;
use sweep::Measure;

use super::{Judge, Source};
use crate::column::NumberColumn;
use crate::goal::DesignGoal;
use crate::requirement_bounds::{Bound, Bounds, soundness};
use crate::sample::{SampleJudge, UsedStatistic};
use crate::statistic::Statistic;

impl Judge {
    /// Creates the judge for `goal`.
    ///
    /// Criteria of a fitness are rescaled between the worst and best values that the goal states.
    pub fn new(goal: &DesignGoal) -> Self {
        Self::rescaling(goal, goal.fitness.as_ref().map_or(&[], |fitness| &fitness.ends))
    }

    /// Creates the judge for `goal`. `ends` are the worst and best values of the fitness criteria.
    pub fn rescaling(goal: &DesignGoal, ends: &[CriterionEnds]) -> Self {
        JudgeParts { goal, ends }.judge()
    }
}

/// Builder of a judge: a goal, and the worst and best values of the criteria of its fitness.
struct JudgeParts<'a> {
    goal: &'a DesignGoal,
    ends: &'a [CriterionEnds],
}

impl JudgeParts<'_> {
    /// Builds the judge.
    fn judge(&self) -> Judge {
        let mut statistics = self.statistics();
        let objectives = self.goal.objectives.iter().filter_map(|objective| {
            let large = objective.goal == Goal::Maximize;
            Some((objective.goal, self.source(&objective.column, large, &statistics)?))
        });
        let objectives = objectives.collect();
        let mut requirements: Vec<_> = self
            .goal
            .requirements
            .iter()
            .filter_map(|requirement| {
                let large = requirement.direction() > 0.0;
                let column = self.source(&requirement.column, large, &statistics)?;
                Some(Bound { requirement: requirement.clone(), column })
            })
            .collect();
        let open = self.open(&mut statistics);
        let soundness = open.as_ref().map(|_| requirements.len());
        requirements.extend(open);
        let samples =
            SampleJudge { bounds: self.bounds(), statistics, count: self.goal.samples_per_design };
        Judge { objectives, requirements, soundness, measures: self.measures(), samples }
    }

    /// Returns the source of the values of the column or statistic `name`.
    ///
    /// `large` is true if large values are better. `None` for an unknown name.
    fn source(&self, name: &str, large: bool, statistics: &[UsedStatistic]) -> Option<Source> {
        let mut used = statistics.iter();
        used.position(|used| used.name == name && used.large == large)
            .map(Source::Statistic)
            .or_else(|| (name == Statistic::MARGIN).then_some(Source::Margin))
            .or_else(|| self.column(name).map(Source::Nominal))
    }

    /// Returns the column `name` of nominal designs.
    fn column(&self, name: &str) -> Option<NumberColumn> {
        let sweep = self.goal.space.sweep();
        match &self.goal.fitness {
            Some(fitness) if name == NumberColumn::FITNESS => {
                Some(NumberColumn::fitness(fitness, sweep, self.ends))
            }
            _ => NumberColumn::named(sweep, name),
        }
    }

    /// Returns the requirements on columns, then the requirement of an unfolded surface, if any.
    fn bounds(&self) -> Bounds {
        let plain = self.goal.requirements.iter();
        let plain = plain.filter(|requirement| self.goal.statistic(&requirement.column).is_none());
        let soundness = self.soundness();
        let mut all: Vec<_> = plain.cloned().filter_map(|required| self.bound(required)).collect();
        let open = soundness.and_then(|required| self.bound(required));
        let soundness = open.as_ref().map(|_| all.len());
        all.extend(open);
        Bounds { all, soundness }
    }

    /// Returns the requirement with its column; `None` for an unknown column.
    fn bound(&self, requirement: Requirement) -> Option<Bound<NumberColumn>> {
        let column = self.column(&requirement.column)?;
        Some(Bound { requirement, column })
    }

    /// Returns the requirement of an unfolded surface; `None` if the goal does not require it.
    fn soundness(&self) -> Option<Requirement> {
        soundness(self.goal.space.sweep()).filter(|_| self.goal.sound)
    }

    /// Returns the requirement of an unfolded surface with its source; `None` if not required.
    ///
    /// If the goal contains quantiles, the requirement applies to a quantile of the samples. This
    /// quantile is added to `statistics`.
    fn open(&self, statistics: &mut Vec<UsedStatistic>) -> Option<Bound<Source>> {
        let requirement = self.soundness()?;
        let column = match UsedStatistic::of_soundness(&requirement.column, statistics) {
            Some((name, statistic)) => {
                statistics.push(self.used(&name, statistic, true));
                Source::Statistic(statistics.len() - 1)
            }
            None => Source::Nominal(self.column(&requirement.column)?),
        };
        Some(Bound { requirement, column })
    }

    /// Returns the statistics of the goal. The yield is added if columns have requirements.
    fn statistics(&self) -> Vec<UsedStatistic> {
        let goal = self.goal;
        let objectives = goal.objectives.iter();
        let objectives = objectives.map(|o| (o.column.as_ref(), o.goal == Goal::Maximize));
        let required = goal.requirements.iter();
        let required = required.map(|r| (r.column.as_str(), r.direction() > 0.0));
        let named = objectives.chain(required);
        let used =
            named.filter_map(|(name, large)| Some(self.used(name, goal.statistic(name)?, large)));
        let mut used: Vec<UsedStatistic> = used.collect();
        let has_bounds = goal.requirements.iter().any(|r| goal.statistic(&r.column).is_none());
        // Report the yield even if the goal does not contain it: the samples are solved anyway.
        if !used.is_empty() && has_bounds && !used.iter().any(UsedStatistic::is_yield) {
            used.push(self.used(Statistic::YIELD, Statistic::Yield, true));
        }
        used
    }

    /// Returns a statistic with its column; `large` is true if large values are better.
    fn used(&self, name: &str, statistic: Statistic, large: bool) -> UsedStatistic {
        let column = match &statistic {
            Statistic::Quantile { column, .. } => self.column(column),
            Statistic::Yield => None,
        };
        UsedStatistic { name: name.to_owned(), statistic, column, large }
    }

    /// Returns the measures that the columns of the goal depend on.
    fn measures(&self) -> Vec<Measure> {
        let criteria = self.goal.fitness.iter().flat_map(|fitness| &fitness.criteria);
        let criteria = self.goal.objectives.iter().chain(criteria).map(|c| c.column.as_ref());
        let required = self.goal.requirements.iter().map(|r| r.column.as_str());
        criteria.chain(required).map(Statistic::base).filter_map(measure_of).collect()
    }
}

//! Describes binding limits and their multipliers in words.

use ranking::{Criterion, Goal, Requirement};
use results::columns::explain_value;
use text::number;

use crate::candidate::Target;
use crate::evaluated_row::StatisticUse;
use crate::goal::DesignGoal;
use crate::judge::Judge;
use crate::price::{Binding, Limit};
use crate::space::Interval;
use crate::statistic::Statistic;

/// Fraction of its width at rest to which every gap stays open in the stated price.
///
/// The required limit is 0, so a price for a change of the limit by some per cent has no meaning.
const OPEN: f64 = 0.1;

/// Describes the binding limits of a goal and their multipliers in words.
pub struct BindingText<'a> {
    goal: &'a DesignGoal,
    judge: Judge,
}

impl<'a> BindingText<'a> {
    /// Creates an object that describes the limits of `goal`.
    pub fn new(goal: &'a DesignGoal) -> Self {
        Self { goal, judge: Judge::new(goal) }
    }

    /// Returns the requirements of the goal, then the requirement of an unfolded surface, if any.
    pub fn requirements(&self) -> Vec<&Requirement> {
        self.judge.requirements().collect()
    }

    /// Describes a limit, e.g. `coverage >= 0.5` or `gap_over_t at its lower end 0.1`.
    pub fn limit(&self, limit: &Limit, target: &Target) -> String {
        match *limit {
            Limit::Requirement(k)
                if self.judge.is_soundness(k)
                    && self.judge.is_statistic(StatisticUse::Requirement(k)) =>
            {
                "the surface is about to fold in further samples".to_owned()
            }
            Limit::Requirement(k) if self.judge.is_soundness(k) => {
                "the surface is about to fold".to_owned()
            }
            Limit::Requirement(k) => {
                self.requirement(k).map(ToString::to_string).unwrap_or_default()
            }
            Limit::ObjectiveBound(k) => {
                let value = bound_of(target, k) * self.judge.sign(k);
                let sign = if self.judge.sign(k) > 0.0 { ">=" } else { "<=" };
                format!("{} {sign} {}", self.goal.objectives[k].column, rounded(value))
            }
            Limit::Lower(j) => {
                let Interval { parameter, from, .. } = self.goal.space.intervals()[j];
                format!("{} at its lower end {}", parameter.key, number::text(from))
            }
            Limit::Upper(j) => {
                let Interval { parameter, to, .. } = self.goal.space.intervals()[j];
                format!("{} at its upper end {}", parameter.key, number::text(to))
            }
            Limit::FirstContact => "scales about to touch at the end of bending".to_owned(),
        }
    }

    /// Describes the cost of a limit, e.g. `0.01 more coverage costs 0.12 of critical_force`.
    ///
    /// `None` if the multiplier of the limit is unknown.
    pub fn price(&self, binding: &Binding, target: &Target) -> Option<String> {
        if binding.limit.is_yield(&self.judge) {
            return Some("no price: the fraction of samples changes in steps".to_owned());
        }
        let price = binding.price?;
        let objective = &self.goal.objectives[target.objective];
        Some(match binding.limit {
            Limit::Requirement(k) if self.judge.is_soundness(k) => {
                self.openness(k, price, objective)
            }
            Limit::Requirement(k) => {
                let requirement = self.requirement(k)?;
                let column = &requirement.column;
                stricter(requirement.limit, requirement.direction(), column, price, objective)
            }
            Limit::ObjectiveBound(k) => {
                let column = &self.goal.objectives[k].column;
                stricter(bound_of(target, k), self.judge.sign(k), column, price, objective)
            }
            Limit::Lower(j) => self.wider(j, "less", price, objective),
            Limit::Upper(j) => self.wider(j, "more", price, objective),
            Limit::FirstContact => {
                // The limit is a logarithm (O2), so a change of 0.01 is 1 % of the end rotation.
                let costs = amount_of(0.01 * price, objective);
                format!("bending 1 % further without contact {} {costs}", verb(objective))
            }
        })
    }

    /// Describes the gain of the objective if the range of variable `j` is extended by one step.
    ///
    /// `sense` is "more" for the upper end and "less" for the lower end of the range.
    fn wider(&self, j: usize, sense: &str, price: f64, objective: &Criterion) -> String {
        let interval = &self.goal.space.intervals()[j];
        let step = step(interval.length());
        let (key, gain) = (interval.parameter.key, amount_of(step * price, objective));
        format!("{} {sense} {key} would gain {gain}", number::text(step))
    }

    /// Describes the multiplier of requirement `k`, the requirement of an unfolded surface.
    ///
    /// The text states the cost of keeping gaps open by the fraction `OPEN` of their width at rest.
    fn openness(&self, k: usize, price: f64, objective: &Criterion) -> String {
        let of = if self.judge.is_statistic(StatisticUse::Requirement(k)) {
            "the gaps of these samples"
        } else {
            "every gap"
        };
        let (open, costs) = (100.0 * OPEN, amount_of(OPEN * price, objective));
        format!("keeping {of} open by {open} % of its width at rest {} {costs}", verb(objective))
    }

    /// Describes all binding limits in one line.
    pub fn bindings(&self, bindings: &[Binding], target: &Target) -> String {
        let limits: Vec<_> = bindings.iter().map(|b| self.limit(&b.limit, target)).collect();
        limits.join("; ")
    }

    /// Describes all multipliers in one line.
    pub fn prices(&self, bindings: &[Binding], target: &Target) -> String {
        let prices: Vec<_> = bindings.iter().filter_map(|b| self.price(b, target)).collect();
        prices.join("; ")
    }

    fn requirement(&self, k: usize) -> Option<&Requirement> {
        self.judge.requirements().nth(k)
    }
}

/// Describes the cost of tightening the limit of a column by one step.
///
/// A positive `direction` means a lower limit, a negative `direction` an upper limit.
fn stricter(limit: f64, direction: f64, column: &str, price: f64, objective: &Criterion) -> String {
    let step = step(limit);
    let sense = if direction > 0.0 { "more" } else { "less" };
    let (step_amount, costs) = (amount(step, column), verb(objective));
    format!("{step_amount} {sense} {column} {costs} {}", amount_of(step * price, objective))
}

/// Returns the lower bound that `target` sets on an objective, after the change of sign.
fn bound_of(target: &Target, objective: usize) -> f64 {
    let bound = target.lower_bounds.iter().find(|(of, _)| *of == objective);
    bound.map_or(f64::NAN, |(_, bound)| *bound)
}

/// Returns the verb that describes the effect of a tighter limit on `objective`.
///
/// A tighter limit reduces an objective to be maximised, and increases one to be minimised.
fn verb(objective: &Criterion) -> &'static str {
    if objective.goal == Goal::Maximize { "costs" } else { "adds" }
}

/// Returns the power of ten that is between 1 % and 10 % of `size`.
fn step(size: f64) -> f64 {
    let size = if size == 0.0 { 1.0 } else { size.abs() };
    // The step must be small, because a multiplier is a derivative.
    10_f64.powi(size.log10().floor() as i32 - 1)
}

/// Formats an amount of a column, with the unit of columns in N, mm or kg.
fn amount(amount: f64, column: &str) -> String {
    let unit = explain_value(Statistic::base(column)).map_or("-", |(unit, _)| unit);
    let is_physical = ["N", "mm", "kg"].iter().any(|beginning| unit.starts_with(beginning));
    let amount = rounded(amount);
    if is_physical { format!("{amount} {unit}") } else { amount }
}

/// Formats an amount of an objective, e.g. `0.12 of critical_force`.
fn amount_of(value: f64, objective: &Criterion) -> String {
    format!("{} of {}", amount(value, &objective.column), objective.column)
}

/// Formats a number with three significant digits.
fn rounded(value: f64) -> String {
    number::rounded(value, 3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_small_powers_of_ten() {
        assert_eq!([0.5, 2.0, 0.0, -30.0].map(step), [0.01, 0.1, 0.1, 1.0]);
    }

    #[test]
    fn prices_state_the_cost_of_a_tighter_limit() {
        let text = "name = 'x'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n[designs]\nlength_over_t = 1\n\
                    slant_deg = 75\n[material]\nthickness_mm = 1\nsubstrate_modulus_MPa = 1\nscale_density_kg_m3 = 1000\n\
                    [goal]\nminimize = 'areal_mass_kg_m2'\nrequire = ['critical_force_N >= 2', 'penetration <= 0.4']";
        let goal = DesignGoal::parse(text, "x.toml", &[]).expect("a goal");
        let binding_text = BindingText::new(&goal);
        let target = Target { objective: 0, lower_bounds: Vec::new() };
        let say = |limit: Limit, price| {
            let binding = Binding { limit, price: Some(price) };
            let limit = binding_text.limit(&binding.limit, &target);
            format!("{limit}: {}", binding_text.price(&binding, &target).expect("a price"))
        };
        insta::assert_snapshot!(say(Limit::Requirement(0), 0.25), @"critical_force_N >= 2: 0.1 N more critical_force_N adds 0.025 kg/m^2 of areal_mass_kg_m2");
        insta::assert_snapshot!(say(Limit::Requirement(1), 3.0), @"penetration <= 0.4: 0.01 less penetration adds 0.03 kg/m^2 of areal_mass_kg_m2");
        insta::assert_snapshot!(say(Limit::Lower(0), 1.0), @"gap_over_t at its lower end 0.1: 0.01 less gap_over_t would gain 0.01 kg/m^2 of areal_mass_kg_m2");
    }
}

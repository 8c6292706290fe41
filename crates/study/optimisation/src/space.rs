//! Design space of a search: variables, points, and the cases of points.

use std::ops::RangeInclusive;

use sweep::{Case, Parameter, Scalar, Sweep, VariableValues};
use text::number;

/// Step to which angles of a design are rounded, in degrees.
const ANGLE_STEP_DEG: f64 = 1.0;

/// Tolerance for round-off of a value divided by its step.
const ROUND_OFF: f64 = 1e-9;

/// Continuous variable: a parameter that varies between two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Parameter.
    pub parameter: &'static Parameter,
    /// Smallest value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
    /// Step to which values are rounded; `None` if the parameter is not rounded.
    pub step: Option<f64>,
}

/// Discrete variable: a parameter that has one of a few values.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Parameter.
    pub parameter: &'static Parameter,
    /// Values, at least one.
    pub values: Vec<Scalar>,
}

/// Point of the design space, with a coordinate for each variable.
#[derive(Clone, Debug, PartialEq)]
pub struct SpacePoint {
    /// Fraction of each interval, from 0 (lower end) to 1 (upper end).
    pub fractions: Vec<f64>,
    /// For each choice, the index of its value.
    pub chosen: Vec<usize>,
}

impl SpacePoint {
    /// Returns a copy of the point at `fraction` of the interval with index `interval`.
    pub(crate) fn with_fraction(&self, interval: usize, fraction: f64) -> Self {
        let mut moved = self.clone();
        moved.fractions[interval] = fraction;
        moved
    }
}

/// Space of the variables, and the values of all other parameters.
#[derive(Clone, Debug)]
pub struct DesignSpace {
    sweep: Sweep,
    intervals: Vec<Interval>,
    choices: Vec<Choice>,
}

impl Interval {
    /// Returns the value at `fraction` of the interval.
    ///
    /// The value is exactly an end of the interval at 0 and 1.
    pub fn value(&self, fraction: f64) -> f64 {
        let value = self.from + fraction * (self.to - self.from);
        // Avoid round-off: tables should not show 59.99999999999999 instead of 60.
        let value = if fraction >= 1.0 { self.to } else { value.clamp(self.from, self.to) };
        // A rounded design should not show 0.35000000000000003 instead of 0.35.
        let multiple = self.step.map(|step| multiple((value / step).round(), step));
        let size = self.from.abs().max(self.to.abs());
        multiple.filter(|m| (m - value).abs() <= 4.0 * f64::EPSILON * size).unwrap_or(value)
    }

    /// Returns the fraction of the interval at `value`, limited to 0 to 1.
    pub(crate) fn fraction(&self, value: f64) -> f64 {
        ((value - self.from) / self.length()).clamp(0.0, 1.0)
    }

    /// Returns the multiples of the step inside the interval, as factors of the step.
    ///
    /// `None` if the parameter is not rounded.
    pub(crate) fn multiples(&self) -> Option<RangeInclusive<i64>> {
        let step = self.step?;
        let first = (self.from / step - ROUND_OFF).ceil() as i64;
        Some(first..=(self.to / step + ROUND_OFF).floor() as i64)
    }

    /// Returns the multiples of the step below and above a value, as factors of the step.
    ///
    /// The value is at `fraction` of the interval. Both factors are equal if the value is
    /// a multiple, or is not between two multiples. `None` if the interval contains no multiple.
    pub(crate) fn multiples_around(&self, fraction: f64) -> Option<[i64; 2]> {
        let (first, last) = self.multiples()?.into_inner();
        let quotient = self.value(fraction) / self.step?;
        let around = [(quotient + ROUND_OFF).floor(), (quotient - ROUND_OFF).ceil()];
        (first <= last).then(|| around.map(|k| (k as i64).clamp(first, last)))
    }

    /// Returns the fraction of the interval at `factor` times the step; `None` without a step.
    pub(crate) fn fraction_of_multiple(&self, factor: i64) -> Option<f64> {
        Some(self.fraction(multiple(factor as f64, self.step?)))
    }

    /// Returns the length of the interval.
    pub fn length(&self) -> f64 {
        self.to - self.from
    }
}

/// Returns `factor * step` without round-off in the decimal digits, e.g. 0.35.
fn multiple(factor: f64, step: f64) -> f64 {
    number::short_decimal(factor * step, factor * step)
}

/// Returns the step to which a parameter is rounded, in the unit of the parameter.
///
/// `round` is the step of lengths in mm, or divided by the thickness of a scale if the thickness in
/// mm is unknown. `None` for a parameter that is neither a length nor an angle.
fn step(parameter: &Parameter, round: f64, thickness: Option<f64>) -> Option<f64> {
    match parameter.unit {
        "mm" => Some(round),
        "t" => Some(thickness.map_or(round, |thickness| round / thickness)),
        "deg" => Some(ANGLE_STEP_DEG),
        _ => None,
    }
}

impl SpacePoint {
    /// Returns the largest difference of fractions over all intervals; infinite if choices differ.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        // The values of a choice have no order, so points with different choices are not near.
        if self.chosen != other.chosen {
            return f64::INFINITY;
        }
        let pairs = self.fractions.iter().zip(&other.fractions);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}

impl DesignSpace {
    /// Returns the indices of the intervals that only change the scale of physical columns.
    ///
    /// The parameters of these intervals do not change dimensionless measures.
    pub(crate) fn scaling_intervals(&self) -> Vec<usize> {
        let measures = self.sweep().measures();
        let intervals = self.intervals().iter().enumerate();
        // The thickness changes the measures if lengths are in mm. A modulus changes the measures
        // if the modulus of the scales is given. `has_followers` is true in these cases.
        let scaling = intervals.filter(|(_, Interval { parameter, .. })| {
            !(measures.iter().any(|m| m.sections().contains(&parameter.section))
                || self.sweep().has_followers(parameter))
        });
        scaling.map(|(j, _)| j).collect()
    }

    /// Creates the space of the variables of `sweep`. All other axes must have one value.
    ///
    /// `round` is the step of lengths: in mm, or divided by the thickness if the thickness in mm is
    /// unknown; `None` without rounding.
    pub(crate) fn new(sweep: Sweep, round: Option<f64>) -> Self {
        let (mut intervals, mut choices) = (Vec::new(), Vec::new());
        let thickness = sweep.grid().case(0).material.thickness_mm;
        for variable in sweep.variables() {
            let parameter = variable.parameter();
            match variable.values() {
                &VariableValues::Between(from, to) => {
                    let step = round.and_then(|round| step(parameter, round, thickness));
                    intervals.push(Interval { parameter, from, to, step });
                }
                VariableValues::OneOf(values) => {
                    choices.push(Choice { parameter, values: values.clone() });
                }
            }
        }
        Self { sweep, intervals, choices }
    }

    /// Returns the sweep with the variables.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// Returns the continuous variables.
    pub fn intervals(&self) -> &[Interval] {
        &self.intervals
    }

    /// Returns the discrete variables.
    pub fn choices(&self) -> &[Choice] {
        &self.choices
    }

    /// Returns the parameters of the continuous variables, then of the discrete variables.
    pub fn parameters(&self) -> impl Iterator<Item = &'static Parameter> {
        let intervals = self.intervals.iter().map(|interval| interval.parameter);
        intervals.chain(self.choices.iter().map(|choice| choice.parameter))
    }

    /// Returns the number of combinations of values of the discrete variables, at least one.
    pub(crate) fn combinations(&self) -> usize {
        self.choices.iter().map(|choice| choice.values.len()).fold(1, usize::saturating_mul)
    }

    /// Returns the values of the discrete variables in combination `index`, as indices.
    pub(crate) fn combination(&self, mut index: usize) -> Vec<usize> {
        self.choices
            .iter()
            .map(|choice| {
                let digit = index % choice.values.len();
                index /= choice.values.len();
                digit
            })
            .collect()
    }

    /// Returns the case of the design at `point`.
    pub fn case(&self, point: &SpacePoint) -> Case {
        // The first design of the grid contains the values of all parameters that do not vary.
        let mut case = self.sweep.grid().case(0);
        for (interval, fraction) in self.intervals.iter().zip(&point.fractions) {
            case = interval.parameter.put(&case, Scalar::Number(interval.value(*fraction)));
        }
        for (choice, index) in self.choices.iter().zip(&point.chosen) {
            case = choice.parameter.put(&case, choice.values[*index]);
        }
        case
    }
}

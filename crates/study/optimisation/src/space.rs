//! Design space: variables, points, and their cases.

use std::ops::RangeInclusive;

use sweep::{Case, Parameter, Scalar, Sweep, VariableValues};
use text::number;

/// Step of rounded angles, degrees.
const ANGLE_STEP_DEG: f64 = 1.0;

/// Round-off of a quotient of a value and its step.
const ROUND_OFF: f64 = 1e-9;

/// A parameter that varies between two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Parameter.
    pub parameter: &'static Parameter,
    /// Smallest value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
    /// Step of the values of a rounded design; `None` if they are not rounded.
    pub step: Option<f64>,
}

/// A parameter that takes one of a few values.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Parameter.
    pub parameter: &'static Parameter,
    /// Values, at least one.
    pub values: Vec<Scalar>,
}

/// Point of the space.
///
/// It has a fraction of each interval, from 0 (lower end) to 1, and an index for each choice.
#[derive(Clone, Debug, PartialEq)]
pub struct SpacePoint {
    /// Fractions of the intervals.
    pub shares: Vec<f64>,
    /// Indices of the choices.
    pub chosen: Vec<usize>,
}

impl SpacePoint {
    /// Returns a copy with this fraction of one interval.
    pub(crate) fn with_share(&self, interval: usize, share: f64) -> Self {
        let mut moved = self.clone();
        moved.shares[interval] = share;
        moved
    }
}
/// Space of the variables, with the values shared by all designs.
#[derive(Clone, Debug)]
pub struct DesignSpace {
    sweep: Sweep,
    intervals: Vec<Interval>,
    choices: Vec<Choice>,
}

impl Interval {
    /// Returns the value at a fraction of the interval; exactly its ends at 0 and 1.
    pub fn value(&self, share: f64) -> f64 {
        let value = self.from + share * (self.to - self.from);
        // Round-off could show as 59.99999999999999 instead of 60 in tables.
        let value = if share >= 1.0 { self.to } else { value.clamp(self.from, self.to) };
        // Nor may a rounded design show as 0.35000000000000003.
        let multiple = self.step.map(|step| multiple((value / step).round(), step));
        let size = self.from.abs().max(self.to.abs());
        multiple.filter(|m| (m - value).abs() <= 4.0 * f64::EPSILON * size).unwrap_or(value)
    }

    /// Returns the fraction of the interval at a value.
    pub(crate) fn share(&self, value: f64) -> f64 {
        ((value - self.from) / self.length()).clamp(0.0, 1.0)
    }

    /// Returns the multiples of the step in the interval, as factors of the step.
    ///
    /// `None` without a step.
    pub(crate) fn multiples(&self) -> Option<RangeInclusive<i64>> {
        let step = self.step?;
        let first = (self.from / step - ROUND_OFF).ceil() as i64;
        Some(first..=(self.to / step + ROUND_OFF).floor() as i64)
    }

    /// Returns the multiples of the step below and above the value at a fraction of the interval.
    ///
    /// They are equal at a multiple and beyond the last one. `None` without a multiple.
    pub(crate) fn multiples_around(&self, share: f64) -> Option<[i64; 2]> {
        let (first, last) = self.multiples()?.into_inner();
        let quotient = self.value(share) / self.step?;
        let around = [(quotient + ROUND_OFF).floor(), (quotient - ROUND_OFF).ceil()];
        (first <= last).then(|| around.map(|k| (k as i64).clamp(first, last)))
    }

    /// Returns the fraction of the interval at a multiple of the step.
    pub(crate) fn share_of_multiple(&self, factor: i64) -> Option<f64> {
        Some(self.share(multiple(factor as f64, self.step?)))
    }

    /// Returns the length of the interval.
    pub fn length(&self) -> f64 {
        self.to - self.from
    }
}

/// Returns a multiple of a step as the decimal number that is meant.
fn multiple(factor: f64, step: f64) -> f64 {
    number::short_decimal(factor * step, factor * step)
}

/// Returns the step of a rounded parameter; `None` if it is neither a length nor an
/// angle.
///
/// `round` is the step of lengths in mm, or over the thickness if that is unknown.
fn step(parameter: &Parameter, round: f64, thickness: Option<f64>) -> Option<f64> {
    match parameter.unit {
        "mm" => Some(round),
        "t" => Some(thickness.map_or(round, |thickness| round / thickness)),
        "deg" => Some(ANGLE_STEP_DEG),
        _ => None,
    }
}

impl SpacePoint {
    /// Returns the largest difference in any interval; infinite if choices differ.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        // Choices are unordered, so a search does not step between them.
        if self.chosen != other.chosen {
            return f64::INFINITY;
        }
        let pairs = self.shares.iter().zip(&other.shares);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}

impl DesignSpace {
    /// Returns the intervals that only scale columns in physical units, not measures.
    pub(crate) fn scaling_intervals(&self) -> Vec<usize> {
        let measures = self.sweep().measures();
        let intervals = self.intervals().iter().enumerate();
        // A thickness also matters if lengths are in mm, and a modulus beside the modulus of the
        // scales.
        let scaling = intervals.filter(|(_, Interval { parameter, .. })| {
            !(measures.iter().any(|m| m.sections().contains(&parameter.section))
                || self.sweep().has_followers(parameter))
        });
        scaling.map(|(j, _)| j).collect()
    }

    /// Creates the space of the variables of `sweep`.
    ///
    /// Its other axes have one value each. Sizes of rounded designs are multiples of `round`.
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

    /// Returns the parameters of all variables.
    pub fn parameters(&self) -> impl Iterator<Item = &'static Parameter> {
        let intervals = self.intervals.iter().map(|interval| interval.parameter);
        intervals.chain(self.choices.iter().map(|choice| choice.parameter))
    }

    /// Returns the number of combinations of choices, at least one.
    pub(crate) fn combinations(&self) -> usize {
        self.choices.iter().map(|choice| choice.values.len()).fold(1, usize::saturating_mul)
    }

    /// Returns the choices of the combination `index`.
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

    /// Returns the case of a point.
    pub fn case(&self, point: &SpacePoint) -> Case {
        // The first design of the grid holds all shared values.
        let mut case = self.sweep.grid().case(0);
        for (interval, share) in self.intervals.iter().zip(&point.shares) {
            case = interval.parameter.put(&case, Scalar::Number(interval.value(*share)));
        }
        for (choice, index) in self.choices.iter().zip(&point.chosen) {
            case = choice.parameter.put(&case, choice.values[*index]);
        }
        case
    }
}

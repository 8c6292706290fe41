//! Design space: variables, points, and their cases.

use sweep::{Case, Parameter, Scalar, Sweep, VariableValues};

/// A parameter that varies between two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Parameter.
    pub parameter: &'static Parameter,
    /// Smallest value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
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
        if share >= 1.0 { self.to } else { value.clamp(self.from, self.to) }
    }

    /// Returns the length of the interval.
    pub fn length(&self) -> f64 {
        self.to - self.from
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
    /// Creates the space of the variables of `sweep`.
    ///
    /// Its other axes have one value each.
    pub(crate) fn new(sweep: Sweep) -> Self {
        let (mut intervals, mut choices) = (Vec::new(), Vec::new());
        for variable in sweep.variables() {
            let parameter = variable.parameter();
            match variable.values() {
                &VariableValues::Between(from, to) => {
                    intervals.push(Interval { parameter, from, to });
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
        let digit = |choice: &Choice| {
            let digit = index % choice.values.len();
            index /= choice.values.len();
            digit
        };
        self.choices.iter().map(digit).collect()
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

//! Grid of designs: all combinations of the axis values, numbered but never stored.

use std::ops::RangeInclusive;

use crate::case::Case;
use crate::parameter::Parameter;
use crate::scalar::Scalar;

/// A parameter and its values in a grid, in order.
#[derive(Clone, Debug)]
pub struct Axis {
    parameter: &'static Parameter,
    values: Vec<Scalar>,
    /// The range in TOML, if the values were written as a range.
    range: Option<String>,
}

impl Axis {
    /// Creates an axis from a list of values.
    pub(crate) fn list(parameter: &'static Parameter, values: Vec<Scalar>) -> Self {
        Self { parameter, values, range: None }
    }

    /// Creates an axis from the values of the written range `range`.
    pub(crate) fn range(parameter: &'static Parameter, values: Vec<Scalar>, range: String) -> Self {
        Self { parameter, values, range: Some(range) }
    }

    /// Returns the parameter of the axis.
    pub fn parameter(&self) -> &'static Parameter {
        self.parameter
    }

    /// Returns the number of values, at least one.
    #[expect(clippy::len_without_is_empty, reason = "an axis is never empty")]
    pub fn len(&self) -> u64 {
        self.values.len() as u64
    }

    /// Returns the value at `index`, which counts from 0.
    pub fn value(&self, index: u64) -> Scalar {
        self.values[usize::try_from(index).unwrap_or(usize::MAX)]
    }

    /// Returns the smallest and the largest number of the axis; for words `(inf, -inf)`.
    pub(crate) fn span(&self) -> (f64, f64) {
        let numbers = self.values.iter().filter_map(|value| value.number());
        numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    }

    /// Returns the index of the value that equals `value` up to round-off.
    pub fn position(&self, value: Scalar) -> Option<u64> {
        self.values.iter().position(|other| other.same(value)).map(|index| index as u64)
    }

    /// Returns the values as written in a definition.
    pub fn to_toml(&self) -> String {
        self.range.clone().unwrap_or_else(|| {
            let values: Vec<_> = self.values.iter().map(|value| value.to_toml()).collect();
            format!("[{}]", values.join(", "))
        })
    }
}

/// The designs of a sweep: all combinations of axis values, last axis fastest.
#[derive(Clone, Debug)]
pub struct Grid {
    axes: Vec<Axis>,
    /// Values of the parameters that are not axes.
    base: Case,
    count: u64,
}

/// The grid has more designs than a `u64` can number.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the axes span more than {} designs, expected fewer values", u64::MAX)]
pub struct TooManyDesigns;

/// A text that is not the number of a design.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no design {found}, expected a number from 1 to {count}")]
pub struct NoSuchDesign {
    /// The given text.
    pub found: String,
    /// Number of designs.
    pub count: u64,
}

impl Grid {
    /// Creates the grid of `axes`, with all other parameters from `base`.
    ///
    /// # Errors
    ///
    /// If a `u64` cannot number the designs.
    pub fn new(axes: Vec<Axis>, base: Case) -> Result<Self, TooManyDesigns> {
        let count = axes
            .iter()
            .try_fold(1, |count: u64, axis| count.checked_mul(axis.len()))
            .ok_or(TooManyDesigns)?;
        Ok(Self { axes, base, count })
    }

    /// Returns the axes. The first axis varies slowest, the last axis fastest.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the axis of a parameter.
    pub fn axis(&self, key: &str) -> Option<&Axis> {
        self.axes.iter().find(|axis| axis.parameter.key == key)
    }

    /// Returns the axis of the parameter `key`, directly or in mm.
    pub fn axis_in_any_unit(&self, key: &str) -> Option<&Axis> {
        self.axes.iter().find(|axis| axis.parameter.is_or_determines(key))
    }

    /// Returns the case that all designs share, except for the parameters of the axes.
    ///
    /// The values of the axis parameters in this case are meaningless.
    pub fn base(&self) -> &Case {
        &self.base
    }

    /// Returns the number of designs, at least one.
    #[expect(clippy::len_without_is_empty, reason = "a grid is never empty")]
    pub fn len(&self) -> u64 {
        self.count
    }

    /// Returns the case of design `index`, which counts from 0 and is below [`Self::len`].
    pub fn case(&self, index: u64) -> Case {
        let mut case = self.base;
        let mut rest = index;
        // The index is a mixed-radix number with one digit per axis, the fastest axis last.
        for axis in self.axes.iter().rev() {
            axis.parameter.set(&mut case, axis.value(rest % axis.len()));
            rest /= axis.len();
        }
        case
    }

    /// Returns the index of the design with the values of `case` on every axis, if there is one.
    pub fn find(&self, case: &Case) -> Option<u64> {
        self.axes.iter().try_fold(0, |index, axis| {
            let position = axis.position(axis.parameter.get(case))?;
            Some(index * axis.len() + position)
        })
    }

    /// Returns a grid with the design `index` of this grid as its only design.
    pub(crate) fn only(&self, index: u64) -> Self {
        self.at(&self.case(index))
    }

    /// Returns a grid with a single design, which has the values of `case` on every axis.
    pub(crate) fn at(&self, case: &Case) -> Self {
        let parameters = self.axes.iter().map(|axis| axis.parameter);
        let axes = parameters.map(|parameter| Axis::list(parameter, vec![parameter.get(case)]));
        Self { axes: axes.collect(), base: self.base, count: 1 }
    }

    /// Parses the number of a design and returns its index. Leading zeros are optional.
    ///
    /// # Errors
    ///
    /// If `text` is not the number of a design of this grid.
    pub fn parse_number(&self, text: &str) -> Result<u64, NoSuchDesign> {
        let number = text.parse::<u64>().ok().filter(|number| (1..=self.count).contains(number));
        number
            .map(|number| number - 1)
            .ok_or_else(|| NoSuchDesign { found: text.to_owned(), count: self.count })
    }

    /// Parses one design number, such as `7`, or a range, such as `1-12`.
    ///
    /// Returns the indices of the designs.
    ///
    /// # Errors
    ///
    /// If a number is not in the grid, or the first number is above the last.
    pub fn parse_numbers(&self, text: &str) -> Result<RangeInclusive<u64>, NoSuchDesign> {
        let Some((first, last)) = text.split_once('-') else {
            return self.parse_number(text).map(|index| index..=index);
        };
        let range = self.parse_number(first.trim())?..=self.parse_number(last.trim())?;
        let error = NoSuchDesign { found: text.to_owned(), count: self.count };
        if range.is_empty() { Err(error) } else { Ok(range) }
    }

    /// Returns the number of design `index`.
    pub fn number(&self, index: u64) -> DesignNumber {
        let digits = self.count.to_string().len();
        DesignNumber { position: index + 1, width: digits.max(4) }
    }
}

/// 1-based position of a design in its grid, written with leading zeros.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DesignNumber {
    position: u64,
    width: usize,
}

impl DesignNumber {
    /// Returns the position in the grid, from 0.
    pub fn index(self) -> u64 {
        self.position - 1
    }
}

impl std::fmt::Display for DesignNumber {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:0width$}", self.position, width = self.width)
    }
}

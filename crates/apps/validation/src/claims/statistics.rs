//! Trends along lines, and fractions of variance.

use std::collections::BTreeMap;
use std::fmt;

use crate::study::MeasuredDesign;

/// A parameter of the grid.
pub(crate) type DesignParameter = fn(&MeasuredDesign) -> f64;
/// A value of a design, if it has one.
pub(crate) type DesignValue = fn(&MeasuredDesign) -> Option<f64>;

pub(crate) const GAP: DesignParameter = |design| design.gap;
pub(crate) const LENGTH: DesignParameter = |design| design.length;
pub(crate) const SLANT: DesignParameter = |design| design.slant;

/// Steps between neighbours along lines, counted by direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TrendSteps {
    /// Steps in the expected direction.
    pub(crate) right: usize,
    /// Steps without a value at one end, hence without direction.
    pub(crate) missing: usize,
    /// All steps.
    pub(crate) all: usize,
}

impl TrendSteps {
    /// Counts the steps with falling values.
    pub(crate) fn falling(lines: &[Vec<Option<f64>>]) -> Self {
        Self::of(lines, |from, to| to < from)
    }

    /// Counts the steps with rising values.
    pub(crate) fn rising(lines: &[Vec<Option<f64>>]) -> Self {
        Self::of(lines, |from, to| to > from)
    }

    fn of(lines: &[Vec<Option<f64>>], right: fn(f64, f64) -> bool) -> Self {
        let mut steps = Self::default();
        for step in lines.iter().flat_map(|line| line.windows(2)) {
            steps.all += 1;
            match (step[0], step[1]) {
                (Some(from), Some(to)) => steps.right += usize::from(right(from, to)),
                _ => steps.missing += 1,
            }
        }
        steps
    }

    /// Returns the percentage of steps in the expected direction; `None` without steps.
    pub(crate) fn percent(&self) -> Option<f64> {
        (self.all > 0).then(|| 100.0 * self.right as f64 / self.all as f64)
    }
}

impl fmt::Display for TrendSteps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {}", self.right, self.all)?;
        match self.missing {
            0 => Ok(()),
            missing => write!(f, " ({missing} without a value)"),
        }
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns the fraction of the variance of a value that a parameter explains alone.
///
/// It is the variance of the means over designs with equal values of the parameter (first-order
/// effect, Sobol 1993).
pub(crate) fn explained(designs: &[(&MeasuredDesign, f64)], parameter: DesignParameter) -> f64 {
    // Keys are the bits of the numbers: equal grid values have equal bits.
    let mut groups = BTreeMap::<u64, Vec<f64>>::new();
    for (design, value) in designs {
        groups.entry(parameter(design).to_bits()).or_default().push(*value);
    }
    let all: Vec<f64> = designs.iter().map(|(_, value)| *value).collect();
    let centre = mean(&all);
    let between: f64 = groups.values().map(|g| g.len() as f64 * (mean(g) - centre).powi(2)).sum();
    between / all.iter().map(|value| (value - centre).powi(2)).sum::<f64>()
}

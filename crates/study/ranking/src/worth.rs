//! The worth of a design: its objectives, and how far it is within every requirement.

use crate::requirement::Requirement;

/// The worth of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Worth {
    /// The objectives in their units.
    pub objectives: Vec<f64>,
    /// The objectives as designs are compared by them: a yield, which is a staircase, with the part of its next step.
    pub compared: Vec<f64>,
    /// The values of the columns that are required.
    pub required: Vec<f64>,
    /// How far it is within each requirement, relative to the limit; below 0 where it falls short.
    pub margins: Vec<f64>,
    /// Whether it meets every requirement.
    pub met: bool,
}

impl Worth {
    /// The largest shortfall, relative to the limit; 0 where there is none.
    pub fn shortfall(&self) -> f64 {
        self.margins.iter().fold(0.0, |shortfall, margin| shortfall.max(-margin))
    }
}

/// The requirement that a design with these values is least within, of equal ones the first, with its counted margin.
pub fn tightest<'r>(
    bounds: impl Iterator<Item = (&'r Requirement, Option<f64>)>,
) -> Option<(usize, f64)> {
    let margins = bounds.map(|(requirement, value)| requirement.counted_margin(value));
    // `min_by` keeps the first of equal ones.
    margins.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tightest_requirement_is_the_one_that_a_design_is_least_within() {
        let requirements = ["a >= 2", "b <= 4", "c > 0"].map(|text| text.parse().expect("valid"));
        let tightest_of = |values: [Option<f64>; 3]| tightest(requirements.iter().zip(values));
        assert_eq!(tightest_of([Some(3.0), Some(3.0), Some(9.0)]), Some((1, 0.25)));
        // Round-off breaks no limit, and what has no value keeps none.
        assert_eq!(tightest_of([Some(2.0 - 1e-15), Some(3.0), Some(9.0)]), Some((0, 0.0)));
        assert_eq!(tightest_of([Some(3.0), None, Some(9.0)]), Some((1, f64::NEG_INFINITY)));
        assert!(
            tightest_of([Some(3.0), Some(3.0), Some(0.0)]).is_some_and(|(k, m)| k == 2 && m < 0.0)
        );
    }
}

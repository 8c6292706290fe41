//! Objectives of a design, and its margins to all requirements.

use crate::requirement::Requirement;

/// Objectives of a design, and its margins to all requirements.
#[derive(Clone, Debug, PartialEq)]
pub struct Worth {
    /// Objectives in their units.
    pub objectives: Vec<f64>,
    /// Objectives used to compare designs.
    ///
    /// A yield is a step function of the design. In this field, a yield also contains a fraction of
    /// the next step, so that designs with equal yields can be compared.
    pub compared: Vec<f64>,
    /// Values of the required columns.
    pub required: Vec<f64>,
    /// Margin to each requirement, relative to the limit; negative if the requirement is not met.
    pub margins: Vec<f64>,
    /// True if the design meets every requirement.
    pub met: bool,
}

impl Worth {
    /// Returns the largest shortfall, relative to the limit; 0 if all requirements are met.
    pub fn shortfall(&self) -> f64 {
        self.margins.iter().fold(0.0, |shortfall, margin| shortfall.max(-margin))
    }
}

/// Returns the index of the tightest requirement and its [`Requirement::counted_margin`].
///
/// Each item of `bounds` holds a requirement and the value of its column. The tightest requirement
/// is the first one with the smallest margin. `None` without requirements.
pub fn tightest<'r>(
    bounds: impl Iterator<Item = (&'r Requirement, Option<f64>)>,
) -> Option<(usize, f64)> {
    let margins = bounds.map(|(requirement, value)| requirement.counted_margin(value));
    // `min_by` returns the first of equal items.
    margins.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tightest_requirement_has_the_smallest_margin() {
        let requirements = ["a >= 2", "b <= 4", "c > 0"].map(|text| text.parse().expect("valid"));
        let found = [
            [Some(3.0), Some(3.0), Some(9.0)],
            // Round-off does not violate a requirement, but a missing value does.
            [Some(2.0 - 1e-15), Some(3.0), Some(9.0)],
            [Some(3.0), None, Some(9.0)],
            [Some(3.0), Some(3.0), Some(0.0)],
        ]
        .map(|values| tightest(requirements.iter().zip(values)).expect("a requirement"));
        assert_eq!(found[..3], [(1, 0.25), (0, 0.0), (1, f64::NEG_INFINITY)]);
        assert!(found[3].0 == 2 && found[3].1 < 0.0);
    }
}

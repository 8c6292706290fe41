//! Protection levels of standards for protective clothing, as requirements.

use crate::requirement::{Relation, Requirement};

/// A standard that defines its protection levels by minimum forces.
#[derive(Debug)]
pub struct Standard {
    /// First word of a level, as in `needle 2`.
    pub name: &'static str,
    /// Name of the standard, and the indenter of its test.
    pub source: &'static str,
    /// Minimum force of each level in N, starting with level 1.
    pub newtons: &'static [f64],
}

/// Standards that requirements may name.
// The levels are published in ANSI/ISEA 105-2016 with ASTM F2878 (needle, 500 mm/min) and
// EN 388:2016 (probe, 100 mm/min).
pub const STANDARDS: [Standard; 2] = [
    Standard {
        name: "needle",
        source: "ANSI/ISEA 105 by ASTM F2878, a needle of 25G",
        newtons: &[2.0, 4.0, 6.0, 8.0, 10.0],
    },
    Standard {
        name: "probe",
        source: "EN 388, a blunt probe of 4.5 mm",
        newtons: &[20.0, 60.0, 100.0, 150.0],
    },
];

/// Warning that a critical force above the force of a level does not prove the level.
pub const TILTING_ONLY: &str = "the model predicts the force at which a scale tilts under a point load, not whether a needle or probe \
    penetrates: it neglects the radius of the tip, the strength of the scales and the path between them; only a test gives the level";

impl Standard {
    /// Returns the standard and the requirement of a level such as `needle 2`.
    pub fn requirement(text: &str) -> Option<(&'static Self, Requirement)> {
        let (name, level) = text.trim().split_once(' ')?;
        let standard = STANDARDS.iter().find(|standard| standard.name == name)?;
        let index = level.trim().parse::<usize>().ok()?.checked_sub(1)?;
        // The critical force replaces the force in the test of the standard; see `TILTING_ONLY`.
        let (column, relation) = ("critical_force_N".to_owned(), Relation::AtLeast);
        Some((standard, Requirement { column, relation, limit: *standard.newtons.get(index)? }))
    }

    /// Lists all levels, for messages.
    pub fn levels() -> String {
        let of =
            |standard: &Self| format!("'{} 1' to '{0} {}'", standard.name, standard.newtons.len());
        STANDARDS.iter().map(of).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_requires_a_critical_force() {
        let read =
            |text: &str| text.parse::<Requirement>().map(|requirement| requirement.to_string());
        assert_eq!(read("needle 2").as_deref(), Ok("critical_force_N >= 4"));
        assert_eq!(read(" probe 4 ").as_deref(), Ok("critical_force_N >= 150"));
        for wrong in ["needle", "needle 0", "needle 6", "needle two", "needles 2"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
        assert_eq!(Standard::levels(), "'needle 1' to 'needle 5', 'probe 1' to 'probe 4'");
    }
}

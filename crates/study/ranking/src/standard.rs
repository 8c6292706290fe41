//! Levels of protection that buyers read, as requirements.

use crate::requirement::{Relation, Requirement};

/// A standard whose levels are forces.
#[derive(Debug)]
pub struct Standard {
    /// The word before a level, as in `needle 2`.
    pub name: &'static str,
    /// The standard, and what it presses into the sample.
    pub source: &'static str,
    /// Newtons of the levels, from 1 on.
    pub newtons: &'static [f64],
}

/// The standards that requirements may name.
// Levels as published: ANSI/ISEA 105-2016 with ASTM F2878 (needle, 500 mm/min), EN 388:2016 (probe, 100 mm/min).
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

/// What a level does not say of a skin that meets it here.
pub const TILTING_ONLY: &str = "the model tells at which force a scale tilts under a point, not whether a needle or probe goes \
    through: the tip's own radius, the strength of the scales and the way between them are left out; only a test gives the level";

impl Standard {
    /// The requirement of a level such as `needle 2`, and its standard.
    pub fn requirement(text: &str) -> Option<(&'static Self, Requirement)> {
        let (name, level) = text.trim().split_once(' ')?;
        let standard = STANDARDS.iter().find(|standard| standard.name == name)?;
        let index = level.trim().parse::<usize>().ok()?.checked_sub(1)?;
        // The force at which a scale tilts stands for that of the test: see `TILTING_ONLY`.
        let (column, relation) = ("critical_force_N".to_owned(), Relation::AtLeast);
        Some((standard, Requirement { column, relation, limit: *standard.newtons.get(index)? }))
    }

    /// All levels, in words.
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
    fn a_level_is_a_force() {
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

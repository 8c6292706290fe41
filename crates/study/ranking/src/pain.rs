//! Pressure limits of body parts, as requirements.

use crate::requirement::{Relation, Requirement};

/// Limit of the pressure on a body part that is clamped by a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PainLimit {
    /// Body part, as in the requirement `pain palm`.
    pub part: &'static str,
    /// Maximum pressure in kPa.
    pub kilopascals: f64,
}

/// Pressure limits that requirements may name.
///
/// `docs/bodies.md` lists the same limits with their source; a test compares both lists.
pub const PAIN_LIMITS: [PainLimit; 8] = [
    PainLimit { part: "finger", kilopascals: 600.0 },
    PainLimit { part: "palm", kilopascals: 600.0 },
    PainLimit { part: "forearm", kilopascals: 500.0 },
    PainLimit { part: "torso", kilopascals: 350.0 },
    PainLimit { part: "chest", kilopascals: 450.0 },
    PainLimit { part: "back", kilopascals: 700.0 },
    PainLimit { part: "thigh", kilopascals: 800.0 },
    PainLimit { part: "shin", kilopascals: 450.0 },
];

/// Meaning of a pressure limit, for notes to the user.
pub const PAIN_MEANING: &str = "limit of BG/BGIA for contact with robots, near the onset of pain, \
    not of injury; it applies to the mean pressure of one base up to the end of the path, and \
    persons differ by a factor of four (docs/bodies.md)";

impl PainLimit {
    /// Returns the limit and the requirement of a text such as `pain palm` or `pain "palm"`.
    pub fn requirement(text: &str) -> Option<(&'static Self, Requirement)> {
        let part = text.trim().strip_prefix("pain")?;
        let part = part.strip_prefix(char::is_whitespace)?.trim().trim_matches(['"', '\'']);
        let limit = PAIN_LIMITS.iter().find(|limit| limit.part.eq_ignore_ascii_case(part))?;
        let column = "tissue_pressure_max_kPa".to_owned();
        Some((limit, Requirement { column, relation: Relation::AtMost, limit: limit.kilopascals }))
    }

    /// Lists all limits, for messages.
    pub fn names() -> String {
        let names = PAIN_LIMITS.iter().map(|limit| format!("'pain {}'", limit.part));
        names.collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn a_body_part_limits_the_pressure_on_the_tissue() {
        for text in ["pain palm", " pain  \"palm\" ", "pain 'Palm'"] {
            let requirement = text.parse::<Requirement>().map(|found| found.to_string());
            assert_eq!(requirement.as_deref(), Ok("tissue_pressure_max_kPa <= 600"), "{text}");
        }
        for wrong in ["pain", "pain nose", "painpalm", "palm"] {
            assert!(wrong.parse::<Requirement>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_documented_pressure_limits_match_the_list() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/bodies.md");
        let page = std::fs::read_to_string(page).expect("readable");
        let rows = page.lines().filter(|line| line.starts_with("| `pain "));
        let rows: Vec<_> = rows.map(|row| row.split(" | ").collect::<Vec<_>>()).collect();
        let expected = PAIN_LIMITS.map(|PainLimit { part, kilopascals }| {
            (format!("| `pain {part}`"), kilopascals.to_string())
        });
        let documented: Vec<_> =
            rows.iter().map(|row| (row[0].to_owned(), row[1].to_owned())).collect();
        assert_eq!(documented, expected);
    }
}

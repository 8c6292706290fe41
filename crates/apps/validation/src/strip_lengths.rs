//! Verdicts on the most compliant designs, for strips with equal numbers of gaps.

use sweep::Sweep;

use crate::claims;
use crate::page::marked;
use crate::study::Study;

/// Strips of 40 to 45 gaps in every design, for both bases.
///
/// The definition requests no puncture, because punctures do not depend on the strip.
const STRIPS: &str = "name = \"gaps\"\nmeasures = [\"coverage\", \"flexure\"]\n\
                      designs.gaps = [40, 41, 42, 43, 44, 45]\ndesigns.base = [\"L\", \"2L\"]";

/// The claims about the most compliant designs.
const CLAIMS: [&str; 3] = ["C22", "C23", "C26"];

/// Verdicts on the most compliant designs for one number of gaps.
#[derive(Clone, Debug)]
pub struct StripLength {
    /// The setting, as `key = value`.
    pub setting: String,
    /// The verdict on each claim.
    pub verdicts: [String; CLAIMS.len()],
}

impl StripLength {
    /// Solves the strips and checks the claims on them.
    ///
    /// # Errors
    /// If the temporary folder cannot be written.
    pub fn all() -> anyhow::Result<Vec<Self>> {
        let study = Study::run(Sweep::parse(STRIPS, "gaps", &[])?)?;
        study
            .settings()
            .into_iter()
            .map(|(setting, study)| {
                let score = claims::score(&study)?;
                let verdict =
                    |id: &str| score.iter().find(|(known, _)| known == id).map(|(_, v)| *v);
                let verdicts = CLAIMS.map(|id| verdict(id).map_or_else(String::new, marked));
                Ok(Self { setting, verdicts })
            })
            .collect()
    }

    /// Returns the row of the table in Markdown.
    pub(crate) fn row(&self) -> String {
        format!("| {} | {} |", self.setting, self.verdicts.join(" | "))
    }
}

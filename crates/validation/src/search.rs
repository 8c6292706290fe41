//! A search for the settings of the open choices that reproduce most claims at once.

use std::fmt::Write as _;

use rayon::prelude::*;
use sweep::Sweep;

use crate::study::Study;
use crate::{Headlines, PartProgress, ValidationError, claims};

/// A setting with the claims that it reproduces.
#[derive(Clone, Debug)]
pub struct ScoredSetting {
    /// The setting, as `key = value`.
    pub setting: String,
    /// The claims that are reproduced.
    pub reproduced: Vec<&'static str>,
    /// The claims that are reproduced in part.
    pub in_part: Vec<&'static str>,
    /// The main results.
    pub headlines: Headlines,
}

/// Sweeps over combinations of open choices, on the designs of the paper.
#[derive(Clone, Debug)]
pub struct SettingSearch {
    /// Every setting, the one that reproduces most first.
    pub settings: Vec<ScoredSetting>,
}

impl SettingSearch {
    /// Solves the sweeps and checks every claim on each setting; `progress` is called when a sweep begins.
    ///
    /// # Errors
    /// If the temporary folder cannot be written.
    pub fn run(
        sweeps: &[Sweep],
        mut progress: impl FnMut(PartProgress<'_>),
    ) -> Result<Self, ValidationError> {
        let score = |(setting, study): (String, Study)| {
            let [reproduced, in_part] = claims::score(&study);
            ScoredSetting { setting, reproduced, in_part, headlines: Headlines::of(&study) }
        };
        let mut settings = Vec::new();
        for (done, sweep) in sweeps.iter().enumerate() {
            progress(PartProgress { done, parts: sweeps.len(), part: sweep.name() });
            let study = Study::run(sweep.clone())?;
            settings.par_extend(study.settings().into_par_iter().map(score));
        }
        // Stable: of equal ones the first in the sweep comes first.
        settings.sort_by_key(|s| std::cmp::Reverse((s.reproduced.len(), s.in_part.len())));
        Ok(Self { settings })
    }

    /// Returns the settings as a table in Markdown.
    pub fn table(&self) -> String {
        let mut text = String::from(
            "| Setting | Reproduced | In part | F_c* at (0.1, 0.1, 75°) | Balanced optimum | Not reproduced |\n\
             |---|--:|--:|--:|---|---|\n",
        );
        let all: Vec<_> = claims::ids().collect();
        for scored in &self.settings {
            let ScoredSetting { setting, reproduced, in_part, headlines } = scored;
            let found = |id: &&&str| !reproduced.contains(*id) && !in_part.contains(*id);
            let missing: Vec<_> = all.iter().filter(found).copied().collect();
            let _ = writeln!(
                text,
                "| {setting} | {} | {} | {} | {} | {} |",
                reproduced.len(),
                in_part.len(),
                headlines.force,
                headlines.balanced,
                missing.join(" ")
            );
        }
        text
    }
}

//! A search for the combination of open choices that reproduces most claims.

use std::fmt::Write as _;

use rayon::prelude::*;
use sweep::Sweep;

use crate::study::Study;
use crate::{Headlines, PartProgress, Verdict, claims};

/// A setting of the open choices, with the verdicts on all claims.
#[derive(Clone, Debug)]
pub struct ScoredSetting {
    /// The setting, as `key = value`.
    pub setting: String,
    /// The verdict on every claim.
    pub verdicts: Vec<(String, Verdict)>,
    /// The main results.
    pub headlines: Headlines,
}

/// Sweeps over combinations of open choices, on the designs of the paper.
#[derive(Clone, Debug)]
pub struct SettingSearch {
    /// All settings, sorted by the number of claims that they reproduce, largest first.
    pub settings: Vec<ScoredSetting>,
}

impl ScoredSetting {
    /// Returns the numbers of the claims with this verdict.
    fn with(&self, wanted: Verdict) -> impl Iterator<Item = &str> {
        self.verdicts.iter().filter(move |(_, found)| *found == wanted).map(|(id, _)| id.as_str())
    }
}

impl SettingSearch {
    /// Solves the sweeps and checks every claim for each setting.
    ///
    /// `progress` is called at the start of each sweep.
    ///
    /// # Errors
    /// If the temporary folder cannot be written.
    pub fn run(
        sweeps: &[Sweep],
        mut progress: impl FnMut(PartProgress<'_>),
    ) -> anyhow::Result<Self> {
        let mut settings = Vec::new();
        for (done, sweep) in sweeps.iter().enumerate() {
            progress(PartProgress { done, parts: sweeps.len(), part: sweep.name() });
            let study = Study::run(sweep.clone())?;
            let scored = study.settings().into_par_iter().map(|(setting, study)| {
                let verdicts = claims::score(&study)?;
                Ok(ScoredSetting { setting, verdicts, headlines: Headlines::of(&study) })
            });
            settings.extend(scored.collect::<anyhow::Result<Vec<_>>>()?);
        }
        // A stable sort keeps equal settings in the order of the sweep.
        settings.sort_by_key(|s| {
            std::cmp::Reverse([Verdict::Reproduced, Verdict::InPart].map(|v| s.with(v).count()))
        });
        Ok(Self { settings })
    }

    /// Returns the settings as a table in Markdown.
    pub fn table(&self) -> String {
        let mut text = String::from(
            "| Setting | Reproduced | In part | F_c* at (0.1, 0.1, 75°) | Balanced optimum | Not reproduced |\n\
             |---|--:|--:|--:|---|---|\n",
        );
        for scored in &self.settings {
            let ScoredSetting { setting, headlines, .. } = scored;
            let [reproduced, in_part] =
                [Verdict::Reproduced, Verdict::InPart].map(|verdict| scored.with(verdict).count());
            // List numbers only, because claims that no setting reproduces appear in every row.
            let missing: Vec<_> = scored.with(Verdict::NotReproduced).collect();
            let _ = writeln!(
                text,
                "| {setting} | {reproduced} | {in_part} | {} | {} | {} |",
                headlines.force,
                headlines.balanced,
                missing.join(" ")
            );
        }
        text
    }
}

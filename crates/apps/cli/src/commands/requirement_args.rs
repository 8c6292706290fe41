//! The option `--require`, which several commands have.

use anyhow::Context as _;
use clap::Args;
use ranking::{PAIN_MEANING, PainLimit, Requirement, Standard, TILTING_ONLY};

use crate::print::note;

/// The option `--require`.
#[derive(Debug, Args)]
pub struct RequirementArgs {
    /// Requirement: a column compared with a number by >=, <=, >, < or ==, e.g. 'coverage >= 0.6';
    /// a level of a standard, e.g. 'needle 2'; or the pressure limit of a body part, e.g. 'pain
    /// palm' (may be repeated: all must hold)
    #[arg(long = "require", value_name = "REQUIREMENT")]
    pub texts: Vec<String>,
}

impl RequirementArgs {
    /// Parses the requirements, and prints a note on each standard and pressure limit.
    pub fn read(&self) -> anyhow::Result<Vec<Requirement>> {
        let all = self.texts.iter();
        let all = all.map(|text| text.parse().with_context(|| format!("--require {text}")));
        let all = all.collect::<anyhow::Result<Vec<_>>>()?;
        for (text, (standard, level)) in
            self.texts.iter().filter_map(|text| Some((text, Standard::requirement(text)?)))
        {
            note(&format!("--require {text}: {level} ({}); {TILTING_ONLY}", standard.source));
        }
        for (text, (_, limit)) in
            self.texts.iter().filter_map(|text| Some((text, PainLimit::requirement(text)?)))
        {
            note(&format!("--require {text}: {limit} ({PAIN_MEANING})"));
        }
        Ok(all)
    }
}

//! The validation of squama: benchmarks with known answers, the claims of the paper, and the sensitivity to open choices.
//!
//! A benchmark holds if the number of the program differs from the reference by no more than its band,
//!
//! ```text
//! |ours/reference − 1| ≤ band
//! ```
//!
//! where the band is the error of the reference where that is an approximation itself. A claim of Shafiei et al. (2021,
//! doi 10.1016/j.jmps.2020.104176) is reproduced, reproduced in part, or not; nothing is tuned.
//!
//! | Item | Role |
//! |---|---|
//! | [`benchmarks()`], [`Benchmark`] | problems with known answers (their closed forms are in [`analytical`]) |
//! | [`claims()`], [`Claim`], [`CheckedClaim`], [`CheckedStatement`], [`Verdict`] | the statements of the paper, and their verdicts |
//! | [`BetweenPoints`], [`FittestDesign`], [`FrontOverGrid`] | what a search between the points of the grid finds |
//! | [`GapCount`] | the claims on the most compliant designs, for strips with the same number of gaps |
//! | [`Sensitivity`], [`Headlines`], [`ChoiceEffects`], [`ChoiceEffect`] | the dependence of the main results on the open choices |
//! | [`Soundness`] | folds of the surface, and the claims on a substrate that cannot fold |
//! | [`SettingSearch`], [`ScoredSetting`] | combinations of open choices, by the number of claims that they reproduce |
//! | [`Validation`], [`PartProgress`] | all parts, one after the other, and the page in Markdown |
//!
//! ```
//! for benchmark in validation::benchmarks()? {
//!     assert!(benchmark.holds(), "{}: {}", benchmark.name, benchmark.ours);
//! }
//! # Ok::<(), validation::ValidationError>(())
//! ```

mod benchmarks;
mod between;
mod claims;
mod error;
mod gap_counts;
mod page;
mod search;
mod sensitivity;
mod soundness;
mod study;

use sweep::Sweep;

pub use benchmarks::{Benchmark, benchmarks};
pub use between::{BetweenPoints, FittestDesign, FrontOverGrid};
pub use claims::{CheckedClaim, CheckedStatement, Claim, Finding, Verdict, claims};
pub use error::ValidationError;
pub use gap_counts::GapCount;
pub use search::{ScoredSetting, SettingSearch};
pub use sensitivity::{ChoiceEffect, ChoiceEffects, Headlines, Sensitivity};
pub use soundness::Soundness;
use study::Study;

/// The sweeps on which claims are checked: the paper's 720 designs with either meaning of the length.
const SWEEPS: [(&str, &str); 2] = [
    ("paper sweep, base L", "name = \"paper\""),
    ("paper sweep, base 2L", "name = \"paper-as-written\"\nscale.base = \"2L\""),
];

/// The results of all parts of the validation.
#[derive(Clone, Debug)]
pub struct Validation {
    /// Problems with known answers.
    pub benchmarks: Vec<Benchmark>,
    /// The claims of the paper with their verdicts.
    pub claims: Vec<CheckedClaim>,
    /// Where the model holds, and the claims on a substrate that cannot fold.
    pub soundness: Soundness,
    /// The best designs between the points of the grid, if they were searched for.
    pub between: Option<BetweenPoints>,
    /// The claims on the most compliant designs, for strips with the same number of gaps in every design.
    pub gap_counts: Vec<GapCount>,
    /// The main results for each value of each open choice.
    pub sensitivity: Vec<Sensitivity>,
    /// The effects on the measures of the paper's simplified coupling through the substrate, and of friction between scales.
    pub effects: ChoiceEffects,
}

/// The part of a validation that begins now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartProgress<'a> {
    /// The number of parts that are done.
    pub done: usize,
    /// The number of all parts.
    pub parts: usize,
    /// The name of the part that begins.
    pub part: &'a str,
}

impl Validation {
    /// Carries out all parts, the `searches` between the grid points if they are asked for; `progress` is called when a part begins.
    ///
    /// # Errors
    /// If a benchmark has no result or the temporary folder cannot be written.
    pub fn run(
        searches: bool,
        mut progress: impl FnMut(PartProgress<'_>),
    ) -> Result<Self, ValidationError> {
        let settings = sensitivity::settings()?;
        // Benchmarks, two sweeps on two substrates, claims, searches, strips of equal gaps, and a part for each setting.
        let parts = 3 + usize::from(searches) + 2 * SWEEPS.len() + settings.len();
        let mut done = 0;
        let mut begin = |part: &str| {
            progress(PartProgress { done, parts, part });
            done += 1;
        };
        begin("benchmarks");
        let benchmarks = benchmarks()?;
        let [paper, as_written] = SWEEPS.map(|(part, text)| {
            begin(part);
            Study::run(Sweep::parse(text, "paper", &[])?)
        });
        let (paper, as_written) = (paper?, as_written?);
        let [other_paper, other_as_written] = soundness::neo_hookean_studies(&mut begin)?;
        begin("claims");
        let (linear, neo_hookean) = ([&paper, &as_written], [&other_paper, &other_as_written]);
        let (claims, others) = (claims::check(linear)?, claims::check(neo_hookean)?);
        let soundness = Soundness::of(linear, neo_hookean, [&claims, &others]);
        let between = searches.then(|| {
            begin("between the grid points");
            BetweenPoints::of(&paper)
        });
        let between = between.transpose()?;
        begin("strips of equal gaps");
        let gap_counts = GapCount::all()?;
        let (sensitivity, effects) =
            sensitivity::sensitivity(settings, &[paper, as_written], begin)?;
        Ok(Self { benchmarks, claims, soundness, between, gap_counts, sensitivity, effects })
    }

    /// Returns whether every benchmark lies within its band.
    pub fn holds(&self) -> bool {
        self.benchmarks.iter().all(Benchmark::holds)
    }
}

//! Validation of squama against benchmarks and the claims of the paper.
//!
//! The validation includes the sensitivity of the claims to choices that the paper leaves open.
//!
//! A benchmark is reproduced if the relative difference from its reference lies within its band:
//!
//! ```text
//! |ours/reference − 1| ≤ band
//! ```
//!
//! For an approximate reference the band is its known error. A claim of Shafiei et al. (2021, doi
//! 10.1016/j.jmps.2020.104176) is reproduced, reproduced in part, or not; no parameter is tuned.
//!
//! | Item | Role |
//! |---|---|
//! | [`benchmarks()`], [`Benchmark`] | problems with known answers (their closed forms are in [`analytical`]) |
//! | [`claims()`], [`Claim`], [`CheckedClaim`], [`CheckedStatement`], [`Verdict`] | the statements of the paper, and their verdicts |
//! | [`GridGapSearch`], [`FittestDesign`], [`FrontOverGrid`] | searches between the grid points |
//! | [`StripLength`] | the claims on the most compliant designs, for strips with the same number of gaps |
//! | [`Sensitivity`], [`Headlines`], [`ChoiceEffects`], [`ChoiceEffect`] | the dependence of the main results on the open choices |
//! | [`SurfaceFolds`] | folds of the surface, and the claims on a substrate that cannot fold |
//! | [`ChangedVerdicts`] | the claims with a guided needle, and with friction between scales |
//! | [`SettingSearch`], [`ScoredSetting`] | combinations of open choices, by the number of claims that they reproduce |
//! | [`Validation`], [`PartProgress`] | all parts, one after the other, and the page in Markdown |
//!
//! ```no_run
//! for benchmark in validation::benchmarks()? {
//!     assert!(benchmark.is_within_band(), "{}: {}", benchmark.name, benchmark.ours);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod benchmarks;
mod changed_verdicts;
mod claims;
mod grid_gap_search;
mod page;
mod search;
mod sensitivity;
mod strip_lengths;
mod study;
mod surface_folds;

use sweep::Sweep;

pub use benchmarks::{Benchmark, benchmarks};
pub use changed_verdicts::ChangedVerdicts;
pub use claims::{CheckedClaim, CheckedStatement, Claim, Finding, Verdict, claims};
pub use grid_gap_search::{FittestDesign, FrontOverGrid, GridGapSearch};
pub use search::{ScoredSetting, SettingSearch};
pub use sensitivity::{ChoiceEffect, ChoiceEffects, Headlines, Sensitivity};
pub use strip_lengths::StripLength;
use study::Study;
pub use surface_folds::SurfaceFolds;

/// The sweeps for the claims: the paper's 720 designs with both meanings of the length.
const BASES: [(&str, &str); 2] = [
    ("base L", "name = \"paper\""),
    ("base 2L", "name = \"paper-as-written\"\nscale.base = \"2L\""),
];

/// Models of the sweeps: the choices of the paper, and alternatives.
const MODELS: [(&str, &str); 3] = [
    ("paper sweep", ""),
    ("neo-Hookean substrate", "substrate.law = \"neo-hookean\""),
    (
        // The needle recommended in docs/needle.md.
        "guided needle",
        "puncture.needle = \"guided\"\npuncture.needle_friction = 0.3\npuncture.load_inset_over_t = 0.05",
    ),
];

/// The results of all parts of the validation.
#[derive(Clone, Debug)]
pub struct Validation {
    /// Problems with known answers.
    pub benchmarks: Vec<Benchmark>,
    /// The claims of the paper with their verdicts.
    pub claims: Vec<CheckedClaim>,
    /// Folds of the surface, and the claims on a substrate that cannot fold.
    pub soundness: SurfaceFolds,
    /// The claims under a guided needle.
    pub needle: ChangedVerdicts,
    /// The claims with friction between scales.
    pub friction: ChangedVerdicts,
    /// The best designs between the grid points, if searched.
    pub between: Option<GridGapSearch>,
    /// The claims on the most compliant designs, for strips with equal numbers of gaps.
    pub gap_counts: Vec<StripLength>,
    /// The main results for each value of each open choice.
    pub sensitivity: Vec<Sensitivity>,
    /// The effects of full substrate coupling and of friction between scales.
    pub effects: ChoiceEffects,
}

/// Solves the sweeps of the claims with one of the models.
///
/// `begin` is called with the name of each sweep before it is solved.
fn studies(
    (model, choice): (&str, &str),
    mut begin: impl FnMut(&str),
) -> anyhow::Result<[Study; 2]> {
    let [paper, as_written] = BASES.map(|(base, text)| {
        begin(&format!("{model}, {base}"));
        Study::run(Sweep::parse(&format!("{text}\n{choice}"), "paper", &[])?)
    });
    Ok([paper?, as_written?])
}

/// Progress of a validation, reported at the start of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartProgress<'a> {
    /// The number of completed parts.
    pub done: usize,
    /// The total number of parts.
    pub parts: usize,
    /// The name of the part that begins.
    pub part: &'a str,
}

impl Validation {
    /// Runs all parts, with `searches` between the grid points if requested.
    ///
    /// `progress` is called at the start of each part.
    ///
    /// # Errors
    /// If a benchmark has no result or the temporary folder cannot be written.
    pub fn run(searches: bool, mut progress: impl FnMut(PartProgress<'_>)) -> anyhow::Result<Self> {
        let settings = sensitivity::settings()?;
        // The parts are benchmarks, claims, strips of equal gaps, searches if requested, and each
        // sweep and setting.
        let sweeps = MODELS.len() * BASES.len();
        let parts = 3 + usize::from(searches) + sweeps + settings.len();
        let mut done = 0;
        let mut begin = |part: &str| {
            progress(PartProgress { done, parts, part });
            done += 1;
        };
        begin("benchmarks");
        let benchmarks = benchmarks()?;
        let [paper, neo_hookean, guided] = MODELS.map(|model| studies(model, &mut begin));
        let (paper, neo_hookean, guided) = (paper?, neo_hookean?, guided?);
        begin("claims");
        let [claims, on_neo_hookean, under_needle] =
            [&paper, &neo_hookean, &guided].map(|of| claims::check(of.each_ref()));
        let claims = claims?;
        let soundness = SurfaceFolds::compare(&paper, &neo_hookean, [&claims, &on_neo_hookean?]);
        let needle = ChangedVerdicts::compare(&claims, &[&under_needle?], BASES.len());
        let between = searches.then(|| {
            begin("between the grid points");
            GridGapSearch::run(&paper[0])
        });
        let between = between.transpose()?;
        begin("strips of equal gaps");
        let gap_counts = StripLength::all()?;
        let (sensitivity, effects, with_friction) =
            sensitivity::sensitivity(settings, &paper, begin)?;
        let with_friction: Vec<_> = with_friction.iter().map(Vec::as_slice).collect();
        // The sweep over friction has only the base L.
        let friction = ChangedVerdicts::compare(&claims, &with_friction, 1);
        Ok(Self {
            benchmarks,
            claims,
            soundness,
            needle,
            friction,
            between,
            gap_counts,
            sensitivity,
            effects,
        })
    }

    /// Returns true if every benchmark lies within its band.
    pub fn all_within_band(&self) -> bool {
        self.benchmarks.iter().all(Benchmark::is_within_band)
    }
}

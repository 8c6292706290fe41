//! Tolerances: what comes out when what is made differs from what is drawn.
//!
//! A [`Deviation`](sweep::Deviation) is common to all scales of a batch or differs from scale to scale. The spread of a measure is
//! predicted from its derivatives, the sum of the parts of batch deviations `s` and of single scales `i` (T1), and solved for with
//! random samples; both stand side by side, with the difference. Random numbers depend on the seed, the number of the sample and the
//! key of the parameter alone.
//!
//! ```text
//! σ² = Σ_s σ_s² + Σ_i σ_i²
//! ```
//!
//! ```text
//! deviations ─► derivatives ─► LinearSpread ─┐
//!          └──► samples ─────► Sampled ──────┴─► MeasureTolerance ─► tolerance.csv
//!                       └────► Proportion ─────► RequirementYield ─► yield.csv
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`Analysis`], [`DesignTolerance`] | a design with its deviations, and everything that is known of it |
//! | [`MeasureTolerance`], [`LinearSpread`], [`Sampled`] | the spread of a measure, predicted and solved |
//! | [`SourceShare`], [`DeviationLevel`] | the part of a source in it; whether all scales of a batch share the deviation |
//! | [`RequirementYield`], [`Proportion`] | the share of samples that meet a requirement, with its interval |
//! | [`SampledQuantile`] | a quantile over samples, with its interval |
//! | [`Sampler`], [`MadeSkin`] | solves skins that are made of designs |
//! | [`SolvedSample`], [`SampleStore`] | what was solved, kept so that nothing is solved twice |
//! | [`GlobalAnalysis`], [`GlobalSensitivity`], [`MeasureIndices`] | the parts that variables have in the variance over a box |
//! | [`sobol_indices`], [`Evaluation`], [`SobolIndices`], [`IndexEstimate`] | the estimators, for any function |
//! | [`TOLERANCE_COLUMNS`], [`SOURCE_COLUMNS`], [`YIELD_COLUMNS`], [`INDEX_COLUMNS`] | the tables |
//! | [`NoAnalysis`] | why there is no analysis |
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use run::Program;
//! use sweep::Sweep;
//! use tolerance::{Analysis, SampleStore};
//!
//! // Scales of 45° cover λ = 1 − d (Eq. G2), so the coverage spreads as the gap does.
//! let text = "name = 'x'\nmeasures = 'coverage'\n[designs]\ngap_over_t = 0.5\nlength_over_t = 1\nslant_deg = 45\n\
//!             [tolerance]\ngap_over_t = { batch_sd = 0.01 }";
//! let sweep = Sweep::parse(text, "x.toml", &[])?;
//! let (folder, stop) = (tempfile::tempdir()?, AtomicBool::new(false));
//! let program = Program { version: "1.0", revision: "none" };
//! let analysis = Analysis::new(&sweep, &[], 50, program, &stop);
//! let design = analysis.design(0, &SampleStore::new(folder.path()))?;
//! let coverage = design.measures.iter().find(|measure| measure.name == "coverage").expect("it is measured");
//! let predicted = coverage.linear.as_ref().expect("it has derivatives");
//! assert!((predicted.spread - 0.01).abs() < 1e-6);
//! assert_eq!(coverage.failed, 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod analysis;
mod draw;
mod global;
mod linear;
mod measured;
mod moments;
mod no_analysis;
mod proportion;
mod quantile;
mod sampled;
mod sampler;
mod sobol;
mod store;
mod tables;
mod yields;

pub use analysis::{Analysis, DesignTolerance, MeasureTolerance};
pub use global::{GlobalAnalysis, GlobalSensitivity, MeasureIndices};
pub use linear::{DeviationLevel, LinearSpread, SourceShare};
pub use measured::NoSuchColumn;
pub use no_analysis::NoAnalysis;
pub use proportion::Proportion;
pub use quantile::SampledQuantile;
pub use sampled::Sampled;
pub use sampler::{MadeSkin, Sampler};
pub use sobol::{Evaluation, IndexEstimate, SobolIndices, sobol_indices};
pub use store::{SampleStore, SolvedSample};
pub use tables::{
    DesignMeasureTolerance, DesignSource, DesignYield, INDEX_COLUMNS, IndexRow, SOURCE_COLUMNS,
    TOLERANCE_COLUMNS, YIELD_COLUMNS,
};
pub use yields::RequirementYield;

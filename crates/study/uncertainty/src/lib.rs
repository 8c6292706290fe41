//! The effect of manufacturing tolerances: the spread of every measure, and the yield.
//!
//! All scales of a batch share a [`Deviation`](sweep::Deviation), or each scale has its own. The derivatives of a measure predict its
//! spread: the variances that batch deviations `s` and single scales `i` cause add up (T1). Solving random samples gives the spread
//! too, and the tables show both and their discrepancy. The random numbers of a sample depend on nothing but the seed, the number of
//! the sample and the key of the parameter.
//!
//! ```text
//! σ² = Σ_s σ_s² + Σ_i σ_i²
//! ```
//!
//! ```text
//! deviations ─► derivatives ─► LinearSpread ─┐
//!          └──► samples ─────► SampledSpread ──────┴─► MeasureTolerance ─► tolerance.csv
//!                       └────► Proportion ─────► RequirementYield ─► yield.csv
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`Analysis`], [`DesignTolerance`] | the tolerances of a design |
//! | [`MeasureTolerance`], [`LinearSpread`], [`SampledSpread`] | the spread of a measure, predicted and solved |
//! | [`SourceShare`], [`DeviationLevel`] | the part of a source in it; whether all scales of a batch share the deviation |
//! | [`RequirementYield`], [`Proportion`] | the share of samples that meet a requirement, with its interval |
//! | [`SampledQuantile`] | a quantile over samples, with its interval |
//! | [`Sampler`], [`Sample`] | draws and solves samples of designs |
//! | [`SolvedSample`], [`SampleStore`] | the solved samples, kept on disk so that none is solved twice |
//! | [`GlobalAnalysis`], [`GlobalSensitivity`], [`MeasureIndices`] | global sensitivity: the share of every variable in the variance |
//! | [`sobol_indices`], [`Evaluation`], [`SobolIndices`], [`IndexEstimate`] | the estimators, for any function |
//! | [`TOLERANCE_COLUMNS`], [`SOURCE_COLUMNS`], [`YIELD_COLUMNS`], [`INDEX_COLUMNS`] | the tables |
//! | [`AnalysisError`] | why an analysis fails |
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use run::Program;
//! use sweep::Sweep;
//! use uncertainty::{Analysis, SampleStore};
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
mod analysis_error;
mod draw;
mod global;
mod linear;
mod measured_columns;
mod moments;
mod proportion;
mod quantile;
mod sample_store;
mod sampled_spread;
mod sampler;
mod sobol;
mod tables;
mod yields;

pub use analysis::{Analysis, DesignTolerance, MeasureTolerance};
pub use analysis_error::AnalysisError;
pub use global::{GlobalAnalysis, GlobalSensitivity, MeasureIndices};
pub use linear::{DeviationLevel, LinearSpread, SourceShare};
pub use measured_columns::NoSuchColumn;
pub use proportion::Proportion;
pub use quantile::SampledQuantile;
pub use sample_store::{SampleStore, SolvedSample};
pub use sampled_spread::SampledSpread;
pub use sampler::{Sample, Sampler};
pub use sobol::{Evaluation, IndexEstimate, SobolIndices, sobol_indices};
pub use tables::{INDEX_COLUMNS, SOURCE_COLUMNS, TOLERANCE_COLUMNS, YIELD_COLUMNS};
pub use yields::RequirementYield;

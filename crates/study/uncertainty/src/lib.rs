//! Effect of manufacturing tolerances: spread of every measure, and yield.
//!
//! All scales of a batch share a [`Deviation`](sweep::Deviation), or each scale has its own
//! deviation. The spread of a measure is its standard deviation `σ`. First, the derivatives of the
//! measure predict the spread: the variances caused by batch deviations `s` and by single scales
//! `i` add up,
//!
//! ```text
//! σ² = Σ_s σ_s² + Σ_i σ_i²                                                               (T1)
//! ```
//!
//! Second, random samples of the design are solved. The tables contain the predicted spread, the
//! sampled spread and their relative difference. The random numbers of a sample depend only
//! on the seed, the number of the sample and the key of the parameter.
//!
//! ```text
//! deviations ─► derivatives ─► LinearSpread ─┐
//!          └──► samples ─────► SampledSpread ──────┴─► MeasureTolerance ─► tolerance.csv
//!                       └────► Proportion ─────► RequirementYield ─► yield.csv
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`Analysis`], [`DesignTolerance`] | tolerance analysis of a design, and its result |
//! | [`MeasureTolerance`] | spread of a measure, predicted and sampled |
//! | [`LinearSpread`], [`SourceShare`] | predicted spread, and the contribution of each source |
//! | [`DeviationLevel`] | states whether all scales of a batch share a deviation |
//! | [`SampledSpread`], [`SampledQuantile`] | spread and quantile of the values of samples |
//! | [`RequirementYield`], [`Proportion`] | fraction of samples that meet a requirement |
//! | [`Sampler`], [`Sample`] | draws and solves samples of designs |
//! | [`SolvedSample`], [`SampleStore`] | a solved sample, and the files that store samples |
//! | [`GlobalAnalysis`], [`GlobalSensitivity`] | global sensitivity analysis, and its result |
//! | [`MeasureIndices`] | Sobol' indices of a measure for every variable |
//! | [`sobol_indices`], [`Evaluation`] | estimator of the indices for any function, and its input |
//! | [`SobolIndices`], [`IndexEstimate`] | estimated indices with their standard errors |
//! | [`TOLERANCE_COLUMNS`], [`SOURCE_COLUMNS`] | columns of the tables of spreads |
//! | [`YIELD_COLUMNS`], [`INDEX_COLUMNS`] | columns of the tables of yields and indices |
//! | [`AnalysisError`] | error of an analysis |
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use run::Program;
//! use sweep::Sweep;
//! use uncertainty::{Analysis, SampleStore};
//!
//! // At 45° the coverage is λ = 1 − d (Eq. G2), so coverage and gap have the same spread.
//! let text = "name = 'x'\nmeasures = 'coverage'\n\
//!             [designs]\ngap_over_t = 0.5\nlength_over_t = 1\nslant_deg = 45\n\
//!             [tolerance]\ngap_over_t = { batch_sd = 0.01 }";
//! let sweep = Sweep::parse(text, "x.toml", &[])?;
//! let (folder, stop) = (tempfile::tempdir()?, AtomicBool::new(false));
//! let program = Program { version: "1.0", revision: "none" };
//! let analysis = Analysis::new(&sweep, &[], 50, program, &stop);
//! let design = analysis.design(0, &SampleStore::new(folder.path()))?;
//! let mut measures = design.measures.iter();
//! let coverage = measures.find(|measure| measure.name == "coverage").expect("it is measured");
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

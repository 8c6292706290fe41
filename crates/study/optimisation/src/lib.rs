//! Optimisation: finds the best designs in ranges of continuous and discrete variables.
//!
//! A goal defines variables, objectives and requirements. A search first solves the designs at
//! space-filling points. Gradient searches then improve the best of these designs with the exact
//! derivatives of the measures. A gradient search stops at a kink of a measure; a bundle method
//! then continues the search along the kink.
//! Several objectives give a Pareto front. The binding limits `g_k ≥ l_k` of a best design have
//! multipliers `μ_k`, which balance the gradient of the objective `o` and state the cost of each
//! limit (O1):
//!
//! ```text
//! ∇o + Σ μ_k ∇g_k = 0,   μ_k ≥ 0;      do/dl_k = −μ_k
//! ```
//!
//! ```text
//! DesignGoal ─► DesignSpace ─► sample ─► local search ⇄ ridge, polish ─► Found: designs, history
//!                                     └─ Evaluations: each point once, stored in a journal ─┘
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`DesignGoal`] | variables, objectives and requirements, as in the file |
//! | [`DesignSpace`], [`SpacePoint`] | space of the variables, and its points |
//! | [`Interval`], [`Choice`] | a continuous variable, and a discrete variable |
//! | [`Judge`], [`Judgement`], [`NominalWorth`] | judgement of a design by the goal |
//! | [`Statistic`] | quantile or yield over samples |
//! | [`Confirmation`], [`Estimate`] | check of statistics with independent samples |
//! | [`MissedRequirement`] | a requirement, and the fraction of samples that miss it |
//! | [`Rounding`] | rounding of a best design to multiples of a step |
//! | [`DesignChecks`], [`Check`], [`Contradiction`] | checks of a best design with finer models |
//! | [`optimise`], [`SearchOptions`] | runs a search |
//! | [`SearchProgress`], [`SearchPart`] | progress of a search |
//! | [`SearchStatus`] | status of a search, from its journal |
//! | [`Found`], [`Answer`], [`BestDesign`], [`Front`] | results of a search |
//! | [`UnjudgedDesigns`] | counts of designs without a valid judgement |
//! | [`Candidate`], [`SearchStage`], [`Target`] | evaluated design, stage and target of a search |
//! | [`write_found`] | writes the tables of a search |
//! | [`BindingText`] | describes binding limits and their cost in words |
//! | [`Agreement`] | number of local searches that found the same best design |
//! | [`Binding`], [`Limit`] | a binding limit with its multiplier, and the kinds of limits |
//! | [`OptimisationError`] | error of a search |
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use optimisation::{Answer, DesignGoal, SearchProgress, SearchOptions, optimise};
//! use run::{Program, Start};
//!
//! // At 45° the coverage is λ = 1 − d (Eq. G2), so the narrowest gap is best.
//! let text = "name = 'covered'\nmeasures = 'coverage'\n\
//!             [variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
//!             [designs]\nlength_over_t = 1\nslant_deg = 45\n\
//!             [goal]\nmaximize = 'coverage'\nsamples = 8";
//! let goal = DesignGoal::parse(text, "covered.toml", &[])?;
//! let (folder, stop) = (tempfile::tempdir()?, AtomicBool::new(false));
//! let progress = SearchProgress::default();
//! let options = SearchOptions { threads: 1, start: Start::New, stop: &stop, progress: &progress };
//! let program = Program { version: "1.0", revision: "none" };
//! let found = optimise(&goal, folder.path(), &options, &program)?.expect("no stop request");
//! let Answer::Optimum(best) = found.answer else { panic!("there is one objective") };
//! assert!((best.row.case.design.gap - 0.1).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answer;
mod best;
mod binding_text;
mod candidate;
mod checks;
mod column;
mod contact_margin;
mod contradiction;
mod coverage_peaks;
mod coverage_piece;
mod error;
mod evaluated_row;
mod evaluations;
mod front;
mod goal;
mod improvement;
mod judge;
mod judgement;
mod local;
mod price;
mod progress;
mod reason;
mod requirement_bounds;
mod restarts;
mod rounding;
mod sample;
mod sampled;
mod search;
mod slopes;
mod space;
mod space_filling;
mod statistic;
mod status;
mod tables;

pub use answer::Answer;
pub use best::BestDesign;
pub use binding_text::BindingText;
pub use candidate::{Candidate, SearchStage, Target};
pub use checks::{Check, DesignChecks, described};
pub use contradiction::Contradiction;
pub use error::OptimisationError;
pub use front::Front;
pub use goal::DesignGoal;
pub use goal::section::goal_schema;
pub use judge::Judge;
pub use judgement::{Judgement, NominalWorth};
pub use price::{Binding, Limit};
pub use progress::{SearchPart, SearchProgress};
pub use restarts::Agreement;
pub use rounding::Rounding;
pub use sample::MissedRequirement;
pub use sampled::confirmation::{Confirmation, Estimate};
pub use search::{Found, SearchOptions, UnjudgedDesigns, optimise};
pub use space::{Choice, DesignSpace, Interval, SpacePoint};
pub use statistic::Statistic;
pub use status::{EvaluatedDesign, SearchStatus};
pub use tables::{
    FAILED_CHECKS, FRONT, GOAL, HISTORY, NEAREST_DEFINITION, OPTIMUM, OPTIMUM_DEFINITION,
    history_columns, optimum_columns, write_found,
};

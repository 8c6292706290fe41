//! Optimisation: the best designs between the points of a grid.
//!
//! A goal names variables, objectives and requirements. Points that fill the space of the variables are solved first; the best of
//! them are improved along the exact derivatives of every measure, and, where those end at kinks, by a bundle method that converges
//! there. Several objectives give a front. What binds at a best design, and what it costs, comes from the multipliers of
//! the limits `g_k ≥ l_k` that balance the objective `o` (O1):
//!
//! ```text
//! ∇o + Σ μ_k ∇g_k = 0,   μ_k ≥ 0;      do/dl_k = −μ_k
//! ```
//!
//! ```text
//! DesignGoal ─► DesignSpace ─► sample ─► climb ⇄ ridge, polish ─► Found: optimum or front, bindings, history
//!                                └─ Evaluations: each point once, kept in a journal ─┘
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`DesignGoal`] | variables, objectives, requirements, as they are written |
//! | [`DesignSpace`], [`Interval`], [`Choice`], [`SpacePoint`] | the space of the variables, and the cases of its points |
//! | [`Judge`], [`Judgement`], [`NominalWorth`] | what a design is worth by the goal |
//! | [`Statistic`], [`Confirmation`], [`Estimate`] | a quantile or yield over samples, and its test with other samples |
//! | [`optimise`], [`SearchOptions`] | the search |
//! | [`SearchProgress`], [`SearchPart`] | how far it is |
//! | [`Found`], [`Answer`], [`BestDesign`], [`Front`], [`LeftOutDesigns`] | what it found |
//! | [`Candidate`], [`SearchStage`], [`Target`] | a design that was looked at, in which stage, and what for |
//! | [`write_found`] | writes the tables of what was found |
//! | [`BindingText`] | what binds and what it costs, in words |
//! | [`Agreement`] | how many searches agree on a best design |
//! | [`Binding`], [`Limit`] | what keeps a design from being better, and its price |
//! | [`OptimisationError`] | why there was no search |
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use optimisation::{Answer, DesignGoal, SearchProgress, SearchOptions, optimise};
//! use run::{Program, Start};
//!
//! // Scales of 45° cover more, the narrower their gaps: λ = 1 − d (Eq. G2).
//! let text = "name = 'covered'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
//!             [designs]\nlength_over_t = 1\nslant_deg = 45\n[goal]\nmaximize = 'coverage'\nsamples = 8";
//! let goal = DesignGoal::parse(text, "covered.toml", &[])?;
//! let (folder, stop) = (tempfile::tempdir()?, AtomicBool::new(false));
//! let progress = SearchProgress::default();
//! let options = SearchOptions { threads: 1, start: Start::New, stop: &stop, progress: &progress };
//! let program = Program { version: "1.0", revision: "none" };
//! let found = optimise(&goal, folder.path(), &options, &program)?.expect("nobody stops it");
//! let Answer::Optimum(best) = found.answer else { panic!("there is one objective") };
//! assert!((best.row.case.design.gap - 0.1).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answer;
mod best;
mod binding_text;
mod candidate;
mod column;
mod contact_margin;
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
mod requirement_bounds;
mod restarts;
mod sample;
mod sampled;
mod search;
mod slopes;
mod space;
mod space_filling;
mod statistic;
mod tables;

pub use answer::Answer;
pub use best::BestDesign;
pub use binding_text::BindingText;
pub use candidate::{Candidate, SearchStage, Target};
pub use error::OptimisationError;
pub use front::Front;
pub use goal::DesignGoal;
pub use judge::Judge;
pub use judgement::{Judgement, NominalWorth};
pub use price::{Binding, Limit};
pub use progress::{SearchPart, SearchProgress};
pub use restarts::Agreement;
pub use sampled::confirmation::{Confirmation, Estimate};
pub use search::{Found, LeftOutDesigns, SearchOptions, optimise};
pub use space::{Choice, DesignSpace, Interval, SpacePoint};
pub use statistic::Statistic;
pub use tables::{
    FRONT, GOAL, HISTORY, NEAREST_DEFINITION, OPTIMUM, OPTIMUM_DEFINITION, history_columns,
    optimum_columns, write_found,
};

//! Ranking, Pareto front and comparison of the designs of runs.
//!
//! Designs that meet all requirements are ranked by fitness: the criteria are rescaled, weighted
//! and combined. A ranking contains the best design for one set of weights and for all weights on a
//! grid, and the Pareto front, which needs no weights. Two runs are compared design by design. On
//! the paper's scale the fitness of a design is the weighted geometric mean of its rescaled
//! criteria (Eq. 7 of Shafiei et al. 2021, doi 10.1016/j.jmps.2020.104176),
//!
//! ```text
//! f = s₁^m s₂^n s₃^k s₄^l,     s = (c − min c)/(max c − min c)                       (R3), (R2)
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`Preferences`] | requirements, criteria, weights and scale, as stored in `ranking.toml` |
//! | [`Requirement`], [`Relation`] | bound on a column |
//! | [`CRITERIA`], [`Criterion`], [`Goal`] | columns to be maximised or minimised |
//! | [`Weights`], [`Scale`] | weights of the criteria, and the rule to rescale and combine criteria |
//! | [`Ranking`], [`RankedDesign`] | designs in the order of their fitness |
//! | [`Unmet`] | nearest design and binding requirements, if no design meets all requirements |
//! | [`check_comparable`], [`comparable_groups`] | designs with comparable criteria |
//! | [`TetrahedralGrid`] | a grid of all weights of four criteria |
//! | [`Standard`] | protection levels that requirements may name, such as `needle 2` |
//! | [`Worth`], [`tightest`] | objectives of a design, and its margins to all requirements |
//! | [`FitnessGoal`], [`CriterionEnds`], [`RescaledCriterion`] | fitness with fixed worst and best values of the criteria |
//! | [`dominates`], [`pareto_front`] | Pareto dominance and front |
//! | [`compare()`], [`Comparison`] | differences between two runs |
//! | [`write_ranking`], [`write_comparison`] | write the tables of a ranking or of a comparison |
//!
//! ```
//! use ranking::{Ranking, TetrahedralGrid, Weights};
//! use results::Results;
//!
//! let table = "design,coverage,critical_force,penetration,compliance\n\
//!              0001,0.2,1,0.5,10\n0002,0.6,5,0.25,20\n0003,1,3,0.2,40";
//! let folder = tempfile::tempdir()?;
//! std::fs::write(folder.path().join("designs.csv"), table)?;
//! let results = Results::read(folder.path())?;
//! let ranking = Ranking::new(&results, TetrahedralGrid::default())?;
//! assert_eq!(ranking.winner(Weights::BALANCED).design(), "0003");
//! assert_eq!(ranking.front().len(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod compare;
mod criterion;
mod filter;
mod fitness;
mod front;
mod incomparable;
mod pain;
mod preferences;
mod ranking;
mod requirement;
mod requirement_text;
mod scale;
mod standard;
mod tetrahedral_grid;
mod unmet;
mod weights;
mod worth;

pub use compare::{
    COMPARISON_COLUMNS, ColumnDifference, Comparison, Difference, Extreme, InvalidComparison,
    ParameterChange, compare, difference_columns, rank_correlation, write_comparison,
};
pub use criterion::{CRITERIA, Criterion, InvalidCriterion};
pub use fitness::{CriterionEnds, FitnessGoal, RescaledCriterion};
pub use front::{dominates, pareto_front};
pub use incomparable::{Incomparable, comparable_groups};
pub use pain::{PAIN_LIMITS, PAIN_MEANING, PainLimit};
pub use preferences::{InvalidPreferences, Preferences};
pub use ranking::{
    InvalidRanking, RankedDesign, Ranking, check_comparable, pareto_columns, quaternary_columns,
    ranking_columns, winner_columns, write_ranking, write_unmet,
};
pub use requirement::{Relation, Requirement};
pub use requirement_text::InvalidRequirement;
pub use results::columns::Goal;
pub use scale::{Scale, UnknownScale};
pub use standard::{STANDARDS, Standard, TILTING_ONLY};
pub use tetrahedral_grid::{InvalidResolution, Steps, TetrahedralGrid};
pub use unmet::{Unmet, UnmetRequirement};
pub use weights::{InvalidWeights, MOST_CRITERIA, Weights};
pub use worth::{Worth, tightest};

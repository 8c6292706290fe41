//! Rankings: what is made of the results of a run.
//!
//! Four criteria are rescaled, weighted and multiplied; the best design is found for one set of
//! weights, for all of them, and without any. Two runs are compared design by design.
//!
//! | Type | Role |
//! |---|---|
//! | [`CRITERIA`], [`Weights`] | what is good, and how much each counts |
//! | [`Ranking`], [`RankedDesign`] | the designs in the order of their fitness |
//! | [`TetrahedralGrid`] | all ways to share a weight among the criteria |
//! | [`pareto_front`] | designs that no other beats |
//! | [`compare()`], [`Comparison`] | where two runs differ |

mod compare;
mod criteria;
mod front;
mod ranking;
mod tetrahedral_grid;

pub use compare::{
    ColumnDifference, Comparison, Difference, Extreme, InvalidComparison, ParameterChange, compare,
    comparison_columns, difference_columns, rank_correlation, write_comparison,
};
pub use criteria::{CRITERIA, Criterion, InvalidWeights, Weights};
pub use front::pareto_front;
pub use ranking::{
    InvalidRanking, LeftOut, RankedDesign, Ranking, pareto_columns, quaternary_columns,
    ranking_columns, winner_columns, write_ranking,
};
pub use tetrahedral_grid::{InvalidResolution, Steps, TetrahedralGrid};

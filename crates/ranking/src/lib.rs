//! Rankings: what is made of the results of a run.
//!
//! Four criteria are rescaled, weighted and multiplied; the best design is found for one set of
//! weights, for all of them, and without any. Two runs are compared design by design.
//!
//! | Type | Role |
//! |---|---|
//! | [`CRITERIA`], [`SOUND_CRITERIA`], [`Weights`] | what is good, and how much each counts |
//! | [`Ranking`], [`RankedDesign`] | the designs in the order of their fitness |
//! | [`TetrahedralGrid`] | all ways to share a weight among the criteria |
//! | [`pareto_front`] | designs that no other beats |
//! | [`compare()`], [`Comparison`] | where two runs differ |
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
mod criteria;
mod front;
mod ranking;
mod tetrahedral_grid;

pub use compare::{
    ColumnDifference, Comparison, Difference, Extreme, InvalidComparison, ParameterChange, compare,
    comparison_columns, difference_columns, rank_correlation, write_comparison,
};
pub use criteria::{CRITERIA, Criterion, InvalidWeights, SOUND_CRITERIA, Weights};
pub use front::pareto_front;
pub use ranking::{
    InvalidRanking, LeftOut, RankedDesign, Ranking, pareto_columns, quaternary_columns,
    ranking_columns, winner_columns, write_ranking,
};
pub use tetrahedral_grid::{InvalidResolution, Steps, TetrahedralGrid};

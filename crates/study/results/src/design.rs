//! A solved design: outcomes, measures and failures.

pub mod design_result;
pub mod extrapolated;
pub mod failure;
pub mod outcome;
pub mod parameter_derivative;
pub mod path_result;
pub mod rerun_change;
pub mod row;
pub mod sample_statistics;
mod solved_path;
mod stored_derivatives;

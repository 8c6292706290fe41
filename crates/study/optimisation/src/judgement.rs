//! Judgement of a design by a goal.

use ranking::Worth;
use results::Outcome;

/// Judgement of a design by a goal.
#[derive(Clone, Debug, PartialEq)]
pub enum Judgement {
    /// Objectives and required columns have values.
    Judged(Worth),
    /// The goal contains statistics over samples, but the design was not sampled.
    Nominal(NominalWorth),
    /// The surface folded along the path, although the design meets all requirements at the end.
    Folded,
    /// A measure failed. Holds the outcome of its solution.
    Failed(Outcome),
    /// The design is complete, but a column of the goal is empty. Holds the name of the column.
    Missing(String),
}

/// Values of a nominal design in the columns of requirements.
#[derive(Clone, Debug, PartialEq)]
pub struct NominalWorth {
    /// Value for each requirement on a column; requirements on statistics are omitted.
    pub required: Vec<f64>,
    /// Largest shortfall relative to the limit; 0 if every requirement is met.
    pub shortfall: f64,
}

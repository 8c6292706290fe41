//! Judgement of a design by a goal.

use ranking::Worth;
use results::Outcome;

/// Judgement of a design by a goal.
#[derive(Clone, Debug, PartialEq)]
pub enum Judgement {
    /// All objectives and required columns have values.
    Judged(Worth),
    /// The goal is about samples, and the design was not sampled.
    Nominal(NominalWorth),
    /// The surface folded along the path and is open again at the end.
    Folded,
    /// A measure has no value.
    Failed(Outcome),
    /// The design is complete, but has no value in a column of the goal, named here.
    Missing(String),
}

/// Values of a nominal design under the requirements on its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct NominalWorth {
    /// Values in the required columns, without statistics.
    pub required: Vec<f64>,
    /// Largest shortfall, relative to the limit; 0 if every requirement is met.
    pub shortfall: f64,
}

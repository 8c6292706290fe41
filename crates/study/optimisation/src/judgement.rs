//! What a judge makes of a design.

use ranking::Worth;
use results::Outcome;

/// The judgement of a design by a goal.
#[derive(Clone, Debug, PartialEq)]
pub enum Judgement {
    /// The design has every objective and every column that is required.
    Judged(Worth),
    /// The goal is about samples, and of this design only the nominal one is known.
    Nominal(NominalWorth),
    /// The surface folded on the way and is open again at the end.
    Folded,
    /// A measure has no value.
    Failed(Outcome),
    /// The design is complete, and has no value in the column of an objective or a requirement.
    Missing(String),
}

/// The worth of a nominal design, by the requirements that its samples are to meet, too.
#[derive(Clone, Debug, PartialEq)]
pub struct NominalWorth {
    /// The values of the columns that are required, without statistics.
    pub required: Vec<f64>,
    /// The largest shortfall, relative to the limit; 0 where every requirement is met.
    pub shortfall: f64,
}

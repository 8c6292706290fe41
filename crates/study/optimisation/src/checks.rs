//! Checks of a best design with finer models.
//!
//! The design is solved again with full substrate coupling, at other load positions and with new
//! samples.

use std::fmt;

use results::Outcome;
use results::columns::measures_among;
use run::{CouplingChange, GapChange, Patience, WeakestPlace};
use sweep::Case;
use text::number;

use crate::goal::DesignGoal;

/// Results of a best design solved with finer models.
#[derive(Clone, Debug, Default)]
pub struct DesignChecks {
    /// Change of the goal's columns with full substrate coupling.
    ///
    /// `None` if the coupling is already full, or if no column changes.
    pub coupling: Option<CouplingChange>,
    /// Change of the goal's columns with gaps 10 % smaller and larger.
    pub gaps: Option<GapChange>,
    /// Forces at other load positions, with full coupling.
    ///
    /// Empty unless the needle is guided.
    pub places: Vec<WeakestPlace>,
}

/// Kind of check of a best design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Check {
    /// Solution with full substrate coupling.
    Coupling,
    /// Solutions at other load positions with full substrate coupling.
    ///
    /// The values are the weakest load position (0: left corner of the top, 1: right corner) and
    /// the outcome of the path at this position. If the path at another position ended so early
    /// that the smallest force is uncertain, the values belong to that position.
    LoadPositions(f64, Outcome),
    /// Solution of new samples. The value is the number of samples.
    Samples(usize),
}

impl DesignChecks {
    /// Solves the case `best`, the best design of `goal`, with finer models.
    pub(crate) fn solve(goal: &DesignGoal, best: &Case) -> Self {
        let alone = goal.space.sweep().at(best);
        let number = alone.grid().number(0).to_string();
        let columns = measures_among(goal.columns());
        let patience = Patience::Unlimited;
        let ((coupling, gaps), places) = rayon::join(
            || {
                rayon::join(
                    || CouplingChange::solve(&alone, &number, &columns, patience),
                    || GapChange::solve(&alone, &number, &columns, patience),
                )
            },
            || WeakestPlace::solve(&alone, &number, &columns),
        );
        Self { coupling, gaps, places }
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Coupling => write!(f, "With full substrate coupling"),
            Self::LoadPositions(position, _) => {
                write!(f, "At {}, with full substrate coupling", described(position))
            }
            Self::Samples(count) => write!(f, "Over {} new samples", number::text(count as f64)),
        }
    }
}

/// Describes a load position: 0 is the left corner of the top, 1 the right corner.
pub fn described(position: f64) -> String {
    if position == 0.0 {
        "the left corner of the scale".to_owned()
    } else if position == 1.0 {
        "the right corner of the scale".to_owned()
    } else {
        format!("{} of the width from the left corner", number::rounded(position, 3))
    }
}

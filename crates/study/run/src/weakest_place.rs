//! Solves a design again at more load positions.

use results::Quantity;
use serde::Serialize;
use sweep::Sweep;

use crate::gap_change::again;

/// Number of load positions on the top of a scale.
pub const PLACES: usize = 11;

/// Critical forces at the requested and at the weakest load position.
///
/// Forces are dimensionless, then in newtons if the material has a modulus and a thickness.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WeakestPlace {
    /// Force at the requested position.
    pub requested: [Option<f64>; 2],
    /// Force at the weakest of [`PLACES`] positions; `None` if a path ended early.
    pub weakest: [Option<f64>; 2],
    /// The weakest position: 0 is the left corner of the top, 1 the right corner.
    pub place: Option<f64>,
}

impl WeakestPlace {
    /// Solves design `number` of `sweep` at [`PLACES`] load positions.
    ///
    /// Returns `None` if there is no such design, if it is slow to solve, if it has as many
    /// positions already, or if its needle is not guided: a dead load is attached to its corner.
    pub fn solve(sweep: &Sweep, number: &str) -> Option<Self> {
        let index = sweep.grid().parse_number(number).ok()?;
        let punctured = sweep.grid().case(index).punctured();
        let has_all = punctured.places.is_some_and(|places| places >= PLACES);
        (punctured.needle.is_guided() && !has_all).then_some(())?;
        let (case, [row]) =
            again(sweep, number, [PLACES], |case, places| case.puncture.places = Some(places))?;
        let measures = row.result.puncture?.measures;
        let [requested, weakest] = [measures.critical_force, measures.weakest.force]
            .map(|force| [force, force.and_then(|f| Quantity::Force.physical(f, &case))]);
        Some(Self { requested, weakest, place: measures.weakest.place })
    }
}

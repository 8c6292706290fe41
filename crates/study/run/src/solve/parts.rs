//! Parts of a design that must be solved for a given set of columns.

use results::columns::needs_parameter;
use sweep::{Case, key};

/// Parts of a design to solve besides its first puncture and its bending.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts {
    /// True if all load positions are solved.
    places: bool,
    /// True if the row across is solved.
    across: bool,
    /// True if bodies between two radii are solved.
    between: bool,
    /// True if unloading is solved, for puncture and for bending.
    unloading: [bool; 2],
}

impl Parts {
    /// Returns the parts of a design on which `columns` depend.
    pub(super) fn of(columns: &[&str]) -> Self {
        let [places, across, failure, between, unload, unbend] =
            [key::PLACES, key::ACROSS, key::FAILURE, key::RADIUS_TO, key::UNLOAD, key::UNBEND]
                .map(|key| columns.iter().any(|column| needs_parameter(column, key)));
        // A first failure may occur across the row. The force across the row is compared with the
        // force at the weakest load position, so the load positions are needed, too.
        let across = across || failure;
        Self { places: places || across, across, between, unloading: [unload, unbend] }
    }

    /// Returns `case` without the parts that are not solved.
    pub(super) fn of_case(self, case: &Case) -> Case {
        let mut case = *case;
        let [unload, unbend] = self.unloading;
        case.puncture.places = case.puncture.places.filter(|_| self.places);
        case.across &= self.across;
        case.gap_across = case.gap_across.filter(|_| self.across);
        case.body_radius_to = case.body_radius_to.filter(|_| self.between);
        case.puncture.unload &= unload;
        case.flexure.unload &= unbend;
        case
    }
}

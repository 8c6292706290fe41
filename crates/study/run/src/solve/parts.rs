//! Parts of a design that columns need.

use results::columns::needs_parameter;
use sweep::{Case, key};

/// Parts of a design besides its first puncture and its bending.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts {
    /// The load positions.
    places: bool,
    /// The row across.
    across: bool,
    /// The bodies between two radii.
    between: bool,
    /// Unloading, of puncture and bending.
    unloading: [bool; 2],
}

impl Parts {
    /// Returns the parts that `columns` need.
    pub(super) fn of(columns: &[&str]) -> Self {
        let [places, across, failure, between, unload, unbend] =
            [key::PLACES, key::ACROSS, key::FAILURE, key::RADIUS_TO, key::UNLOAD, key::UNBEND]
                .map(|key| columns.iter().any(|column| needs_parameter(column, key)));
        // The first failure may occur across the row. Both directions are compared at the weakest
        // load position.
        let across = across || failure;
        Self { places: places || across, across, between, unloading: [unload, unbend] }
    }

    /// Returns `case` without requests for parts that are not needed.
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

//! Parameters without mechanical meaning.

use contact::InvalidLaw;
use geometry::OutOfRange;

/// A parameter without mechanical meaning.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidDesign {
    /// A parameter of the geometry, the membrane, the puncture or the imperfection.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// A constant of the contact law.
    #[error(transparent)]
    Law(#[from] InvalidLaw),
}

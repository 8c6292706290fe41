//! Parameters without mechanical meaning.

use contact::InvalidLaw;
use geometry::InvalidGeometry;
use membrane::InvalidMembrane;

use crate::imperfection::InvalidImperfection;
use crate::puncture::InvalidPuncture;

/// A parameter without mechanical meaning.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidDesign {
    /// In the geometry.
    #[error(transparent)]
    Geometry(#[from] InvalidGeometry),
    /// In the contact law.
    #[error(transparent)]
    Law(#[from] InvalidLaw),
    /// In the membrane.
    #[error(transparent)]
    Membrane(#[from] InvalidMembrane),
    /// In the imperfection.
    #[error(transparent)]
    Imperfection(#[from] InvalidImperfection),
    /// In what the puncture depends on besides.
    #[error(transparent)]
    Puncture(#[from] InvalidPuncture),
}

//! Common interface of the two models of the membrane in a gap.

use geometry::Vec2;
use nalgebra::DVector;

use crate::{Derivatives, Elastica, GapEnergies, GapMembrane, GapResponse};

/// Membrane in one gap: co-rotational elements or their limit, the elastica.
///
/// Both models use the pose of the left scale as their frame. The state of a gap consists of its
/// own unknowns and of the displacement and rotation of the right scale,
///
/// ```text
/// z = (interior, uₓ, u_y, φ)                                                    (M23)
/// ```
///
/// with the interior of (M13) for elements, the poses of the nodes between the scales, and of (M22)
/// for the elastica.
#[derive(Clone, Debug, PartialEq)]
pub enum Membrane {
    /// Co-rotational elements.
    Elements(GapMembrane),
    /// Spectral element of the extensible elastica.
    Elastica(Elastica),
}

impl Membrane {
    /// Returns the number of the gap's own unknowns, the first of its state.
    pub fn interior(&self) -> usize {
        match self {
            Self::Elements(gap) => 3 * (gap.elements() - 1),
            Self::Elastica(gap) => gap.interior(),
        }
    }

    /// Returns the number of leading unknowns that vanish without a force in the gap.
    ///
    /// The functions of a state accept one without them.
    pub fn vanishing(&self) -> usize {
        match self {
            // Nodes between elements rotate with the membrane, with or without force.
            Self::Elements(_) => 0,
            Self::Elastica(gap) => gap.order() - 1,
        }
    }

    /// Returns the reference sizes of the entries of the gradient.
    ///
    /// They are in the order of the state.
    pub fn units(&self) -> DVector<f64> {
        match self {
            Self::Elements(gap) => gap.units(),
            Self::Elastica(gap) => gap.units(),
        }
    }

    /// Computes the derivatives of the potential of the gap with respect to its state `z`.
    pub fn derivatives(&self, z: &[f64]) -> Derivatives {
        match self {
            Self::Elements(gap) => {
                // The left scale is the frame: its three coordinates are not part of the state.
                let GapResponse { force, tangent, .. } = gap.response(&from_left(z));
                Derivatives {
                    gradient: force.rows(3, z.len()).into_owned(),
                    hessian: tangent.view((3, 3), (z.len(), z.len())).into_owned(),
                }
            }
            Self::Elastica(gap) => gap.derivatives(z),
        }
    }

    /// Computes the energies at a state `z` that satisfies the gap's own equations.
    pub fn energies(&self, z: &[f64]) -> GapEnergies {
        match self {
            Self::Elements(gap) => gap.energies(&from_left(z)),
            Self::Elastica(gap) => gap.energies(z),
        }
    }

    /// Computes the largest strain `|ε| + ½ h |κ|` at the surface of the membrane.
    pub fn largest_strain(&self, z: &[f64]) -> f64 {
        match self {
            Self::Elements(gap) => gap.largest_strain(&from_left(z)),
            Self::Elastica(gap) => gap.largest_strain(z),
        }
    }

    /// Computes the deformed axis from base to base.
    ///
    /// It is relative to the node of the left scale. It has `intervals` intervals per element, or
    /// in the whole gap for an elastica.
    pub fn axis(&self, z: &[f64], intervals: usize) -> Vec<Vec2> {
        match self {
            Self::Elements(gap) => gap.axis(&from_left(z), intervals),
            Self::Elastica(gap) => gap.axis(z, intervals),
        }
    }

    /// Transfers the state `z` to a membrane of another resolution.
    ///
    /// `None` unless both are elasticas, which can be interpolated.
    pub fn transferred(&self, z: &[f64], to: &Self) -> Option<Vec<f64>> {
        match (self, to) {
            (Self::Elastica(ours), Self::Elastica(theirs)) => Some(ours.transferred(z, theirs)),
            _ => None,
        }
    }
}

/// Extends a state by the left scale at rest, as elements need it.
fn from_left(z: &[f64]) -> DVector<f64> {
    let mut state = DVector::zeros(z.len() + 3);
    state.rows_mut(3, z.len()).copy_from_slice(z);
    state
}

//! Common interface of both models of the membrane in a gap: elements and elastica.

use geometry::Vec2;
use nalgebra::DVector;

use crate::{Derivatives, Elastica, GapEnergies, GapMembrane, GapResponse};

/// Membrane in one gap: co-rotational elements or their limit, the elastica.
///
/// Both models use the pose of the left scale as reference frame. The state of a gap consists of
/// interior unknowns and the displacement and rotation `(uₓ, u_y, φ)` of the right scale:
///
/// ```text
/// z = (interior, uₓ, u_y, φ)                                                    (M23)
/// ```
///
/// The interior unknowns are the displacements and rotations of the nodes between the scales (M13)
/// for elements, and `ψ` and `f` (M22) for the elastica.
#[derive(Clone, Debug, PartialEq)]
pub enum Membrane {
    /// Co-rotational elements.
    Elements(GapMembrane),
    /// Spectral element of the extensible elastica.
    Elastica(Elastica),
}

impl Membrane {
    /// Returns the number of interior unknowns, the first entries of the state.
    pub fn interior(&self) -> usize {
        match self {
            Self::Elements(gap) => 3 * (gap.elements() - 1),
            Self::Elastica(gap) => gap.interior(),
        }
    }

    /// Returns the number of leading unknowns that are zero if no force acts in the gap.
    ///
    /// All functions with an argument `z` also accept a state without these unknowns.
    pub fn vanishing(&self) -> usize {
        match self {
            // Nodes between elements rotate also in pure bending, without a force.
            Self::Elements(_) => 0,
            Self::Elastica(gap) => gap.order() - 1,
        }
    }

    /// Returns a reference size for each entry of the gradient, for tolerances on residuals.
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
                // The left scale is the reference frame, so its three coordinates are not part of
                // the state.
                let GapResponse { force, tangent, .. } = gap.response(&from_left(z));
                Derivatives {
                    gradient: force.rows(3, z.len()).into_owned(),
                    hessian: tangent.view((3, 3), (z.len(), z.len())).into_owned(),
                }
            }
            Self::Elastica(gap) => gap.derivatives(z),
        }
    }

    /// Computes the energies at a state `z` in which the interior unknowns are in equilibrium.
    pub fn energies(&self, z: &[f64]) -> GapEnergies {
        match self {
            Self::Elements(gap) => gap.energies(&from_left(z)),
            Self::Elastica(gap) => gap.energies(z),
        }
    }

    /// Returns the largest strain `|ε| + ½ h |κ|` at the surface of the membrane.
    pub fn largest_strain(&self, z: &[f64]) -> f64 {
        match self {
            Self::Elements(gap) => gap.largest_strain(&from_left(z)),
            Self::Elastica(gap) => gap.largest_strain(z),
        }
    }

    /// Returns points of the deformed axis from the left to the right base.
    ///
    /// The points divide each element, or the whole gap of an elastica, into `intervals` intervals.
    /// Positions are relative to the node of the left scale.
    pub fn axis(&self, z: &[f64], intervals: usize) -> Vec<Vec2> {
        match self {
            Self::Elements(gap) => gap.axis(&from_left(z), intervals),
            Self::Elastica(gap) => gap.axis(z, intervals),
        }
    }

    /// Converts the state `z` to the membrane `to` of another order.
    ///
    /// `None` if one of the membranes consists of elements, for which no interpolation exists.
    pub fn transferred(&self, z: &[f64], to: &Self) -> Option<Vec<f64>> {
        match (self, to) {
            (Self::Elastica(ours), Self::Elastica(theirs)) => Some(ours.transferred(z, theirs)),
            _ => None,
        }
    }
}

/// Prepends the zero displacement of the left scale to a state, as elements require.
fn from_left(z: &[f64]) -> DVector<f64> {
    let mut state = DVector::zeros(z.len() + 3);
    state.rows_mut(3, z.len()).copy_from_slice(z);
    state
}

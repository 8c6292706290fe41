//! Either model of the membrane in a gap, behind one interface.

use geometry::Vec2;
use nalgebra::DVector;

use crate::{Derivatives, Elastica, GapEnergies, GapMembrane, GapResponse};

/// The membrane in one gap: co-rotational elements, or the extensible elastica that is their limit.
///
/// Both are seen from the left scale, whose pose is the frame. The state of a gap consists of its own unknowns and of the
/// displacement and rotation of the right scale,
///
/// ```text
/// z = (interior, uₓ, u_y, φ)                                                    (M23)
/// ```
///
/// where the interior is that of (M13) for elements, the poses of the nodes between the scales, and that of (M22) for the
/// elastica.
#[derive(Clone, Debug, PartialEq)]
pub enum Membrane {
    /// Co-rotational elements.
    Elements(GapMembrane),
    /// A spectral element for the extensible elastica.
    Elastica(Elastica),
}

impl Membrane {
    /// Returns the number of unknowns that belong to the gap itself, the first of its state.
    pub fn interior(&self) -> usize {
        match self {
            Self::Elements(gap) => 3 * (gap.elements() - 1),
            Self::Elastica(gap) => gap.interior(),
        }
    }

    /// Returns the number of leading unknowns that vanish while no force goes through the gap. The functions of a state
    /// accept one without them.
    pub fn vanishing(&self) -> usize {
        match self {
            // Nodes between elements turn with the membrane, force or not.
            Self::Elements(_) => 0,
            Self::Elastica(gap) => gap.order() - 1,
        }
    }

    /// Returns the sizes that the entries of the gradient are to be compared with, in the order of the state.
    pub fn units(&self) -> DVector<f64> {
        match self {
            Self::Elements(gap) => gap.units(),
            Self::Elastica(gap) => gap.units(),
        }
    }

    /// Returns the derivatives of the potential of the gap with respect to its state `z`.
    pub fn derivatives(&self, z: &[f64]) -> Derivatives {
        match self {
            Self::Elements(gap) => {
                // The left scale is the frame: its three coordinates are no entries of the state.
                let GapResponse { force, tangent, .. } = gap.response(&from_left(z));
                Derivatives {
                    gradient: force.rows(3, z.len()).into_owned(),
                    hessian: tangent.view((3, 3), (z.len(), z.len())).into_owned(),
                }
            }
            Self::Elastica(gap) => gap.derivatives(z),
        }
    }

    /// Returns the energies at a state `z` that satisfies the equations of the gap's own unknowns.
    pub fn energies(&self, z: &[f64]) -> GapEnergies {
        match self {
            Self::Elements(gap) => gap.energies(&from_left(z)),
            Self::Elastica(gap) => gap.energies(z),
        }
    }

    /// Returns the largest strain `|ε| + ½ h |κ|` at the surface of the membrane in the state `z`.
    pub fn largest_strain(&self, z: &[f64]) -> f64 {
        match self {
            Self::Elements(gap) => gap.largest_strain(&from_left(z)),
            Self::Elastica(gap) => gap.largest_strain(z),
        }
    }

    /// Returns the deformed axis, from base to base, measured from the node of the left scale: `intervals` of each
    /// element, or of the whole gap.
    pub fn axis(&self, z: &[f64], intervals: usize) -> Vec<Vec2> {
        match self {
            Self::Elements(gap) => gap.axis(&from_left(z), intervals),
            Self::Elastica(gap) => gap.axis(z, intervals),
        }
    }

    /// Returns the state `z` as it is seen by a membrane of another resolution; `None` unless both are elasticas, whose direction
    /// can be interpolated.
    pub fn transferred(&self, z: &[f64], to: &Self) -> Option<Vec<f64>> {
        match (self, to) {
            (Self::Elastica(ours), Self::Elastica(theirs)) => Some(ours.transferred(z, theirs)),
            _ => None,
        }
    }
}

/// Returns the state of elements whose left scale is at rest.
fn from_left(z: &[f64]) -> DVector<f64> {
    let mut state = DVector::zeros(z.len() + 3);
    state.rows_mut(3, z.len()).copy_from_slice(z);
    state
}

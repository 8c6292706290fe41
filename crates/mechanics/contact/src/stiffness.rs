//! Symmetric stiffness of a contact of two corners.

use crate::corner_contact::{CornerContact, FORCES, Force};
use crate::corners::Corners;
use crate::gap::Gap;
use crate::law::ContactLaw;
use crate::response::{COORDINATES, ROTATIONS, Secant, Together};

/// Symmetric tangent of a contact in the coordinates of its pair and the components of its force.
///
/// ```text
/// [[A, B], [Bᵀ, −C]]      stiffness  A + B C⁻¹ Bᵀ                                     (C8)
/// ```
///
/// The force components are `λ` on an edge, and `λ` and `λ''` for a flush contact. In the state
/// corner on corner they are the components of `f` along fixed axes. With `λ` and `λ'` the tangent
/// would not be symmetric, because their directions rotate with the scales. `C` is positive
/// semidefinite, and zero for a rigid contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactStiffness {
    /// Matrix `A`, in the coordinates of the pair.
    pub by_coordinate: [[f64; COORDINATES]; COORDINATES],
    /// Columns of the matrix `B`, one for each force component.
    pub by_force: Vec<[f64; COORDINATES]>,
    /// Matrix `C`; with one force component only its first entry is used.
    pub compliance: [[f64; 2]; 2],
}

impl CornerContact {
    /// Returns true if the state corner on corner lies on a ridge of the energy.
    ///
    /// On a ridge the equilibrium (C5) is unstable. The partner's force has a component towards the
    /// end of the edge of the own contact, so the corner lies short of this end and could also
    /// slide back along the edge, which decreases the energy.
    pub fn is_on_ridge(self, corners: &Corners) -> bool {
        match self {
            Self::Corner(edge) => {
                let together = Together::new(corners, corners.together(edge));
                together.overrun(together.normals[1]) > 0.0
            }
            _ => false,
        }
    }

    /// Computes the stiffness of the contact at the given `forces`.
    pub fn stiffness(
        self,
        corners: &Corners,
        law: &ContactLaw,
        forces: [f64; FORCES],
    ) -> ContactStiffness {
        let [own, partner, flush] = forces;
        let mut stiffness = ContactStiffness::default();
        match self {
            Self::Open => {}
            Self::Edge(edge) => stiffness.add_gap(&corners.gap(edge), own),
            Self::Flush(edge) => {
                stiffness.add_gap(&corners.gap(edge), own);
                if let Some(beside) = edge.flush() {
                    stiffness.add_gap(&corners.gap(beside), flush);
                }
            }
            Self::Corner(edge) => {
                let together = Together::new(corners, corners.together(edge));
                return together.stiffness(law, [own, partner]);
            }
        }
        let sum = forces[Force::Own as usize] + forces[Force::Flush as usize];
        // `λ` and `λ''` share one approach, a function of their sum, so all entries are equal.
        stiffness.compliance = [[law.approach(sum).slope; 2]; 2];
        stiffness
    }
}

impl ContactStiffness {
    /// Adds a contact force in the direction of a gap, with a new force component.
    fn add_gap(&mut self, gap: &Gap, force: f64) {
        self.by_force.push(gap.gradient.map(|slope| -slope));
        for (row, hessian) in self.by_coordinate.iter_mut().zip(gap.curvature.hessian()) {
            for (entry, hessian) in row.iter_mut().zip(hessian) {
                *entry -= force * hessian;
            }
        }
    }
}

impl Together {
    /// Computes the stiffness of corner on corner under the forces `λ` and `λ'`.
    fn stiffness(&self, law: &ContactLaw, forces: [f64; 2]) -> ContactStiffness {
        let f = forces[0] * self.normals[0] + forces[1] * self.normals[1];
        let mut stiffness = ContactStiffness::default();
        // A rotation of a scale also rotates the direction in which a further rotation moves its
        // corner.
        let [left, right] = ROTATIONS;
        stiffness.by_coordinate[left][left] = f.dot(&self.arms[0]);
        stiffness.by_coordinate[right][right] = -f.dot(&self.arms[1]);
        let moved: [_; COORDINATES] = std::array::from_fn(|i| -self.apart_slope(i));
        stiffness.by_force = vec![moved.map(|moved| moved.x), moved.map(|moved| moved.y)];
        let Secant { compliance, growth } = Secant::new(law, f);
        let product = growth * f * f.transpose();
        for (i, row) in stiffness.compliance.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = product[(i, j)] + if i == j { compliance } else { 0.0 };
            }
        }
        stiffness
    }
}

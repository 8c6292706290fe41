//! The stiffness of a contact of two corners, symmetric as its energy makes it.

use crate::corner_contact::{CornerContact, FORCES, Force};
use crate::corners::Corners;
use crate::gap::Gap;
use crate::law::ContactLaw;
use crate::response::{COORDINATES, ROTATIONS, Secant, Together};

/// The tangent of a contact in the coordinates of its pair and the components of its force, of which there are one or two:
///
/// ```text
/// [[A, B], [Bᵀ, −C]]      stiffness  A + B C⁻¹ Bᵀ                                     (C8)
/// ```
///
/// On an edge the component is `λ`, flush they are `λ` and `λ''`, and with corner on corner those of `f` along the axes: their directions do
/// not turn with the scales, as those of `λ` and `λ'` do. `C` is not negative, and vanishes where a contact is rigid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactStiffness {
    /// `A`, by the coordinates of the pair.
    pub by_coordinate: [[f64; COORDINATES]; COORDINATES],
    /// The columns of `B`.
    pub by_force: Vec<[f64; COORDINATES]>,
    /// `C`; of one component its first entry.
    pub compliance: [[f64; 2]; 2],
}

impl CornerContact {
    /// Whether two corners that are together stand on a ridge of the energy: where the partner's force turns the force towards the end of
    /// the edge, the corner does so short of that end, where it could slide back along the edge as well. The contact holds the
    /// corners together (C5), but on a ridge the energy falls to either side.
    pub fn is_on_ridge(self, corners: &Corners) -> bool {
        match self {
            Self::Corner(edge) => {
                let together = Together::new(corners, corners.together(edge));
                together.overrun(together.normals[1]) > 0.0
            }
            _ => false,
        }
    }

    /// The stiffness of the contact with the values that the three `forces` have.
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
        // Flush forces share one approach, that of their sum, so that all entries are the same.
        stiffness.compliance = [[law.approach(sum).slope; 2]; 2];
        stiffness
    }
}

impl ContactStiffness {
    /// Adds a force that acts along a gap.
    fn add_gap(&mut self, gap: &Gap, force: f64) {
        self.by_force.push(gap.gradient.map(|slope| -slope));
        for (row, hessian) in self.by_coordinate.iter_mut().zip(gap.hessian) {
            for (entry, hessian) in row.iter_mut().zip(hessian) {
                *entry -= force * hessian;
            }
        }
    }
}

impl Together {
    fn stiffness(&self, law: &ContactLaw, forces: [f64; 2]) -> ContactStiffness {
        let f = forces[0] * self.normals[0] + forces[1] * self.normals[1];
        let mut stiffness = ContactStiffness::default();
        // Turning an arm turns the direction in which its corner moves.
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

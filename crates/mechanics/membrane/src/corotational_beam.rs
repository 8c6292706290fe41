//! Co-rotational Euler–Bernoulli beam element.

use geometry::{OutOfRange, Vec2};
use nalgebra::{SMatrix, SVector};

use crate::section::positive;

/// Poses `q = (x₁ y₁ φ₁ x₂ y₂ φ₂)` of the two ends of an element, or forces and moments on them.
pub type Ends = SVector<f64, 6>;

/// Matrix of second derivatives of an energy with respect to [`Ends`].
pub type Stiffness = SMatrix<f64, 6, 6>;

/// Two-node Euler–Bernoulli beam: small strains, arbitrarily large rotations.
///
/// ```text
///          φ₁ ⟋                      L   length at rest
///           ⟋ θ₁                     l   length of the chord
///        1 ○───────────○ 2   chord   β   angle of the chord from the x axis
///                     θ₂ ⟍           φᵢ  direction of the axis at end i, from the x axis
///                       φ₂ ⟍         θᵢ  direction of the axis at end i, from the chord
/// ```
///
/// Deformations are measured in the frame of the chord, which moves with the element:
///
/// ```text
/// d = x₂ − x₁,   l = |d|,   e = d/l = (cos β, sin β),   n = (−sin β, cos β)      (M2)
/// u = l − L,     θᵢ = φᵢ − β = atan2(e × tᵢ, e · tᵢ),   tᵢ = (cos φᵢ, sin φᵢ)    (M3)
/// ```
///
/// `atan2` returns the angle between the chord and the axis. Full turns in `φᵢ` and the branch of
/// `β` therefore have no effect; the only restriction is `|θᵢ| < π`. In the frame of the chord the
/// beam is linear, with a cubic deflection and a uniform axial strain:
///
/// ```text
/// N  = EA u/L,   M₁ = EI (4θ₁ + 2θ₂)/L,   M₂ = EI (2θ₁ + 4θ₂)/L                 (M4)
/// Wₐ = EA u²/2L,   W_b = 2 EI (θ₁² + θ₁θ₂ + θ₂²)/L                              (M5)
/// ```
///
/// With `r = (−e, 0, e, 0)`, `z = (−n, 0, n, 0)` and the unit vectors `i₃`, `i₆` of the rotations,
///
/// ```text
/// ∂l = r,   ∂β = z/l,   ∂r = z zᵀ/l,   ∂(z/l) = −(r zᵀ + z rᵀ)/l²               (M6)
/// ```
///
/// so that, with `b₁ = ∂θ₁ = i₃ − z/l` and `b₂ = ∂θ₂ = i₆ − z/l`, the force and the tangent are
///
/// ```text
/// f = ∂W  = N r + M₁ b₁ + M₂ b₂                                                 (M7)
/// K = ∂²W = EA/L r rᵀ + EI/L (4 b₁b₁ᵀ + 2 b₁b₂ᵀ + 2 b₂b₁ᵀ + 4 b₂b₂ᵀ)
///           + N z zᵀ/l + (M₁ + M₂)(r zᵀ + z rᵀ)/l²                              (M8)
/// ```
///
/// `K` derives from an energy, so it is symmetric also outside equilibrium. The error relative to
/// the elastica is of second order in the element length. In pure bending, moments and rotations
/// are exact, and the nodes are the corners of a polygon with sides of length `L`.
///
/// Sources: M. A. Crisfield, *Comput. Methods Appl. Mech. Eng.* 81 (1990) 131,
/// doi 10.1016/0045-7825(90)90106-V, and *Non-linear Finite Element Analysis of Solids and
/// Structures*, vol. 1, Wiley (1991), ch. 7; L. L. Yaw, *2D Corotational Beam Formulation*, Walla
/// Walla University (2009).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CorotationalBeam {
    length: f64,
    axial_stiffness: f64,
    bending_stiffness: f64,
}

/// Deformations and forces of an element in the frame of its chord.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Local {
    /// Length `l` of the chord.
    pub chord_length: f64,
    /// Unit vector `e` along the chord, from end 1 to end 2.
    pub chord: Vec2,
    /// Rotations `θ₁, θ₂` of the ends relative to the chord, from −π to π.
    pub rotations: [f64; 2],
    /// Axial force `N`, positive in tension.
    pub axial_force: f64,
    /// Moments `M₁, M₂` on the ends, counter-clockwise; pure bending has `M₁ = −M₂`.
    pub moments: [f64; 2],
}

/// Energies of an element and their derivatives with respect to the poses of its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Stretching energy `Wₐ`.
    pub axial_energy: f64,
    /// Bending energy `W_b`.
    pub bending_energy: f64,
    /// Internal force `f = ∂(Wₐ + W_b)`, equal to the applied force at equilibrium.
    pub force: Ends,
    /// Consistent tangent `K = ∂f`, symmetric.
    pub tangent: Stiffness,
}

impl CorotationalBeam {
    /// Creates an element with length `L` at rest, axial stiffness `EA` and bending stiffness `EI`.
    ///
    /// # Errors
    /// If the length or a stiffness is not positive and finite.
    pub fn new(
        length: f64,
        axial_stiffness: f64,
        bending_stiffness: f64,
    ) -> Result<Self, OutOfRange> {
        Ok(Self {
            length: positive("length of an element", length)?,
            axial_stiffness: positive("axial stiffness", axial_stiffness)?,
            bending_stiffness: positive("bending stiffness", bending_stiffness)?,
        })
    }

    /// Returns the length `L` at rest.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the deformations and forces in the frame of the chord (M2 to M4) at the poses `q`.
    pub fn local(&self, q: &Ends) -> Local {
        let d = Vec2::new(q[3] - q[0], q[4] - q[1]);
        let chord_length = d.norm();
        let chord = d / chord_length;
        let rotations = [angle_from(chord, q[2]), angle_from(chord, q[5])];
        let [theta1, theta2] = rotations;
        let bending = self.bending_stiffness / self.length;
        Local {
            chord_length,
            chord,
            rotations,
            axial_force: self.axial_stiffness * (chord_length - self.length) / self.length,
            moments: [
                bending * (4.0 * theta1 + 2.0 * theta2),
                bending * (2.0 * theta1 + 4.0 * theta2),
            ],
        }
    }

    /// Returns energies, force and tangent (M5 to M8) at the poses `q` of the ends.
    ///
    /// If the two ends coincide, the chord has no direction and the response is not finite.
    pub fn response(&self, q: &Ends) -> Response {
        let local = self.local(q);
        let Local { chord_length: l, rotations: [theta1, theta2], axial_force, moments, .. } =
            local;
        let gradients = Gradients::new(&local);
        Response {
            axial_energy: 0.5 * axial_force * (l - self.length),
            bending_energy: 0.5 * (moments[0] * theta1 + moments[1] * theta2),
            force: gradients.force(&local),
            tangent: self.material_stiffness(&gradients) + gradients.geometric_stiffness(&local),
        }
    }

    /// Returns the point of the deformed axis at `ξ`, from 0 at end 1 to 1 at end 2:
    ///
    /// ```text
    /// x(ξ) = x₁ + l ξ e + l [θ₁ ξ (1−ξ)² − θ₂ ξ² (1−ξ)] n                       (M9)
    /// ```
    pub fn axis_point(&self, q: &Ends, xi: f64) -> Vec2 {
        let Local { chord_length, chord, rotations: [theta1, theta2], .. } = self.local(q);
        let deflection = theta1 * xi * (1.0 - xi).powi(2) - theta2 * xi.powi(2) * (1.0 - xi);
        Vec2::new(q[0], q[1]) + chord_length * (xi * chord + deflection * quarter_turn(chord))
    }

    /// Returns the material stiffness, the first line of (M8).
    fn material_stiffness(&self, gradients: &Gradients) -> Stiffness {
        let Gradients { r, b1, b2, .. } = gradients;
        let axial = self.axial_stiffness / self.length;
        let bending = self.bending_stiffness / self.length;
        axial * r * r.transpose()
            + bending * (4.0 * b1 + 2.0 * b2) * b1.transpose()
            + bending * (2.0 * b1 + 4.0 * b2) * b2.transpose()
    }
}

/// Vectors `r`, `z`, `b₁` and `b₂` of (M6) to (M8), built from gradients of the deformations.
struct Gradients {
    r: Ends,
    z: Ends,
    b1: Ends,
    b2: Ends,
}

impl Gradients {
    fn new(local: &Local) -> Self {
        let (e, n) = (local.chord, quarter_turn(local.chord));
        let z = Ends::new(-n.x, -n.y, 0.0, n.x, n.y, 0.0);
        let mut b1 = -z / local.chord_length;
        let mut b2 = b1;
        b1[2] = 1.0;
        b2[5] = 1.0;
        Self { r: Ends::new(-e.x, -e.y, 0.0, e.x, e.y, 0.0), z, b1, b2 }
    }

    /// Returns the internal force (M7).
    fn force(&self, local: &Local) -> Ends {
        let [m1, m2] = local.moments;
        local.axial_force * self.r + m1 * self.b1 + m2 * self.b2
    }

    /// Returns the geometric stiffness, the second line of (M8).
    fn geometric_stiffness(&self, local: &Local) -> Stiffness {
        let Self { r, z, .. } = self;
        let l = local.chord_length;
        let shear = (local.moments[0] + local.moments[1]) / l;
        let rz = r * z.transpose();
        local.axial_force / l * z * z.transpose() + shear / l * (rz + rz.transpose())
    }
}

/// Returns the angle from the unit vector `e` to the direction `phi` (M3), from −π to π.
fn angle_from(e: Vec2, phi: f64) -> f64 {
    let (sin, cos) = phi.sin_cos();
    (e.x * sin - e.y * cos).atan2(e.x * cos + e.y * sin)
}

/// Returns the vector `v` rotated counter-clockwise by 90°.
pub(crate) fn quarter_turn(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

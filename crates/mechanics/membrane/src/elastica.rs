//! Membrane of a gap as an extensible elastica.

use std::sync::Arc;

use geometry::{OutOfRange, Vec2};
use nalgebra::{DMatrix, DVector, DVectorView};

use crate::corotational_beam::quarter_turn;
use crate::gap::check;
use crate::lobatto::Lobatto;
use crate::{RigidArm, Section, Span};

/// Membrane of a gap: one spectral element of the extensible elastica.
///
/// Between two rigid bases the membrane carries no load, so one force `F` acts in the whole gap.
/// With the arc length `S` at rest, the direction `θ(S)` of the axis, `t = (cos θ, sin θ)` and its
/// quarter turn `n`, the membrane is a beam without shear and without deformation of its section:
///
/// ```text
/// r' = (1 + ε) t,   N = F·t = EA ε,   M = EI θ',   EI θ" = −(1 + ε) F·n         (M18)
/// ```
///
/// This is the limit of co-rotational elements of vanishing length. With the force in units of the
/// axial stiffness, `F = EA f`, and the vector `Δ` from the end at the left base to the end at the
/// right base, the equations make stationary
///
/// ```text
/// Π(θ, f) = ∫ ½ EI θ'² dS − EA ∫ (f·t + ½ (f·t)²) dS + EA f·Δ                   (M19)
/// ```
///
/// and its stationary value is the energy `∫ ½ (EI θ'² + EA ε²) dS`. The direction is a polynomial
/// through the Gauss–Lobatto–Legendre points of the gap, which also serve for integration. To order
/// `n`,
///
/// ```text
/// θᵢ = φ ξᵢ + ψᵢ,   ψ₀ = ψₙ = 0,   εᵢ = f·tᵢ                                    (M20)
/// Π = EI/2d (φ² + Σᵢⱼ ψᵢ Kᵢⱼ ψⱼ) − EA d Σᵢ wᵢ (εᵢ + ½ εᵢ²) + EA f·Δ             (M21)
/// ```
///
/// so pure bending, `ψ = 0` and `f = 0`, is exact. The error decreases faster than any power of
/// `1/n` once the points resolve the boundary layers of length `√(EI/(N (1+ε)))` at the bases, that
/// is from about `n² ≈ d/length`.
///
/// The state of a gap of order `n` has [`Self::unknowns`] entries, in the frame of the left scale:
///
/// ```text
/// z = (ψ₁ … ψₙ₋₁, f₁, f₂, uₓ, u_y, φ)                                           (M22)
/// ```
///
/// with the displacement and the rotation `(uₓ, u_y, φ)` of the right scale. The unknowns `ψ` and
/// `f` belong to the gap, with the equations `∂Π/∂ψ = 0` and `∂Π/∂f = 0`; eliminating them leaves
/// the force of the membrane on its right scale. Because `f` is a multiplier, two eigenvalues of
/// the tangent are negative at every stable equilibrium.
///
/// If no force acts in the gap, `f = 0` and `ψ = 0`. The functions of a state therefore also accept
/// a state without `ψ`, its last five entries alone, with five rows of gradient and Hessian. This
/// is cheap while scales do not touch.
///
/// Sources: E. Reissner, *Z. Angew. Math. Phys.* 23 (1972) 795, doi 10.1007/BF01602645 (without
/// shear); S. S. Antman, *Nonlinear Problems of Elasticity*, 2nd ed., Springer (2005), ch. 4, doi
/// 10.1007/0-387-27649-1.
#[derive(Clone, Debug, PartialEq)]
pub struct Elastica {
    section: Section,
    span: Span,
    rule: Arc<Lobatto>,
}

/// Energies of the membrane in a gap, over `E_m t³`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapEnergies {
    /// Stretching energy `∫ ½ EA ε² dS`.
    pub axial: f64,
    /// Bending energy `∫ ½ EI θ'² dS`.
    pub bending: f64,
}

/// Derivatives of the potential of a gap with respect to its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// First derivatives, in the order of the state.
    pub gradient: DVector<f64>,
    /// Second derivatives, symmetric.
    pub hessian: DMatrix<f64>,
}

/// Valid orders for [`Elastica::new`].
///
/// A polynomial of order 1 cannot bend. An order above 128 is taken for a mistake.
const ORDERS: std::ops::RangeInclusive<usize> = 2..=128;

impl Elastica {
    /// Creates the membrane of a section over a span.
    ///
    /// Its direction is a polynomial of degree `order`.
    ///
    /// # Errors
    /// If the gap is not positive and finite, the half-base negative, the offset not finite, or the
    /// order outside 2 … 128.
    pub fn new(section: Section, span: Span, order: usize) -> Result<Self, OutOfRange> {
        check(&span)?;
        let accepted = ORDERS.contains(&order);
        OutOfRange::unless(accepted, "order of the membrane", order as f64, "2 to 128")?;
        Ok(Self { section, span, rule: Lobatto::shared(order) })
    }

    /// Creates a membrane of the same section and order over another span.
    ///
    /// # Errors
    /// If the gap is not positive and finite, the half-base negative, or the offset not finite.
    pub fn over(&self, span: Span) -> Result<Self, OutOfRange> {
        check(&span)?;
        // The quadrature rule depends only on the order, so both membranes share it.
        Ok(Self { span, ..self.clone() })
    }

    /// Returns the order `n`.
    pub fn order(&self) -> usize {
        self.rule.order()
    }

    /// Returns the number of unknowns `ψ` and `f` of the gap.
    ///
    /// They are the first `n + 1` of the state.
    pub fn interior(&self) -> usize {
        self.order() + 1
    }

    /// Returns the number of entries `n + 4` of the state (M22).
    pub fn unknowns(&self) -> usize {
        self.interior() + 3
    }

    /// Returns the distance `2a + d` between the nodes of the scales at rest.
    pub fn pitch(&self) -> f64 {
        2.0 * self.span.half_base + self.span.gap
    }

    /// Returns the reference sizes of the entries of the gradient.
    ///
    /// They are in the order of the state.
    pub fn units(&self) -> DVector<f64> {
        let [axial, bending] = self.stiffness();
        let mut units = DVector::from_element(self.unknowns(), bending);
        let f = self.order() - 1;
        // Closure equations are scaled by the length of the gap, force equations, as for beam
        // elements, by the force of a displacement `t`.
        units.rows_mut(f, 2).fill(axial * self.span.gap);
        units.rows_mut(f + 2, 2).fill(axial / self.span.gap);
        units
    }

    /// Computes the derivatives of the potential (M21) at a state.
    ///
    /// The gradient holds the residuals of the gap's own unknowns, then the force `(Fₓ, F_y)` (over
    /// `E_m t²`) and the moment about its node (over `E_m t³`) required to hold the right scale.
    ///
    /// # Panics
    /// If the state `z` has neither [`Self::unknowns`] nor five entries.
    pub fn derivatives(&self, z: &[f64]) -> Derivatives {
        let ElasticaState { psi, force, phi, .. } = ElasticaState::new(z);
        let ([axial, bending], f) = (self.stiffness(), z.len() - 5);
        let (lever, stiffness) = (self.lever(phi), self.rule.stiffness.view((1, 1), (f, f)));
        let mut gradient = DVector::zeros(z.len());
        gradient.rows_mut(0, f).gemv(bending, &stiffness, &psi, 0.0);
        let mut hessian = DMatrix::zeros(z.len(), z.len());
        hessian.view_mut((0, 0), (f, f)).zip_apply(&stiffness, |entry, k| *entry = bending * k);
        let mut moment = bending * phi + axial * force.dot(&quarter_turn(lever));
        let mut turning = bending - axial * force.dot(&lever);
        let (mut closure, mut coupling) = (self.base_to_base(z), axial * quarter_turn(lever));
        for (i, section) in self.sections(z) {
            let (weight, xi) = (self.weight(i), self.rule.points[i]);
            let Direction { along, across, strain, shear } = section;
            let torque = -weight * (1.0 + strain) * shear;
            let stiffness = -weight * (shear * shear - (1.0 + strain) * strain);
            let mixed = -weight * ((1.0 + strain) * across + shear * along);
            moment += xi * torque;
            turning += xi * xi * stiffness;
            closure -= weight / axial * (1.0 + strain) * along;
            coupling += xi * mixed;
            let mut stretching = hessian.fixed_view_mut::<2, 2>(f, f);
            stretching -= weight * (along * along.transpose());
            // The directions at both ends are given by the bases and are not unknowns.
            if (1..=f).contains(&i) {
                gradient[i - 1] += torque;
                hessian[(i - 1, i - 1)] += stiffness;
                set(&mut hessian, [i - 1, f + 4], xi * stiffness);
                set(&mut hessian, [i - 1, f], mixed.x);
                set(&mut hessian, [i - 1, f + 1], mixed.y);
            }
        }
        let [closure, right] = [axial * closure, axial * force];
        gradient.rows_mut(f, 5).copy_from_slice(&[closure.x, closure.y, right.x, right.y, moment]);
        hessian[(f + 4, f + 4)] = turning;
        for axis in 0..2 {
            set(&mut hessian, [f + axis, f + 2 + axis], axial);
            set(&mut hessian, [f + axis, f + 4], coupling[axis]);
        }
        Derivatives { gradient, hessian }
    }

    /// Computes the energies at a state that satisfies the gap's own equations.
    ///
    /// # Panics
    /// If the state `z` has neither [`Self::unknowns`] nor five entries.
    pub fn energies(&self, z: &[f64]) -> GapEnergies {
        let [_, bending] = self.stiffness();
        let curvatures = self.curvatures(z);
        let density =
            |(i, section): (usize, Direction)| 0.5 * self.weight(i) * section.strain.powi(2);
        // The rule is exact for this integral: the square of `θ'` is of degree `2n − 2` (M15).
        let bending = curvatures.component_mul(&curvatures).dot(&self.rule.weights)
            * (0.5 * bending * self.span.gap.powi(2));
        GapEnergies { axial: self.sections(z).map(density).sum(), bending }
    }

    /// Computes the largest strain `|ε| + ½ h |θ'|` at the surface of the membrane.
    ///
    /// The maximum is over the points of the gap.
    ///
    /// # Panics
    /// If the state `z` has neither [`Self::unknowns`] nor five entries.
    pub fn largest_strain(&self, z: &[f64]) -> f64 {
        let curvatures = self.curvatures(z);
        let half = 0.5 * self.section.thickness();
        let sections = self.sections(z);
        sections.fold(0.0, |max, (i, section)| {
            max.max(section.strain.abs() + half * curvatures[i].abs())
        })
    }

    /// Computes the deformed axis from base to base, in `intervals ≥ 1` intervals.
    ///
    /// Positions are relative to the node of the left scale.
    ///
    /// # Panics
    /// If the state `z` has neither [`Self::unknowns`] nor five entries.
    pub fn axis(&self, z: &[f64], intervals: usize) -> Vec<Vec2> {
        let angles = self.angles(z);
        let force = ElasticaState::new(z).force;
        let width = 1.0 / intervals as f64;
        let mut axis = vec![self.arms()[0].lever(0.0)];
        for k in 0..intervals {
            // The cosine of a polynomial is not a polynomial, so each interval uses the whole rule.
            let points = self.rule.points.iter().zip(&self.rule.weights).map(|(xi, weight)| {
                let angle = self.rule.interpolate(&angles, (k as f64 + xi) * width);
                let section = Direction::new(angle, force);
                *weight * width * ((1.0 + section.strain) * section.along)
            });
            axis.push(axis[k] + self.span.gap * points.sum::<Vec2>());
        }
        axis
    }

    /// Transfers the state `z` to another order by interpolating its direction.
    ///
    /// # Panics
    /// If the state `z` has neither [`Self::unknowns`] nor five entries.
    pub fn transferred(&self, z: &[f64], to: &Self) -> Vec<f64> {
        let deviations = self.angles(z) - ElasticaState::new(z).phi * &self.rule.points;
        let points = to.rule.points.iter().skip(1).take(to.order() - 1);
        let psi = points.map(|&xi| self.rule.interpolate(&deviations, xi));
        psi.chain(z[z.len() - 5..].iter().copied()).collect()
    }

    /// Returns `EA` and `EI/d`.
    fn stiffness(&self) -> [f64; 2] {
        [self.section.axial_stiffness(), self.section.bending_stiffness() / self.span.gap]
    }

    /// Returns `EA d wᵢ`.
    fn weight(&self, i: usize) -> f64 {
        self.section.axial_stiffness() * self.span.gap * self.rule.weights[i]
    }

    /// Returns the arms from the nodes of the scales to the ends of the membrane.
    fn arms(&self) -> [RigidArm; 2] {
        let Span { half_base, axis_offset, .. } = self.span;
        [half_base, -half_base].map(|x| RigidArm::new(Vec2::new(x, -axis_offset)))
    }

    /// Returns the vector from the node of the right scale to the end of the membrane.
    fn lever(&self, phi: f64) -> Vec2 {
        self.arms()[1].lever(phi)
    }

    /// Computes `Δ`.
    fn base_to_base(&self, z: &[f64]) -> Vec2 {
        let ElasticaState { displacement, phi, .. } = ElasticaState::new(z);
        let node = Vec2::new(self.pitch(), 0.0) + displacement;
        node + self.lever(phi) - self.arms()[0].lever(0.0)
    }

    /// Computes the directions `θᵢ` at the points (M20).
    fn angles(&self, z: &[f64]) -> DVector<f64> {
        let ElasticaState { psi, phi, .. } = ElasticaState::new(z);
        let mut angles = phi * &self.rule.points;
        let mut inner = angles.rows_mut(1, psi.len());
        inner += psi;
        angles
    }

    /// Computes the curvatures `θ'` at the points.
    fn curvatures(&self, z: &[f64]) -> DVector<f64> {
        &self.rule.derivative * self.angles(z) / self.span.gap
    }

    /// Iterates over the sections at the points, in order.
    fn sections<'a>(&'a self, z: &'a [f64]) -> impl Iterator<Item = (usize, Direction)> + 'a {
        let ElasticaState { psi, force, phi, .. } = ElasticaState::new(z);
        (0..=self.order()).map(move |i| {
            // A state without `ψ` is pure bending, to an arc.
            let deviation = if (1..=psi.len()).contains(&i) { psi[i - 1] } else { 0.0 };
            (i, Direction::new(phi * self.rule.points[i] + deviation, force))
        })
    }
}

/// Components of a state (M22).
struct ElasticaState<'a> {
    psi: DVectorView<'a, f64>,
    force: Vec2,
    displacement: Vec2,
    phi: f64,
}

impl<'a> ElasticaState<'a> {
    fn new(z: &'a [f64]) -> Self {
        let (psi, rest) = z.split_at(z.len() - 5);
        Self {
            psi: DVectorView::from_slice(psi, psi.len()),
            force: Vec2::new(rest[0], rest[1]),
            displacement: Vec2::new(rest[2], rest[3]),
            phi: rest[4],
        }
    }
}

/// Cross-section of the membrane under a force `f`.
struct Direction {
    /// `t`.
    along: Vec2,
    /// `n`.
    across: Vec2,
    /// `ε = f·t`.
    strain: f64,
    /// `f·n`.
    shear: f64,
}

impl Direction {
    fn new(angle: f64, force: Vec2) -> Self {
        let (sin, cos) = angle.sin_cos();
        let (along, across) = (Vec2::new(cos, sin), Vec2::new(-sin, cos));
        Self { along, across, strain: force.dot(&along), shear: force.dot(&across) }
    }
}

/// Sets an entry and its mirror image in a symmetric matrix.
fn set(matrix: &mut DMatrix<f64>, [row, column]: [usize; 2], value: f64) {
    matrix[(row, column)] = value;
    matrix[(column, row)] = value;
}

//! Model of the membrane in a gap as an extensible elastica.

use std::sync::Arc;

use geometry::{OutOfRange, Vec2};
use nalgebra::{DMatrix, DVector, DVectorView, Matrix2};

use crate::corotational_beam::quarter_turn;
use crate::gap::check;
use crate::lobatto::Lobatto;
use crate::{RigidArm, Section, Span};

/// Membrane in a gap, modelled by one spectral element of the extensible elastica.
///
/// No load acts on the membrane between two rigid bases, so the internal force `F` is constant
/// within the gap. `S` is the arc length at rest, `θ(S)` the direction of the axis,
/// `t = (cos θ, sin θ)` its unit vector, and `n` is `t` rotated by 90° counter-clockwise. The
/// membrane is a beam without shear deformation:
///
/// ```text
/// r' = (1 + ε) t,   N = F·t = EA ε,   M = EI θ',   EI θ" = −(1 + ε) F·n         (M18)
/// ```
///
/// Co-rotational elements converge to this model as their length decreases. With `F = EA f` and the
/// vector `Δ` from the left to the right end of the membrane, equilibria are the stationary points
/// of
///
/// ```text
/// Π(θ, f) = ∫ ½ EI θ'² dS − EA ∫ (f·t + ½ (f·t)²) dS + EA f·Δ                   (M19)
/// ```
///
/// The value of `Π` at an equilibrium is the energy `∫ ½ (EI θ'² + EA ε²) dS`. The direction `θ` is
/// a polynomial of degree `n`, given by its values at the Gauss–Lobatto–Legendre points `ξᵢ` of the
/// gap. These points and their weights `wᵢ` are also used for integration:
///
/// ```text
/// θᵢ = φ ξᵢ + ψᵢ,   ψ₀ = ψₙ = 0,   εᵢ = f·tᵢ                                    (M20)
/// Π = EI/2d (φ² + Σᵢⱼ ψᵢ Kᵢⱼ ψⱼ) − EA d Σᵢ wᵢ (εᵢ + ½ εᵢ²) + EA f·Δ             (M21)
/// ```
///
/// Pure bending (`ψ = 0`, `f = 0`) is therefore exact. The error decreases faster than any power of
/// `1/n` once the points resolve the boundary layers of length `b = √(EI/(N (1+ε)))` at the bases,
/// from about `n² = d/b` on.
///
/// The state of a gap of order `n` has [`Self::unknowns`] entries, in the frame of the left scale:
///
/// ```text
/// z = (ψ₁ … ψₙ₋₁, f₁, f₂, uₓ, u_y, φ)                                           (M22)
/// ```
///
/// with the displacement and the rotation `(uₓ, u_y, φ)` of the right scale. The interior unknowns
/// `ψ` and `f` are determined by `∂Π/∂ψ = 0` and `∂Π/∂f = 0`. The derivatives of `Π` with respect
/// to `(uₓ, u_y, φ)` are the force and the moment that hold the right scale. Because `f` is a
/// Lagrange multiplier, two eigenvalues of the tangent are negative at every stable equilibrium.
///
/// If no force acts in the gap, `f = 0` and `ψ = 0`. All functions with an argument `z` therefore
/// also accept a short state, the last five entries of (M22) without `ψ`; gradient and Hessian then
/// have five rows. This reduces the cost while scales do not touch.
///
/// Sources: E. Reissner, *Z. Angew. Math. Phys.* 23 (1972) 795, doi 10.1007/BF01602645 (with shear
/// deformation); S. S. Antman, *Nonlinear Problems of Elasticity*, 2nd ed., Springer (2005), ch. 4,
/// doi 10.1007/0-387-27649-1.
#[derive(Clone, Debug, PartialEq)]
pub struct Elastica {
    section: Section,
    span: Span,
    rule: Arc<Lobatto>,
}

/// Energies of the membrane in a gap, in units of `E_m t³`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapEnergies {
    /// Stretching energy `∫ ½ EA ε² dS`.
    pub axial: f64,
    /// Bending energy `∫ ½ EI θ'² dS`.
    pub bending: f64,
}

/// First and second derivatives of the potential of a gap with respect to its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// First derivatives, in the order of the entries of the state.
    pub gradient: DVector<f64>,
    /// Symmetric matrix of second derivatives.
    pub hessian: DMatrix<f64>,
}

/// Valid orders for [`Elastica::new`].
///
/// With order 1 the direction is linear, so the membrane could only bend to an arc. An order above
/// 128 is refused as a probable mistake.
const ORDERS: std::ops::RangeInclusive<usize> = 2..=128;

impl Elastica {
    /// Creates a membrane with the cross-section `section` in the gap `span`.
    ///
    /// The direction of the axis is a polynomial of degree `order`.
    ///
    /// # Errors
    /// If the gap is not positive and finite, the half-base is negative, the offset is not finite,
    /// or the order is outside 2 … 128.
    pub fn new(section: Section, span: Span, order: usize) -> Result<Self, OutOfRange> {
        check(&span)?;
        let accepted = ORDERS.contains(&order);
        OutOfRange::unless(accepted, "order of the membrane", order as f64, "2 to 128")?;
        Ok(Self { section, span, rule: Lobatto::shared(order) })
    }

    /// Creates a membrane in another gap with the section and the order of `self`.
    ///
    /// # Errors
    /// If the gap is not positive and finite, the half-base is negative, or the offset is not
    /// finite.
    pub fn over(&self, span: Span) -> Result<Self, OutOfRange> {
        check(&span)?;
        // The quadrature rule depends only on the order, so both membranes share it.
        Ok(Self { span, ..self.clone() })
    }

    /// Returns the order `n`, the degree of the polynomial for the direction.
    pub fn order(&self) -> usize {
        self.rule.order()
    }

    /// Returns the number `n + 1` of interior unknowns `ψ` and `f`, the first entries of a state.
    pub fn interior(&self) -> usize {
        self.order() + 1
    }

    /// Returns the number `n + 4` of entries of a state (M22).
    pub fn unknowns(&self) -> usize {
        self.interior() + 3
    }

    /// Returns the distance `2a + d` between the nodes of the two scales at rest, in units of `t`.
    pub fn pitch(&self) -> f64 {
        2.0 * self.span.half_base + self.span.gap
    }

    /// Returns a reference size for each entry of the gradient, for tolerances on residuals.
    pub fn units(&self) -> DVector<f64> {
        let [axial, bending] = self.stiffness();
        let mut units = DVector::from_element(self.unknowns(), bending);
        let f = self.order() - 1;
        // The derivatives with respect to `f` are displacements times `EA`, with the gap `d` as
        // their reference. Forces are compared with the axial force of a displacement by 1, as for
        // beam elements.
        units.rows_mut(f, 2).fill(axial * self.span.gap);
        units.rows_mut(f + 2, 2).fill(axial / self.span.gap);
        units
    }

    /// Computes the derivatives of the potential (M21) at the state `z`.
    ///
    /// The gradient consists of the residuals of the equations for `ψ` and `f`, followed by the
    /// force `(Fₓ, F_y)` (in units of `E_m t²`) and the moment about the node (in units of
    /// `E_m t³`) that hold the right scale.
    ///
    /// # Panics
    /// If the state `z` has neither [`Self::unknowns`] nor five entries.
    pub fn derivatives(&self, z: &[f64]) -> Derivatives {
        let ElasticaState { psi, force, phi, .. } = ElasticaState::new(z);
        let ([axial, bending], f) = (self.stiffness(), z.len() - 5);
        let (size, lever) = (z.len(), self.lever(phi));
        let mut gradient = DVector::zeros(size);
        let mut hessian = DMatrix::zeros(size, size);
        let (interior, others) = hessian.as_mut_slice().split_at_mut(size * f);
        self.add_bending(&psi, gradient.as_mut_slice(), interior);
        let mut stretching = Matrix2::zeros();
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
            stretching -= weight * (along * along.transpose());
            // The bases prescribe the directions at both ends, so these have no unknown `ψ`.
            if let Some(row) = i.checked_sub(1).filter(|&row| row < f) {
                let column = &mut interior[size * row..][..size];
                gradient[row] += torque;
                column[row] += stiffness;
                for (k, value) in [(0, mixed.x), (1, mixed.y), (4, xi * stiffness)] {
                    column[f + k] = value;
                    others[size * k + row] = value;
                }
            }
        }
        hessian.fixed_view_mut::<2, 2>(f, f).copy_from(&stretching);
        let [closure, right] = [axial * closure, axial * force];
        gradient.rows_mut(f, 5).copy_from_slice(&[closure.x, closure.y, right.x, right.y, moment]);
        hessian[(f + 4, f + 4)] = turning;
        for axis in 0..2 {
            set(&mut hessian, [f + axis, f + 2 + axis], axial);
            set(&mut hessian, [f + axis, f + 4], coupling[axis]);
        }
        Derivatives { gradient, hessian }
    }

    /// Adds the terms of `Σᵢⱼ ψᵢ Kᵢⱼ ψⱼ` in (M21) to the gradient and the columns of `ψ`.
    ///
    /// `columns` contains the columns of the Hessian one after another.
    fn add_bending(&self, psi: &DVectorView<f64>, gradient: &mut [f64], columns: &mut [f64]) {
        let ([_, bending], f) = (self.stiffness(), psi.len());
        let stiffness = self.rule.stiffness.as_slice().chunks_exact(self.order() + 1).skip(1);
        let columns = columns.chunks_exact_mut(gradient.len());
        for ((column, stiffness), psi) in columns.zip(stiffness).zip(psi) {
            let entries = column[..f].iter_mut().zip(&stiffness[1..]);
            for ((entry, stiffness), gradient) in entries.zip(&mut gradient[..]) {
                *entry = bending * stiffness;
                *gradient += *entry * psi;
            }
        }
    }

    /// Computes the energies at a state `z` that satisfies the equations for `ψ` and `f`.
    ///
    /// # Panics
    /// If the state `z` has neither [`Self::unknowns`] nor five entries.
    pub fn energies(&self, z: &[f64]) -> GapEnergies {
        let [_, bending] = self.stiffness();
        let curvatures = self.curvatures(z);
        let density =
            |(i, section): (usize, Direction)| 0.5 * self.weight(i) * section.strain.powi(2);
        // The rule is exact for this integral, because `θ'²` is a polynomial of degree `2n − 2`
        // (M15).
        let bending = curvatures.component_mul(&curvatures).dot(&self.rule.weights)
            * (0.5 * bending * self.span.gap.powi(2));
        GapEnergies { axial: self.sections(z).map(density).sum(), bending }
    }

    /// Returns the largest strain `|ε| + ½ h |θ'|` at the surface of the membrane.
    ///
    /// Evaluates only the Gauss–Lobatto–Legendre points.
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

    /// Returns `intervals + 1` points of the deformed axis from the left to the right base.
    ///
    /// Positions are relative to the node of the left scale. `intervals` is at least 1.
    ///
    /// # Panics
    /// If the state `z` has neither [`Self::unknowns`] nor five entries.
    pub fn axis(&self, z: &[f64], intervals: usize) -> Vec<Vec2> {
        let angles = self.angles(z);
        let force = ElasticaState::new(z).force;
        let width = 1.0 / intervals as f64;
        let mut axis = vec![self.arms()[0].lever(0.0)];
        for k in 0..intervals {
            // `t(θ)` is not a polynomial, so each interval is integrated with all points of the
            // rule.
            let points = self.rule.points.iter().zip(&self.rule.weights).map(|(xi, weight)| {
                let angle = self.rule.interpolate(&angles, (k as f64 + xi) * width);
                let section = Direction::new(angle, force);
                *weight * width * ((1.0 + section.strain) * section.along)
            });
            axis.push(axis[k] + self.span.gap * points.sum::<Vec2>());
        }
        axis
    }

    /// Converts the state `z` to the order of the membrane `to` by interpolating the direction.
    ///
    /// # Panics
    /// If the state `z` has neither [`Self::unknowns`] nor five entries.
    pub fn transferred(&self, z: &[f64], to: &Self) -> Vec<f64> {
        let deviations = self.angles(z) - ElasticaState::new(z).phi * &self.rule.points;
        let points = to.rule.points.iter().skip(1).take(to.order() - 1);
        let psi = points.map(|&xi| self.rule.interpolate(&deviations, xi));
        psi.chain(z[z.len() - 5..].iter().copied()).collect()
    }

    /// Returns the axial stiffness `EA` and the rotational stiffness `EI/d` of the gap.
    fn stiffness(&self) -> [f64; 2] {
        [self.section.axial_stiffness(), self.section.bending_stiffness() / self.span.gap]
    }

    /// Returns `EA d wᵢ`, the weight of point `i` in the axial energy.
    fn weight(&self, i: usize) -> f64 {
        self.section.axial_stiffness() * self.span.gap * self.rule.weights[i]
    }

    /// Returns the arms from the nodes of the scales to the ends of the membrane.
    fn arms(&self) -> [RigidArm; 2] {
        let Span { half_base, axis_offset, .. } = self.span;
        [half_base, -half_base].map(|x| RigidArm::new(Vec2::new(x, -axis_offset)))
    }

    /// Returns the vector from the node of the right scale to the right end of the membrane.
    ///
    /// `phi` is the rotation of the right scale.
    fn lever(&self, phi: f64) -> Vec2 {
        self.arms()[1].lever(phi)
    }

    /// Computes the vector `Δ` from the left to the right end of the membrane.
    fn base_to_base(&self, z: &[f64]) -> Vec2 {
        let ElasticaState { displacement, phi, .. } = ElasticaState::new(z);
        let node = Vec2::new(self.pitch(), 0.0) + displacement;
        node + self.lever(phi) - self.arms()[0].lever(0.0)
    }

    /// Computes the directions `θᵢ` at all points (M20).
    fn angles(&self, z: &[f64]) -> DVector<f64> {
        let ElasticaState { psi, phi, .. } = ElasticaState::new(z);
        let mut angles = phi * &self.rule.points;
        let mut inner = angles.rows_mut(1, psi.len());
        inner += psi;
        angles
    }

    /// Computes the curvatures `θ'` at all points.
    fn curvatures(&self, z: &[f64]) -> DVector<f64> {
        &self.rule.derivative * self.angles(z) / self.span.gap
    }

    /// Iterates over the points in order, with the index and the [`Direction`] at each point.
    fn sections<'a>(&'a self, z: &'a [f64]) -> impl Iterator<Item = (usize, Direction)> + 'a {
        let ElasticaState { psi, force, phi, .. } = ElasticaState::new(z);
        (0..=self.order()).map(move |i| {
            // A state without `ψ` is an arc, as in pure bending.
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

/// Direction of the membrane axis at a point, and components of the force `f` at this point.
struct Direction {
    /// Unit vector `t` along the axis.
    along: Vec2,
    /// Unit vector `n` normal to the axis.
    across: Vec2,
    /// Axial strain `ε = f·t`.
    strain: f64,
    /// Component `f·n` of the force normal to the axis.
    shear: f64,
}

impl Direction {
    fn new(angle: f64, force: Vec2) -> Self {
        let (sin, cos) = angle.sin_cos();
        let (along, across) = (Vec2::new(cos, sin), Vec2::new(-sin, cos));
        Self { along, across, strain: force.dot(&along), shear: force.dot(&across) }
    }
}

/// Sets the entries `(row, column)` and `(column, row)` of a symmetric matrix.
fn set(matrix: &mut DMatrix<f64>, [row, column]: [usize; 2], value: f64) {
    matrix[(row, column)] = value;
    matrix[(column, row)] = value;
}

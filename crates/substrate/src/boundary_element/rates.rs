//! How fast the reactions change with the footprint.

use std::ops::{AddAssign, Mul};

use faer::Mat;

use super::{Equations, Factors, RowReactions, Tractions, Unresolved};
use crate::Footprint;
use crate::mesh::Mesh;

/// A direction in which a footprint changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootprintChange {
    /// Rate of `d/a`.
    pub gap_over_a: f64,
    /// Rate of `b/a`.
    pub width_over_a: f64,
    /// Rate of `ν`.
    pub poisson_ratio: f64,
}

/// A step of a difference of the mesh, as a part of what changes.
const STEP: f64 = 1e-5;

/// Weights of a derivative by values at a distance: from both sides, or from one alone.
const CENTRAL: [(f64, f64); 2] = [(-1.0, -0.5), (1.0, 0.5)];
const FORWARD: [(f64, f64); 3] = [(0.0, -1.5), (1.0, 2.0), (2.0, -0.5)];

/// Lengths that are equal to this part change places within a difference of the mesh.
const TIED: f64 = 3.0 * STEP;

/// Returns the reactions of [`row_reactions`](super::row_reactions) and their rates where the footprint changes in each of the
/// `changes`. With the tractions `p` of (S5),
///
/// ```text
/// dp = G⁻¹ (du − dG p)                                                               (S14)
/// ```
///
/// on the factors of the tractions themselves. The differentials of matrix, displacements and sums are differences of explicit
/// functions of the mesh. Where two of the lengths that grade the mesh are equal the rate is that of the side to which the change
/// leads.
///
/// # Errors
/// As [`reactions`](super::reactions).
pub fn row_reactions_and_rates(
    footprint: &Footprint,
    neighbours: usize,
    n: usize,
    changes: &[FootprintChange],
) -> Result<(RowReactions, Vec<RowReactions>), Unresolved> {
    let mesh = Mesh::row(footprint, neighbours, n);
    let unresolved = Unresolved { footprint: *footprint, cells: n };
    if !mesh.is_resolved() {
        return Err(unresolved);
    }
    let factors = Equations::assemble(&mesh, footprint.poisson_ratio()).factorised();
    let tractions = factors.solve(mesh.displacements());
    let solved = Solved { footprint, mesh, n, factors, tractions };
    let reactions = solved.mesh.sums(footprint, &solved.tractions);
    let rates: Vec<_> = changes.iter().map(|change| solved.rate(change)).collect();
    let finite = [&reactions].into_iter().chain(&rates).all(RowReactions::is_finite);
    if finite { Ok((reactions, rates)) } else { Err(unresolved) }
}

/// A row whose tractions are known.
struct Solved<'a> {
    footprint: &'a Footprint,
    mesh: Mesh,
    n: usize,
    factors: Factors,
    tractions: Tractions,
}

impl Solved<'_> {
    fn rate(&self, change: &FootprintChange) -> RowReactions {
        let mut rate = self.mesh.sums(self.footprint, &self.tractions) * 0.0;
        let mut right = self.mesh.displacements().map(|zero| zero * 0.0);
        if change.poisson_ratio != 0.0 {
            right.shear += -change.poisson_ratio * self.change_with_poisson_ratio();
        }
        let Stencil { weights, step } = Stencil::of(self.footprint, change);
        for &(place, weight) in weights {
            let Some(footprint) = self.footprint.moved(change, place * step) else { continue };
            let mesh = Mesh::row(&footprint, self.mesh.neighbours.len(), self.n);
            rate += mesh.sums(&footprint, &self.tractions) * (weight / step);
            let equations = Equations::assemble(&mesh, self.footprint.poisson_ratio());
            equations.add_defects(&self.tractions, mesh.displacements(), weight / step, &mut right);
        }
        rate += self.mesh.sums(self.footprint, &self.factors.solve(right));
        rate
    }

    /// `∂G/∂ν p` of the shear problem, whose matrix is linear in `1/(1 − ν)`.
    fn change_with_poisson_ratio(&self) -> Mat<f64> {
        let Equations { shear, normal, .. } = Equations::assemble(&self.mesh, 0.5);
        let rate = (1.0 - self.footprint.poisson_ratio()).powi(-2);
        rate * ((shear - normal) * &self.tractions.shear)
    }
}

impl Equations {
    /// Adds `weight` times `u − G p` of the three problems.
    fn add_defects(
        &self,
        tractions: &Tractions,
        displacements: Tractions,
        weight: f64,
        into: &mut Tractions,
    ) {
        into.shear += weight * (displacements.shear - &self.shear * &tractions.shear);
        into.normal += weight * (displacements.normal - &self.normal * &tractions.normal);
        into.rotation += weight * (displacements.rotation - &self.rotation * &tractions.rotation);
    }
}

/// How a derivative with respect to the mesh is taken.
struct Stencil {
    weights: &'static [(f64, f64)],
    step: f64,
}

impl Stencil {
    fn of(footprint: &Footprint, change: &FootprintChange) -> Self {
        let relative = (change.gap_over_a / footprint.gap_over_a()).abs();
        let relative = relative.max((change.width_over_a / footprint.width_over_a()).abs());
        let weights: &[_] = match relative {
            0.0 => &[],
            _ if footprint.is_tied() => &FORWARD,
            _ => &CENTRAL,
        };
        Self { weights, step: STEP / relative }
    }
}

impl Footprint {
    /// Whether lengths that grade the mesh are equal: where one takes the place of another as the smaller, the numerical
    /// reactions have a kink.
    pub fn is_tied(&self) -> bool {
        let [gap, width] = [self.gap_over_a(), self.width_over_a()];
        let tied = |a: f64, b: f64| (a - b).abs() <= TIED * a;
        tied(width, 2.0) || tied(gap, width.min(2.0))
    }

    /// The footprint with other lengths, as far as there is one.
    fn moved(&self, change: &FootprintChange, distance: f64) -> Option<Self> {
        let gap = self.gap_over_a() + distance * change.gap_over_a;
        let width = self.width_over_a() + distance * change.width_over_a;
        Self::new(gap, width, self.poisson_ratio()).ok()
    }
}

impl RowReactions {
    /// Changes every number.
    fn update(&mut self, mut f: impl FnMut(&mut f64)) {
        let numbers = self.direct.iter_mut().chain(self.neighbours.iter_mut().flatten());
        let cross = self.cross.iter_mut().flat_map(|terms| [&mut terms.force, &mut terms.moment]);
        numbers.chain(cross).for_each(|number| f(number));
    }

    /// Every number.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let numbers = self.direct.iter().chain(self.neighbours.iter().flatten());
        let cross = self.cross.iter().flat_map(|terms| [&terms.force, &terms.moment]);
        numbers.chain(cross).copied()
    }
}

impl Mul<f64> for RowReactions {
    type Output = Self;

    fn mul(mut self, factor: f64) -> Self {
        self.update(|number| *number *= factor);
        self
    }
}

impl AddAssign for RowReactions {
    fn add_assign(&mut self, other: Self) {
        let mut numbers = other.numbers();
        self.update(|number| *number += numbers.next().unwrap_or_default());
    }
}

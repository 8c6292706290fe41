//! How fast the reactions change with the footprint.

use std::ops::{AddAssign, Mul};

use super::moving::{self, Motion};
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
/// on the factors of the tractions themselves. That of the matrix is exact in the motion of the mesh; the motion, displacements and sums are
/// differences of explicit functions. Where two of the lengths that grade the mesh are equal the rate is that of the side to which the change
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
    let rates = solved.rates(changes);
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
    /// The rates of the reactions for each change.
    fn rates(&self, changes: &[FootprintChange]) -> Vec<RowReactions> {
        let mut rates: Vec<_> = changes.iter().map(|change| self.imposed_rates(change)).collect();
        let motions: Vec<_> =
            rates.iter_mut().map(|rates| std::mem::take(&mut rates.motion)).collect();
        let products = moving::products(&self.mesh, self.footprint, &motions, &self.tractions);
        let of_change = |(rates, product): (ImposedRates, Tractions)| {
            let ImposedRates { mut sums, displacements, .. } = rates;
            let right = Tractions {
                shear: displacements.shear - product.shear,
                normal: displacements.normal - product.normal,
                rotation: displacements.rotation - product.rotation,
            };
            sums += self.mesh.sums(self.footprint, &self.factors.solve(right));
            sums
        };
        rates.into_iter().zip(products).map(of_change).collect()
    }

    /// The rates of what is imposed: differences of explicit functions of the mesh.
    fn imposed_rates(&self, change: &FootprintChange) -> ImposedRates {
        let mut sums = self.mesh.sums(self.footprint, &self.tractions) * 0.0;
        let mut displacements = self.mesh.displacements().map(|zero| zero * 0.0);
        let mut motion = Motion::of(&self.mesh, change.poisson_ratio);
        let Stencil { weights, step } = Stencil::of(self.footprint, change);
        for &(place, weight) in weights {
            let Some(footprint) = self.footprint.moved(change, place * step) else { continue };
            let (mesh, weight) =
                (Mesh::row(&footprint, self.mesh.neighbours.len(), self.n), weight / step);
            sums += mesh.sums(&footprint, &self.tractions) * weight;
            let there = mesh.displacements();
            displacements.shear += weight * there.shear;
            displacements.normal += weight * there.normal;
            displacements.rotation += weight * there.rotation;
            motion.add(&mesh, weight);
        }
        ImposedRates { sums, displacements, motion }
    }
}

/// The rates of what a footprint imposes on given tractions.
struct ImposedRates {
    sums: RowReactions,
    displacements: Tractions,
    motion: Motion,
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
    fn update(&mut self, f: impl FnMut(&mut f64)) {
        let numbers = self.direct.iter_mut().chain(self.neighbours.iter_mut().flatten());
        let cross = self.cross.iter_mut().flat_map(|terms| [&mut terms.force, &mut terms.moment]);
        numbers.chain(cross).for_each(f);
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

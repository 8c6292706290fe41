//! How fast the reactions change with the footprint.

use std::ops::{AddAssign, Mul};

use super::moving::{self, Motion, SeenLines};
use super::{Equations, Factors, RowReactions, Tractions, Unresolved};
use crate::Footprint;
use crate::mesh::{Mesh, MeshChange, MeshMotion};

/// A direction in which a footprint, or what grades its mesh, changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FootprintChange {
    /// Rates of the lengths.
    pub mesh: MeshChange,
    /// Rate of `ν`.
    pub poisson_ratio: f64,
}

/// A step of a difference of what a footprint imposes, as a part of what changes.
const STEP: f64 = 1e-5;

/// Returns the reactions of [`row_reactions`](super::row_reactions) and their rates where the footprint changes in each of the
/// `changes`. With the tractions `p` of (S5),
///
/// ```text
/// dp = G⁻¹ (du − dG p)                                                               (S14)
/// ```
///
/// on the factors of the tractions themselves. That of the matrix is exact in the motion of the mesh, and so is the motion; displacements and sums
/// are differences of explicit functions. The moments of displaced neighbours, which only a coupling beyond Eq. (1) has, have rates if `moments` says so.
///
/// # Errors
/// As [`reactions`](super::reactions).
pub fn row_reactions_and_rates(
    footprint: &Footprint,
    (neighbours, moments): (usize, bool),
    n: usize,
    changes: &[FootprintChange],
) -> Result<(RowReactions, Vec<RowReactions>), Unresolved> {
    let mesh = Mesh::row(footprint, neighbours, n);
    let unresolved = Unresolved { footprint: *footprint, cells: n };
    if !mesh.is_resolved() {
        return Err(unresolved);
    }
    let mut seen = SeenLines::of(&mesh);
    let equations = Equations::assemble(&mesh, footprint.poisson_ratio(), Some(&mut seen));
    let factors = equations.factorised();
    let tractions = factors.solve(mesh.displacements());
    let reactions = mesh.sums(footprint, &tractions);
    let tractions = if moments { tractions } else { tractions.without_moments() };
    let rates = Solved { footprint, mesh, factors, tractions, seen }.rates(changes);
    let finite = [&reactions].into_iter().chain(&rates).all(RowReactions::is_finite);
    if finite { Ok((reactions, rates)) } else { Err(unresolved) }
}

/// A row whose tractions are known.
struct Solved<'a> {
    footprint: &'a Footprint,
    mesh: Mesh,
    factors: Factors,
    tractions: Tractions,
    seen: SeenLines,
}

impl Solved<'_> {
    /// The rates of the reactions for each change.
    fn rates(&self, changes: &[FootprintChange]) -> Vec<RowReactions> {
        let motion = |change: &FootprintChange| Motion {
            mesh: self.mesh.motion(&change.mesh),
            poisson_ratio: change.poisson_ratio,
        };
        let motions: Vec<_> = changes.iter().map(motion).collect();
        let ratio = self.footprint.poisson_ratio();
        let products = moving::products(&self.mesh, ratio, &motions, &self.tractions, &self.seen);
        let of_change = |(change, (motion, product)): (&FootprintChange, (&Motion, Tractions))| {
            let (mut sums, displacements) = self.imposed_rates(change, &motion.mesh);
            let right = Tractions {
                shear: displacements.shear - product.shear,
                normal: displacements.normal - product.normal,
                rotation: displacements.rotation - product.rotation,
            };
            sums += self.mesh.sums(self.footprint, &self.factors.solve(right));
            sums
        };
        changes.iter().zip(motions.iter().zip(products)).map(of_change).collect()
    }

    /// The rates of the sums of the same tractions and of the imposed displacements: differences of explicit functions of the mesh.
    fn imposed_rates(
        &self,
        change: &FootprintChange,
        motion: &MeshMotion,
    ) -> (RowReactions, Tractions) {
        let mut sums = self.mesh.sums(self.footprint, &self.tractions) * 0.0;
        let mut displacements = self.tractions.zeros();
        let relative = self.footprint.fastest(&change.mesh);
        if relative == 0.0 {
            return (sums, displacements);
        }
        let step = STEP / relative;
        for by in [-step, step] {
            let Some(footprint) = self.footprint.moved(change, by) else { continue };
            let (mesh, weight) = (self.mesh.moved(motion, by), 0.5 / by);
            sums += mesh.sums(&footprint, &self.tractions) * weight;
            let there = mesh.displacements();
            let there = if self.has_moments() { there } else { there.without_moments() };
            displacements.shear += weight * there.shear;
            displacements.normal += weight * there.normal;
            displacements.rotation += weight * there.rotation;
        }
        (sums, displacements)
    }

    fn has_moments(&self) -> bool {
        self.tractions.rotation.ncols() > 1
    }
}

impl Footprint {
    /// The footprint with other lengths, as far as there is one.
    fn moved(&self, change: &FootprintChange, distance: f64) -> Option<Self> {
        let gap = self.gap_over_a() + distance * change.mesh.gap;
        let width = self.width_over_a() + distance * change.mesh.width;
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

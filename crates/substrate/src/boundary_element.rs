//! Reactions of rigid rectangles on an elastic half-space, by collocation.
//!
//! The traction is uniform in each cell `j` and the displacement is met at one point `i` of each,
//!
//! ```text
//! Σ_j G_ij p_j = u_i      (S5)
//! ```
//!
//! with `G` from (S1) for normal and from (S2) for tangential tractions. Both planes of symmetry are
//! used: `z` always (every load is even in it), `x` with the sign of the load (displacements are
//! even, the rotation is odd). So `n × n` cells on a quarter of the middle rectangle and as many on
//! half a neighbour are all the unknowns. The reactions are
//!
//! ```text
//! α_x, α_y = ∬ q, ∬ p,  α_φ = ∬ p (x − x_m)   on the middle rectangle
//! β_x, β_y = −∬ q, −∬ p,  β_φ = −∬ p (x − x_n)   on a neighbour      (S6)
//! ```
//!
//! for `u_x = 1`, `u_y = 1` and `u_y = x − x_m`, with `E* = a = 1`.

use faer::{ColRef, Mat};

mod moving;
mod rates;

pub use rates::{FootprintChange, row_reactions_and_rates};

use crate::Footprint;
use crate::dense_lu::DenseLu;
use crate::half_space::{CornerLine, Influence};
use crate::mesh::{GradedAxis, Mesh};
use moving::SeenLines;

/// A row of rectangles that double precision cannot tell apart.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "no tractions found under rectangles of gap/a = {:e} and width/a = {:e} with {cells} cells a side",
    .footprint.gap_over_a(), .footprint.width_over_a()
)]
pub struct Unresolved {
    /// The footprint of the row.
    pub footprint: Footprint,
    /// Cells a side of the mesh.
    pub cells: usize,
}

/// Reactions on one mesh, for `E* = a = 1`; signs as in Eq. (1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reactions {
    /// The direct reactions `α_x`, `α_y`, `α_φ`.
    pub direct: [f64; 3],
    /// The coupling reactions `β_x`, `β_y`, `β_φ`.
    pub coupling: [f64; 3],
    /// Coupling of the rotation of the middle rectangle and the normal displacement of the right neighbour.
    pub cross: CrossTerms,
}

/// The two cross terms of a pair of rectangles, equal by Betti's theorem as far as the mesh is fine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossTerms {
    /// Normal force on the neighbour from a unit rotation of the middle rectangle.
    pub force: f64,
    /// Moment on the middle rectangle from a unit normal displacement of the neighbour.
    pub moment: f64,
}

impl Reactions {
    /// Returns `α_x, α_y, α_φ, β_x, β_y, β_φ`.
    pub fn coefficients(&self) -> [f64; 6] {
        let ([a, b, c], [d, e, f]) = (self.direct, self.coupling);
        [a, b, c, d, e, f]
    }
}

/// Reactions of a row of rectangles on one mesh, for `E* = a = 1`, when the middle one is displaced by a
/// unit and the others are held.
#[derive(Clone, Debug, PartialEq)]
pub struct RowReactions {
    /// Reactions on the middle rectangle, in the direction of the displacement: `x`, `y`, `φ`.
    pub direct: [f64; 3],
    /// Reactions on the neighbours on the right, the nearest first, in the same directions.
    pub neighbours: Vec<[f64; 3]>,
    /// Coupling of the rotation of the middle rectangle and the normal displacement of each neighbour.
    pub cross: Vec<CrossTerms>,
}

/// Displaces the middle one of three rectangles with its neighbours held, on `n × n` cells a quarter
/// (S5), and returns the reactions (S6).
///
/// Eqs. (2)–(3) of Shafiei et al. (doi 10.1016/j.jmps.2020.104176) treat normal and tangential tractions
/// apart. At `ν = 0.5` that is exact, as neither moves the surface in the other's direction.
/// Elsewhere it neglects their coupling, proportional to `1 − 2ν`, as if the base slid freely in the
/// direction that is not driven.
///
/// # Errors
/// If the gap, or a cell, is lost in rounding.
pub fn reactions(footprint: &Footprint, n: usize) -> Result<Reactions, Unresolved> {
    let found = row_reactions(footprint, 1, n)?;
    let (neighbour, cross) = (found.neighbours[0], found.cross[0]);
    Ok(Reactions { direct: found.direct, coupling: neighbour.map(|force| -force), cross })
}

/// Displaces the middle one of a row with `neighbours ≥ 1` rectangles on each side, with the others held, and returns
/// the reactions on all of them.
///
/// # Errors
/// As [`reactions`].
pub fn row_reactions(
    footprint: &Footprint,
    neighbours: usize,
    n: usize,
) -> Result<RowReactions, Unresolved> {
    let mesh = Mesh::row(footprint, neighbours, n);
    let found = mesh.is_resolved().then(|| mesh.reactions(footprint));
    found.filter(RowReactions::is_finite).ok_or(Unresolved { footprint: *footprint, cells: n })
}

impl RowReactions {
    fn is_finite(&self) -> bool {
        self.numbers().all(f64::is_finite)
    }

    /// Returns `α_x, α_y, α_φ, β_x, β_y, β_φ` of Eq. (1).
    pub(crate) fn coefficients(&self) -> [f64; 6] {
        let ([a, b, c], [d, e, f]) = (self.direct, self.neighbours[0]);
        [a, b, c, -d, -e, -f]
    }
}

/// A displacement of a rectangle, or the arm of its tractions, as a function of `x`.
type Profile = fn(f64) -> f64;

const ONE: Profile = |_| 1.0;
const ZERO: Profile = |_| 0.0;
const ARM: Profile = |x| x;

/// A load case: the displacement of the middle rectangle, and the neighbour that is displaced by 1 besides.
struct Load {
    middle: Profile,
    neighbour: Option<usize>,
}

impl Load {
    /// Returns the displacement of a point of rectangle `body`: 0 is the middle one, 1 its nearest neighbour.
    fn displacement(&self, body: usize, x: f64) -> f64 {
        match body {
            0 => (self.middle)(x),
            _ => f64::from(u8::from(self.neighbour == Some(body - 1))),
        }
    }
}

/// The tractions of the three problems; `rotation` has further columns for displaced neighbours.
struct Tractions {
    shear: Mat<f64>,
    normal: Mat<f64>,
    rotation: Mat<f64>,
}

impl Tractions {
    fn map(self, mut f: impl FnMut(Mat<f64>) -> Mat<f64>) -> Self {
        Self { shear: f(self.shear), normal: f(self.normal), rotation: f(self.rotation) }
    }
}

impl Mesh {
    fn reactions(&self, footprint: &Footprint) -> RowReactions {
        let equations = Equations::assemble(self, footprint.poisson_ratio(), None);
        let factors = equations.factorised();
        self.sums(footprint, &factors.solve(self.displacements()))
    }

    /// Returns the displacements that the loads impose.
    fn displacements(&self) -> Tractions {
        let push = self.imposed(&[Load { middle: ONE, neighbour: None }]);
        // Besides the rotation, a neighbour and its mirror image displaced by 1 and −1: half of it is the
        // odd part of one displaced alone, and the even part leaves no moment on the middle rectangle.
        let turn = Load { middle: ARM, neighbour: None };
        let opposed = (0..self.neighbours.len()).map(|k| Load { middle: ZERO, neighbour: Some(k) });
        let loads: Vec<_> = [turn].into_iter().chain(opposed).collect();
        Tractions { shear: push.clone(), normal: push, rotation: self.imposed(&loads) }
    }

    /// Returns the reactions that tractions add up to; without the columns of displaced neighbours, without their moments.
    fn sums(&self, footprint: &Footprint, tractions: &Tractions) -> RowReactions {
        let count = self.neighbours.len();
        let odd = &tractions.rotation;
        let (shear, normal) = (tractions.shear.col(0), tractions.normal.col(0));
        let rotation = odd.col(0);
        let neighbour = |k: usize| {
            let centre = (k + 1) as f64 * footprint.pitch_over_a();
            [
                self.neighbour_sum(k, shear, ONE),
                self.neighbour_sum(k, normal, ONE),
                self.neighbour_sum(k, rotation, |x| x - centre),
            ]
        };
        let cross = |k: usize| {
            let displaced = odd.col_iter().nth(k + 1);
            let moment = displaced.map_or(0.0, |column| 0.5 * self.middle_sum(column, ARM));
            CrossTerms { force: self.neighbour_sum(k, rotation, ONE), moment }
        };
        RowReactions {
            direct: [
                self.middle_sum(shear, ONE),
                self.middle_sum(normal, ONE),
                self.middle_sum(rotation, ARM),
            ],
            neighbours: (0..count).map(neighbour).collect(),
            cross: (0..count).map(cross).collect(),
        }
    }

    /// Returns the axes along `x`, in the order of the unknowns: column by column, `z` fastest.
    fn across(&self) -> impl Iterator<Item = &GradedAxis> + Clone {
        std::iter::once(&self.middle).chain(&self.neighbours)
    }

    fn unknowns(&self) -> usize {
        self.across().map(GradedAxis::cells).sum::<usize>() * self.depth.cells()
    }

    /// Returns a column for each load: the displacements that it imposes.
    fn imposed(&self, loads: &[Load]) -> Mat<f64> {
        let depth = self.depth.cells();
        let points: Vec<(usize, f64)> = self
            .across()
            .enumerate()
            .flat_map(|(body, axis)| axis.points().iter().map(move |&x| (body, x)))
            .collect();
        Mat::from_fn(self.unknowns(), loads.len(), |i, load| {
            let (body, x) = points[i / depth];
            loads[load].displacement(body, x)
        })
    }

    /// Returns `∬ p arm(x)` over the middle rectangle, four times that over its quarter.
    fn middle_sum(&self, tractions: ColRef<'_, f64>, arm: impl Fn(f64) -> f64) -> f64 {
        4.0 * self.sum(&self.middle, 0, tractions, arm)
    }

    /// Returns `∬ p arm(x)` over the neighbour `k`, from 0, twice that over its half.
    fn neighbour_sum(&self, k: usize, tractions: ColRef<'_, f64>, arm: impl Fn(f64) -> f64) -> f64 {
        let before = self.across().take(k + 1).map(GradedAxis::cells).sum::<usize>();
        2.0 * self.sum(&self.neighbours[k], before * self.depth.cells(), tractions, arm)
    }

    /// Returns `∬ p arm(x)` over the meshed part of a rectangle whose first unknown is `first`.
    fn sum(
        &self,
        axis: &GradedAxis,
        first: usize,
        tractions: ColRef<'_, f64>,
        arm: impl Fn(f64) -> f64,
    ) -> f64 {
        let depth = self.depth.cells();
        let column = |i: usize| -> f64 {
            (0..depth).map(|k| tractions[first + i * depth + k] * self.depth.width(k)).sum()
        };
        (0..axis.cells()).map(|i| column(i) * axis.width(i) * arm(axis.middle(i))).sum()
    }
}

/// The matrices `G` of (S5) for the three loads.
struct Equations {
    shear: Mat<f64>,
    normal: Mat<f64>,
    rotation: Mat<f64>,
}

impl Equations {
    /// Assembles the matrices, and puts what each field point sees behind each other into `seen`.
    fn assemble(mesh: &Mesh, poisson_ratio: f64, mut seen: Option<&mut SeenLines>) -> Self {
        let n = mesh.unknowns();
        let mut equations =
            Self { shear: Mat::zeros(n, n), normal: Mat::zeros(n, n), rotation: Mat::zeros(n, n) };
        let depth = mesh.depth.cells();
        let fields: Vec<f64> = mesh.across().flat_map(GradedAxis::points).copied().collect();
        for (k, &z) in mesh.depth.points().iter().enumerate() {
            let line = CornerLine::new(mesh.depth.mirrored_edges(), z);
            let mut columns = CellColumns::new(line, seen.as_deref_mut());
            let mut sides = [Vec::with_capacity(n), Vec::with_capacity(n)];
            for (i, &x) in fields.iter().enumerate() {
                columns.both_sides(mesh, x, &mut sides);
                equations.fill_row(i * depth + k, &sides, poisson_ratio);
            }
        }
        equations
    }

    /// Sources on the right act with their mirror images on the left, even or odd in `x`.
    fn fill_row(&mut self, row: usize, [right, left]: &[Vec<Influence>; 2], poisson_ratio: f64) {
        for (column, (&right, &left)) in right.iter().zip(left).enumerate() {
            // The edges of a mirror image descend, which turns its sign.
            let even = right - left;
            self.shear[(row, column)] = even.tangential(poisson_ratio);
            self.normal[(row, column)] = even.normal();
            self.rotation[(row, column)] = (right + left).normal();
        }
    }
}

/// Influence of columns of cells at one depth, each cell together with its mirror image in `z`.
struct CellColumns<'s> {
    line: CornerLine,
    last: Vec<Influence>,
    next: Vec<Influence>,
    seen: Option<&'s mut SeenLines>,
}

impl<'s> CellColumns<'s> {
    /// Creates the columns between lines of corners; `line` holds the edges of cells and of their mirror images, an odd number.
    fn new(line: CornerLine, seen: Option<&'s mut SeenLines>) -> Self {
        let blank = vec![Influence::default(); line.len()];
        Self { line, last: blank.clone(), next: blank, seen }
    }

    /// The influence at `x` of the cells on the right and of their mirror images on the left.
    fn both_sides(&mut self, mesh: &Mesh, x: f64, [right, left]: &mut [Vec<Influence>; 2]) {
        right.clear();
        left.clear();
        for axis in mesh.across() {
            self.influence(axis.edges().iter().map(|edge| edge - x), right);
            self.influence(axis.edges().iter().map(|edge| -edge - x), left);
        }
    }

    /// Appends, column by column, the influence of the cells between the `offsets`; negative where
    /// they descend.
    fn influence(&mut self, offsets: impl Iterator<Item = f64>, into: &mut Vec<Influence>) {
        for (column, offset) in offsets.enumerate() {
            std::mem::swap(&mut self.last, &mut self.next);
            self.line.evaluate(offset, &mut self.next);
            if let Some(seen) = &mut self.seen {
                seen.push(self.line.logarithms());
            }
            if column > 0 {
                append_cells(&self.last, &self.next, into);
            }
        }
    }
}

/// Appends the influence of the cells between two lines of corners, each together with its mirror image in `z`.
fn append_cells(last: &[Influence], next: &[Influence], into: &mut Vec<Influence>) {
    let half = last.len() / 2;
    let strip = |j: usize| next[j] - last[j];
    into.extend((0..half).map(|k| {
        let cell = strip(half + k + 1) - strip(half + k);
        let image = strip(half - k) - strip(half - k - 1);
        cell + image
    }));
}

impl Equations {
    fn factorised(self) -> Factors {
        Factors([self.shear, self.normal, self.rotation].map(DenseLu::new))
    }
}

/// LU factors of the three matrices.
struct Factors([DenseLu; 3]);

impl Factors {
    /// Solves the three problems for their right-hand sides.
    fn solve(&self, right: Tractions) -> Tractions {
        let mut factors = self.0.iter();
        right.map(|right| factors.next().map_or(right.clone(), |lu| lu.solve(right)))
    }
}

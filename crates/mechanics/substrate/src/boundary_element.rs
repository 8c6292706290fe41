//! Reactions of rigid rectangles on an elastic half-space, computed by collocation.
//!
//! The traction is uniform in each cell `j`. The displacement is imposed at one point `i` of each
//! cell:
//!
//! ```text
//! Σ_j G_ij p_j = u_i      (S5)
//! ```
//!
//! `G_ij` follows from (S1) for normal and from (S2) for tangential tractions. Both planes of
//! symmetry are used. All loads are even in `z`. In `x`, displacements of the middle rectangle are
//! even and its rotation is odd. The unknowns are therefore the tractions in `n × n` cells on a
//! quarter of the middle rectangle and in `n × n` cells on half of each neighbour. The reactions
//! are
//!
//! ```text
//! α_x, α_y = ∬ q, ∬ p,  α_φ = ∬ p (x − x_m)   on the middle rectangle
//! β_x, β_y = −∬ q, −∬ p,  β_φ = −∬ p (x − x_n)   on a neighbour      (S6)
//! ```
//!
//! for `u_x = 1`, `u_y = 1` and `u_y = x − x_m` under the middle rectangle, with `E* = a = 1`.

use nalgebra::DMatrix;

use crate::Footprint;
use crate::half_space::{CornerLine, Influence};
use crate::mesh::{GradedAxis, Mesh};

/// Error for a row of rectangles with gaps or cells that double precision cannot resolve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "cannot solve for the tractions under rectangles of gap/a = {:e} and width/a = {:e} with \
       {cells} cells a side: use a wider gap",
    .footprint.gap_over_a(), .footprint.width_over_a()
)]
pub struct Unresolved {
    /// Footprint of the row.
    pub footprint: Footprint,
    /// Number of cells along each side of the mesh.
    pub cells: usize,
}

/// The two cross terms between the middle rectangle and a neighbour.
///
/// By Betti's theorem both terms are equal; on a mesh they differ by the discretisation error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossTerms {
    /// Normal force on the neighbour from a unit rotation of the middle rectangle.
    pub force: f64,
    /// Moment on the middle rectangle from a unit normal displacement of the neighbour.
    pub moment: f64,
}

/// Reactions of a row of rectangles on one mesh, for `E* = a = 1`.
///
/// The middle rectangle is displaced by 1 or rotated by 1, and the others are fixed.
#[derive(Clone, Debug, PartialEq)]
pub struct RowReactions {
    /// Reactions on the middle rectangle in the direction of its displacement: `x`, `y`, `φ`.
    pub direct: [f64; 3],
    /// Reactions on the right neighbours, nearest first, in the same directions `x`, `y`, `φ`.
    pub neighbours: Vec<[f64; 3]>,
    /// Coupling of the rotation of the middle rectangle with normal forces on each neighbour.
    pub cross: Vec<CrossTerms>,
}

/// Computes the reactions (S6) of a row of rectangles on one mesh.
///
/// The row has `neighbours ≥ 1` rectangles on each side of the middle rectangle. The middle
/// rectangle is displaced and the others are fixed. Half of each neighbour and a quarter of the
/// middle rectangle have `n × n` cells.
///
/// Normal and tangential tractions are solved separately, as in Eqs. (2) and (3) of Shafiei et al.
/// (doi 10.1016/j.jmps.2020.104176). This is exact at `ν = 0.5`, where normal tractions cause no
/// tangential displacement and vice versa. At other ratios it neglects a coupling proportional to
/// `1 − 2ν`, as if the base slid freely in the direction in which no displacement is imposed.
///
/// # Errors
/// If the gap or a cell vanishes by rounding.
pub fn row_reactions(
    footprint: &Footprint,
    neighbours: usize,
    n: usize,
) -> Result<RowReactions, Unresolved> {
    let reactions = row_reactions_at(footprint, &[footprint.poisson_ratio()], neighbours, n)?;
    reactions.into_iter().next().ok_or(Unresolved { footprint: *footprint, cells: n })
}

/// Computes [`row_reactions`] for several Poisson's ratios at once.
///
/// `poisson_ratios` replace the ratio of the footprint. The matrices for normal displacement and
/// rotation do not depend on the ratio; each ratio only needs its own matrix for shear.
///
/// # Errors
/// If the gap or a cell vanishes by rounding.
pub fn row_reactions_at(
    footprint: &Footprint,
    poisson_ratios: &[f64],
    neighbours: usize,
    n: usize,
) -> Result<Vec<RowReactions>, Unresolved> {
    let mesh = Mesh::row(footprint, neighbours, n);
    // If rounding reduces a cell or a gap to zero width, the solution is meaningless.
    let reactions =
        if mesh.is_resolved() { mesh.reactions(footprint, poisson_ratios) } else { None };
    reactions
        .filter(|rows| rows.iter().flat_map(RowReactions::numbers).all(f64::is_finite))
        .ok_or(Unresolved { footprint: *footprint, cells: n })
}

impl RowReactions {
    /// Returns all reactions as a list.
    ///
    /// The list contains the three reactions of the middle rectangle and then, for each neighbour,
    /// three reactions, the cross force and the cross moment.
    pub fn numbers(&self) -> Vec<f64> {
        let neighbours = self.neighbours.iter().zip(&self.cross);
        let neighbours =
            neighbours.flat_map(|(&[x, y, turn], cross)| [x, y, turn, cross.force, cross.moment]);
        self.direct.into_iter().chain(neighbours).collect()
    }
}

/// Function of `x`: the imposed displacement under a rectangle, or the lever arm of its traction.
pub(crate) type Profile = fn(f64) -> f64;

pub(crate) const ONE: Profile = |_| 1.0;
pub(crate) const ZERO: Profile = |_| 0.0;
pub(crate) const ARM: Profile = |x| x;

/// Load case: imposed displacement of the middle rectangle, or of one neighbour by 1.
pub(crate) struct Load {
    pub(crate) middle: Profile,
    pub(crate) neighbour: Option<usize>,
}

impl Load {
    /// Returns the displacement imposed at `x` under rectangle `body`; 0 is the middle rectangle.
    fn displacement(&self, body: usize, x: f64) -> f64 {
        match body {
            0 => (self.middle)(x),
            _ => f64::from(u8::from(self.neighbour == Some(body - 1))),
        }
    }
}

impl Mesh {
    /// Solves for the reactions at each Poisson's ratio, or returns `None` if a matrix is singular.
    fn reactions(
        &self,
        footprint: &Footprint,
        poisson_ratios: &[f64],
    ) -> Option<Vec<RowReactions>> {
        let equations = Equations::assemble(self, poisson_ratios);
        let push = self.imposed(&[Load { middle: ONE, neighbour: None }]);
        // Displacing one neighbour is the sum of an even and an odd load. The even load causes no
        // moment on the middle rectangle. The odd load displaces the neighbour by ½ and its mirror
        // image by −½. This odd system is solved for 1 and −1, so `sums` halves its moments.
        let turn = Load { middle: ARM, neighbour: None };
        let opposed = (0..self.neighbours.len()).map(|k| Load { middle: ZERO, neighbour: Some(k) });
        let loads: Vec<_> = [turn].into_iter().chain(opposed).collect();
        let normal = equations.normal.lu().solve(&push)?;
        let odd = equations.rotation.lu().solve(&self.imposed(&loads))?;
        let mut reactions = Vec::with_capacity(poisson_ratios.len());
        for matrix in equations.shear {
            let shear = matrix.lu().solve(&push)?;
            reactions.push(self.sums(footprint, shear.as_slice(), normal.as_slice(), &odd));
        }
        Some(reactions)
    }

    /// Integrates the tractions to reactions.
    ///
    /// The first column of `odd` is the solution for the rotation of the middle rectangle. The
    /// further columns are the solutions for the displacement of each neighbour.
    fn sums(
        &self,
        footprint: &Footprint,
        shear: &[f64],
        normal: &[f64],
        odd: &DMatrix<f64>,
    ) -> RowReactions {
        let columns: Vec<&[f64]> = odd.as_slice().chunks_exact(odd.nrows()).collect();
        let rotation = columns[0];
        let (mut neighbours, mut cross) = (Vec::new(), Vec::new());
        for k in 0..self.neighbours.len() {
            let centre = (k + 1) as f64 * footprint.pitch_over_a();
            neighbours.push([
                self.neighbour_sum(k, shear, ONE),
                self.neighbour_sum(k, normal, ONE),
                self.neighbour_sum(k, rotation, |x| x - centre),
            ]);
            let moment = 0.5 * self.middle_sum(columns[k + 1], ARM);
            cross.push(CrossTerms { force: self.neighbour_sum(k, rotation, ONE), moment });
        }
        let direct = [
            self.middle_sum(shear, ONE),
            self.middle_sum(normal, ONE),
            self.middle_sum(rotation, ARM),
        ];
        RowReactions { direct, neighbours, cross }
    }

    /// Returns the axes along `x` in the order of the unknowns, in which `z` varies fastest.
    pub(crate) fn axes_along_x(&self) -> impl Iterator<Item = &GradedAxis> + Clone {
        std::iter::once(&self.middle).chain(&self.neighbours)
    }

    pub(crate) fn unknowns(&self) -> usize {
        self.axes_along_x().map(GradedAxis::cells).sum::<usize>() * self.depth.cells()
    }

    /// Returns the displacements imposed at the collocation points, one column for each load.
    pub(crate) fn imposed(&self, loads: &[Load]) -> DMatrix<f64> {
        let depth = self.depth.cells();
        let points: Vec<(usize, f64)> = self
            .axes_along_x()
            .enumerate()
            .flat_map(|(body, axis)| axis.points().iter().map(move |&x| (body, x)))
            .collect();
        DMatrix::from_fn(self.unknowns(), loads.len(), |i, load| {
            let (body, x) = points[i / depth];
            loads[load].displacement(body, x)
        })
    }

    /// Returns `∬ p arm(x)` over the middle rectangle, four times the integral over its quarter.
    pub(crate) fn middle_sum(&self, tractions: &[f64], arm: impl Fn(f64) -> f64) -> f64 {
        4.0 * self.sum(&self.middle, 0, tractions, arm)
    }

    /// Returns `∬ p arm(x)` over neighbour `k`, twice the integral over its half.
    ///
    /// `k` is 0 for the nearest neighbour.
    pub(crate) fn neighbour_sum(
        &self,
        k: usize,
        tractions: &[f64],
        arm: impl Fn(f64) -> f64,
    ) -> f64 {
        let before = self.axes_along_x().take(k + 1).map(GradedAxis::cells).sum::<usize>();
        2.0 * self.sum(&self.neighbours[k], before * self.depth.cells(), tractions, arm)
    }

    /// Returns `∬ p arm(x)` over the meshed part of a rectangle.
    ///
    /// `first` is the index of the first unknown of the rectangle.
    fn sum(
        &self,
        axis: &GradedAxis,
        first: usize,
        tractions: &[f64],
        arm: impl Fn(f64) -> f64,
    ) -> f64 {
        let (depth, mut sum) = (self.depth.cells(), 0.0);
        for i in 0..axis.cells() {
            let column = (0..depth).map(|k| tractions[first + i * depth + k] * self.depth.width(k));
            sum += column.sum::<f64>() * axis.width(i) * arm(axis.middle(i));
        }
        sum
    }
}

/// Matrices `G` of (S5) for shear, normal displacement and rotation.
///
/// `shear` holds one matrix for each Poisson's ratio.
struct Equations {
    shear: Vec<DMatrix<f64>>,
    normal: DMatrix<f64>,
    rotation: DMatrix<f64>,
}

impl Equations {
    fn assemble(mesh: &Mesh, poisson_ratios: &[f64]) -> Self {
        let n = mesh.unknowns();
        let zeros = DMatrix::zeros(n, n);
        let shear = vec![zeros.clone(); poisson_ratios.len()];
        let mut equations = Self { shear, normal: zeros.clone(), rotation: zeros };
        let depth = mesh.depth.cells();
        let fields: Vec<f64> = mesh.axes_along_x().flat_map(GradedAxis::points).copied().collect();
        // All field points at the same depth share one line of corners, so that its logarithms are
        // computed once.
        for (k, &z) in mesh.depth.points().iter().enumerate() {
            let mut columns = CellColumns::new(CornerLine::new(mesh.depth.mirrored_edges(), z));
            for (i, &x) in fields.iter().enumerate() {
                let [right, left] = [1.0, -1.0].map(|side| columns.on_side(mesh, x, side));
                equations.fill_row(i * depth + k, &right, &left, poisson_ratios);
            }
        }
        equations
    }

    /// Fills a matrix row with the influences of all cells and of their mirror images in `x`.
    fn fill_row(
        &mut self,
        row: usize,
        right: &[Influence],
        left: &[Influence],
        poisson_ratios: &[f64],
    ) {
        for (column, (&right, &left)) in right.iter().zip(left).enumerate() {
            // `left` is negative, because the edges of a mirror image descend. The difference is
            // therefore the sum of both influences.
            let even = right - left;
            for (shear, ratio) in self.shear.iter_mut().zip(poisson_ratios) {
                shear[(row, column)] = even.tangential(*ratio);
            }
            self.normal[(row, column)] = even.normal();
            self.rotation[(row, column)] = (right + left).normal();
        }
    }
}

/// Influence of all cells on points at one depth `z`, each cell with its mirror image in `z`.
pub(crate) struct CellColumns {
    line: CornerLine,
    last: Vec<Influence>,
    next: Vec<Influence>,
}

impl CellColumns {
    /// Creates the influences for a line of corners with an odd number of corners.
    ///
    /// The corners lie at the edges of the cells and of their mirror images in `z`.
    pub(crate) fn new(line: CornerLine) -> Self {
        let blank = vec![Influence::default(); line.len()];
        Self { line, last: blank.clone(), next: blank }
    }

    /// Computes the influence at `x` of the cells on one side of the symmetry plane `x = 0`.
    ///
    /// `side` is 1 for the cells on the right and −1 for their mirror images. The edges of mirror
    /// images descend, so their influence has the opposite sign. `z` varies fastest in the result.
    pub(crate) fn on_side(&mut self, mesh: &Mesh, x: f64, side: f64) -> Vec<Influence> {
        let mut influence = Vec::with_capacity(mesh.unknowns());
        for axis in mesh.axes_along_x() {
            for (column, edge) in axis.edges().iter().enumerate() {
                std::mem::swap(&mut self.last, &mut self.next);
                self.line.evaluate(side * edge - x, &mut self.next);
                if column > 0 {
                    append_cells(&self.last, &self.next, &mut influence);
                }
            }
        }
        influence
    }
}

/// Appends the influence of the cells between two neighbouring lines of corners.
///
/// The influence of each cell includes its mirror image in `z`.
fn append_cells(last: &[Influence], next: &[Influence], into: &mut Vec<Influence>) {
    let half = last.len() / 2;
    into.extend((0..half).map(|k| {
        let [cell, image] = [[half + k, half + k + 1], [half - k - 1, half - k]]
            .map(|[low, high]| (next[high] - last[high]) - (next[low] - last[low]));
        cell + image
    }));
}

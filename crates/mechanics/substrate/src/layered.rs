//! Contribution of the rigid base below a layer to the stiffness of a row.
//!
//! The contribution is the difference of two collocation solutions, layer minus half-space, on the
//! same mesh, so that mesh errors cancel. Thick layers therefore converge to the half-space with
//! all digits of the table. On a layer the tractions `q` along the row and the normal tractions `p`
//! are solved together, with (S20) added to (S1) and (S2). Symmetry about `x = 0` splits the
//! equations into two systems: `q` even and `p` odd for a displacement along the row and for a
//! rotation, `q` odd and `p` even for a vertical displacement. In this module, "across" means
//! vertical.

use crate::boundary_element::{ARM, CellColumns, Load, ONE, Profile, Unresolved, row_reactions};
use crate::extrapolation::{CAUTION, extrapolation};
use crate::half_space::{CornerLine, Influence};
use crate::layer::{Displacements, Layer};
use crate::mesh::{GradedAxis, Mesh};
use crate::{Coupling, Footprint, FootprintParameter, NEIGHBOURS, Neighbour, RowStiffness};

use nalgebra::DMatrix;

/// Number of cells per side of both meshes.
///
/// The contribution of the base is smooth and needs fewer cells than the stiffness itself.
const CELLS: [usize; 2] = [4, 6];

/// Step of the finite differences, relative to the parameter (absolute for Poisson's ratio).
///
/// Both the third-order terms and the rounding of a solution, about 1e-13, stay below 1e-6 of the
/// derivative.
const STEP: f64 = 1e-4;

/// Number of values of the middle rectangle in [`Added::numbers`].
const OWN: usize = 4;
/// Number of values of each neighbour in [`Added::numbers`].
const PER_NEIGHBOUR: usize = 6;

/// Computes the contribution of the rigid base to the stiffness of a row.
///
/// The footprint `near`, almost equal to `footprint`, determines the number of quadrature points.
/// All footprints of a finite difference use one `near`, so that their quadratures do not differ.
///
/// # Errors
/// If the gap or a cell vanishes by rounding.
pub(crate) fn addition(
    footprint: &Footprint,
    near: &Footprint,
    coupling: Coupling,
) -> Result<RowStiffness, Unresolved> {
    let neighbours = if coupling == Coupling::Full { NEIGHBOURS } else { 1 };
    // There is no third mesh, so the error estimate is a fraction of the extrapolation step.
    let coarse = added(footprint, near, neighbours, CELLS[0])?;
    let fine = added(footprint, near, neighbours, CELLS[1])?;
    let best = extrapolation(CELLS, [&coarse.numbers, &fine.numbers]);
    let [x, y, turn] = fine.sizes;
    let cross = (y * turn).sqrt();
    let sizes =
        [x, y, turn, cross].into_iter().chain([x, y, turn, cross, x, cross].into_iter().cycle());
    let steps = best.iter().zip(&fine.numbers).zip(sizes);
    let error = steps.map(|((best, fine), size)| CAUTION * ((best - fine) / size).abs());
    let neighbours = best[OWN..].as_chunks::<PER_NEIGHBOUR>().0.iter().map(|n| Neighbour {
        direct: [n[0], n[1], n[2]],
        // Eq. (1) has no vertical force due to a rotation, so `c` of the layer is dropped, too.
        cross: if coupling == Coupling::Full { n[3] } else { 0.0 },
        lift: n[4],
        roll: n[5],
    });
    Ok(RowStiffness {
        direct: [best[0], best[1], best[2]],
        roll: best[3],
        error: error.fold(0.0, f64::max),
        neighbours: neighbours.collect(),
        ..RowStiffness::default()
    })
}

/// Computes the derivative of [`addition`] with respect to a parameter by central differences.
///
/// Second-order differences are sufficient, because the contribution is smooth.
pub(crate) fn slope(
    footprint: &Footprint,
    coupling: Coupling,
    parameter: FootprintParameter,
) -> Result<RowStiffness, Unresolved> {
    let step = footprint.step(parameter, STEP);
    let [high, low] = [step, -step]
        .map(|step| addition(&footprint.moved(parameter as usize, step), footprint, coupling));
    Ok(high? * (0.5 / step) + low? * (-0.5 / step))
}

/// Reactions of a row on a layer minus its reactions on the half-space, on one mesh.
struct Added {
    /// Values of the middle rectangle, then of each neighbour, in the notation of (S9) and (S21).
    ///
    /// Middle rectangle: `K_x`, `K_y`, `K_φ`, `r_0`. Neighbour: `K_x`, `K_y`, `K_φ`, `c`, `l`, `r`.
    numbers: Vec<f64>,
    /// `K_x`, `K_y`, `K_φ` of the middle rectangle on the layer.
    sizes: [f64; 3],
}

/// Solves for the reactions on the layer and on the half-space, and returns their difference.
fn added(
    footprint: &Footprint,
    near: &Footprint,
    neighbours: usize,
    n: usize,
) -> Result<Added, Unresolved> {
    let half_space = row_reactions(footprint, neighbours, n)?;
    let mesh = Mesh::row(footprint, neighbours, n);
    let quadrature = Quadrature::new(&mesh, &Mesh::row(near, neighbours, n), near);
    let [along, across] = quadrature.equations(&mesh, footprint);
    let unresolved = Unresolved { footprint: *footprint, cells: n };
    let solved = Tractions {
        mesh: &mesh,
        pitch: footprint.pitch_over_a(),
        along: mesh.solve(along, &[[Some(ONE), None], [None, Some(ARM)]]).ok_or(unresolved)?,
        across: mesh.solve(across, &[[None, Some(ONE)]]).ok_or(unresolved)?,
    };
    let middle = solved.middle();
    let mut numbers = middle.to_vec();
    (0..neighbours).for_each(|k| numbers.extend(solved.neighbour(k)));
    let all_finite = numbers.iter().all(|number| number.is_finite());
    for (number, less) in numbers.iter_mut().zip(half_space.direct) {
        *number -= less;
    }
    let rest = numbers[OWN..].as_chunks_mut::<PER_NEIGHBOUR>().0.iter_mut();
    for ((number, direct), cross) in rest.zip(&half_space.neighbours).zip(&half_space.cross) {
        let [x, y, turn] = *direct;
        number.iter_mut().zip([x, y, turn, cross.force]).for_each(|(n, less)| *n -= less);
    }
    let addition = Added { numbers, sizes: [middle[0], middle[1], middle[2]] };
    all_finite.then_some(addition).ok_or(unresolved)
}

impl Mesh {
    /// Solves for the tractions: `q` of all cells, followed by `p` of all cells.
    ///
    /// Each entry of `imposed` is a load: the tangential and the normal displacement of the middle
    /// rectangle. The neighbours are fixed. Returns `None` if the matrix is singular.
    fn solve(
        &self,
        equations: DMatrix<f64>,
        imposed: &[[Option<Profile>; 2]],
    ) -> Option<DMatrix<f64>> {
        let n = self.unknowns();
        let mut right = DMatrix::zeros(2 * n, imposed.len());
        for (load, parts) in imposed.iter().enumerate() {
            for (first, middle) in [0, n].into_iter().zip(parts) {
                let Some(middle) = *middle else { continue };
                let part = self.imposed(&[Load { middle, neighbour: None }]);
                right.view_mut((first, load), (n, 1)).copy_from(&part);
            }
        }
        equations.lu().solve(&right)
    }
}

/// Tractions due to a displacement along the row, a rotation and a vertical displacement.
struct Tractions<'a> {
    mesh: &'a Mesh,
    pitch: f64,
    /// First column: due to a displacement along the row. Second column: due to a rotation.
    along: DMatrix<f64>,
    /// Tractions due to a vertical displacement.
    across: DMatrix<f64>,
}

impl Tractions<'_> {
    /// Returns the tractions of each load.
    ///
    /// The loads are a displacement along the row, a rotation and a vertical displacement.
    fn by_load(&self) -> [&[f64]; 3] {
        let (push, turn) = self.along.as_slice().split_at(self.along.nrows());
        [push, turn, self.across.as_slice()]
    }

    fn middle(&self) -> [f64; OWN] {
        let n = self.mesh.unknowns();
        let [push, turn, lift] = self.by_load();
        let x = self.mesh.middle_sum(&push[..n], ONE);
        let y = self.mesh.middle_sum(&lift[n..], ONE);
        let moment = self.mesh.middle_sum(&turn[n..], ARM);
        // By reciprocity both values are equal, up to a small error of collocation.
        let roll = f64::midpoint(
            self.mesh.middle_sum(&turn[..n], ONE),
            self.mesh.middle_sum(&push[n..], ARM),
        );
        [x, y, moment, roll]
    }

    fn neighbour(&self, k: usize) -> [f64; PER_NEIGHBOUR] {
        let [push, turn, lifted] = self.by_load().map(|load| self.forces_on_neighbour(k, load));
        // By reciprocity `push` and `lifted` give the same `lift`, and `push` and `turn` the same
        // `roll`. On this mesh the values differ, because outer rectangles have fewer neighbours.
        // Means are used, because an energy requires one value.
        let lift = 0.5 * (push[1] - lifted[0]);
        let roll = f64::midpoint(push[2], turn[0]);
        [push[0], lifted[1], turn[2], turn[1], lift, roll]
    }

    /// Integrates tractions on neighbour `k` to the force along the row, vertical force and moment.
    fn forces_on_neighbour(&self, k: usize, tractions: &[f64]) -> [f64; 3] {
        let n = self.mesh.unknowns();
        let centre = (k + 1) as f64 * self.pitch;
        let (q, p) = tractions.split_at(n);
        [
            self.mesh.neighbour_sum(k, q, ONE),
            self.mesh.neighbour_sum(k, p, ONE),
            self.mesh.neighbour_sum(k, p, |x| x - centre),
        ]
    }
}

/// Coordinate of a quadrature point in a cell and its weight, for the smooth part of the influence.
type QuadraturePoint = [f64; 2];

/// Quadrature points of the cells along `x` (`columns`) and along `z` (`depth`).
struct Quadrature {
    columns: Vec<Vec<QuadraturePoint>>,
    depth: Vec<Vec<QuadraturePoint>>,
}

impl Quadrature {
    /// Places two Gauss points on subcells of at most half the thickness of the layer.
    ///
    /// The result is accurate to 1e-4 of the contribution. `near` determines the number of
    /// subcells.
    fn new(mesh: &Mesh, near: &Mesh, footprint: &Footprint) -> Self {
        let largest = 0.5 * footprint.thickness_over_a();
        let columns = mesh.axes_along_x().zip(near.axes_along_x());
        let columns = columns.flat_map(|(axis, near)| gauss_points(axis, near, largest)).collect();
        Self { columns, depth: gauss_points(&mesh.depth, &near.depth, largest) }
    }

    /// Assembles the matrices of the system with even `q` and of the system with even `p`.
    ///
    /// The first half of the rows are displacements along the row, the second half vertical ones.
    /// The first half of the columns belongs to `q`, the second half to `p`.
    fn equations(&self, mesh: &Mesh, footprint: &Footprint) -> [DMatrix<f64>; 2] {
        let n = mesh.unknowns();
        let layer = Layer::with_poisson_ratio(footprint.poisson_ratio());
        let mut systems = [DMatrix::zeros(2 * n, 2 * n), DMatrix::zeros(2 * n, 2 * n)];
        let depth = mesh.depth.cells();
        let fields: Vec<f64> = mesh.axes_along_x().flat_map(GradedAxis::points).copied().collect();
        for (k, &z) in mesh.depth.points().iter().enumerate() {
            let mut columns = CellColumns::new(CornerLine::new(mesh.depth.mirrored_edges(), z));
            for (i, &x) in fields.iter().enumerate() {
                let smooth = self.at(&layer, footprint.thickness_over_a(), [x, z]);
                let [right, left] = [1.0, -1.0].map(|side| columns.on_side(mesh, x, side));
                for (column, smooth) in smooth.into_iter().enumerate() {
                    // `left` has the opposite sign, because the edges of mirror images descend.
                    let closed = [right[column], Influence::default() - left[column]];
                    let [right, left] = [0, 1].map(|side| {
                        smooth[side] + on_half_space(closed[side], footprint.poisson_ratio())
                    });
                    let entry = [i * depth + k, column];
                    fill(&mut systems[0], n, entry, right, left, [1.0, -1.0]);
                    fill(&mut systems[1], n, entry, right, left, [-1.0, 1.0]);
                }
            }
        }
        systems
    }

    /// Computes the influence of each cell at `(x, z)`: layer minus half-space, a smooth function.
    ///
    /// The two values of a cell are due to the cell and to its mirror image in `x`. Both include
    /// the mirror image in `z`.
    fn at(&self, layer: &Layer, thickness: f64, [x, z]: [f64; 2]) -> Vec<[Displacements; 2]> {
        let mut influences = Vec::with_capacity(self.columns.len() * self.depth.len());
        for column in &self.columns {
            for row in &self.depth {
                let mut sums = [Displacements::default(); 2];
                for &[at_x, width] in column {
                    for &[at_z, depth] in row {
                        for (sum, x) in sums.iter_mut().zip([x - at_x, x + at_x]) {
                            let [one, image] = [z - at_z, z + at_z]
                                .map(|z| layer.deviation_from_half_space(thickness, x, z));
                            *sum = *sum + (one + image) * (width * depth);
                        }
                    }
                }
                influences.push(sums);
            }
        }
        influences
    }
}

/// Returns the Gauss points of each cell of an axis.
///
/// Each cell is divided into equal subcells. Their number is chosen so that subcells of the axis
/// `near` are no wider than `largest`.
fn gauss_points(axis: &GradedAxis, near: &GradedAxis, largest: f64) -> Vec<Vec<QuadraturePoint>> {
    let mut cells = Vec::with_capacity(axis.cells());
    for k in 0..axis.cells() {
        let parts = (near.width(k) / largest).ceil().max(1.0);
        let width = axis.width(k) / parts;
        let half = 0.5 * width / 3.0_f64.sqrt();
        let mut points = Vec::new();
        for i in 0..parts as usize {
            let middle = axis.edges()[k] + (i as f64 + 0.5) * width;
            points.extend([-half, half].map(|by| [middle + by, 0.5 * width]));
        }
        cells.push(points);
    }
    cells
}

/// Returns the surface displacements of the half-space due to unit tractions on a cell.
fn on_half_space(cell: Influence, poisson_ratio: f64) -> Displacements {
    let (normal, shear) = (cell.normal(), cell.tangential(poisson_ratio));
    Displacements { normal, shear, cross: 0.0 }
}

/// Fills the four entries by which a cell influences a collocation point.
///
/// `right` and `left` are the influences of the cell and of its mirror image in `x`. The last
/// argument holds the signs of `q` and of `p` on the mirror image.
fn fill(
    matrix: &mut DMatrix<f64>,
    n: usize,
    [row, column]: [usize; 2],
    right: Displacements,
    left: Displacements,
    [along, across]: [f64; 2],
) {
    matrix[(row, column)] = right.shear + along * left.shear;
    matrix[(row, n + column)] = right.cross + across * left.cross;
    matrix[(n + row, column)] = -(right.cross + along * left.cross);
    matrix[(n + row, n + column)] = right.normal + across * left.normal;
}

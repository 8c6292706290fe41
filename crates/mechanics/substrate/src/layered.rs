//! Contribution of a rigid base below a layer to the stiffness of a row.
//!
//! Layer and half-space are solved by collocation on the same meshes and subtracted, so that mesh
//! errors cancel. Hence thick layers converge to the half-space to the last digit of the table. On
//! a layer the tractions `q` along the row and `p` across it are solved together, with (S20) added
//! to (S1) and (S2). The symmetry plane `x = 0` gives two systems: `q` even and `p` odd for a
//! displacement along the row and for a rotation, `q` odd and `p` even for a displacement across
//! it.

use crate::boundary_element::{ARM, CellColumns, Load, ONE, Profile, Unresolved, row_reactions};
use crate::extrapolation::{CAUTION, extrapolation};
use crate::half_space::{CornerLine, Influence};
use crate::layer::{Displacements, Layer};
use crate::mesh::{GradedAxis, Mesh};
use crate::{Coupling, Footprint, FootprintParameter, NEIGHBOURS, Neighbour, RowStiffness};

use nalgebra::DMatrix;

/// Cells per side of the meshes.
///
/// The contribution is smooth and needs fewer than the stiffness.
const CELLS: [usize; 2] = [4, 6];

/// Relative step of the differences.
///
/// Third-order terms and the rounding of a solution, about 1e-13, both stay below 1e-6 of the
/// derivative.
const STEP: f64 = 1e-4;

/// Number of values for the scale itself, and for each neighbour.
const OWN: usize = 4;
const PER_NEIGHBOUR: usize = 6;

/// Computes the contribution of the layer to the stiffness of a row.
///
/// The cells have the quadrature of the footprint `near`, which is almost equal, so that
/// differences between footprints do not contain a change of the quadrature.
///
/// # Errors
/// If the gap vanishes by rounding.
pub(crate) fn addition(
    footprint: &Footprint,
    near: &Footprint,
    coupling: Coupling,
) -> Result<RowStiffness, Unresolved> {
    let neighbours = if coupling == Coupling::Full { NEIGHBOURS } else { 1 };
    // With two meshes only, the step of the extrapolation is the error estimate.
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
        // Eq. (1) has no force from rotation, so drop it here too.
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

/// Computes the derivative of [`addition`] with respect to a parameter.
///
/// Second-order differences suffice: the contribution of a layer is smooth.
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

/// Reactions on one mesh, minus the half-space reactions.
struct Added {
    /// Values of the middle rectangle, then of each neighbour.
    ///
    /// `K_x`, `K_y`, `K_φ`, `r_0`, then `K_x`, `K_y`, `K_φ`, `c`, `l`, `r`.
    numbers: Vec<f64>,
    /// `K_x`, `K_y`, `K_φ` of the middle rectangle on the layer.
    sizes: [f64; 3],
}

/// Solves for the reactions on the layer and on the half-space, and subtracts them.
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
    /// Solves for the tractions, `q` before `p`.
    ///
    /// `imposed` holds the displacements of the middle rectangle along and across the row; its
    /// neighbours are fixed. `None` if the matrix is singular.
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

/// Tractions of the three loads.
struct Tractions<'a> {
    mesh: &'a Mesh,
    pitch: f64,
    /// Tractions due to a displacement along the row, and due to a rotation.
    along: DMatrix<f64>,
    /// Tractions due to a displacement across the row.
    across: DMatrix<f64>,
}

impl Tractions<'_> {
    /// Returns the tractions by load.
    ///
    /// The loads are a displacement along the row, a rotation, and a displacement across the row.
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
        // By reciprocity both are equal; collocation leaves a small difference, so take the mean.
        let roll = f64::midpoint(
            self.mesh.middle_sum(&turn[..n], ONE),
            self.mesh.middle_sum(&push[n..], ARM),
        );
        [x, y, moment, roll]
    }

    fn neighbour(&self, k: usize) -> [f64; PER_NEIGHBOUR] {
        let [push, turn, lifted] = self.by_load().map(|load| self.forces_on_neighbour(k, load));
        // The middle rectangle has two neighbours, its neighbours have one, so collocation gives
        // two values. An energy requires one value: take the mean.
        let lift = 0.5 * (push[1] - lifted[0]);
        let roll = f64::midpoint(push[2], turn[0]);
        [push[0], lifted[1], turn[2], turn[1], lift, roll]
    }

    /// Sums the tractions on neighbour `k`: forces along and across the row, moment.
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

/// Point of a cell with its weight, for the smooth part of the influence.
type QuadraturePoint = [f64; 2];

/// Quadrature points of cells: along the row by column, across it by row.
struct Quadrature {
    columns: Vec<Vec<QuadraturePoint>>,
    depth: Vec<Vec<QuadraturePoint>>,
}

impl Quadrature {
    /// Places two Gauss points on subcells of at most half the thickness of the layer.
    ///
    /// The quadrature is accurate to 1e-4 of the contribution.
    fn new(mesh: &Mesh, near: &Mesh, footprint: &Footprint) -> Self {
        let largest = 0.5 * footprint.thickness_over_a();
        let columns = mesh.across().zip(near.across());
        let columns = columns.flat_map(|(axis, near)| gauss_points(axis, near, largest)).collect();
        Self { columns, depth: gauss_points(&mesh.depth, &near.depth, largest) }
    }

    /// Assembles the matrices of the two systems.
    ///
    /// The displacements along the row precede those across it, and `q` precedes `p`.
    fn equations(&self, mesh: &Mesh, footprint: &Footprint) -> [DMatrix<f64>; 2] {
        let n = mesh.unknowns();
        let layer = Layer::with_poisson_ratio(footprint.poisson_ratio());
        let mut systems = [DMatrix::zeros(2 * n, 2 * n), DMatrix::zeros(2 * n, 2 * n)];
        let depth = mesh.depth.cells();
        let fields: Vec<f64> = mesh.across().flat_map(GradedAxis::points).copied().collect();
        for (k, &z) in mesh.depth.points().iter().enumerate() {
            let mut columns = CellColumns::new(CornerLine::new(mesh.depth.mirrored_edges(), z));
            for (i, &x) in fields.iter().enumerate() {
                let smooth = self.at(&layer, footprint.thickness_over_a(), [x, z]);
                let [right, left] = [1.0, -1.0].map(|side| columns.on_side(mesh, x, side));
                for (column, smooth) in smooth.into_iter().enumerate() {
                    // The edges of a mirror image descend, which reverses the sign.
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

    /// Computes the smooth influence of each cell at a point.
    ///
    /// The two values are the cell and its mirror image in `x`, each with its mirror image in `z`.
    fn at(&self, layer: &Layer, thickness: f64, [x, z]: [f64; 2]) -> Vec<[Displacements; 2]> {
        let mut influences = Vec::with_capacity(self.columns.len() * self.depth.len());
        for column in &self.columns {
            for row in &self.depth {
                let mut sums = [Displacements::default(); 2];
                for &[at_x, width] in column {
                    for &[at_z, depth] in row {
                        for (sum, x) in sums.iter_mut().zip([x - at_x, x + at_x]) {
                            let [one, image] = [z - at_z, z + at_z]
                                .map(|z| layer.beside_half_space(thickness, x, z));
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
/// Each cell is divided into subcells no wider than `largest`. The axis `near` determines their
/// number.
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

/// Returns the displacements of a cell on the half-space.
fn on_half_space(cell: Influence, poisson_ratio: f64) -> Displacements {
    let (normal, shear) = (cell.normal(), cell.tangential(poisson_ratio));
    Displacements { normal, shear, cross: 0.0 }
}

/// Fills the four entries of a cell.
///
/// `signs` are the signs of `q` and `p` in the mirror image.
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

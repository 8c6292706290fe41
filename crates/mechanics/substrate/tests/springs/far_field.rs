//! The far field of free scales agrees with solutions for all scales of a row.

use nalgebra::{DMatrix, DVector};
use substrate::{Coupling, FarField, Footprint, Neighbour, RowStiffness, Springs};

fn springs(alpha: f64, ratio: f64) -> RowStiffness {
    let direct = [alpha, 2.0 * alpha, 0.5 * alpha];
    let coupling = [0.5 * ratio, 0.4 * ratio, -0.45 * ratio];
    let coupling = std::array::from_fn(|k| direct[k] * coupling[k]);
    RowStiffness::from(&Springs { direct, coupling, error: 0.0 })
}

/// Solves a row of `scales` free scales with its first scale displaced by 1 along `k`.
///
/// Uses Thomas's algorithm from the far end. Returns the displacements of all scales and the force
/// on the first scale.
fn finite_row(stiffness: &RowStiffness, k: usize, scales: usize) -> (Vec<f64>, f64) {
    let (alpha, beta) = (stiffness.direct[k], -stiffness.neighbours[0].direct[k]);
    let mut ratios = Vec::new();
    let mut reduced = alpha;
    for _ in 1..scales {
        ratios.push(beta / reduced);
        reduced = alpha - beta * beta / reduced;
    }
    let mut displacements = vec![1.0];
    for ratio in ratios.iter().rev() {
        displacements.push(ratio * displacements[displacements.len() - 1]);
    }
    (displacements, reduced)
}

/// Returns the stiffness of the last solved scale in direction `k`, reduced by the far field.
fn reduced_stiffness(stiffness: &RowStiffness, far: &FarField, k: usize) -> f64 {
    let relief = far.relief.iter().find(|r| [r.force, r.displacement] == [0, 0]);
    stiffness.direct[k] - relief.unwrap().by[k][k]
}

#[test]
fn the_far_field_of_an_infinite_row_agrees_with_400_scales() {
    for ratio in [-0.98, -0.3, 0.0, 0.2, 0.7, 0.98] {
        let stiffness = springs(3.0, ratio);
        let far = stiffness.far_field(None).unwrap();
        for k in 0..3 {
            let (displacements, force) = finite_row(&stiffness, k, 400);
            assert!((reduced_stiffness(&stiffness, &far, k) / force - 1.0).abs() < 1e-13);
            for (distance, displacement) in displacements.iter().enumerate().take(20).skip(1) {
                let found = far.displacement(|_| [1.0; 3], distance)[k];
                assert!(
                    (found - displacement).abs() <= 1e-12 * displacement.abs(),
                    "{k} {distance}"
                );
            }
        }
    }
}

#[test]
fn the_far_field_of_a_finite_row_agrees_with_a_solution_of_all_scales() {
    for ratio in [-0.98, 0.0, 0.2, 0.98] {
        let stiffness = springs(3.0, ratio);
        for beyond in [1, 2, 3, 10, 60] {
            let far = stiffness.far_field(Some(beyond)).unwrap();
            for k in 0..3 {
                let (displacements, force) = finite_row(&stiffness, k, beyond + 1);
                assert!((reduced_stiffness(&stiffness, &far, k) / force - 1.0).abs() < 1e-13);
                let found = far.displacements(|_| [1.0; 3], beyond);
                for (found, displacement) in found.iter().zip(&displacements[1..]) {
                    let off = found[k] - displacement;
                    assert!(off.abs() <= 1e-12 * displacement.abs(), "{k} {beyond}");
                }
            }
        }
    }
}

#[test]
fn displacements_decay_along_rows_on_a_half_space() {
    for [gap, width] in [[0.2, 2.0], [0.0125, 0.25], [40.0, 80.0], [0.2, 20.0]] {
        let footprint = Footprint::new(gap, width, 0.5).unwrap();
        let stiffness = RowStiffness::compute(&footprint, Coupling::Nearest).unwrap();
        let far = stiffness.far_field(None).unwrap();
        let [x, y, rotation] = far.displacement(|_| [1.0; 3], 1);
        // Displacements along x and y keep their sign from scale to scale, rotations alternate.
        assert!(0.0 < x && x < 1.0 && 0.0 < y && y < 1.0, "{x} {y}");
        assert!(-1.0 < rotation && rotation < 0.0, "{rotation}");
        for k in 0..3 {
            let part = reduced_stiffness(&stiffness, &far, k) / stiffness.direct[k];
            assert!(0.5 < part && part < 1.0, "{k} {part}");
        }
    }
}

/// Assembles the dense stiffness of a row with the couplings of (S9) and (S21).
fn dense(stiffness: &RowStiffness, scales: usize) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(3 * scales, 3 * scales);
    for i in 0..scales {
        for k in 0..3 {
            matrix[(3 * i + k, 3 * i + k)] = stiffness.direct[k];
        }
        matrix[(3 * i, 3 * i + 2)] = stiffness.roll;
        matrix[(3 * i + 2, 3 * i)] = stiffness.roll;
        for (j, neighbour) in (i + 1..scales).zip(&stiffness.neighbours) {
            for (force, displaced, value) in [
                (3 * i, 3 * j, neighbour.direct[0]),
                (3 * i + 1, 3 * j + 1, neighbour.direct[1]),
                (3 * i + 2, 3 * j + 2, neighbour.direct[2]),
                (3 * j + 1, 3 * i + 2, neighbour.cross),
                (3 * i + 1, 3 * j + 2, -neighbour.cross),
                (3 * j + 1, 3 * i, neighbour.lift),
                (3 * j, 3 * i + 1, -neighbour.lift),
                (3 * j, 3 * i + 2, neighbour.roll),
                (3 * j + 2, 3 * i, neighbour.roll),
            ] {
                matrix[(force, displaced)] = value;
                matrix[(displaced, force)] = value;
            }
        }
    }
    matrix
}

/// The far field with `m` coupled neighbours equals the static condensation of 400 free scales.
#[test]
fn a_row_with_several_neighbours_is_condensed_to_its_last_scales() {
    let rows = [([0.2, 2.0], 8), ([0.0125, 0.25], 3), ([8.0, 80.0], 1)];
    let rows = rows.map(|([gap, width], neighbours)| {
        RowStiffness::solve(&Footprint::new(gap, width, 0.5).unwrap(), neighbours).unwrap()
    });
    let layer = Footprint::new(0.2, 2.0, 0.5).unwrap().on_layer(1.5).unwrap();
    let layers = [Coupling::Nearest, Coupling::Full]
        .map(|coupling| RowStiffness::compute(&layer, coupling).unwrap());
    for stiffness in rows.into_iter().chain(layers) {
        let neighbours = stiffness.neighbours.len();
        let far = stiffness.far_field(None).unwrap();
        assert_eq!(stiffness.far_field(Some(5)), None);
        let (last, all) = (3 * neighbours, 3 * (neighbours + 400));
        let matrix = dense(&stiffness, neighbours + 400);
        let inner = matrix.view((last, last), (all - last, all - last)).into_owned();
        let follows =
            inner.lu().solve(&matrix.view((last, 0), (all - last, last)).into_owned()).unwrap();
        let relief = matrix.view((0, last), (last, all - last)) * &follows;
        let mut condensed = DMatrix::<f64>::zeros(last, last);
        for part in &far.relief {
            let [row, column] =
                [part.force, part.displacement].map(|scale| 3 * (neighbours - 1 - scale));
            for (k, by) in part.by.iter().enumerate() {
                for (l, &by) in by.iter().enumerate() {
                    condensed[(row + k, column + l)] = by;
                }
            }
        }
        assert!((&relief - &condensed).amax() < 1e-13 * stiffness.direct[0]);
        let displaced = DVector::from_fn(last, |i, _| end(neighbours - 1 - i / 3)[i % 3]);
        let moved = &follows * displaced;
        for (scale, found) in far.displacements(end, 20).iter().enumerate() {
            for (k, found) in found.iter().enumerate() {
                assert!((found + moved[3 * scale + k]).abs() < 1e-12, "{scale} {k}");
            }
            assert_eq!(*found, far.displacement(end, scale + 1));
        }
    }
}

/// Returns arbitrary displacements for the last solved scales.
fn end(scale: usize) -> [f64; 3] {
    let k = scale as f64;
    [0.3 + k, k.cos(), (3.0 * k).sin()]
}

#[test]
fn an_unstable_row_has_no_far_field() {
    let mut loose = springs(1.0, 0.5);
    loose.neighbours = vec![Neighbour { direct: [-0.5, -0.1, 0.1], ..Neighbour::default() }];
    assert_eq!(loose.far_field(None).or(loose.far_field(Some(3))), None);
    loose.neighbours.push(Neighbour { direct: [-0.1, 0.0, 0.0], ..Neighbour::default() });
    assert_eq!(loose.far_field(None), None);
}

//! Stiffness of rows with several coupled neighbours, Eqs. (S9)–(S12).

use std::f64::consts::PI;
use std::sync::Arc;

use analytical::half_space;
use substrate::{Calibrations, Coupling, Footprint, NEIGHBOURS, RowStiffness, calibrate};

/// `d/a` and `b/a` of the rows, from narrow to long bases and from small to large gaps.
const FOOTPRINTS: [[f64; 2]; 6] =
    [[0.2, 2.0], [0.2, 20.0], [8.0, 80.0], [4.0, 2.0], [0.05, 0.5], [0.1, 1.0]];

fn footprint([gap, width]: [f64; 2]) -> Footprint {
    Footprint::new(gap, width, 0.5).unwrap()
}

fn row(numbers: [f64; 2], neighbours: usize) -> RowStiffness {
    RowStiffness::solve(&footprint(numbers), neighbours).unwrap()
}

#[test]
fn a_row_with_one_neighbour_has_the_springs_of_equation_1() {
    for [gap, width] in FOOTPRINTS {
        // This gap lies outside the table, so both functions solve boundary elements.
        let beyond = [1e-3 * gap, width];
        let (springs, row) = (calibrate(&footprint(beyond)).unwrap(), row(beyond, 1));
        let mut eq1 = RowStiffness::from(&springs);
        assert_eq!((row.direct, row.error), (eq1.direct, eq1.error));
        assert!(row.neighbours[0].cross < 0.0);
        eq1.neighbours[0].cross = row.neighbours[0].cross;
        assert_eq!(row.neighbours, eq1.neighbours);
    }
}

/// The stiffness of an infinite row for displacements `exp(i q k)` is positive definite (S12).
///
/// If it is positive definite for every `q`, so is the stiffness of every finite row.
#[test]
fn the_stiffness_is_positive_definite() {
    for numbers in FOOTPRINTS {
        for neighbours in [1, 2, NEIGHBOURS] {
            let row = row(numbers, neighbours);
            for step in 0..=400 {
                let q = PI * f64::from(step) / 400.0;
                let ([mut x, mut y, mut turn], mut cross) = (row.direct, 0.0);
                for (k, n) in row.neighbours.iter().enumerate() {
                    let (sin, cos) = ((k + 1) as f64 * q).sin_cos();
                    x += 2.0 * cos * n.direct[0];
                    y += 2.0 * cos * n.direct[1];
                    turn += 2.0 * cos * n.direct[2];
                    cross += 2.0 * sin * n.cross;
                }
                assert!(x > 0.0 && y > 0.0 && turn > 0.0, "{numbers:?} {q}");
                assert!(y * turn > cross * cross, "{numbers:?} {q}");
            }
        }
    }
}

/// A distant scale is loaded like the surface under a point load or a couple.
///
/// The displacements of the surface at the distance `r` are `u = α_y/(π r)` and `u = α_φ/(π r²)`.
#[test]
fn distant_scales_respond_as_to_point_loads_and_couples() {
    let row = row([200.0, 2.0], 3);
    let [_, alone, turned] = row.direct;
    for (k, neighbour) in row.neighbours.iter().enumerate() {
        let r = (k + 1) as f64 * 202.0;
        let force = -alone * alone * half_space::point_load(r);
        let couple = -alone * turned * half_space::point_couple(r);
        assert!((neighbour.direct[1] / force - 1.0).abs() < 0.02, "{k} {}", neighbour.direct[1]);
        // Scales between the displaced and the distant scale carry a part of the load.
        assert!((neighbour.cross / couple - 1.0).abs() < 0.03, "{k} {}", neighbour.cross);
    }
}

/// The error includes the difference of the cross terms, which is 0 by Betti's theorem.
#[test]
fn rows_with_eight_neighbours_have_small_estimated_errors() {
    for numbers in FOOTPRINTS {
        let row = row(numbers, NEIGHBOURS);
        assert!(row.error < 1e-3, "{numbers:?} {:e}", row.error);
        assert!(row.truncation < 0.02, "{numbers:?} {:e}", row.truncation);
        assert_eq!(row.estimated_error(), row.error + row.truncation);
    }
}

/// Doubling the number of neighbours changes no value by more than `truncation` (S11).
#[test]
fn the_truncation_error_bounds_the_effect_of_more_neighbours() {
    for (k, numbers) in FOOTPRINTS.into_iter().enumerate() {
        // Rows of 33 rectangles take most of the time, so only half of the footprints use them.
        let counts = if k % 2 == 0 { vec![2, 4, 8, 16] } else { vec![2, 4, 8] };
        let rows: Vec<_> = counts.into_iter().map(|count| row(numbers, count)).collect();
        for pair in rows.windows(2) {
            let (short, long) = (&pair[0], &pair[1]);
            let change = largest_change(short, long);
            let neighbours = short.neighbours.len();
            assert!(change < short.truncation, "{numbers:?} {neighbours} {change}");
            assert!(long.truncation < 0.7 * short.truncation);
        }
    }
}

/// Returns the largest difference of the stiffness values that both rows have, relative to `K_0`.
fn largest_change(short: &RowStiffness, long: &RowStiffness) -> f64 {
    let pairs = short.neighbours.iter().zip(&long.neighbours).map(|(a, b)| (a.direct, b.direct));
    let changes = pairs
        .chain([(short.direct, long.direct)])
        .flat_map(|(a, b)| (0..3).map(move |i| (a[i] - b[i]).abs() / long.direct[i]));
    changes.fold(0.0, f64::max)
}

/// A rotation loads hardly more than the nearest neighbours, a displacement also distant ones.
#[test]
fn couplings_of_rotations_decay_faster_than_couplings_of_displacements() {
    for numbers in FOOTPRINTS {
        let row = row(numbers, NEIGHBOURS);
        let [y, turn] = [1, 2].map(|i| (row.neighbours[3].direct[i] / row.direct[i]).abs());
        assert!(turn < 3e-4 && y > 7e-3, "{numbers:?} {turn} {y}");
        let size = (row.direct[1] * row.direct[2]).sqrt();
        assert!((row.neighbours[3].cross / size).abs() < 2e-3, "{numbers:?}");
    }
}

#[test]
fn rows_with_both_couplings_are_cached() {
    let shared = Calibrations::default();
    let print = footprint([0.2, 2.0]);
    let full = shared.row(&print, Coupling::Full).unwrap();
    assert_eq!(*full, RowStiffness::compute(&print, Coupling::Full).unwrap());
    assert_eq!(full.neighbours.len(), NEIGHBOURS);
    assert!(Arc::ptr_eq(&shared.row(&print, Coupling::Full).unwrap(), &full));
    let nearest = shared.row(&print, Coupling::Nearest).unwrap();
    assert_eq!(*nearest, RowStiffness::from(&calibrate(&print).unwrap()));
    assert_eq!(shared.get(&print), calibrate(&print));
    let lost = Footprint::new(1e-17, 2.0, 0.5).unwrap();
    assert!(shared.row(&lost, Coupling::Full).is_err());
}

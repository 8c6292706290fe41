//! The derivatives of the springs against differences of whole calibrations.

use substrate::{Coupling, Footprint, OneSided, RowStiffness, StiffnessSlopes};

fn numbers(stiffness: &RowStiffness) -> Vec<f64> {
    let neighbours = stiffness.neighbours.iter();
    let neighbours = neighbours.flat_map(|n| n.direct.into_iter().chain([n.cross]));
    stiffness.direct.into_iter().chain(neighbours).collect()
}

/// `(−3 f₀ + 4 f₁ − f₂)/2h` in a direction, with one step of Richardson's.
fn one_sided(at: impl Fn(f64) -> Vec<f64>, step: f64) -> Vec<f64> {
    let [f0, f1, f2, f4] = [0.0, 1.0, 2.0, 4.0].map(|k| at(k * step));
    let difference = |i: usize| {
        let rough = (-3.0 * f0[i] + 4.0 * f2[i] - f4[i]) / (4.0 * step);
        let fine = (-3.0 * f0[i] + 4.0 * f1[i] - f2[i]) / (2.0 * step);
        fine + (fine - rough) / 3.0
    };
    (0..f0.len()).map(difference).collect()
}

fn central(at: impl Fn(f64) -> Vec<f64>, step: f64) -> Vec<f64> {
    let difference = |step: f64| -> Vec<f64> {
        let (high, low) = (at(step), at(-step));
        high.iter().zip(low).map(|(high, low)| (high - low) / (2.0 * step)).collect()
    };
    let (fine, rough) = (difference(step), difference(2.0 * step));
    fine.iter().zip(rough).map(|(fine, rough)| fine + (fine - rough) / 3.0).collect()
}

fn assert_close(ours: &RowStiffness, expected: &[f64], tolerance: f64, what: &str) {
    let ours = numbers(ours);
    let largest = expected.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
    for (ours, expected) in ours.iter().zip(expected) {
        let off = (ours - expected).abs();
        assert!(
            off <= tolerance * expected.abs() + 0.1 * tolerance * largest,
            "{what}: {ours} {expected}"
        );
    }
}

fn check(gap: f64, width: f64, poisson_ratio: f64, coupling: Coupling) {
    let at = |gap: f64, width: f64, ratio: f64| {
        let footprint = Footprint::new(gap, width, ratio).unwrap();
        numbers(&RowStiffness::of(&footprint, coupling).unwrap())
    };
    // Where two of gap, width and base are equal another one grades the mesh on each side.
    let is_tied = width == 2.0 || gap == width.min(2.0);
    let footprint = Footprint::new(gap, width, poisson_ratio).unwrap();
    let slopes = StiffnessSlopes::of(&footprint, coupling).unwrap();
    assert_eq!(slopes.stiffness, RowStiffness::of(&footprint, coupling).unwrap());
    let what = format!("{gap} {width} {poisson_ratio} {coupling:?}");
    let by_ratio = central(|h| at(gap, width, poisson_ratio + h), 1e-4);
    assert_close(&slopes.by_poisson_ratio, &by_ratio, 1e-7, &what);
    let by_gap = |h: f64| at(gap * (1.0 + h), width, poisson_ratio);
    let by_width = |h: f64| at(gap, width * (1.0 + h), poisson_ratio);
    let by_size = |h: f64| at(gap * (1.0 + h), width * (1.0 + h), poisson_ratio);
    let scaled = |slopes: &OneSided, by: f64| OneSided {
        left: slopes.left.clone() * by,
        right: slopes.right.clone() * by,
    };
    let compare = |slopes: OneSided, f: &dyn Fn(f64) -> Vec<f64>| {
        if is_tied {
            assert_close(&slopes.right, &one_sided(f, 1e-4), 1e-6, &what);
            let back: Vec<_> = one_sided(|h| f(-h), 1e-4).iter().map(|x| -x).collect();
            assert_close(&slopes.left, &back, 1e-6, &what);
        } else {
            assert_eq!(slopes.left, slopes.right);
            assert_close(&slopes.right, &central(f, 1e-3), 1e-6, &what);
        }
    };
    compare(scaled(&slopes.by_gap, gap), &by_gap);
    compare(scaled(&slopes.by_width, width), &by_width);
    compare(slopes.by_size.clone(), &by_size);
}

#[test]
fn derivatives_of_the_springs_are_those_of_whole_calibrations() {
    for (gap, width) in [(0.2, 1.7), (0.03, 3.1), (4.0, 0.6), (1.3, 40.0), (0.9, 0.5)] {
        for ratio in [0.1, 0.37, 0.45] {
            check(gap, width, ratio, Coupling::Nearest);
        }
    }
    check(0.3, 1.4, 0.3, Coupling::Full);
}

#[test]
fn where_the_mesh_is_graded_anew_there_is_a_derivative_on_each_side() {
    // d = b = 2a, b = 2a, d = b, d = 2a.
    for (gap, width) in [(2.0, 2.0), (0.2, 2.0), (0.8, 0.8), (2.0, 20.0)] {
        let footprint = Footprint::new(gap, width, 0.4).unwrap();
        let slopes = StiffnessSlopes::of(&footprint, Coupling::Nearest).unwrap();
        assert!([&slopes.by_gap, &slopes.by_width].iter().any(|slope| slope.left != slope.right));
        check(gap, width, 0.4, Coupling::Nearest);
    }
}

//! Springs agree with published and independent values and with closed forms.
//!
//! For printed values the tolerance is half a unit of the last digit plus `Springs::error`.

use analytical::half_space;
use substrate::{Footprint, Springs, calibrate, extrapolated};

/// Gap at which the coupling is too small to change the last printed digit.
const ALONE: f64 = 1e5;

fn springs(gap: f64, width: f64, poisson_ratio: f64) -> Springs {
    calibrate(&Footprint::new(gap, width, poisson_ratio).unwrap()).unwrap()
}

/// Asserts that `found` equals `printed`, a value rounded to `digits` decimals.
///
/// `estimate` is the absolute estimated error of `found`.
fn assert_printed(found: f64, printed: f64, digits: i32, estimate: f64) {
    let allowed = 0.5 * 10_f64.powi(-digits) + estimate;
    assert!((found - printed).abs() <= allowed, "{found} is not {printed} within {allowed:.1e}");
}

/// A rigid square punch of side `s` needs the force `P = 1.1523 E* s δ` (Borodachev 1976).
///
/// The springs refer to the half-width `a = s/2`.
#[test]
fn a_rigid_square_punch_agrees_with_borodachev() {
    for poisson_ratio in [0.0, 0.3, 0.5] {
        let square = springs(ALONE, 2.0, poisson_ratio);
        let printed = half_space::SQUARE.normal / 2.0;
        assert_printed(square.direct[1] / 2.0, printed, 4, square.error * square.direct[1] / 2.0);
        assert!(square.error < 5e-4, "{}", square.error);
    }
}

/// Compares the stiffness of a single square for shear and rotation at `ν = 0.5`.
#[test]
fn an_isolated_square_agrees_with_converged_values() {
    let square = springs(ALONE, 2.0, 0.5);
    let known = half_space::SQUARE;
    assert_printed(square.direct[0], known.shear, 4, square.error * square.direct[0]);
    assert_printed(square.direct[2], known.rocking, 4, square.error * square.direct[2]);
}

/// Compares three squares with gaps of a tenth of their side at `ν = 0.5`.
///
/// The known values are printed with three decimals and truncated, not rounded: the computed value
/// `β_x = 0.9936` is printed as 0.993.
#[test]
fn three_squares_agree_with_converged_values() {
    let row = springs(0.2, 2.0, 0.5);
    let direct = half_space::THREE_SQUARES_DIRECT.values();
    let coupling = half_space::THREE_SQUARES_COUPLING.values().map(f64::abs);
    for (i, (direct, coupling)) in direct.into_iter().zip(coupling).enumerate() {
        let slack = row.error * row.direct[i];
        for (found, cut) in [(row.direct[i], direct), (row.coupling[i].abs(), coupling)] {
            assert!(
                found > cut - slack && found < cut + 1e-3 + slack,
                "{found} is not {cut} when truncated"
            );
        }
    }
    assert!(row.coupling[2] < 0.0);
}

/// A distant neighbour is loaded like the surface under a point load.
///
/// The displaced scale exerts the force `α`, which displaces the surface at the pitch `p` by
/// `u = α/(π p)`, and for shear by `u = α/(π p (1 − ν))`. The reaction of the neighbour is `α u`.
#[test]
fn distant_neighbours_respond_as_to_a_point_load() {
    let poisson_ratio = 0.3;
    for gap in [50.0, 200.0] {
        let row = springs(gap, 1.0, poisson_ratio);
        let pitch = gap + 2.0;
        let normal = row.direct[1].powi(2) * half_space::point_load(pitch);
        let shear = row.direct[0].powi(2) * half_space::tangential_point_load(pitch, poisson_ratio);
        // The two neighbours also load each other, an effect of the relative size a/p.
        assert!(
            (row.coupling[1] / normal - 1.0).abs() < 1.0 / pitch,
            "{}",
            row.coupling[1] / normal
        );
        assert!((row.coupling[0] / shear - 1.0).abs() < 1.0 / pitch, "{}", row.coupling[0] / shear);
    }
}

#[test]
fn coupling_vanishes_with_distance() {
    let mut last = springs(0.05, 2.0, 0.5).coupling.map(f64::abs);
    for gap in [0.2, 1.0, 5.0, 25.0, 125.0, 625.0] {
        let coupling = springs(gap, 2.0, 0.5).coupling.map(f64::abs);
        assert!(coupling.iter().zip(last).all(|(now, before)| *now < before), "{coupling:?}");
        last = coupling;
    }
    assert!(last[0] < 4e-3 && last[1] < 4e-3 && last[2] < 1e-6, "{last:?}");
}

/// The effect of the neighbours on `α` decreases with the pitch `p` as `(a/p)²`.
#[test]
fn the_effect_of_neighbours_decreases_with_the_square_of_the_pitch() {
    let alone = extrapolated(&Footprint::new(ALONE, 2.0, 0.5).unwrap(), [16, 24]).unwrap();
    let [near, far] = [40.0, 82.0].map(|gap| springs(gap, 2.0, 0.5).direct);
    for i in [0, 1] {
        let ratio = (near[i] - alone[i]) / (far[i] - alone[i]);
        assert!((ratio - 4.0).abs() < 0.3, "{ratio}");
    }
    assert!((near[2] - alone[2]).abs() < 1e-4 * alone[2]);
}

/// Springs for normal loads, divided by `E*`, do not depend on Poisson's ratio.
///
/// Springs for shear depend on it, and at `ν = 0` they equal the springs for normal loads.
#[test]
fn only_shear_depends_on_poissons_ratio() {
    let [zero, some, half] = [0.0, 0.25, 0.5].map(|ratio| springs(0.3, 1.5, ratio));
    for i in [1, 2] {
        assert_eq!((zero.direct[i], zero.coupling[i]), (half.direct[i], half.coupling[i]));
    }
    let error = zero.error * zero.direct[1];
    assert!((zero.direct[0] - zero.direct[1]).abs() < 2.0 * error, "{zero:?}");
    assert!((zero.coupling[0] - zero.coupling[1]).abs() < 2.0 * error, "{zero:?}");
    assert!(zero.direct[0] > some.direct[0] && some.direct[0] > half.direct[0]);
    // The kernel x²/r³ of shear lies between 0 and 1/r, so α_x lies between α_y (1 − ν) and α_y.
    assert!(half.direct[0] > 0.5 * half.direct[1]);
}

#[test]
fn displacements_couple_positively_and_rotations_negatively() {
    for (gap, width) in [(0.017, 0.25), (0.05, 80.0), (1.0, 2.0), (80.0, 80.0)] {
        let row = springs(gap, width, 0.5);
        let [x, y, phi] = row.coupling;
        assert!(x > 0.0 && y > 0.0 && phi < 0.0, "{row:?}");
        assert!(row.direct.iter().all(|direct| *direct > 0.0), "{row:?}");
    }
}

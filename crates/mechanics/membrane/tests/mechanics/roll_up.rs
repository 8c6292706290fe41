//! Strip rolled up by a tip moment: the solution with elements is exact for any mesh.

use std::f64::consts::{PI, TAU};

use analytical::elastica::rolled_up;
use geometry::OutOfRange;
use nalgebra::Vector3;

use crate::cantilever::{cantilever, equilibrium};

/// Checks energy, shape and moments of a strip under a tip moment.
///
/// The moment rotates the tip by the angle `π half_turns`.
fn check(elements: usize, half_turns: u32) -> Result<(), OutOfRange> {
    let angle = PI * f64::from(half_turns);
    let gap = cantilever(elements, 0.1)?;
    let u = equilibrium(&gap, Vector3::new(0.0, 0.0, angle), 75 * half_turns);
    let energy = gap.response(&u);
    assert!((energy.bending_energy - 0.5 * angle.powi(2)).abs() < 1e-11 * angle.powi(2));
    assert!(energy.axial_energy < 1e-20);

    let poses = gap.rest() + &u;
    for (node, expected) in rolled_up(elements, angle).into_iter().enumerate() {
        let error = (poses.fixed_rows::<3>(3 * (node + 1)) - Vector3::from(expected)).amax();
        assert!(error < 1e-11, "{elements} elements, {angle} rad, node {node}: {error:e}");
    }
    for local in gap.local(&u) {
        assert!(
            (local.moments[0] + angle).abs() < 1e-10 && (local.moments[1] - angle).abs() < 1e-10
        );
    }
    Ok(())
}

#[test]
fn a_strip_rolls_up_to_half_a_circle() -> Result<(), OutOfRange> {
    (1..=9).try_for_each(|elements| check(elements, 1))
}

#[test]
fn a_strip_rolls_up_to_a_closed_circle() -> Result<(), OutOfRange> {
    for elements in [2, 3, 4, 7, 16, 50] {
        check(elements, 2)?;
        let u = equilibrium(&cantilever(elements, 0.1)?, Vector3::new(0.0, 0.0, -TAU), 150);
        assert!((u[3 * elements] + 1.0).abs() < 1e-11 && u[3 * elements + 1].abs() < 1e-11);
    }
    Ok(())
}

#[test]
fn a_strip_rolls_up_to_three_circles() -> Result<(), OutOfRange> {
    [5, 12, 31].into_iter().try_for_each(|elements| check(elements, 6))
}

//! Invariance under rigid motions: energies do not change, forces rotate with the body, to 1e-12.

use std::f64::consts::{PI, TAU};

use geometry::OutOfRange;
use membrane::{CorotationalBeam, Ends};
use nalgebra::{DMatrix, DVector, Rotation2, Vector2};
use proptest::prelude::*;

use crate::states::{bent_beam, bent_gap};

/// Returns the matrix that rotates the positions of poses (or forces) about the origin.
///
/// The matrix does not change the angles of the poses (or the moments).
fn turn(size: usize, angle: f64) -> DMatrix<f64> {
    let mut turn = DMatrix::identity(size, size);
    for node in (0..size).step_by(3) {
        turn.fixed_view_mut::<2, 2>(node, node).copy_from(Rotation2::new(angle).matrix());
    }
    turn
}

/// Returns the poses `q` after a rotation about the origin by `angle` and a translation `shift`.
fn moved(q: &DVector<f64>, angle: f64, shift: Vector2<f64>) -> DVector<f64> {
    let mut moved = turn(q.len(), angle) * q;
    for node in (0..q.len()).step_by(3) {
        moved[node] += shift.x;
        moved[node + 1] += shift.y;
        moved[node + 2] += angle;
    }
    moved
}

proptest! {
    #[test]
    fn forces_of_a_gap_rotate_with_the_gap(
        (gap, u) in bent_gap(), angle in -10.0..10.0, x in -5.0..5.0, y in -5.0..5.0,
    ) {
        let before = gap.response(&u);
        let poses = moved(&(gap.rest() + &u), angle, Vector2::new(x, y));
        let after = gap.response(&(poses - gap.rest()));
        let turn = turn(u.len(), angle);

        let energy = before.axial_energy + before.bending_energy;
        prop_assert!((after.axial_energy - before.axial_energy).abs() < 1e-12 * energy);
        prop_assert!((after.bending_energy - before.bending_energy).abs() < 1e-12 * energy);
        let force = (&after.force - &turn * &before.force).amax();
        prop_assert!(force < 1e-12 * before.force.amax(), "{force:e}");
        let tangent = (&after.tangent - &turn * &before.tangent * turn.transpose()).amax();
        prop_assert!(tangent < 1e-12 * before.tangent.amax(), "{tangent:e}");
    }

    #[test]
    fn full_turns_of_an_end_do_not_change_the_response(
        (beam, q) in bent_beam(), first in -9..=9, second in -9..=9,
    ) {
        let mut turned = q;
        turned[2] += TAU * f64::from(first);
        turned[5] += TAU * f64::from(second);
        let (before, after) = (beam.response(&q), beam.response(&turned));
        prop_assert!((after.bending_energy - before.bending_energy).abs() < 1e-12 * before.bending_energy);
        prop_assert!((after.force - before.force).amax() < 1e-12 * before.force.amax());
        prop_assert!((after.tangent - before.tangent).amax() < 1e-12 * before.tangent.amax());
    }

    #[test]
    fn internal_forces_are_in_equilibrium((gap, u) in bent_gap()) {
        let force = gap.response(&u).force;
        let q = gap.rest() + &u;
        let mut sum = [0.0; 3];
        for node in (0..q.len()).step_by(3) {
            sum[0] += force[node];
            sum[1] += force[node + 1];
            sum[2] += force[node + 2] + q[node] * force[node + 1] - q[node + 1] * force[node];
        }
        prop_assert!(sum.iter().all(|part| part.abs() < 1e-11 * force.amax().max(1.0)), "{sum:?}");
    }
}

/// Rotates an undeformed element by multiples of 45°, up to five full turns in either direction.
#[test]
fn a_rotated_undeformed_element_has_no_force() -> Result<(), OutOfRange> {
    let beam = CorotationalBeam::new(0.1, 1.0, 0.01)?;
    for eighth in -40..=40 {
        let phi = PI / 4.0 * f64::from(eighth);
        let q = Ends::new(0.0, 0.0, phi, 0.1 * phi.cos(), 0.1 * phi.sin(), phi);
        let local = beam.local(&q);
        assert!(local.rotations.iter().all(|theta| theta.abs() < 1e-14), "{eighth}: {local:?}");
        assert!(local.axial_force.abs() < 1e-14);
    }
    Ok(())
}

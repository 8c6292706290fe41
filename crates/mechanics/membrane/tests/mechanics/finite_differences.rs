//! Comparison of forces with differences of the energy, and of tangents with differences of forces.

use membrane::{Ends, NodePose, Response, RigidArm};
use nalgebra::{DMatrix, DVector, Vector2};
use proptest::prelude::*;

use crate::states::{bent_beam, bent_gap, bent_offset_beam};

const STEP: f64 = 2e-4;
const TOLERANCE: f64 = 1e-8;

/// Returns the derivative of `f` with respect to component `i` by a fourth-order difference.
fn derivative(
    f: impl Fn(&DVector<f64>) -> DVector<f64>,
    q: &DVector<f64>,
    i: usize,
) -> DVector<f64> {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|shift| {
        let mut moved = q.clone();
        moved[i] += shift * STEP;
        f(&moved)
    });
    (a - 8.0 * b + 8.0 * c - d) / (12.0 * STEP)
}

/// Energy (a vector with one entry), force and tangent at a state.
type Parts = (DVector<f64>, DVector<f64>, DMatrix<f64>);

/// Returns the largest error of the force and of the tangent.
///
/// Each error is relative to the largest entry of the force or of the tangent.
fn errors(parts: impl Fn(&DVector<f64>) -> Parts, q: &DVector<f64>) -> [f64; 2] {
    let (_, force, tangent) = parts(q);
    let mut errors: [f64; 2] = [0.0; 2];
    for i in 0..q.len() {
        let slope = derivative(|q| parts(q).0, q, i)[0];
        let column = derivative(|q| parts(q).1, q, i);
        errors[0] = errors[0].max((slope - force[i]).abs() / force.amax());
        errors[1] = errors[1].max((column - tangent.column(i)).amax() / tangent.amax());
    }
    errors
}

fn parts(response: &Response) -> Parts {
    (
        DVector::from_element(1, response.axial_energy + response.bending_energy),
        DVector::from_column_slice(response.force.as_slice()),
        DMatrix::from_column_slice(6, 6, response.tangent.as_slice()),
    )
}

/// Converts a vector with the poses of two bodies to [`Ends`].
fn ends(q: &DVector<f64>) -> Ends {
    q.fixed_rows::<6>(0).into_owned()
}

/// Returns the largest asymmetry of a matrix, relative to its largest entry.
fn asymmetry(tangent: &DMatrix<f64>) -> f64 {
    (tangent - tangent.transpose()).amax() / tangent.amax()
}

proptest! {
    #[test]
    fn derivatives_of_an_element_agree_with_finite_differences((beam, q) in bent_beam()) {
        let q = DVector::from_column_slice(q.as_slice());
        let [force, tangent] = errors(|q| parts(&beam.response(&ends(q))), &q);
        prop_assert!(force < TOLERANCE && tangent < TOLERANCE, "{force:e} {tangent:e}");
    }

    #[test]
    fn derivatives_of_an_element_between_arms_agree_with_finite_differences(
        (beam, q) in bent_offset_beam(),
    ) {
        let q = DVector::from_column_slice(q.as_slice());
        let [force, tangent] = errors(|q| parts(&beam.response(&ends(q))), &q);
        prop_assert!(force < TOLERANCE && tangent < TOLERANCE, "{force:e} {tangent:e}");
    }

    #[test]
    fn derivatives_of_a_gap_agree_with_finite_differences((gap, u) in bent_gap()) {
        let [force, tangent] = errors(|u| {
            let response = gap.response(u);
            let energy = response.axial_energy + response.bending_energy;
            (DVector::from_element(1, energy), response.force, response.tangent)
        }, &u);
        prop_assert!(force < TOLERANCE && tangent < TOLERANCE, "{force:e} {tangent:e}");
    }

    #[test]
    fn derivatives_of_an_arm_agree_with_finite_differences(
        x in -1.0..1.0, y in -1.0..1.0, body in prop::array::uniform3(-20.0..20.0),
    ) {
        let arm = RigidArm::new(Vector2::new(x, y));
        let q = DVector::from_column_slice(&body);
        let gradient = arm.gradient(q[2]);
        for i in 0..3 {
            let slope = derivative(|q| {
                let attached = arm.attached(&NodePose::new(q[0], q[1], q[2]));
                DVector::from_column_slice(attached.as_slice())
            }, &q, i);
            prop_assert!((slope - gradient.column(i)).amax() < TOLERANCE);
        }
        let turning = derivative(|q| DVector::from_column_slice(arm.gradient(q[2]).as_slice()), &q, 2);
        let second = arm.second_derivative(q[2]);
        prop_assert!((turning[6] - second.x).abs() < TOLERANCE);
        prop_assert!((turning[7] - second.y).abs() < TOLERANCE);
    }

    #[test]
    fn tangents_are_symmetric(
        (beam, ends) in bent_beam(), (offset, bodies) in bent_offset_beam(), (gap, u) in bent_gap(),
    ) {
        prop_assert!(asymmetry(&parts(&beam.response(&ends)).2) < 1e-14);
        prop_assert!(asymmetry(&parts(&offset.response(&bodies)).2) < 1e-14);
        prop_assert!(asymmetry(&gap.response(&u).tangent) < 1e-14);
    }
}

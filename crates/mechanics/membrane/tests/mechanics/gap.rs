//! Gap between two scales: closed forms and invalid parameters.

use geometry::OutOfRange;
use membrane::{GapMembrane, Section, Span};
use nalgebra::{DVector, Vector2, Vector3};

use crate::cantilever::equilibrium;

const THICKNESS: f64 = 0.125;

fn gap(span: Span, elements: usize) -> Result<GapMembrane, OutOfRange> {
    GapMembrane::new(Section::new(1.0, THICKNESS)?, span, elements)
}

/// A moment `M` bends only the free length `d`, so the right scale rotates by `φ = M d/EI`.
///
/// The rotation does not depend on the width of the bases, the axis offset or the mesh.
#[test]
fn rotation_in_pure_bending_depends_only_on_the_free_length() -> Result<(), OutOfRange> {
    let bending_stiffness = THICKNESS.powi(3) / 12.0;
    for (half_base, axis_offset) in [(0.0, 0.0), (0.5, 0.0), (0.5, THICKNESS / 2.0), (0.1, -0.3)] {
        for elements in [1, 2, 5] {
            let gap = gap(Span { half_base, gap: 0.2, axis_offset }, elements)?;
            let angle = 0.7;
            let moment = bending_stiffness * angle / 0.2;
            let u = equilibrium(&gap, Vector3::new(0.0, 0.0, moment), 40);
            assert!((u[3 * elements + 2] - angle).abs() < 1e-12);
            let energy = gap.response(&u);
            assert!((energy.bending_energy - 0.5 * moment * angle).abs() < 1e-15);
            assert!(energy.axial_energy < 1e-25);
        }
    }
    Ok(())
}

#[test]
fn a_gap_reports_its_numbers_of_elements_and_unknowns() -> Result<(), OutOfRange> {
    for elements in [1, 2, 5] {
        let gap = gap(Span { half_base: 0.5, gap: 0.1, axis_offset: 0.0 }, elements)?;
        assert_eq!((gap.elements(), gap.unknowns()), (elements, 3 * (elements + 1)));
    }
    Ok(())
}

/// Stretches a gap with the membrane axis at the depth `e` below the bases.
///
/// The load on the node of the right scale is the axial force `N` and the counter-clockwise couple
/// `N e`.
#[test]
fn tension_acts_below_the_base_for_a_positive_offset() -> Result<(), OutOfRange> {
    let (stretch, axis_offset) = (0.01, 0.0625);
    for elements in [1, 3] {
        let gap = gap(Span { half_base: 0.5, gap: 0.1, axis_offset }, elements)?;
        let mut u = DVector::zeros(gap.unknowns());
        for k in 1..=elements {
            u[3 * k] = stretch * k as f64 / elements as f64;
        }
        let tension = THICKNESS * stretch / 0.1;
        let response = gap.response(&u);
        let right = response.force.fixed_rows::<3>(3 * elements);
        assert!((right - Vector3::new(tension, 0.0, tension * axis_offset)).amax() < 1e-14);
        assert!((response.axial_energy - 0.5 * tension * stretch).abs() < 1e-15);
        assert!(gap.local(&u).iter().all(|local| (local.axial_force - tension).abs() < 1e-14));
    }
    Ok(())
}

/// Evaluates the moment of a small curvature in a gap displaced by up to a hundred thicknesses.
///
/// The only loss of precision is the rounding of the displacements.
#[test]
fn a_displaced_gap_loses_only_the_rounding_of_its_displacements() -> Result<(), OutOfRange> {
    let (half_base, angle) = (0.0125, 1e-3_f64);
    let gap = gap(Span { half_base, gap: 0.1, axis_offset: 0.0 }, 1)?;
    let moment = THICKNESS.powi(3) / 12.0 * angle / 0.1;
    for (displacement, tolerance) in [(0.0, 1e-12), (1.0, 1e-11), (100.0, 1e-9)] {
        let right = [
            half_base + 0.1 * (angle / 2.0).cos() + half_base * angle.cos() - gap.pitch(),
            0.1 * (angle / 2.0).sin() + half_base * angle.sin(),
        ];
        let [x, y] = right.map(|part| part + displacement);
        let u = DVector::from_vec(vec![displacement, displacement, 0.0, x, y, angle]);
        let error = (gap.local(&u)[0].moments[1] / moment - 1.0).abs();
        assert!(error < tolerance, "displaced by {displacement}: {error:e}");
    }
    Ok(())
}

#[test]
fn the_rest_state_has_no_force() -> Result<(), OutOfRange> {
    let gap = gap(Span { half_base: 0.5, gap: 0.1, axis_offset: 0.05 }, 4)?;
    assert_eq!(gap.unknowns(), 15);
    assert_eq!(gap.rest().len(), 15);
    assert!((gap.rest()[12] - 1.1).abs() < 1e-15 && (gap.pitch() - 1.1).abs() < 1e-15);
    assert!(gap.response(&DVector::zeros(15)).force.amax() < 1e-14);
    Ok(())
}

/// Compares the axis of an element in pure bending with an arc.
///
/// The axis is a cubic polynomial; its sag agrees with the arc to 1 %.
#[test]
fn the_deformed_axis_of_an_element_follows_the_arc() -> Result<(), OutOfRange> {
    let (angle, intervals) = (0.4, 10);
    let gap = gap(Span { half_base: 0.5, gap: 1.0, axis_offset: 0.1 }, 2)?;
    let mut u = DVector::zeros(gap.unknowns());
    let middle =
        Vector2::new(0.5 + 0.5 * (angle / 4.0_f64).cos(), -0.1 + 0.5 * (angle / 4.0_f64).sin());
    u[3] = middle.x - gap.rest()[3];
    u[4] = middle.y - gap.rest()[4];
    u[5] = angle / 2.0;
    let axis = gap.axis(&u, intervals);
    assert_eq!(axis.len(), 2 * intervals + 1);
    assert!((axis[0] - Vector2::new(0.5, -0.1)).norm() < 1e-15);
    assert!((axis[intervals] - middle).norm() < 1e-15);
    assert!((axis[2 * intervals] - Vector2::new(1.5, -0.1)).norm() < 1e-15);
    let chord = (axis[intervals] - axis[0]).normalize();
    let sag = (axis[intervals / 2] - axis[0]).perp(&chord);
    let arc = 0.5 * 0.25 * (angle / 4.0_f64).tan() * 2.0;
    assert!((sag - arc / 2.0).abs() < 0.01 * sag, "{sag} {arc}");
    Ok(())
}

#[test]
fn invalid_membranes_are_refused() {
    let span = Span { half_base: 0.5, gap: 0.1, axis_offset: 0.0 };
    for (span, elements, message) in [
        (span, 0, "number of elements per gap is 0, expected at least 1"),
        (Span { gap: 0.0, ..span }, 1, "gap is 0, expected a positive finite number"),
        (
            Span { half_base: -0.5, ..span },
            1,
            "half-width of the base is -0.5, expected a length of at least 0",
        ),
        (
            Span { axis_offset: f64::NAN, ..span },
            1,
            "offset of the membrane's axis is NaN, expected a finite length",
        ),
    ] {
        assert_eq!(gap(span, elements).unwrap_err().to_string(), message);
    }
}

//! Elastica of a gap: derivatives, closed forms, symmetry, convergence of elements to the elastica.

use analytical::elastica::tip;
use geometry::OutOfRange;
use membrane::{Elastica, GapMembrane, Section, Span};
use nalgebra::{DVector, Rotation2, Vector2, Vector3};
use proptest::prelude::*;

use crate::cantilever;

const THICKNESS: f64 = 0.125;
const AXIAL: f64 = THICKNESS;
const BENDING: f64 = THICKNESS * THICKNESS * THICKNESS / 12.0;

fn elastica(span: Span, order: usize) -> Result<Elastica, OutOfRange> {
    Elastica::new(Section::new(1.0, THICKNESS)?, span, order)
}

/// Boundary condition of the right scale.
#[derive(Clone, Copy)]
enum Right {
    /// Prescribed displacement and rotation of the right end of the membrane from rest.
    End(Span, Vector3<f64>),
    /// Prescribed force and moment on the right scale.
    Load(Vector3<f64>),
}

/// Returns the state of a gap under the boundary condition `right`.
///
/// The boundary condition is applied in equal steps from rest. Newton's method starts each step
/// from a linear extrapolation of the last two solutions.
fn equilibrium(gap: &Elastica, right: Right, steps: u32) -> Vec<f64> {
    let mut last = DVector::zeros(gap.unknowns());
    let mut z = last.clone();
    for step in 1..=steps {
        let part = f64::from(step) / f64::from(steps);
        let mut start: DVector<f64> = 2.0 * &z - &last;
        let (free, load) = match right {
            Right::End(span, end) => {
                start.rows_mut(gap.interior(), 3).copy_from(&scale_pose(span, part * end));
                (gap.interior(), Vector3::zeros())
            }
            Right::Load(load) => (gap.unknowns(), part * load),
        };
        last = std::mem::replace(&mut z, newton(gap, start, free, load));
    }
    z.as_slice().to_vec()
}

/// Returns the state in which the first `free` unknowns are in equilibrium, by Newton's method.
fn newton(gap: &Elastica, mut z: DVector<f64>, free: usize, load: Vector3<f64>) -> DVector<f64> {
    for _ in 0..60 {
        let mut residual: DVector<f64> = -gap.derivatives(z.as_slice()).gradient;
        let mut right = residual.fixed_rows_mut::<3>(gap.interior());
        right += load;
        let tangent = gap.derivatives(z.as_slice()).hessian.view((0, 0), (free, free)).into_owned();
        let change = tangent.lu().solve(&residual.rows(0, free)).expect("the tangent is regular");
        let mut moved = z.rows_mut(0, free);
        moved += &change;
        if change.amax() < 1e-11 {
            return z;
        }
    }
    panic!("no equilibrium under {load:?}");
}

/// Returns the displacement and rotation of the right scale at a given end of the membrane.
///
/// `end` contains the displacement and the rotation of the right end of the membrane.
fn scale_pose(span: Span, end: Vector3<f64>) -> Vector3<f64> {
    let (arm, (sin, cos)) = (Vector2::new(-span.half_base, -span.axis_offset), end[2].sin_cos());
    let turned = Vector2::new(cos * arm.x - sin * arm.y, sin * arm.x + cos * arm.y) - arm;
    Vector3::new(end[0] - turned.x, end[1] - turned.y, end[2])
}

/// Returns the displacement and rotation of the right scale in the state `z`.
fn pose(gap: &Elastica, z: &[f64]) -> Vector3<f64> {
    Vector3::from_column_slice(&z[gap.interior()..])
}

/// Returns the force and moment that hold the right scale in the state `z`.
fn load(gap: &Elastica, z: &[f64]) -> Vector3<f64> {
    gap.derivatives(z).gradient.fixed_rows::<3>(gap.interior()).into_owned()
}

fn energy(gap: &Elastica, z: &[f64]) -> f64 {
    let energies = gap.energies(z);
    energies.axial + energies.bending
}

/// Returns the derivative of `f` at 0 by a fourth-order difference with the step `h`.
fn slope(h: f64, f: impl Fn(f64) -> DVector<f64>) -> DVector<f64> {
    (f(-2.0 * h) - 8.0 * f(-h) + 8.0 * f(h) - f(2.0 * h)) / (12.0 * h)
}

fn span() -> impl Strategy<Value = Span> {
    (0.0..1.0, 0.2..1.0, -0.3..0.3).prop_map(|(half_base, gap, axis_offset)| Span {
        half_base,
        gap,
        axis_offset,
    })
}

/// Generates a random gap and a random state, which is not in equilibrium.
fn any_state() -> impl Strategy<Value = (Elastica, Vec<f64>)> {
    (span(), 2_usize..9, prop::collection::vec(-2.0..2.0, 12)).prop_map(|(span, order, mut z)| {
        let gap = elastica(span, order).unwrap();
        z.truncate(gap.unknowns());
        (gap, z)
    })
}

/// Generates a span, and a large displacement and rotation of the right end of the membrane.
fn pulled() -> impl Strategy<Value = (Span, Vector3<f64>)> {
    (span(), 0.2..2.0, -0.6..0.6, -0.9..0.9).prop_map(|(span, stretch, shift, phi)| {
        (span, Vector3::new(span.gap * stretch, span.gap * shift, phi))
    })
}

proptest! {
    #[test]
    fn the_hessian_is_the_derivative_of_the_gradient((gap, z) in any_state()) {
        let hessian = gap.derivatives(&z).hessian;
        prop_assert!(hessian == hessian.transpose());
        for i in 0..z.len() {
            let slope = slope(2e-4, |shift| {
                let mut moved = z.clone();
                moved[i] += shift;
                gap.derivatives(&moved).gradient
            });
            let error = (slope - hessian.column(i)).amax() / hessian.amax();
            prop_assert!(error < 1e-9, "{i}: {error:e}");
        }
    }

}

proptest! {
    // Each case follows an equilibrium path in 30 steps, so the number of cases is reduced.
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_force_is_the_gradient_of_the_energy((span, end) in pulled()) {
        let gap = elastica(span, 16).unwrap();
        let z = equilibrium(&gap, Right::End(span, end), 30);
        let force = load(&gap, &z);
        for i in 0..3 {
            let slope = slope(1e-3 * span.gap, |shift| {
                let mut moved = DVector::from_column_slice(&z);
                moved[gap.interior() + i] += shift;
                let solved = newton(&gap, moved, gap.interior(), Vector3::zeros());
                DVector::from_element(1, energy(&gap, solved.as_slice()))
            });
            let error = (slope[0] - force[i]).abs() / force.amax();
            prop_assert!(error < 1e-8, "{i}: {error:e}");
        }
    }

    /// Rotates a deformed gap by 180°.
    ///
    /// The rotation exchanges both scales and changes the sign of the axis offset. Energies, strain
    /// and force must be unchanged.
    #[test]
    fn rotation_by_180_degrees_exchanges_the_scales((span, end) in pulled()) {
        let gap = elastica(span, 16).unwrap();
        let other = elastica(Span { axis_offset: -span.axis_offset, ..span }, 16).unwrap();
        let back = Rotation2::new(-end[2]);
        let rest = Vector2::new(span.gap, 0.0);
        let shift = back * (rest + end.xy()) - rest;
        let ours = equilibrium(&gap, Right::End(span, end), 30);
        let turned = Vector3::new(shift.x, shift.y, -end[2]);
        let mirrored = Span { axis_offset: -span.axis_offset, ..span };
        let theirs = equilibrium(&other, Right::End(mirrored, turned), 30);
        let [a, b] = [gap.energies(&ours), other.energies(&theirs)];
        prop_assert!((a.axial - b.axial).abs() < 1e-10 * a.axial);
        prop_assert!((a.bending - b.bending).abs() < 1e-10 * a.axial);
        prop_assert!((gap.largest_strain(&ours) - other.largest_strain(&theirs)).abs() < 1e-9);
        let [force, rotated] = [load(&gap, &ours), load(&other, &theirs)];
        prop_assert!((rotated.xy() - back * force.xy()).amax() < 1e-10 * force.amax());
    }
}

/// Compares co-rotational elements with the elastica in a gap under a large force and a moment.
///
/// If the length of the elements is halved, the error decreases by a factor of 4. Extrapolation
/// from two meshes leaves a far smaller error.
#[test]
fn elements_converge_to_the_elastica_quadratically() -> Result<(), OutOfRange> {
    let span = Span { half_base: 0.2, gap: 0.5, axis_offset: 0.0 };
    let section = Section::new(1.0, THICKNESS)?;
    let applied = Vector3::new(0.05, 0.001, 0.0004);
    let limit = elastica(span, 24)?;
    let limit = pose(&limit, &equilibrium(&limit, Right::Load(applied), 100));
    let [coarse, middle, fine] = [32, 64, 128].map(|elements| {
        let gap = GapMembrane::new(section, span, elements).unwrap();
        let u = cantilever::equilibrium(&gap, applied, 100);
        u.fixed_rows::<3>(3 * elements) - limit
    });
    for [coarse, fine] in [[coarse, middle], [middle, fine]] {
        let order = (coarse.norm() / fine.norm()).log2();
        assert!((order - 2.0).abs() < 0.01, "order {order}");
    }
    assert!(fine.amax() > 1e-6, "{fine}");
    let extrapolated = (fine - (middle - fine) / 3.0).amax();
    assert!(extrapolated < 1e-8, "{extrapolated:e}");
    Ok(())
}

/// A moment bends the free length to a full circle.
///
/// The direction of the axis is exact at any order. The position, an integral of the cosine and
/// sine of the direction, is exact to round-off only at the higher order.
#[test]
fn pure_bending_deforms_a_gap_to_a_circle() -> Result<(), OutOfRange> {
    for (order, tolerance) in [(12, 1e-5), (20, 1e-13)] {
        let gap = elastica(Span { half_base: 0.3, gap: 1.0, axis_offset: 0.1 }, order)?;
        let angle = std::f64::consts::TAU;
        let z = equilibrium(&gap, Right::Load(Vector3::new(0.0, 0.0, BENDING * angle)), 10);
        let end = pose(&gap, &z);
        assert!((end - Vector3::new(-1.0, 0.0, angle)).amax() < tolerance, "{end}");
        let energies = gap.energies(&z);
        assert!((energies.bending - 0.5 * BENDING * angle * angle).abs() < 1e-13);
        assert!(energies.axial < 1e-25);
        assert!((gap.largest_strain(&z) - 0.5 * THICKNESS * angle).abs() < 1e-11);
        let axis = gap.axis(&z, 4);
        let radius = 1.0 / angle;
        let points = [[0.3, -0.1], [0.3 + radius, -0.1 + radius], [0.3, -0.1 + 2.0 * radius]];
        for (point, expected) in axis.iter().zip(points) {
            assert!((point - Vector2::from(expected)).amax() < 1e-12, "{point}");
        }
        assert!((axis[4] - axis[0]).amax() < 1e-12 && axis.len() == 5);
    }
    Ok(())
}

/// A force `N` along the membrane axis stretches the gap uniformly.
///
/// The axis lies `e` below the node of the scale, so the load also contains the couple `N e`.
#[test]
fn a_force_along_the_axis_stretches_a_gap_uniformly() -> Result<(), OutOfRange> {
    let (stretch, axis_offset) = (3.0, 0.0625);
    let gap = elastica(Span { half_base: 0.5, gap: 0.1, axis_offset }, 2)?;
    let tension = AXIAL * stretch;
    let z = equilibrium(&gap, Right::Load(Vector3::new(tension, 0.0, tension * axis_offset)), 2);
    assert!((pose(&gap, &z) - Vector3::new(0.1 * stretch, 0.0, 0.0)).amax() < 1e-13);
    let energies = gap.energies(&z);
    assert!((energies.axial - 0.5 * tension * 0.1 * stretch).abs() < 1e-14);
    assert!(energies.bending < 1e-25);
    assert!((gap.largest_strain(&z) - stretch).abs() < 1e-12);
    let axis = gap.axis(&z, 2);
    assert!((axis[1] - Vector2::new(0.5 + 0.05 * (1.0 + stretch), -axis_offset)).amax() < 1e-13);
    Ok(())
}

/// Compares a thin cantilever under a transverse tip load with elliptic integrals.
#[test]
fn a_thin_cantilever_agrees_with_the_closed_form() -> Result<(), OutOfRange> {
    let thickness = 1e-4_f64;
    let section = Section::new(12.0 / thickness.powi(3), thickness)?;
    let gap = Elastica::new(section, Span { half_base: 0.0, gap: 1.0, axis_offset: 0.0 }, 20)?;
    for force in (1..=10).map(f64::from) {
        let z = equilibrium(&gap, Right::Load(Vector3::new(0.0, force, 0.0)), 20);
        let [x, y, phi] = pose(&gap, &z).into();
        let error = (Vector3::new(y, -x, phi) - Vector3::from(tip(force).values())).amax();
        assert!(error < 1e-7, "PL²/EI = {force}: {error:e}");
    }
    Ok(())
}

/// Checks the error of the load at increasing orders in a stretched gap.
///
/// The length of the boundary layers is about a thirtieth of the gap.
#[test]
fn the_error_falls_faster_than_any_power_of_the_order() -> Result<(), OutOfRange> {
    let span = Span { half_base: 0.5, gap: 1.0, axis_offset: 0.0 };
    let turned = Right::End(span, Vector3::new(0.5, -0.5, 0.4));
    let limit = elastica(span, 64)?;
    let exact = load(&limit, &equilibrium(&limit, turned, 10));
    for (order, bound) in [(8, 1e-3), (12, 1e-4), (16, 2e-6), (24, 4e-9), (36, 1e-12)] {
        let gap = elastica(span, order)?;
        let error = (load(&gap, &equilibrium(&gap, turned, 10)) - exact).norm() / exact.norm();
        assert!(error < bound, "{order}: {error:e}");
    }
    Ok(())
}

/// Converts a state of order 32 to order 40, where the same polynomial represents the direction.
#[test]
fn a_state_transferred_to_a_higher_order_keeps_its_energies_and_axis() -> Result<(), OutOfRange> {
    let span = Span { half_base: 0.5, gap: 1.0, axis_offset: 0.0 };
    let [coarse, fine] = [elastica(span, 32)?, elastica(span, 40)?];
    let z = equilibrium(&coarse, Right::End(span, Vector3::new(0.5, -0.5, 0.4)), 10);
    let converted = coarse.transferred(&z, &fine);
    assert_eq!(converted.len(), fine.unknowns());
    let [a, b] = [coarse.energies(&z), fine.energies(&converted)];
    assert!((a.axial - b.axial).abs() < 1e-9 * a.axial, "{a:?} {b:?}");
    assert!((a.bending - b.bending).abs() < 1e-9 * a.bending, "{a:?} {b:?}");
    for (ours, theirs) in coarse.axis(&z, 5).iter().zip(fine.axis(&converted, 5)) {
        assert!((ours - theirs).amax() < 1e-9);
    }
    Ok(())
}

/// Compares a short state, which omits `ψ`, with the full state for `ψ = 0`.
#[test]
fn a_state_without_psi_equals_the_state_with_zero_psi() -> Result<(), OutOfRange> {
    let gap = elastica(Span { half_base: 0.5, gap: 0.3, axis_offset: 0.1 }, 6)?;
    let short = [0.1, -0.2, 0.3, 0.4, 0.5];
    let whole = [vec![0.0; 5], short.to_vec()].concat();
    assert_eq!(gap.derivatives(&short).gradient, gap.derivatives(&whole).gradient.rows(5, 5));
    assert_eq!(
        gap.derivatives(&short).hessian,
        gap.derivatives(&whole).hessian.view((5, 5), (5, 5))
    );
    assert_eq!(gap.energies(&short), gap.energies(&whole));
    assert_eq!(gap.largest_strain(&short), gap.largest_strain(&whole));
    assert_eq!(gap.axis(&short, 3), gap.axis(&whole, 3));
    assert_eq!(gap.transferred(&short, &gap), whole);
    Ok(())
}

#[test]
fn invalid_elasticas_are_refused() -> Result<(), OutOfRange> {
    let span = Span { half_base: 0.5, gap: 0.1, axis_offset: 0.0 };
    let order = "order of the membrane is 1, expected 2 to 128";
    assert_eq!(elastica(span, 1).unwrap_err().to_string(), order);
    assert!(elastica(span, 129).is_err() && elastica(span, 128).is_ok());
    let closed = Span { gap: 0.0, ..span };
    let gap = "gap is 0, expected a positive finite number";
    assert_eq!(elastica(closed, 4).unwrap_err().to_string(), gap);
    let whole = elastica(span, 4)?;
    assert_eq!(whole.over(closed).unwrap_err().to_string(), gap);
    let other = Span { gap: 0.2, ..span };
    assert_eq!(whole.over(other)?, elastica(other, 4)?);
    assert_eq!((whole.order(), whole.interior(), whole.unknowns()), (4, 5, 8));
    Ok(())
}

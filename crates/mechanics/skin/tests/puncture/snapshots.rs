//! Tests of snapshots: equilibria of a row at given points of its path.

use approx::assert_relative_eq;
use contact::CornerEdge;
use skin::puncture::{
    At, PunctureParameters, RowSnapshot, ScaleState, Snapshots, snapshots, snapshots_to_end,
};
use skin::{Common, Design};
use substrate::Calibrations;

use crate::samples::{folding, on_row, settled, solve, spread, springs};

fn shots(design: &Design, parameters: &PunctureParameters, at: &[At]) -> Snapshots {
    let springs = springs(design, parameters, &Calibrations::default());
    snapshots(design, &springs, &Common::default(), parameters, at).unwrap()
}

fn shot(design: &Design, at: At) -> RowSnapshot {
    shots(design, &on_row(41), &[at]).at.remove(0).expect("the path reaches this point")
}

#[test]
fn a_snapshot_is_an_equilibrium_of_the_path() {
    for design in spread() {
        let puncture = solve(&design, &on_row(41));
        let point = puncture.path[puncture.path.len() / 3];
        let here = shot(&design, At::Displacement(point.displacement));
        assert_relative_eq!(here.displacement, point.displacement, max_relative = 1e-10);
        assert_relative_eq!(here.force, point.force, max_relative = 1e-8);
        assert_relative_eq!(here.tilt_deg, point.tilt_deg, max_relative = 1e-8);
        let end = shot(&design, At::Tilt(10.0));
        // The snapshot solves for all scales, the puncture only for scales near contacts.
        let force = puncture.measures.critical_force.unwrap();
        assert_relative_eq!(end.force, force, max_relative = 1e-13);
        assert_eq!(Some(end.contacts.len()), puncture.measures.contacts);
        for (ours, theirs) in end.scales.iter().zip(&puncture.scales) {
            assert_eq!(ours.scale, theirs.scale);
            let numbers =
                |s: &ScaleState| [s.displacement[0], s.displacement[1], s.rotation_deg, s.reaction];
            assert_relative_eq!(numbers(ours)[..], numbers(theirs)[..], epsilon = 1e-13);
        }
        assert_eq!(end.scales.len(), puncture.scales.len());
    }
}

#[test]
fn snapshots_have_exactly_the_requested_tilt_or_force() {
    for design in spread() {
        for tilt in [0.0, 0.37, 3.21, 7.77] {
            assert_relative_eq!(shot(&design, At::Tilt(tilt)).tilt_deg, tilt, epsilon = 1e-9);
        }
        let peak = solve(&design, &on_row(41)).measures.peak_force.unwrap();
        let force = 0.613 * peak;
        let close = 2e-12 * (1.0 + force);
        assert_relative_eq!(shot(&design, At::Force(force)).force, force, epsilon = close);
    }
}

#[test]
fn vertical_forces_balance_on_every_scale() {
    for design in spread() {
        for tilt in [2.0, 6.0, 10.0] {
            let RowSnapshot { force, scales, contacts, .. } = shot(&design, At::Tilt(tilt));
            let first = scales[0].scale;
            let mut vertical: Vec<f64> = scales.iter().map(|scale| scale.reaction).collect();
            let punctured = usize::try_from(-first).unwrap();
            vertical[punctured] -= force * design.length;
            for contact in &contacts {
                vertical[contact.left] += contact.force[1];
                vertical[contact.left + 1] -= contact.force[1];
            }
            for rest in vertical {
                assert_relative_eq!(rest, 0.0, epsilon = 1e-8 * force.abs().max(1.0));
            }
        }
    }
}

#[test]
fn the_position_of_a_contact_is_its_touching_corner() {
    let design = folding();
    let RowSnapshot { scales, contacts, .. } = shot(&design, At::Tilt(10.0));
    let row = design.row().unwrap();
    assert!(contacts.iter().any(|contact| contact.corner_edge == CornerEdge::BottomLeftOnBase));
    for contact in contacts {
        let of = contact.left + usize::from(!contact.corner_edge.corner_is_left());
        let (sin, cos) = scales[of].rotation_deg.to_radians().sin_cos();
        let arm = row.scale().corner(contact.corner_edge.corner());
        let [x, y] = scales[of].displacement;
        let position = of as f64 * row.pitch() + x + cos * arm.x - sin * arm.y;
        assert_relative_eq!(contact.point[0], position, epsilon = 1e-9);
        assert_relative_eq!(contact.point[1], y + sin * arm.x + cos * arm.y, epsilon = 1e-9);
        assert!(contact.approach >= 0.0);
    }
}

#[test]
fn snapshots_extend_the_path_beyond_the_critical_tilt() {
    let points = [At::Tilt(5.0), At::Tilt(25.0)];
    let Snapshots { puncture, at, .. } = shots(&settled(), &on_row(41), &points);
    let tilts: Vec<f64> = at.iter().flatten().map(|shot| shot.tilt_deg).collect();
    assert_relative_eq!(tilts[0], 5.0, epsilon = 1e-9);
    assert_relative_eq!(tilts[1], 25.0, epsilon = 1e-9);
    let steepest = puncture.path.iter().map(|point| point.tilt_deg).fold(0.0, f64::max);
    assert!(steepest >= 25.0);
}

#[test]
fn snapshots_to_end_stop_at_the_critical_state() {
    let (design, parameters) = (settled(), on_row(41));
    let springs = springs(&design, &parameters, &Calibrations::default());
    let points = [At::Tilt(5.0), At::Tilt(25.0)];
    let solved = snapshots_to_end(&design, &springs, &Common::default(), &parameters, &points);
    let Snapshots { puncture, at, end, is_critical } = solved.unwrap();
    assert!(is_critical && at[0].is_some() && at[1].is_none());
    assert_relative_eq!(end.tilt_deg, 10.0, epsilon = 1e-9);
    assert_eq!(Some(end.force), puncture.path.last().map(|point| point.force));
}

#[test]
fn an_unreachable_point_has_no_snapshot() {
    let at = shots(&settled(), &on_row(11), &[At::Force(1e6), At::Tilt(1.0)]).at;
    assert!(at[0].is_none() && at[1].is_some());
}

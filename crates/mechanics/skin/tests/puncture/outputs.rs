//! Tests of the meaning of measures, events, scales and iterations.

use std::collections::{HashMap, HashSet};

use approx::assert_relative_eq;
use skin::puncture::{self, At, Needle, Puncture, PunctureParameters, PuncturePoint};
use skin::{Base, Common, ContactChange, ContactEvent, Status};

use solver::{Settings, Termination};
use substrate::{Calibrations, calibrate};

use crate::samples::{design, domino, on_row, solve, solve_as, solve_with, spread};
use crate::{complete, end};

fn solved() -> Vec<(skin::Design, Puncture)> {
    let known = Calibrations::default();
    spread().into_iter().map(|d| (d, solve_with(&known, &d, &on_row(41)))).collect()
}

#[test]
fn measures_match_the_end_of_the_path() {
    for (design, puncture) in solved() {
        let (measures, end) = (complete(&puncture), end(&puncture));
        assert_relative_eq!(end.tilt_deg, 10.0, max_relative = 1e-12);
        assert_eq!(measures.critical_force, Some(end.force));
        assert_eq!(measures.critical_displacement, Some(end.displacement));
        assert_eq!(measures.contacts, Some(end.contacts));
        let peak = puncture.path.iter().map(|point| point.force).fold(0.0, f64::max);
        assert_eq!(measures.peak_force, Some(peak));
        let secant = 4.0 / 3.0 * end.force * design.length / end.displacement;
        assert_relative_eq!(measures.secant_stiffness.unwrap(), secant, max_relative = 1e-14);
    }
}

/// The corners of a base lie above or below its node by the half-width times the sine of the
/// rotation.
#[test]
fn penetration_is_the_depth_of_the_deepest_base_corner() {
    for (design, puncture) in solved() {
        let measures = complete(&puncture);
        let corners = puncture.scales.iter().flat_map(|scale| {
            let rise = design.half_base() * scale.rotation_deg.to_radians().sin();
            [rise, -rise].map(|rise| -(scale.displacement[1] + rise))
        });
        let deepest = corners.fold(f64::NEG_INFINITY, f64::max);
        assert_relative_eq!(measures.penetration.unwrap(), deepest, max_relative = 1e-12);
        let nodes = puncture.scales.iter().map(|scale| -scale.displacement[1]);
        assert_eq!(measures.sink, Some(nodes.fold(f64::NEG_INFINITY, f64::max)));
    }
}

#[test]
fn the_reactions_of_the_substrate_add_up_to_the_load() {
    for (design, puncture) in solved() {
        let sum: f64 = puncture.scales.iter().map(|scale| scale.reaction).sum();
        assert_relative_eq!(sum, end(&puncture).force * design.length, max_relative = 1e-9);
    }
}

/// Returns the corners and edges that are in contact after all `events`.
///
/// The key is the left scale of the pair and true for the upper level. Flush edges have two
/// contacts at one level. If the force is handed over or a corner is reached, one contact remains.
fn closed_by(
    events: &[ContactEvent<PuncturePoint>],
) -> HashMap<(i64, bool), HashSet<&'static str>> {
    let mut closed = HashMap::new();
    for event in events {
        let kind = event.corner_edge.name();
        let level = (event.left_scale.unwrap(), kind.starts_with('T'));
        let kinds: &mut HashSet<_> = closed.entry(level).or_default();
        match event.change {
            ContactChange::Closed => assert!(kinds.insert(kind), "closed twice: {event:?}"),
            ContactChange::Opened => assert!(kinds.remove(kind), "opened while open: {event:?}"),
            _ => {
                assert!(!kinds.is_empty(), "changed while open: {event:?}");
                *kinds = [kind].into();
            }
        }
        assert!(kinds.len() <= 2, "{event:?}");
    }
    closed.retain(|_, kinds| !kinds.is_empty());
    closed
}

#[test]
fn numbers_of_contacts_and_engaged_scales_follow_from_the_events() {
    for (_, puncture) in solved() {
        let (measures, closed) = (complete(&puncture), closed_by(&puncture.events));
        assert_eq!(measures.contacts, Some(closed.values().map(HashSet::len).sum()));
        let engaged: HashSet<i64> = closed.keys().flat_map(|&(left, _)| [left, left + 1]).collect();
        assert_eq!(measures.engaged_scales, Some(engaged.len()));
        let first = puncture.events.iter().find(|event| event.change == ContactChange::Closed);
        assert_eq!(measures.first_contact_displacement, first.map(|e| e.point.displacement));
        assert!(puncture.events.iter().all(|event| puncture.path.contains(&event.point)));
    }
}

#[test]
fn every_point_of_the_path_has_its_iterations() {
    for (_, puncture) in solved() {
        let steps: HashSet<usize> = puncture.history.iter().map(|i| i.step).collect();
        assert_eq!(steps, (1..puncture.path.len()).collect());
        for step in puncture.history.chunk_by(|a, b| a.step == b.step) {
            assert!(step.iter().enumerate().all(|(k, iteration)| iteration.iteration == k));
        }
    }
}

#[test]
fn a_path_that_stops_early_keeps_the_measures_of_its_start_and_of_its_peak() {
    let solver = Settings { max_points: 20, ..Settings::default() };
    let (known, common) = (Calibrations::default(), Common { solver, ..Common::default() });
    let cut = solve_as(&known, &domino(), &common, &on_row(41));
    let whole = solve(&domino(), &on_row(41));
    assert_eq!(cut.status, Status::Stopped(Termination::TooManyPoints));
    assert_eq!(cut.path.len(), 21);
    assert_eq!(cut.path[..], whole.path[..21]);
    let cut_path = cut.path;
    let (cut, whole) = (cut.measures, complete(&whole));
    assert!(cut.first_contact_displacement.is_some());
    assert_eq!(cut.first_contact_displacement, whole.first_contact_displacement);
    assert_eq!(cut.initial_stiffness, whole.initial_stiffness);
    assert_eq!(cut.scales, 41);
    let peak = cut_path.iter().max_by(|a, b| a.force.total_cmp(&b.force)).unwrap();
    assert_eq!(
        [cut.peak_force, cut.peak_displacement, cut.peak_tilt_deg],
        [peak.force, peak.displacement, peak.tilt_deg].map(Some)
    );
    assert_eq!(cut.critical_force.or(cut.critical_displacement), None);
    assert_eq!(cut.penetration.or(cut.sink).or(cut.max_stiffness).or(cut.secant_stiffness), None);
    assert_eq!(cut.contacts.or(cut.engaged_scales), None);
}

/// For a depth beyond the end of the path, the force at this depth is the final force.
#[test]
fn force_at_a_depth_matches_the_snapshot_at_that_depth() {
    let design = design(0.2, 0.5, 60.0, Base::L);
    let end = solve(&design, &PunctureParameters::default()).measures;
    assert_eq!(end.force_at_depth, None);
    let deepest = end.critical_displacement.unwrap();
    for needle in [Needle::Free, Needle::Guided { friction: 0.3 }] {
        let depth = 0.4 * deepest;
        let [shallow, deep] = [depth, 10.0].map(|depth| PunctureParameters {
            depth: Some(depth),
            needle,
            ..Default::default()
        });
        let springs = calibrate(&design.footprint(0.5).unwrap()).unwrap();
        let at = [At::Displacement(depth)];
        let snapshots =
            puncture::snapshots(&design, &springs, &Common::default(), &shallow, &at).unwrap();
        let there = snapshots.at[0].as_ref().unwrap();
        let measured = snapshots.puncture.measures.force_at_depth.unwrap();
        assert_relative_eq!(measured, there.force, max_relative = 1e-12);
        let beyond = solve(&design, &deep).measures;
        assert_eq!(beyond.force_at_depth, beyond.critical_force);
        assert!(measured < beyond.force_at_depth.unwrap());
    }
}

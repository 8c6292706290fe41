//! Rows under a guided needle with a round tip.

use super::*;
use crate::contacts::OutlinePart;
use crate::puncture::needle::{reach, unknowns};

/// Gap, length and slant; radius of the tip; friction; load position.
///
/// The tips move from faces to corners, touch several scales, stick, and slide in both directions.
const TIPS: [([f64; 3], f64, f64, f64); 9] = [
    ([0.1, 1.0, 0.0], 0.1, 0.0, 1.0),
    ([0.1, 0.2, 0.0], 1.0, 0.0, 1.0),
    ([0.1, 1.0, 45.0], 0.03, 0.0, 1.0),
    ([0.1, 1.0, 60.0], 0.5, 0.0, 1.0),
    ([0.3, 0.5, 45.0], 0.5, 0.3, 1.0),
    ([0.1, 0.2, 0.0], 1.0, 0.3, 1.0),
    ([0.1, 1.0, 60.0], 0.1, 0.15, 0.98),
    ([0.2, 0.8, 30.0], 0.5, 0.1, 1.1),
    ([0.1, 1.0, 0.0], 0.2, 0.2, 0.95),
];

#[test]
fn work_of_a_round_tip_is_stored_or_dissipated() {
    let most = TIPS.map(|(of, radius, friction, position)| {
        let dissipated = dissipated_fraction(round_path(of, [radius, friction, position], 0.01));
        assert_eq!(dissipated > 1e-12, friction > 0.0, "{of:?} {dissipated}");
        dissipated
    });
    assert!(most.into_iter().fold(0.0, f64::max) > 0.01, "{most:?}");
}

/// The paths must contain tips that stick and slide, each on tops and on other outline parts.
#[test]
fn tangent_of_a_round_tip_matches_finite_differences() {
    let mut tip_states = HashSet::new();
    for (of, radius, friction, position) in TIPS {
        for_segments(round_path(of, [radius, friction, position], 0.1), |path, from, to| {
            if path.spans(from, to)[0].abs() < 1e-6 {
                return;
            }
            let Some(between) = path.between(from, to, 0.5) else { return };
            for touch in between.state.mode.needle.tip_contacts.iter().flatten() {
                tip_states.insert((
                    touch.part == OutlinePart::Top,
                    std::mem::discriminant(&touch.tip_state),
                ));
            }
            check_tangent(path.system(), &between.state, 1e-5).unwrap();
        });
    }
    assert_eq!(tip_states.len(), 4);
}

/// Compares derivatives with respect to radius, load position and length with differences.
///
/// The tips end on a face, on a corner, or on two or three scales.
#[test]
fn derivatives_of_a_round_tip_match_differences() {
    let by_radius: Change =
        |input, h| input.parameters.needle_radius = input.parameters.needle_radius.map(|r| r + h);
    let changes = [(by_radius, 2e-6), (move_load_right, 2e-6), (longer, 2e-6)];
    for (gap, length, slant, radius, friction, position) in [
        (0.1, 1.0, 0.0, 0.5, 0.0, 0.8),
        (0.5, 1.0, 0.0, 0.2, 0.0, 0.9),
        (0.1, 1.0, 45.0, 0.03, 0.0, 0.95),
        (0.1, 1.0, 60.0, 0.5, 0.0, 1.04),
        (0.3, 0.5, 45.0, 0.5, 0.0, 1.2),
        (0.2, 0.2, 30.0, 1.0, 0.0, 0.7),
        (0.5, 1.0, 0.0, 0.2, 0.1, 0.9),
        (0.1, 0.2, 0.0, 0.1, 0.3, 0.9),
        (0.1, 1.0, 60.0, 0.5, 0.2, 0.97),
        (0.3, 0.7, 60.0, 0.5, 0.3, 0.9),
    ] {
        let parameters = PunctureParameters {
            needle: Needle::Guided { friction },
            needle_radius: Some(radius),
            load_position: position,
            ..PunctureParameters::default()
        };
        let design = design(gap, length, slant);
        derivatives_are_differences(design, Common::default(), parameters, &changes);
    }
}

/// Starts the path of a row of 21 scales under a round tip.
///
/// `needle` holds radius, friction and load position.
fn round_path([gap, length, slant]: [f64; 3], needle: [f64; 3], step: f64) -> Continuation<Chain> {
    path_of(&design(gap, length, slant), needle, step)
}

/// Starts the path of a row of 21 scales of a design under a round tip.
fn path_of(
    design: &Design,
    [radius, friction, load_position]: [f64; 3],
    step: f64,
) -> Continuation<Chain> {
    let reach = reach(radius, 2.0 * design.half_base() + design.gap).unwrap();
    let needle = unknowns(reach, friction > 0.0);
    let layout = RowLayout { left: 10, right: 10, needle, contacts: 6 };
    let law = law(design, Law::PRINTED, HARD);
    let parameters = PunctureParameters {
        load_position,
        needle: Needle::Guided { friction },
        needle_radius: Some(radius),
        ..PunctureParameters::default()
    };
    let chain = whole(&(&springs(design)).into(), design, law, layout, &parameters);
    let settings = Settings { first_step: step, max_step: step, ..Settings::default() };
    let rest = chain.at_rest();
    Continuation::new(chain, rest, settings)
}

/// Corner and top are at the same distance up to round-off. The first tilt moves the tip onto the
/// top.
#[test]
fn a_tip_set_down_on_a_corner_starts_on_the_top() {
    for (length, radius) in [(2.0, 0.7), (5.0, 0.3), (9.5, 0.7), (9.5, 2.0)] {
        for (friction, position) in [(0.0, 0.0), (0.0, 1.0), (0.3, 0.0), (0.3, 1.0)] {
            let design = Design { width: 16.0, ..design(1.0, length, 0.0) };
            let mut path = path_of(&design, [radius, friction, position], 0.01);
            let start = path.point().state.mode.needle.part(0);
            assert_eq!(start, Some(OutlinePart::Top), "{length} {radius} {friction} {position}");
            assert_eq!(path.by_ref().take(3).count(), 3, "{:?}", path.termination());
        }
    }
}

/// At 78° along the arc, the tip lies below the bases of scales, between their extended side faces.
#[test]
fn a_tip_on_a_convex_body_does_not_touch_scales_far_along_the_arc() {
    let design = design(1.145, 4.632, 54.87);
    let [three, five] = [3, 5].map(|scales| {
        let parameters = PunctureParameters {
            scales: RowLength::Scales(scales),
            load_position: 0.0,
            needle: Needle::Guided { friction: 0.3 },
            needle_radius: Some(0.847),
            curvature: 1.0 / 8.47,
            ..PunctureParameters::default()
        };
        let puncture =
            puncture::solve(&design, &springs(&design), &Common::default(), &parameters).unwrap();
        assert_eq!(puncture.status, Status::Complete);
        puncture.measures.critical_force.unwrap()
    });
    assert_relative_eq!(three, five, max_relative = 1e-2);
}

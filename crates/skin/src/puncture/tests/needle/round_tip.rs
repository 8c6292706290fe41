//! Rows under a guided needle with a round tip.

use super::*;
use crate::puncture::needle::{reach, unknowns};

/// What a round tip does is stored, on the way from face to corner and from scale to scale.
#[test]
fn work_of_a_round_tip_is_stored() {
    for (gap, length, slant, radius) in [
        (0.1, 1.0, 0.0, 0.1),
        (0.1, 0.2, 0.0, 1.0),
        (0.1, 1.0, 45.0, 0.03),
        (0.1, 1.0, 60.0, 0.5),
        (0.3, 0.5, 45.0, 0.5),
    ] {
        let design = design(gap, length, slant);
        let (mut done, mut off) = (0.0, 0.0_f64);
        for_segments(round_path(&design, radius, 0.01), |path, from, to| {
            done += work(path, from, to);
            let chain = path.system();
            let stored = chain.substrate_energy(&to.state) + chain.contacts.energy(&to.state);
            off = off.max((done - stored).abs());
        });
        assert!(off < 1e-8 * done, "{:e} {design:?} {radius}", off / done);
    }
}

/// The tangent of a round tip on faces and corners agrees with finite differences.
#[test]
fn the_tangent_of_a_round_tip() {
    for (gap, length, slant, radius) in [(0.1, 0.2, 0.0, 1.0), (0.1, 1.0, 60.0, 0.5)] {
        let design = design(gap, length, slant);
        for_segments(round_path(&design, radius, 0.1), |path, from, to| {
            let Some(between) = path.between(from, to, 0.5) else { return };
            check_tangent(path.system(), &between.state, 1e-5).unwrap();
        });
    }
}

/// Derivatives by the radius, the place and the length are those of differences of whole solutions: on a face, on a corner, between two
/// scales, on three of them.
#[test]
fn derivatives_of_a_round_tip() {
    let by_radius: Change =
        |input, h| input.parameters.needle_radius = input.parameters.needle_radius.map(|r| r + h);
    let changes = [(by_radius, 2e-6), (set_down_further_right, 2e-6), (longer, 2e-6)];
    for (gap, length, slant, radius, position) in [
        (0.1, 1.0, 0.0, 0.5, 0.8),
        (0.5, 1.0, 0.0, 0.2, 0.9),
        (0.1, 1.0, 45.0, 0.03, 0.95),
        (0.1, 1.0, 60.0, 0.5, 1.04),
        (0.3, 0.5, 45.0, 0.5, 1.2),
        (0.2, 0.2, 30.0, 1.0, 0.7),
    ] {
        let parameters = PunctureParameters {
            needle: Needle::Guided { friction: 0.0 },
            needle_radius: Some(radius),
            load_position: position,
            ..PunctureParameters::default()
        };
        let design = design(gap, length, slant);
        derivatives_are_differences(design, Common::default(), parameters, &changes);
    }
}

/// The path of a row of 21 scales under a round tip.
fn round_path(design: &Design, radius: f64, step: f64) -> Path<Chain> {
    let reach = reach(radius, 2.0 * design.half_base() + design.gap).unwrap();
    let layout = Layout { left: 10, right: 10, needle: unknowns(reach), pair: 6 };
    let law = law(design, Law::PRINTED, HARD);
    let parameters =
        PunctureParameters { needle_radius: Some(radius), ..parameters(design, 0.0, 0.0) };
    let chain = whole(&(&springs(design)).into(), design, law, layout, &parameters);
    let settings = Settings { first_step: step, max_step: step, ..Settings::default() };
    let rest = chain.at_rest();
    Path::new(chain, rest, settings)
}

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

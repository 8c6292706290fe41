//! Tests of several load positions, and of the weakest position among them.

use approx::assert_relative_eq;
use skin::puncture::{
    self, LoadPosition, Needle, NumberList, Puncture, PunctureParameters, Weakest,
};
use skin::{Base, Common, Design, Status};
use solver::Termination;
use substrate::{Calibrations, SubstrateLaw};

use crate::samples::{design, solve_as};

const FREE: Needle = Needle::Free;
const GUIDED: Needle = Needle::Guided { friction: 0.3 };

fn parameters(needle: Needle, places: usize) -> PunctureParameters {
    PunctureParameters { needle, places: Some(places), ..PunctureParameters::default() }
}

fn solve(design: &Design, parameters: &PunctureParameters) -> Puncture {
    solve_as(&Calibrations::default(), design, &Common::default(), parameters)
}

/// Compares every third position and the weakest one with separate punctures, to the last bit.
#[test]
fn the_weakest_position_has_the_smallest_force_of_single_punctures() {
    let known = Calibrations::default();
    let cases = [
        (design(0.1, 1.0, 75.0, Base::L), GUIDED, SubstrateLaw::Linear, 0.0, Some(0.3)),
        (design(0.1, 0.2, 45.0, Base::L), GUIDED, SubstrateLaw::NeoHookean, 0.1, Some(0.6)),
        (design(0.3, 0.5, 60.0, Base::TwoL), FREE, SubstrateLaw::Linear, 0.1, None),
        (design(0.1, 0.2, 75.0, Base::L), FREE, SubstrateLaw::NeoHookean, 0.0, Some(1.0)),
    ];
    for (design, needle, substrate_law, friction, expected) in cases {
        let common = Common { friction, ..Common::default() };
        let tried = PunctureParameters { substrate_law, ..parameters(needle, 11) };
        let puncture = solve_as(&known, &design, &common, &tried);
        let weakest = puncture.measures.weakest;
        let mut smallest = f64::INFINITY;
        for (k, place) in puncture.places.iter().enumerate() {
            smallest = smallest.min(place.force.unwrap_or(f64::INFINITY));
            if k % 3 != 0 && weakest.position != Some(place.position) {
                continue;
            }
            let there =
                PunctureParameters { load_position: k as f64 / 10.0, places: None, ..tried };
            let whole = solve_as(&known, &design, &common, &there);
            assert_eq!((place.position, place.status), (there.load_position, whole.status));
            assert_eq!(place.force, whole.measures.critical_force);
            assert_eq!(place.critical_event, whole.measures.passage.critical_event);
        }
        assert_eq!(weakest.force, Some(smallest), "{design:?}");
        assert!(expected.is_none_or(|place| weakest.position == Some(place)), "{weakest:?}");
        // All other measures refer to the load position of the parameters.
        let own = PunctureParameters { places: None, ..tried };
        let own = solve_as(&known, &design, &common, &own).measures;
        assert_eq!(
            puncture::PunctureMeasures { weakest: Weakest::default(), ..puncture.measures },
            own
        );
    }
}

/// An upright scale tilts to the side of the load, and not at all under a load in its middle.
#[test]
fn positions_on_an_upright_scale_are_mirror_images() {
    for needle in [FREE, GUIDED] {
        let upright = design(0.1, 1.0, 0.0, Base::L);
        let Puncture { places, measures, .. } = solve(&upright, &parameters(needle, 5));
        for k in 0..2 {
            let [left, right] = [places[k], places[4 - k]];
            assert_relative_eq!(left.force.unwrap(), right.force.unwrap(), max_relative = 1e-8);
            assert_relative_eq!(left.tilt_deg.unwrap(), -10.0, max_relative = 1e-9);
            assert_relative_eq!(right.tilt_deg.unwrap(), 10.0, max_relative = 1e-9);
        }
        assert_eq!((places[2].status, places[2].force), (Status::Untilted, None));
        // Both corners are equally weak; the first position is reported.
        assert_eq!(measures.weakest.position, Some(0.0));
        assert_eq!(measures.weakest.force, places.iter().filter_map(|p| p.force).reduce(f64::min));
    }
}

/// A frictionless needle exactly on the left corner of this design stops early, at a smaller force
/// than the critical forces of other positions. This position may be weaker than all others, so no
/// weakest force is reported.
#[test]
fn a_path_that_stops_at_a_small_force_leaves_no_weakest_force() {
    let lost = design(0.1, 1.0, 75.0, Base::L);
    let slippery = parameters(Needle::Guided { friction: 0.0 }, 11);
    let Puncture { status, places, measures, .. } = solve(&lost, &slippery);
    assert_eq!((status, measures.weakest), (Status::Complete, Weakest::default()));
    assert_eq!(Weakest::from_positions(&places), Err(places[0].status));
    assert!(places[0].force.is_none() && places[1..].iter().all(|place| place.force.is_some()));

    let held = LoadPosition {
        position: 0.5,
        status: Status::Complete,
        force: Some(1.0),
        displacement: None,
        tilt_deg: None,
        critical_event: None,
        largest_force: Some(2.0),
    };
    let status = Status::Stopped(Termination::Unloaded);
    for (largest_force, status, expected) in [
        (Some(0.9), status, Err(status)),
        (Some(1.1), status, Ok(Some(1.0))),
        (None, Status::Untilted, Ok(Some(1.0))),
    ] {
        let other = LoadPosition { force: None, largest_force, status, ..held };
        let weakest = Weakest::from_positions(&[held, other]);
        assert_eq!(weakest.map(|weakest| weakest.force), expected);
    }
    let stopped = LoadPosition { force: None, largest_force: Some(1.0), status, ..held };
    assert_eq!(Weakest::from_positions(&[stopped]), Err(status));
    assert_eq!(Weakest::from_positions(&[]), Ok(Weakest::default()));
}

#[test]
fn a_single_load_position_is_rejected() {
    let design = design(0.1, 1.0, 0.0, Base::L);
    let springs = substrate::calibrate(&design.footprint(0.5).unwrap()).unwrap();
    let solved = puncture::solve(&design, &springs, &Common::default(), &parameters(FREE, 1));
    assert!(solved.unwrap_err().to_string().contains("number of load positions"));
}

/// Lists the magnitude of the critical tilt and measures that do not change in a mirror image.
fn mirrored_measures(puncture: &Puncture) -> [f64; 9] {
    let (measures, at_tilt) = (puncture.measures, puncture.at_tilts[0].unwrap());
    [
        puncture.path.last().unwrap().tilt_deg.abs(),
        measures.critical_force.unwrap(),
        measures.critical_displacement.unwrap(),
        measures.penetration.unwrap(),
        measures.max_stiffness.unwrap(),
        measures.peak_force.unwrap(),
        at_tilt.force,
        at_tilt.displacement,
        measures.remains.displacement.unwrap_or_default(),
    ]
}

/// Compares loads at mirrored positions of upright scales, in measures and intermediate tilts.
#[test]
fn a_load_on_the_left_gives_the_mirror_image_of_a_load_on_the_right() {
    let known = Calibrations::default();
    for (needle, friction) in [(FREE, 0.0), (FREE, 0.3), (GUIDED, 0.0)] {
        for (gap, length, position) in
            [(0.3, 0.6, 1.0), (0.3, 0.6, 0.7), (0.05, 1.0, 1.0), (0.05, 1.0, 0.7), (0.1, 0.3, 1.0)]
        {
            let upright = design(gap, length, 0.0, Base::L);
            let common = Common { friction, ..Common::default() };
            let [left, right] = [1.0 - position, position].map(|load_position| {
                let parameters = PunctureParameters {
                    load_position,
                    needle,
                    tilts_before_deg: NumberList::new(&[5.0]),
                    unload: true,
                    ..PunctureParameters::default()
                };
                solve_as(&known, &upright, &common, &parameters)
            });
            assert_eq!((left.status, right.status), (Status::Complete, Status::Complete));
            let tilts = [&left, &right].map(|puncture| puncture.path.last().unwrap().tilt_deg);
            assert!(tilts[0] * tilts[1] < 0.0, "{tilts:?}");
            assert_eq!(
                left.unloading.as_ref().unwrap().stop,
                right.unloading.as_ref().unwrap().stop
            );
            for (left, right) in mirrored_measures(&left).into_iter().zip(mirrored_measures(&right))
            {
                assert_relative_eq!(left, right, max_relative = 1e-6, epsilon = 1e-9);
            }
        }
    }
}

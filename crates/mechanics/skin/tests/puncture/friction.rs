//! Tests of friction between scales, and of unloading.

use approx::assert_relative_eq;
use skin::puncture::{self, Needle, Puncture, PunctureInput, PunctureParameters, RowLength};
use skin::{Base, Common, Design, Status};
use solver::{Settings, Termination};
use substrate::Calibrations;

use super::complete;
use super::samples::{
    BASES, design, finer, long_campaigns, on_row, random, reference_study, solve_as, springs,
};

fn with_friction(friction: f64) -> Common {
    Common { friction, ..Common::default() }
}

fn solve(design: &Design, friction: f64, parameters: &PunctureParameters) -> Puncture {
    solve_as(&Calibrations::default(), design, &with_friction(friction), parameters)
}

/// The independent programs model contact by penalty springs, and friction by return mapping.
#[test]
fn forces_and_penetration_match_independent_programs() {
    let [steep, steepest] = [45.0, 60.0].map(|slant_deg| {
        let design = design(0.1, 1.0, slant_deg, Base::L);
        [0.0, 0.1].map(|friction| complete(&solve(&design, friction, &on_row(41))))
    });
    for (measures, force) in steep.iter().zip([0.4163, 0.4514]) {
        assert_relative_eq!(measures.critical_force.unwrap(), force, max_relative = 2e-4);
    }
    for (measures, penetration) in steepest.iter().zip([0.426, 0.475]) {
        assert_relative_eq!(measures.penetration.unwrap(), penetration, max_relative = 2e-3);
    }
}

#[test]
fn the_force_with_vanishing_friction_is_the_force_without_friction() {
    for slant_deg in [0.0, 45.0, 60.0] {
        let design = design(0.1, 1.0, slant_deg, Base::L);
        let [none, little] =
            [0.0, 1e-9].map(|friction| complete(&solve(&design, friction, &on_row(21))));
        let [none, little] = [none, little].map(|measures| measures.critical_force.unwrap());
        assert_relative_eq!(none, little, max_relative = 1e-7);
    }
}

#[test]
fn the_path_does_not_depend_on_the_step_size() {
    for (gap, length, slant_deg, friction) in
        [(0.1, 1.0, 45.0, 0.1), (0.1, 0.3, 60.0, 0.3), (0.2, 0.3, 75.0, 0.1), (0.1, 1.0, 75.0, 0.2)]
    {
        let design = design(gap, length, slant_deg, Base::L);
        let known = Calibrations::default();
        let settings = [Settings::default(), finer(Settings::default())];
        let [coarse, fine] = settings.map(|solver| {
            let common = Common { solver, ..with_friction(friction) };
            complete(&solve_as(&known, &design, &common, &on_row(41)))
        });
        assert_relative_eq!(
            coarse.critical_force.unwrap(),
            fine.critical_force.unwrap(),
            max_relative = 1e-8
        );
        assert_eq!(coarse.contacts, fine.contacts);
    }
}

#[test]
fn the_work_of_the_load_equals_stored_energy_plus_dissipation() {
    for (gap, length, slant_deg, friction) in
        [(0.1, 1.0, 45.0, 0.05), (0.2, 0.5, 60.0, 0.1), (0.2, 0.3, 75.0, 0.05)]
    {
        let design = design(gap, length, slant_deg, Base::L);
        let solver = Settings { first_step: 1.5e-4, max_step: 1.5e-4, ..Settings::default() };
        let common = Common { solver, ..with_friction(friction) };
        let puncture = solve_as(&Calibrations::default(), &design, &common, &on_row(21));
        let measures = complete(&puncture);
        let taken = measures.friction_work.unwrap();
        let mut work = 0.0;
        let whole =
            puncture.path.last().map(|end| end.substrate_energy + end.contact_energy + taken);
        for (from, to) in puncture.path.iter().zip(&puncture.path[1..]) {
            // Trapezoidal rule; its error in one step is of third order.
            let mean = 0.5 * (from.force + to.force) * length;
            work += mean * (to.displacement - from.displacement);
            let balance = to.substrate_energy + to.contact_energy + to.friction_work.unwrap();
            assert!((work - balance).abs() < 1e-8 * whole.unwrap(), "{work} {balance}");
        }
        assert!(taken > 1e-3 * work, "{taken} {work}");
        // With default steps the integration by cubics must give the same dissipation.
        let usual = complete(&solve(&design, friction, &on_row(21))).friction_work.unwrap();
        assert_relative_eq!(usual, taken, max_relative = 3e-4);
    }
}

#[test]
fn contacts_slip_and_stick_in_turn() {
    let puncture = solve(&design(0.1, 1.0, 45.0, Base::L), 0.1, &on_row(21));
    let changes: Vec<_> = puncture.events.iter().map(|event| event.change.name()).collect();
    assert!(changes.contains(&"slips") && changes.contains(&"sticks"), "{changes:?}");
}

/// Steep, short scales lean on dozens of neighbours.
#[test]
fn designs_with_dozens_of_contacts_complete_with_friction() {
    for (gap, length, slant_deg) in [(0.1, 0.3, 60.0), (0.2, 0.3, 75.0), (0.1, 0.1, 75.0)] {
        let design = design(gap, length, slant_deg, Base::L);
        let forces = [0.0, 0.1].map(|friction| {
            let row =
                PunctureParameters { scales: RowLength::Auto, ..PunctureParameters::default() };
            complete(&solve(&design, friction, &row)).critical_force.unwrap()
        });
        assert!(forces[1] > 1.05 * forces[0], "{forces:?}");
    }
}

/// Returns parameters of a guided needle slightly inside the corner.
fn guided(friction: f64) -> PunctureParameters {
    PunctureParameters {
        needle: Needle::Guided { friction },
        load_position: 0.9875,
        ..PunctureParameters::default()
    }
}

/// In these designs the tip slides to a corner that lies on the next scale. Because of friction,
/// tip and corner then stick together at one point of the face of the next scale.
#[test]
fn tip_and_corner_stick_together_in_a_notch() {
    for (gap, length, slant_deg, base) in [
        (0.2, 1.0, 60.0, Base::L),
        (0.3, 1.0, 75.0, Base::L),
        (0.2, 1.0, 75.0, Base::L),
        (0.2, 0.5, 60.0, Base::TwoL),
        (0.4, 0.9, 75.0, Base::TwoL),
    ] {
        let design = design(gap, length, slant_deg, base);
        let known = Calibrations::default();
        let [coarse, fine] = [Settings::default(), finer(Settings::default())].map(|solver| {
            let common = Common { solver, ..with_friction(0.1) };
            solve_as(&known, &design, &common, &guided(0.3))
        });
        assert_eq!([coarse.status, fine.status], [Status::Complete; 2], "{design:?}");
        let [coarse, fine] = [coarse, fine].map(|puncture| *puncture.path.last().unwrap());
        assert_relative_eq!(coarse.force, fine.force, max_relative = 1e-7);
        assert_relative_eq!(coarse.displacement, fine.displacement, max_relative = 1e-7);
    }
}

/// Solves designs with the given friction, and lists the incomplete designs with their statuses.
fn incomplete(
    designs: impl IntoIterator<Item = Design>,
    friction: f64,
    parameters: &PunctureParameters,
) -> Vec<(Design, Status)> {
    let known = Calibrations::default();
    let statuses = designs.into_iter().map(|design| {
        (design, solve_as(&known, &design, &with_friction(friction), parameters).status)
    });
    statuses.filter(|(_, status)| *status != Status::Complete).collect()
}

#[test]
fn the_reference_study_is_complete_with_friction() {
    for friction in [0.1, 0.3] {
        for base in BASES {
            let every = if long_campaigns() { 1 } else { 24 };
            let designs = reference_study(base).into_iter().skip(5).step_by(every);
            assert_eq!(incomplete(designs, friction, &PunctureParameters::default()), []);
        }
    }
}

#[test]
fn the_reference_study_under_a_guided_needle_ends_only_for_mechanical_reasons() {
    for friction in [0.1, 0.3] {
        for base in BASES {
            let every = if long_campaigns() { 1 } else { 24 };
            let designs = reference_study(base).into_iter().skip(7).step_by(every);
            let failed = incomplete(designs, friction, &guided(0.3));
            for (_, status) in &failed {
                // Every other reason to stop early is numerical.
                let is_jump = *status == Status::Stopped(Termination::Jumps);
                assert!(is_jump || !matches!(status, Status::Stopped(_)), "{failed:?}");
            }
            assert!(failed.len() <= 4, "{failed:?}");
        }
    }
}

#[test]
fn random_designs_are_complete_with_friction() {
    let count = if long_campaigns() { 2000 } else { 100 };
    let failed = incomplete(random(count, 21), 0.3, &PunctureParameters::default());
    assert!(failed.len() <= count / 1000, "{failed:?}");
}

/// Compares the work of loading, the work returned by unloading, and the loop work.
///
/// Without friction unloading returns all work. With friction the loop work is dissipated, or
/// stored in the residual deformation.
#[test]
fn loading_work_equals_returned_work_plus_loop_work() {
    for (gap, length, slant_deg, friction, needle) in [
        (0.1, 1.0, 45.0, 0.0, Needle::Free),
        (0.1, 1.0, 45.0, 0.1, Needle::Free),
        (0.2, 0.5, 60.0, 0.3, Needle::Free),
        (0.3, 0.7, 60.0, 0.0, Needle::Guided { friction: 0.3 }),
        (0.2, 1.0, 60.0, 0.1, Needle::Guided { friction: 0.3 }),
        (0.5, 1.0, 0.0, 0.1, Needle::Guided { friction: 0.1 }),
    ] {
        let design = design(gap, length, slant_deg, Base::L);
        let parameters =
            PunctureParameters { needle, unload: true, load_position: 0.95, ..on_row(21) };
        let solver = Settings { first_step: 1.5e-4, max_step: 1.5e-4, ..Settings::default() };
        let common = Common { solver, ..with_friction(friction) };
        let puncture = solve_as(&Calibrations::default(), &design, &common, &parameters);
        let back = puncture.unloading.as_ref().unwrap();
        assert_eq!(
            (puncture.status, back.stop),
            (Status::Complete, Termination::Unloaded),
            "{design:?}"
        );
        let [done, returned] = [(1.0, &puncture.path), (-1.0, &back.path)].map(|(sign, path)| {
            let steps = path.windows(2).map(|pair| {
                let mean = 0.5 * (pair[0].force + pair[1].force) * length;
                mean * (pair[1].displacement - pair[0].displacement)
            });
            sign * steps.sum::<f64>()
        });
        let loop_work = puncture.measures.remains.loop_work.unwrap();
        println!("{design:?} {done} {returned} {loop_work} {:?}", puncture.measures.remains);
        assert!((done - returned - loop_work).abs() < 1e-5 * done, "{design:?}");
        let end = back.path.last().unwrap();
        assert!(end.force.abs() < 1e-9);
        if friction == 0.0 && needle == Needle::Free {
            assert!(end.displacement.abs() < 1e-9 && loop_work.abs() < 1e-9 * done);
        } else {
            assert!(loop_work > 1e-3 * done && end.displacement > -1e-9);
        }
    }
}

/// Unloading begins before the critical tilt. The curve agrees with a path that ends at this point
/// and unloads.
#[test]
fn unloading_curves_lie_on_the_unloading_path() {
    for (slant_deg, friction, needle) in [
        (45.0, 0.2, Needle::Free),
        (60.0, 0.0, Needle::Guided { friction: 0.3 }),
        (60.0, 0.1, Needle::Guided { friction: 0.3 }),
    ] {
        let design = design(0.2, 0.8, slant_deg, Base::L);
        let parameters =
            PunctureParameters { needle, load_position: 0.95, unload: true, ..on_row(21) };
        let common = with_friction(friction);
        let to = PunctureParameters { critical_tilt_deg: 7.0, ..parameters };
        let puncture = solve_as(&Calibrations::default(), &design, &common, &to);
        let back = puncture.unloading.as_ref().unwrap();
        assert_eq!(back.stop, Termination::Unloaded);
        let springs = springs(&design, &parameters, &Calibrations::default());
        let stiffness = (&springs).into();
        let input = PunctureInput { design, stiffness, common, parameters, perturbed: None };
        let turn = puncture.path.last().unwrap().displacement;
        let points = &back.path[1..back.path.len() - 1];
        let depths: Vec<_> = points.iter().map(|point| point.displacement).collect();
        let below = depths.last().unwrap() - 1.0;
        let curve =
            puncture::unloading_curve(&input, turn, &[&depths[..], &[below]].concat()).unwrap();
        assert_eq!(curve.last(), Some(&None));
        for (point, on_curve) in points.iter().zip(&curve) {
            let value = on_curve.as_ref().unwrap().value;
            assert_relative_eq!(value, point.force, max_relative = 1e-6, epsilon = 1e-9);
        }
    }
}

/// Computes the work of the load along a path by the trapezoidal rule.
fn work_of(path: &[puncture::PuncturePoint], length: f64) -> f64 {
    let steps = path.windows(2).map(|pair| {
        let mean = 0.5 * (pair[0].force + pair[1].force) * length;
        mean * (pair[1].displacement - pair[0].displacement)
    });
    steps.sum()
}

/// In a notch the tip and the corner slide together, so the friction of both reverses together.
///
/// The expected loop work was computed by an independent program.
#[test]
fn friction_in_a_notch_reverses_with_the_load() {
    let (gap, length, slant_deg) = (0.0879, 0.5481, 61.07);
    let parameters = PunctureParameters {
        needle: Needle::Guided { friction: 0.25 },
        unload: true,
        load_position: 1.0 - 0.06 / length,
        ..Default::default()
    };
    let design = design(gap, length, slant_deg, Base::L);
    let solver = Settings { first_step: 0.002, max_step: 0.02, ..Settings::default() };
    let common = Common { solver, ..with_friction(0.16) };
    let puncture = solve_as(&Calibrations::default(), &design, &common, &parameters);
    let loop_work = puncture.measures.remains.loop_work.unwrap();
    assert_relative_eq!(loop_work, 0.0444, max_relative = 5e-3);
    let back = puncture.unloading.as_ref().unwrap();
    let area = work_of(&puncture.path, length) + work_of(&back.path, length);
    assert_relative_eq!(loop_work, area, max_relative = 1e-3);
}

/// Returns the friction between scales and the parameters for random design number `k`.
///
/// Twelve successive numbers combine three frictions with four needles: free, sharp and round.
fn unloaded_with_friction(k: usize) -> (f64, PunctureParameters) {
    let needle = k / 3 % 4;
    let parameters = PunctureParameters {
        needle: [
            Needle::Guided { friction: 0.1 },
            Needle::Guided { friction: 0.3 },
            Needle::Guided { friction: 0.2 },
            Needle::Free,
        ][needle],
        needle_radius: (needle == 2).then_some(0.1),
        unload: true,
        load_position: 0.9,
        ..Default::default()
    };
    ([0.0, 0.1, 0.25][k % 3], parameters)
}

/// Tests free needles, and guided needles with sharp and round tips.
#[test]
fn loop_work_is_the_area_of_the_loop_for_random_designs() {
    let count = if long_campaigns() { 400 } else { 24 };
    let known = Calibrations::default();
    let mut closed = 0;
    for (k, design) in random(count, 31).into_iter().enumerate() {
        let (friction, parameters) = unloaded_with_friction(k);
        // The error of the trapezoidal rule decreases with the square of the step.
        let solver = Settings { first_step: 0.001, max_step: 0.002, ..Settings::default() };
        let common = Common { solver, ..with_friction(friction) };
        let puncture = solve_as(&known, &design, &common, &parameters);
        let (Some(loop_work), Some(back)) =
            (puncture.measures.remains.loop_work, &puncture.unloading)
        else {
            continue;
        };
        let there = work_of(&puncture.path, design.length);
        let area = there + work_of(&back.path, design.length);
        assert!((loop_work - area).abs() < 1e-3 * there, "{design:?} {loop_work} {area} {there}");
        closed += 1;
    }
    assert!(closed > count * 4 / 5, "{closed} of {count}");
}

/// Compares default steps with small steps.
#[test]
fn loop_work_does_not_depend_on_the_step_size() {
    let count = if long_campaigns() { 400 } else { 24 };
    let known = Calibrations::default();
    let mut closed = 0;
    for (k, design) in random(count, 110).into_iter().enumerate() {
        let (friction, parameters) = unloaded_with_friction(k);
        let small = Settings { first_step: 0.001, max_step: 0.002, ..Settings::default() };
        let [coarse, fine] = [Settings::default(), small].map(|solver| {
            let common = Common { solver, ..with_friction(friction) };
            solve_as(&known, &design, &common, &parameters)
        });
        let [Some(coarse), Some(fine)] =
            [coarse, fine].map(|puncture| puncture.measures.remains.loop_work)
        else {
            continue;
        };
        assert_relative_eq!(coarse, fine, max_relative = 2e-3, epsilon = 1e-9);
        closed += 1;
    }
    assert!(closed > count * 4 / 5, "{closed} of {count}");
}

/// In this design the tip slides to a corner, at which the directions of its forces change. The
/// dissipation must include the last segment before the corner.
#[test]
fn dissipation_of_a_tip_includes_the_segment_up_to_a_corner() {
    let design = design(0.348_434, 0.074_856, 12.225_76, Base::TwoL);
    let parameters = PunctureParameters {
        needle: Needle::Guided { friction: 0.1 },
        unload: true,
        load_position: 0.9,
        ..Default::default()
    };
    let small = Settings { first_step: 1e-4, max_step: 2e-4, ..Settings::default() };
    let [coarse, fine] = [Settings::default(), small].map(|solver| {
        let common = Common { solver, ..Common::default() };
        solve_as(&Calibrations::default(), &design, &common, &parameters)
    });
    let back = fine.unloading.as_ref().unwrap();
    let area = work_of(&fine.path, design.length) + work_of(&back.path, design.length);
    for puncture in [&coarse, &fine] {
        let loop_work = puncture.measures.remains.loop_work.unwrap();
        assert_relative_eq!(loop_work, area, max_relative = 1e-4);
    }
}

/// During unloading of these designs a tip leaves a notch, or a contact closes while another opens.
///
/// If the solver started with the wrong one of the simultaneous changes, these paths would reverse
/// or stop.
#[test]
fn unloading_continues_through_simultaneous_contact_changes() {
    let guided = Needle::Guided { friction: 0.3 };
    for (gap, length, slant_deg, base, friction, needle) in [
        (0.6, 0.9, 75.0, Base::L, 0.0, guided),
        (0.1, 0.5, 60.0, Base::L, 0.0, guided),
        (0.1, 0.3, 75.0, Base::TwoL, 0.0, guided),
        (0.6, 1.0, 75.0, Base::TwoL, 0.3, Needle::Free),
        (1.0, 0.8, 75.0, Base::TwoL, 0.3, Needle::Free),
    ] {
        let design = design(gap, length, slant_deg, base);
        let load_position = if needle == Needle::Free { 1.0 } else { 0.975 };
        let parameters =
            PunctureParameters { needle, unload: true, load_position, ..Default::default() };
        let puncture =
            solve_as(&Calibrations::default(), &design, &with_friction(friction), &parameters);
        let back = puncture.unloading.as_ref().unwrap();
        assert_eq!(
            (puncture.status, back.stop),
            (Status::Complete, Termination::Unloaded),
            "{design:?}"
        );
    }
}

/// Without detection of the jump the first path would return to rest, and the second would cycle.
#[test]
fn a_path_without_an_outgoing_branch_ends_as_a_jump() {
    let needle = Needle::Guided { friction: 0.3 };
    let parameters = PunctureParameters { needle, load_position: 0.95, ..Default::default() };
    for (gap, length, slant_deg, base) in
        [(0.063_973, 1.488_271, 76.554, Base::L), (0.062_271, 2.393_676, 79.65, Base::L)]
    {
        let design = design(gap, length, slant_deg, base);
        let puncture =
            solve_as(&Calibrations::default(), &design, &with_friction(0.1), &parameters);
        assert_eq!(puncture.status, Status::Stopped(Termination::Jumps), "{design:?}");
        assert!(puncture.path.len() < 1000, "{design:?}");
    }
}

//! Compares the puncture of one isolated scale with [`analytical::isolated_scale`].

use analytical::isolated_scale::IsolatedScale;
use approx::assert_relative_eq;
use contact::Law;
use skin::puncture::PunctureParameters;
use skin::{Base, Status};
use substrate::Calibrations;

use crate::samples::{design, in_small_steps, on_row, solve_as, solve_with, springs, with_law};

fn closed_form(
    design: &skin::Design,
    parameters: &PunctureParameters,
    known: &Calibrations,
) -> IsolatedScale {
    let (a, springs) = (design.half_base(), springs(design, parameters, known));
    let shift = design.slant_deg.to_radians().tan();
    IsolatedScale {
        normal: a * springs.direct[1],
        rotation: a.powi(3) * springs.direct[2],
        arm: [shift - a + 2.0 * a * parameters.load_position, 1.0],
    }
}

#[test]
fn the_whole_path_follows_the_closed_form() {
    let known = Calibrations::default();
    for base in [Base::L, Base::TwoL] {
        for (gap, length, slant) in
            [(0.1, 1.0, 0.0), (0.1, 0.025, 75.0), (1.0, 0.5, 45.0), (0.05, 3.0, 80.0)]
        {
            for load_position in [1.0, 0.8] {
                let design = design(gap, length, slant, base);
                let parameters = PunctureParameters { load_position, ..on_row(1) };
                let exact = closed_form(&design, &parameters, &known);
                let puncture = solve_as(&known, &design, &in_small_steps(), &parameters);
                assert_eq!(puncture.status, Status::Complete);
                assert!(puncture.path.len() > 10);
                for point in &puncture.path {
                    let psi = point.tilt_deg.to_radians();
                    let (force, displacement) = (exact.force(psi), exact.displacement(psi));
                    assert_relative_eq!(point.force * length, force, max_relative = 1e-9);
                    assert_relative_eq!(point.displacement, displacement, max_relative = 1e-9);
                    let energy = exact.energy(psi);
                    assert_relative_eq!(point.substrate_energy, energy, max_relative = 1e-9);
                    assert_eq!((point.contact_energy, point.contacts), (0.0, 0));
                }
            }
        }
    }
}

#[test]
fn measures_match_the_closed_form() {
    let known = Calibrations::default();
    let (design, parameters) = (design(0.3, 0.4, 30.0, Base::L), on_row(1));
    let exact = closed_form(&design, &parameters, &known);
    let measures = solve_with(&known, &design, &parameters).measures;
    let psi = 10.0_f64.to_radians();
    let (force, displacement) = (exact.force(psi), exact.displacement(psi));
    for (ours, exact) in [
        // The substrate is incompressible, so `E*/E_s` = 4/3.
        (measures.initial_stiffness, 4.0 / 3.0 * exact.initial_stiffness()),
        (measures.secant_stiffness, 4.0 / 3.0 * force / displacement),
        (measures.critical_force, force / 0.4),
        (measures.critical_displacement, displacement),
        (measures.sink, exact.sink(psi)),
        (measures.penetration, exact.sink(psi) + 0.2 * psi.sin()),
    ] {
        assert_relative_eq!(ours.unwrap(), exact, max_relative = 1e-9);
    }
    assert_eq!(measures.first_contact_displacement, None);
    assert_eq!((measures.contacts, measures.engaged_scales), (Some(0), Some(0)));
}

/// A load above the node of an upright block has no lever arm, so the block sinks without tilting.
#[test]
fn a_load_above_the_node_of_a_block_has_no_critical_tilt() {
    let parameters = PunctureParameters { load_position: 0.5, ..on_row(1) };
    let (known, common) = (Calibrations::default(), with_law(Law::EXCHANGED));
    let block = design(0.1, 1.0, 0.0, Base::L);
    let puncture = crate::samples::solve_as(&known, &block, &common, &parameters);
    assert_eq!(puncture.status, Status::Untilted);
    assert_eq!(puncture.measures.critical_force, None);
}

//! Tests of the energy balance along the path of a strip.

mod gap_by_gap;

use contact::Law;
use solver::{Continuation, Settings};

use super::problem::FlexureProblem;
use super::strip::Strip;
use super::{FlexureParameters, Method};
use crate::contacts::{SkinPoint, SkinState};
use crate::{Base, Common, Design};

/// Integrates `M dΦ` between two points of a path by Boole's rule.
///
/// Evaluates five equilibria at equal distances in `Φ`.
fn work(path: &mut Continuation<Strip>, from: &SkinPoint, to: &SkinPoint) -> f64 {
    let inner = [0.25, 0.5, 0.75].map(|x| path.between(from, to, x).unwrap().state);
    let states = [&from.state, &inner[0], &inner[1], &inner[2], &to.state];
    let strip = path.system();
    let moments = states.iter().zip([7.0, 32.0, 12.0, 32.0, 7.0]);
    let mean = moments.map(|(state, weight)| weight * strip.moment(&state.z)).sum::<f64>() / 90.0;
    mean * (strip.rotation(&to.state.z) - strip.rotation(&from.state.z))
}

/// Computes the largest difference between work and stored energy along the path of a strip.
///
/// The difference is relative to the energy at the end of the path. Also returns the axial energy
/// of the membrane and the contact energy at the end, as fractions of the whole energy.
fn balance(design: &Design, common: &Common, parameters: &FlexureParameters) -> [f64; 3] {
    let problem = FlexureProblem::even(design, common, parameters).unwrap();
    let strip = problem.resolved(&[], &[]).unwrap().0.path.system().clone();
    let rest = SkinState::at_rest(&strip);
    let mut path = Continuation::new(strip, rest, common.solver);
    let (mut done, mut off, mut energies) = (0.0, 0.0_f64, [0.0; 3]);
    loop {
        let from = path.point().clone();
        let Some(to) = path.next() else { break };
        done += work(&mut path, &from, &to);
        let strip = path.system();
        let membrane = strip.membrane_energy(&to.state);
        energies = [membrane.bending, membrane.axial, strip.contacts.energy(&to.state)];
        off = off.max((done - energies.iter().sum::<f64>()).abs());
    }
    let whole = energies.iter().sum::<f64>();
    [off / whole, energies[1] / whole, energies[2] / whole]
}

#[test]
fn work_of_the_moment_equals_stored_energy() {
    let design =
        |gap, length, slant_deg| Design { gap, length, slant_deg, base: Base::L, width: 1.0 };
    let solver = Settings { max_step: 0.004, ..Settings::default() };
    let (mut most_axial, mut most_contact) = (0.0_f64, 0.0_f64);
    for (gap, length, slant_deg) in
        [(0.1, 1.0, 75.0), (0.1, 0.1, 45.0), (0.3, 0.5, 60.0), (1.0, 0.2, 75.0), (0.5, 1.0, 0.0)]
    {
        // The contacts of the last case are so soft that they store a large part of the energy.
        for (law, modulus) in
            [(Law::PRINTED, 667.0), (Law::EXCHANGED, 667.0), (Law::EXCHANGED, 1.0)]
        {
            let parameters = FlexureParameters {
                contact_modulus_over_membrane: modulus,
                membrane_length: 20.0,
                ..FlexureParameters::default()
            };
            let [off, axial, contact] = balance(
                &design(gap, length, slant_deg),
                &Common { law, solver, ..Common::default() },
                &parameters,
            );
            assert!(off < 1e-6, "{gap} {length} {slant_deg} {law:?} {modulus}: {off:e}");
            most_axial = most_axial.max(axial);
            most_contact = most_contact.max(contact);
        }
    }
    assert!(most_axial > 0.1 && most_contact > 0.1, "{most_axial} {most_contact}");
}

#[test]
fn a_chain_balances_work_and_energy() {
    let design = Design { gap: 0.3, length: 0.5, slant_deg: 60.0, base: Base::L, width: 1.0 };
    let solver = Settings { max_step: 0.01, ..Settings::default() };
    let chain = FlexureParameters {
        method: Method::Chain,
        membrane_length: 8.0,
        ..FlexureParameters::default()
    };
    let common = Common { solver, ..Common::default() };
    let [off, axial, _] = balance(&design, &common, &chain);
    assert!(off < 1e-6, "{off:e}");
    assert!(axial > 0.01, "{axial}");
}

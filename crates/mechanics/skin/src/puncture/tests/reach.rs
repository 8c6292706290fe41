//! Tests of contacts between scales that are not direct neighbours.

use contact::Law;
use solver::{Continuation, Settings, check_tangent};
use substrate::{Coupling, RowStiffness};

use super::{Balance, DOMINO, HARD, balance, for_segments, law, whole};
use crate::contacts::{SkinState, pair_constraints};
use crate::puncture::row_layout::RowLayout;
use crate::puncture::{Problem, Puncture, PunctureParameters, Rows};
use crate::{Base, Common, Design, Status};

/// Designs of the paper in which scales touch second neighbours under full coupling.
const DISTANT_CONTACT: [Design; 2] =
    [DOMINO, Design { gap: 0.1, length: 0.4, slant_deg: 75.0, base: Base::L, width: 1.0 }];

/// Returns the stiffness of the substrate with full coupling.
fn full(design: &Design) -> RowStiffness {
    RowStiffness::compute(&design.footprint(0.5).unwrap(), Coupling::Full).unwrap()
}

/// Solves a puncture with a fixed contact reach; `None` increases the reach as needed.
fn solved(design: &Design, common: &Common, contact_reach: Option<usize>) -> Puncture {
    let parameters = PunctureParameters::default();
    let rows = Rows::Even(design.row().unwrap());
    let problem = Problem::new(rows, design, full(design), common, &parameters).unwrap();
    let followed = match contact_reach {
        None => problem.follow(&[], &[]),
        Some(reach) => {
            let (start, longest) = problem.start(reach).unwrap();
            problem.follow_row(start, longest, &[], &[])
        }
    };
    followed.unwrap().puncture(false)
}

#[test]
fn contacts_with_second_neighbours_prevent_their_overlap() {
    for design in DISTANT_CONTACT {
        let common = Common::default();
        let through = solved(&design, &common, Some(1));
        assert_eq!(through.status, Status::Interpenetration);
        let stopped = solved(&design, &common, None);
        assert_eq!(stopped.status, Status::Complete);
        let mut beyond = stopped.events.iter().filter(|event| {
            let [left, right] = [event.left_scale, event.right_scale].map(Option::unwrap);
            right - left == 2
        });
        // Up to the first contact of second neighbours both paths agree.
        let first = beyond.next().unwrap().point;
        let same = through.path.iter().zip(&stopped.path);
        for (ours, theirs) in same.take_while(|(_, theirs)| theirs.force < first.force) {
            assert!((ours.force - theirs.force).abs() < 1e-9 * theirs.force.abs().max(1e-3));
        }
        // Unknowns of contacts that never close must not change the result.
        let longer = solved(&design, &common, Some(3));
        let [ours, theirs] = [&stopped, &longer].map(|p| p.measures.critical_force.unwrap());
        assert!((ours - theirs).abs() < 1e-9 * theirs, "{ours} {theirs}");
    }
}

#[test]
fn distant_contacts_conserve_energy_and_their_tangent_matches_differences() {
    let design = &DISTANT_CONTACT[1];
    let law = law(design, Law::PRINTED, HARD);
    let layout = RowLayout { left: 20, right: 20, needle: 0, contacts: 2 * pair_constraints(&law) };
    let chain = whole(&full(design), design, law, layout, &PunctureParameters::default());
    let path = Continuation::new(chain.clone(), SkinState::at_rest(&chain), Settings::default());
    let Balance { work, off, .. } = balance(path.clone());
    assert!(off < 1e-6 * work, "{:e}", off / work);
    let mut closed = 0;
    for_segments(path, |path, from, to| {
        let state = path.between(from, to, 0.5).unwrap().state;
        let contacts = path.system().contacts.closed_contacts(&state);
        let beyond = contacts.iter().filter(|contact| contact.right == contact.left + 2).count();
        closed += beyond;
        if beyond > 0 {
            check_tangent(path.system(), &state, 1e-6).unwrap();
        }
    });
    assert!(closed > 0);
}

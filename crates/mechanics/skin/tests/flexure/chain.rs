//! Compares the assembled chain of all gaps with the unit cell of one gap.

use approx::assert_relative_eq;
use contact::Law;
use rayon::prelude::*;
use skin::flexure::{FlexureParameters, Method, StripSnapshot, snapshots, solve, whole_gaps};
use skin::{Base, Common, Design, Status};

use crate::samples::{LAWS, forty, with_law};

/// End rotations in degrees at which states are compared; some are just after a contact closes.
const AT: [f64; 12] = [1.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0, 150.0, 175.0, 180.0];

fn compare(design: &Design, law: Law) -> usize {
    let [cell, chain] = [Method::UnitCell, Method::Chain].map(|method| {
        let gaps = Some(whole_gaps(&design.row().unwrap(), &FlexureParameters::default()));
        let parameters = FlexureParameters { method, gaps, ..FlexureParameters::default() };
        let shots = snapshots(design, &with_law(law), &parameters, &AT).unwrap();
        let shots = shots.into_iter().map(|shot| shot.expect("the path reaches this rotation"));
        shots.collect::<Vec<StripSnapshot>>()
    });
    for (cell, chain) in cell.iter().zip(&chain) {
        assert_relative_eq!(cell.curvature, chain.curvature, max_relative = 1e-11);
        assert_relative_eq!(cell.moment, chain.moment, max_relative = 1e-8);
        assert_eq!(cell.contacts.len(), chain.contacts.len(), "{design:?}");
    }
    cell.iter().map(|shot| shot.contacts.len()).sum()
}

#[test]
fn chain_and_unit_cell_have_equal_moments() {
    let designs = forty();
    assert_eq!(designs.len(), 40);
    for law in LAWS {
        let contacts: usize = designs.par_iter().map(|design| compare(design, law)).sum();
        assert!(contacts > 1000, "{contacts}");
    }
}

#[test]
fn chain_and_unit_cell_have_equal_measures() {
    for design in forty().iter().step_by(5) {
        let [cell, chain] = [Method::UnitCell, Method::Chain].map(|method| {
            let gaps = Some(whole_gaps(&design.row().unwrap(), &FlexureParameters::default()));
            let parameters = FlexureParameters { method, gaps, ..FlexureParameters::default() };
            let flexure = solve(design, &Common::default(), &parameters).unwrap();
            assert_eq!(flexure.status, Status::Complete);
            flexure.measures
        });
        assert_eq!((cell.contact, cell.gaps), (chain.contact, chain.gaps));
        for (cell, chain) in [
            (cell.initial_compliance, chain.initial_compliance),
            (cell.first_contact_curvature, chain.first_contact_curvature),
            (cell.max_moment, chain.max_moment),
        ] {
            assert_eq!(cell.is_some(), chain.is_some());
            if let (Some(cell), Some(chain)) = (cell, chain) {
                assert_relative_eq!(cell, chain, max_relative = 1e-7);
            }
        }
    }
}

/// In a chain with its bases far above the membrane, gaps open and close in turn, so that the
/// rotation makes no progress.
#[test]
fn a_chain_without_progress_stops_as_locked() {
    let design = Design {
        gap: 0.028_267_519_146_269_48,
        length: 1.347_354_718_232_657,
        slant_deg: 47.109_083_004_029_73,
        base: Base::TwoL,
        width: 2.597_055_556_846_208,
    };
    let parameters = FlexureParameters {
        method: Method::Chain,
        membrane_thickness: 0.325_770_736_600_017_3,
        membrane_axis_offset: 2.184_566_791_659_762,
        ..FlexureParameters::default()
    };
    let flexure = solve(&design, &Common::default(), &parameters).unwrap();
    assert_eq!(flexure.status, Status::Locked);
    assert!(flexure.path.len() < 600, "{}", flexure.path.len());
}

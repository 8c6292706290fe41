//! Every design of the reference study can be bent to a full turn.

use contact::Law;
use rayon::prelude::*;
use skin::flexure::{Parameters, Status, solve};

use crate::samples::{BASES, reference_study};

#[test]
fn the_reference_study_completes_with_either_law() {
    for base in BASES {
        for law in [Law::PRINTED, Law::EXCHANGED] {
            let parameters = Parameters { law, ..Parameters::default() };
            let touching: usize = reference_study(base)
                .par_iter()
                .map(|design| {
                    let flexure = solve(design, &parameters).unwrap();
                    assert_eq!(flexure.status, Status::Complete, "{design:?} {law:?}");
                    usize::from(flexure.measures.contact == Some(true))
                })
                .sum();
            assert!((100..720).contains(&touching), "{touching}");
        }
    }
}

//! Checks that the compliance does not depend on step size and tolerance.

use approx::assert_relative_eq;
use rayon::prelude::*;
use skin::flexure::{FlexureParameters, solve};
use skin::{Common, Status};
use solver::Settings;

use crate::samples::{LAWS, finer, forty};

#[test]
fn steps_ten_times_smaller_give_the_same_compliance() {
    let coarse = Settings::default();
    let fine = finer(coarse);
    for law in LAWS {
        forty().par_iter().for_each(|design| {
            let [ours, theirs] = [coarse, fine].map(|solver| {
                let common = Common { law, solver, ..Common::default() };
                solve(design, &common, &FlexureParameters::default()).unwrap()
            });
            assert!(theirs.path.len() > 3 * ours.path.len());
            let [ours, theirs] = [ours, theirs].map(|flexure| flexure.measures.compliance.unwrap());
            assert_relative_eq!(ours, theirs, max_relative = 1e-6);
        });
    }
}

/// Newton's method cannot reach this tolerance, so it must stop when residuals stagnate.
#[test]
fn a_tolerance_at_round_off_gives_the_same_compliance() {
    let loose = Settings::default();
    let tight = Settings { tolerance: 1e-12, ..loose };
    for law in LAWS {
        forty().par_iter().for_each(|design| {
            let [loose, tight] = [loose, tight].map(|solver| {
                let common = Common { law, solver, ..Common::default() };
                let flexure = solve(design, &common, &FlexureParameters::default()).unwrap();
                assert_eq!(flexure.status, Status::Complete, "{design:?} {law:?}");
                flexure.measures.compliance.unwrap()
            });
            assert_relative_eq!(loose, tight, max_relative = 1e-8);
        });
    }
}

//! The compliance does not depend on the steps with which the path is followed.

use approx::assert_relative_eq;
use rayon::prelude::*;
use skin::Common;
use skin::flexure::{FlexureParameters, solve};
use solver::Settings;

use crate::samples::{LAWS, finer, forty};

#[test]
fn steps_ten_times_smaller_give_the_same_compliance() {
    let coarse = Settings::default();
    let fine = finer(coarse);
    for law in LAWS {
        forty().par_iter().for_each(|design| {
            let with = |solver| {
                solve(design, &Common { law, solver }, &FlexureParameters::default()).unwrap()
            };
            let [ours, theirs] = [with(coarse), with(fine)];
            assert!(theirs.path.len() > 3 * ours.path.len());
            let compliance =
                |flexure: &skin::flexure::Flexure| flexure.measures.compliance.unwrap();
            assert_relative_eq!(compliance(&ours), compliance(&theirs), max_relative = 1e-6);
        });
    }
}

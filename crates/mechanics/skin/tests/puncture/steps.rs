//! Checks that measures and events do not depend on the step size.

use skin::Common;
use solver::Settings;
use substrate::Calibrations;

use crate::samples::{LAWS, finer, on_row, solve_as, spread};

#[test]
fn steps_ten_times_smaller_give_the_same_measures_and_events() {
    let known = Calibrations::default();
    let coarse = Settings::default();
    let fine = finer(coarse);
    for design in spread() {
        for law in LAWS {
            let [ours, theirs] = [coarse, fine].map(|solver| {
                solve_as(&known, &design, &Common { law, solver, ..Common::default() }, &on_row(41))
            });
            assert!(theirs.path.len() >= ours.path.len() + 30);
            crate::assert_same_measures(&crate::complete(&ours), &crate::complete(&theirs), 1e-6);
            let [ours, theirs] = [&ours, &theirs].map(|puncture| {
                let events = puncture.events.iter();
                events.map(|e| (e.left_scale, e.corner_edge.name(), e.change)).collect::<Vec<_>>()
            });
            assert_eq!(ours, theirs, "{design:?}");
        }
    }
}

//! The branches of the contact that the designs of these tests end in.

use std::collections::{BTreeSet, HashMap};

use rayon::prelude::*;
use results::ParameterDerivative;
use run::Evaluator;
use skin::ContactChange;
use substrate::Coupling;
use sweep::{Case, Measure};

use super::designs::{self, random_case};
use super::differences::Differences;
use super::{compare, compare_components, derivatives};

/// The branches in which the contacts of a puncture and a bent strip end: a corner on an edge, corners together, a tip on the
/// neighbour's end, and sides that lie flush.
fn branches(case: &Case) -> BTreeSet<&'static str> {
    let solved = Evaluator::new(&Measure::USUAL).solve(designs::number(), case);
    let punctured = solved.puncture.iter().flat_map(|p| &p.events);
    let punctured = punctured.map(|e| (e.left_scale, e.corner_edge.name(), e.change));
    let bent = solved.flexure.iter().flat_map(|f| &f.events);
    let bent = bent.map(|e| (e.left_scale, e.corner_edge.name(), e.change));
    let mut branches = ends(punctured);
    branches.extend(ends(bent));
    branches
}

fn ends(
    events: impl Iterator<Item = (Option<i64>, &'static str, ContactChange)>,
) -> BTreeSet<&'static str> {
    let mut ends = HashMap::new();
    for (pair, edge, change) in events {
        let is_upper = edge.starts_with('T');
        let on_edge = if edge.ends_with("edge") { "edge" } else { "tip" };
        let before = ends.get(&(pair, is_upper)).copied();
        let after = match change {
            ContactChange::Slips | ContactChange::Sticks => panic!("nothing rubs"),
            ContactChange::Closed if before.is_some() => Some("flush"),
            ContactChange::Closed | ContactChange::LeftCorner | ContactChange::HandedOver => {
                Some(on_edge)
            }
            ContactChange::ReachedCorner => Some("corner"),
            ContactChange::Opened if before == Some("flush") => Some(on_edge),
            ContactChange::Opened => None,
        };
        match after {
            Some(branch) => ends.insert((pair, is_upper), branch),
            None => ends.remove(&(pair, is_upper)),
        };
    }
    ends.into_values().collect()
}

/// Steep designs at large tilts, of which a few end in the rarer branches.
pub fn steep_case(number: u64) -> Case {
    let mut case = random_case(number);
    case.puncture.critical_tilt_deg = 10.0 + 25.0 * (number % 7) as f64 / 7.0;
    case.design.slant_deg = 55.0 + 28.0 * (number % 11) as f64 / 11.0;
    case.design.gap *= 0.5;
    case
}

/// Derivatives of designs that end in every branch of the contact are those of whole solutions.
#[test]
fn every_branch_of_the_contact_is_exercised() {
    let exercised = [43, 97].into_par_iter().flat_map_iter(|number| {
        let case = steep_case(number);
        assert!(compare(&case) > 30, "{case:?}");
        branches(&case)
    });
    let exercised: BTreeSet<_> = exercised.collect();
    assert_eq!(exercised, BTreeSet::from(["corner", "edge", "flush", "tip"]));
}

/// With full coupling the scales on both sides of a punctured one that is driven down meet above it.
#[test]
fn scales_meet_over_one_that_is_driven_down() {
    let mut case = Case { coupling: Coupling::Full, ..Case::default() };
    (case.design.gap, case.design.length, case.design.slant_deg) = (0.1, 0.4, 75.0);
    let solved = Evaluator::new(&Measure::USUAL).solve(designs::number(), &case);
    let events = solved.puncture.iter().flat_map(|puncture| &puncture.events);
    let mut pairs = events.map(|event| (event.left_scale, event.right_scale));
    assert!(pairs.any(|pair| pair == (Some(-1), Some(1))));
    // Two parameters: with full coupling the calibration of each neighbouring footprint takes its time.
    let is_compared =
        |by: &ParameterDerivative| ["gap_over_t", "slant_deg"].contains(&by.parameter);
    let compared: Vec<_> = derivatives(&case).into_iter().filter(is_compared).collect();
    assert!(compare_components(&case, &compared, &Differences::of(&case)) > 20);
}

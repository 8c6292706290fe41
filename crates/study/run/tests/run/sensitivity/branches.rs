//! Derivatives agree with differences for every kind of contact at the end of a path.

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

/// Returns the kinds of contact at the ends of the puncture and bending paths.
///
/// The kinds are a corner on an edge, two corners together, a tip on the base or top of the
/// neighbour, and flush sides.
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
            ContactChange::Slips | ContactChange::Sticks => panic!("no contact has friction"),
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

/// Returns a steep design with a large critical tilt; a few of these designs end with rare
/// contacts.
pub fn steep_case(number: u64) -> Case {
    let mut case = random_case(number);
    case.puncture.critical_tilt_deg = 10.0 + 25.0 * (number % 7) as f64 / 7.0;
    case.design.slant_deg = 55.0 + 28.0 * (number % 11) as f64 / 11.0;
    case.design.gap *= 0.5;
    case
}

/// The paths of the two designs end with all four kinds of contact.
#[test]
fn derivatives_match_differences_for_every_kind_of_contact() {
    let exercised = [43, 97].into_par_iter().flat_map_iter(|number| {
        let case = steep_case(number);
        assert!(compare(&case) > 30, "{case:?}");
        branches(&case)
    });
    let exercised: BTreeSet<_> = exercised.collect();
    assert_eq!(exercised, BTreeSet::from(["corner", "edge", "flush", "tip"]));
}

/// With full coupling, a deeply punctured scale sinks until its neighbours touch above it.
#[test]
fn neighbours_touch_above_a_deeply_punctured_scale() {
    let mut case = Case { coupling: Coupling::Full, ..Case::default() };
    (case.design.gap, case.design.length, case.design.slant_deg) = (0.1, 0.4, 75.0);
    let solved = Evaluator::new(&Measure::USUAL).solve(designs::number(), &case);
    let events = solved.puncture.iter().flat_map(|puncture| &puncture.events);
    let mut pairs = events.map(|event| (event.left_scale, event.right_scale));
    assert!(pairs.any(|pair| pair == (Some(-1), Some(1))));
    // Only two parameters are compared, because differences need springs for each changed
    // footprint, which are slow to compute with full coupling.
    let is_compared =
        |by: &ParameterDerivative| ["gap_over_t", "slant_deg"].contains(&by.parameter);
    let compared: Vec<_> = derivatives(&case).into_iter().filter(is_compared).collect();
    assert!(compare_components(&case, &compared, &Differences::of(&case)) > 20);
}

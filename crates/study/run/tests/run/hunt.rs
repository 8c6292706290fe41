//! Random designs with every combination of features: how their paths end, and how long they take.

use std::collections::BTreeMap;
use std::time::Duration;

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use results::Outcome;
use run::Evaluator;
use skin::Base;
use skin::flexure::Method;
use skin::puncture::{Needle, RowLength};
use substrate::{Coupling, SubstrateLaw};
use sweep::{Case, Measure};

use super::sensitivity::designs::number;

/// Draws a design with a random choice of features; each has its default in some designs.
pub fn mixed_case(seed: u64) -> Case {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut even = |low: f64, high: f64| random.random_range(low..high);
    let mut case = Case::default();
    case.design.gap = even(-4.0, 0.7).exp();
    case.design.length = even(-3.0, 1.4).exp();
    case.design.slant_deg = if even(0.0, 1.0) < 0.2 { 0.0 } else { even(0.0, 80.0) };
    case.design.base = if even(0.0, 1.0) < 0.5 { Base::L } else { Base::TwoL };
    case.design.width = even(-2.0, 1.1).exp();
    if even(0.0, 1.0) < 0.3 {
        case.common.friction = even(0.0, 0.6);
    }
    if even(0.0, 1.0) < 0.5 {
        (case.common.law.c1, case.common.law.c2) = (even(-1.0, 1.5).exp(), even(0.2, 1.5));
    }
    let puncture = &mut case.puncture;
    puncture.poisson_ratio = even(0.0, 0.5);
    puncture.contact_modulus_over_substrate = even(1.0, 9.0).exp();
    puncture.critical_tilt_deg = if even(0.0, 1.0) < 0.5 { 10.0 } else { even(1.0, 89.0) };
    puncture.load_position = if even(0.0, 1.0) < 0.5 { 1.0 } else { even(0.0, 1.0) };
    if even(0.0, 1.0) < 0.2 {
        puncture.scales = RowLength::Scales(even(1.0, 60.0) as usize);
    }
    if even(0.0, 1.0) < 0.3 {
        puncture.substrate_law = SubstrateLaw::NeoHookean;
    }
    if even(0.0, 1.0) < 0.6 {
        let friction = if even(0.0, 1.0) < 0.3 { 0.0 } else { even(0.0, 0.6) };
        puncture.needle = Needle::Guided { friction };
        if even(0.0, 1.0) < 0.4 {
            puncture.needle_radius = Some(even(-3.0, 1.0).exp());
        }
    }
    puncture.unload = even(0.0, 1.0) < 0.4;
    if even(0.0, 1.0) < 0.2 {
        puncture.places = Some(even(2.0, 12.0) as usize);
    }
    if even(0.0, 1.0) < 0.3 {
        case.tissue_thickness = Some(even(-0.7, 3.0).exp());
    }
    if even(0.0, 1.0) < 0.2 {
        case.coupling = Coupling::Full;
    }
    let flexure = &mut case.flexure;
    flexure.contact_modulus_over_membrane = even(1.0, 8.0).exp();
    flexure.membrane_thickness = even(-3.0, 0.0).exp();
    flexure.membrane_axis_offset = if even(0.0, 1.0) < 0.5 { 0.0 } else { even(-0.5, 0.5) };
    if even(0.0, 1.0) < 0.3 {
        flexure.method = Method::Chain;
        flexure.membrane_length = even(2.0, 40.0);
    }
    flexure.unload = even(0.0, 1.0) < 0.3;
    case
}

/// Returns the range of seeds in `SQUAMA_HUNT`, such as `0..2000`, or else a small one.
fn seeds() -> std::ops::Range<u64> {
    let range = std::env::var("SQUAMA_HUNT").unwrap_or_else(|_| "0..300".to_owned());
    let (from, to) = range.split_once("..").expect("a range of seeds");
    from.parse().expect("a seed")..to.parse().expect("a seed")
}

/// Returns the processor time of this thread.
fn processor_time() -> Duration {
    let statistics = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = statistics.split_whitespace().next().and_then(|n| n.parse().ok());
    Duration::from_nanos(nanoseconds.unwrap_or(0))
}

fn is_numeric(outcome: Outcome) -> bool {
    use Outcome::{Cycling, Internal, NoConvergence, NotFinite, Singular, TooManyPoints};
    matches!(outcome, Cycling | Internal | NoConvergence | NotFinite | Singular | TooManyPoints)
}

/// At most one path in a hundred ends for a numeric reason, and no design takes more than 10 s.
#[test]
#[ignore = "takes minutes; SQUAMA_HUNT=FROM..TO selects other seeds"]
fn few_mixed_designs_end_numerically() {
    let solved: Vec<(Vec<(&str, Outcome)>, Duration)> = seeds()
        .into_par_iter()
        .map(|seed| {
            let case = mixed_case(seed);
            let begun = processor_time();
            let evaluator = Evaluator::new(&[Measure::Puncture, Measure::Flexure]);
            let result = evaluator.row(number(), &case).result;
            let mut outcomes = Vec::new();
            if let Some(puncture) = result.puncture {
                outcomes.push(("puncture", puncture.outcome));
                outcomes.extend(puncture.weakest.map(|outcome| ("weakest", outcome)));
                outcomes.extend(puncture.way_back.map(|outcome| ("unloading", outcome)));
            }
            if let Some(flexure) = result.flexure {
                outcomes.push(("flexure", flexure.outcome));
                outcomes.extend(flexure.way_back.map(|outcome| ("unbending", outcome)));
            }
            let (time, numeric) = (
                processor_time().saturating_sub(begun),
                outcomes.iter().any(|(_, of)| is_numeric(*of)),
            );
            if numeric || time > Duration::from_secs(5) {
                println!("{seed}: {time:.1?} {outcomes:?}");
            }
            (outcomes, time)
        })
        .collect();
    let mut counts = BTreeMap::new();
    for (measure, outcome) in solved.iter().flat_map(|(outcomes, _)| outcomes) {
        *counts.entry((*measure, outcome.text())).or_insert(0) += 1;
    }
    println!("{counts:#?}");
    let all: usize = counts.values().sum();
    let numeric =
        solved.iter().flat_map(|(outcomes, _)| outcomes).filter(|(_, of)| is_numeric(*of));
    assert!(100 * numeric.count() <= all, "{counts:#?}");
    let longest = solved.iter().map(|(_, time)| *time).max();
    assert!(longest < Some(Duration::from_secs(10)), "{longest:?}");
}

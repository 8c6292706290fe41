//! Solves everything that must be solvable and counts what does not end as it should:
//!
//! ```text
//! cargo run --release -p skin --example robustness
//! ```
//!
//! The 720 designs of the reference study with either base, on a row of 41 scales, with the contact law
//! as printed and with its constants exchanged, at the reference contact modulus and at 1/100,
//! 100 and 10 000 times it; then 10 000 random designs with either law; then 20 000 to a tilt of 45°, on rows as long
//! as needed.
//!
//! Counts how paths end, and tells those that are complete at a load below zero or have no peak.

#[path = "../tests/samples/mod.rs"]
mod samples;

use std::collections::BTreeMap;
use std::iter::zip;
use std::time::Instant;

use contact::Law;
use rayon::prelude::*;
use skin::Design;
use skin::Status;
use skin::puncture::{Puncture, PunctureParameters};
use solver::Stop;
use substrate::Calibrations;

/// Names of the laws, in their order.
const NAMES: [&str; 2] = ["as printed", "exchanged"];

fn main() {
    let known = Calibrations::default();
    let study = samples::BASES.map(samples::reference_study).concat();
    for (name, law) in zip(NAMES, samples::LAWS) {
        for factor in [1e-2, 1.0, 1e2, 1e4] {
            let mut parameters = samples::on_row(41);
            parameters.contact_modulus_over_substrate *= factor;
            report(
                &format!("study, law {name}, modulus × {factor:e}"),
                &known,
                &study,
                law,
                &parameters,
            );
        }
    }
    for (name, law) in zip(NAMES, samples::LAWS) {
        let (name, designs) = (format!("random, law {name}"), samples::random(10_000, 1));
        report(&name, &known, &designs, law, &samples::on_row(41));
    }
    let steep = PunctureParameters { critical_tilt_deg: 45.0, ..PunctureParameters::default() };
    report("random, to 45°", &known, &samples::random(20_000, 2), Law::PRINTED, &steep);
}

/// How a puncture ended.
struct End {
    status: Status,
    iterations: usize,
    /// Whether it has a peak, and no force below zero.
    makes_sense: bool,
}

fn end(puncture: &Puncture) -> End {
    let measures = &puncture.measures;
    let pulls = measures.critical_force.is_some_and(|force| force < 0.0);
    let has_peak = measures.peak_force.is_some_and(|peak| peak > 0.0);
    End {
        status: puncture.status,
        iterations: puncture.history.len(),
        makes_sense: has_peak && !pulls,
    }
}

fn report(
    title: &str,
    known: &Calibrations,
    designs: &[Design],
    law: Law,
    parameters: &PunctureParameters,
) {
    let start = Instant::now();
    let ends: Vec<End> = designs
        .par_iter()
        .map(|design| end(&samples::solve_as(known, design, &samples::with_law(law), parameters)))
        .collect();
    let seconds = start.elapsed().as_secs_f64();
    let mut counts = BTreeMap::<String, usize>::new();
    for end in &ends {
        *counts.entry(format!("{:?}", end.status)).or_default() += 1;
    }
    let iterations: usize = ends.iter().map(|end| end.iterations).sum();
    println!("{title}: {counts:?}, {} iterations each, {seconds:.1} s", iterations / designs.len());
    let expected = [Status::Complete, Status::Stopped(Stop::Unloaded), Status::LimitPoint];
    for (design, End { status, makes_sense, .. }) in designs.iter().zip(&ends) {
        if !expected.contains(status) || !makes_sense {
            println!("    {status:?}, makes sense: {makes_sense}: {design:?}");
        }
    }
}

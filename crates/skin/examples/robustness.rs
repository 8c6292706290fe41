//! Solves everything that must be solvable and counts what does not end as it should:
//!
//! ```text
//! cargo run --release -p skin --example robustness
//! ```
//!
//! The 720 designs of the reference study with either base, on a row of 41 scales, with the contact law
//! as printed and with its constants exchanged, at the reference contact modulus and at 1/100,
//! 100 and 10 000 times it; then 10 000 random designs with either law.

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
}

/// How a puncture ended.
struct End {
    status: Status,
    iterations: usize,
}

fn end(puncture: &Puncture) -> End {
    End { status: puncture.status, iterations: puncture.history.len() }
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
    for (design, End { status, .. }) in designs.iter().zip(&ends) {
        if *status != Status::Complete {
            println!("    {status:?}: {design:?}");
        }
    }
}

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
use std::time::Instant;

use contact::Law;
use rayon::prelude::*;
use skin::Design;
use skin::Status;
use skin::puncture::{Parameters, Puncture};
use substrate::Calibrations;

const LAWS: [(&str, Law); 2] = [("as printed", Law::PRINTED), ("exchanged", Law::EXCHANGED)];

fn main() {
    let known = Calibrations::default();
    let study = samples::BASES.map(samples::reference_study).concat();
    for (name, law) in LAWS {
        for factor in [1e-2, 1.0, 1e2, 1e4] {
            let mut parameters = Parameters { law, ..samples::on_row(41) };
            parameters.contact_modulus_over_substrate *= factor;
            report(
                &format!("study, law {name}, modulus × {factor:e}"),
                &known,
                &study,
                &parameters,
            );
        }
    }
    for (name, law) in LAWS {
        let parameters = Parameters { law, ..samples::on_row(41) };
        report(&format!("random, law {name}"), &known, &samples::random(10_000, 1), &parameters);
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

fn report(title: &str, known: &Calibrations, designs: &[Design], parameters: &Parameters) {
    let start = Instant::now();
    let ends: Vec<End> = designs
        .par_iter()
        .map(|design| end(&samples::solve_with(known, design, parameters)))
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

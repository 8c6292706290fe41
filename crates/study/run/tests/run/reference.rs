//! New solutions agree with the committed tables of the paper's sweep.

use std::path::PathBuf;

use rayon::prelude::*;
use results::Results;
use results::columns::design_columns;
use run::Evaluator;
use sweep::Sweep;

/// Number of designs that are compared, and their distance in the grid.
///
/// The slant is the fastest axis of the grid, with six values.
const DESIGNS: u64 = 40;
const EVERY: u64 = 18;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// Returns a text for each cell that differs from the reference.
///
/// Numbers may differ by 1e-9 of the larger magnitude.
fn differences(ours: &[(&str, String)], reference: &Results, row: usize) -> Vec<String> {
    assert_eq!(ours.iter().map(|(name, _)| *name).collect::<Vec<_>>(), reference.header());
    ours.iter()
        .enumerate()
        .filter_map(|(column, (name, ours))| {
            let theirs = reference.text(row, column);
            let same = match (ours.parse::<f64>(), theirs.parse::<f64>()) {
                (Ok(a), Ok(b)) => (a - b).abs() <= 1e-9 * a.abs().max(b.abs()),
                _ => *ours == theirs,
            };
            // Numbers of path points and iterations may change without a change of results.
            let is_count = name.ends_with("_points") || name.ends_with("_iterations");
            // A value that is zero except for rounding has no significant digits.
            let is_zero =
                *name == "axial_energy_share" && theirs.parse().is_ok_and(|x: f64| x < 1e-20);
            // The error estimate is a difference of nearly equal values and has few significant
            // digits.
            let is_estimate = *name == "flexure_error";
            (!same && !is_count && !is_zero && !is_estimate)
                .then(|| format!("{name}: {ours} instead of {theirs}"))
        })
        .collect()
}

#[test]
fn forty_designs_of_the_paper_sweep_match_the_reference() {
    let sweep = Sweep::read(&root().join("sweeps/paper.toml"), &[]).expect("a sweep");
    let reference = Results::read(&root().join("results/reference/paper")).expect("tables");
    assert_eq!(reference.len() as u64, sweep.grid().len());
    let (evaluator, columns) = (Evaluator::new(sweep.measures()), design_columns(&sweep));
    // The selection contains every gap, length and slant.
    let chosen: Vec<u64> = (0..DESIGNS).map(|k| k * EVERY + k % EVERY).collect();
    let wrong: Vec<_> = chosen
        .par_iter()
        .flat_map(|&index| {
            let number = sweep.grid().number(index);
            let row = evaluator.solve(number, &sweep.grid().case(index)).row;
            let cells: Vec<_> =
                columns.iter().map(|c| (c.name.as_ref(), c.cell(&row).to_string())).collect();
            let wrong = differences(&cells, &reference, usize::try_from(index).expect("a row"));
            wrong.into_iter().map(|text| format!("{number}: {text}")).collect::<Vec<_>>()
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

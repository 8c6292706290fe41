//! Writes synthetic results of any size, without solving designs.

use std::fmt::Write as _;
use std::path::Path;

use results::columns::design_columns;
use sweep::Sweep;

/// Relation between the criteria of the designs.
#[derive(Clone, Copy, Debug)]
pub enum Criteria {
    /// Independent criteria: few designs are on the Pareto front.
    Independent,
    /// Conflicting criteria: no design dominates another design.
    Conflicting,
}

/// Writes `designs.csv` of a synthetic run of `50 × 50 × slants` designs.
///
/// Every column has cells. Designs with a slant below 5° have no coverage. `seed` changes only the
/// values of the criteria.
pub fn write_results(folder: &Path, slants: u32, criteria: Criteria, seed: u64) {
    let text = format!(
        "name = 'x'\ndesigns.gap_over_t = {{ from = 0.02, to = 1, step = 0.02 }}\n\
         designs.length_over_t = {{ from = 0.02, to = 1, step = 0.02 }}\n\
         designs.slant_deg = {{ from = 0, to = {}, step = 2 }}",
        2 * (slants - 1)
    );
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep");
    let names: Vec<_> =
        design_columns(&sweep).into_iter().map(|column| column.name.into_owned()).collect();
    let mut table = names.join(",");
    let grid = sweep.grid();
    for index in 0..grid.len() {
        let case = grid.case(index);
        let [coverage, force, depth, compliance] = values(criteria, index, seed);
        let coverage = if case.design.slant_deg < 5.0 { 0.0 } else { coverage };
        let (gap, length, slant) = (case.design.gap, case.design.length, case.design.slant_deg);
        let number = grid.number(index);
        let _ = write!(
            table,
            "\n{number},{gap},{length},{slant},{coverage},{force},{depth},{compliance}"
        );
        for name in &names[8..] {
            let text = if name.ends_with("_status") { "complete" } else { "0.1234567890123" };
            let _ = write!(table, ",{text}");
        }
    }
    std::fs::create_dir_all(folder).expect("a folder");
    std::fs::write(folder.join("designs.csv"), table).expect("writable");
}

fn values(criteria: Criteria, index: u64, seed: u64) -> [f64; 4] {
    let random = std::array::from_fn(|c| unit(index * 4 + c as u64 + seed));
    match criteria {
        Criteria::Independent => random,
        Criteria::Conflicting => {
            // The criteria are points of a sphere, where no point is larger in all coordinates.
            let norm = random.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
            let [coverage, force, resistance, compliance] = random.map(|x| x / norm);
            [coverage, force, 1.0 / resistance, compliance]
        }
    }
}

/// Returns a pseudo-random number between 0 and 1 (`splitmix64`).
fn unit(index: u64) -> f64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
}

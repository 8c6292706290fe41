//! Prints reference coefficients from fine meshes, the file `tests/springs/reference.csv`:
//!
//! ```text
//! cargo run --release -p squama-substrate --example reference \
//!     > crates/mechanics/substrate/tests/springs/reference.csv
//! ```
//!
//! The coefficients are extrapolated from 16 and 24 cells per side, which takes a few minutes. The
//! footprints cover the 720 designs of Shafiei et al. (2021) with a base of `L` and of `2L`
//! (`b = t`, `ν = 0.5`), and a grid over the range of the tests.

use std::error::Error;

use substrate::{Footprint, extrapolated};

const LENGTHS: [f64; 12] = [0.025, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "gap_over_a,width_over_a,poisson_ratio,alpha_x,alpha_y,alpha_phi,beta_x,beta_y,beta_phi"
    );
    for [gap, width, poisson_ratio] in geometries() {
        let footprint = Footprint::new(gap, width, poisson_ratio)?;
        let fine = extrapolated(&footprint, [16, 24])?;
        let fine = fine.map(|c| format!("{c:.6e}")).join(",");
        println!("{gap},{width},{poisson_ratio},{fine}");
    }
    Ok(())
}

fn geometries() -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for half_over_length in [0.5, 1.0] {
        for length in LENGTHS {
            let a = half_over_length * length;
            all.extend((1..=10).map(|gap| [f64::from(gap) / 10.0 / a, 1.0 / a, 0.5]));
        }
    }
    for width in [0.25, 1.0, 5.0, 20.0, 80.0] {
        for (gap, poisson_ratio) in [
            (0.017, 0.5),
            (0.05, 0.5),
            (0.05, 0.0),
            (0.25, 0.5),
            (1.5, 0.3),
            (8.0, 0.5),
            (80.0, 0.5),
        ] {
            all.push([gap, width, poisson_ratio]);
        }
    }
    // The same footprint can occur for two lengths, one with a base of L and one with a base of 2L.
    let mut seen = std::collections::HashSet::new();
    all.retain(|key| seen.insert(key.map(f64::to_bits)));
    all
}

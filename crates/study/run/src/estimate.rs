//! Estimates the time and disk space of a sweep from a few of its designs.

use std::time::{Duration, Instant};

use journal::Seal;
use results::DesignRow;
use results::columns::tables;
use sweep::Sweep;

use crate::run_journal::{JournalEntry, Line};
use crate::solve::evaluator::Evaluator;

/// Number of positions in the grid, and number of neighbouring designs solved at each position.
// Several positions, because the time varies over the grid. Neighbours, because neighbouring
// designs share springs in a run.
const POSITIONS: u64 = 8;
const NEIGHBOURS: u64 = 6;

/// Order in which the positions are solved; any number of first entries is spread over the grid.
// The middle is first, because the first designs of a grid are often the slowest.
const ORDER: [u64; POSITIONS as usize] = [4, 1, 6, 3, 0, 5, 2, 7];

/// Time after which no further design is solved for the estimate.
const PATIENCE: Duration = Duration::from_secs(2);

/// Estimated time and disk space of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Number of designs solved for the estimate.
    pub solved: u64,
    /// Estimated seconds on one thread.
    pub seconds: f64,
    /// Estimated bytes of journal and tables.
    pub bytes: f64,
}

impl Estimate {
    /// Solves a few designs of `sweep`, evenly spread over its grid, and extrapolates to all
    /// designs.
    pub fn solve(sweep: &Sweep) -> Self {
        let (evaluator, grid) = (Evaluator::new(sweep.measures()), sweep.grid());
        let (begun, mut solved, mut bytes) = (Instant::now(), 0, 0);
        // Designs are solved on one thread; callers divide the time by the number of threads.
        for index in spread(grid.len()) {
            let row = evaluator.row(grid.number(index), &grid.case(index));
            bytes += disk_space(sweep, &row);
            solved += 1;
            if begun.elapsed() > PATIENCE {
                break;
            }
        }
        let factor = grid.len() as f64 / solved as f64;
        let seconds = begun.elapsed().as_secs_f64() * factor;
        Self { solved, seconds, bytes: bytes as f64 * factor }
    }
}

/// Returns the indices of neighbouring designs at a few positions of a grid.
fn spread(designs: u64) -> impl Iterator<Item = u64> {
    let first = move |position: u64| (2 * position + 1) * (designs / (2 * POSITIONS));
    // Visit all positions before any neighbour, because slow designs leave time for only a few.
    let all = (0..NEIGHBOURS).flat_map(move |next| ORDER.map(|position| first(position) + next));
    all.filter(move |index| *index < designs)
}

/// Returns the number of bytes of a design in journal and tables.
fn disk_space(sweep: &Sweep, row: &DesignRow) -> usize {
    let (design, result) = (row.number.index() + 1, row.result.clone());
    // Six digits are typical for the times in a journal.
    let entry = JournalEntry { design, rerun: 0, at: 0.123_456, seconds: 0.123_456, result };
    let journal = Seal::default().seal(&Line::Design(Box::new(entry))).len();
    let layouts = tables(sweep);
    let columns = layouts.iter().flat_map(|layout| &layout.columns);
    // Add one byte for the comma or line end after each cell.
    journal + columns.map(|column| column.cell(row).to_string().len() + 1).sum::<usize>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn designs_of_an_estimate_are_spread_over_the_grid() {
        let chosen: Vec<_> = spread(16_000).collect();
        assert_eq!(chosen.len(), 48);
        // The first eight designs are in eight different parts of the grid, because slow designs
        // leave time for only a few.
        let mut parts: Vec<_> = chosen[..8].iter().map(|index| index / 2000).collect();
        parts.sort_unstable();
        assert_eq!(parts, [0, 1, 2, 3, 4, 5, 6, 7]);
    }

    #[test]
    fn estimated_disk_space_is_proportional_to_the_number_of_designs() {
        let bytes = |values: u32| {
            let text = format!(
                "name = 'x'\nmeasures = 'coverage'\n[designs]\ngap_over_t = {{ from = 1, to = {values}, step = 1 }}"
            );
            Estimate::solve(&Sweep::parse(&text, "x.toml", &[]).expect("a sweep")).bytes
        };
        let ratio = bytes(200) / bytes(100);
        assert!((ratio - 2.0).abs() < 0.1, "{ratio}");
    }
}

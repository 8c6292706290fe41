//! Estimates the time and disk space of a sweep from a few of its designs.

use std::time::{Duration, Instant};

use journal::Seal;
use results::DesignRow;
use results::columns::tables;
use sweep::Sweep;

use crate::run_journal::{JournalEntry, Line};
use crate::solve::evaluator::Evaluator;

/// Number of positions in the grid, and of neighbouring designs at each.
// Several positions, because the cost varies over the grid; neighbours, because they share springs.
const POSITIONS: u64 = 8;
const NEIGHBOURS: u64 = 6;

/// Order of the positions; every prefix of it is spread over the grid.
// The middle first, because the first designs of a grid are often the costliest.
const ORDER: [u64; POSITIONS as usize] = [4, 1, 6, 3, 0, 5, 2, 7];

/// Maximum time of an estimate, plus the design in progress.
const PATIENCE: Duration = Duration::from_secs(2);

/// Estimated time and disk space of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Number of designs solved for the estimate.
    pub solved: u64,
    /// Seconds on one thread.
    pub seconds: f64,
    /// Bytes of journal and tables.
    pub bytes: f64,
}

impl Estimate {
    /// Solves a few designs of `sweep`, evenly spread, and extrapolates.
    pub fn solve(sweep: &Sweep) -> Self {
        let (evaluator, grid) = (Evaluator::new(sweep.measures()), sweep.grid());
        let (begun, mut solved, mut bytes) = (Instant::now(), 0, 0);
        // Time on one thread; callers divide it by the number of threads.
        for index in spread(grid.len()) {
            let row = evaluator.row(grid.number(index), &grid.case(index));
            bytes += disk_space(sweep, &row);
            solved += 1;
            if begun.elapsed() > PATIENCE {
                break;
            }
        }
        let share = grid.len() as f64 / solved as f64;
        let seconds = begun.elapsed().as_secs_f64() * share;
        Self { solved, seconds, bytes: bytes as f64 * share }
    }
}

/// Selects neighbouring designs at a few positions of a grid.
fn spread(designs: u64) -> impl Iterator<Item = u64> {
    let first = move |place: u64| (2 * place + 1) * (designs / (2 * POSITIONS));
    // All positions before any neighbours, because slow designs leave time for only a few.
    let all = (0..NEIGHBOURS).flat_map(move |next| ORDER.map(|place| first(place) + next));
    all.filter(move |index| *index < designs)
}

/// Returns the bytes of a design in journal and tables.
fn disk_space(sweep: &Sweep, row: &DesignRow) -> usize {
    let (design, result) = (row.number.index() + 1, row.result.clone());
    // Times of six digits are typical.
    let entry = JournalEntry { design, rerun: 0, at: 0.123_456, seconds: 0.123_456, result };
    let journal = Seal::default().seal(&Line::Design(Box::new(entry))).len();
    let layouts = tables(sweep);
    let columns = layouts.iter().flat_map(|layout| &layout.columns);
    // Each cell with the comma or line end after it.
    journal + columns.map(|column| column.cell(row).to_string().len() + 1).sum::<usize>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_sample_all_parts_of_a_grid() {
        let chosen: Vec<_> = spread(16_000).collect();
        assert_eq!(chosen.len(), 48);
        // Slow designs leave time for only a few, so the first ones are from different parts.
        let mut places: Vec<_> = chosen[..8].iter().map(|index| index / 2000).collect();
        places.sort_unstable();
        assert_eq!(places, [0, 1, 2, 3, 4, 5, 6, 7]);
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

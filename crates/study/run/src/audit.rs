//! The audit of a run: solves a fraction of its designs again by a second method.
//!
//! There are two second methods. Steps a tenth as large must not change any result. Bending as a
//! chain of all gaps must agree with one gap that represents all; the number of gaps is then
//! rounded, so that both methods solve the same problem.

use std::path::Path;

use results::columns::design_columns;
use results::{Cell, Column, DesignRow, ResultsFolder};
use skin::flexure::{self, Method};
use sweep::{Case, DesignNumber, Measure, Sweep};

use crate::options::Options;
use crate::progress::RunError;
use crate::run_journal::Archive;
use crate::solve::evaluator::Evaluator;
use crate::solve::groups::Groups;
use crate::solve::workers;

/// Factor by which the steps of the second computation are smaller.
// Ten instead of two makes errors of first and second order obvious.
const SMALLER: f64 = 10.0;

/// Magnitude below which values count as zero.
// Measures are of order one; where symmetry makes them vanish, round-off remains.
const NOTHING: f64 = 1e-9;

/// The golden ratio minus one.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Maximum number of gaps of a chain in an audit.
// A longer chain is the same problem and only takes longer.
const LONGEST_CHAIN: usize = 1000;

/// The second method for solving a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SecondMethod {
    /// With steps a tenth as large.
    SmallerSteps,
    /// As a chain of all gaps.
    Chain,
}

/// Largest difference in one column.
#[derive(Clone, Debug, PartialEq)]
pub struct LargestDifference {
    /// Column of `designs.csv`.
    pub column: String,
    /// Second method.
    pub method: SecondMethod,
    /// Difference relative to the larger value.
    pub relative: f64,
    /// Design with this difference.
    pub design: DesignNumber,
    /// Value of the run (or of the unit cell), and value of the second method.
    pub values: [f64; 2],
}

/// Result of an audit.
#[derive(Clone, Debug, Default)]
pub struct Audit {
    /// Number of designs that were solved again.
    pub designs: u64,
    /// Largest difference of each column and method, the largest first.
    pub differences: Vec<LargestDifference>,
    /// Cells with different texts, or without a value in one method only.
    ///
    /// Each item has the column, the design and both texts.
    pub contradictions: Vec<(String, DesignNumber, [String; 2])>,
}

/// A design that was solved again.
struct Audited {
    index: u64,
    /// Row with smaller steps, to be compared with the row in the journal.
    finer: DesignRow,
    chain: Option<[DesignRow; 2]>,
}

impl Audit {
    /// Solves a `fraction` (0 to 1) of the designs of the run in `folder` again, and compares.
    ///
    /// # Errors
    ///
    /// If the journal cannot be read, or the threads cannot be started.
    pub fn solve(folder: &Path, fraction: f64, options: &Options<'_>) -> Result<Self, RunError> {
        let archive = Archive::open(&ResultsFolder::new(folder))?;
        let sweep = archive.sweep();
        let columns = design_columns(sweep);
        // Select all designs first, because selected designs are far apart in the grid, and groups
        // compare neighbours.
        let chosen: Vec<_> = every(fraction, archive.finished()).collect();
        let mut entries = archive.entries()?;
        let mut audit = Self::default();
        let groups = Groups::new(sweep.grid(), chosen.into_iter());
        let auditor = Auditor::new(sweep);
        workers::solve(
            options.threads,
            options.stop,
            groups,
            |index| auditor.solve(index),
            |audited: Audited| {
                let position = archive.designs().position(audited.index);
                let entry = position.map(|position| entries.last(position)).transpose()?.flatten();
                // A design that was solved again with other settings differs from the sweep.
                if let Some(entry) = entry.filter(|entry| entry.result.settings.is_empty()) {
                    audit.compare(
                        &columns,
                        [&archive.row(entry), &audited.finer],
                        SecondMethod::SmallerSteps,
                    );
                    audit.designs += 1;
                }
                if let Some([cell, chain]) = &audited.chain {
                    audit.compare(&columns, [cell, chain], SecondMethod::Chain);
                }
                Ok(())
            },
        )?;
        audit.differences.sort_by(|a, b| b.relative.total_cmp(&a.relative));
        Ok(audit)
    }

    /// Adds the differences between two rows of one design.
    fn compare(
        &mut self,
        columns: &[Column<DesignRow>],
        rows: [&DesignRow; 2],
        method: SecondMethod,
    ) {
        for column in columns.iter().filter(|column| is_physical(&column.name)) {
            let design = rows[0].number;
            match rows.map(|row| column.cell(row)) {
                [Cell::Number(first), Cell::Number(second)] => {
                    // Both are numbers, so their relative difference is recorded.
                    let relative = relative(first, second);
                    let (column, values) = (column.name.to_string(), [first, second]);
                    self.note(LargestDifference { column, method, relative, design, values });
                }
                // Different texts, such as statuses, have no size, so both are recorded.
                cells if cells[0] != cells[1] => {
                    let texts = cells.map(|cell| cell.to_string());
                    self.contradictions.push((column.name.to_string(), design, texts));
                }
                _ => {}
            }
        }
    }

    /// Stores a difference if it is the largest of its column and method.
    fn note(&mut self, new: LargestDifference) {
        // With some twenty columns and two methods, a list is faster than a map.
        match self
            .differences
            .iter_mut()
            .find(|old| old.column == new.column && old.method == new.method)
        {
            Some(old) if new.relative > old.relative => *old = new,
            Some(_) => {}
            None => self.differences.push(new),
        }
    }
}

/// Solves designs by the second methods.
struct Auditor<'s> {
    sweep: &'s Sweep,
    evaluator: Evaluator,
    flexure: Evaluator,
}

impl<'s> Auditor<'s> {
    fn new(sweep: &'s Sweep) -> Self {
        let evaluator = Evaluator::new(sweep.measures());
        Self { sweep, evaluator, flexure: Evaluator::new(&[Measure::Flexure]) }
    }

    fn solve(&self, index: u64) -> Audited {
        let (number, case) = (self.sweep.grid().number(index), self.sweep.grid().case(index));
        let finer = self.evaluator.row(number, &finer(case));
        let bends = self.sweep.measures().contains(&Measure::Flexure);
        let whole = bends.then(|| whole(case)).flatten();
        let bend = |case: Case| self.flexure.row(number, &case);
        Audited { index, finer, chain: whole.map(|cases| cases.map(bend)) }
    }
}

/// Returns the case with smaller steps and a larger limit on their number.
fn finer(mut case: Case) -> Case {
    let solver = &mut case.common.solver;
    solver.first_step /= SMALLER;
    solver.max_step /= SMALLER;
    solver.min_step /= SMALLER;
    // Otherwise paths with smaller steps would stop at the limit, with another status.
    solver.max_points = solver.max_points.saturating_mul(SMALLER as usize);
    case
}

/// Returns the case with a whole number of gaps, as a unit cell and as a chain.
fn whole(mut case: Case) -> Option<[Case; 2]> {
    let gaps = flexure::whole_gaps(&case.design.row().ok()?, &case.flexure);
    // The unit cell cannot represent unequal gaps, so compare perfect strips only.
    case.imperfection = skin::Imperfection::default();
    case.flexure.gaps = Some(gaps);
    (gaps <= LONGEST_CHAIN).then(|| {
        [Method::UnitCell, Method::Chain].map(|method| {
            case.flexure.method = method;
            case
        })
    })
}

/// Selects a `fraction` of `designs`, spread evenly at every period of the grid.
///
/// The multiples of the golden ratio modulo one have this property.
fn every(fraction: f64, designs: impl Iterator<Item = u64>) -> impl Iterator<Item = u64> {
    designs
        .enumerate()
        .filter(move |(ordinal, _)| (*ordinal as f64 * GOLDEN).fract() < fraction)
        .map(|(_, design)| design)
}

/// Returns true if a column does not depend on the solution method.
fn is_physical(column: &str) -> bool {
    // The second method changes the numbers of steps and iterations.
    let of_the_path = ["_points", "_iterations", "_error"];
    !of_the_path.iter().any(|end| column.ends_with(end)) && column != "scales"
}

/// Returns the difference of two numbers relative to the larger; 0 if both vanish.
fn relative(first: f64, second: f64) -> f64 {
    let larger = first.abs().max(second.abs());
    if larger < NOTHING { 0.0 } else { (first - second).abs() / larger }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selected_designs_are_spread_evenly() {
        let chosen = |share| every(share, 0..720).collect::<Vec<_>>();
        let tenth = chosen(0.1);
        assert!(tenth.len().abs_diff(72) <= 1, "{}", tenth.len());
        assert_eq!((chosen(1.0).len(), chosen(0.0).len()), (720, 0));
        // The selection contains every slant of six 12 times on average, and 8 to 16 times.
        for slant in 0..6 {
            let count = tenth.iter().filter(|index| **index % 6 == slant).count();
            assert!((8..=16).contains(&count), "{count} of slant {slant}");
        }
    }

    #[test]
    fn the_largest_difference_of_a_column_is_kept() {
        let sweep =
            Sweep::parse("name = 'x'\nmeasures = 'coverage'", "x.toml", &[]).expect("a sweep");
        let columns = design_columns(&sweep);
        let row = |index, coverage| {
            let (number, case) = (sweep.grid().number(index), sweep.grid().case(index));
            let result = results::DesignResult { coverage, ..results::DesignResult::default() };
            DesignRow { number, case, result }
        };
        let mut audit = Audit::default();
        for (index, values) in [(0, [0.5, 0.4]), (1, [0.5, 0.25]), (2, [0.5, 0.5])] {
            let rows = values.map(|coverage| row(index, Some(coverage)));
            audit.compare(&columns, [&rows[0], &rows[1]], SecondMethod::SmallerSteps);
        }
        audit.compare(&columns, [&row(3, Some(0.5)), &row(3, None)], SecondMethod::SmallerSteps);
        let found: Vec<_> =
            audit.differences.iter().filter(|found| found.column == "coverage").collect();
        assert_eq!((found.len(), found[0].relative), (1, 0.5));
        assert_eq!(found[0].design.to_string(), "0002");
        let [(column, design, texts)] = audit.contradictions.as_slice() else { panic!("one") };
        assert_eq!((column.as_str(), design.to_string().as_str()), ("coverage", "0004"));
        assert_eq!(texts, &["0.5".to_owned(), String::new()]);
    }
}

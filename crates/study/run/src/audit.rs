//! Audit of a run: solves a fraction of its designs again by a second method and compares results.
//!
//! Two second methods exist. One solves the paths with steps a tenth as large, which must not
//! change any result. The other solves bending as a chain of all gaps instead of a unit cell, one
//! gap that represents all gaps. Chain and unit cell must agree if the number of gaps is a whole
//! number.

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

/// Number by which the second computation divides the steps of the paths.
// Ten instead of two, so that errors of first and second order in the step become obvious.
const SMALLER: f64 = 10.0;

/// Magnitude below which values count as zero.
// Measures are of order one. Measures that are zero by symmetry contain only rounding errors.
const NEGLIGIBLE: f64 = 1e-9;

/// The golden ratio minus one.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Maximum number of gaps of a chain in an audit.
// A longer chain adds no information, because its gaps are equal, but takes longer.
const LONGEST_CHAIN: usize = 1000;

/// Second method for solving a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SecondMethod {
    /// Solves the paths with steps a tenth as large.
    SmallerSteps,
    /// Solves bending as a chain of all gaps.
    Chain,
}

/// Largest difference between both methods in one column.
#[derive(Clone, Debug, PartialEq)]
pub struct LargestDifference {
    /// Name of the column of `designs.csv`.
    pub column: String,
    /// Second method that gave this difference.
    pub method: SecondMethod,
    /// Difference divided by the larger magnitude.
    pub relative: f64,
    /// Number of the design with this difference.
    pub design: DesignNumber,
    /// Value in the run (for a chain: of the unit cell), and value of the second method.
    pub values: [f64; 2],
}

/// Result of an audit.
#[derive(Clone, Debug, Default)]
pub struct Audit {
    /// Number of designs that were solved again.
    pub designs: u64,
    /// Largest difference of each column and method, in descending order.
    pub differences: Vec<LargestDifference>,
    /// Cells that differ in their text, or have a value in one method only.
    ///
    /// Each item holds the column, the design, and the texts of both methods.
    pub contradictions: Vec<(String, DesignNumber, [String; 2])>,
}

/// Results of the second methods for one design.
struct Audited {
    index: u64,
    /// Row with smaller steps, to be compared with the row in the journal.
    finer: DesignRow,
    /// Rows of the unit cell and of the chain; `None` without bending, or if the chain is too long.
    chain: Option<[DesignRow; 2]>,
}

impl Audit {
    /// Solves a `fraction` (0 to 1) of the designs of the run in `folder` again, and compares rows.
    ///
    /// # Errors
    ///
    /// If the journal cannot be read, or the threads cannot be started.
    pub fn solve(folder: &Path, fraction: f64, options: &Options<'_>) -> Result<Self, RunError> {
        let archive = Archive::open(&ResultsFolder::new(folder))?;
        let sweep = archive.sweep();
        let columns = design_columns(sweep);
        // Select all designs before they are grouped: a group contains neighbours in this list,
        // which are far apart in the grid.
        let chosen: Vec<_> = selected(fraction, archive.finished()).collect();
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
                // A design that a rerun solved with other settings is not comparable with the
                // sweep.
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

    /// Records the differences between two rows of one design.
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
                    // For numbers, record the relative difference; texts have none, see the next
                    // arm.
                    let relative = relative(first, second);
                    let (column, values) = (column.name.to_string(), [first, second]);
                    self.note(LargestDifference { column, method, relative, design, values });
                }
                // Texts such as statuses have no magnitude, so both texts are recorded.
                cells if cells[0] != cells[1] => {
                    let texts = cells.map(|cell| cell.to_string());
                    self.contradictions.push((column.name.to_string(), design, texts));
                }
                _ => {}
            }
        }
    }

    /// Keeps a difference if it is the largest of its column and method.
    fn note(&mut self, new: LargestDifference) {
        // Linear search: there are only about twenty columns and two methods.
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

/// Solves designs of a sweep by the second methods.
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

/// Returns the case with smaller steps, and with a larger limit on the number of path points.
fn finer(mut case: Case) -> Case {
    let solver = &mut case.common.solver;
    solver.first_step /= SMALLER;
    solver.max_step /= SMALLER;
    solver.min_step /= SMALLER;
    // Without a larger limit, paths with smaller steps would reach the limit and have another
    // status.
    solver.max_points = solver.max_points.saturating_mul(SMALLER as usize);
    case
}

/// Returns the case as a unit cell and as a chain, both with the same whole number of gaps.
///
/// Returns `None` if the scales overlap at rest or the chain is longer than [`LONGEST_CHAIN`].
fn whole(mut case: Case) -> Option<[Case; 2]> {
    let gaps = flexure::whole_gaps(&case.design.row().ok()?, &case.flexure);
    // Only perfect strips, because a unit cell cannot represent unequal gaps.
    case.imperfection = skin::Imperfection::default();
    case.flexure.gaps = Some(gaps);
    (gaps <= LONGEST_CHAIN).then(|| {
        [Method::UnitCell, Method::Chain].map(|method| {
            case.flexure.method = method;
            case
        })
    })
}

/// Selects a `fraction` of `designs`, spread evenly along every axis of the grid.
///
/// A design is selected if its position in `designs`, times the golden ratio, modulo one, is below
/// `fraction`.
fn selected(fraction: f64, designs: impl Iterator<Item = u64>) -> impl Iterator<Item = u64> {
    designs
        .enumerate()
        .filter(move |(ordinal, _)| (*ordinal as f64 * GOLDEN).fract() < fraction)
        .map(|(_, design)| design)
}

/// Returns true if the value of a column should not depend on the numerical method.
fn is_physical(column: &str) -> bool {
    // Numbers of path points and iterations and error estimates depend on the method.
    let of_the_path = ["_points", "_iterations", "_error"];
    !of_the_path.iter().any(|end| column.ends_with(end)) && column != "scales"
}

/// Returns the difference of two numbers divided by the larger magnitude; 0 if both vanish.
fn relative(first: f64, second: f64) -> f64 {
    let larger = first.abs().max(second.abs());
    if larger < NEGLIGIBLE { 0.0 } else { (first - second).abs() / larger }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selected_designs_are_spread_evenly() {
        let chosen = |fraction| selected(fraction, 0..720).collect::<Vec<_>>();
        let tenth = chosen(0.1);
        assert!(tenth.len().abs_diff(72) <= 1, "{}", tenth.len());
        assert_eq!((chosen(1.0).len(), chosen(0.0).len()), (720, 0));
        // Each of six slants occurs 12 times on average, and 8 to 16 times in this selection.
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
        let [(column, design, texts)] = audit.contradictions.as_slice() else { panic!("one text") };
        assert_eq!((column.as_str(), design.to_string().as_str()), ("coverage", "0004"));
        assert_eq!(texts, &["0.5".to_owned(), String::new()]);
    }
}

//! Requirements that no design meets: which design comes nearest, and which requirement stands in the way.

use results::{InvalidResults, Results};

use crate::filter::RequirementFilter;
use crate::requirement::Requirement;

/// Requirements that no design meets.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmet {
    /// Each requirement, and how far the designs are from it.
    pub requirements: Vec<UnmetRequirement>,
    /// The row of the design that comes nearest: its largest shortfall is the least, then their sum. `None` if
    /// every design lacks a value that is required.
    pub nearest: Option<usize>,
}

/// One of the requirements that no design meets together.
#[derive(Clone, Debug, PartialEq)]
pub struct UnmetRequirement {
    /// The requirement.
    pub requirement: Requirement,
    /// The number of designs that meet it.
    pub met: usize,
    /// The number of designs that meet all the others.
    pub met_without: usize,
    /// The value of the nearest design in its column.
    pub nearest: Option<f64>,
    /// How much of the limit the nearest design lacks.
    pub shortfall: f64,
}

impl UnmetRequirement {
    /// Whether it alone stands in the way: without it there are designs that meet all others.
    pub fn binds(&self) -> bool {
        self.met_without > 0
    }
}

impl Unmet {
    /// The obstacle to the requirements, none of which a design meets together.
    pub(crate) fn of(
        results: &Results,
        requirements: &[Requirement],
    ) -> Result<Self, InvalidResults> {
        let filter = RequirementFilter::new(results, requirements)?;
        let rows = (0..results.len()).map(|row| filter.values(row));
        let values = rows.collect::<Result<Vec<_>, _>>()?;
        let sizes = requirements.iter().enumerate().map(|(k, r)| size(&values, k, r));
        Ok(Self::by_sizes(&values, requirements, &sizes.collect::<Vec<_>>(), nearest))
    }

    /// The obstacle to the requirements among designs with these `values` in their columns, none of which meets them together and of which
    /// a search has found `nearest` to be that.
    pub fn of_search(
        values: &[Vec<Option<f64>>],
        requirements: &[Requirement],
        nearest: Option<usize>,
    ) -> Self {
        // The sizes that margins are relative to, by which the search went.
        let sizes: Vec<f64> = requirements.iter().map(Requirement::size).collect();
        Self::by_sizes(values, requirements, &sizes, |_| nearest)
    }

    fn by_sizes(
        values: &[Vec<Option<f64>>],
        requirements: &[Requirement],
        sizes: &[f64],
        nearest: impl Fn(&[Vec<f64>]) -> Option<usize>,
    ) -> Self {
        let shortfalls = |row: &Vec<Option<f64>>| -> Vec<f64> {
            let one = |(k, value): (usize, &Option<f64>)| {
                // What has no value in a required column is never the nearest.
                value.map_or(f64::INFINITY, |value| requirements[k].shortfall(value, sizes[k]))
            };
            row.iter().enumerate().map(one).collect()
        };
        let all: Vec<_> = values.iter().map(shortfalls).collect();
        let nearest = nearest(&all);
        let report = |(k, requirement): (usize, &Requirement)| UnmetRequirement {
            requirement: requirement.clone(),
            // Exactly 0: what misses a strict bound by nothing has the least number there is.
            met: all.iter().filter(|row| row[k] == 0.0).count(),
            met_without: all.iter().filter(|row| meets_others(row, k)).count(),
            nearest: nearest.and_then(|row| values[row][k]),
            shortfall: nearest.map_or(f64::INFINITY, |row| all[row][k]),
        };
        let requirements = requirements.iter().enumerate().map(report).collect();
        Self { requirements, nearest }
    }
}

/// Whether a design meets every requirement but one.
fn meets_others(shortfalls: &[f64], one: usize) -> bool {
    shortfalls.iter().enumerate().all(|(k, shortfall)| k == one || *shortfall == 0.0)
}

/// The size that shortfalls are relative to: the limit, or the largest value of the column if the limit is 0.
fn size(values: &[Vec<Option<f64>>], k: usize, requirement: &Requirement) -> f64 {
    let found = values.iter().filter_map(|row| row[k]);
    // A limit of 0 has no size, without which shortfalls in other units could not be compared.
    let largest = || found.fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let size = if requirement.limit == 0.0 { largest() } else { requirement.limit.abs() };
    if size > 0.0 { size } else { 1.0 }
}

/// The row whose largest shortfall is the least, then the sum; of equal ones the first.
fn nearest(shortfalls: &[Vec<f64>]) -> Option<usize> {
    let distance = |row: &[f64]| (row.iter().copied().fold(0.0, f64::max), row.iter().sum::<f64>());
    let rows = shortfalls.iter().enumerate().map(|(k, row)| (distance(row), k));
    let finite = rows.filter(|((largest, _), _)| largest.is_finite());
    let first = finite.min_by(|((a, b), _), ((c, d), _)| a.total_cmp(c).then(b.total_cmp(d)));
    first.map(|(_, row)| row)
}

//! Analyses requirements that no design meets together: nearest design and binding requirements.

use results::{InvalidResults, Results};

use crate::filter::RequirementFilter;
use crate::requirement::Requirement;

/// Requirements that no design meets together, and the nearest design.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmet {
    /// Requirements with the shortfalls of the nearest design.
    pub requirements: Vec<UnmetRequirement>,
    /// Row of the nearest design, which has the smallest maximum of its relative shortfalls.
    ///
    /// Among designs with equal maxima, the nearest has the smallest sum of shortfalls. `None` if
    /// every design lacks a required value.
    pub nearest: Option<usize>,
}

/// One of the requirements that no design meets together.
#[derive(Clone, Debug, PartialEq)]
pub struct UnmetRequirement {
    /// The requirement.
    pub requirement: Requirement,
    /// Number of designs that meet this requirement.
    pub met: usize,
    /// Number of designs that meet all other requirements.
    pub met_without: usize,
    /// Value of the required column in the nearest design.
    pub nearest: Option<f64>,
    /// Shortfall of the nearest design, relative to the limit.
    pub shortfall: f64,
}

impl UnmetRequirement {
    /// Returns true if some designs miss only this requirement.
    pub fn binds(&self) -> bool {
        self.met_without > 0
    }
}

impl Unmet {
    /// Analyses requirements that no design in `results` meets together.
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

    /// Analyses requirements that no evaluated design of a search meets together.
    ///
    /// `values` contains the values of the required columns for each design, and `nearest` is the
    /// index of the nearest design according to the search.
    pub fn of_search(
        values: &[Vec<Option<f64>>],
        requirements: &[Requirement],
        nearest: Option<usize>,
    ) -> Self {
        // The shortfalls must be relative to the same sizes as in the search.
        let sizes: Vec<f64> = requirements.iter().map(Requirement::size).collect();
        Self::by_sizes(values, requirements, &sizes, |_| nearest)
    }

    fn by_sizes(
        values: &[Vec<Option<f64>>],
        requirements: &[Requirement],
        sizes: &[f64],
        nearest: impl Fn(&[Vec<f64>]) -> Option<usize>,
    ) -> Self {
        let all: Vec<_> = values
            .iter()
            .map(|row| -> Vec<f64> {
                let shortfalls = row.iter().enumerate().map(|(k, value)| {
                    // A design without a required value is never the nearest.
                    value.map_or(f64::INFINITY, |value| requirements[k].shortfall(value, sizes[k]))
                });
                shortfalls.collect()
            })
            .collect();
        let nearest = nearest(&all);
        let requirements =
            requirements.iter().enumerate().map(|(k, requirement)| UnmetRequirement {
                requirement: requirement.clone(),
                // Compare with exactly 0: a value at the limit of a strict inequality has a tiny
                // positive shortfall.
                met: all.iter().filter(|row| row[k] == 0.0).count(),
                met_without: all.iter().filter(|row| meets_others(row, k)).count(),
                nearest: nearest.and_then(|row| values[row][k]),
                shortfall: nearest.map_or(f64::INFINITY, |row| all[row][k]),
            });
        Self { requirements: requirements.collect(), nearest }
    }
}

/// Returns true if a design meets all requirements, without regard to the requirement `ignored`.
fn meets_others(shortfalls: &[f64], ignored: usize) -> bool {
    shortfalls.iter().enumerate().all(|(k, shortfall)| k == ignored || *shortfall == 0.0)
}

/// Returns the size by which shortfalls of requirement `k` are divided.
///
/// This is the magnitude of the limit or, if the limit is 0, the largest magnitude of the values.
fn size(values: &[Vec<Option<f64>>], k: usize, requirement: &Requirement) -> f64 {
    // Shortfalls in different columns are comparable only if they are relative to a size above 0.
    let size = if requirement.limit == 0.0 {
        values.iter().filter_map(|row| row[k]).fold(0.0, |size: f64, value| size.max(value.abs()))
    } else {
        requirement.limit.abs()
    };
    if size > 0.0 { size } else { 1.0 }
}

/// Returns the row with the smallest maximum shortfall and, among equals, the smallest sum.
///
/// Of several equal rows, returns the first. `None` if every row has an infinite shortfall.
fn nearest(shortfalls: &[Vec<f64>]) -> Option<usize> {
    let rows = shortfalls
        .iter()
        .enumerate()
        .map(|(k, row)| ((row.iter().copied().fold(0.0, f64::max), row.iter().sum::<f64>()), k));
    let finite = rows.filter(|((largest, _), _)| largest.is_finite());
    let first = finite.min_by(|((a, b), _), ((c, d), _)| a.total_cmp(c).then(b.total_cmp(d)));
    first.map(|(_, row)| row)
}

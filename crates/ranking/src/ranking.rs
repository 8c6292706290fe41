//! The ranking of designs: by weighted fitness, for all weights, and without any.

mod columns;

use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;
use results::{InvalidResults, OutputError, Results, RunFolder, write_rows};

use crate::criteria::{CRITERIA, Criterion, SOUND_CRITERIA, Weights};
use crate::front::{Criteria, pareto_front};
use crate::tetrahedral_grid::{Steps, TetrahedralGrid};
pub use columns::{pareto_columns, quaternary_columns, ranking_columns, winner_columns};

/// The designs of a run that can be ranked, with what is known of each whatever the weights.
#[derive(Clone, Debug)]
pub struct Ranking<'r> {
    results: &'r Results,
    grid: TetrahedralGrid,
    criteria: &'static [Criterion; 4],
    candidates: Vec<Contender>,
    /// The candidate that is best at each node of the grid.
    winners: Vec<usize>,
    left_out: BTreeMap<LeftOut, usize>,
}

/// A design that can be ranked.
#[derive(Clone, Debug)]
pub(crate) struct Contender {
    /// The row of the design in the results.
    pub row: usize,
    /// The values that the criteria are made from.
    pub values: Criteria,
    /// The criteria, larger being better (R1).
    criteria: Criteria,
    /// The criteria from 0, the worst, to 1, the best.
    pub rescaled: Criteria,
    logs: Criteria,
    /// Whether no other design beats it in every criterion.
    pub on_front: bool,
    /// Nodes of the grid of weights at which it is the best, and their part of the tetrahedron.
    pub nodes: u64,
    won: u64,
}

/// The reason why a design is not ranked: the first of these that holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LeftOut {
    /// The design leaves the substrate exposed.
    Exposed,
    /// A criterion (its place among the criteria, and its column) has no value.
    Missing(usize, &'static str),
    /// A criterion that is an inverse cannot be formed.
    NotPositive(usize, &'static str),
}

impl std::fmt::Display for LeftOut {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Exposed => f.write_str("coverage is 0"),
            Self::Missing(_, column) => write!(f, "no {column}"),
            Self::NotPositive(_, column) => write!(f, "{column} is not above 0"),
        }
    }
}

/// Results that hold no design to rank.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidRanking {
    /// The results cannot be read.
    #[error(transparent)]
    Results(#[from] InvalidResults),
    /// Every design is left out.
    #[error("{file}: no design can be ranked ({reasons}), expected one with all of {columns}")]
    Nothing {
        /// The table.
        file: String,
        /// The number of designs that are left out for each reason.
        reasons: String,
        /// The columns that a design needs.
        columns: String,
    },
}

/// A design at some weights: a row of the tables.
#[derive(Clone, Copy, Debug)]
pub struct RankedDesign<'a> {
    pub(crate) results: &'a Results,
    pub(crate) candidate: &'a Contender,
    whole: u64,
    /// The weights.
    pub weights: Weights,
    /// The fitness `f` (R3).
    pub fitness: f64,
    /// Place in the ranking by these weights, from 1.
    pub rank: usize,
}

impl<'a> RankedDesign<'a> {
    /// The row of the design in the results.
    pub fn row(&self) -> usize {
        self.candidate.row
    }

    /// The number of the design.
    pub fn design(&self) -> &'a str {
        self.results.design(self.candidate.row)
    }

    /// The values that its criteria are made from, in the order of [`CRITERIA`].
    pub fn values(&self) -> [f64; 4] {
        self.candidate.values
    }

    /// The criteria of the design, larger being better (R1), in the order of [`CRITERIA`].
    pub fn criteria(&self) -> [f64; 4] {
        self.candidate.criteria
    }

    /// The part of the tetrahedron of weights in which the design is the best.
    pub fn share(&self) -> f64 {
        self.candidate.won as f64 / self.whole as f64
    }

    /// Whether no other design beats it in every criterion.
    pub fn on_front(&self) -> bool {
        self.candidate.on_front
    }

    /// The criteria of the design from 0, the worst of the designs that are ranked, to 1, the best.
    pub fn rescaled(&self) -> [f64; 4] {
        self.candidate.rescaled
    }
}

impl<'r> Ranking<'r> {
    /// The designs of `results` that have every criterion; for all weights on `grid`.
    ///
    /// # Errors
    /// If a column is missing, a cell is no number, or no design remains.
    pub fn new(results: &'r Results, grid: TetrahedralGrid) -> Result<Self, InvalidRanking> {
        Self::by(results, grid, &CRITERIA)
    }

    /// The ranking by what the model can answer for: with the sound force in the place of the critical force.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn sound(results: &'r Results, grid: TetrahedralGrid) -> Result<Self, InvalidRanking> {
        Self::by(results, grid, &SOUND_CRITERIA)
    }

    fn by(
        results: &'r Results,
        grid: TetrahedralGrid,
        criteria: &'static [Criterion; 4],
    ) -> Result<Self, InvalidRanking> {
        let (rows, left_out) = sort_out(results, criteria)?;
        if rows.is_empty() {
            let reasons: Vec<_> = left_out.iter().map(|(why, n)| format!("{n}: {why}")).collect();
            let reasons = reasons.join("; ");
            let columns = criteria.each_ref().map(|criterion| criterion.column).join(", ");
            return Err(InvalidRanking::Nothing { file: results.file(), reasons, columns });
        }
        let mut candidates = candidates(&rows);
        let nodes: Vec<Steps> = grid.nodes().collect();
        let winners: Vec<usize> =
            nodes.par_iter().map(|&steps| best(&candidates, Weights::at(grid, steps))).collect();
        for (&winner, &steps) in winners.iter().zip(&nodes) {
            candidates[winner].nodes += 1;
            candidates[winner].won += TetrahedralGrid::cell(steps);
        }
        Ok(Self { results, grid, criteria, candidates, winners, left_out })
    }

    /// The number of designs that are ranked.
    #[expect(clippy::len_without_is_empty, reason = "a ranking is never empty")]
    pub fn len(&self) -> usize {
        self.candidates.len()
    }

    /// The criteria in the order of their weights.
    pub fn criteria(&self) -> &'static [Criterion; 4] {
        self.criteria
    }

    /// The grid of weights.
    pub fn grid(&self) -> TetrahedralGrid {
        self.grid
    }

    /// The number of designs that are left out for each reason.
    pub fn left_out(&self) -> &BTreeMap<LeftOut, usize> {
        &self.left_out
    }

    /// Criteria (places among [`CRITERIA`]) in which all designs are equal, so that they do not
    /// tell them apart.
    pub fn ties(&self) -> Vec<usize> {
        let first = self.candidates[0].criteria;
        let equal = |c: &usize| self.candidates.iter().all(|other| other.criteria[*c] == first[*c]);
        (0..CRITERIA.len()).filter(equal).collect()
    }

    /// All designs by fitness, the best first; equal ones in the order of their numbers.
    pub fn by_fitness(&self, weights: Weights) -> Vec<RankedDesign<'_>> {
        let mut order: Vec<_> = self
            .candidates
            .iter()
            .map(|candidate| (weights.log_fitness(&candidate.logs), candidate))
            .collect();
        // Stable, and candidates stand in the order of their numbers.
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let ranked = order.into_iter().enumerate();
        ranked.map(|(i, (_, candidate))| self.ranked(candidate, weights, i + 1)).collect()
    }

    /// The best design by `weights`.
    pub fn winner(&self, weights: Weights) -> RankedDesign<'_> {
        self.ranked(&self.candidates[best(&self.candidates, weights)], weights, 1)
    }

    /// The designs that no other beats in every criterion, in the order of their numbers.
    pub fn front(&self) -> Vec<RankedDesign<'_>> {
        let front = self.candidates.iter().filter(|candidate| candidate.on_front);
        front.map(|candidate| self.ranked(candidate, Weights::BALANCED, 0)).collect()
    }

    /// The designs that are best for some weights of the grid, the largest share first.
    pub fn winners(&self) -> Vec<RankedDesign<'_>> {
        let mut winners: Vec<_> = self.candidates.iter().filter(|c| c.nodes > 0).collect();
        winners.sort_by_key(|candidate| std::cmp::Reverse(candidate.won));
        winners.into_iter().map(|winner| self.ranked(winner, Weights::BALANCED, 0)).collect()
    }

    /// The best design at every node of the grid of weights.
    pub fn quaternary(&self) -> Vec<RankedDesign<'_>> {
        let at = |(steps, &winner): (Steps, &usize)| {
            self.ranked(&self.candidates[winner], Weights::at(self.grid, steps), 1)
        };
        self.grid.nodes().zip(&self.winners).map(at).collect()
    }

    fn ranked<'a>(
        &'a self,
        candidate: &'a Contender,
        weights: Weights,
        rank: usize,
    ) -> RankedDesign<'a> {
        let fitness = weights.log_fitness(&candidate.logs).exp();
        let whole = self.grid.whole();
        RankedDesign { results: self.results, candidate, whole, weights, fitness, rank }
    }
}

/// A row that can be ranked: its values, and the criteria that they make.
struct Eligible {
    row: usize,
    values: Criteria,
    criteria: Criteria,
}

/// The rows that can be ranked, and why the others cannot.
type SortedOut = (Vec<Eligible>, BTreeMap<LeftOut, usize>);

fn sort_out(
    results: &Results,
    criteria: &'static [Criterion; 4],
) -> Result<SortedOut, InvalidResults> {
    let mut columns = [0; 4];
    for (column, criterion) in columns.iter_mut().zip(criteria) {
        *column = results.column(criterion.column)?;
    }
    let (mut rows, mut left_out) = (Vec::new(), BTreeMap::new());
    for row in 0..results.len() {
        let mut values = [None; 4];
        for (value, column) in values.iter_mut().zip(columns) {
            *value = results.number(row, column)?;
        }
        match eligible(row, values, criteria) {
            Ok(eligible) => rows.push(eligible),
            Err(why) => *left_out.entry(why).or_insert(0) += 1,
        }
    }
    Ok((rows, left_out))
}

/// A row that has every value, with its criteria (R1).
fn eligible(
    row: usize,
    found: [Option<f64>; 4],
    all: &'static [Criterion; 4],
) -> Result<Eligible, LeftOut> {
    if found[0].is_some_and(|coverage| coverage <= 0.0) {
        return Err(LeftOut::Exposed);
    }
    let (mut values, mut criteria) = ([0.0; 4], [0.0; 4]);
    for (c, criterion) in all.iter().enumerate() {
        values[c] = found[c].ok_or(LeftOut::Missing(c, criterion.column))?;
        criteria[c] = if criterion.inverse { values[c].recip() } else { values[c] };
        if criterion.inverse && !(values[c] > 0.0 && criteria[c].is_finite()) {
            return Err(LeftOut::NotPositive(c, criterion.column));
        }
    }
    Ok(Eligible { row, values, criteria })
}

fn candidates(rows: &[Eligible]) -> Vec<Contender> {
    let criteria: Vec<Criteria> = rows.iter().map(|eligible| eligible.criteria).collect();
    let front = pareto_front(&criteria);
    let spans: [_; 4] = std::array::from_fn(|c| span(criteria.iter().map(|values| values[c])));
    let candidate = |(&Eligible { row, values, criteria }, on_front): (&Eligible, bool)| {
        let rescaled: Criteria = std::array::from_fn(|c| rescaled(criteria[c], spans[c]));
        let logs = rescaled.map(f64::ln);
        Contender { row, values, criteria, rescaled, logs, on_front, nodes: 0, won: 0 }
    };
    rows.iter().zip(front).map(candidate).collect()
}

fn span(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// A value from 0 at the smallest to 1 at the largest (R2); 1 if all are equal, so that they do
/// not count.
fn rescaled(value: f64, (low, high): (f64, f64)) -> f64 {
    if high > low { (value - low) / (high - low) } else { 1.0 }
}

/// The candidate of the largest fitness, the first of equal ones.
fn best(candidates: &[Contender], weights: Weights) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (i, candidate) in candidates.iter().enumerate() {
        let fitness = weights.log_fitness(&candidate.logs);
        if fitness > best.1 {
            best = (i, fitness);
        }
    }
    best.0
}

/// Writes the tables of `ranking`, with the ranking itself by `weights`, to `folder`; returns their
/// names.
///
/// # Errors
/// If the folder or the disk does not take them.
pub fn write_ranking(
    folder: &Path,
    ranking: &Ranking<'_>,
    weights: Weights,
) -> Result<[&'static str; 4], OutputError> {
    let folder = RunFolder::new(folder);
    folder.make()?;
    let parameters: Vec<_> = ranking.results.parameters().collect();
    let criteria = ranking.criteria;
    let [by_fitness, pareto, winners, quaternary] = RunFolder::RANKING;
    let format = ranking.results.format();
    let rows = ranking.by_fitness(weights);
    write_rows(&folder, by_fitness, format, &ranking_columns(&parameters, criteria), rows)?;
    write_rows(&folder, pareto, format, &pareto_columns(&parameters, criteria), ranking.front())?;
    write_rows(
        &folder,
        winners,
        format,
        &winner_columns(&parameters, criteria),
        ranking.winners(),
    )?;
    let rows = ranking.quaternary();
    write_rows(&folder, quaternary, format, &quaternary_columns(&parameters), rows)?;
    folder.sync();
    Ok(RunFolder::RANKING)
}

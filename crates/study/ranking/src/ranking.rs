//! The ranking of designs: by weighted fitness, for all weights, and without any.

mod columns;
mod contenders;

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

use rayon::prelude::*;
use results::columns::{name, parameter_of};
use results::round_off::ROUND_OFF;
use results::{
    Claim, InvalidResults, Maker, OutputError, Results, ResultsFolder, VerifiedFolder, write_rows,
};

use crate::criterion::Criterion;
use crate::incomparable::Incomparable;
use crate::preferences::Preferences;
use crate::tetrahedral_grid::{Steps, TetrahedralGrid};
use crate::unmet::Unmet;
use crate::weights::Weights;
pub use columns::{pareto_columns, quaternary_columns, ranking_columns, winner_columns};
use contenders::{Contenders, LeftOut};

/// The number of criteria whose weights fill a tetrahedron.
const FOUR: usize = 4;

/// The designs of a run that can be ranked, with what is known of each whatever the weights.
#[derive(Clone, Debug)]
pub struct Ranking<'r> {
    results: &'r Results,
    preferences: Preferences,
    grid: TetrahedralGrid,
    contenders: Contenders,
    /// The contender that is best at each node of the grid; none unless there are four criteria.
    winners: Vec<usize>,
    wins: BTreeMap<usize, Wins>,
    left_out: Vec<(String, usize)>,
}

/// The nodes of the grid of weights at which a design is the best, and their part of the tetrahedron.
#[derive(Clone, Copy, Debug, Default)]
struct Wins {
    nodes: usize,
    cells: u64,
}

/// Results that hold no design to rank.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
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
        /// The columns of the criteria.
        columns: String,
    },
    /// No design meets the requirements.
    #[error("no design meets all requirements")]
    Unmet(Unmet),
    /// Designs are not measured alike.
    #[error(transparent)]
    Incomparable(#[from] Incomparable),
}

/// A design at some weights: a row of the tables.
#[derive(Clone, Copy, Debug)]
pub struct RankedDesign<'a> {
    ranking: &'a Ranking<'a>,
    contender: usize,
    /// The weights.
    pub weights: Weights,
    /// The fitness `f` (R3, R8).
    pub fitness: f64,
    /// Place in the ranking by these weights, from 1. Designs that are equal but for round-off share their place.
    pub rank: usize,
}

impl<'a> RankedDesign<'a> {
    /// The row of the design in the results.
    pub fn row(&self) -> usize {
        self.ranking.contenders.rows[self.contender]
    }

    /// The number of the design.
    pub fn design(&self) -> &'a str {
        self.ranking.results.design(self.row())
    }

    /// The value that a criterion, named by its place, is made from.
    pub fn value(&self, criterion: usize) -> f64 {
        let column = self.ranking.contenders.columns[criterion];
        // A cell that is no number has ended the ranking before.
        self.ranking.results.table().number(self.row(), column).unwrap_or(f64::NAN)
    }

    /// A criterion of the design, named by its place, larger being better (R1).
    pub fn criterion(&self, criterion: usize) -> f64 {
        contenders::criterion(&self.ranking.preferences, criterion, self.value(criterion))
    }

    /// A criterion of the design, named by its place, from 0, the worst of the designs that are ranked, to 1, the best.
    pub fn rescaled(&self, criterion: usize) -> f64 {
        self.ranking.contenders.rescaled(criterion, self.criterion(criterion))
    }

    /// The part of the tetrahedron of weights in which the design is the best.
    pub fn share(&self) -> f64 {
        self.wins().cells as f64 / self.ranking.grid.whole() as f64
    }

    fn wins(&self) -> Wins {
        self.ranking.wins.get(&self.contender).copied().unwrap_or_default()
    }

    /// Whether no other design beats it in every criterion.
    pub fn on_front(&self) -> bool {
        self.ranking.contenders.on_front[self.contender]
    }
}

impl<'r> Ranking<'r> {
    /// The designs of `results` that have every criterion of the paper; for all weights on `grid`.
    ///
    /// # Errors
    /// If a column is missing, a cell is no number, or no design remains.
    pub fn new(results: &'r Results, grid: TetrahedralGrid) -> Result<Self, InvalidRanking> {
        Self::by(results, Preferences::paper(), grid)
    }

    /// The designs of `results` that meet the requirements and have every criterion of `preferences`; for all weights on
    /// `grid`, if there are four criteria.
    ///
    /// # Errors
    /// If a column is missing, a cell is no number, no design meets the requirements, or none remains.
    pub fn by(
        results: &'r Results,
        preferences: Preferences,
        grid: TetrahedralGrid,
    ) -> Result<Self, InvalidRanking> {
        let (contenders, reasons) = contenders::sort_out(results, &preferences)?;
        let unmet: usize = reasons.iter().filter(|(why, _)| why.is_unmet()).map(|(_, n)| n).sum();
        // A design that is left out for another reason meets them: they are not what is in the way.
        if unmet > 0 && unmet == results.len() {
            return Err(InvalidRanking::Unmet(Unmet::of(results, &preferences.requirements)?));
        }
        let words = |(why, count): (LeftOut, usize)| (why.in_words(&preferences), count);
        let left_out: Vec<_> = reasons.into_iter().map(words).collect();
        if contenders.rows.is_empty() {
            return Err(nothing(results, &preferences, &left_out));
        }
        let winners = winners(&contenders, grid);
        let mut wins: BTreeMap<usize, Wins> = BTreeMap::new();
        for (&winner, steps) in winners.iter().zip(grid.nodes()) {
            let own = wins.entry(winner).or_default();
            own.nodes += 1;
            own.cells += TetrahedralGrid::cell(steps);
        }
        Ok(Self { results, preferences, grid, contenders, winners, wins, left_out })
    }

    /// The results in `folder`, as far as a ranking by `preferences` reads them.
    ///
    /// # Errors
    /// As [`Results::read_from`].
    pub fn results(
        folder: &VerifiedFolder,
        preferences: &Preferences,
    ) -> Result<Results, InvalidResults> {
        let is_criterion = |column: &str| preferences.criteria.iter().any(|c| c.column == column);
        let is_required = |own: &str| preferences.requirements.iter().any(|r| r.column == own);
        Results::with_columns(folder, |column| {
            // Parameters are printed, and tell what is measured alike.
            let is_always = column == name::FOLD_FORCE || parameter_of(column).is_some();
            is_always || is_criterion(column) || is_required(column)
        })
    }

    /// The preferences that the ranking goes by.
    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// The number of designs that are ranked.
    #[expect(clippy::len_without_is_empty, reason = "a ranking is never empty")]
    pub fn len(&self) -> usize {
        self.contenders.rows.len()
    }

    /// The grid of weights.
    pub fn grid(&self) -> TetrahedralGrid {
        self.grid
    }

    /// The number of designs that are left out for each reason.
    pub fn left_out(&self) -> &[(String, usize)] {
        &self.left_out
    }

    /// Criteria, by their places, in which all designs are equal but for round-off, so that they do not tell them apart.
    pub fn ties(&self) -> Vec<usize> {
        let spans = self.contenders.spans.iter().enumerate();
        spans.filter(|(_, span)| span.is_none()).map(|(c, _)| c).collect()
    }

    /// All designs by fitness, the best first; those that are equal but for round-off in the order of their numbers.
    pub fn by_fitness(&self, weights: Weights) -> impl ExactSizeIterator<Item = RankedDesign<'_>> {
        let scored = self.contenders.terms().enumerate();
        let mut order: Vec<_> = scored.map(|(k, terms)| (weights.score(terms), k)).collect();
        // Stable, and contenders stand in the order of their numbers.
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut ranks = Vec::with_capacity(order.len());
        let mut rest = order.as_mut_slice();
        while let Some(&(best, _)) = rest.first() {
            // From the best on, not from one to the next: many small steps would make all equal.
            let equal = rest.partition_point(|(score, _)| is_as_good(*score, best));
            let (equals, others) = rest.split_at_mut(equal);
            // Within round-off their scores are no order: their numbers are.
            equals.sort_by_key(|(_, contender)| *contender);
            let rank = ranks.len() + 1;
            ranks.extend(equals.iter().map(|(_, contender)| (rank, *contender)));
            rest = others;
        }
        ranks.into_iter().map(move |(rank, contender)| self.ranked(contender, weights, rank))
    }

    /// The best design by `weights`.
    pub fn winner(&self, weights: Weights) -> RankedDesign<'_> {
        self.ranked(best(&self.contenders, weights), weights, 1)
    }

    /// The best of the designs under which the surface of the substrate does not fold over, if it does under the best of all; by
    /// the weights of the preferences. `None` also where the table does not tell.
    pub fn best_unfolded(&self) -> Option<RankedDesign<'_>> {
        let fold = self.results.column(name::FOLD_FORCE).ok()?;
        // A surface that does not fold has no force at its fold: the cell is empty.
        let is_open = |design: &RankedDesign<'_>| self.results.table().is_empty(design.row(), fold);
        let best = self.winner(self.preferences.weights);
        let others = || self.by_fitness(self.preferences.weights).find(is_open);
        if is_open(&best) { None } else { others() }
    }

    /// The number of other designs that are as good as the best one by `weights`, but for round-off.
    pub fn equals(&self, weights: Weights) -> usize {
        let scores = || self.contenders.terms().map(|terms| weights.score(terms));
        let largest = scores().fold(f64::NEG_INFINITY, f64::max);
        scores().filter(|score| is_as_good(*score, largest)).count() - 1
    }

    /// The designs that no other beats in every criterion, in the order of their numbers.
    pub fn front(&self) -> Vec<RankedDesign<'_>> {
        let all = (0..self.len()).map(|k| self.ranked(k, self.preferences.weights, 0));
        all.filter(RankedDesign::on_front).collect()
    }

    /// The knee of the front: of its designs the one whose criteria, each rescaled from 0, the worst of the front, to 1, the
    /// best, have the largest sum (R9), the first of equal ones. `None` for a front of fewer than three designs, or of one
    /// criterion.
    pub fn knee(&self) -> Option<RankedDesign<'_>> {
        let (front, count) = (self.front(), self.preferences.criteria.len());
        // Two designs are the ends of a front: no knee lies between them.
        if front.len() < 3 || count < 2 {
            return None;
        }
        let criteria = front.iter().flat_map(|design| (0..count).map(|c| design.criterion(c)));
        let sums = contenders::sums_of_rescaled(&criteria.collect::<Vec<_>>(), count);
        let largest = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        sums.iter().position(|sum| is_as_good(*sum, largest)).map(|knee| front[knee])
    }

    /// The designs that are best for some weights of the grid, the largest share first; none unless there are four criteria.
    pub fn winners(&self) -> Vec<RankedDesign<'_>> {
        let mut winners: Vec<_> = self.wins.iter().collect();
        // Stable: of equal shares the design of the smaller number stands first.
        winners.sort_by_key(|(_, wins)| std::cmp::Reverse(wins.cells));
        // No table of winners or of the front has a place: 0 stands for none.
        winners.into_iter().map(|(&winner, _)| self.ranked(winner, Weights::BALANCED, 0)).collect()
    }

    /// The best design at every node of the grid of weights; none unless there are four criteria.
    pub fn quaternary(&self) -> Vec<RankedDesign<'_>> {
        let at = |(steps, &winner): (Steps, &usize)| {
            self.ranked(winner, Weights::at(self.grid, steps), 1)
        };
        self.grid.nodes().zip(&self.winners).map(at).collect()
    }

    fn ranked(&self, contender: usize, weights: Weights, rank: usize) -> RankedDesign<'_> {
        let score = weights.score(self.contenders.terms().nth(contender).unwrap_or_default());
        let fitness = self.preferences.scale.fitness(score);
        RankedDesign { ranking: self, contender, weights, fitness, rank }
    }
}

fn nothing(
    results: &Results,
    preferences: &Preferences,
    left_out: &[(String, usize)],
) -> InvalidRanking {
    let reasons: Vec<_> = left_out.iter().map(|(why, n)| format!("{n}: {why}")).collect();
    let columns: Vec<&str> =
        preferences.criteria.iter().map(|c: &Criterion| c.column.as_ref()).collect();
    let (reasons, columns) = (reasons.join("; "), columns.join(", "));
    InvalidRanking::Nothing { file: results.file(), reasons, columns }
}

/// The contender that is best at each node of the grid; none unless there are four criteria.
fn winners(contenders: &Contenders, grid: TetrahedralGrid) -> Vec<usize> {
    if contenders.columns.len() != FOUR {
        return Vec::new();
    }
    let nodes: Vec<Steps> = grid.nodes().collect();
    let contest = |&steps: &Steps| best(contenders, Weights::at(grid, steps));
    // In the order of the nodes, whichever thread is first: `quaternary` counts on it.
    nodes.par_iter().map(contest).collect()
}

/// Whether a score is as good as the best one, but for round-off. Scores are logarithms, or parts of 1.
fn is_as_good(score: f64, best: f64) -> bool {
    score >= best - ROUND_OFF
}

/// The contender of the largest fitness, of those that are equal but for round-off the first.
fn best(contenders: &Contenders, weights: Weights) -> usize {
    let scores = || contenders.terms().map(|terms| weights.score(terms));
    let largest = scores().fold(f64::NEG_INFINITY, f64::max);
    scores().position(|score| is_as_good(score, largest)).unwrap_or(0)
}

/// Writes the tables of `ranking`, with the ranking itself by its weights, and what it goes by, to `folder`; returns the
/// names of the files, and the lock of the folder, for whoever reads them again. Without four criteria there are no tables for all weights.
///
/// # Errors
/// If the folder or the disk does not take them.
pub fn write_ranking(
    folder: &Path,
    ranking: &Ranking<'_>,
) -> Result<(Vec<&'static str>, File), OutputError> {
    let folder = ResultsFolder::new(folder);
    // Removes the earlier tables: those for all weights would outlive a change of the criteria.
    let claim = Claim::take(&folder, Maker::Ranking)?;
    let parameters: Vec<_> = ranking.results.parameters().collect();
    let [by_fitness, pareto, winners, quaternary] = ResultsFolder::RANKING;
    let format = ranking.results.format();
    let (parameters, preferences) = (&parameters, &ranking.preferences);
    let rows = ranking.by_fitness(preferences.weights);
    write_rows(&folder, by_fitness, format, &ranking_columns(parameters, preferences), rows)?;
    write_rows(&folder, pareto, format, &pareto_columns(parameters, preferences), ranking.front())?;
    folder.write_text(ResultsFolder::PREFERENCES, &preferences.to_toml())?;
    let mut files = vec![by_fitness, pareto, ResultsFolder::PREFERENCES];
    if preferences.criteria.len() == FOUR {
        write_rows(
            &folder,
            winners,
            format,
            &winner_columns(parameters, preferences),
            ranking.winners(),
        )?;
        write_rows(
            &folder,
            quaternary,
            format,
            &quaternary_columns(parameters, preferences),
            ranking.quaternary(),
        )?;
        files.splice(2..2, [winners, quaternary]);
    }
    let lock = claim.state(&files)?;
    Ok((files, lock))
}

/// Writes what a ranking that no design meets goes by to `folder`, and takes an earlier ranking away; returns the name of the
/// file, and the lock of the folder.
///
/// # Errors
/// If the folder or the disk does not take it.
pub fn write_unmet(
    folder: &Path,
    preferences: &Preferences,
) -> Result<(&'static str, File), OutputError> {
    let folder = ResultsFolder::new(folder);
    let claim = Claim::take(&folder, Maker::Ranking)?;
    // Kept although no design meets them: the page of the run opens with these requirements.
    folder.write_text(ResultsFolder::PREFERENCES, &preferences.to_toml())?;
    let lock = claim.state(&[ResultsFolder::PREFERENCES])?;
    Ok((ResultsFolder::PREFERENCES, lock))
}

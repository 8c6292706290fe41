//! Ranking of designs by weighted fitness, best designs for all weights, and Pareto front.

mod columns;
mod contenders;

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

use rayon::prelude::*;
use results::columns::{is_invalid_after_fold, name, parameter_of};
use results::{
    Claim, InvalidResults, Maker, OutputError, Results, ResultsFolder, VerifiedFolder, write_rows,
};

use crate::criterion::Criterion;
use crate::incomparable::{Incomparable, differing};
use crate::preferences::Preferences;
use crate::tetrahedral_grid::{Steps, TetrahedralGrid};
use crate::unmet::Unmet;
use crate::weights::Weights;
pub use columns::{pareto_columns, quaternary_columns, ranking_columns, winner_columns};
use contenders::Contenders;

/// Number of criteria for which the best designs for all weights are determined.
const FOUR: usize = 4;

/// The designs of a run that can be ranked, with all data that do not depend on weights.
#[derive(Clone, Debug)]
pub struct Ranking<'r> {
    results: &'r Results,
    preferences: Preferences,
    grid: TetrahedralGrid,
    contenders: Contenders,
    /// Best contender at each node of the grid; empty unless there are four criteria.
    winners: Vec<usize>,
    /// Nodes and volume of each contender that is the best at any node.
    wins: BTreeMap<usize, Wins>,
    /// Reasons to exclude designs, with the number of excluded designs.
    exclusions: Vec<(String, usize)>,
}

/// Extent of the weights for which a design is the best.
#[derive(Clone, Copy, Debug, Default)]
struct Wins {
    /// Number of nodes of the grid of weights.
    nodes: usize,
    /// Volume in the tetrahedron of weights, a part of [`TetrahedralGrid::whole`].
    cells: u64,
}

/// Error: designs cannot be ranked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InvalidRanking {
    /// The results cannot be read.
    #[error(transparent)]
    Results(#[from] InvalidResults),
    /// All designs are excluded.
    #[error("{file}: no design can be ranked ({reasons}), expected one with all of {columns}")]
    Nothing {
        /// File name of the table.
        file: String,
        /// Number of excluded designs for each reason.
        reasons: String,
        /// Columns of the criteria.
        columns: String,
    },
    /// No design meets the requirements.
    #[error("no design meets all requirements")]
    Unmet(Unmet),
    /// A criterion was measured under different conditions, so designs are incomparable.
    #[error(transparent)]
    Incomparable(#[from] Incomparable),
}

/// A design with its fitness for some weights. It is a row of the tables of a ranking.
#[derive(Clone, Copy, Debug)]
pub struct RankedDesign<'a> {
    ranking: &'a Ranking<'a>,
    contender: usize,
    /// Weights of the criteria.
    pub weights: Weights,
    /// Fitness `f` for these weights (R3, R8).
    pub fitness: f64,
    /// Rank for these weights, from 1; 0 in tables without a rank.
    ///
    /// Designs with equal fitness up to round-off share their rank.
    pub rank: usize,
}

impl<'a> RankedDesign<'a> {
    /// Returns the row of the design in the results.
    pub fn row(&self) -> usize {
        self.ranking.contenders.rows[self.contender]
    }

    /// Returns the number of the design.
    pub fn design(&self) -> &'a str {
        self.ranking.results.design(self.row())
    }

    /// Returns the value of the design in the column of the criterion with this index.
    pub fn value(&self, criterion: usize) -> f64 {
        let column = self.ranking.contenders.columns[criterion];
        // The cell is a number, which was checked when the ranking was created.
        self.ranking.results.table().number(self.row(), column).unwrap_or(f64::NAN)
    }

    /// Returns the criterion with this index for the design; larger is better (R1).
    pub fn criterion(&self, criterion: usize) -> f64 {
        contenders::criterion(&self.ranking.preferences, criterion, self.value(criterion))
    }

    /// Returns the criterion with this index for the design, rescaled from 0 (worst) to 1 (best).
    pub fn rescaled(&self, criterion: usize) -> f64 {
        self.ranking.contenders.rescaled(criterion, self.criterion(criterion))
    }

    /// Returns the fraction of all weights for which the design is the best.
    pub fn share(&self) -> f64 {
        self.wins().cells as f64 / self.ranking.grid.whole() as f64
    }

    fn wins(&self) -> Wins {
        self.ranking.wins.get(&self.contender).copied().unwrap_or_default()
    }

    /// Returns true if the design is on the Pareto front.
    pub fn on_front(&self) -> bool {
        self.ranking.contenders.on_front[self.contender]
    }
}

impl<'r> Ranking<'r> {
    /// Ranks the designs of `results` by the criteria of the paper.
    ///
    /// The best design is determined at every node of `grid`, a grid of weights.
    ///
    /// # Errors
    ///
    /// If a column is missing, a cell is not a number, or all designs are excluded.
    pub fn new(results: &'r Results, grid: TetrahedralGrid) -> Result<Self, InvalidRanking> {
        Self::by(results, Preferences::paper(), grid)
    }

    /// Ranks the designs of `results` by `preferences`.
    ///
    /// Designs are excluded if they miss a requirement, or if a criterion has no value. With four
    /// criteria, the best design is determined at every node of `grid`, a grid of weights.
    ///
    /// # Errors
    ///
    /// If a column is missing, a cell is not a number, or all designs are excluded.
    pub fn by(
        results: &'r Results,
        preferences: Preferences,
        grid: TetrahedralGrid,
    ) -> Result<Self, InvalidRanking> {
        let (contenders, reasons) = contenders::select(results, &preferences)?;
        let unmet: usize = reasons.iter().filter(|(why, _)| why.is_unmet()).map(|(_, n)| n).sum();
        // A design that is excluded for another reason meets all requirements. So no design meets
        // all requirements only if every design is excluded by a requirement.
        if unmet > 0 && unmet == results.len() {
            return Err(InvalidRanking::Unmet(Unmet::of(results, &preferences.requirements)?));
        }
        let exclusions: Vec<_> = reasons
            .into_iter()
            .map(|(why, count)| (why.description(&preferences), count))
            .collect();
        if contenders.rows.is_empty() {
            return Err(nothing(results, &preferences, &exclusions));
        }
        let winners = winners(&contenders, grid);
        let mut wins: BTreeMap<usize, Wins> = BTreeMap::new();
        for (&winner, steps) in winners.iter().zip(grid.nodes()) {
            let extent = wins.entry(winner).or_default();
            extent.nodes += 1;
            extent.cells += TetrahedralGrid::cell(steps);
        }
        Ok(Self { results, preferences, grid, contenders, winners, wins, exclusions })
    }

    /// Reads the results in `folder`, with only the columns that a ranking by `preferences` needs.
    ///
    /// # Errors
    ///
    /// See [`Results::read_from`].
    pub fn results(
        folder: &VerifiedFolder,
        preferences: &Preferences,
    ) -> Result<Results, InvalidResults> {
        Results::with_columns(folder, |column| {
            // Parameters are always needed: they are printed, and determine which designs are
            // comparable. The fold force is needed for the best design without a fold.
            let is_always = column == name::FOLD_FORCE || parameter_of(column).is_some();
            // A failure mode is printed beside its force.
            is_always
                || preferences.criteria.iter().any(|c| c.column == column)
                || preferences.requirements.iter().any(|r| r.column == column)
                || column == name::FIRST_FAILURE
        })
    }

    /// Returns the preferences of the ranking.
    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// Returns the number of ranked designs.
    #[expect(clippy::len_without_is_empty, reason = "a ranking is never empty")]
    pub fn len(&self) -> usize {
        self.contenders.rows.len()
    }

    /// Returns the grid of weights.
    pub fn grid(&self) -> TetrahedralGrid {
        self.grid
    }

    /// Returns the number of excluded designs for each reason.
    pub fn exclusions(&self) -> &[(String, usize)] {
        &self.exclusions
    }

    /// Returns the indices of criteria that are equal in all designs up to round-off.
    pub fn ties(&self) -> Vec<usize> {
        let spans = self.contenders.spans.iter().enumerate();
        spans.filter(|(_, span)| span.is_none()).map(|(c, _)| c).collect()
    }

    /// Returns all designs by fitness, the best first.
    ///
    /// Designs with equal fitness up to round-off are ordered by number.
    pub fn by_fitness(&self, weights: Weights) -> impl ExactSizeIterator<Item = RankedDesign<'_>> {
        let scored = self.contenders.terms().enumerate();
        let mut order: Vec<_> = scored.map(|(k, terms)| (weights.score(terms), k)).collect();
        // Stable sort: contenders with equal scores remain ordered by number.
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut ranks = Vec::with_capacity(order.len());
        let mut rest = order.as_mut_slice();
        while let Some(&(best, _)) = rest.first() {
            // Compare scores with the best score of this rank, not with the previous score:
            // otherwise a chain of small differences would make all designs equal.
            let equal = rest.partition_point(|(score, _)| is_as_good(*score, best));
            let (equals, others) = rest.split_at_mut(equal);
            // Order designs that are equal up to round-off by number.
            equals.sort_by_key(|(_, contender)| *contender);
            let rank = ranks.len() + 1;
            ranks.extend(equals.iter().map(|(_, contender)| (rank, *contender)));
            rest = others;
        }
        ranks.into_iter().map(move |(rank, contender)| self.ranked(contender, weights, rank))
    }

    /// Returns the best design for `weights`.
    pub fn winner(&self, weights: Weights) -> RankedDesign<'_> {
        self.ranked(best(&self.contenders, weights), weights, 1)
    }

    /// Returns the best design without a surface fold, if the surface folds in the best design.
    ///
    /// The weights are taken from the preferences. `None` if the surface does not fold in the best
    /// design, if the table has no column of fold forces, or if all criteria and requirements stay
    /// valid after a fold.
    pub fn best_unfolded(&self) -> Option<RankedDesign<'_>> {
        let fold = self.results.column(name::FOLD_FORCE).ok()?;
        let criteria = self.preferences.criteria.iter().map(|criterion| &criterion.column);
        let required = self.preferences.requirements.iter().map(|required| &*required.column);
        let mut columns = criteria.map(|column| &**column).chain(required);
        columns.find(|column| is_invalid_after_fold(column))?;
        // The cell of the fold force is empty if the surface does not fold.
        let is_unfolded =
            |design: &RankedDesign<'_>| self.results.table().is_empty(design.row(), fold);
        let weights = self.preferences.weights;
        if is_unfolded(&self.winner(weights)) {
            None
        } else {
            self.by_fitness(weights).find(is_unfolded)
        }
    }

    /// Counts the designs, besides the winner, with the best fitness for `weights` up to round-off.
    pub fn equals(&self, weights: Weights) -> usize {
        let scores = self.contenders.terms().map(|terms| weights.score(terms));
        let largest = scores.clone().fold(f64::NEG_INFINITY, f64::max);
        scores.filter(|score| is_as_good(*score, largest)).count() - 1
    }

    /// Returns the designs on the Pareto front, ordered by number.
    pub fn front(&self) -> Vec<RankedDesign<'_>> {
        let all = (0..self.len()).map(|k| self.ranked(k, self.preferences.weights, 0));
        all.filter(RankedDesign::on_front).collect()
    }

    /// Returns the knee of the front: largest sum of rescaled criteria (R9).
    ///
    /// Criteria are rescaled from 0, the worst on the front, to 1, the best. If several designs
    /// have the largest sum, returns the first. `None` if the front has fewer than three designs,
    /// or there is one criterion only.
    pub fn knee(&self) -> Option<RankedDesign<'_>> {
        let (front, count) = (self.front(), self.preferences.criteria.len());
        // A front of two designs consists of its ends, so there is no knee between the ends.
        if front.len() < 3 || count < 2 {
            return None;
        }
        let criteria = front.iter().flat_map(|design| (0..count).map(|c| design.criterion(c)));
        let sums = contenders::sums_of_rescaled(&criteria.collect::<Vec<_>>(), count);
        let largest = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        sums.iter().position(|sum| is_as_good(*sum, largest)).map(|knee| front[knee])
    }

    /// Returns the designs that are best for some weights on the grid.
    ///
    /// The design with the largest fraction comes first. Empty unless there are four criteria.
    pub fn winners(&self) -> Vec<RankedDesign<'_>> {
        let mut winners: Vec<_> = self.wins.iter().collect();
        // Stable sort: equal fractions are ordered by number.
        winners.sort_by_key(|(_, wins)| std::cmp::Reverse(wins.cells));
        // The table of winners has no ranks, so use the rank 0.
        winners.into_iter().map(|(&winner, _)| self.ranked(winner, Weights::BALANCED, 0)).collect()
    }

    /// Returns the best design at every node of the grid.
    ///
    /// Empty unless there are four criteria.
    pub fn quaternary(&self) -> Vec<RankedDesign<'_>> {
        self.grid
            .nodes()
            .zip(&self.winners)
            .map(|(steps, &winner)| self.ranked(winner, Weights::at(self.grid, steps), 1))
            .collect()
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
    exclusions: &[(String, usize)],
) -> InvalidRanking {
    let reasons: Vec<_> = exclusions.iter().map(|(why, n)| format!("{n}: {why}")).collect();
    let columns: Vec<&str> =
        preferences.criteria.iter().map(|c: &Criterion| c.column.as_ref()).collect();
    let (reasons, columns) = (reasons.join("; "), columns.join(", "));
    InvalidRanking::Nothing { file: results.file(), reasons, columns }
}

/// Returns the best contender at each node of the grid.
///
/// Empty unless there are four criteria.
fn winners(contenders: &Contenders, grid: TetrahedralGrid) -> Vec<usize> {
    if contenders.columns.len() != FOUR {
        return Vec::new();
    }
    let nodes: Vec<Steps> = grid.nodes().collect();
    // `collect` keeps the order of the nodes, which `quaternary` relies on.
    nodes.par_iter().map(|&steps| best(contenders, Weights::at(grid, steps))).collect()
}

/// Maximum round-off of a score, which is a sum of logarithms or of fractions.
///
/// Values of a criterion that are equal up to round-off have been made exactly equal, so only the
/// round-off of the sum remains.
const SUM_ROUND_OFF: f64 = 1e-12;

/// Returns true if `score` equals the best score `best` up to round-off.
///
/// Scores are logarithms or fractions of 1, so an absolute tolerance is appropriate.
fn is_as_good(score: f64, best: f64) -> bool {
    score >= best - SUM_ROUND_OFF
}

/// Returns the first contender with the largest fitness up to round-off.
fn best(contenders: &Contenders, weights: Weights) -> usize {
    let mut scores = contenders.terms().map(|terms| weights.score(terms));
    let largest = scores.clone().fold(f64::NEG_INFINITY, f64::max);
    scores.position(|score| is_as_good(score, largest)).unwrap_or(0)
}

/// Checks that all criteria are comparable between the designs that meet the requirements.
///
/// # Errors
///
/// If a column is missing or not numeric, or if designs are incomparable.
pub fn check_comparable(
    results: &Results,
    preferences: &Preferences,
) -> Result<(), InvalidRanking> {
    match differing(results, preferences)?.into_iter().next() {
        Some(incomparable) => Err(incomparable.into()),
        None => Ok(()),
    }
}

/// Writes the tables and preferences of `ranking` to `folder`.
///
/// Returns the names of the files, and the lock of the folder, which callers hold while they read
/// the files. The tables for all weights are written only if there are four criteria.
///
/// # Errors
///
/// If the files cannot be written.
pub fn write_ranking(
    folder: &Path,
    ranking: &Ranking<'_>,
) -> Result<(Vec<&'static str>, File), OutputError> {
    let folder = ResultsFolder::new(folder);
    // The claim removes earlier tables. Otherwise tables for all weights would remain after a
    // change of the criteria.
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
    let lock = claim.finish(&files)?;
    Ok((files, lock))
}

/// Writes only the preferences of a ranking to `folder`, if no design meets its requirements.
///
/// Removes an earlier ranking. Returns the name of the file, and the lock of the folder.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_unmet(
    folder: &Path,
    preferences: &Preferences,
) -> Result<(&'static str, File), OutputError> {
    let folder = ResultsFolder::new(folder);
    let claim = Claim::take(&folder, Maker::Ranking)?;
    // Write the preferences, because the HTML page of the run first shows these requirements.
    folder.write_text(ResultsFolder::PREFERENCES, &preferences.to_toml())?;
    let lock = claim.finish(&[ResultsFolder::PREFERENCES])?;
    Ok((ResultsFolder::PREFERENCES, lock))
}

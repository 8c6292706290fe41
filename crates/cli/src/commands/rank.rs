//! `squama rank`.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Context as _;
use ranking::{RankedDesign, Ranking, TetrahedralGrid, Weights};
use results::Results;

use super::DONE;
use crate::args;
use crate::print::{aligned, counted, digits, print};

/// Winners that are listed before the list is cut short.
const LISTED: usize = 10;

/// Finds the best designs of a run and writes them down.
pub fn rank(arguments: &args::RankArguments) -> anyhow::Result<u8> {
    let weights: Weights = option("--weights", &arguments.weights)?;
    let grid: TetrahedralGrid = option("--resolution", &arguments.resolution)?;
    let results = Results::read(&arguments.results)?;
    let rank = if arguments.sound { Ranking::sound } else { Ranking::new };
    let ranking = rank(&results, grid)?;
    let folder = arguments.out.as_deref().unwrap_or(&arguments.results);
    let files = ranking::write_ranking(folder, &ranking, weights)?;
    let report = RankReport { results: &results, ranking: &ranking };
    let text = report.text(weights, arguments.top);
    print(&format!("{text}\n{}: {}\n", folder.display(), files.join(" ")))?;
    Ok(DONE)
}

/// The value of an option.
fn option<T: std::str::FromStr>(name: &str, text: &str) -> anyhow::Result<T>
where
    T::Err: std::error::Error + Send + Sync + 'static,
{
    text.parse().with_context(|| format!("{name} {text}"))
}

struct RankReport<'a> {
    results: &'a Results,
    ranking: &'a Ranking<'a>,
}

impl RankReport<'_> {
    fn text(&self, weights: Weights, top: usize) -> String {
        let folder = self.results.folder();
        let best = self.ranking.by_fitness(weights);
        let best: Vec<_> = best.iter().take(top).collect();
        let mut text = self.title(folder);
        let _ = write!(text, "\nBest by {weights}\n{}", self.table(&best, "fitness", fitness));
        text.push_str(&self.unfolded(weights));
        let _ = write!(text, "\nBest by one criterion alone\n{}", self.corners());
        let _ = write!(text, "\n{}", self.winners());
        let front = counted(self.ranking.front().len() as u64, "design");
        let _ = writeln!(text, "\nBeaten by no other in every criterion: {front}");
        text
    }

    /// How many designs are ranked, and why the others are not.
    fn title(&self, folder: &Path) -> String {
        let (ranked, all) = (self.ranking.len(), self.results.len());
        let mut text = format!("{}: {ranked} of {} ranked\n", folder.display(), designs(all));
        let left_out = self.ranking.left_out().iter();
        let rows: Vec<_> =
            left_out.map(|(why, count)| [format!("{count} left out"), why.to_string()]).collect();
        text.push_str(&aligned(&rows));
        for criterion in self.ranking.ties() {
            let name = self.ranking.criteria()[criterion].name;
            let _ = writeln!(text, "  {name} is the same for all of them and does not count");
        }
        text
    }

    /// The best of those whose surface has not folded over, if that of the winner has.
    fn unfolded(&self, weights: Weights) -> String {
        // Tables of an earlier version do not tell.
        let Ok(fold) = self.results.column("fold_force") else { return String::new() };
        let by_fitness = self.ranking.by_fitness(weights);
        let is_open = |design: &&RankedDesign<'_>| self.results.text(design.row(), fold).is_empty();
        if by_fitness.first().is_none_or(|winner| is_open(&winner)) {
            return String::new();
        }
        let best: Vec<_> = by_fitness.iter().filter(is_open).take(1).collect();
        let table = self.table(&best, "fitness", fitness);
        format!(
            "\nThe surface of the substrate folds over under the winner. Best of the others\n{table}"
        )
    }

    /// The best design by each criterion.
    fn corners(&self) -> String {
        let corners = self.ranking.criteria().iter().zip(Weights::alone());
        let mut rows = vec![self.header("criterion")];
        rows.extend(corners.map(|(criterion, weights)| {
            self.row(&self.ranking.winner(weights), criterion.name.to_owned())
        }));
        aligned(&rows)
    }

    /// The designs that win most of the weights.
    fn winners(&self) -> String {
        let winners = self.ranking.winners();
        let count = winners.len();
        let listed: Vec<_> = winners.iter().take(LISTED).collect();
        let more = count.saturating_sub(LISTED);
        let more = if more > 0 { format!("  and {more} more\n") } else { String::new() };
        let table = self.table(&listed, "share", |s| format!("{:.2} %", 100.0 * s.share()));
        format!(
            "Best for some weights: {}, with their share of all weights\n{table}{more}",
            designs(count)
        )
    }

    fn table(
        &self,
        standings: &[&RankedDesign<'_>],
        first: &str,
        cell: fn(&RankedDesign<'_>) -> String,
    ) -> String {
        let mut rows = vec![self.header(first)];
        rows.extend(standings.iter().map(|standing| self.row(standing, cell(standing))));
        aligned(&rows)
    }

    fn header(&self, first: &str) -> Vec<String> {
        let mut header = vec![first, "design"];
        header.extend(self.results.parameters().map(|parameter| parameter.key));
        header.extend(self.ranking.criteria().iter().map(|criterion| criterion.column));
        header.into_iter().map(str::to_owned).collect()
    }

    fn row(&self, standing: &RankedDesign<'_>, first: String) -> Vec<String> {
        let mut row = vec![first, standing.design().to_owned()];
        let parameters = self.results.parameters();
        row.extend(parameters.map(|p| self.results.parameter(standing.row(), p).to_owned()));
        row.extend(standing.values().map(digits));
        row
    }
}

fn fitness(standing: &RankedDesign<'_>) -> String {
    format!("{:.6}", standing.fitness)
}

fn designs(count: usize) -> String {
    counted(count as u64, "design")
}

//! Text output of `squama rank`.

use std::fmt::Write as _;

use ranking::{Preferences, RankedDesign, Ranking, Scale, Unmet, UnmetRequirement, Weights};
use results::Results;
use results::columns::{is_invalid_after_fold, mode_column, name, parameter_of};
use run::{CouplingChange, GapChange};
use sweep::JudgedModes;

use super::super::answer::DesignAnswer;
use super::super::couplings::couplings_report;
use super::checks::Checks;
use super::gap_changes::gap_changes_report;
use crate::print::{FAILED, FOLDED, aligned, counted, digits, shortfall};

/// Maximum number of listed designs.
const LISTED: usize = 10;

const FOLDED_MEANS: &str =
    "⚠ the surface of the substrate folds: the critical force is not valid\n";
const FAILED_MEANS: &str = "✗ fails a check: with full substrate coupling or a gap 10 % smaller or \
    larger, a requirement is missed or the surface folds\n";

/// Formats the ranking of a run.
pub struct RankReport<'a> {
    pub results: &'a Results,
    pub ranking: &'a Ranking<'a>,
    /// Number of designs listed by fitness.
    pub top: usize,
    /// Changes of the measures of the best designs with their gaps.
    pub changes: &'a [GapChange],
    /// Changes of the best designs with full substrate coupling.
    pub couplings: &'a [CouplingChange],
    /// Checks of the best designs against the requirements.
    pub checks: &'a Checks<'a>,
}

impl RankReport<'_> {
    pub fn text(&self) -> String {
        let mut text = self.title();
        let _ = write!(text, "\n{}", self.best());
        text.push_str(&self.unfolded());
        text.push_str(&self.checked());
        if self.preferences().criteria.len() > 1 {
            let _ = write!(text, "\nBest by one criterion alone\n{}", self.corners());
        }
        let requirements = &self.preferences().requirements;
        text.push_str(&gap_changes_report(self.changes, requirements));
        text.push_str(&couplings_report(self.couplings, requirements));
        // The answer has warnings, which begin with the mark of a fold.
        let mut has_fold = text.contains(FOLDED);
        text.push_str(&self.answer());
        let answered = text.len();
        if let Some(modes) = judged_modes(self.results, self.ranking) {
            let _ = write!(text, "\n{modes}");
        }
        if !self.ranking.winners().is_empty() {
            let _ = write!(text, "\n{}", self.winners());
        }
        let _ = write!(text, "\n{}", self.front());
        has_fold |= text[answered..].contains(FOLDED);
        let mut legend = String::new();
        if has_fold {
            legend.push_str(FOLDED_MEANS);
        }
        if text.contains(FAILED) {
            legend.push_str(FAILED_MEANS);
        }
        if !legend.is_empty() {
            let _ = write!(text, "\n{legend}");
        }
        text
    }

    fn preferences(&self) -> &Preferences {
        self.ranking.preferences()
    }

    /// States how many designs are ranked, and why the others are left out.
    fn title(&self) -> String {
        let (ranked, all) = (self.ranking.len(), self.results.len());
        let folder = self.results.folder().display();
        let mut text = format!("{folder}: {ranked} of {} ranked\n", designs(all));
        text.push_str(&shortfall(self.results.verified_folder()));
        let left_out = self.ranking.left_out().iter();
        let rows: Vec<_> =
            left_out.map(|(why, count)| [format!("{count} left out"), why.clone()]).collect();
        text.push_str(&aligned(&rows));
        // For a single design every criterion is trivially equal.
        if ranked > 1 {
            for criterion in self.ranking.ties() {
                let name = &self.preferences().criteria[criterion].name;
                let _ = writeln!(text, "  {name} is equal for all of them, and is ignored");
            }
        }
        text
    }

    /// Lists the best designs by fitness, and the number of ties for the first place.
    fn best(&self) -> String {
        let preferences = self.preferences();
        let best = self.ranking.by_fitness(preferences.weights);
        let listed: Vec<_> = best.take(self.top).collect();
        let mut text = match preferences.criteria.as_slice() {
            [alone] => format!("Best by {}", alone.name),
            _ => format!("Best by {}", preferences.in_words()),
        };
        if preferences.scale != Scale::Paper {
            let _ = write!(text, ", {} scale", preferences.scale);
        }
        let _ = write!(text, "\n{}", self.table(&listed, "fitness", fitness));
        let equal = self.ranking.equals(preferences.weights);
        if equal > 0 {
            let _ = writeln!(text, "  the first {} have equal fitness", equal + 1);
        }
        text
    }

    /// Shows the best design without a fold, if the surface folds under the winner.
    fn unfolded(&self) -> String {
        let Some(best) = self.ranking.best_unfolded() else { return String::new() };
        let title =
            "The surface of the substrate folds under the best design. Best design without a fold";
        format!("\n{title}\n{}", self.table(&[best], "fitness", fitness))
    }

    /// Shows the best design that passes all checks, if the winner fails one.
    fn checked(&self) -> String {
        let count = self.checks.failed.len();
        match self.checks.best {
            Some(best) => {
                let table = self.table(&[best], "fitness", fitness);
                format!("\nThe best design fails a check. Best design that passes all\n{table}")
            }
            None if count > 0 => {
                format!("\nOf the first {} none passes all checks.\n", designs(count))
            }
            None => String::new(),
        }
    }

    /// States required values, margins and warnings of the best design that passes the checks.
    fn answer(&self) -> String {
        let Preferences { requirements, weights, .. } = self.preferences();
        let best = self.checks.best.unwrap_or_else(|| self.ranking.winner(*weights));
        let solved = self.results.definition().filter(|_| !requirements.is_empty());
        let Some((sweep, row)) =
            solved.and_then(|sweep| Some((sweep, run::solved_row(sweep, best.design())?)))
        else {
            return String::new();
        };
        let answer = DesignAnswer::new(sweep, &row, requirements);
        let (rows, warnings) = (aligned(&answer.rows()), answer.warnings_text(None));
        format!("\nThe requirements of {}\n{rows}{warnings}", best.design())
    }

    /// Lists the best design by each criterion.
    fn corners(&self) -> String {
        let criteria = &self.preferences().criteria;
        let mut header = self.header("criterion");
        header.push(String::new());
        let mut rows = vec![header];
        for (criterion, weights) in criteria.iter().zip(Weights::alone_among(criteria.len())) {
            let mut row = self.row(&self.ranking.winner(weights), criterion.name.to_string());
            row.push(match self.ranking.equals(weights) {
                0 => String::new(),
                equal => format!("and {equal} equally good"),
            });
            rows.push(row);
        }
        aligned(&rows)
    }

    /// Lists the designs that win the most choices of weights.
    fn winners(&self) -> String {
        let winners = self.ranking.winners();
        let count = winners.len();
        let listed = &winners[..count.min(LISTED)];
        let table = self.table(listed, "share", |s| format!("{:.2} %", 100.0 * s.share()));
        let title = "Best for some choice of weights";
        format!(
            "{title}: {}, with their share of all choices\n{table}{}",
            designs(count),
            more(count)
        )
    }

    /// States the size of the Pareto front; for custom criteria lists its designs and the knee.
    fn front(&self) -> String {
        let front = self.ranking.front();
        let count = front.len();
        let title = format!("Pareto front: {}\n", designs(count));
        if self.preferences().are_the_papers() || self.preferences().criteria.len() == 1 {
            return title;
        }
        let knee = self.ranking.knee();
        let is_knee = |s: &RankedDesign<'_>| knee.is_some_and(|knee| knee.row() == s.row());
        let mut listed: Vec<_> = front.iter().collect();
        listed.sort_by(|a, b| b.criterion(0).total_cmp(&a.criterion(0)));
        listed.truncate(LISTED.max(self.top));
        // The knee is always listed, even beyond the limit.
        let hidden = knee.filter(|knee| !listed.iter().any(|s| s.row() == knee.row()));
        let mut rows = vec![self.header("")];
        rows.extend(listed.iter().copied().chain(&hidden).map(|standing| {
            let first = if is_knee(standing) { "knee" } else { "" };
            self.row(standing, first.to_owned())
        }));
        let more = count.saturating_sub(rows.len() - 1);
        let more = if more > 0 { format!("  and {more} more\n") } else { String::new() };
        format!("{title}{}{more}", aligned(&rows))
    }

    fn table(
        &self,
        standings: &[RankedDesign<'_>],
        first: &str,
        cell: fn(&RankedDesign<'_>) -> String,
    ) -> String {
        let mut rows = vec![self.header(first)];
        rows.extend(standings.iter().map(|standing| self.row(standing, cell(standing))));
        aligned(&rows)
    }

    fn header(&self, first: &str) -> Vec<String> {
        let mut header = vec![first.to_owned()];
        header.extend(shown_columns(self.results, self.preferences()));
        header
    }

    fn row(&self, standing: &RankedDesign<'_>, first: String) -> Vec<String> {
        let mut row = vec![first];
        row.extend(shown_cells(self.results, self.preferences(), standing.row()));
        if self.checks.fails(standing.design()) {
            // The first cell of the design is its number.
            row[1].push(FAILED);
        }
        row
    }
}

/// Returns true for a parameter, unless the table has the same length in mm, too.
fn is_shown_parameter(column: &str, header: &[String]) -> bool {
    let parameter = parameter_of(column);
    parameter.is_some_and(|parameter| {
        !parameter.in_mm().any(|in_mm| header.iter().any(|column| column == in_mm.key))
    })
}

/// Returns the displayed columns: number, parameters, criteria and required columns.
fn shown_columns(results: &Results, preferences: &Preferences) -> Vec<String> {
    let mut columns = vec!["design".to_owned()];
    let header = results.header();
    columns.extend(header.iter().filter(|column| is_shown_parameter(column, header)).cloned());
    for column in preferred_columns(preferences) {
        for column in std::iter::once(column).chain(mode_column(column)) {
            if !columns.iter().any(|shown| shown == column) {
                columns.push(column.to_owned());
            }
        }
    }
    columns
}

/// Returns the columns of criteria and requirements.
pub fn preferred_columns(preferences: &Preferences) -> impl Iterator<Item = &str> {
    let criteria = preferences.criteria.iter().map(|criterion| criterion.column.as_ref());
    criteria.chain(preferences.requirements.iter().map(|requirement| &*requirement.column))
}

/// Returns the failure modes that the best design is judged by, if a failure force is shown.
pub fn judged_modes(results: &Results, ranking: &Ranking<'_>) -> Option<JudgedModes> {
    let preferences = ranking.preferences();
    shown_columns(results, preferences).iter().find_map(|column| mode_column(column))?;
    let best = ranking.winner(preferences.weights);
    let grid = results.definition()?.grid();
    grid.case(grid.parse_number(best.design()).ok()?).judged_modes()
}

/// Returns true if the surface of the substrate folds before the puncture ends.
pub fn is_folded(results: &Results, row: usize) -> bool {
    results.column(name::FOLD_FORCE).is_ok_and(|fold| !results.table().is_empty(row, fold))
}

fn shown_cells(results: &Results, preferences: &Preferences, row: usize) -> Vec<String> {
    let columns = shown_columns(results, preferences);
    let is_doubtful = columns.iter().any(|column| is_invalid_after_fold(column));
    let cell = |column: &String| {
        let text = results.column(column).map_or_else(|_| "".into(), |of| results.text(row, of));
        match text.parse::<f64>() {
            _ if column == "design" && is_doubtful && is_folded(results, row) => {
                format!("{text}{FOLDED}")
            }
            Ok(_) if column == "design" => text.into_owned(),
            // 12 digits identify the design and hide the round-off of a division by the thickness.
            Ok(number) if parameter_of(column).is_some() => text::number::rounded(number, 12),
            Ok(number) => digits(number),
            _ => text.into_owned(),
        }
    };
    columns.iter().map(cell).collect()
}

/// Formats the result if no design meets the requirements.
pub fn unmet_report(results: &Results, preferences: &Preferences, unmet: &Unmet) -> String {
    let folder = results.folder().display();
    let all = designs(results.len());
    let mut text = format!("{folder}: none of {all} meets all requirements\n");
    let _ = write!(text, "\n{}", obstacle(unmet));
    if let Some(row) = unmet.nearest {
        let table = [shown_columns(results, preferences), shown_cells(results, preferences, row)];
        let _ = write!(text, "\nThe nearest design\n{}", aligned(&table));
    }
    text
}

/// Lists the distance of the nearest design from each requirement, and the obstacle.
pub fn obstacle(unmet: &Unmet) -> String {
    let mut rows =
        vec![["requirement", "met by", "others met by", "nearest", "short by"].map(str::to_owned)];
    rows.extend(unmet.requirements.iter().map(|requirement| {
        let [text, nearest, short] = distance(requirement);
        [text, designs(requirement.met), designs(requirement.met_without), nearest, short]
    }));
    format!("{}\n{}", aligned(&rows), binding(unmet))
}

/// Formats a requirement, the value of the nearest design, and the shortfall.
pub fn distance(requirement: &UnmetRequirement) -> [String; 3] {
    let short = match requirement.shortfall {
        0.0 => "-".to_owned(),
        short => format!("{:.2} %", 100.0 * short),
    };
    let nearest = requirement.nearest.map_or_else(|| "no value".to_owned(), digits);
    [requirement.requirement.to_string(), nearest, short]
}

/// Names the requirements that are the obstacle.
fn binding(unmet: &Unmet) -> String {
    let binds = unmet.requirements.iter().filter(|requirement| requirement.binds());
    let binding: Vec<_> = binds.map(|requirement| requirement.requirement.to_string()).collect();
    match binding.as_slice() {
        [] if unmet.requirements.len() > 1 => {
            "No single requirement is the obstacle: relax two or more.\n".to_owned()
        }
        [] => String::new(),
        [one] => format!("The obstacle is {one}: some designs meet all other requirements.\n"),
        several => {
            format!(
                "The obstacles are {}: for each of them, some designs meet all other requirements.\n",
                several.join(" and ")
            )
        }
    }
}

/// States how many are not listed; empty if all are.
fn more(count: usize) -> String {
    let more = count.saturating_sub(LISTED);
    if more > 0 { format!("  and {more} more\n") } else { String::new() }
}

fn fitness(standing: &RankedDesign<'_>) -> String {
    format!("{:.6}", standing.fitness)
}

fn designs(count: usize) -> String {
    counted(count as u64, "design")
}

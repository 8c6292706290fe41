//! The text output of `squama rank`.

use std::fmt::Write as _;

use ranking::{
    CRITERIA, Preferences, RankedDesign, Ranking, Scale, Unmet, UnmetRequirement, Weights,
};
use results::Results;
use results::columns::{is_invalid_after_fold, mode_column, parameter_of};
use run::{CouplingChange, GapChange};
use sweep::JudgedModes;

use super::answer::RankedAnswer;
use super::checks::Checks;
use super::columns::{is_folded, preferred_columns};
use crate::print::{FAILED, FOLDED, aligned, counted, digits, shortfall};

/// Maximum number of designs that the report names as the best for some weights.
const LISTED: usize = 5;

const FOLDED_MEANS: &str =
    "  ⚠ the surface of the substrate folds: the critical force is not valid\n";
const FAILED_MEANS: &str = "  ✗ fails a check: with full substrate coupling or a gap 10 % smaller or \
    larger, a requirement is missed or the surface folds\n";

/// A ranking with everything that its report states.
pub struct RankReport<'a> {
    pub results: &'a Results,
    pub ranking: &'a Ranking<'a>,
    /// Number of designs listed by fitness.
    pub top: usize,
    /// Measures of the best designs with smaller and larger gaps.
    pub changes: &'a [GapChange],
    /// Measures of the best designs with full substrate coupling.
    pub couplings: &'a [CouplingChange],
    /// Checks of the best designs against the requirements.
    pub checks: &'a Checks<'a>,
    /// The best design that passes the checks, or the best of all if none passes.
    pub answer: &'a RankedAnswer<'a>,
}

impl RankReport<'_> {
    /// Formats the ranking with its legend, and the answer.
    pub fn text(&self) -> String {
        let mut text = self.title();
        let _ = write!(text, "\n{}", self.best());
        let mut legend = String::new();
        if text.contains(FOLDED) {
            legend.push_str(FOLDED_MEANS);
        }
        if text.contains(FAILED) {
            legend.push_str(FAILED_MEANS);
        }
        let _ = write!(text, "{legend}{}\n{}", self.sizes(), self.answer());
        if let Some(modes) = judged_modes(self.results, self.ranking) {
            let _ = write!(text, "\n{modes}");
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
        let exclusions = self.ranking.exclusions().iter();
        let rows: Vec<_> =
            exclusions.map(|(why, count)| [format!("{count} left out"), why.clone()]).collect();
        text.push_str(&aligned(&rows));
        // A single ranked design ties with itself in every criterion; do not report these ties.
        if ranked > 1 {
            for criterion in self.ranking.ties() {
                let name = &self.preferences().criteria[criterion].name;
                let _ = writeln!(text, "  {name} is equal for all ranked designs, and is ignored");
            }
        }
        text
    }

    /// Lists the best designs by fitness, and the designs with a note.
    ///
    /// [`notes`](Self::notes) adds designs that are the best by a criterion or in another respect.
    fn best(&self) -> String {
        let preferences = self.preferences();
        let notes = self.notes();
        let best = self.ranking.by_fitness(preferences.weights).enumerate();
        let shown = best.filter(|(k, design)| {
            *k < self.top || notes.iter().any(|(row, _)| *row == design.row())
        });
        let mut rows = vec![self.header("fitness")];
        for (_, design) in shown {
            let mut row = self.row(&design, format!("{:.6}", design.fitness));
            let of_design = notes.iter().filter(|(row, _)| *row == design.row());
            row.push(of_design.map(|(_, note)| note.as_str()).collect::<Vec<_>>().join(", "));
            rows.push(row);
        }
        let mut text = match preferences.criteria.as_slice() {
            [alone] => format!("Best by {}", alone.name),
            _ => format!("Best by {}", preferences.criteria_text()),
        };
        if preferences.scale != Scale::Paper {
            let _ = write!(text, ", {} scale", preferences.scale);
        }
        let _ = write!(text, "\n{}", aligned(&rows));
        let equal = self.ranking.equals(preferences.weights);
        if equal > 0 {
            let _ = writeln!(text, "  the first {} have equal fitness", equal + 1);
        }
        text
    }

    /// Returns the row of each design that is the best in some respect, and a note on this respect.
    ///
    /// These designs are the best that passes all checks, the best without a fold, the best by each
    /// criterion, and the knee of the front.
    fn notes(&self) -> Vec<(usize, String)> {
        let criteria = &self.preferences().criteria;
        let mut notes = Vec::new();
        if let Some(best) = self.checks.best {
            notes.push((best.row(), "best that passes all checks".to_owned()));
        }
        if let Some(best) = self.ranking.best_unfolded() {
            notes.push((best.row(), "best without a fold".to_owned()));
        }
        let alone = criteria.iter().zip(Weights::alone_among(criteria.len()));
        for (criterion, weights) in alone.filter(|_| criteria.len() > 1) {
            // The name of a criterion of the user already begins with "largest" or "least".
            let is_known = CRITERIA.contains(criterion);
            let best = if is_known { "best " } else { "" };
            let mut note = format!("{best}{}", criterion.name);
            match self.ranking.equals(weights) {
                0 => {}
                equal => _ = write!(note, " (and {equal} equally good)"),
            }
            notes.push((self.ranking.winner(weights).row(), note));
        }
        // Omit the knee for the paper's four criteria: most designs are on the front of these
        // criteria, so the knee means little.
        let knee = self.ranking.knee().filter(|_| !self.preferences().has_paper_criteria());
        notes.extend(knee.map(|knee| (knee.row(), "knee of the front".to_owned())));
        notes
    }

    /// States the size of the Pareto front, and the designs with the largest fractions of weights.
    fn sizes(&self) -> String {
        let front = self.ranking.front().len();
        let mut text = format!("  Pareto front: {} (pareto.csv)\n", designs(front));
        let winners = self.ranking.winners();
        if !winners.is_empty() {
            let first = winners.iter().take(LISTED);
            let first = first.map(|s| format!("{} {:.0} %", self.marked(s), 100.0 * s.share()));
            let first = first.collect::<Vec<_>>().join(", ");
            let count = designs(winners.len());
            let more = if winners.len() > LISTED { ", …" } else { "" };
            let _ = writeln!(text, "  Best for some weights: {count} (winners.csv): {first}{more}");
        }
        text
    }

    /// Formats the best design that passes the checks, or the best of all if none passes.
    fn answer(&self) -> String {
        let winner = self.ranking.winner(self.preferences().weights);
        let best = self.checks.best.unwrap_or(winner);
        let (number, shown) = (best.design(), self.marked(&best));
        let title = match (self.checks.best, self.checks.failed.len()) {
            (Some(_), _) => format!("The best design that passes all checks: {shown}"),
            (None, 0) => format!("The best design: {shown}"),
            (None, count) => format!(
                "Of the first {} none passes all checks. The best design: {shown}",
                designs(count)
            ),
        };
        let change = self.changes.iter().find(|change| change.design == number);
        let coupling = self.couplings.iter().find(|change| change.design == number);
        format!("{title}\n{}", self.answer.text(change, coupling))
    }

    /// Returns the number of a design with the marks of a fold and of a failed check.
    fn marked(&self, design: &RankedDesign<'_>) -> String {
        self.row(design, String::new()).swap_remove(1)
    }

    fn header(&self, first: &str) -> Vec<String> {
        let mut header = vec![first.to_owned()];
        header.extend(shown_columns(self.results, self.preferences()));
        header
    }

    fn row(&self, design: &RankedDesign<'_>, first: String) -> Vec<String> {
        let mut row = vec![first];
        row.extend(shown_cells(self.results, self.preferences(), design.row()));
        if self.checks.fails(design.design()) {
            // Mark the number of the design, which follows the cell `first`.
            row[1].push(FAILED);
        }
        row
    }
}

/// Returns true for the column of a parameter, unless the table also has this parameter in mm.
fn is_shown_parameter(column: &str, header: &[String]) -> bool {
    let parameter = parameter_of(column);
    parameter.is_some_and(|parameter| {
        !parameter.in_mm().any(|in_mm| header.iter().any(|column| column == in_mm.key))
    })
}

/// Returns the displayed columns: number, parameters, criteria, requirements and failure modes.
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

/// Returns the judged failure modes of the best design, if a failure force is displayed.
pub fn judged_modes(results: &Results, ranking: &Ranking<'_>) -> Option<JudgedModes> {
    let preferences = ranking.preferences();
    shown_columns(results, preferences).iter().find_map(|column| mode_column(column))?;
    let best = ranking.winner(preferences.weights);
    let grid = results.definition()?.grid();
    grid.case(grid.parse_number(best.design()).ok()?).judged_modes()
}

/// Returns the cells of the displayed columns, with a mark for a fold.
fn shown_cells(results: &Results, preferences: &Preferences, row: usize) -> Vec<String> {
    let columns = shown_columns(results, preferences);
    let is_doubtful = columns.iter().any(|column| is_invalid_after_fold(column));
    columns
        .iter()
        .map(|column| {
            let text =
                results.column(column).map_or_else(|_| "".into(), |of| results.text(row, of));
            match text.parse::<f64>() {
                _ if column == "design" && is_doubtful && is_folded(results, row) => {
                    format!("{text}{FOLDED}")
                }
                Ok(_) if column == "design" => text.into_owned(),
                // Show parameters with 12 digits, which identify a design, and hide the round-off
                // of a division by the thickness.
                Ok(number) if parameter_of(column).is_some() => text::number::rounded(number, 12),
                Ok(number) => digits(number),
                _ => text.into_owned(),
            }
        })
        .collect()
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

/// Lists how far the nearest design is from each requirement, and names the obstacles.
pub fn obstacle(unmet: &Unmet) -> String {
    let mut rows =
        vec![["requirement", "met by", "others met by", "nearest", "short by"].map(str::to_owned)];
    rows.extend(unmet.requirements.iter().map(|requirement| {
        let [text, nearest, short] = distance(requirement);
        [text, designs(requirement.met), designs(requirement.met_without), nearest, short]
    }));
    format!("{}\n{}", aligned(&rows), binding(unmet))
}

/// Formats a requirement, the value of the nearest design, and the shortfall of this value.
pub fn distance(requirement: &UnmetRequirement) -> [String; 3] {
    let short = match requirement.shortfall {
        0.0 => "-".to_owned(),
        short => format!("{:.2} %", 100.0 * short),
    };
    let nearest = requirement.nearest.map_or_else(|| "no value".to_owned(), digits);
    [requirement.requirement.to_string(), nearest, short]
}

/// Names the requirements that alone prevent some designs from meeting all requirements.
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

fn designs(count: usize) -> String {
    counted(count as u64, "design")
}

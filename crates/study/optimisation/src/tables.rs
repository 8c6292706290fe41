//! Writes the files of a search: the goal, the best designs, and all evaluated designs.

use journal::JournalError;
use results::columns::{Cell, design_columns};
use results::{
    Claim, Column, CsvFormat, DesignRow, Maker, ResultsFolder, WrittenTable, finite, write_rows,
};

use crate::answer::Answer;
use crate::best::BestDesign;
use crate::binding_text::BindingText;
use crate::candidate::Candidate;
use crate::column::NumberColumn;
use crate::goal::DesignGoal;
use crate::judge::Judge;
use crate::judgement::Judgement;
use crate::requirement_bounds::has_folded;
use crate::search::Found;
use crate::statistic::Statistic;

/// File name of the table of the best design.
pub const OPTIMUM: &str = "optimum.csv";
/// File name of the definition of the best design, which all commands can read.
pub const OPTIMUM_DEFINITION: &str = "optimum.toml";
/// File name of the definition of the nearest design, if no design is feasible.
pub const NEAREST_DEFINITION: &str = "nearest.toml";
/// File name of the table of non-dominated designs.
pub const FRONT: &str = "front.csv";
/// File name of the table of all evaluated designs.
pub const HISTORY: &str = "history.csv";
/// Name of the column with requirements that a check of the best design contradicts.
///
/// Requirements are separated by `; `.
pub const FAILED_CHECKS: &str = "failed_checks";
/// File name of the goal, including settings that override keys.
pub const GOAL: &str = "goal.toml";

const FITNESS_MEANING: &str =
    "weighted geometric mean of the rescaled criteria (Eq. 7), if the goal uses the fitness";

/// Cells of a row of a table.
type Cells = Vec<Cell>;

/// Returns the columns of `optimum.csv` and `front.csv`.
///
/// The tables have the columns of `designs.csv`, the fitness (if used), binding limits, prices,
/// failed checks, and statistics over samples (if used).
pub fn optimum_columns(goal: &DesignGoal) -> Vec<Column<Cells>> {
    let known = design_columns(goal.space.sweep()).into_iter();
    let known = known.map(|column| (column.name.to_string(), column.unit, column.meaning));
    let known = known.chain(fitness_column(goal));
    let further = [
        (
            "binding",
            "-",
            "binding limits, which prevent a better design: requirements, ends of the ranges of variables, lower bounds of other objectives",
        ),
        (
            "prices",
            "-",
            "cost of each binding limit, from its multiplier; empty if no multipliers balance the gradients, e.g. on a kink",
        ),
        (
            FAILED_CHECKS,
            "-",
            "requirements that a check contradicts: full substrate coupling, other load positions or new samples",
        ),
    ];
    let further = further.map(|(name, unit, meaning)| (name.to_owned(), unit, meaning));
    cells(known.chain(further).chain(statistic_columns(goal)))
}

/// Returns the columns with statistics over independent samples.
///
/// Empty if the goal contains no statistics over samples.
fn statistic_columns(goal: &DesignGoal) -> Vec<ColumnText> {
    let known = design_columns(goal.space.sweep());
    let mut columns = Vec::new();
    for (name, statistic) in Judge::new(goal).statistics() {
        let unit = unit_of(&known, &name);
        columns.extend([
            (name.clone(), unit, statistic.meaning()),
            (format!("{name}_low"), unit, "lower end of the 95 % interval of the statistic"),
            (format!("{name}_high"), unit, "upper end of the 95 % interval of the statistic"),
            (format!("{name}_seen"), unit, "estimate from the samples of the search"),
        ]);
    }
    if !columns.is_empty() {
        let fresh = "number of independent samples for the statistics and their intervals";
        columns.push(("fresh_samples".to_owned(), "-", fresh));
    }
    columns
}

/// Returns the cells of a best design in the columns of [`statistic_columns`].
fn statistic_cells(goal: &DesignGoal, best: &BestDesign) -> Cells {
    let mut cells: Cells = Vec::new();
    let confirmation = best.confirmation.as_ref();
    for (name, _) in Judge::new(goal).statistics() {
        let of = confirmation.and_then(|confirmation| confirmation.estimate(&name));
        let [low, high] = of.map(|of| of.interval).unwrap_or_default();
        let values = [of.and_then(|of| of.value), low, high, of.and_then(|of| of.seen)];
        cells.extend(values.map(Cell::from));
    }
    if !cells.is_empty() {
        let fresh = confirmation.map_or(Cell::Empty, |confirmation| confirmation.fresh.into());
        cells.push(fresh);
    }
    cells
}

/// Returns the unit of the statistic `name`, which is the unit of its column.
fn unit_of(known: &[Column<DesignRow>], name: &str) -> &'static str {
    let base = Statistic::base(name);
    known.iter().find(|column| column.name == base).map_or("-", |column| column.unit)
}

/// Name, unit and meaning of a column.
type ColumnText = (String, &'static str, &'static str);

/// Returns the column of an objective: a column of `designs.csv`, a statistic or the fitness.
fn objective_column(
    goal: &DesignGoal,
    known: &[Column<DesignRow>],
    name: &str,
) -> Option<ColumnText> {
    if let Some(column) = known.iter().find(|column| column.name == name) {
        return Some((column.name.to_string(), column.unit, column.meaning));
    }
    match goal.statistic(name) {
        Some(statistic) => Some((name.to_owned(), unit_of(known, name), statistic.meaning())),
        None => fitness_column(goal),
    }
}

/// Returns the column of the fitness, if the goal uses the fitness.
fn fitness_column(goal: &DesignGoal) -> Option<ColumnText> {
    goal.fitness.is_some().then(|| (NumberColumn::FITNESS.to_owned(), "-", FITNESS_MEANING))
}

/// Returns the columns of `history.csv`.
pub fn history_columns(goal: &DesignGoal) -> Vec<Column<Cells>> {
    let first = [
        plain("evaluation", "number of the evaluation, in the order of the search"),
        plain(
            "stage",
            "sample: space-filling point; gradient: step of the gradient search; ridge: step of the bundle method along a kink; polish: derivative-free step; tolerance: first samples of a design; rounded: sizes in multiples of `goal.round`",
        ),
    ];
    let parameters = goal.space.parameters().map(|p| (p.key.to_owned(), p.unit, p.meaning));
    let known = design_columns(goal.space.sweep());
    let objectives =
        goal.objectives.iter().filter_map(|o| objective_column(goal, &known, &o.column));
    let last = [
        plain(
            "shortfall",
            "largest shortfall, relative to the limit; 0 if every requirement is met",
        ),
        plain(
            "verdict",
            "met; short: the design misses a requirement; folded; nominal: the design was not sampled; otherwise the reason why the design cannot be judged",
        ),
        plain(
            "best",
            "best value of the first objective so far, over designs that meet every requirement",
        ),
    ];
    cells(first.into_iter().chain(parameters).chain(objectives).chain(last))
}

/// Returns name, unit and meaning of a column without a unit.
fn plain(name: &str, meaning: &'static str) -> ColumnText {
    (name.to_owned(), "-", meaning)
}

/// Creates columns that take their values from rows of cells in the same order.
fn cells(columns: impl Iterator<Item = ColumnText>) -> Vec<Column<Cells>> {
    columns
        .enumerate()
        .map(|(index, (name, unit, meaning))| {
            Column::computed(name.into(), unit, meaning, move |row: &Cells| row[index].clone())
        })
        .collect()
}

/// Writes the results of a search into `folder`, and returns the names of the files.
///
/// The files are the goal, the history, the optimum or front with its definition, and the `figures`
/// (name and SVG text).
///
/// # Errors
///
/// If a file cannot be written, or if the journal was edited after earlier tables were written.
pub fn write_found(
    folder: &ResultsFolder,
    goal: &DesignGoal,
    found: &Found,
    figures: &[(String, String)],
    format: CsvFormat,
) -> Result<Vec<String>, JournalError> {
    let tables = found_tables(goal, found);
    refuse_edited(folder, &tables)?;
    let mut files = vec![GOAL];
    // Claim the folder before writing, because the claim removes tables of an earlier search.
    let mut claim = Claim::take(folder, Maker::Search)?;
    folder.write_text(GOAL, goal.to_toml())?;
    for FoundTable { name, columns, rows } in &tables {
        write_rows(folder, name, format, columns, rows)?;
        files.push(name);
    }
    let definition = match &found.answer {
        Answer::Optimum(best) => Some((OPTIMUM_DEFINITION, best.row.case)),
        Answer::Front(_) => None,
        Answer::Infeasible(nearest) => nearest
            .and_then(|index| found.history.get(index))
            .map(|nearest| (NEAREST_DEFINITION, goal.space.case(&nearest.point))),
    };
    if let Some((name, case)) = definition {
        folder.write_text(name, &goal.space.sweep().at(&case).to_toml())?;
        files.push(name);
    }
    let mut files: Vec<String> = files.into_iter().map(str::to_owned).collect();
    for (name, svg) in figures {
        claim.add(name)?;
        folder.write_text(name, svg)?;
        files.push(name.clone());
    }
    claim.finish(&files)?;
    Ok(files)
}

/// A table of a search: file name, columns and rows.
struct FoundTable {
    name: &'static str,
    columns: Vec<Column<Cells>>,
    rows: Vec<Cells>,
}

/// Returns the table of all evaluated designs, and the table of the best designs, if any.
fn found_tables(goal: &DesignGoal, found: &Found) -> Vec<FoundTable> {
    let rows = history(goal, found).collect();
    let history = FoundTable { name: HISTORY, columns: history_columns(goal), rows };
    let (name, best) = match &found.answer {
        Answer::Optimum(best) => (OPTIMUM, std::slice::from_ref(best.as_ref())),
        Answer::Front(front) => (FRONT, front.designs.as_slice()),
        Answer::Infeasible(_) => return vec![history],
    };
    let (columns, rows) = (optimum_columns(goal), best_rows(goal, best));
    vec![history, FoundTable { name, columns, rows }]
}

/// Returns an error if the new `tables` differ from intact tables written from the same journal.
///
/// A difference means that somebody edited the journal.
fn refuse_edited(folder: &ResultsFolder, tables: &[FoundTable]) -> Result<(), JournalError> {
    let Some(stated) = Claim::recorded(folder, Maker::Search) else { return Ok(()) };
    for FoundTable { name, columns, rows } in tables {
        let Some(table) = WrittenTable::as_stated(folder, name, &stated) else { continue };
        let mut rows = rows.iter();
        let changed: Result<Vec<String>, JournalError> = table.changed(columns, |_| {
            // If the new table has fewer rows, the missing rows count as empty.
            let row = rows.next().cloned();
            Ok(Some(row.unwrap_or_else(|| vec![Cell::Empty; columns.len()])))
        });
        let first = changed?.into_iter().next();
        if let Some(line) = first.or_else(|| rows.next().map(|row| row[0].to_string())) {
            return Err(JournalError::Edited {
                path: folder.file(ResultsFolder::EVALUATIONS),
                line: format!("{} {line}", columns[0].name),
                table: (*name).to_owned(),
                again: "with --fresh",
            });
        }
    }
    Ok(())
}

/// Returns the rows of `optimum.csv` or `front.csv`.
fn best_rows(goal: &DesignGoal, designs: &[BestDesign]) -> Vec<Cells> {
    let sweep = goal.space.sweep();
    let (binding_text, known) = (BindingText::new(goal), design_columns(sweep));
    designs
        .iter()
        .enumerate()
        .map(|(index, best)| {
            // The number of a design is its position in the front, so that `--design 3` selects the
            // third design.
            let row = DesignRow { number: sweep.grid().number(index as u64), ..best.row.clone() };
            let mut cells: Cells = known.iter().map(|column| column.cell(&row)).collect();
            cells.extend(
                goal.fitness.as_ref().map(|_| value(goal, &best.candidate, NumberColumn::FITNESS)),
            );
            cells.push(binding_text.bindings(&best.bindings, &best.target).into());
            cells.push(binding_text.prices(&best.bindings, &best.target).into());
            let failed = best.contradictions(goal);
            let failed: Vec<String> = failed.iter().map(ToString::to_string).collect();
            cells.push(failed.join("; ").into());
            cells.extend(statistic_cells(goal, best));
            cells
        })
        .collect()
}

/// Returns the rows of `history.csv`.
fn history<'a>(goal: &'a DesignGoal, found: &'a Found) -> impl Iterator<Item = Cells> + 'a {
    let known = design_columns(goal.space.sweep());
    let sign = if goal.objectives[0].goal == ranking::Goal::Maximize { 1.0 } else { -1.0 };
    let mut best: Option<f64> = None;
    found.history.iter().enumerate().map(move |(index, candidate)| {
        let row = row(goal, candidate);
        if let Judgement::Judged(worth) = &candidate.verdict
            && worth.met
            && best.is_none_or(|best| sign * worth.objectives[0] > sign * best)
        {
            best = Some(worth.objectives[0]);
        }
        let mut cells: Cells = vec![(index + 1).into(), candidate.stage.word().into()];
        cells.extend(goal.space.parameters().map(|p| Cell::from(p.get(&row.case))));
        cells.extend(goal.objectives.iter().map(|objective| {
            let column = known.iter().find(|column| column.name == objective.column);
            column.map_or_else(
                || value(goal, candidate, &objective.column),
                |column| column.cell(&row),
            )
        }));
        cells.extend(verdict(candidate, &row));
        cells.push(best.into());
        cells
    })
}

/// Returns the value of a design in a column of the goal; empty without a valid judgement.
fn value(goal: &DesignGoal, candidate: &Candidate, column: &str) -> Cell {
    let Judgement::Judged(worth) = &candidate.verdict else { return Cell::Empty };
    goal.values(worth).find(|(name, _)| *name == column).map(|(_, value)| value).into()
}

/// Returns the row of a nominal design.
fn row(goal: &DesignGoal, candidate: &Candidate) -> DesignRow {
    let number = goal.space.sweep().grid().number(0);
    let case = goal.space.case(&candidate.point);
    DesignRow { number, case, result: candidate.result.as_ref().clone() }
}

/// Returns the cells `shortfall` and `verdict` of a design.
fn verdict(candidate: &Candidate, row: &DesignRow) -> [Cell; 2] {
    match &candidate.verdict {
        Judgement::Judged(worth) => {
            let word = match (worth.met, has_folded(row)) {
                (true, _) => "met",
                (false, true) => "folded",
                (false, false) => "short",
            };
            // The shortfall is infinite if too many samples have no value.
            [finite(if worth.met { 0.0 } else { worth.shortfall() }).into(), word.into()]
        }
        Judgement::Nominal(worth) => {
            let word = match (worth.shortfall > 0.0, has_folded(row)) {
                (false, _) => "nominal",
                (true, true) => "folded",
                (true, false) => "short",
            };
            [worth.shortfall.into(), word.into()]
        }
        Judgement::Folded => [Cell::Empty, "folded".into()],
        Judgement::Failed(outcome) => [Cell::Empty, outcome.text().into()],
        Judgement::Missing(column) => [Cell::Empty, format!("no {column}").into()],
    }
}

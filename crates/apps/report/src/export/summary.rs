//! The first sheet of a workbook: description of the run, outcome and best designs.

use std::collections::HashSet;

use ranking::{CRITERIA, Criterion, Goal, Preferences};
use results::columns::{is_invalid_after_fold, name};
use results::round_off::Leader;
use results::{CsvFormat, ResultsFolder, VerifiedFolder, incomparable_by};
use rust_xlsxwriter::{Format, FormatAlign, Worksheet, XlsxError};
use sweep::{PARAMETERS, Sweep};

use super::ExportError;
use super::explanation::explained;
use crate::facts::facts;
use crate::figures::physical_of;

/// The name of the sheet.
const NAME: &str = "summary";
/// Number of designs listed from the ranking.
const LISTED: usize = 10;
/// Warning for a design with a fold in the surface of the substrate.
const FOLDS: &str = "the surface folds: the critical force is not valid";
/// Short form of [`FOLDS`], placed after the number of a design.
const DOUBT: &str = " ⚠ surface folds";
/// Widths of the columns, characters.
const WIDTHS: [f64; 4] = [34.0, 22.0, 26.0, 90.0];

/// The best value of each criterion, collected from the rows of `designs.csv`.
#[derive(Debug, Default)]
pub(super) struct BestValues {
    columns: Vec<BestColumn>,
    /// Number of designs.
    designs: u64,
    /// Index of the column with the force at the first fold.
    fold: Option<usize>,
    /// Numbers of the designs with a fold.
    folded: HashSet<String>,
}

/// The column of a criterion, in physical units if the table has one, with its best value.
#[derive(Debug)]
struct BestColumn {
    name: String,
    place: usize,
    goal: Goal,
    best: Option<Leader<String>>,
}

impl BestColumn {
    fn of(criterion: &Criterion, header: &csv::StringRecord) -> Option<Self> {
        let name = physical_of(header, &criterion.column).unwrap_or(&criterion.column);
        let place = header.iter().position(|column| column == name)?;
        Some(Self { name: name.to_owned(), place, goal: criterion.goal, best: None })
    }
}

impl BestValues {
    /// Creates the collection for a table with this header.
    pub fn new(header: &csv::StringRecord) -> Self {
        let fold = header.iter().position(|name| name == name::FOLD_FORCE);
        let columns = CRITERIA.iter().filter_map(|criterion| BestColumn::of(criterion, header));
        Self { fold, columns: columns.collect(), ..Self::default() }
    }

    /// Returns the warning for a best design if a fold invalidates this measure.
    fn fold_warning(&self, design: &str, measure: &str) -> &'static str {
        if is_invalid_after_fold(measure) && self.folded.contains(design) { DOUBT } else { "" }
    }

    /// Records a row of the table.
    pub fn add(&mut self, format: CsvFormat, row: &csv::StringRecord) {
        self.designs += 1;
        let design = row.get(0).unwrap_or_default();
        if self.fold.and_then(|place| row.get(place)).is_some_and(|cell| !cell.is_empty()) {
            self.folded.insert(design.to_owned());
        }
        for BestColumn { place, goal, best, .. } in &mut self.columns {
            if let Some(value) = row.get(*place).and_then(|cell| format.number(cell)) {
                Leader::enter(best, design.to_owned(), value, *goal);
            }
        }
    }
}

/// The summary sheet while it is written.
struct Sheet {
    page: Worksheet,
    row: u32,
    bold: Format,
}

/// Content of the summary besides the best values, read from the folder of the run.
pub(super) struct SummaryFacts {
    /// The record of the run; empty if there is none.
    record: String,
    preferences: Option<Preferences>,
    /// Rank, number and fitness of the first designs of the ranking.
    leading: Vec<[String; 3]>,
}

impl SummaryFacts {
    /// Reads the facts from `folder`.
    pub fn read(folder: &VerifiedFolder) -> Result<Self, ExportError> {
        let has_record = folder.holds(ResultsFolder::RUN_INFO);
        let record = has_record.then(|| folder.text(ResultsFolder::RUN_INFO)).transpose()?;
        let preferences = Preferences::read(folder)?;
        let leading = if preferences.is_some() { leading(folder)? } else { Vec::new() };
        Ok(Self { record: record.unwrap_or_default(), preferences, leading })
    }
}

/// Creates the summary of the run in `folder`.
pub(super) fn summary(
    folder: &VerifiedFolder,
    best: &BestValues,
    facts: &SummaryFacts,
) -> Result<Worksheet, XlsxError> {
    let mut page = Worksheet::new();
    page.set_name(NAME)?;
    page.set_landscape();
    page.set_print_fit_to_pages(1, 0);
    for (place, width) in (0..).zip(WIDTHS) {
        page.set_column_width(place, width)?;
    }
    let mut sheet = Sheet { page, row: 0, bold: Format::new().set_bold() };
    let definition = Sweep::parse(&facts.record, ResultsFolder::RUN_INFO, &[]).ok();
    sheet.title(definition.as_ref())?;
    sheet.run(&facts.record, folder.shortfall(), best)?;
    sheet.best(best, definition.as_ref())?;
    sheet.ranking(facts, best)?;
    if let Some(sweep) = &definition {
        sheet.definition(sweep)?;
    }
    Ok(sheet.page)
}

impl Sheet {
    fn title(&mut self, sweep: Option<&Sweep>) -> Result<(), XlsxError> {
        let name = sweep.map_or("a sweep", Sweep::name);
        let large = self.bold.clone().set_font_size(14);
        self.page.write_string_with_format(0, 0, name, &large)?;
        self.row = 1;
        Ok(())
    }

    /// Begins a section, after an empty row.
    fn part(&mut self, cells: &[&str]) -> Result<(), XlsxError> {
        self.row += 1;
        for (place, cell) in (0..).zip(cells) {
            self.page.write_string_with_format(self.row, place, *cell, &self.bold)?;
        }
        self.row += 1;
        Ok(())
    }

    /// Adds a row; numeric text is written as numbers.
    fn add(&mut self, cells: &[&str]) -> Result<(), XlsxError> {
        let left = Format::new().set_align(FormatAlign::Left);
        for (place, cell) in (0..).zip(cells) {
            match CsvFormat::Plain.number(cell) {
                Some(number) if !is_design_number(cell) => {
                    self.page.write_number_with_format(self.row, place, number, &left)?
                }
                _ => self.page.write_string(self.row, place, *cell)?,
            };
        }
        self.row += 1;
        Ok(())
    }

    /// Writes the number of designs and the record of the run.
    fn run(
        &mut self,
        record: &str,
        shortfall: Option<String>,
        best: &BestValues,
    ) -> Result<(), XlsxError> {
        self.part(&["Run"])?;
        if let Some(held) = shortfall {
            self.add(&["made from", &held])?;
        }
        let facts = facts(record);
        if facts.is_empty() {
            self.add(&["designs", &best.designs.to_string()])?;
        }
        for (name, value) in facts {
            self.add(&[&name, &value])?;
        }
        Ok(())
    }

    fn best(&mut self, best: &BestValues, sweep: Option<&Sweep>) -> Result<(), XlsxError> {
        self.part(&["Best designs", "design", "value", "unit"])?;
        for BestColumn { name: column, goal, best: leader, .. } in &best.columns {
            let Some(leader) = leader else { continue };
            let ties = match leader.ties {
                0 => String::new(),
                ties => format!(", and {ties} more"),
            };
            let extreme = ["largest", "least"][usize::from(*goal == Goal::Minimize)];
            let name = format!("{extreme} {}", column.replace('_', " "));
            if let Some(parameter) = sweep.and_then(|s| incomparable_by(s, column)) {
                let why = format!(
                    "left out: designs of different {parameter} cannot be compared by this column"
                );
                self.add(&[&name, "", "", &why])?;
                continue;
            }
            let unit = explained("designs", column).map_or("-", |(unit, _)| unit);
            self.add(&[
                &name,
                &format!("{}{}{ties}", leader.first, best.fold_warning(&leader.first, column)),
                &text::number::rounded(leader.value, 6),
                unit,
            ])?;
        }
        Ok(())
    }

    /// Writes the requirements and criteria of the ranking, and its first designs.
    fn ranking(&mut self, facts: &SummaryFacts, best: &BestValues) -> Result<(), XlsxError> {
        let Some(preferences) = &facts.preferences else { return Ok(()) };
        self.part(&["Ranking: requirements"])?;
        if preferences.requirements.is_empty() {
            self.add(&["none"])?;
        }
        for requirement in &preferences.requirements {
            self.add(&[&requirement.to_string()])?;
        }
        self.part(&["Ranking: criteria", "weight", "column"])?;
        for (criterion, weight) in preferences.criteria.iter().zip(preferences.weights.values()) {
            self.add(&[&criterion.name, &text::number::text(*weight), &criterion.to_string()])?;
        }
        self.add(&["scale", preferences.scale.name()])?;
        self.part(&["Ranking: best designs", "design", "fitness"])?;
        for [rank, design, fitness] in &facts.leading {
            let doubt = if best.folded.contains(design) { FOLDS } else { "" };
            self.add(&[rank, design, fitness, doubt])?;
        }
        Ok(())
    }

    fn definition(&mut self, sweep: &Sweep) -> Result<(), XlsxError> {
        self.part(&["Definition", "value", "unit", "meaning"])?;
        for axis in sweep.grid().axes() {
            let parameter = axis.parameter();
            let key = format!("designs.{}", parameter.key);
            self.add(&[&key, &axis.to_toml(), parameter.unit, parameter.meaning])?;
        }
        let shared: Vec<_> = sweep.shared().collect();
        for parameter in PARAMETERS {
            if let Some((_, value)) = shared.iter().find(|(p, _)| *p == parameter) {
                self.add(&[
                    &parameter.path(),
                    &value.to_string(),
                    parameter.unit,
                    parameter.meaning,
                ])?;
            }
        }
        Ok(())
    }
}

/// Returns true for the number of a design, which is written as text to keep leading zeros.
fn is_design_number(cell: &str) -> bool {
    cell.len() > 1 && cell.starts_with('0') && cell.chars().all(|c| c.is_ascii_digit())
}

/// Returns rank, number and fitness of the first designs of the ranking in a folder.
fn leading(folder: &VerifiedFolder) -> Result<Vec<[String; 3]>, ExportError> {
    let [ranking, ..] = ResultsFolder::RANKING;
    // If no design meets the requirements, the ranking has preferences but no tables.
    if !folder.holds(ranking) {
        return Ok(Vec::new());
    }
    // An unreadable table was already rejected when its own sheet was written.
    let Ok((format, mut table)) = super::open(folder.file(ranking)?) else { return Ok(Vec::new()) };
    let Ok(header) = table.headers().cloned() else { return Ok(Vec::new()) };
    let places = ["rank", "design", "fitness"].map(|name| header.iter().position(|h| h == name));
    Ok(table
        .records()
        .take(LISTED)
        .filter_map(Result::ok)
        .map(|row| {
            places.map(|place| {
                let cell = place.and_then(|place| row.get(place)).unwrap_or_default();
                // Only the fitness has decimals. Ranks and design numbers are copied unchanged.
                match format.number(cell).filter(|_| cell.contains(['.', ','])) {
                    Some(number) => format!("{number:.6}"),
                    None => cell.to_owned(),
                }
            })
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use ranking::CRITERIA;

    use super::BestColumn;

    #[test]
    fn best_designs_are_listed_in_newtons_if_available() {
        // The force per width is a different quantity.
        let physical = ["critical_force", "critical_force_per_width_N_mm", "critical_force_N"];
        for (header, listed) in [
            (&["critical_force", "compliance"][..], &["critical_force", "compliance"][..]),
            (&physical, &["critical_force_N"]),
        ] {
            let header = csv::StringRecord::from(header.to_vec());
            let columns =
                CRITERIA.iter().filter_map(|criterion| BestColumn::of(criterion, &header));
            assert_eq!(columns.map(|column| column.name).collect::<Vec<_>>(), listed);
        }
    }
}

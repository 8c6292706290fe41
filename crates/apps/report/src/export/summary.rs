//! The first sheet of a workbook: what the run is, how it ended, which designs are best.

use std::collections::HashSet;

use ranking::{CRITERIA, Criterion, Goal, Preferences};
use results::columns::{measure_of, name};
use results::round_off::Leader;
use results::{CsvFormat, ResultsFolder, VerifiedFolder, incomparable_by};
use rust_xlsxwriter::{Format, FormatAlign, Worksheet, XlsxError};
use sweep::{Measure, PARAMETERS, Sweep};

use super::ExportError;
use super::explanation::explained;
use crate::facts::facts;
use crate::figures::physical_of;

/// The name of the sheet.
const NAME: &str = "summary";
/// The designs of the ranking that are listed.
const LISTED: usize = 10;
/// What is said of a design under which the surface of the substrate folds over.
const FOLDS: &str = "the surface folds: the critical force is not valid";
const DOUBT: &str = " ⚠ surface folds";
/// Widths of its columns, in characters.
const WIDTHS: [f64; 4] = [34.0, 22.0, 26.0, 90.0];

/// The best values of the designs, as rows of `designs.csv` pass.
#[derive(Debug, Default)]
pub(super) struct BestValues {
    columns: Vec<BestColumn>,
    designs: u64,
    /// Place of the force at which the surface folds over, and the designs under which it does.
    fold: Option<usize>,
    folded: HashSet<String>,
}

/// A column whose best value is told: that of a criterion, in newtons or millimetres if there are any.
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
    /// The best values of a table with this header.
    pub fn new(header: &csv::StringRecord) -> Self {
        let fold = header.iter().position(|name| name == name::FOLD_FORCE);
        let columns = CRITERIA.iter().filter_map(|criterion| BestColumn::of(criterion, header));
        Self { fold, columns: columns.collect(), ..Self::default() }
    }

    /// What stands behind a design that is named best by a measure, if the fold touches that measure.
    fn doubt(&self, design: &str, measure: &str) -> &'static str {
        let is_touched = measure_of(measure) == Some(Measure::Puncture);
        if is_touched && self.folded.contains(design) { DOUBT } else { "" }
    }

    /// Sees a row.
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

/// The sheet while it is written.
struct Sheet {
    page: Worksheet,
    row: u32,
    bold: Format,
}

/// What the summary tells besides the best values, once it is checked.
pub(super) struct SummaryFacts {
    /// The record of the run, empty where there is none.
    record: String,
    preferences: Option<Preferences>,
    /// Rank, number and fitness of the first designs of the ranking.
    leading: Vec<[String; 3]>,
}

impl SummaryFacts {
    /// The facts in `folder`.
    pub fn read(folder: &VerifiedFolder) -> Result<Self, ExportError> {
        let has_record = folder.holds(ResultsFolder::RUN_INFO);
        let record = has_record.then(|| folder.text(ResultsFolder::RUN_INFO)).transpose()?;
        let preferences = Preferences::read(folder)?;
        let leading = if preferences.is_some() { leading(folder)? } else { Vec::new() };
        Ok(Self { record: record.unwrap_or_default(), preferences, leading })
    }
}

/// The summary of the run in `folder`.
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

    /// Begins a part, after an empty row.
    fn part(&mut self, cells: &[&str]) -> Result<(), XlsxError> {
        self.row += 1;
        for (place, cell) in (0..).zip(cells) {
            self.page.write_string_with_format(self.row, place, *cell, &self.bold)?;
        }
        self.row += 1;
        Ok(())
    }

    /// Adds a row; what is a number becomes one.
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

    /// How many designs there are, and what the record of the run says of it.
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
                let why =
                    format!("not told: designs of different {parameter} cannot be compared by it");
                self.add(&[&name, "", "", &why])?;
                continue;
            }
            let unit = explained("designs", column).map_or("-", |(unit, _)| unit);
            self.add(&[
                &name,
                &format!("{}{}{ties}", leader.first, best.doubt(&leader.first, column)),
                &text::number::rounded(leader.value, 6),
                unit,
            ])?;
        }
        Ok(())
    }

    /// What the ranking of the run goes by, and its first designs.
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

/// Whether it is the number of a design, which keeps its zeros and so is a text.
fn is_design_number(cell: &str) -> bool {
    cell.len() > 1 && cell.starts_with('0') && cell.chars().all(|c| c.is_ascii_digit())
}

/// Rank, number and fitness of the first designs of the ranking of a folder.
fn leading(folder: &VerifiedFolder) -> Result<Vec<[String; 3]>, ExportError> {
    let [ranking, ..] = ResultsFolder::RANKING;
    // A ranking that no design meets has preferences and no tables.
    if !folder.holds(ranking) {
        return Ok(Vec::new());
    }
    // A table that cannot be read was refused before, when its sheet was made.
    let Ok((format, mut table)) = super::open(folder.file(ranking)?) else { return Ok(Vec::new()) };
    let Ok(header) = table.headers().cloned() else { return Ok(Vec::new()) };
    let places = ["rank", "design", "fitness"].map(|name| header.iter().position(|h| h == name));
    let row = |row: csv::StringRecord| {
        places.map(|place| {
            let cell = place.and_then(|place| row.get(place)).unwrap_or_default();
            // Fitness alone has decimals: ranks and numbers of designs stay as they are.
            match format.number(cell).filter(|_| cell.contains(['.', ','])) {
                Some(number) => format!("{number:.6}"),
                None => cell.to_owned(),
            }
        })
    };
    Ok(table.records().take(LISTED).filter_map(Result::ok).map(row).collect())
}

#[cfg(test)]
mod tests {
    use ranking::CRITERIA;

    use super::BestColumn;

    #[test]
    fn the_best_designs_are_told_in_newtons_where_there_are_any() {
        let told = |header: &[&str]| {
            let header = csv::StringRecord::from(header.to_vec());
            let columns =
                CRITERIA.iter().filter_map(|criterion| BestColumn::of(criterion, &header));
            columns.map(|column| column.name).collect::<Vec<_>>()
        };
        assert_eq!(told(&["critical_force", "compliance"]), ["critical_force", "compliance"]);
        // A force over a width is another quantity.
        let physical = ["critical_force", "critical_force_per_width_N_mm", "critical_force_N"];
        assert_eq!(told(&physical), ["critical_force_N"]);
    }
}

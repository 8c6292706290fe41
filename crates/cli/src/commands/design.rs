//! `squama design`.

use anyhow::ensure;
use results::columns::design_columns;
use results::{
    Cell, Claim, Column, DesignRow, Maker, ParameterDerivative, RunFolder, SolvedDesign,
    write_measures, write_path_tables,
};
use run::Evaluator;
use serde_json::{Map, Value, json};
use sweep::PARAMETERS;

use super::selection::{SelectedDesign, select};
use super::source::folder_within;
use super::{DONE, INCOMPLETE};
use crate::args;
use crate::json;
use crate::print::{aligned, print, rounded};

/// Solves one design, prints its measures and writes them down with its path.
pub fn design(arguments: &args::DesignArguments) -> anyhow::Result<u8> {
    let mut design = choose(arguments)?;
    if arguments.sensitivity {
        design.sweep = design.sweep.with_sensitivity();
    }
    let chosen = SolvedChoice::new(design);
    let folder = RunFolder::new(chosen.folder(arguments));
    let claim = Claim::take(&folder, Maker::Design)?;
    let mut files = write_path_tables(&folder, &chosen.solved)?;
    files.push(write_measures(&folder, &chosen.columns, &chosen.solved.row)?);
    folder.write_text("design.toml", &chosen.design.sweep.to_toml())?;
    files.push("design.toml");
    claim.state()?;
    let place = folder.path().display();
    if arguments.json {
        json::print(&chosen.json(&place.to_string(), &files))?;
    } else {
        print(&format!("{}\n{place}: {}\n", chosen.report(), files.join(" ")))?;
    }
    Ok(if chosen.solved.row.result.failed() { INCOMPLETE } else { DONE })
}

/// The one design that is asked for.
fn choose(arguments: &args::DesignArguments) -> anyhow::Result<SelectedDesign> {
    let mut designs = select(&arguments.definition, &arguments.selection)?;
    ensure!(
        designs.len() == 1,
        "{}: {} designs are asked for, expected one: {}",
        arguments.definition.path.display(),
        designs.len(),
        advice(&designs)
    );
    Ok(designs.swap_remove(0))
}

/// The options that leave one of several designs.
fn advice(designs: &[SelectedDesign]) -> String {
    let [first, .., last] = designs else { return String::new() };
    let differing = PARAMETERS.iter().filter(|p| p.get(&first.case()) != p.get(&last.case()));
    let option = |parameter: &sweep::Parameter| match parameter.key {
        "gap_over_t" => "--gap …".to_owned(),
        "length_over_t" => "--length …".to_owned(),
        "slant_deg" => "--slant …".to_owned(),
        key => format!("--set designs.{key}=…"),
    };
    format!("give a value with {}", differing.map(option).collect::<Vec<_>>().join(" "))
}

/// A design that is solved.
struct SolvedChoice {
    design: SelectedDesign,
    solved: SolvedDesign,
    columns: Vec<Column<DesignRow>>,
}

impl SolvedChoice {
    fn new(design: SelectedDesign) -> Self {
        let evaluator = Evaluator::new(design.sweep.measures());
        let number = design.number.unwrap_or(design.sweep.grid().number(0));
        let solved = evaluator.solve(number, &design.case());
        let columns = design_columns(&design.sweep);
        Self { design, solved, columns }
    }

    fn folder(&self, arguments: &args::DesignArguments) -> std::path::PathBuf {
        let designs = || folder_within(&arguments.definition, &self.design.sweep, "designs");
        arguments.out.clone().unwrap_or_else(|| designs().join(self.design.label()))
    }

    /// The columns, but for the number, which stands in the title.
    fn measures(&self) -> impl Iterator<Item = (&Column<DesignRow>, Cell)> {
        self.columns.iter().skip(1).map(|column| (column, column.cell(&self.solved.row)))
    }

    fn report(&self) -> String {
        let rows = self.measures().map(|(column, cell)| {
            [column.name.to_string(), shown(&cell), unit(column.unit), column.meaning.to_owned()]
        });
        let rows: Vec<_> = rows.collect();
        let sensitivity = sensitivity(&self.solved.row.result.sensitivity);
        format!("{}\n{}\n{}{sensitivity}", self.title(), self.changes(), aligned(&rows))
    }

    fn title(&self) -> String {
        let name = self.design.sweep.name();
        match self.design.number {
            Some(number) => format!("{name}: design {number} of {}", self.design.count),
            None => {
                format!("{name}: a design beside the grid, {}", self.design.values(" = ", ", "))
            }
        }
    }

    /// The parameters that are not as the sweep has them.
    fn changes(&self) -> String {
        let Some(original) = self.design.original else {
            return String::new();
        };
        let case = self.design.case();
        let changed = PARAMETERS.iter().filter(|p| p.get(&case) != p.get(&original));
        let line = |p: &sweep::Parameter| {
            format!("  with {} = {} instead of {}\n", p.path(), p.get(&case), p.get(&original))
        };
        changed.map(line).collect()
    }

    fn json(&self, folder: &str, files: &[&str]) -> Value {
        let case = self.design.case();
        let parameters = PARAMETERS.iter().map(|p| (p.path(), json::scalar(p.get(&case))));
        let measures = self.measures().map(|(c, cell)| (c.name.to_string(), json::cell(&cell)));
        let units = self.measures().map(|(c, _)| (c.name.to_string(), c.unit.into()));
        json!({
            "sweep": self.design.sweep.name(),
            "design": self.design.number.map(|number| number.to_string()),
            "parameters": parameters.collect::<Map<_, _>>(),
            "measures": measures.collect::<Map<_, _>>(),
            "units": units.collect::<Map<_, _>>(),
            "failed": self.solved.row.result.failed(),
            "folder": folder,
            "files": files,
        })
    }
}

/// A cell for people: six digits of a number; the tables have all.
fn shown(cell: &Cell) -> String {
    match cell {
        Cell::Number(number) => rounded(*number),
        cell => Some(cell.to_string()).filter(|text| !text.is_empty()).unwrap_or("none".to_owned()),
    }
}

/// The elasticities of the measures: a line for each measure and parameter, kinks by their names.
fn sensitivity(derivatives: &[ParameterDerivative]) -> String {
    if derivatives.is_empty() {
        return String::new();
    }
    let line = |derivative: &ParameterDerivative| {
        let change = match (&derivative.kink, derivative.elasticity()) {
            (Some(kink), _) => format!("kink: {kink}"),
            (None, Some(elasticity)) => format!("{elasticity:+.3} %"),
            (None, None) => "none".to_owned(),
        };
        [derivative.measure.to_owned(), derivative.parameter.to_owned(), change]
    };
    let lines: Vec<_> = derivatives.iter().map(line).collect();
    format!("\nChange for one per cent of a parameter\n{}", aligned(&lines))
}

fn unit(unit: &str) -> String {
    if unit == "-" { String::new() } else { unit.to_owned() }
}

//! `squama design`.

use std::path::PathBuf;

use anyhow::{Context as _, bail};
use results::columns::design_columns;
use results::{ParameterDerivative, RunFolder, SolvedDesign, write_path_tables};
use run::Evaluator;
use sweep::{Case, DesignNumber, PARAMETERS, Setting, Sweep};

use super::{DONE, INCOMPLETE, folder_of, settings};
use crate::args;
use crate::print::{aligned, print};

/// Solves one design, prints its measures and writes its path tables.
pub fn design(arguments: &args::DesignArguments) -> anyhow::Result<u8> {
    let mut chosen = choose(arguments)?;
    if arguments.sensitivity {
        chosen.sweep = chosen.sweep.with_sensitivity();
    }
    let grid = chosen.sweep.grid();
    let evaluator = Evaluator::new(chosen.sweep.measures());
    let number = chosen.number.unwrap_or(grid.number(0));
    let solved = evaluator.solve(number, &grid.case(0));
    let folder = RunFolder::new(chosen.folder(arguments));
    let files = write_path_tables(&folder, &solved)?;
    folder.write_text("design.toml", &chosen.sweep.to_toml())?;
    let report = chosen.report(&solved);
    print(&format!("{report}\n{}: {} design.toml\n", folder.path().display(), files.join(" ")))?;
    Ok(if solved.row.result.failed() { INCOMPLETE } else { DONE })
}

/// The design that is asked for.
struct Chosen {
    /// A sweep of this design alone.
    sweep: Sweep,
    /// The number of the design in the whole sweep, if it is one of its designs.
    number: Option<DesignNumber>,
    /// How many designs the sweep has as a whole.
    count: u64,
    /// The case that the sweep solves under that number, if settings may have changed it.
    original: Option<Case>,
}

fn choose(arguments: &args::DesignArguments) -> anyhow::Result<Chosen> {
    match &arguments.number {
        Some(number) => by_number(arguments, number),
        None => by_values(arguments),
    }
}

fn by_number(arguments: &args::DesignArguments, number: &str) -> anyhow::Result<Chosen> {
    let path = &arguments.definition.path;
    let sweep = Sweep::read(path, &settings(&arguments.definition)?)?;
    let grid = sweep.grid();
    let index = grid
        .parse_number(number)
        .with_context(|| format!("{}: --design {number}", path.display()))?;
    let original =
        Sweep::read(path, &[]).ok().filter(|original| original.grid().len() == grid.len());
    Ok(Chosen {
        number: Some(grid.number(index)),
        count: grid.len(),
        original: original.map(|original| original.grid().case(index)),
        sweep: sweep.only(index),
    })
}

fn by_values(arguments: &args::DesignArguments) -> anyhow::Result<Chosen> {
    let path = &arguments.definition.path;
    let mut settings = settings(&arguments.definition)?;
    let options = [
        ("--gap", "gap_over_t", &arguments.gap),
        ("--length", "length_over_t", &arguments.length),
        ("--slant", "slant_deg", &arguments.slant),
    ];
    for (option, key, value) in options {
        if let Some(value) = value {
            settings.push(Setting::from_option(
                &format!("{option} {value}"),
                &format!("designs.{key}={value}"),
            )?);
        }
    }
    let sweep = Sweep::read(path, &settings)?;
    if let Some(axis) = sweep.grid().axes().iter().find(|axis| axis.len() > 1) {
        let key = axis.parameter().key;
        let option = options.iter().find(|(_, of, _)| *of == key);
        let option =
            option.map_or(format!("--set designs.{key}=…"), |(option, ..)| format!("{option} …"));
        bail!(
            "{}: designs.{key}: {} values, expected one, given with {option}",
            path.display(),
            axis.len()
        );
    }
    Ok(located(arguments, sweep))
}

/// `sweep`, of one design, with the number that the definition as it is written gives it.
fn located(arguments: &args::DesignArguments, sweep: Sweep) -> Chosen {
    let whole = Sweep::read(&arguments.definition.path, &[]).ok();
    let found = whole.and_then(|whole| {
        let grid = whole.grid();
        let index = grid.find(&sweep.grid().case(0))?;
        Some((grid.number(index), grid.len(), grid.case(index)))
    });
    let (number, count, original) = match found {
        Some((number, count, case)) => (Some(number), count, Some(case)),
        None => (None, 1, None),
    };
    Chosen { sweep, number, count, original }
}

impl Chosen {
    fn folder(&self, arguments: &args::DesignArguments) -> PathBuf {
        let folder = || folder_of(&self.sweep, None).join("designs").join(self.label());
        arguments.out.clone().unwrap_or_else(folder)
    }

    /// The number, or the values of a design that has none.
    fn label(&self) -> String {
        self.number.map_or_else(|| self.values("_", "-"), |number| number.to_string())
    }

    /// The values on all axes.
    fn values(&self, equals: &str, separator: &str) -> String {
        let axes = self.sweep.grid().axes().iter();
        let value =
            |axis: &sweep::Axis| format!("{}{equals}{}", axis.parameter().key, axis.value(0));
        axes.map(value).collect::<Vec<_>>().join(separator)
    }

    fn report(&self, solved: &SolvedDesign) -> String {
        let columns = design_columns(&self.sweep);
        // The number stands in the title.
        let rows = columns.iter().skip(1).map(|column| {
            let value = match column.cell(&solved.row).to_string() {
                text if text.is_empty() => "none".to_owned(),
                text => text,
            };
            [column.name.to_owned(), value, unit(column.unit), column.meaning.to_owned()]
        });
        let rows: Vec<_> = rows.collect();
        let sensitivity = sensitivity(&solved.row.result.sensitivity);
        format!("{}\n{}\n{}{sensitivity}", self.title(), self.changes(), aligned(&rows))
    }

    fn title(&self) -> String {
        let name = self.sweep.name();
        match self.number {
            Some(number) => format!("{name}: design {number} of {}", self.count),
            None => format!("{name}: a design beside the grid, {}", self.values(" = ", ", ")),
        }
    }

    /// The parameters that are not as the sweep has them.
    fn changes(&self) -> String {
        let Some(original) = self.original else {
            return String::new();
        };
        let case = self.sweep.grid().case(0);
        let changed = PARAMETERS.iter().filter(|p| p.get(&case) != p.get(&original));
        let line = |p: &sweep::Parameter| {
            format!("  with {} = {} instead of {}\n", p.path(), p.get(&case), p.get(&original))
        };
        changed.map(line).collect()
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
        [derivative.measure.clone(), derivative.parameter.clone(), change]
    };
    let lines: Vec<_> = derivatives.iter().map(line).collect();
    format!("\nChange for one per cent of a parameter\n{}", aligned(&lines))
}

fn unit(unit: &str) -> String {
    if unit == "-" { String::new() } else { unit.to_owned() }
}

//! The command `squama design`, which solves one design.

use std::path::PathBuf;

use anyhow::ensure;
use clap::Args;
use ranking::Requirement;
use results::columns::design_columns;
use results::{
    Cell, Claim, Column, DesignRow, Maker, Outcome, ParameterDerivative, ResultsFolder,
    SolvedDesign, write_measures, write_path_tables,
};
use run::Evaluator;
use serde_json::{Map, Value, json};
use skin::puncture::{self, Weakest};
use sweep::{JudgedModes, PARAMETERS};

use super::answer::{DesignAnswer, SearchedDesign};
use super::selection::{SelectedDesign, Selection, select};
use super::source::{Definition, folder_within};
use super::{DONE, INCOMPLETE};
use crate::json;
use crate::print::{aligned, change, rounded};

/// Arguments of `squama design`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama design sweeps/paper.toml --design 0417
  squama design sweeps/paper.toml --gap 0.1 --length 1 --slant 75
  squama design sweeps/paper.toml --gap 0.15 --length 1 --slant 40 --set scale.width_over_t=2
  squama design results/paper --design 0417 --json
  squama design results/paper --design 0417 --sensitivity

Solves the design exactly as the sweep does. A design given by its lengths need not be on the
grid; if the grid has further axes, give a value for each with --set designs.KEY=VALUE.
Writes measures.csv (every value with all its digits), path.csv, events.csv, scales.csv,
steps.csv (every Newton iteration), the same tables of bending (flexure_path.csv and so on), and design.toml.
With puncture.places also places.csv, the force at every load position.
--sensitivity also writes sensitivity.csv, and prints how one per cent of a parameter changes the measures.
Exit code: 0 done, 1 the design failed, 2 bad input or a disk error.")]
pub struct Arguments {
    #[command(flatten)]
    pub definition: Definition,

    #[command(flatten)]
    pub selection: Selection,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,

    /// Differentiate every measure with respect to every continuous parameter
    #[arg(long)]
    pub sensitivity: bool,

    /// Folder for the files [default: designs/NUMBER in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Solves one design, prints its measures, and writes them with its path.
pub fn design(arguments: &Arguments) -> anyhow::Result<u8> {
    let mut design = choose(arguments)?;
    let searched = SearchedDesign::read(&arguments.definition.path)?;
    if arguments.sensitivity {
        design.sweep = design.sweep.with_sensitivity();
    }
    // Solve the design before claiming the folder, because the claim removes the files of the
    // previous call.
    let chosen = SolvedChoice::new(design, searched.requirements);
    let folder = ResultsFolder::new(chosen.folder(arguments));
    let claim = Claim::take(&folder, Maker::Design)?;
    let mut files = write_path_tables(&folder, &chosen.solved)?;
    files.push(write_measures(&folder, &chosen.columns, &chosen.solved.row)?);
    folder.write_text("design.toml", &chosen.design.sweep.to_toml())?;
    files.push("design.toml");
    claim.finish(&files)?;
    let path = folder.path();
    json::answer(
        arguments.json,
        || chosen.json(&path.to_string_lossy(), &files),
        || chosen.report(),
        (path, &files),
    )?;
    Ok(if chosen.solved.row.result.failed() { INCOMPLETE } else { DONE })
}

/// Returns the selected design; an error if there are several.
fn choose(arguments: &Arguments) -> anyhow::Result<SelectedDesign> {
    let mut designs = select(&arguments.definition, &arguments.selection)?;
    ensure!(
        designs.len() == 1,
        "{}: {} designs are selected, expected one: {}",
        arguments.definition.path.display(),
        designs.len(),
        advice(&designs)
    );
    Ok(designs.swap_remove(0))
}

/// Names the options with which the user can select one of `designs`.
fn advice(designs: &[SelectedDesign]) -> String {
    let [first, .., last] = designs else { return String::new() };
    let differing = PARAMETERS.iter().filter(|p| p.get(&first.case()) != p.get(&last.case()));
    let options = differing.map(|parameter| match parameter.key {
        "gap_over_t" => "--gap …".to_owned(),
        "length_over_t" => "--length …".to_owned(),
        "slant_deg" => "--slant …".to_owned(),
        key => format!("--set designs.{key}=…"),
    });
    format!("give a value with {}", options.collect::<Vec<_>>().join(" "))
}

/// The selected design with its solution.
struct SolvedChoice {
    design: SelectedDesign,
    solved: SolvedDesign,
    columns: Vec<Column<DesignRow>>,
    /// Requirements of the search that found the design; empty without a search.
    requirements: Vec<Requirement>,
}

impl SolvedChoice {
    fn new(design: SelectedDesign, requirements: Vec<Requirement>) -> Self {
        let evaluator = Evaluator::new(design.sweep.measures());
        let number = design.number.unwrap_or(design.sweep.grid().number(0));
        let solved = run::report_slow(
            &format!("design {number}"),
            |text| eprintln!("{text}"),
            || evaluator.solve(number, &design.case()),
        );
        let columns = design_columns(&design.sweep);
        Self { design, solved, columns, requirements }
    }

    /// Returns the folder to which the files are written.
    fn folder(&self, arguments: &Arguments) -> std::path::PathBuf {
        arguments.out.clone().unwrap_or_else(|| {
            let designs = folder_within(&arguments.definition, &self.design.sweep, "designs");
            designs.join(self.design.label())
        })
    }

    /// Returns each column with its cell, without the first column, the number of the design.
    fn measures(&self) -> impl Iterator<Item = (&Column<DesignRow>, Cell)> {
        self.columns.iter().skip(1).map(|column| (column, column.cell(&self.solved.row)))
    }

    fn report(&self) -> String {
        let rows = self.measures().map(|(column, cell)| {
            [column.name.to_string(), shown(&cell), unit(column.unit), column.meaning.to_owned()]
        });
        let rows: Vec<_> = rows.collect();
        let sensitivity = sensitivity(&self.solved.row.result.sensitivity);
        let (title, changes, table) = (self.title(), self.changes(), aligned(&rows));
        let (weakest, judged) = (self.unknown_weakest(), self.judged());
        let answer = self.answer();
        let warnings = answer.warnings_text(None);
        let notes = [self.overlap(), warnings, weakest, judged, sensitivity].concat();
        let required = match answer.rows() {
            rows if rows.is_empty() => String::new(),
            rows => format!("{}\n", aligned(&rows)),
        };
        format!("{title}\n{changes}\n{required}{table}{notes}")
    }

    /// States the radius of the body at which neighbouring scales touch at rest.
    ///
    /// The text is empty unless the scales overlap at rest.
    fn overlap(&self) -> String {
        let outcome = self.solved.row.result.puncture.map(|puncture| puncture.outcome);
        let case = self.design.case();
        match puncture::touching_curvature(&case.design) {
            Ok(Some(touching)) if outcome == Some(Outcome::Overlapping) => {
                let in_mm =
                    case.material.thickness_mm.map(|t| format!(" ({} mm)", rounded(t / touching)));
                format!(
                    "\nThe scales touch at rest at a radius of {} t{}: increase radius or gap\n",
                    rounded(touching.recip()),
                    in_mm.unwrap_or_default()
                )
            }
            _ => String::new(),
        }
    }

    fn answer(&self) -> DesignAnswer<'_> {
        DesignAnswer::new(&self.design.sweep, &self.solved.row, &self.requirements)
    }

    /// Explains why the weakest load position is unknown.
    ///
    /// The text is empty if the weakest load position is known.
    fn unknown_weakest(&self) -> String {
        let Some(puncture) = &self.solved.puncture else { return String::new() };
        let Err(status) = Weakest::from_positions(&puncture.places) else { return String::new() };
        let known = puncture.places.iter().filter_map(|place| Some((place.force?, place)));
        let Some((force, place)) = known.min_by(|one, other| one.0.total_cmp(&other.0)) else {
            return String::new();
        };
        let open = puncture.places.iter();
        // Omit positions that carried more than `force` before their paths ended: they are not the
        // weakest.
        let open = open.filter(|p| {
            p.force.is_none() && p.largest_force.is_some_and(|largest_force| largest_force < force)
        });
        let open: Vec<_> = open.map(|place| rounded(place.position)).collect();
        format!(
            "\nThe weakest load position is unknown: the path ends early ({}) at {}. The weakest of the other positions is {}, with a critical force of {}\n",
            Outcome::from(status),
            open.join(", "),
            rounded(place.position),
            rounded(force)
        )
    }

    /// Returns the judged failure modes.
    ///
    /// `None` without a solved puncture, or if the design does not request the first failure.
    fn failure_modes(&self) -> Option<JudgedModes> {
        self.solved.row.result.puncture?;
        self.design.case().judged_modes()
    }

    /// States which failure modes were judged, and why the others were not.
    fn judged(&self) -> String {
        self.failure_modes().map_or_else(String::new, |modes| format!("\n{modes}"))
    }

    fn title(&self) -> String {
        let name = self.design.sweep.name();
        match self.design.number {
            Some(number) => format!("{name}: design {number} of {}", self.design.count),
            None => {
                format!("{name}: a design off the grid, {}", self.design.values(" = ", ", "))
            }
        }
    }

    /// Lists the parameters that differ from the design with the same number in the sweep.
    fn changes(&self) -> String {
        let Some(original) = self.design.original else {
            return String::new();
        };
        let case = self.design.case();
        let changed = PARAMETERS.iter().filter(|p| p.get(&case) != p.get(&original));
        let lines: Vec<_> = changed
            .map(|p| {
                format!("  with {} = {} instead of {}\n", p.path(), p.get(&case), p.get(&original))
            })
            .collect();
        lines.concat()
    }

    fn json(&self, folder: &str, files: &[&str]) -> Value {
        let case = self.design.case();
        let parameters = PARAMETERS.iter().map(|p| (p.path(), json!(p.get(&case))));
        let measures = self.measures().map(|(c, cell)| (c.name.to_string(), json!(cell)));
        let units = self.measures().map(|(c, _)| (c.name.to_string(), c.unit.into()));
        let mut answer = json!({
            "sweep": self.design.sweep.name(),
            "design": self.design.number.map(|number| number.to_string()),
            "parameters": parameters.collect::<Map<_, _>>(),
            "measures": measures.collect::<Map<_, _>>(),
            "units": units.collect::<Map<_, _>>(),
            "failed": self.solved.row.result.failed(),
            "folder": folder,
            "files": files,
        });
        answer["answer"] = self.answer().record(None);
        if let Some(modes) = self.failure_modes() {
            answer["failure_modes"] = json::failure_modes(&modes);
        }
        answer
    }
}

/// Formats a cell; a number gets at most six significant digits.
fn shown(cell: &Cell) -> String {
    match cell {
        Cell::Number(number) => rounded(*number),
        cell => Some(cell.to_string()).filter(|text| !text.is_empty()).unwrap_or("none".to_owned()),
    }
}

/// Maximum number of parameters that are listed for each measure, the most influential first.
const LISTED: usize = 3;

/// Smallest change that is listed, in percent; smaller changes would be printed as 0.
const NEGLIGIBLE: f64 = 5e-4;

/// Returns the absolute value of the elasticity; infinite at a kink, 0 if it is unknown.
///
/// The elasticity is the change of a measure in percent if a parameter changes by one per cent.
fn importance(derivative: &ParameterDerivative) -> f64 {
    match derivative.kink {
        Some(_) => f64::INFINITY,
        None => derivative.elasticity().map_or(0.0, f64::abs),
    }
}

/// Formats the kinks and the largest elasticities of each measure.
fn sensitivity(derivatives: &[ParameterDerivative]) -> String {
    if derivatives.is_empty() {
        return String::new();
    }
    let mut lines = Vec::new();
    for of_measure in derivatives.chunk_by(|one, other| one.measure == other.measure) {
        let mut known: Vec<_> = of_measure.iter().filter(|d| importance(d) >= NEGLIGIBLE).collect();
        // Kinks have an infinite importance, so they are listed first.
        known.sort_by(|one, other| importance(other).total_cmp(&importance(one)));
        lines.extend(known.into_iter().take(LISTED).map(sensitivity_line));
    }
    let title = "Change for one per cent of a parameter, the three largest of each measure";
    format!("\n{title} (sensitivity.csv has all)\n{}", aligned(&lines))
}

fn sensitivity_line(derivative: &ParameterDerivative) -> [String; 3] {
    let change = match (&derivative.kink, derivative.elasticity()) {
        (Some(kink), _) => format!("kink: {kink}"),
        (None, elasticity) => change(elasticity.unwrap_or_default(), 3),
    };
    [derivative.measure.to_owned(), derivative.parameter.to_owned(), change]
}

fn unit(unit: &str) -> String {
    if unit == "-" { String::new() } else { unit.to_owned() }
}

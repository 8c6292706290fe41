//! Selects designs by their numbers or by their values.

use std::ops::RangeInclusive;
use std::path::Path;

use anyhow::{Context as _, bail, ensure};
use clap::Args;
use optimisation::{DesignGoal, FRONT, GOAL};
use results::{Completeness, Results, VerifiedFolder};
use sweep::{Axis, Case, DesignNumber, Grid, Setting, Sweep, read_text};

use text::number::same;

use super::source::{Defined, Definition, IS_GOAL, defined_by, definition_file, settings};

/// Options that select designs.
#[derive(Debug, Args)]
#[group(multiple = true)]
pub struct Selection {
    /// Numbers of designs in the grid, e.g. 0417 or 1-12,0417 [default: the only design]
    #[arg(long = "design", value_name = "NUMBERS", value_delimiter = ',', conflicts_with_all = ["gap", "length", "slant"])]
    pub numbers: Vec<String>,

    /// Gap d/t, or in mm if the definition has `gap_mm`: one value, several (0.1,0.2), or all
    /// values of the sweep in a range (0.1..0.3)
    #[arg(long, value_name = "GAP", allow_hyphen_values = true)]
    pub gap: Option<String>,

    /// Length L/t, or in mm if the definition has `length_mm`, in the same forms as --gap
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub length: Option<String>,

    /// Slant in degrees, in the same forms as --gap
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub slant: Option<String>,
}

/// A selected design.
pub struct SelectedDesign {
    /// A sweep that consists of this design.
    pub sweep: Sweep,
    /// Number of the design in the whole sweep; `None` if the design is not on its grid.
    pub number: Option<DesignNumber>,
    /// Number of designs in the whole sweep; 1 for a design that is not on its grid.
    pub count: u64,
    /// Parameters of the design with this number in the definition without `--set`.
    ///
    /// `None` if there is no such design.
    pub original: Option<Case>,
}

/// Returns the selected designs; an error if there are none.
pub fn select(
    definition: &Definition,
    selection: &Selection,
) -> anyhow::Result<Vec<SelectedDesign>> {
    let settings = settings(&definition.settings)?;
    // Handle the folder of a Pareto front here, because `definition_file` rejects this folder.
    if definition.path.join(FRONT).is_file() {
        return select_from_front(&definition.path, &settings, selection);
    }
    let file = definition_file(&definition.path)?;
    // Read the file only once, because it may be a pipe.
    let mut text = read_text(&file)?;
    let is_chosen = options(selection).iter().any(|(.., text)| text.is_some());
    let designs = match defined_by(&text, &file, &settings)? {
        // A design of a goal has no number, so it can be chosen only by its values.
        Defined::Goal(goal) if is_chosen && selection.numbers.is_empty() => {
            text = first_design(&goal);
            1
        }
        Defined::Goal(_) => bail!(
            "{}: {IS_GOAL}; or choose a design with --gap, --length and --slant",
            file.display()
        ),
        Defined::Sweep(sweep) => sweep.grid().len(),
    };
    if is_chosen && selection.numbers.is_empty() {
        return by_values((&text, &file), settings, selection);
    }
    ensure!(
        designs == 1 || !selection.numbers.is_empty(),
        "{}: has {designs} designs; choose with --design, or with --gap, --length and --slant",
        definition.path.display()
    );
    let only = ["1".to_owned()];
    let numbers = if selection.numbers.is_empty() { only.as_slice() } else { &selection.numbers };
    by_numbers((&text, &file), &settings, numbers)
}

/// Selects designs by their numbers from the Pareto front of a search.
fn select_from_front(
    folder: &Path,
    settings: &[Setting],
    selection: &Selection,
) -> anyhow::Result<Vec<SelectedDesign>> {
    let found = VerifiedFolder::open(folder, Completeness::Partial)?;
    let name = folder.join(GOAL).display().to_string();
    let goal = DesignGoal::parse(&found.text(GOAL)?, &name, &[])?;
    let front = Results::of_file(&found, FRONT)?;
    let (definition, grid, designs) = (first_design(&goal), goal.space.sweep().grid(), front.len());
    ensure!(
        !selection.numbers.is_empty(),
        "{}: holds a Pareto front of {designs} designs; choose with --design",
        folder.display()
    );
    let mut selected = Vec::new();
    for text in &selection.numbers {
        let row = text.trim().parse::<usize>().ok().filter(|number| (1..=designs).contains(number));
        let row = row.with_context(|| {
            format!(
                "--design {text}: not accepted, expected 1 to {designs}, the designs of {FRONT}"
            )
        })? - 1;
        let values = goal.space.parameters().map(|parameter| {
            Setting::parse(&format!("{}={}", parameter.path(), front.parameter(row, parameter)))
        });
        let mut all = values.collect::<Result<Vec<_>, _>>()?;
        // Append the settings of `--set` last, so that they override the values of the front.
        all.extend_from_slice(settings);
        let (sweep, number) =
            (Sweep::parse(&definition, &name, &all)?, Some(grid.number(row as u64)));
        selected.push(SelectedDesign { sweep, number, count: designs as u64, original: None });
    }
    Ok(selected)
}

/// Returns the sweep definition of the first design of a goal.
///
/// Other designs of the goal are selected by settings that change the values in this definition.
fn first_design(goal: &DesignGoal) -> String {
    let space = goal.space.sweep();
    space.at(&space.grid().case(0)).to_toml()
}

/// Selects designs by their numbers in the grid.
fn by_numbers(
    (text, file): (&str, &Path),
    settings: &[Setting],
    numbers: &[String],
) -> anyhow::Result<Vec<SelectedDesign>> {
    let name = file.display().to_string();
    let sweep = Sweep::parse(text, &name, settings)?;
    let grid = sweep.grid();
    // If settings change the number of designs, an index is not the same design in both sweeps.
    let original =
        Sweep::parse(text, &name, &[]).ok().filter(|other| other.grid().len() == grid.len());
    Ok(ranges(grid, numbers, file)?
        .into_iter()
        .flatten()
        .map(|index| SelectedDesign {
            number: Some(grid.number(index)),
            count: grid.len(),
            original: original.as_ref().map(|original| original.grid().case(index)),
            sweep: sweep.only(index),
        })
        .collect())
}

/// Converts numbers of designs to ranges of indices in the grid of `file`.
pub fn ranges(
    grid: &Grid,
    numbers: &[String],
    file: &Path,
) -> anyhow::Result<Vec<RangeInclusive<u64>>> {
    numbers
        .iter()
        .map(|text| {
            let range = grid.parse_numbers(text.trim());
            range.with_context(|| format!("{}: --design {text}", file.display()))
        })
        .collect()
}

/// Selects designs by their values.
fn by_values(
    (text, file): (&str, &Path),
    mut settings: Vec<Setting>,
    selection: &Selection,
) -> anyhow::Result<Vec<SelectedDesign>> {
    let name = file.display().to_string();
    let written = Sweep::parse(text, &name, &settings)?;
    for (option, key, text) in options(selection) {
        let Some(text) = text else { continue };
        // Let error messages say that `0,1` is read as two values: the user probably meant 0.1.
        let whole = text.split(',').all(|part| part.trim().parse::<u64>().is_ok());
        let note = if text.contains(',') && whole { " (several values)" } else { "" };
        let option = format!("{option} {text}{note}");
        // A range selects values of the axis in the definition; this axis may be in mm.
        let axis = written.grid().axis_in_any_unit(key);
        let key = axis.map_or(key, |axis| axis.parameter().key);
        let values = values(text, axis).context(option.clone())?;
        settings.push(Setting::from_option(&option, &format!("designs.{key}={values}"))?);
    }
    let sweep = Sweep::parse(text, &name, &settings)?;
    // Parse without `--set`, because the numbers of designs refer to the definition as written.
    let whole = Sweep::parse(text, &name, &[]).ok();
    Ok((0..sweep.grid().len()).map(|index| located(sweep.only(index), whole.as_ref())).collect())
}

/// Returns name, key of the axis, and value (if given) of each option that selects by value.
fn options(selection: &Selection) -> [(&'static str, &'static str, Option<&String>); 3] {
    [
        ("--gap", "gap_over_t", selection.gap.as_ref()),
        ("--length", "length_over_t", selection.length.as_ref()),
        ("--slant", "slant_deg", selection.slant.as_ref()),
    ]
}

/// Converts the values of an option to TOML.
///
/// `text` is a value, a comma-separated list, or a range `FROM..TO` of the values of `axis`.
fn values(text: &str, axis: Option<&Axis>) -> anyhow::Result<String> {
    let Some((low, high)) = text.split_once("..") else {
        // Return TOML such as { from = 0.1, to = 1 } unchanged.
        if text.trim_start().starts_with(['[', '{']) {
            return Ok(text.to_owned());
        }
        // Parse and format the numbers, because TOML does not accept numbers such as `.5`.
        let all: Vec<_> = text
            .split(',')
            .map(|part| {
                let number = part.trim().parse::<f64>().ok().filter(|number| number.is_finite());
                number.map_or_else(|| part.to_owned(), |number| number.to_string())
            })
            .collect();
        return Ok(if all.len() > 1 { format!("[{}]", all.join(",")) } else { all.concat() });
    };
    let [low, high] = [low, high].map(|end| end.trim().parse::<f64>().ok());
    let bounds = low.zip(high);
    let (low, high) = bounds.context("not accepted, expected FROM..TO, e.g. 15..60")?;
    let axis = axis.map_or(Vec::new(), |axis| (0..axis.len()).map(|i| axis.value(i)).collect());
    let within = axis.iter().filter(|value| {
        value.number().is_some_and(|n| (low..=high).contains(&n) || same(n, low) || same(n, high))
    });
    let values: Vec<_> = within.map(|value| value.to_toml()).collect();
    let all: Vec<_> = axis.iter().map(ToString::to_string).collect();
    ensure!(
        !values.is_empty(),
        "the sweep has no value in this range, expected some of {}",
        all.join(" ")
    );
    Ok(format!("[{}]", values.join(", ")))
}

/// Returns the only design of `sweep`, with its number in the sweep `whole`.
///
/// The number is `None` if the design is not on the grid of `whole`.
fn located(sweep: Sweep, whole: Option<&Sweep>) -> SelectedDesign {
    let found = whole.and_then(|whole| {
        let grid = whole.grid();
        let index = grid.find(&sweep.grid().case(0))?;
        Some((grid.number(index), grid.len(), grid.case(index)))
    });
    let (number, count, original) = match found {
        Some((number, count, case)) => (Some(number), count, Some(case)),
        None => (None, 1, None),
    };
    SelectedDesign { sweep, number, count, original }
}

impl SelectedDesign {
    /// Returns the parameters of the design.
    pub fn case(&self) -> Case {
        self.sweep.grid().case(0)
    }

    /// Returns the number of the design; for a design off the grid, the values on its axes.
    pub fn label(&self) -> String {
        self.number.map_or_else(|| self.values("_", "-"), |number| number.to_string())
    }

    /// Returns the name of the sweep and of the design.
    pub fn title(&self) -> String {
        let name = self.sweep.name();
        match self.number {
            Some(number) => format!("{name} design {number}"),
            None => format!("{name}, {}", self.values(" = ", ", ")),
        }
    }

    /// Formats the keys and values of the design on all axes.
    ///
    /// `equals` is the text between key and value, `separator` the text between two axes.
    pub fn values(&self, equals: &str, separator: &str) -> String {
        let axes = self.sweep.grid().axes().iter();
        axes.map(|axis| format!("{}{equals}{}", axis.parameter().key, axis.value(0)))
            .collect::<Vec<_>>()
            .join(separator)
    }
}

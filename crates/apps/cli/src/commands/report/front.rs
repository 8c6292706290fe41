//! What `squama optimise` has found, for the page of a sweep.

use std::path::Path;

use anyhow::{Context as _, ensure};
use optimisation::{DesignGoal, FRONT, GOAL, OPTIMUM, Statistic};
use ranking::{Criterion, Goal, Relation, Requirement};
use report::{Designs, PageFront};
use results::{Completeness, Results, VerifiedFolder};
use sweep::{PARAMETERS, Parameter, Scalar, Sweep};

use crate::commands::results_folder::ResultsFolder;

/// The designs in a folder of `squama optimise`, to stand beside those of `grid`.
pub fn front(folder: &Path, grid: &ResultsFolder) -> anyhow::Result<PageFront> {
    let name = folder.display();
    // A search states no number of designs, of which some could be missing.
    let found = VerifiedFolder::open(folder, Completeness::Partial)?;
    let table = [FRONT, OPTIMUM].into_iter().find(|table| found.holds(table));
    let table = table.with_context(|| {
        format!("--front {name}: holds neither {FRONT} nor {OPTIMUM}, expected a results folder of squama optimise")
    })?;
    let designs = Designs::of(&Results::of_file(&found, table)?);
    let goal = folder.join(GOAL).display().to_string();
    let goal = DesignGoal::parse(&found.text(GOAL)?, &goal, &[])?;
    let headers = grid.designs.headers();
    let nominal = goal.nominal();
    let objectives = objectives(&nominal);
    // Both share the axes of a figure, so that a grid without the column has no place on it.
    for objective in &objectives {
        ensure!(
            headers.iter().any(|header| *header == objective.column),
            "--front {name}: its objective {} is not a column of the designs in {}, expected a sweep with the same measures and [material]",
            objective.column,
            grid.folder.display()
        );
    }
    Ok(PageFront {
        folder: name.to_string(),
        differences: differences(&goal, grid).into_iter().chain(of_skins(&goal)).collect(),
        variables: goal.space.parameters().map(|parameter| parameter.key.to_owned()).collect(),
        objectives,
        made: made(&goal),
        requirements: nominal.requirements,
        sound: goal.sound,
        designs,
    })
}

/// The objectives as far as nominal designs have them; of a yield alone the columns that samples are to meet.
fn objectives(nominal: &DesignGoal) -> Vec<Criterion> {
    let of_grid = |objective: &&Criterion| objective.column != Statistic::MARGIN;
    let objectives: Vec<Criterion> = nominal.objectives.iter().filter(of_grid).cloned().collect();
    if !objectives.is_empty() {
        return objectives;
    }
    let criterion = |requirement: &Requirement| {
        let is_upper = matches!(requirement.relation, Relation::AtMost | Relation::Below);
        let goal = if is_upper { Goal::Minimize } else { Goal::Maximize };
        Criterion::new(&requirement.column, goal)
    };
    // One is enough: the page takes its second axis from other requirements or the variables.
    nominal.requirements.iter().take(1).map(criterion).collect()
}

/// The quantities over what is made that a goal names, each once.
fn made(goal: &DesignGoal) -> Vec<String> {
    let objectives = goal.objectives.iter().map(|objective| objective.column.as_ref());
    let columns = objectives.chain(goal.requirements.iter().map(|r| r.column.as_str()));
    let mut made: Vec<String> = Vec::new();
    for column in columns.filter(|column| goal.statistic(column).is_some()) {
        if !made.iter().any(|known| known == column) {
            made.push(column.to_owned());
        }
    }
    made
}

/// The part of a goal that is about what is made, and that the designs of a grid have not.
fn of_skins(goal: &DesignGoal) -> Option<String> {
    let tolerances = goal.space.sweep().deviations().iter();
    let tolerances = tolerances.map(|d| format!("tolerance.{} {}", d.key(), d.to_toml()));
    let all: Vec<String> = tolerances.collect();
    goal.is_about_samples().then(|| all.join(", "))
}

/// What has one value in the search and another one in the grid: each parameter with both.
fn differences(goal: &DesignGoal, grid: &ResultsFolder) -> Vec<String> {
    let is_variable = |key: &str| goal.space.parameters().any(|variable| variable.key == key);
    let held = PARAMETERS.iter().filter(|parameter| !is_variable(parameter.key));
    let difference = |parameter: &Parameter| {
        let found = only_value(goal.space.sweep(), parameter)?;
        let expected = only_value(&grid.sweep, parameter)?;
        let path = parameter.path();
        (found != expected).then(|| format!("{path} {found} instead of {expected}"))
    };
    held.filter_map(difference).collect()
}

/// The value of a parameter in all designs of a sweep; `None` if there are several.
fn only_value(sweep: &Sweep, parameter: &Parameter) -> Option<Scalar> {
    match sweep.grid().axis(parameter.key) {
        Some(axis) => (axis.len() == 1).then(|| axis.value(0)),
        None => Some(parameter.get(sweep.grid().base())),
    }
}

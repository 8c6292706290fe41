//! Reads designs found by `squama optimise`, to show them in the report of a sweep.

use std::path::Path;

use anyhow::{Context as _, ensure};
use optimisation::{DesignGoal, FRONT, GOAL, OPTIMUM, Statistic};
use ranking::{Criterion, Goal, Relation};
use report::{Designs, PageFront};
use results::{Completeness, Results, VerifiedFolder};
use sweep::{PARAMETERS, Parameter, Scalar, Sweep};

use crate::commands::answer::SearchedDesign;
use crate::commands::folder_contents::FolderContents;

/// Reads the front or the optimum of the search in `folder`, to show it with the designs of `grid`.
///
/// Also returns a sentence for each check that the optimum fails.
pub fn front(folder: &Path, grid: &FolderContents) -> anyhow::Result<(PageFront, Vec<String>)> {
    let name = folder.display();
    let SearchedDesign { failed_checks, .. } = SearchedDesign::read(folder)?;
    let failed_checks = failed_checks.into_iter();
    let failed = failed_checks.map(|check| format!("The optimum of {name} fails a check: {check}"));
    // Accept a partial table, because a search has no expected number of designs.
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
    // Front and grid share the axes of a figure, so the grid needs a column for each objective.
    for objective in &objectives {
        ensure!(
            headers.iter().any(|header| *header == objective.column),
            "--front {name}: its objective {} is not a column of the designs in {}, expected a sweep with the same measures and [material]",
            objective.column,
            grid.folder.display()
        );
    }
    let front = PageFront {
        folder: name.to_string(),
        differences: differences(&goal, grid).into_iter().chain(tolerances_of(&goal)).collect(),
        variables: goal.space.parameters().map(|parameter| parameter.key.to_owned()).collect(),
        objectives,
        statistics: statistics(&goal),
        requirements: nominal.requirements,
        sound: goal.sound,
        designs,
    };
    Ok((front, failed.collect()))
}

/// Returns the objectives of the nominal goal, without the margin that replaces the yield.
///
/// If the yield is the only objective, returns the column of the first requirement.
fn objectives(nominal: &DesignGoal) -> Vec<Criterion> {
    let objectives: Vec<Criterion> = nominal
        .objectives
        .iter()
        .filter(|objective| objective.column != Statistic::MARGIN)
        .cloned()
        .collect();
    if !objectives.is_empty() {
        return objectives;
    }
    // One column suffices: the figures take their second axis from another requirement or variable.
    nominal
        .requirements
        .iter()
        .take(1)
        .map(|requirement| {
            let is_upper = matches!(requirement.relation, Relation::AtMost | Relation::Below);
            let goal = if is_upper { Goal::Minimize } else { Goal::Maximize };
            Criterion::new(&requirement.column, goal)
        })
        .collect()
}

/// Returns the columns of a goal that are statistics over samples, without duplicates.
fn statistics(goal: &DesignGoal) -> Vec<String> {
    let mut statistics: Vec<String> = Vec::new();
    for column in goal.columns().filter(|column| goal.statistic(column).is_some()) {
        if !statistics.iter().any(|name| name == column) {
            statistics.push(column.to_owned());
        }
    }
    statistics
}

/// Lists the tolerances of a goal; `None` if the goal uses no samples.
///
/// The report lists the tolerances, because the designs of the grid have none.
fn tolerances_of(goal: &DesignGoal) -> Option<String> {
    let tolerances = goal.space.sweep().deviations().iter();
    let tolerances = tolerances.map(|d| format!("tolerance.{} {}", d.key(), d.to_toml()));
    let all: Vec<String> = tolerances.collect();
    goal.is_about_samples().then(|| all.join(", "))
}

/// Lists the fixed parameters with different values in the search and in the grid.
fn differences(goal: &DesignGoal, grid: &FolderContents) -> Vec<String> {
    let fixed = PARAMETERS
        .iter()
        .filter(|parameter| !goal.space.parameters().any(|variable| variable.key == parameter.key));
    fixed
        .filter_map(|parameter| {
            let found = only_value(goal.space.sweep(), parameter)?;
            let expected = only_value(&grid.sweep, parameter)?;
            let path = parameter.path();
            (found != expected).then(|| format!("{path} {found} instead of {expected}"))
        })
        .collect()
}

/// Returns the value of `parameter` if all designs of `sweep` have the same value.
fn only_value(sweep: &Sweep, parameter: &Parameter) -> Option<Scalar> {
    match sweep.grid().axis(parameter.key) {
        Some(axis) => (axis.len() == 1).then(|| axis.value(0)),
        None => Some(parameter.get(sweep.grid().base())),
    }
}

//! Failures as data: what has no value, why, and how far its path came.

use crate::shell::shell_word;
use serde::{Deserialize, Serialize};
use skin::flexure::Flexure;
use skin::puncture::Puncture;
use sweep::Measure;

use super::design_result::{DesignRow, finite};
use super::outcome::Outcome;
use crate::columns::Column;

/// The character between the settings of a design.
pub const SEPARATOR: char = ' ';

/// A measure of a design that has no value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    /// The measure.
    pub measure: Measure,
    /// The reason why it has no value.
    pub outcome: Outcome,
    /// The end of its path.
    pub end: PathEnd,
}

/// The last equilibrium of a path that stopped early, and the last iteration after it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathEnd {
    angle_deg: Option<f64>,
    load: Option<f64>,
    displacement: Option<f64>,
    contacts: Option<usize>,
    step: Option<usize>,
    iteration: Option<usize>,
    residual: Option<f64>,
}

impl PathEnd {
    /// The end of the path of `puncture`.
    pub fn of_puncture(puncture: &Puncture) -> Self {
        let (point, last) = (puncture.path.last(), puncture.history.last());
        Self {
            angle_deg: point.and_then(|point| finite(point.tilt_deg)),
            load: point.and_then(|point| finite(point.force)),
            displacement: point.and_then(|point| finite(point.displacement)),
            contacts: point.map(|point| point.contacts),
            step: last.map(|last| last.step),
            iteration: last.map(|last| last.iteration),
            residual: last.and_then(|last| finite(last.residual)),
        }
    }

    /// The end of the path of `flexure`.
    pub fn of_flexure(flexure: &Flexure) -> Self {
        let (point, last) = (flexure.path.last(), flexure.history.last());
        Self {
            angle_deg: point.and_then(|point| finite(point.end_rotation_deg)),
            load: point.and_then(|point| finite(point.moment)),
            displacement: point.and_then(|point| finite(point.curvature)),
            contacts: point.map(|point| point.contacts),
            step: last.map(|last| last.step),
            iteration: last.map(|last| last.iteration),
            residual: last.and_then(|last| finite(last.residual)),
        }
    }
}

/// A row of `failures.csv`.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureRow {
    /// The design.
    pub design: DesignRow,
    /// The failure.
    pub failure: Failure,
}

/// The columns of `failures.csv` after those that say which design it is.
pub fn failure_detail_columns() -> Vec<Column<FailureRow>> {
    let mut columns: Vec<Column<FailureRow>> = vec![
        Column::new("measure", "-", "what has no value", |f| f.failure.measure.key().into()),
        Column::new("reason", "-", "why, one of the statuses", |f| f.failure.outcome.text().into()),
    ];
    columns.extend(path_end_columns());
    columns.push(Column::new("settings", "-", "settings that are not the sweep's own", |f| {
        f.design.result.settings.clone().into()
    }));
    columns.push(Column::new(
        "command",
        "-",
        "command that solves the design alone, with its whole path, from within this folder",
        |f| f.command().into(),
    ));
    columns
}

fn path_end_columns() -> [Column<FailureRow>; 7] {
    [
        Column::new(
            "angle_deg",
            "deg",
            "tilt of the punctured scale, or rotation of each end, at the last equilibrium",
            |f| f.failure.end.angle_deg.into(),
        ),
        Column::new(
            "load",
            "E_s L t/(1-nu^2) or E_m I_m/t",
            "puncture force, or bending moment, at the last equilibrium",
            |f| f.failure.end.load.into(),
        ),
        Column::new(
            "displacement",
            "t or 1/t",
            "displacement of the punctured point, or curvature, at the last equilibrium",
            |f| f.failure.end.displacement.into(),
        ),
        Column::new("contacts", "-", "closed contacts at the last equilibrium", |f| {
            f.failure.end.contacts.into()
        }),
        Column::new("step", "-", "step of the path at which it ended", |f| {
            f.failure.end.step.into()
        }),
        Column::new("iteration", "-", "last Newton iteration of that step", |f| {
            f.failure.end.iteration.into()
        }),
        Column::new("residual", "-", "largest scaled residual of that iteration", |f| {
            f.failure.end.residual.into()
        }),
    ]
}

impl FailureRow {
    /// The command that solves the design alone.
    fn command(&self) -> String {
        let number = self.design.number;
        let mut command =
            format!("squama design run.toml --design {number} --out designs/{number}");
        let settings = self.design.result.settings.split(SEPARATOR);
        for setting in settings.filter(|text| !text.is_empty()) {
            command.push_str(" --set ");
            command.push_str(&shell_word(setting));
        }
        command
    }
}

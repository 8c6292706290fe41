//! The columns of `failures.csv` that say what has no value, and why.

use super::column::Column;
use super::name;
use crate::design::row::FailureRow;

/// The columns of `failures.csv` after those that say which design it is.
pub fn failure_detail_columns() -> Vec<Column<FailureRow>> {
    let mut columns: Vec<Column<FailureRow>> = vec![
        Column::new("measure", "-", "what has no value", |f| f.failure.measure.key().into()),
        Column::new("reason", "-", "why, one of the statuses", |f| f.failure.outcome.text().into()),
    ];
    columns.extend(path_end_columns());
    columns.push(Column::new(name::SETTINGS, "-", "settings that are not the sweep's own", |f| {
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
        Column::new(name::CONTACTS, "-", "closed contacts at the last equilibrium", |f| {
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

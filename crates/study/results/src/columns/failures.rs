//! Columns of `failures.csv` that describe the failed measure and the reason.

use super::column::Column;
use super::name;
use crate::columns;
use crate::design::row::FailureRow;

/// Returns the columns of `failures.csv` that follow the columns of the design.
pub fn failure_detail_columns() -> Vec<Column<FailureRow>> {
    Vec::from(columns! { FailureRow:
        "measure", "-", |f| f.failure.measure.key(), "measure without a value";
        "reason", "-", |f| f.failure.outcome.text(), "reason, one of the statuses";
        "angle_deg", "deg", |f| f.failure.end.angle_deg,
            "tilt of the punctured scale, or rotation of each end, at the last equilibrium";
        "load", "E_s L t/(1-nu^2) or E_m I_m/t", |f| f.failure.end.load,
            "puncture force, or bending moment, at the last equilibrium";
        "displacement", "t or 1/t", |f| f.failure.end.displacement,
            "displacement of the punctured point, or curvature, at the last equilibrium";
        name::CONTACTS, "-", |f| f.failure.end.contacts, "closed contacts at the last equilibrium";
        "step", "-", |f| f.failure.end.step, "step of the path at which it ended";
        "iteration", "-", |f| f.failure.end.iteration, "last Newton iteration of that step";
        "residual", "-", |f| f.failure.end.residual, "largest scaled residual of that iteration";
        name::SETTINGS, "-", |f| f.design.result.settings.clone(),
            "settings that differ from the sweep";
        "command", "-", |f| f.command(),
            "command that solves the design alone, with its whole path, from within this folder";
    })
}

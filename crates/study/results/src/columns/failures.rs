//! Columns of `failures.csv` that describe the failed measure and the reason.

use super::column::Column;
use super::name;
use crate::columns;
use crate::design::row::FailureRow;

/// Returns the columns of `failures.csv` that follow the columns of the design.
pub fn failure_detail_columns() -> Vec<Column<FailureRow>> {
    Vec::from(columns! { FailureRow:
        "measure", "-", |f| f.failure.measure.key(), "measure without a value";
        "reason", "-", |f| f.failure.outcome.text(), "status that explains the missing value";
        "angle_deg", "deg", |f| f.failure.end.angle_deg,
            "tilt of the punctured scale, or rotation of each end, at the last equilibrium";
        "load", "E_s L t/(1-nu^2) or E_m I_m/t", |f| f.failure.end.load,
            "puncture force, or bending moment, at the last equilibrium";
        "displacement", "t or 1/t", |f| f.failure.end.displacement,
            "displacement of the punctured point, or curvature, at the last equilibrium";
        name::CONTACTS, "-", |f| f.failure.end.contacts,
            "number of closed contacts at the last equilibrium";
        "step", "-", |f| f.failure.end.step, "step at which the path stopped";
        "iteration", "-", |f| f.failure.end.iteration,
            "last Newton iteration of the step at which the path stopped";
        "residual", "-", |f| f.failure.end.residual,
            "largest scaled residual of the last Newton iteration";
        name::SETTINGS, "-", |f| f.design.result.settings.clone(),
            "settings that differ from the sweep";
        "command", "-", |f| f.command(),
            "command that solves the design alone, with its whole path, from within this folder";
    })
}

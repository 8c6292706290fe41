//! Failures as data: what failed, why, and how far it came.

use skin::flexure::Flexure;
use skin::puncture::Puncture;

use crate::columns::{Cell, Column, identity_columns};
use sweep::{Measure, Sweep};

use crate::design::design_result::{Record, Solved};
use crate::design::outcome::Outcome;
use crate::row;

/// What stands between the settings of a design.
pub const SEPARATOR: char = ' ';

/// A measure of a design that has no value.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    number: String,
    settings: String,
    measure: Measure,
    outcome: Outcome,
    course: Course,
}

/// How far the path came.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Course {
    angle_deg: Option<f64>,
    load: Option<f64>,
    displacement: Option<f64>,
    contacts: Option<usize>,
    step: Option<usize>,
    iteration: Option<usize>,
    residual: Option<f64>,
}

/// The columns of `failures.csv` after those that say which design it is.
pub static FAILURES: &[Column<Failure>] = &[
    Column::new("measure", "-", "what has no value", |f| f.measure.key().into()),
    Column::new("reason", "-", "why, one of the statuses", |f| f.outcome.text().into()),
    Column::new(
        "angle_deg",
        "deg",
        "tilt of the punctured scale, or rotation of each end, at the last equilibrium",
        |f| f.course.angle_deg.into(),
    ),
    Column::new(
        "load",
        "E_s L t/(1-nu^2) or E_m I_m/t",
        "puncture force, or bending moment, at the last equilibrium",
        |f| f.course.load.into(),
    ),
    Column::new(
        "displacement",
        "t or 1/t",
        "displacement of the punctured point, or curvature, at the last equilibrium",
        |f| f.course.displacement.into(),
    ),
    Column::new("contacts", "-", "closed contacts at the last equilibrium", |f| {
        f.course.contacts.into()
    }),
    Column::new("step", "-", "step of the path at which it ended", |f| f.course.step.into()),
    Column::new("iteration", "-", "last Newton iteration of that step", |f| {
        f.course.iteration.into()
    }),
    Column::new("residual", "-", "largest scaled residual of that iteration", |f| {
        f.course.residual.into()
    }),
    Column::new("settings", "-", "settings that are not the sweep's own", |f| {
        f.settings.clone().into()
    }),
    Column::new(
        "command",
        "-",
        "command that solves the design alone, with its whole path, from within this folder",
        |f| command(f).into(),
    ),
];

fn command(failure: &Failure) -> String {
    let number = &failure.number;
    let mut command = format!("squama design run.toml --design {number} --out designs/{number}");
    for setting in failure.settings.split(SEPARATOR).filter(|text| !text.is_empty()) {
        command.push_str(" --set ");
        command.push_str(setting);
    }
    command
}

/// Names of the columns of `failures.csv`.
pub fn names(sweep: &Sweep) -> Vec<&'static str> {
    let identity = identity_columns(sweep);
    identity.iter().map(|column| column.name).chain(FAILURES.iter().map(|c| c.name)).collect()
}

/// The rows of `failures.csv` that a solved design of `sweep` gives.
pub fn rows(sweep: &Sweep, solved: &Solved) -> Vec<String> {
    let identity = identity_columns(sweep);
    let row = |failure: Failure| {
        let identity = identity.iter().map(|column| column.cell(&solved.record));
        let cells = identity.chain(FAILURES.iter().map(|column| column.cell(&failure)));
        row::join(cells.map(|cell: Cell| cell.to_string()))
    };
    failures(sweep, solved).into_iter().map(row).collect()
}

fn failures(sweep: &Sweep, solved: &Solved) -> Vec<Failure> {
    let record = &solved.record;
    let mut failures = Vec::new();
    for &measure in sweep.measures() {
        if let Some((outcome, course)) = failed(measure, record, solved) {
            let (number, settings) = (record.number.to_string(), record.settings.clone());
            failures.push(Failure { number, settings, measure, outcome, course });
        }
    }
    failures
}

/// Why a measure has no value, and how far it came; `None` if it has one.
fn failed(measure: Measure, record: &Record, solved: &Solved) -> Option<(Outcome, Course)> {
    let (outcome, course) = match measure {
        Measure::Coverage if record.coverage.is_some() => return None,
        // A formula fails only if the program does.
        Measure::Coverage => (Outcome::Internal, Course::default()),
        Measure::Puncture => {
            let course = solved.puncture.as_ref().map(Course::of_puncture);
            (record.puncture?.outcome, course.unwrap_or_default())
        }
        Measure::Flexure => {
            let course = solved.flexure.as_ref().map(Course::of_flexure);
            (record.flexure?.outcome, course.unwrap_or_default())
        }
    };
    (outcome != Outcome::Complete).then_some((outcome, course))
}

impl Course {
    fn of_puncture(puncture: &Puncture) -> Self {
        let (point, last) = (puncture.path.last(), puncture.history.last());
        Self {
            angle_deg: point.map(|point| point.tilt_deg),
            load: point.map(|point| point.force),
            displacement: point.map(|point| point.displacement),
            contacts: point.map(|point| point.contacts),
            step: last.map(|last| last.step),
            iteration: last.map(|last| last.iteration),
            residual: last.map(|last| last.residual),
        }
    }

    fn of_flexure(flexure: &Flexure) -> Self {
        let (point, last) = (flexure.path.last(), flexure.history.last());
        Self {
            angle_deg: point.map(|point| point.end_rotation_deg),
            load: point.map(|point| point.moment),
            displacement: point.map(|point| point.curvature),
            contacts: point.map(|point| point.contacts),
            step: last.map(|last| last.step),
            iteration: last.map(|last| last.iteration),
            residual: last.map(|last| last.residual),
        }
    }
}

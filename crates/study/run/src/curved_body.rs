//! Compares the force of a design on a flat body with its force on curved bodies.

use results::DesignRow;
use results::columns::{design_columns, name};
use sweep::{BODIES, Case, Measure, Sweep, key};
use text::number::rounded;

use crate::gap_change::{Patience, is_quick, solved_row};
use crate::solve::evaluator::Evaluator;

/// A force on a curved body is reported below this fraction of the force on a flat body.
const LOWER: f64 = 0.9;

/// Describes the loss of force of a design on curved bodies, compared with a flat body.
///
/// Returns `None` if the force decreases by less than a tenth on every body, if the definition has
/// a body or lacks a thickness in mm, or if the design is slow to solve.
pub fn curved_body_warning(sweep: &Sweep, row: &DesignRow) -> Option<String> {
    let case = &row.case;
    let thickness_mm = thickness_of_flat(sweep, case)?;
    let in_newtons = [name::FAILURE_FORCE, name::CRITICAL_FORCE].map(|force| format!("{force}_N"));
    let columns = design_columns(sweep);
    let force = in_newtons.iter().find_map(|name| columns.iter().find(|c| c.name == *name))?;
    let flat = force.cell(row).number()?;
    let evaluator = Evaluator::new(&[Measure::Puncture]);
    let mut lower = Vec::new();
    for body in BODIES.iter().rev() {
        let radius_mm = body.values.iter().find(|(key, _)| *key == key::RADIUS_MM)?.1;
        let mut puncture = case.puncture;
        puncture.curvature = thickness_mm / radius_mm;
        let on_body = Case { puncture, body_radius: None, ..*case };
        let curved = force.cell(&evaluator.row(row.number, &on_body)).number();
        if curved.is_none_or(|curved| curved < LOWER * flat) {
            let text = curved.map_or("without a value".to_owned(), |curved| rounded(curved, 3));
            lower.push(format!("{text} on a {} (radius {radius_mm} mm)", body.name));
        }
    }
    let (name, flat) = (&force.name, rounded(flat, 3));
    (!lower.is_empty()).then(|| {
        format!(
            "{name} is {flat} on a flat body, but {}. To find designs for a body, add [body] to the definition.",
            lower.join(", ")
        )
    })
}

/// Describes the loss of force of design `number` of `sweep` on curved bodies.
///
/// Returns `None` if there is no such design, or if [`curved_body_warning`] returns `None`.
pub fn flat_design_warning(sweep: &Sweep, number: &str) -> Option<String> {
    let grid = sweep.grid();
    // Check the conditions first, so that a design without a possible warning is not solved.
    thickness_of_flat(sweep, &grid.case(grid.parse_number(number).ok()?))?;
    curved_body_warning(sweep, &solved_row(sweep, number, Patience::Milliseconds)?)
}

/// Returns the thickness in mm of a flat design that is quick to solve, otherwise `None`.
fn thickness_of_flat(sweep: &Sweep, case: &Case) -> Option<f64> {
    let is_flat = case.body().curvature == 0.0 && case.body_radius_to.is_none();
    case.material.thickness_mm.filter(|_| is_flat && is_quick(sweep, case))
}

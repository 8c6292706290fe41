//! Reports a load position at which the best design is weaker than at the position of the search.

use optimisation::{Candidate, DesignGoal};
use results::Cell;
use results::columns::{design_columns, name};
use run::Evaluator;
use sweep::{Setting, Sweep};

use crate::print::digits;

/// Number of load positions on the top of a scale.
const PLACES: usize = 11;

/// A force above this fraction of the force at the requested position is not reported.
const WEAKER: f64 = 0.99;

/// Returns a sentence on the weakest load position, if it is weaker than the position of the goal.
///
/// Returns `None` unless the goal names the critical force of a guided needle at one position: a
/// dead load is attached to the corner by definition.
pub fn weakest_place_note(goal: &DesignGoal, best: &Candidate) -> Option<String> {
    let sweep = goal.space.sweep();
    let case = goal.space.case(&best.point);
    let columns = goal.objectives.iter().map(|objective| &*objective.column);
    let mut columns = columns.chain(goal.requirements.iter().map(|r| &*r.column));
    let is_asked = columns.any(|column| column.starts_with(name::CRITICAL_FORCE));
    if !is_asked || !case.puncture.needle.is_guided() || case.puncture.places.is_some() {
        return None;
    }
    let places = Setting::parse(&format!("puncture.places={PLACES}")).ok()?;
    let tried = Sweep::parse(&sweep.at(&case).to_toml(), sweep.name(), &[places]).ok()?;
    // Without derivatives, which would nearly double the time.
    let evaluator = Evaluator::new(&tried.plain_measures());
    let grid = tried.grid();
    let row = evaluator.solve(grid.number(0), &grid.case(0)).row;
    let columns = design_columns(&tried);
    let value = |name: &str| {
        let column = columns.iter().find(|column| column.name == name)?;
        if let Cell::Number(value) = column.cell(&row) { Some((value, column.unit)) } else { None }
    };
    let forces = |suffix: &str| {
        let (requested, _) = value(&[name::CRITICAL_FORCE, suffix].concat())?;
        let (weakest, unit) = value(&[name::WEAKEST_FORCE, suffix].concat())?;
        Some((requested, weakest, unit))
    };
    // In newtons where the material has a modulus, because the goal then uses them too.
    let (requested, weakest, unit) = forces("_N").or_else(|| forces(""))?;
    let (position, _) = value(name::WEAKEST_PLACE)?;
    if weakest >= WEAKER * requested {
        return None;
    }
    let (suffix, unit) = if unit == "N" { ("_N", " N") } else { ("", "") };
    Some(format!(
        "\nWeakest place: {}, {}{unit} ({}{unit} at the place requested)\n  \
         To search for the largest force at the weakest place, use weakest_force{suffix} with puncture.places = {PLACES}.\n",
        describe(position),
        digits(weakest),
        digits(requested),
    ))
}

/// Describes a load position: 0 is the left corner of the top, 1 the right corner.
fn describe(position: f64) -> String {
    if position == 0.0 {
        "the left corner".to_owned()
    } else if position == 1.0 {
        "the right corner".to_owned()
    } else {
        format!("{} of the width from the left corner", digits(position))
    }
}

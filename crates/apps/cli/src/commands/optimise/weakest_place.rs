//! Does a needle get through the best design elsewhere more easily than where it was searched?

use optimisation::{Candidate, DesignGoal};
use results::Cell;
use results::columns::{design_columns, name};
use run::Evaluator;
use sweep::{Setting, Sweep};

use crate::print::digits;

/// Places of the top at which the needle is tried.
const PLACES: usize = 11;

/// A force that is smaller by less than this part is not worth a word.
const WEAKER: f64 = 0.99;

/// A sentence about the weakest place of the best design, if the goal asks for the force of a guided needle at one place, and
/// another is weaker. A needle that slides takes the force of its place; a dead load hangs on the corner and is meant to.
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
    // Derivatives would take nearly as long again, and nobody asks for them here.
    let evaluator = Evaluator::new(&tried.plain_measures());
    let grid = tried.grid();
    let row = evaluator.solve(grid.number(0), &grid.case(0)).row;
    let columns = design_columns(&tried);
    let value = |name: &str| {
        let column = columns.iter().find(|column| column.name == name)?;
        if let Cell::Number(value) = column.cell(&row) { Some((value, column.unit)) } else { None }
    };
    let of = |ending: &str| {
        let there = value(&[name::CRITICAL_FORCE, ending].concat())?.0;
        let (weakest, unit) = value(&[name::WEAKEST_FORCE, ending].concat())?;
        Some((there, weakest, unit))
    };
    // In newtons where a material tells them, as the goal then has them.
    let (there, weakest, unit) = of("_N").or_else(|| of(""))?;
    let (place, _) = value(name::WEAKEST_PLACE)?;
    let place = digits(place);
    (weakest < WEAKER * there).then(|| {
        format!(
            "\nThe needle gets through more easily at {place} of the way from corner to corner: {} {unit}, not {}.\n  \
             A goal on weakest_force{}, with puncture.places = {PLACES}, counts the weakest place.\n",
            digits(weakest),
            digits(there),
            if unit == "N" { "_N" } else { "" },
        )
    })
}

//! Warnings about the validity of the results of a design.

use results::columns::name;
use results::{DesignRow, Outcome};
use run::GapChange;
use sweep::Case;

use crate::answer::Value;

/// Strain limit of the small-strain law of the membrane.
const LARGE_STRAIN: f64 = 0.2;

pub(crate) fn warnings(
    case: &Case,
    row: &DesignRow,
    values: &[Value],
    change: Option<&GapChange>,
) -> Vec<String> {
    let number = |column: &str| Value::number(values, column);
    let mut sentences = Vec::new();
    let ends = [
        ("needle", row.result.puncture.as_ref().map(|p| p.outcome)),
        ("bending", row.result.flexure.as_ref().map(|f| f.outcome)),
    ];
    for (load, outcome) in ends {
        if let Some(outcome) = outcome.filter(|outcome| *outcome != Outcome::Complete) {
            sentences.push(format!("The path of the {load} ends early: {outcome}."));
        }
    }
    // A path that ended early has no critical force, and has its own warning above.
    if let (Some(fold), Some(force)) = (number(name::FOLD_FORCE), number(name::CRITICAL_FORCE)) {
        let share = 100.0 * fold / force;
        sentences.push(format!("Beyond {share:.0} % of the critical force, the modelled surface folds, which is physically impossible: results beyond it are not valid."));
    }
    if number(name::MEMBRANE_STRAIN).is_some_and(|strain| strain > LARGE_STRAIN) {
        sentences.push(
            "The membrane strain exceeds 20 %, beyond the range of its small-strain law."
                .to_owned(),
        );
    }
    // A round tip soon touches the next scale while it still rests on the first, which needs no
    // warning.
    let is_sharp = case.punctured().needle_radius.is_none_or(|radius| radius == 0.0);
    if let Some(tilt) = number(name::PASSING_TILT).filter(|_| is_sharp) {
        sentences.push(format!(
            "At a tilt of {tilt:.1}° the needle reaches the end of the face on which it was set down (a corner, or the notch beside the next scale) and continues from there."
        ));
    }
    sentences.extend(change.into_iter().flat_map(cliffs));
    sentences
}

/// Returns a sentence for each measure that changes by half if the gap changes by a tenth.
fn cliffs(change: &GapChange) -> impl Iterator<Item = String> {
    change.measures.iter().filter(|measure| measure.cliffs().contains(&true)).map(|measure| {
        let [smaller, larger] = measure.changed.map(|changed| {
            changed.map_or("without a value".to_owned(), |changed| {
                format!("{:.2} times as large", changed / measure.value)
            })
        });
        format!(
            "Sensitive to the gap: 10 % smaller or larger, and the {} is {smaller} or {larger}.",
            measure.column.replace('_', " ")
        )
    })
}

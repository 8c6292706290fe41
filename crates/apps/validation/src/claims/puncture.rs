//! Claims about the punctures of Figs. 3 and 6.

use super::digits;
use super::evidence::{Evidence, PunctureCurve};
use super::measured_number::Measured;
use super::statistics::TrendSteps;

pub(super) fn at_slant(evidence: &Evidence, slant: f64) -> Option<&PunctureCurve> {
    evidence.by_slant.iter().find(|curve| curve.design.slant == slant)
}

pub(super) fn first_contact(evidence: &Evidence, slant: f64) -> Option<f64> {
    evidence.design(0.1, 1.0, slant)?.first_contact
}

/// Returns `u*` at first contact with 75°, divided by the smaller value with 0° and 45°.
pub(super) fn steep_scales_touch_first(evidence: &Evidence) -> Option<Measured> {
    let [flat, slanted, steep] = [0.0, 45.0, 75.0].map(|slant| first_contact(evidence, slant));
    let (flat, slanted, steep) = (flat?, slanted?, steep?);
    let value = steep / flat.min(slanted);
    let [of, others] = [steep, flat.min(slanted)].map(digits);
    Some(Measured { value, shown: format!("{}: {of} against {others}", digits(value)) })
}

fn listed(values: &[Option<f64>]) -> String {
    let shown = values.iter().map(|value| value.map_or_else(|| "none".to_owned(), digits));
    shown.collect::<Vec<_>>().join(", ")
}

/// Returns the percentage of steps between neighbouring curves in the expected direction.
pub(super) fn trend(
    curves: &[PunctureCurve],
    value: impl Fn(&PunctureCurve) -> Option<f64>,
    steps: fn(&[Vec<Option<f64>>]) -> TrendSteps,
) -> Option<Measured> {
    let line: Vec<_> = curves.iter().map(value).collect();
    let shown = listed(&line);
    let steps = steps(&[line]);
    Some(Measured { value: steps.percent()?, shown: format!("{steps}: {shown}") })
}

/// Returns the ratio of the largest to the smallest value of the curves that have a value.
pub(super) fn spread(
    curves: &[PunctureCurve],
    value: impl Fn(&PunctureCurve) -> Option<f64>,
) -> Option<Measured> {
    let values: Vec<f64> = curves.iter().filter_map(value).collect();
    let largest = values.iter().copied().reduce(f64::max)?;
    let smallest = values.iter().copied().reduce(f64::min)?;
    let value = largest / smallest;
    let [low, high, ratio] = [smallest, largest, value].map(digits);
    Some(Measured { value, shown: format!("{ratio}: {low} to {high}") })
}

/// Returns the percentage of steps to a larger gap with later contact.
///
/// Rows without contact count as latest contact.
pub(super) fn contact_is_delayed(evidence: &Evidence) -> Option<Measured> {
    let contacts: Vec<_> = evidence.by_gap.iter().map(|curve| Some(curve.contact?[0])).collect();
    let touching = contacts.iter().rposition(Option::is_some)?;
    // The step from the last row with contact to the first row without contact also counts.
    let line = contacts.iter().take(touching + 2).enumerate();
    let line = line.map(|(i, contact)| contact.or((i > touching).then_some(f64::INFINITY)));
    let steps = TrendSteps::rising(&[line.collect()]);
    let shown = format!("{steps}: {}", listed(&contacts));
    Some(Measured { value: steps.percent()?, shown })
}

/// Returns the slope after contact with 75°, divided by the slope with 0°.
pub(super) fn stiffening_by_slant(evidence: &Evidence) -> Option<Measured> {
    let [steep, upright] = [75.0, 0.0].map(|slant| at_slant(evidence, slant));
    Some((steep?.slope_after_contact()? / upright?.slope_after_contact()?).into())
}

/// Returns the slope after contact of upright scales, divided by their slope before contact.
pub(super) fn stiffening_by_contact(evidence: &Evidence) -> Option<Measured> {
    let curve = at_slant(evidence, 0.0)?;
    Some((curve.slope_after_contact()? / curve.slope_before_contact()?).into())
}

//! Claims about the punctures of Figs. 3 and 6.

use super::digits;
use super::evidence::{Evidence, PunctureCurve};
use super::statement::{Measured, Statement};
use super::statistics::TrendSteps;
use super::verdict::Limits;

pub(super) const FIRST_CONTACT_UNSLANTED: [Statement; 1] = [Statement::number(
    "",
    "u* at first contact",
    |evidence| Some(first_contact(evidence, 0.0)?.into()),
    Limits::printed(0.08),
)];

pub(super) const FIRST_CONTACT_AT_45: [Statement; 1] = [Statement::number(
    "",
    "u* at first contact",
    |evidence| Some(first_contact(evidence, 45.0)?.into()),
    Limits::printed(0.08),
)];

pub(super) const STEEP_SCALES_TOUCH_FIRST: [Statement; 1] = [Statement::number(
    "",
    "u* at first contact with 75°, over the smaller of 0° and 45°",
    steep_scales_touch_first,
    Limits::at_most(1.0, 1.0),
)];

pub(super) const INITIAL_STIFFNESS_BY_SLANT: [Statement; 1] = [Statement::number(
    "",
    "steps from slant to slant at which dF*/du* at rest falls, %",
    |evidence| trend(&evidence.by_slant, |curve| curve.initial_slope, TrendSteps::falling),
    Limits::TREND,
)];

pub(super) const STIFFNESS_BY_SLANT: [Statement; 2] = [
    Statement::number(
        "rises",
        "steps from slant to slant at which the stiffness after contact rises, %",
        |evidence| {
            trend(&evidence.by_slant, PunctureCurve::slope_after_contact, TrendSteps::rising)
        },
        Limits::TREND,
    ),
    Statement::number(
        "significantly",
        "stiffness after contact with 75° over that with 0°",
        |evidence| {
            let [steep, upright] = [75.0, 0.0].map(|slant| at_slant(evidence, slant));
            Some((steep?.slope_after_contact()? / upright?.slope_after_contact()?).into())
        },
        Limits::MUCH,
    ),
];

pub(super) const UNSLANTED_CONTACT: [Statement; 2] = [
    Statement::number(
        "little resistance",
        "stiffness after contact over that before it",
        |evidence| {
            let curve = at_slant(evidence, 0.0)?;
            Some((curve.slope_after_contact()? / curve.slope_before_contact()?).into())
        },
        Limits::LITTLE,
    ),
    Statement::number(
        "mostly horizontal",
        "largest angle of the strongest contact force from the horizontal, °",
        |evidence| Some(at_slant(evidence, 0.0)?.contact_angle_deg?.into()),
        Limits::at_most(30.0, 45.0),
    ),
];

pub(super) const BY_LENGTH: [Statement; 4] = [
    Statement::number(
        "smaller L/t penetrates more",
        "steps from length to length at which the penetration at u/t = 0.7 falls, %",
        |evidence| trend(&evidence.by_length, |c| Some(c.end?.penetration), TrendSteps::falling),
        Limits::TREND,
    ),
    Statement::number(
        "smaller L/t tilts less",
        "steps from length to length at which the tilt at u/t = 0.7 rises, %",
        |evidence| trend(&evidence.by_length, |c| Some(c.end?.tilt_deg), TrendSteps::rising),
        Limits::TREND,
    ),
    Statement::number(
        "smaller L/t is stiffer at first",
        "steps from length to length at which dF*/du* at rest falls, %",
        |evidence| trend(&evidence.by_length, |c| c.initial_slope, TrendSteps::falling),
        Limits::TREND,
    ),
    Statement::number(
        "smaller L/t is stiffer after contact",
        "steps from length to length at which the stiffness after contact falls, %",
        |evidence| {
            trend(&evidence.by_length, PunctureCurve::slope_after_contact, TrendSteps::falling)
        },
        Limits::TREND,
    ),
];

pub(super) const BY_GAP: [Statement; 3] = [
    Statement::number(
        "no significant effect on the initial stiffness",
        "largest over smallest dF*/du* at rest",
        |evidence| spread(&evidence.by_gap, |curve| curve.initial_slope),
        Limits::NO_EFFECT,
    ),
    Statement::number(
        "little effect after contact",
        "largest over smallest stiffness after contact",
        |evidence| spread(&evidence.by_gap, PunctureCurve::slope_after_contact),
        Limits::LITTLE,
    ),
    Statement::number(
        "contact is delayed",
        "steps from gap to gap at which u* at first contact rises, %",
        contact_is_delayed,
        Limits::TREND,
    ),
];

pub(super) const TWO_BLOCKS: [Statement; 1] = [Statement::number(
    "",
    "stiffness just after contact over that just before it",
    |evidence| Some(evidence.kink?.into()),
    Limits::at_least(1.1, 1.01),
)];

fn at_slant(evidence: &Evidence, slant: f64) -> Option<&PunctureCurve> {
    evidence.by_slant.iter().find(|curve| curve.design.slant == slant)
}

fn first_contact(evidence: &Evidence, slant: f64) -> Option<f64> {
    evidence.design(0.1, 1.0, slant)?.first_contact
}

fn steep_scales_touch_first(evidence: &Evidence) -> Option<Measured> {
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

/// Counts the steps along a line of curves that go the right way.
fn trend(
    curves: &[PunctureCurve],
    value: impl Fn(&PunctureCurve) -> Option<f64>,
    steps: fn(&[Vec<Option<f64>>]) -> TrendSteps,
) -> Option<Measured> {
    let line: Vec<_> = curves.iter().map(value).collect();
    let shown = listed(&line);
    let steps = steps(&[line]);
    Some(Measured { value: steps.percent()?, shown: format!("{steps}: {shown}") })
}

/// Returns the largest of the values that exist, over the smallest.
fn spread(
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

/// Counts the steps at which contact comes later. Rows that do not touch on the way touch later than those that do.
fn contact_is_delayed(evidence: &Evidence) -> Option<Measured> {
    let contacts: Vec<_> = evidence.by_gap.iter().map(|curve| Some(curve.contact?[0])).collect();
    let touching = contacts.iter().rposition(Option::is_some)?;
    // The step from the last that touches to the first that does not counts as well.
    let later = |i: usize| (i > touching).then_some(f64::INFINITY);
    let line = contacts.iter().take(touching + 2).enumerate();
    let steps = TrendSteps::rising(&[line.map(|(i, contact)| contact.or(later(i))).collect()]);
    let shown = format!("{steps}: {}", listed(&contacts));
    Some(Measured { value: steps.percent()?, shown })
}

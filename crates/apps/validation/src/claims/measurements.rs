//! The measurement for each statement.

use Measurement::{Best, Number};
use critical_force::{FORCE, INITIAL_STIFFNESS, LARGEST_STIFFNESS};
use puncture::trend;

use super::evidence::{BestDesigns, Evidence, LoadedRow, PunctureCurve};
use super::measured_number::Measured;
use super::statistics::{GAP, LENGTH, SLANT, TrendSteps};
use super::{critical_force, digits, flexure, named, puncture};
use crate::study::MeasuredDesign;

/// The measurement that decides a statement.
#[derive(Clone, Copy)]
pub(crate) enum Measurement {
    /// A number that must lie within limits.
    Number(fn(&Evidence) -> Option<Measured>),
    /// The designs with a largest value, which must be the designs that the paper names.
    Best(fn(&Evidence) -> Option<BestDesigns>),
}

/// Returns the measurement for the statement with this number.
pub(super) fn measurement(id: &str) -> Option<Measurement> {
    let parts = [of_puncture, of_critical_force, of_flexure, of_best_designs];
    parts.into_iter().find_map(|part| part(id))
}

/// Returns the measurement for a statement on coverage or on the punctures of Figs. 3 and 6.
///
/// `None` for other statements.
fn of_puncture(id: &str) -> Option<Measurement> {
    Some(match id {
        // If the largest coverage is 0, all coverages are 0.
        "C01" => Number(|e| Some(e.best(|d| d.slant == 0.0, |d| d.coverage)?.value.into())),
        "C02a" => Best(|e| e.best(|_| true, |d| d.coverage)),
        "C02b" => Number(smallest_gap_largest_length),
        "C03" => Number(|e| Some(puncture::first_contact(e, 0.0)?.into())),
        "C04" => Number(|e| Some(puncture::first_contact(e, 45.0)?.into())),
        "C05" => Number(puncture::steep_scales_touch_first),
        "C06" => Number(|e| trend(&e.by_slant, |c| c.initial_slope, TrendSteps::falling)),
        "C07a" => {
            Number(|e| trend(&e.by_slant, PunctureCurve::slope_after_contact, TrendSteps::rising))
        }
        "C07b" => Number(puncture::stiffening_by_slant),
        "C08a" => Number(puncture::stiffening_by_contact),
        "C08b" => Number(|e| Some(puncture::at_slant(e, 0.0)?.contact_angle_deg?.into())),
        "C09a" => {
            Number(|e| trend(&e.by_length, |c| Some(c.end?.penetration), TrendSteps::falling))
        }
        "C09b" => Number(|e| trend(&e.by_length, |c| Some(c.end?.tilt_deg), TrendSteps::rising)),
        "C09c" => Number(|e| trend(&e.by_length, |c| c.initial_slope, TrendSteps::falling)),
        "C09d" => {
            Number(|e| trend(&e.by_length, PunctureCurve::slope_after_contact, TrendSteps::falling))
        }
        "C10a" => Number(|e| puncture::spread(&e.by_gap, |curve| curve.initial_slope)),
        "C10b" => Number(|e| puncture::spread(&e.by_gap, PunctureCurve::slope_after_contact)),
        "C10c" => Number(puncture::contact_is_delayed),
        _ => return None,
    })
}

/// Returns the measurement for a statement on critical force, puncture stiffness or Fig. 9.
///
/// `None` for other statements.
fn of_critical_force(id: &str) -> Option<Measurement> {
    Some(match id {
        "C11" => Number(|e| {
            let lines = e.lines(GAP, [LENGTH, SLANT], FORCE);
            Measured::steps(TrendSteps::falling(&lines))
        }),
        "C12" => Best(|e| e.best(MeasuredDesign::is_in_figures, FORCE)),
        "C13" => Number(|e| Some(FORCE(e.design(0.1, 0.1, 75.0)?)?.into())),
        // The paper calls both the initial and the post-contact stiffness puncture stiffness.
        "C14a" => Number(|e| critical_force::correlation(e, LARGEST_STIFFNESS)),
        "C14b" => Number(|e| critical_force::correlation(e, INITIAL_STIFFNESS)),
        "C15a" => Best(|e| e.best(MeasuredDesign::is_in_figures, LARGEST_STIFFNESS)),
        "C15b" => Best(|e| e.best(MeasuredDesign::is_in_figures, INITIAL_STIFFNESS)),
        "C16a" => Number(|e| critical_force::slant_effect(e, MeasuredDesign::is_in_figures, FORCE)),
        "C16b" => Number(|e| {
            critical_force::slant_effect(e, MeasuredDesign::is_in_figures, LARGEST_STIFFNESS)
        }),
        "C16c" => Number(|e| {
            critical_force::slant_effect(e, MeasuredDesign::is_in_figures, INITIAL_STIFFNESS)
        }),
        "C16d" => Number(|e| critical_force::slant_effect(e, |_| true, FORCE)),
        "C17" => Number(|e| loaded(e, 0, |row| row.carrying)),
        "C18a" => Number(|e| loaded(e, 1, |row| row.carrying)),
        "C18b" => Number(|e| loaded(e, 1, |row| row.touching)),
        _ => return None,
    })
}

/// Returns the measurement for a statement on bending; `None` for other statements.
fn of_flexure(id: &str) -> Option<Measurement> {
    Some(match id {
        "C19a" => Number(flexure::axial_before_contact),
        "C19b" => Number(|e| Some(flexure::strip(e, 0.0)?.axial_at_end.into())),
        "C20a" => Number(flexure::slanted_scales_soften),
        "C20b" => Number(|e| Some(flexure::strip(e, 0.0)?.softening?.into())),
        "C20c" => Number(|e| Some(e.short_strip?.softening?.into())),
        "C21" => Number(flexure::loss_of_compliance),
        "C22a" => Best(|e| flexure::touching(e, 0.0)),
        "C22b" => Best(|e| flexure::touching(e, 30.0)),
        "C23a" => Best(|e| flexure::touching(e, 60.0)),
        "C23b" => Best(|e| flexure::touching(e, 75.0)),
        "C24" => Number(|e| {
            let lines = e.lines(LENGTH, [GAP, SLANT], |d| d.compliance);
            Measured::steps(TrendSteps::falling(&lines))
        }),
        _ => return None,
    })
}

/// Returns the measurement for a statement on the best designs or on the kink of two blocks.
///
/// `None` for other statements.
fn of_best_designs(id: &str) -> Option<Measurement> {
    Some(match id {
        "C25" => Best(|e| e.best(MeasuredDesign::is_covered, |d| d.penetration.map(f64::recip))),
        "C26" => Best(|e| e.best(MeasuredDesign::is_covered, |d| d.compliance)),
        "C27" => Best(|e| e.best(MeasuredDesign::is_covered, FORCE)),
        "C28" => Best(|e| Some(e.balanced?.into())),
        "C29" => Number(share_of_printed),
        "C30" => Number(|e| Some(e.kink?.into())),
        _ => return None,
    })
}

/// Returns the coverage at the smallest gap and largest length, divided by the maximum.
fn smallest_gap_largest_length(evidence: &Evidence) -> Option<Measured> {
    let there = evidence.design(0.1, 1.0, 45.0)?;
    let best = evidence.best(|_| true, |d| d.coverage)?;
    // If the design equals the best one up to round-off, the ratio must be exactly 1.
    let equal = best.designs.iter().any(|design| named(design) == named(there));
    Some(if equal { 1.0 } else { there.coverage? / best.value }.into())
}

/// Applies `count` to row `which` of Fig. 9: row 0 is upright, row 1 has a slant of 75°.
fn loaded(evidence: &Evidence, which: usize, count: fn(&LoadedRow) -> usize) -> Option<Measured> {
    let row = evidence.loaded.as_ref()?.get(which)?;
    let count = count(row);
    let [force, displacement] = [row.force, row.displacement].map(digits);
    let shown = format!("{count}, at F* = {force} and u* = {displacement}");
    Some(Measured { value: count as f64, shown })
}

/// Returns the percentage of weightings for which the optimum printed in the paper is the best.
fn share_of_printed(evidence: &Evidence) -> Option<Measured> {
    let balanced = evidence.balanced?;
    let ours = format!("{}, wins {:.1} %", named(&balanced.best), balanced.share);
    let value = balanced.share_of_printed;
    Some(Measured { value, shown: format!("{value:.1} %; ours, {ours}") })
}

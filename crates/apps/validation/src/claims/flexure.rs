//! Claims about flexure.

use super::digits;
use super::evidence::{BentStrip, BestDesigns, Evidence};
use super::measured_number::Measured;

/// A strip softens if its slope falls below this fraction of its maximum.
const SOFTENS: f64 = 0.9;

pub(super) fn strip(evidence: &Evidence, slant: f64) -> Option<&BentStrip> {
    evidence.strips.iter().find(|strip| strip.slant == slant)
}

/// Returns the percentage of the strips of slanted scales that soften.
pub(super) fn slanted_scales_soften(evidence: &Evidence) -> Option<Measured> {
    let slanted: Vec<_> = evidence.strips.iter().filter(|strip| strip.slant > 0.0).collect();
    // A path that stops early has no final slope, and does not count as softening.
    let softens = slanted.iter().filter(|s| s.softening.is_some_and(|ratio| ratio < SOFTENS));
    let value = 100.0 * softens.count() as f64 / slanted.len() as f64;
    let shown = slanted
        .iter()
        .map(|strip| {
            let ratio = strip.softening.map_or_else(|| "no value".to_owned(), digits);
            format!("× {ratio} with {}°", strip.slant)
        })
        .collect::<Vec<_>>()
        .join(", ");
    (!slanted.is_empty()).then_some(Measured { value, shown })
}

/// Returns the most compliant designs with this slant that bend to contact.
pub(super) fn touching(evidence: &Evidence, slant: f64) -> Option<BestDesigns> {
    evidence.best(|d| d.is_in_figures() && d.bends_to_contact && d.slant == slant, |d| d.compliance)
}

pub(super) fn axial_before_contact(evidence: &Evidence) -> Option<Measured> {
    let before = strip(evidence, 0.0)?.axial_before;
    // Before contact, the axial energy may be only round-off.
    let shown = if before < 1e-12 { "below 1e-12".to_owned() } else { digits(before) };
    Some(Measured { value: before, shown })
}

/// Returns the largest ratio of initial to final compliance of designs that bend to contact.
pub(super) fn loss_of_compliance(evidence: &Evidence) -> Option<Measured> {
    let best = evidence.best(
        |d| d.is_in_figures() && d.bends_to_contact,
        |d| Some(d.initial_compliance? / d.compliance?),
    )?;
    Some(Measured { value: best.value, shown: best.to_string() })
}

//! Claims about flexure.

use skin::flexure::{self, Flexure};

use super::finding::{Finding, digits, named};
use super::puncture::{GAP, LENGTH, SLANT, all_lines, in_figures};
use super::statistics::{falls, lines, share};
use crate::study::{MeasuredDesign, Study};

fn bent(study: &Study, gap: f64, length: f64, slant_deg: f64, strip: f64) -> Option<Flexure> {
    let case = study.base;
    let design = skin::Design { gap, length, slant_deg, ..case.design };
    let mut parameters = case.flexure;
    parameters.membrane_length = strip;
    let mut common = case.common;
    common.solver.max_step = 0.002;
    flexure::solve(&design, &common, &parameters).ok()
}

/// The length of the strip, over `t`: that of the experiment of Fig. 10, on which the cubes touch.
const STRIP: f64 = 10.0;

pub(super) fn axial_energy(study: &Study) -> Option<Finding> {
    let flexure = bent(study, 0.1, 1.0, 0.0, STRIP)?;
    let ratio = |point: &flexure::PathPoint| point.axial_energy / point.bending_energy;
    let free = flexure.path.iter().filter(|p| p.contacts == 0 && p.bending_energy > 0.0);
    let before = free.map(ratio).reduce(f64::max)?;
    let after = ratio(flexure.path.last()?);
    // Without contact it is round-off, which has no digits.
    let free = if before < 1e-12 { "below 1e-12".to_owned() } else { digits(before) };
    let ours = format!("{free} before, {} at the end", digits(after));
    Some(Finding::is(before < 1e-3 && after > 0.1, ours))
}

/// Returns the slope of the moment at twice the curvature of the first contact over the largest slope before.
fn falls_to(flexure: &Flexure) -> Option<f64> {
    let end = 2.0 * flexure.measures.first_contact_curvature?;
    let points = flexure.path.iter().filter(|point| point.contacts > 0 && point.curvature <= end);
    let slopes: Vec<f64> = points.map(|point| point.stiffness).collect();
    Some(slopes.last()? / slopes.iter().copied().reduce(f64::max)?)
}

pub(super) fn softening(study: &Study) -> Option<Finding> {
    let slanted = [30.0, 45.0, 60.0, 75.0]
        .map(|slant| bent(study, 0.1, 1.0, slant, STRIP).as_ref().and_then(falls_to));
    let slanted: Vec<f64> = slanted.into_iter().collect::<Option<_>>()?;
    let upright = falls_to(&bent(study, 0.1, 1.0, 0.0, STRIP)?)?;
    let (soften, stays) = (slanted.iter().all(|ratio| *ratio < 0.9), upright > 0.9);
    let listed: Vec<_> = slanted.iter().map(|ratio| digits(*ratio)).collect();
    let ours =
        format!("× {} for slants 30° to 75°; × {} for 0°", listed.join(", "), digits(upright));
    Some(Finding::graded(soften && stays, soften || stays, ours))
}

pub(super) fn loss_of_compliance(study: &Study) -> Option<Finding> {
    let loss = |d: &MeasuredDesign| Some(d.initial_compliance? / d.compliance?);
    let (design, loss) = study.largest(|d| in_figures(d) && d.bends_to_contact, loss)?;
    let (within, near) = ((300.0..3000.0).contains(&loss), (30.0..30_000.0).contains(&loss));
    Some(Finding::graded(within, near, format!("{} at {}", digits(loss), named(design))))
}

/// Returns the most compliant design of a slant: of all, and of those that touch.
fn most_compliant_at(study: &Study, slant: f64) -> [Option<&MeasuredDesign>; 2] {
    let of_slant = |d: &MeasuredDesign| in_figures(d) && d.slant == slant;
    let all = study.largest(of_slant, |d| d.compliance);
    let touching = study.largest(|d| of_slant(d) && d.bends_to_contact, |d| d.compliance);
    [all, touching].map(|found| Some(found?.0))
}

/// Compares the most compliant designs with the printed ones. The paper seems to speak of the designs that touch; a
/// design counts if either reading agrees.
fn most_compliant_as_printed(study: &Study, printed: [(f64, f64, f64); 2]) -> Option<Finding> {
    let (mut agree, mut ours) = (0, Vec::new());
    for (slant, gap, length) in printed {
        let [all, touching] = most_compliant_at(study, slant);
        let found = [all, touching].into_iter().flatten();
        agree += u8::from(found.into_iter().any(|d| (d.gap, d.length) == (gap, length)));
        let touching = touching.map_or_else(|| "none".to_owned(), named);
        ours.push(format!("{}, of those that touch {touching}", named(all?)));
    }
    Some(Finding::graded(agree == 2, agree == 1, ours.join("; ")))
}

pub(super) fn most_compliant_at_small_slants(study: &Study) -> Option<Finding> {
    most_compliant_as_printed(study, [(0.0, 0.1, 0.1), (30.0, 0.1, 0.1)])
}

pub(super) fn most_compliant_at_large_slants(study: &Study) -> Option<Finding> {
    most_compliant_as_printed(study, [(60.0, 0.5, 0.1), (75.0, 1.0, 0.1)])
}

pub(super) fn compliance_by_length(study: &Study) -> Option<Finding> {
    let designs = study.designs.iter().filter(|design| in_figures(design));
    let lines = lines(designs, LENGTH, [GAP, SLANT], |d| d.compliance);
    (!lines.is_empty()).then(|| all_lines(share(&lines, falls)))
}

//! Claims about coverage and puncture.

use skin::puncture::{self, Puncture, RowLength};
use solver::Settings;
use substrate::RowStiffness;
use sweep::Case;

use super::finding::{Finding, digits, named};
use super::statistics::{DesignParameter, DesignValue, explained, falls, lines, rises, share};
use crate::study::{MeasuredDesign, Study};

/// The part of the load from which a scale counts as carrying it. The paper gives none; 5 % leaves out the wide shallow bowl
/// of reactions around the load.
const CARRIES: f64 = 0.05;

pub(super) const GAP: DesignParameter = |design| design.gap;
pub(super) const LENGTH: DesignParameter = |design| design.length;
pub(super) const SLANT: DesignParameter = |design| design.slant;
const FORCE: DesignValue = |design| design.critical_force;

/// Returns whether the figures show a design: they leave out the smallest aspect ratios.
pub(super) fn in_figures(design: &MeasuredDesign) -> bool {
    design.length >= 0.1
}

pub(super) fn unslanted_coverage(study: &Study) -> Option<Finding> {
    let (_, best) = study.largest(|d| d.slant == 0.0, |d| d.coverage)?;
    Some(Finding::is(best == 0.0, digits(best)))
}

pub(super) fn best_coverage(study: &Study) -> Option<Finding> {
    let (design, coverage) = study.largest(|_| true, |d| d.coverage)?;
    let agrees = design.gap == 0.1 && design.slant == 45.0 && design.length > 0.75;
    let ours = format!("{}, λ = {}", named(design), digits(coverage));
    Some(Finding::is(agrees, ours))
}

fn first_contact(study: &Study, slant: f64) -> Option<f64> {
    study.design(0.1, 1.0, slant)?.first_contact
}

pub(super) fn first_contact_unslanted(study: &Study) -> Option<Finding> {
    Some(Finding::number(first_contact(study, 0.0)?, 0.08))
}

pub(super) fn first_contact_at_45(study: &Study) -> Option<Finding> {
    Some(Finding::number(first_contact(study, 45.0)?, 0.08))
}

pub(super) fn steep_scales_touch_first(study: &Study) -> Option<Finding> {
    let [flat, slanted, steep] = [0.0, 45.0, 75.0].map(|slant| first_contact(study, slant));
    let (flat, slanted, steep) = (flat?, slanted?, steep?);
    let ours = format!("{} against {} and {}", digits(steep), digits(flat), digits(slanted));
    Some(Finding::is(steep < flat.min(slanted), ours))
}

/// Returns the value of each design; `None` if one lacks it.
fn along<const N: usize>(
    designs: [Option<&MeasuredDesign>; N],
    value: DesignValue,
) -> Option<Vec<f64>> {
    designs.into_iter().map(|design| value(design?)).collect()
}

fn listed(values: &[f64]) -> String {
    values.iter().map(|value| digits(*value)).collect::<Vec<_>>().join(", ")
}

fn by_slant(study: &Study, value: DesignValue) -> Option<Vec<f64>> {
    let designs = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0].map(|slant| study.design(0.1, 1.0, slant));
    along(designs, value)
}

pub(super) fn initial_stiffness_by_slant(study: &Study) -> Option<Finding> {
    let values = by_slant(study, |design| design.initial_stiffness)?;
    Some(Finding::is(falls(&values), listed(&values)))
}

pub(super) fn stiffness_by_slant(study: &Study) -> Option<Finding> {
    let values = by_slant(study, |design| design.max_stiffness)?;
    // The slants of Fig. 6b.
    let drawn = [values[0], values[3], values[5]];
    Some(Finding::graded(rises(&values), rises(&drawn), listed(&values)))
}

/// Returns a design with the other parameters of the study.
fn case(study: &Study, gap: f64, length: f64, slant: f64) -> Case {
    let mut case = study.base;
    case.design = skin::Design { gap, length, slant_deg: slant, ..case.design };
    case
}

fn substrate(case: &Case) -> Option<RowStiffness> {
    RowStiffness::of(&case.footprint().ok()?, case.coupling).ok()
}

fn punctured(case: &Case) -> Option<Puncture> {
    puncture::solve(&case.design, &substrate(case)?, &case.common, &case.puncture).ok()
}

/// Returns the mean stiffness of the step behind the first contact over that of the step before it.
fn kink(puncture: &Puncture) -> Option<f64> {
    let first = puncture.path.iter().position(|point| point.contacts > 0)?;
    let stiffness = |at: usize| {
        let [from, to] = [puncture.path.get(at)?, puncture.path.get(at + 1)?];
        Some((to.force - from.force) / (to.displacement - from.displacement))
    };
    Some(stiffness(first)? / stiffness(first.checked_sub(1)?)?)
}

fn finely(mut case: Case) -> Case {
    case.common.solver = Settings { first_step: 1e-3, max_step: 1e-3, ..Settings::default() };
    case
}

pub(super) fn unslanted_contact(study: &Study) -> Option<Finding> {
    let case = finely(case(study, 0.1, 1.0, 0.0));
    let at = [puncture::At::Tilt(case.puncture.critical_tilt_deg)];
    let solved =
        puncture::snapshots(&case.design, &substrate(&case)?, &case.common, &case.puncture, &at)
            .ok()?;
    let contacts = &solved.at.first()?.as_ref()?.contacts;
    let strongest = contacts
        .iter()
        .max_by(|a, b| a.force[0].hypot(a.force[1]).total_cmp(&b.force[0].hypot(b.force[1])))?;
    let angle = strongest.force[1].abs().atan2(strongest.force[0].abs()).to_degrees();
    let kink = kink(&solved.puncture)?;
    let (horizontal, little) = (angle < 30.0, kink < 1.5);
    let ours = format!("{angle:.1}° from the horizontal; stiffness × {}", digits(kink));
    Some(Finding::graded(horizontal && little, horizontal || little, ours))
}

pub(super) fn stiffness_by_length(study: &Study) -> Option<Finding> {
    let designs = study.designs.iter().filter(|d| (d.gap, d.slant) == (0.1, 45.0) && in_figures(d));
    let per_length = |d: &MeasuredDesign| Some(d.max_stiffness? / d.length);
    let line = lines(designs, LENGTH, [GAP, SLANT], per_length).pop()?;
    // As Fig. 6d draws it: dF*/du* = (1 − ν²) K*/(L/t).
    let plane = 1.0 - study.base.puncture.poisson_ratio.powi(2);
    let line: Vec<f64> = line.into_iter().map(|stiffness| plane * stiffness).collect();
    Some(Finding::graded(falls(&line), falls(&line[line.len() / 2..]), listed(&line)))
}

pub(super) fn stiffness_by_gap(study: &Study) -> Option<Finding> {
    let line: Vec<&MeasuredDesign> =
        study.designs.iter().filter(|d| (d.length, d.slant) == (0.5, 45.0)).collect();
    let stiffness: Option<Vec<f64>> = line.iter().map(|d| d.initial_stiffness).collect();
    // Large gaps have no contact.
    let contact: Vec<f64> = line.iter().filter_map(|d| d.first_contact).collect();
    let stiffness = stiffness?;
    let (low, high) = stiffness
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), k| (low.min(*k), high.max(*k)));
    let (constant, later) = (high / low < 1.05, rises(&contact));
    let ours = format!("{} to {}; contact at {}", digits(low), digits(high), listed(&contact));
    Some(Finding::graded(constant && later, constant || later, ours))
}

/// Creates a finding from the share of the lines that show a trend: all, or in part at least 80 %.
pub(super) fn all_lines(share: f64) -> Finding {
    Finding::graded(share >= 1.0, share >= 0.8, format!("{:.1} %", 100.0 * share))
}

pub(super) fn force_by_gap(study: &Study) -> Option<Finding> {
    let lines = lines(study.designs.iter(), GAP, [LENGTH, SLANT], FORCE);
    (!lines.is_empty()).then(|| all_lines(share(&lines, falls)))
}

fn at_the_corner(design: &MeasuredDesign) -> bool {
    (design.gap, design.length, design.slant) == (0.1, 0.1, 75.0)
}

pub(super) fn largest_force(study: &Study) -> Option<Finding> {
    let (design, _) = study.largest(in_figures, FORCE)?;
    Some(Finding::is(at_the_corner(design), named(design)))
}

pub(super) fn largest_force_value(study: &Study) -> Option<Finding> {
    Some(Finding::number(study.design(0.1, 0.1, 75.0)?.critical_force?, 64.0))
}

pub(super) fn force_and_stiffness(study: &Study) -> Option<Finding> {
    let pair = |d: &MeasuredDesign| Some([d.max_stiffness?, d.critical_force?]);
    let pairs: Vec<_> = study.designs.iter().filter(|d| in_figures(d)).filter_map(pair).collect();
    let rank = ranking::rank_correlation(&pairs)?;
    Some(Finding::graded(rank > 0.8, rank > 0.5, format!("{rank:.3}")))
}

pub(super) fn largest_stiffness(study: &Study) -> Option<Finding> {
    let (design, stiffness) = study.largest(in_figures, |d| d.max_stiffness)?;
    Some(Finding::is(
        at_the_corner(design),
        format!("{}, K* = {}", named(design), digits(stiffness)),
    ))
}

pub(super) fn strongest_parameter(study: &Study) -> Option<Finding> {
    let valued = |d| Some((d, FORCE(d)?.ln()));
    let designs: Vec<_> =
        study.designs.iter().filter(|d| in_figures(d)).filter_map(valued).collect();
    if designs.is_empty() {
        return None;
    }
    let [gap, length, slant] = [GAP, LENGTH, SLANT].map(|p| 100.0 * explained(&designs, p));
    let ours = format!("d/t {gap:.0} %, L/t {length:.0} %, slant {slant:.0} %");
    Some(Finding::is(slant > gap.max(length), ours))
}

/// Returns the number of scales that carry a part of the load at the critical tilt.
fn carriers(study: &Study, slant: f64) -> Option<usize> {
    let puncture = punctured(&case(study, 0.1, 1.0, slant))?;
    let load: f64 = puncture.scales.iter().map(|scale| scale.reaction).sum();
    Some(puncture.scales.iter().filter(|scale| scale.reaction >= CARRIES * load).count())
}

pub(super) fn unslanted_load(study: &Study) -> Option<Finding> {
    let count = carriers(study, 0.0)?;
    Some(Finding::graded(count == 1, count <= 3, count.to_string()))
}

pub(super) fn domino(study: &Study) -> Option<Finding> {
    let count = carriers(study, 75.0)?;
    Some(Finding::graded((7..=9).contains(&count), (5..=11).contains(&count), count.to_string()))
}

pub(super) fn two_blocks(study: &Study) -> Option<Finding> {
    let mut case = finely(case(study, 0.1, 1.0, 0.0));
    case.puncture.scales = RowLength::Scales(2);
    let kink = kink(&punctured(&case)?)?;
    Some(Finding::is(kink > 1.05, format!("stiffness × {}", digits(kink))))
}

//! Gathers the evidence of a study, and computes results that its tables do not contain.

use ranking::{Ranking, TetrahedralGrid, Weights};
use rayon::prelude::*;
use skin::flexure::{self, Flexure};
use skin::puncture::{self, At, Puncture, RowLength, RowSnapshot, Snapshots};
use skin::{ContactChange, Status};
use solver::Settings;
use substrate::RowStiffness;
use sweep::Case;

use super::evidence::{Balanced, BentStrip, CurveEnd, Evidence, LoadedRow, PunctureCurve};
use super::statistics::{DesignParameter, GAP, LENGTH, SLANT};
use crate::study::{MeasuredDesign, Study};

/// Displacement `u/t` at the end of the curves, as in Fig. 6.
const DEPTH: f64 = 0.7;

/// The number of depths at which contact forces are evaluated.
const DEPTHS: usize = 14;

/// Minimum fraction of the load that a scale must carry to count as loaded.
const CARRIES: f64 = 0.05;

/// Largest step, as a fraction of the path, of paths for the evaluation of slopes.
const FINE: f64 = 2e-3;

/// Length, divided by `t`, of a strip that bends further than the strips of the paper.
const SHORT: f64 = 10.0;

/// Maximum number of halvings of a strip until its scales touch.
const HALVINGS: i32 = 10;

/// Gathers the evidence of a study.
pub(super) fn gather(study: &Study) -> Evidence {
    Evidence {
        designs: study.designs.clone(),
        by_slant: curves(study, |d| (d.gap, d.length) == (0.1, 1.0), SLANT),
        by_length: curves(study, |d| (d.gap, d.slant) == (0.1, 45.0) && d.is_in_figures(), LENGTH),
        by_gap: curves(study, |d| (d.length, d.slant) == (0.5, 45.0), GAP),
        loaded: loaded(study),
        kink: two_blocks(study).as_ref().and_then(kink),
        strips: strips(study).unwrap_or_default(),
        short_strip: bent(study, 0.0, SHORT).map(|bent| bent_strip(0.0, &bent)),
        balanced: balanced(study),
    }
}

/// Returns the case of a design in the study.
fn case(study: &Study, gap: f64, length: f64, slant: f64) -> Case {
    let mut case = study.base;
    case.design = skin::Design { gap, length, slant_deg: slant, ..case.design };
    case
}

fn substrate(case: &Case) -> Option<RowStiffness> {
    RowStiffness::compute(&case.footprint().ok()?, case.coupling).ok()
}

fn snapshots(case: &Case, at: &[At]) -> Option<Snapshots> {
    puncture::snapshots(&case.design, &substrate(case)?, &case.common, &case.punctured(), at).ok()
}

/// Solves the curves of some designs of the study, sorted by a parameter.
fn curves(
    study: &Study,
    among: fn(&MeasuredDesign) -> bool,
    by: DesignParameter,
) -> Vec<PunctureCurve> {
    let mut designs: Vec<_> = study.designs.iter().filter(|design| among(design)).collect();
    designs.sort_by(|a, b| by(a).total_cmp(&by(b)));
    designs.into_par_iter().map(|design| curve(study, design)).collect()
}

fn curve(study: &Study, design: &MeasuredDesign) -> PunctureCurve {
    let case = case(study, design.gap, design.length, design.slant);
    // dF*/du* = (1 − ν²) K*/(L/t).
    let slope = (1.0 - case.puncture.poisson_ratio.powi(2)) / design.length;
    let initial_slope = design.initial_stiffness.map(|stiffness| slope * stiffness);
    let start = PunctureCurve { design: *design, initial_slope, ..PunctureCurve::default() };
    let depths = (1..=DEPTHS).map(|i| At::Displacement(DEPTH * i as f64 / DEPTHS as f64));
    let Some(solved) = snapshots(&case, &depths.collect::<Vec<_>>()) else { return start };
    let angles = solved.at.iter().flatten().filter_map(contact_angle_deg);
    PunctureCurve {
        contact: first_contact(&solved.puncture),
        contact_angle_deg: angles.reduce(f64::max),
        end: solved.at.last().and_then(Option::as_ref).map(|end| curve_end(&case, end)),
        ..start
    }
}

/// Returns `u*` and `F*` at the first contact; `None` if it lies beyond the curve.
fn first_contact(puncture: &Puncture) -> Option<[f64; 2]> {
    let first = puncture.events.iter().find(|event| event.change == ContactChange::Closed)?.point;
    (first.displacement < DEPTH).then_some([first.displacement, first.force])
}

fn curve_end(case: &Case, snapshot: &RowSnapshot) -> CurveEnd {
    let a = case.design.half_base();
    let depths = snapshot
        .scales
        .iter()
        .map(|scale| a * scale.rotation_deg.to_radians().sin().abs() - scale.displacement[1]);
    CurveEnd {
        displacement: snapshot.displacement,
        force: snapshot.force,
        tilt_deg: snapshot.tilt_deg,
        penetration: depths.fold(0.0, f64::max),
    }
}

/// Returns the angle between the largest contact force and the horizontal, degrees.
fn contact_angle_deg(snapshot: &RowSnapshot) -> Option<f64> {
    let forces = snapshot.contacts.iter().map(|contact| contact.force);
    let strongest = forces.max_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])))?;
    Some(strongest[1].abs().atan2(strongest[0].abs()).to_degrees())
}

/// Solves the rows of Fig. 9, with 0° and 75°, under the largest force that both rows reach.
///
/// The designs are the designs of Fig. 6a.
fn loaded(study: &Study) -> Option<[LoadedRow; 2]> {
    let cases = [0.0, 75.0].map(|slant| case(study, 0.1, 1.0, slant));
    let forces =
        cases.map(|case| Some(snapshots(&case, &[At::Displacement(DEPTH)])?.at.pop()??.force));
    let force = forces[0]?.min(forces[1]?);
    let [upright, steep] = cases.map(|case| {
        let snapshot = snapshots(&case, &[At::Force(force)])?.at.pop()??;
        Some(loaded_row(&snapshot))
    });
    Some([upright?, steep?])
}

fn loaded_row(snapshot: &RowSnapshot) -> LoadedRow {
    let load: f64 = snapshot.scales.iter().map(|scale| scale.reaction).sum();
    LoadedRow {
        force: snapshot.force,
        displacement: snapshot.displacement,
        carrying: snapshot.scales.iter().filter(|scale| scale.reaction >= CARRIES * load).count(),
        touching: (0..snapshot.scales.len())
            .filter(|i| {
                snapshot.contacts.iter().any(|contact| contact.left == *i || contact.right == *i)
            })
            .count(),
    }
}

/// Solves the puncture of a row of two upright scales.
fn two_blocks(study: &Study) -> Option<Puncture> {
    let mut case = case(study, 0.1, 1.0, 0.0);
    case.puncture.scales = RowLength::Scales(2);
    // Steps are small and equal, so that mean slopes approximate the slopes at the contact.
    case.common.solver = Settings { first_step: 1e-3, max_step: 1e-3, ..Settings::default() };
    puncture::solve(&case.design, &substrate(&case)?, &case.common, &case.punctured()).ok()
}

/// Returns the ratio of the mean stiffnesses in the steps after and before the first contact.
fn kink(puncture: &Puncture) -> Option<f64> {
    let first = puncture.path.iter().position(|point| point.contacts > 0)?;
    let [before, after] = [first.checked_sub(1)?, first].map(|at| {
        let [from, to] = [puncture.path.get(at)?, puncture.path.get(at + 1)?];
        Some((to.force - from.force) / (to.displacement - from.displacement))
    });
    Some(after? / before?)
}

/// Bends the strips of Fig. 11b.
///
/// The length of the study is halved until upright scales touch.
fn strips(study: &Study) -> Option<Vec<BentStrip>> {
    let whole = study.base.flexure.membrane_length;
    let lengths = (0..HALVINGS).map(|halvings| whole * 0.5_f64.powi(halvings));
    let length = lengths.into_iter().find(|length| {
        bent(study, 0.0, *length).is_some_and(|strip| strip.measures.contact == Some(true))
    })?;
    let slants = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0];
    slants.map(|slant| Some(bent_strip(slant, &bent(study, slant, length)?))).into_iter().collect()
}

fn bent(study: &Study, slant: f64, length: f64) -> Option<Flexure> {
    let mut case = case(study, 0.1, 1.0, slant);
    case.flexure.membrane_length = length;
    case.common.solver.max_step = FINE;
    flexure::solve(&case.design, &case.common, &case.flexure).ok()
}

fn bent_strip(slant: f64, bent: &Flexure) -> BentStrip {
    let free = bent.path.iter().filter(|p| p.contacts == 0 && p.bending_energy > 0.0);
    let slopes: Vec<f64> =
        bent.path.iter().filter(|point| point.contacts > 0).map(|point| point.stiffness).collect();
    let steepest = slopes.iter().copied().reduce(f64::max);
    // A path that stops early has no slope at its end.
    let last = slopes.last().filter(|_| bent.status == Status::Complete);
    BentStrip {
        slant,
        axial_before: free.map(axial_share).fold(0.0, f64::max),
        axial_at_end: bent.path.last().map_or(0.0, axial_share),
        softening: last.zip(steepest).map(|(last, steepest)| last / steepest),
    }
}

fn axial_share(point: &flexure::FlexurePoint) -> f64 {
    point.axial_energy / point.bending_energy
}

fn balanced(study: &Study) -> Option<Balanced> {
    let ranking = Ranking::new(&study.results, TetrahedralGrid::default()).ok()?;
    let best = ranking.winner(Weights::BALANCED);
    let printed = ranking.winners().into_iter().find(|winner| {
        let design = study.designs.get(winner.row());
        design.is_some_and(|d| (d.gap, d.length, d.slant) == (0.7, 0.1, 60.0))
    });
    Some(Balanced {
        best: study.designs.get(best.row()).copied()?,
        fitness: best.fitness,
        share: 100.0 * best.share(),
        // A design that is never the best has 0 % of the weightings.
        share_of_printed: printed.map_or(0.0, |winner| 100.0 * winner.share()),
    })
}

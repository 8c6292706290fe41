//! The list of all measured values, from which the columns of the tables derive.
//!
//! To add a value, add a field to the measures, compute the field in the file of this table, and
//! add an entry to [`VALUES`]:
//!
//! | Value | Computed in |
//! |---|---|
//! | of the puncture | `PunctureMeasures::new` in `skin/src/puncture/measures.rs` |
//! | of the puncture at several critical tilts | `skin/src/puncture/tilt_measures.rs` |
//! | of bending | `FlexureMeasures::new` in `skin/src/flexure/measures.rs` |
//! | of bending with unequal gaps | `skin/src/flexure/gap_by_gap.rs` |
//! | statistics over imperfect samples | `run/src/solve/samples.rs` |
//! | coverage | `run/src/solve/evaluator.rs` |
//! | areal mass | `quantity.rs` |
//!
//! A value with derivatives also needs an entry for its point of the path in
//! `skin/src/puncture/sensitivity.rs` or `skin/src/flexure/sensitivity.rs`.

use skin::puncture::{CriticalEvent, FailureMode};

use sweep::key;

use super::builders::{
    BOTH, COMPLIANCE, COVERAGE, DEPTH, FORCE, NONE, bending, depth, force, number, of_bending,
    of_puncture, renamed, same, stiffness, value,
};
use super::measured_value::MeasuredValue;
use super::measured_value::PathPoint::{
    Anywhere, Contact, End, Fold, FoldOrEnd, Instability, Nowhere, Peak, Rest,
};
use super::measured_value::Value::{ArealMass, Coverage, Samples, SamplesAlone, Settings};
use super::name;
use crate::design::outcome::Outcome;
use crate::quantity::Quantity;

/// Parameter that enables the search for the weakest load position.
const PLACES: &[&str] = &[key::PLACES];

/// Parameters that request the puncture of the row across, which is perpendicular to the row.
const ACROSS: &[&str] = &[key::ACROSS, key::GAP_ACROSS, key::GAP_ACROSS_MM];

/// Parameters that request bodies between two radii.
const BETWEEN: &[&str] = &[key::RADIUS_TO, key::RADIUS_TO_MM];

/// Parameters that request the first failure.
const FAILURE: &[&str] = &[
    key::FAILURE,
    key::NEEDLE_FORCE,
    key::NEEDLE_FORCE_N,
    key::SCALE_STRENGTH_OVER_SUBSTRATE,
    key::BOND_STRENGTH_OVER_SUBSTRATE,
    key::SCALE_STRENGTH,
    key::BOND_STRENGTH,
];

/// Builds the list of measured values.
///
/// Each entry has the name of the column, the point of the path or the tables, the accessor,
/// options, and the meaning.
macro_rules! values {
    ($(
        $kind:ident($name:expr, $of:expr, $value:expr)$(.$has:ident($($what:expr),*))*: $meaning:expr;
    )*) => {
        &[$(MeasuredValue {
            meaning: $meaning,
            ..$kind($name, $of, $value)$(.$has($($what),*))*
        }),*]
    };
}

/// Every measured value, in the order of `designs.csv`.
pub(crate) static VALUES: &[MeasuredValue] = values! {
    value(name::COVERAGE, COVERAGE, Coverage).large().first():
        "fraction of the scale layer that a vertical line through the top right corner of a scale crosses as solid scale; 0 for upright scales";
    force(name::CRITICAL_FORCE, End, |m| &mut m.critical_force)
        .physical(&[same(Quantity::Force), renamed(Quantity::ForcePerWidth, "critical_force_per_width", "puncture force at the critical tilt per width of the scales")])
        .large().sampled("critical force", |s| s.critical_force)
        .at_tilts("puncture force where the path first reaches the tilt, or the friction, in the name", |m| m.force)
        .first():
        "puncture force at the critical tilt";
    depth(name::PENETRATION, End, |m| &mut m.penetration)
        .within(DEPTH).small().sampled("penetration", |s| s.penetration)
        .at_tilts("depth of the deepest base corner where the path first reaches the tilt, or the friction, in the name", |m| m.penetration)
        .first():
        "depth of the deepest base corner of any scale at the critical tilt";
    value("puncture_samples_failed", BOTH, Samples(|s| s.puncture_failed)):
        "number of imperfect samples without puncture values, excluded from mean and quantiles";
    of_puncture("puncture_status", BOTH, |p| p.outcome.text().into()).last():
        "complete, or why the puncture has no values";
    force("peak_force", Peak, |m| &mut m.peak_force).large().then():
        "largest puncture force up to the critical tilt, or up to the end of the path";
    depth(name::CRITICAL_DISPLACEMENT, End, |m| &mut m.critical_displacement)
        .within(BOTH)
        .at_tilts("displacement of the punctured point where the path first reaches the tilt, or the friction, in the name", |m| m.displacement)
        .first():
        "downward displacement of the punctured point at the critical tilt";
    depth("sink", End, |m| &mut m.sink).within(DEPTH).small():
        "depth of the deepest midpoint of a base at the critical tilt";
    depth(name::FIRST_CONTACT, Contact, |m| &mut m.first_contact_displacement):
        "displacement of the punctured point when scales first touch";
    // Contact counts depend on the end of the path: counts at tilts of 5° and 10° must not be
    // compared.
    of_puncture(name::CONTACTS, BOTH, |p| p.measures.contacts.into()).at(End).then():
        "number of closed contacts at the critical tilt";
    of_puncture("engaged_scales", BOTH, |p| p.measures.engaged_scales.into()).at(End).large():
        "number of scales in contact with a neighbour at the critical tilt, including the punctured scale";
    of_puncture(name::CRITICAL_EVENT, BOTH, |p| p.measures.passage.critical_event.map(CriticalEvent::name).into())
        .guided():
        "event that ended the path of a guided needle: tilt if a scale in contact with the needle is critically tilted, through if the needle has reached the soft surface";
    force("passing_force", Anywhere, |m| &mut m.passage.passing_force).large().guided():
        "puncture force where a guided needle first touches a corner or another scale in addition to its face; empty if it does not";
    depth("passing_displacement", Anywhere, |m| &mut m.passage.passing_displacement)
        .within(BOTH).guided():
        "depth of the tip of a guided needle where it first touches a corner or another scale";
    number(name::PASSING_TILT, Anywhere, |m| &mut m.passage.passing_tilt_deg)
        .in_unit("deg").guided():
        "tilt of the punctured scale where a guided needle first touches a corner or another scale";
    depth("needle_shift", Anywhere, |m| &mut m.passage.needle_shift).within(BOTH).guided():
        "inward movement of a guided needle on its face, at the end of the path or where it first touches a corner or another scale";
    of_puncture("scales", BOTH, |p| (p.measures.scales > 0).then_some(p.measures.scales).into()):
        "number of scales in the solved row";
    stiffness(name::INITIAL_STIFFNESS, Rest, |m| &mut m.initial_stiffness):
        "puncture stiffness at rest";
    stiffness(name::MAX_STIFFNESS, Anywhere, |m| &mut m.max_stiffness).along_path().then():
        "largest puncture stiffness on the path";
    stiffness(name::SECANT_STIFFNESS, End, |m| &mut m.secant_stiffness):
        "puncture force divided by displacement at the critical tilt";
    of_puncture("puncture_points", NONE, |p| p.points.into()):
        "number of equilibria of the puncture path";
    of_puncture("puncture_iterations", NONE, |p| p.iterations.into()):
        "number of Newton iterations of the puncture path";
    of_puncture("calibration_error", NONE, |p| p.calibration_error.into()):
        "estimated relative error of the substrate stiffness, including terms that full coupling neglects";
    bending(name::COMPLIANCE, Anywhere, |m| &mut m.compliance)
        .in_unit("1/(E_m I_m)")
        .physical(&[renamed(Quantity::Rigidity, "flexural_rigidity", "flexural rigidity: largest slope of the moment against the curvature")])
        .large().sampled("flexural compliance", |s| s.compliance).first():
        "flexural compliance: 1 divided by the largest slope of the moment against the curvature";
    of_bending("flexure_status", COMPLIANCE, |f| f.outcome.text().into()).last():
        "complete, or why the bending has no values";
    bending(name::INITIAL_COMPLIANCE, Rest, |m| &mut m.initial_compliance)
        .in_unit("1/(E_m I_m)")
        .physical(&[renamed(Quantity::Rigidity, "initial_flexural_rigidity", "flexural rigidity at rest")])
        .large():
        "flexural compliance at rest";
    of_bending(name::FLEXURE_CONTACT, COMPLIANCE, |f| f.measures.contact.map(yes_or_no).into()).then():
        "yes or no: whether bending closes contacts";
    bending(name::FIRST_CONTACT_CURVATURE, Contact, |m| &mut m.first_contact_curvature)
        .in_unit("1/t").large():
        "curvature when scales first touch";
    bending("max_moment", Anywhere, |m| &mut m.max_moment)
        .in_unit("E_m I_m/t").physical(&[same(Quantity::Moment)]):
        "largest moment on the path";
    bending("axial_energy_share", End, |m| &mut m.axial_energy_share):
        "fraction of the elastic energy that stretches the membrane, at the largest rotation";
    of_bending("gaps", COMPLIANCE, |f| (f.measures.gaps > 0.0).then_some(f.measures.gaps).into()):
        "number of gaps of the strip; whole only in a chain";
    of_bending("flexure_points", NONE, |f| f.points.into()):
        "number of equilibria of the bending path";
    of_bending("flexure_iterations", NONE, |f| f.iterations.into()):
        "number of Newton iterations of the bending path";
    value(name::SETTINGS, NONE, Settings):
        "settings of a rerun design that differ from the sweep";
    of_bending("flexure_error", COMPLIANCE, |f| f.measures.error.into()):
        "estimated relative error of the measures of bending, from the resolution of the membrane; empty for a given number of elements";
    bending(name::MEMBRANE_STRAIN, Anywhere, |m| &mut m.membrane_strain_max).small().then():
        "largest strain at the surface of the membrane; above 0.2 the small-strain law is outside its range";
    depth("peak_displacement", Peak, |m| &mut m.peak_displacement):
        "downward displacement of the punctured point at the largest force";
    number("peak_tilt_deg", Peak, |m| &mut m.peak_tilt_deg).in_unit("deg"):
        "tilt of the punctured scale at the largest force";
    of_puncture("stable_under_load", FORCE, |p| p.measures.stable_under_load.map(yes_or_no).into()).along_path():
        "yes or no: whether the row is stable at the critical tilt under a constant load";
    of_puncture("stable_under_depth", FORCE, |p| p.measures.stable_under_depth.map(yes_or_no).into()).along_path():
        "yes or no: whether the row is stable at the critical tilt at a constant depth of the punctured point";
    force("load_stability_force", Instability, |m| &mut m.load_stability_force):
        "puncture force at which the row becomes unstable under load control; empty if it does not";
    force("depth_stability_force", Instability, |m| &mut m.depth_stability_force):
        "puncture force at which the row becomes unstable under depth control; empty if it does not";
    of_puncture("snaps", FORCE, |p| p.measures.snaps.into()).at(Anywhere).along_path():
        "number of snaps of the row under a needle with increasing depth";
    number(name::GAP_STRETCH_MIN, End, |m| &mut m.gap_stretch_min).large().then():
        "width of the tightest gap between bases at the critical tilt divided by its width at rest; 0 or less where the surface is folded";
    number(name::GAP_STRETCH_MAX, End, |m| &mut m.gap_stretch_max).small().then():
        "width of the widest gap between bases at the critical tilt divided by its width at rest";
    force(name::FOLD_FORCE, Fold, |m| &mut m.fold_force).large().then():
        "puncture force at the first fold of the surface; empty if it does not fold";
    depth("fold_displacement", Fold, |m| &mut m.fold_displacement):
        "displacement of the punctured point at the first fold of the surface";
    number("fold_tilt_deg", Fold, |m| &mut m.fold_tilt_deg).in_unit("deg"):
        "tilt of the punctured scale at the first fold of the surface";
    force(name::SOUND_FORCE, FoldOrEnd, |m| &mut m.sound_force).large().first():
        "puncture force at the critical tilt or at the first fold, whichever comes first: the largest force at which the model is valid";
    force("force_at_depth", Anywhere, |m| &mut m.force_at_depth)
        .large().first().needing(&[key::DEPTH, key::DEPTH_MM]):
        "puncture force at the requested depth, or at the critical tilt if that comes first; low for skins that sink";
    force(name::WEAKEST_FORCE, Anywhere, |m| &mut m.weakest.force)
        .large().first().needing(PLACES):
        "smallest puncture force, over the evaluated load positions, at which the scale is critically tilted or a guided needle is through";
    of_puncture(name::WEAKEST_PLACE, FORCE, |p| p.measures.weakest.position.into()).then().needing(PLACES):
        "load position with the smallest puncture force: 0 the left corner of the top, 1 the right";
    of_puncture("weakest_status", FORCE, |p| p.weakest.map(Outcome::text).into())
        .last().needing(PLACES):
        "complete, or why a load position that may have a smaller force has no force, so that weakest_force is unknown";
    force(name::FORCE_ACROSS, End, |m| &mut m.across.force)
        .large().first().needing(ACROSS):
        "puncture force at the critical tilt across the row, with the load at the side of a scale";
    force(name::FORCE_ANY_DIRECTION, End, |m| &mut m.across.any_direction)
        .large().first().needing(ACROSS):
        "smaller one of force_across and the force along the row, which is weakest_force if load positions are compared, otherwise critical_force";
    of_puncture("across_status", FORCE, |p| p.across.map(Outcome::text).into())
        .last().needing(ACROSS):
        "complete, or why the row across has no critical force";
    force(name::WORST_FORCE_BETWEEN, End, |m| &mut m.between.force)
        .large().first().needing(BETWEEN):
        "smallest puncture force at the critical tilt on bodies between the two radii";
    of_puncture("worst_curvature", FORCE, |p| p.measures.between.curvature.into())
        .in_unit("1/t").needing(BETWEEN):
        "curvature of the body with the smallest puncture force: positive for a convex body";
    of_puncture("between_status", FORCE, |p| p.between.map(Outcome::text).into())
        .last().needing(BETWEEN):
        "complete, or why a body between the two radii has no critical force, so that worst_force_between is unknown";
    force(name::FAILURE_FORCE, Anywhere, |m| &mut m.failure.force)
        .large().first().needing(FAILURE):
        "puncture force at the first failure: where a scale is critically tilted, breaks or bends by 5 deg, a bond fails, the needle is through or perforates a scale, or the surface folds; or the force across the row, if that is smaller";
    of_puncture(name::FIRST_FAILURE, FORCE, |p| p.measures.failure.mode.map(FailureMode::name).into())
        .at(Anywhere).then().needing(FAILURE):
        "mode of the first failure: tilt, through, fold, break, bend, debond, perforate or across; modes without a strength are not judged";
    number("scale_stress_max", Anywhere, |m| &mut m.failure.scale_stress)
        .in_unit("E_s").physical(&[same(Quantity::Stress)]).small().then().along_path().needing(FAILURE):
        "largest bending stress of any scale, as a beam, up to the end of the path";
    depth("scale_deflection_max", Anywhere, |m| &mut m.failure.scale_deflection)
        .small().along_path().needing(FAILURE):
        "largest deflection of the tip of any scale, as a beam, up to the end of the path";
    number("bond_stress_max", Anywhere, |m| &mut m.failure.bond_stress)
        .in_unit("E_s").physical(&[same(Quantity::Stress)]).small().along_path().needing(FAILURE):
        "largest traction at any base, in tension or mean shear, up to the end of the path";
    number(name::TISSUE_PRESSURE_MAX, Anywhere, |m| &mut m.failure.tissue_pressure)
        .in_unit("E_s").physical(&[same(Quantity::Pressure)]).small().along_path().needing(FAILURE):
        "largest mean pressure of any base on the substrate up to the end of the path";
    number(name::TISSUE_PRESSURE_AT_FORCE, Anywhere, |m| &mut m.tissue_pressure_at_force)
        .in_unit("E_s").physical(&[same(Quantity::Pressure)]).small().needing(&[key::NEEDLE_FORCE, key::NEEDLE_FORCE_N]):
        "largest mean pressure of any base on the substrate when the needle first presses with the given force; empty for a skin that does not withstand that force";
    depth("clearance", Nowhere, |m| &mut m.failure.clearance).needing(FAILURE):
        "distance between the faces of two neighbours at rest";
    of_puncture(name::FRICTION_WORK, BOTH, |p| p.measures.friction_work.into())
        .in_unit("E* t^3").at(End).needing(&[key::FRICTION]):
        "work dissipated by friction between scales up to the critical tilt";
    of_puncture("loop_work", BOTH, |p| p.measures.remains.loop_work.into())
        .in_unit("E* t^3").at(End).needing(&[key::UNLOAD]):
        "work of the load that is not recovered during unloading: dissipated by friction, or stored in the remaining deformation";
    of_puncture("remaining_displacement", BOTH, |p| p.measures.remains.displacement.into())
        .in_unit("t").at(End).needing(&[key::UNLOAD]):
        "displacement of the punctured point that remains after unloading";
    of_puncture("unload_status", BOTH, |p| p.unloading.map(Outcome::text).into())
        .last().needing(&[key::UNLOAD]):
        "complete, or why the load did not return to zero, so that the values of unloading are unknown";
    of_puncture("unique", BOTH, |p| p.measures.unique.map(yes_or_no).into()).needing(&[key::FRICTION]):
        "yes or no: whether the outgoing branch was unique at every event of the puncture path, among the evaluated combinations of sticking and slipping";
    of_bending("flexure_friction_work", COMPLIANCE, |f| f.measures.friction_work.into())
        .in_unit("E_m t^3").at(End).needing(&[key::FRICTION]):
        "work dissipated by friction between scales up to the largest rotation, for the whole strip";
    of_bending("flexure_loop_work", COMPLIANCE, |f| f.measures.remains.loop_work.into())
        .in_unit("E_m t^3").at(End).needing(&[key::UNBEND]):
        "work of the moment that is not recovered during unloading, for the whole strip";
    of_bending("remaining_curvature", COMPLIANCE, |f| f.measures.remains.displacement.into())
        .in_unit("1/t").at(End).needing(&[key::UNBEND]):
        "curvature that remains after unloading";
    of_bending("unbend_status", COMPLIANCE, |f| f.unloading.map(Outcome::text).into())
        .last().needing(&[key::UNBEND]):
        "complete, or why the moment did not return to zero, so that the values of unloading are unknown";
    of_bending("locking_curvature", COMPLIANCE, |f| f.measures.locking_curvature.into())
        .in_unit("1/t").needing(&[key::FRICTION]):
        "curvature above which the scales stick to each other and lock the strip; empty if it does not lock";
    bending(name::CONTACT_CURVATURE, Contact, |m| &mut m.contact_curvature)
        .in_unit("1/t")
        .physical(&[renamed(Quantity::Radius, "bend_radius", "smallest radius to which the skin bends before scales touch; 0 for a gap that cannot close")])
        .large().then():
        "curvature at which scales touch, even if bending ends before; empty for a gap that cannot close";
    // In a perfect strip all gaps close at the same curvature, so only imperfect samples have a
    // range.
    value("closing_range", COMPLIANCE, SamplesAlone)
        .in_unit("1/t")
        .sampled("curvature range from the first to the last gap that closes,", |s| s.closing_range):
        "";
    value("flexure_samples_failed", COMPLIANCE, Samples(|s| s.flexure_failed)):
        "number of imperfect samples without bending values, excluded from mean and quantiles";
    value(name::AREAL_MASS, COVERAGE, ArealMass).in_unit("kg/m^2").small():
        "mass of the scales divided by the area of the skin";
};

fn yes_or_no(holds: bool) -> &'static str {
    if holds { "yes" } else { "no" }
}

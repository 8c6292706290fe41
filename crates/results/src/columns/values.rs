//! The measured values of a design, an entry each: a new one is added here, and nowhere else but where it is measured.

use skin::flexure::FlexureMeasures;
use skin::puncture::{CriticalEvent, PunctureMeasures};

use sweep::key;

use super::cell::Cell;
use super::entry::{
    BLANK, BOTH, COMPLIANCE, COVERAGE, DEPTH, FORCE, NONE, bending, depth, failed_samples, force,
    number, other, other_thing, same, stiffness,
};
use super::measured_value::{MeasuredValue, Place, Value};
use super::name;
use crate::design::design_result::{DesignResult, PunctureResult};
use crate::design::outcome::Outcome;
use crate::quantity::Quantity;

/// The parameter that asks for the weakest place of the load.
const PLACES: &[&str] = &[key::PLACES];

/// Every measured value, in the order of `designs.csv`.
pub(crate) static VALUES: &[MeasuredValue] = &[

    other(
            name::COVERAGE,
            COVERAGE,
            "share of the thickness that scales fill along a vertical line down from the top right corner of a scale; 0 for upright scales",
            |_| Cell::Empty,
        ).valued(Value::Coverage).large().first(),
    force(name::CRITICAL_FORCE, Place::End, "puncture force at the critical tilt", |m| {
            &mut m.critical_force
        }).physical(&[
            same(Quantity::Force),
            other_thing(
                Quantity::ForcePerWidth,
                "critical_force_per_width",
                "puncture force at the critical tilt, over the width of the scales",
            ),
        ]).large().sampled("critical force", |s| s.critical_force).at_tilts("puncture force where the tilt, or its tangent the friction, first is that of the name", |m| m.force).first(),
    depth(
            name::PENETRATION,
            Place::End,
            "depth of the deepest base corner of any scale at the critical tilt",
            |m| &mut m.penetration,
        ).within(DEPTH).small().sampled("penetration", |s| s.penetration).at_tilts("depth of the deepest base corner where the tilt, or its tangent, first is that of the name", |m| m.penetration).first(),
    failed_samples(
        "puncture_samples_failed",
        BOTH,
        "imperfect samples whose puncture has no values, left out of mean and quantiles",
        |s| s.puncture_failed,
    ),
    other("puncture_status", BOTH, "complete, or why the puncture has no values", |r| {
            punctured(r, |p| p.outcome.text())
        }).last(),
    force(
            "peak_force",
            Place::Peak,
            "largest puncture force up to the critical tilt, or up to where the path stopped",
            |m| &mut m.peak_force,
        ).large().then(),
    depth(
            name::CRITICAL_DISPLACEMENT,
            Place::End,
            "downward displacement of the punctured point at the critical tilt",
            |m| &mut m.critical_displacement,
        ).within(BOTH).at_tilts("displacement of the punctured point where the tilt, or its tangent, first is that of the name", |m| m.displacement),
    depth(
            "sink",
            Place::End,
            "depth of the deepest midpoint of a base at the critical tilt",
            |m| &mut m.sink,
        ).within(DEPTH).small(),
    depth(
        name::FIRST_CONTACT,
        Place::Contact,
        "displacement of the punctured point when scales first touch",
        |m| &mut m.first_contact_displacement,
    ),
    // Counts have a place, too, so that nobody compares those at tilts of 5° and 10°.
    other(name::CONTACTS, BOTH, "closed contacts at the critical tilt", |r| {
            measured(r, |m| m.contacts)
        }).at(Place::End).then(),
    other(
            "engaged_scales",
            BOTH,
            "scales that touch a neighbour at the critical tilt, the punctured one included",
            |r| measured(r, |m| m.engaged_scales),
        ).at(Place::End).large(),
    other(
        name::CRITICAL_EVENT,
        BOTH,
        "what ended the path of a guided needle: tilt, a scale that it touches is critically tilted; through, it has come to the soft surface",
        |r| measured(r, |m| m.passage.critical_event.map(CriticalEvent::name)),
    ).guided(),
    force(
        "passing_force",
        Place::Anywhere,
        "puncture force where a guided needle first touches more than the face that it was set down on, a corner or another scale; empty if it does not",
        |m| &mut m.passage.passing_force,
    ).large().guided(),
    depth(
        "passing_displacement",
        Place::Anywhere,
        "depth of the tip of a guided needle where it first touches more than its face",
        |m| &mut m.passage.passing_displacement,
    ).within(BOTH).guided(),
    number(
        name::PASSING_TILT,
        "deg",
        Place::Anywhere,
        "tilt of the punctured scale where a guided needle first touches more than its face",
        |m| &mut m.passage.passing_tilt_deg,
    ).guided(),
    depth(
        "needle_shift",
        Place::Anywhere,
        "how far a guided needle has moved inward on its face: at the end, or where it first touches more",
        |m| &mut m.passage.needle_shift,
    ).within(BOTH).guided(),
    other("scales", BOTH, "scales in the row that was solved", |r| {
        measured(r, |m| (m.scales > 0).then_some(m.scales))
    }),
    stiffness(name::INITIAL_STIFFNESS, Place::Rest, "puncture stiffness at rest", |m| {
        &mut m.initial_stiffness
    }),
    stiffness(name::MAX_STIFFNESS, Place::Anywhere, "largest puncture stiffness on the path", |m| {
            &mut m.max_stiffness
        }).then(),
    stiffness(
        name::SECANT_STIFFNESS,
        Place::End,
        "puncture force over displacement at the critical tilt",
        |m| &mut m.secant_stiffness,
    ),
    other("puncture_points", NONE, "equilibria of the path of puncture", |r| {
        punctured(r, |p| p.points)
    }),
    other("puncture_iterations", NONE, "Newton iterations of the path of puncture", |r| {
        punctured(r, |p| p.iterations)
    }),
    other(
        "calibration_error",
        NONE,
        "estimated relative error of the stiffness of the substrate, with what full coupling neglects",
        |r| punctured(r, |p| p.calibration_error),
    ),
    bending(
            name::COMPLIANCE,
            "1/(E_m I_m)",
            Place::Anywhere,
            "flexural compliance: 1 over the largest slope of the moment against the curvature",
            |m| &mut m.compliance,
        ).physical(&[other_thing(
            Quantity::Rigidity,
            "flexural_rigidity",
            "flexural rigidity: largest slope of the moment against the curvature",
        )]).large().sampled("flexural compliance", |s| s.compliance).first(),
    other("flexure_status", COMPLIANCE, "complete, or why the bending has no values", |r| {
            r.flexure.map(|f| f.outcome.text()).into()
        }).last(),
    bending(
            name::INITIAL_COMPLIANCE,
            "1/(E_m I_m)",
            Place::Rest,
            "flexural compliance at rest",
            |m| &mut m.initial_compliance,
        ).physical(&[other_thing(
            Quantity::Rigidity,
            "initial_flexural_rigidity",
            "flexural rigidity at rest",
        )]).large(),
    other(
            name::FLEXURE_CONTACT,
            COMPLIANCE,
            "yes or no: whether bending brings scales into contact",
            |r| bent(r, |m| m.contact.map(yes_or_no)),
        ).then(),
    bending(
            name::FIRST_CONTACT_CURVATURE,
            "1/t",
            Place::Contact,
            "curvature when scales first touch",
            |m| &mut m.first_contact_curvature,
        ).large(),
    bending("max_moment", "E_m I_m/t", Place::Anywhere, "largest moment on the path", |m| {
            &mut m.max_moment
        }).physical(&[same(Quantity::Moment)]),
    bending(
        "axial_energy_share",
        "-",
        Place::End,
        "share of the elastic energy that stretches the membrane, at the largest rotation",
        |m| &mut m.axial_energy_share,
    ),
    other("gaps", COMPLIANCE, "gaps of the strip, a whole number in a chain alone", |r| {
        bent(r, |m| (m.gaps > 0.0).then_some(m.gaps))
    }),
    other("flexure_points", NONE, "equilibria of the path of bending", |r| {
        r.flexure.map(|f| f.points).into()
    }),
    other("flexure_iterations", NONE, "Newton iterations of the path of bending", |r| {
        r.flexure.map(|f| f.iterations).into()
    }),
    other(
        name::SETTINGS,
        NONE,
        "settings of a design that was solved again with others than the sweep's own",
        |r| r.settings.clone().into(),
    ),
    other(
        "flexure_error",
        COMPLIANCE,
        "estimated relative error of the measures of bending, from the resolution of the membrane; empty for a given number of elements",
        |r| bent(r, |m| m.error),
    ),
    bending(
            name::MEMBRANE_STRAIN,
            "-",
            Place::Anywhere,
            "largest strain at the surface of the membrane; above 0.2 its law of small strains is outside its range",
            |m| &mut m.membrane_strain_max,
        ).small().then(),
    depth(
        "peak_displacement",
        Place::Peak,
        "downward displacement of the punctured point at the largest force",
        |m| &mut m.peak_displacement,
    ),
    number(
        "peak_tilt_deg",
        "deg",
        Place::Peak,
        "tilt of the punctured scale at the largest force",
        |m| &mut m.peak_tilt_deg,
    ),
    other(
        "stable_under_load",
        FORCE,
        "yes or no: whether the row is stable at the critical tilt if the load is held",
        |r| measured(r, |m| m.stable_under_load.map(yes_or_no)),
    ),
    other(
        "stable_under_depth",
        FORCE,
        "yes or no: whether the row is stable at the critical tilt if the depth of the punctured point is held",
        |r| measured(r, |m| m.stable_under_depth.map(yes_or_no)),
    ),
    force(
        "load_stability_force",
        Place::Instability,
        "puncture force at which a row under a held load becomes unstable; empty if it does not",
        |m| &mut m.load_stability_force,
    ),
    force(
        "depth_stability_force",
        Place::Instability,
        "puncture force at which a row under a held depth becomes unstable; empty if it does not",
        |m| &mut m.depth_stability_force,
    ),
    other(
            "snaps",
            FORCE,
            "times that the row snaps under a needle that only goes deeper",
            |r| punctured(r, |p| p.measures.snaps),
        ).at(Place::Anywhere),
    number(
            name::GAP_STRETCH_MIN,
            "-",
            Place::End,
            "width of the tightest gap between bases at the critical tilt over that at rest; not above 0 where the surface is folded over",
            |m| &mut m.gap_stretch_min,
        ).large().then(),
    number(
            name::GAP_STRETCH_MAX,
            "-",
            Place::End,
            "width of the widest gap between bases at the critical tilt over that at rest",
            |m| &mut m.gap_stretch_max,
        ).small().then(),
    force(
            name::FOLD_FORCE,
            Place::Fold,
            "puncture force at which the surface first folds over; empty if it does not",
            |m| &mut m.fold_force,
        ).large().then(),
    depth(
        "fold_displacement",
        Place::Fold,
        "displacement of the punctured point at which the surface first folds over",
        |m| &mut m.fold_displacement,
    ),
    number(
        "fold_tilt_deg",
        "deg",
        Place::Fold,
        "tilt of the punctured scale at which the surface first folds over",
        |m| &mut m.fold_tilt_deg,
    ),
    force(
            name::SOUND_FORCE,
            Place::FoldOrEnd,
            "puncture force at the critical tilt or at the first fold, whichever comes first: the largest that the model can answer for",
            |m| &mut m.sound_force,
        ).large().first(),
    force(
        "force_at_depth",
        Place::Anywhere,
        "puncture force at the depth that is asked for, or at the critical tilt if that comes first: skins that sink are weak by it",
        |m| &mut m.force_at_depth,
    ).large().first().needing(&[key::DEPTH, key::DEPTH_MM]),
    force(
        name::WEAKEST_FORCE,
        Place::Anywhere,
        "smallest puncture force, over the places of the load that are tried, at which the scale is critically tilted or a guided needle is through",
        |m| &mut m.weakest.force,
    ).large().first().needing(PLACES),
    other(
        name::WEAKEST_PLACE,
        FORCE,
        "place of the load with that force: 0 the left corner of the top, 1 the right",
        |r| measured(r, |m| m.weakest.place),
    ).then().needing(PLACES),
    other(
        "weakest_status",
        FORCE,
        "complete, or why a place that may be weaker has no force, and so the weakest is not known",
        |r| punctured(r, |p| p.weakest.map(Outcome::text)),
    ).last().needing(PLACES),
    other(
        name::FRICTION_WORK,
        BOTH,
        "work that friction between scales has taken up to the critical tilt",
        |r| measured(r, |m| m.friction_work),
    ).in_unit("E* t^3").at(Place::End).needing(&[key::FRICTION]),
    other(
        "loop_work",
        BOTH,
        "work of the load that is not given back as it is taken away: taken by friction, or stored in what does not come back",
        |r| measured(r, |m| m.remains.loop_work),
    ).in_unit("E* t^3").at(Place::End).needing(&[key::UNLOAD]),
    other(
        "remaining_displacement",
        BOTH,
        "displacement of the punctured point that remains once the load is gone",
        |r| measured(r, |m| m.remains.displacement),
    ).in_unit("t").at(Place::End).needing(&[key::UNLOAD]),
    other(
        "unload_status",
        BOTH,
        "complete, or why the load did not come back to zero, and so nothing is known of its way back",
        |r| punctured(r, |p| p.way_back.map(Outcome::text)),
    ).last().needing(&[key::UNLOAD]),
    other(
        "unique",
        BOTH,
        "yes or no: whether no event of the path of puncture had another way on, among the ways of sticking and slipping that were looked at",
        |r| measured(r, |m| m.unique.map(yes_or_no)),
    ).needing(&[key::FRICTION]),
    other(
        "flexure_friction_work",
        COMPLIANCE,
        "work that friction between scales has taken at the largest rotation, of the whole strip",
        |r| bent(r, |m| m.friction_work),
    ).in_unit("E_m t^3").at(Place::End).needing(&[key::FRICTION]),
    other(
        "flexure_loop_work",
        COMPLIANCE,
        "work of the moment that is not given back as it is taken away, of the whole strip",
        |r| bent(r, |m| m.remains.loop_work),
    ).in_unit("E_m t^3").at(Place::End).needing(&[key::UNBEND]),
    other(
        "remaining_curvature",
        COMPLIANCE,
        "curvature that remains once the moment is gone",
        |r| bent(r, |m| m.remains.displacement),
    ).in_unit("1/t").at(Place::End).needing(&[key::UNBEND]),
    other(
        "unbend_status",
        COMPLIANCE,
        "complete, or why the moment did not come back to zero, and so nothing is known of its way back",
        |r| r.flexure.and_then(|f| f.way_back).map(Outcome::text).into(),
    ).last().needing(&[key::UNBEND]),
    other(
        "locking_curvature",
        COMPLIANCE,
        "curvature from which on scales stick on each other and hold the strip; empty if it does not lock",
        |r| bent(r, |m| m.locking_curvature),
    ).in_unit("1/t").needing(&[key::FRICTION]),
    bending(
            name::CONTACT_CURVATURE,
            "1/t",
            Place::Contact,
            "curvature at which scales touch, wherever the bending ends; empty for a gap that cannot close",
            |m| &mut m.contact_curvature,
        ).physical(&[other_thing(
            Quantity::Radius,
            "bend_radius",
            "smallest radius to which the skin bends before scales touch",
        )]).large().then(),
    // In a perfect strip all gaps close at once, so only imperfect samples have a range.
    BLANK.named("closing_range", "1/t", "").within(COMPLIANCE).sampled("curvature from the first contact to that in the last gap that closes,", |s| s.closing_range),
    failed_samples(
        "flexure_samples_failed",
        COMPLIANCE,
        "imperfect samples whose bending has no values, left out of mean and quantiles",
        |s| s.flexure_failed,
    ),
    BLANK.named(name::AREAL_MASS, "kg/m^2", "mass of the scales over the area of the skin").within(COVERAGE).valued(Value::ArealMass).small(),
];

fn measured<T: Into<Cell>>(
    result: &DesignResult,
    value: fn(&PunctureMeasures) -> Option<T>,
) -> Cell {
    result.puncture.and_then(|puncture| value(&puncture.measures)).into()
}

fn yes_or_no(holds: bool) -> &'static str {
    if holds { "yes" } else { "no" }
}

fn punctured<T: Into<Cell>>(result: &DesignResult, value: fn(&PunctureResult) -> T) -> Cell {
    result.puncture.as_ref().map(value).into()
}

fn bent<T: Into<Cell>>(result: &DesignResult, value: fn(&FlexureMeasures) -> Option<T>) -> Cell {
    result.flexure.and_then(|flexure| value(&flexure.measures)).into()
}

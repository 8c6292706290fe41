//! The columns of the measured values of a design.

use skin::flexure;
use skin::puncture::PunctureMeasures;

use super::cell::Cell;
use super::measured_value::MeasuredValue;
use crate::design::design_result::PunctureResult;
use crate::design::row::DesignRow;

const FORCE: &[&str] = &["critical_force"];
const DEPTH: &[&str] = &["penetration"];
const BOTH: &[&str] = &["critical_force", "penetration"];
const COMPLIANCE: &[&str] = &["compliance"];

/// Every measured value, in the order of `designs.csv`.
pub(super) static VALUES: &[MeasuredValue] = &[
    MeasuredValue {
        tables: &["coverage"],
        name: "coverage",
        unit: "-",
        meaning: "share of the thickness that scales fill along a vertical line down from the top right corner of a scale; 0 for upright scales",
        cell: |r| r.result.coverage.into(),
    },
    MeasuredValue {
        tables: FORCE,
        name: "critical_force",
        unit: "E_s L t/(1-nu^2)",
        meaning: "puncture force at the critical tilt",
        cell: |r| measured(r, |m| m.critical_force),
    },
    MeasuredValue {
        tables: DEPTH,
        name: "penetration",
        unit: "t",
        meaning: "depth of the deepest base corner of any scale at the critical tilt",
        cell: |r| measured(r, |m| m.penetration),
    },
    MeasuredValue {
        tables: BOTH,
        name: "puncture_status",
        unit: "-",
        meaning: "complete, or why the puncture has no values",
        cell: |r| punctured(r, |p| p.outcome.text()),
    },
    MeasuredValue {
        tables: FORCE,
        name: "peak_force",
        unit: "E_s L t/(1-nu^2)",
        meaning: "largest puncture force up to the critical tilt, or up to where the path stopped",
        cell: |r| measured(r, |m| m.peak_force),
    },
    MeasuredValue {
        tables: BOTH,
        name: "critical_displacement",
        unit: "t",
        meaning: "downward displacement of the punctured point at the critical tilt",
        cell: |r| measured(r, |m| m.critical_displacement),
    },
    MeasuredValue {
        tables: DEPTH,
        name: "sink",
        unit: "t",
        meaning: "depth of the deepest midpoint of a base at the critical tilt",
        cell: |r| measured(r, |m| m.sink),
    },
    MeasuredValue {
        tables: FORCE,
        name: "first_contact_displacement",
        unit: "t",
        meaning: "displacement of the punctured point when scales first touch",
        cell: |r| measured(r, |m| m.first_contact_displacement),
    },
    MeasuredValue {
        tables: BOTH,
        name: "contacts",
        unit: "-",
        meaning: "closed contacts at the critical tilt",
        cell: |r| measured(r, |m| m.contacts),
    },
    MeasuredValue {
        tables: BOTH,
        name: "engaged_scales",
        unit: "-",
        meaning: "scales that touch a neighbour at the critical tilt, the punctured one included",
        cell: |r| measured(r, |m| m.engaged_scales),
    },
    MeasuredValue {
        tables: BOTH,
        name: "scales",
        unit: "-",
        meaning: "scales in the row that was solved",
        cell: |r| measured(r, |m| (m.scales > 0).then_some(m.scales)),
    },
    MeasuredValue {
        tables: FORCE,
        name: "initial_stiffness",
        unit: "E_s t",
        meaning: "puncture stiffness at rest",
        cell: |r| measured(r, |m| m.initial_stiffness),
    },
    MeasuredValue {
        tables: FORCE,
        name: "max_stiffness",
        unit: "E_s t",
        meaning: "largest puncture stiffness on the path",
        cell: |r| measured(r, |m| m.max_stiffness),
    },
    MeasuredValue {
        tables: FORCE,
        name: "secant_stiffness",
        unit: "E_s t",
        meaning: "puncture force over displacement at the critical tilt",
        cell: |r| measured(r, |m| m.secant_stiffness),
    },
    MeasuredValue {
        tables: &[],
        name: "puncture_points",
        unit: "-",
        meaning: "equilibria of the path of puncture",
        cell: |r| punctured(r, |p| p.points),
    },
    MeasuredValue {
        tables: &[],
        name: "puncture_iterations",
        unit: "-",
        meaning: "Newton iterations of the path of puncture",
        cell: |r| punctured(r, |p| p.iterations),
    },
    MeasuredValue {
        tables: &[],
        name: "calibration_error",
        unit: "-",
        meaning: "estimated relative error of the stiffness of the substrate, with what full coupling neglects",
        cell: |r| punctured(r, |p| p.calibration_error),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "compliance",
        unit: "1/(E_m I_m)",
        meaning: "flexural compliance: 1 over the largest slope of the moment against the curvature",
        cell: |r| bent(r, |m| m.compliance),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "flexure_status",
        unit: "-",
        meaning: "complete, or why the bending has no values",
        cell: |r| r.result.flexure.map(|f| f.outcome.text()).into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "initial_compliance",
        unit: "1/(E_m I_m)",
        meaning: "flexural compliance at rest",
        cell: |r| bent(r, |m| m.initial_compliance),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "flexure_contact",
        unit: "-",
        meaning: "yes or no: whether bending brings scales into contact",
        cell: |r| bent(r, |m| m.contact.map(yes_or_no)),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "first_contact_curvature",
        unit: "1/t",
        meaning: "curvature when scales first touch",
        cell: |r| bent(r, |m| m.first_contact_curvature),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "max_moment",
        unit: "E_m I_m/t",
        meaning: "largest moment on the path",
        cell: |r| bent(r, |m| m.max_moment),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "axial_energy_share",
        unit: "-",
        meaning: "share of the elastic energy that stretches the membrane, at the largest rotation",
        cell: |r| bent(r, |m| m.axial_energy_share),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "gaps",
        unit: "-",
        meaning: "gaps of the strip, a whole number in a chain alone",
        cell: |r| bent(r, |m| (m.gaps > 0.0).then_some(m.gaps)),
    },
    MeasuredValue {
        tables: &[],
        name: "flexure_points",
        unit: "-",
        meaning: "equilibria of the path of bending",
        cell: |r| r.result.flexure.map(|f| f.points).into(),
    },
    MeasuredValue {
        tables: &[],
        name: "flexure_iterations",
        unit: "-",
        meaning: "Newton iterations of the path of bending",
        cell: |r| r.result.flexure.map(|f| f.iterations).into(),
    },
    MeasuredValue {
        tables: &[],
        name: "settings",
        unit: "-",
        meaning: "settings of a design that was solved again with others than the sweep's own",
        cell: |r| r.result.settings.clone().into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "flexure_error",
        unit: "-",
        meaning: "estimated relative error of the measures of bending, from the resolution of the membrane; empty for a given number of elements",
        cell: |r| bent(r, |m| m.error),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "membrane_strain_max",
        unit: "-",
        meaning: "largest strain at the surface of the membrane; above 0.2 its law of small strains is outside its range",
        cell: |r| bent(r, |m| m.membrane_strain_max),
    },
    MeasuredValue {
        tables: FORCE,
        name: "peak_displacement",
        unit: "t",
        meaning: "downward displacement of the punctured point at the largest force",
        cell: |r| measured(r, |m| m.peak_displacement),
    },
    MeasuredValue {
        tables: FORCE,
        name: "peak_tilt_deg",
        unit: "deg",
        meaning: "tilt of the punctured scale at the largest force",
        cell: |r| measured(r, |m| m.peak_tilt_deg),
    },
    MeasuredValue {
        tables: FORCE,
        name: "stable_under_load",
        unit: "-",
        meaning: "yes or no: whether the row is stable at the critical tilt if the load is held",
        cell: |r| measured(r, |m| m.stable_under_load.map(yes_or_no)),
    },
    MeasuredValue {
        tables: FORCE,
        name: "stable_under_depth",
        unit: "-",
        meaning: "yes or no: whether the row is stable at the critical tilt if the depth of the punctured point is held",
        cell: |r| measured(r, |m| m.stable_under_depth.map(yes_or_no)),
    },
    MeasuredValue {
        tables: FORCE,
        name: "load_stability_force",
        unit: "E_s L t/(1-nu^2)",
        meaning: "puncture force at which a row under a held load becomes unstable; empty if it does not",
        cell: |r| measured(r, |m| m.load_stability_force),
    },
    MeasuredValue {
        tables: FORCE,
        name: "depth_stability_force",
        unit: "E_s L t/(1-nu^2)",
        meaning: "puncture force at which a row under a held depth becomes unstable; empty if it does not",
        cell: |r| measured(r, |m| m.depth_stability_force),
    },
    MeasuredValue {
        tables: FORCE,
        name: "snaps",
        unit: "-",
        meaning: "times that the row snaps under a needle that only goes deeper",
        cell: |r| punctured(r, |p| p.measures.snaps),
    },
    MeasuredValue {
        tables: FORCE,
        name: "gap_stretch_min",
        unit: "-",
        meaning: "width of the tightest gap between bases at the critical tilt over that at rest; not above 0 where the surface is folded over",
        cell: |r| measured(r, |m| m.gap_stretch_min),
    },
    MeasuredValue {
        tables: FORCE,
        name: "gap_stretch_max",
        unit: "-",
        meaning: "width of the widest gap between bases at the critical tilt over that at rest",
        cell: |r| measured(r, |m| m.gap_stretch_max),
    },
    MeasuredValue {
        tables: FORCE,
        name: "fold_force",
        unit: "E_s L t/(1-nu^2)",
        meaning: "puncture force at which the surface first folds over; empty if it does not",
        cell: |r| measured(r, |m| m.fold_force),
    },
    MeasuredValue {
        tables: FORCE,
        name: "fold_displacement",
        unit: "t",
        meaning: "displacement of the punctured point at which the surface first folds over",
        cell: |r| measured(r, |m| m.fold_displacement),
    },
    MeasuredValue {
        tables: FORCE,
        name: "fold_tilt_deg",
        unit: "deg",
        meaning: "tilt of the punctured scale at which the surface first folds over",
        cell: |r| measured(r, |m| m.fold_tilt_deg),
    },
    MeasuredValue {
        tables: FORCE,
        name: "sound_force",
        unit: "E_s L t/(1-nu^2)",
        meaning: "puncture force at the critical tilt or at the first fold, whichever comes first: the largest that the model can answer for",
        cell: |r| measured(r, |m| m.sound_force),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "contact_curvature",
        unit: "1/t",
        meaning: "curvature at which scales touch, wherever the bending ends; empty for a gap that cannot close",
        cell: |r| bent(r, |m| m.contact_curvature),
    },
];

fn measured<T: Into<Cell>>(row: &DesignRow, value: fn(&PunctureMeasures) -> Option<T>) -> Cell {
    row.result.puncture.and_then(|puncture| value(&puncture.measures)).into()
}

fn yes_or_no(holds: bool) -> &'static str {
    if holds { "yes" } else { "no" }
}

fn punctured<T: Into<Cell>>(row: &DesignRow, value: fn(&PunctureResult) -> T) -> Cell {
    row.result.puncture.as_ref().map(value).into()
}

fn bent<T: Into<Cell>>(row: &DesignRow, value: fn(&flexure::FlexureMeasures) -> Option<T>) -> Cell {
    row.result.flexure.and_then(|flexure| value(&flexure.measures)).into()
}

//! The columns of the path tables of a design: equilibria, events, scales, iterations.

use skin::flexure;
use skin::puncture::{
    CriticalEvent, Fold, Instability, LoadPosition, Puncture, PuncturePoint, ScaleState, Snap,
    TipForces,
};
use skin::{ContactEvent, Iteration};

use super::column::Column;
use super::name;
use crate::columns;
use crate::design::outcome::Outcome;

/// Equilibrium of a puncture, with its numbers of negative eigenvalues.
pub type StabilityPoint = (PuncturePoint, Instability);

/// Returns the columns of `path.csv`.
///
/// Some columns exist only for a guided needle or for scales with friction.
pub fn path_columns(is_guided: bool, has_friction: bool) -> Vec<Column<StabilityPoint>> {
    let mut columns = Vec::from(columns! { StabilityPoint:
        "displacement", "t", |(p, _)| p.displacement,
            "downward displacement of the punctured point";
        "force", "E_s L t/(1-nu^2)", |(p, _)| p.force, "puncture force";
        "tilt_deg", "deg", |(p, _)| p.tilt_deg, "clockwise tilt of the punctured scale";
        name::CONTACTS, "-", |(p, _)| p.contacts, "number of closed contacts";
        "unstable_under_load", "-", |(_, i)| i.load,
            "number of negative eigenvalues of the stiffness under load control, on the outgoing branch";
        "unstable_under_depth", "-", |(_, i)| i.depth,
            "number of negative eigenvalues of the stiffness under depth control";
        "unstable_under_tilt", "-", |(_, i)| i.tilt,
            "number of negative eigenvalues of the stiffness under tilt control";
        name::GAP_STRETCH_MIN, "-", |(p, _)| p.gap_stretch.map(|stretch| stretch.min),
            "width of the tightest gap between bases divided by its width at rest";
        name::GAP_STRETCH_MAX, "-", |(p, _)| p.gap_stretch.map(|stretch| stretch.max),
            "width of the widest gap between bases divided by its width at rest";
    });
    if is_guided {
        columns.extend(columns! { StabilityPoint:
            "lateral_force", "E_s L t/(1-nu^2)", |(p, _)| p.lateral_force,
                "force of the guided needle on the scales along the row, to the right";
        });
    }
    if has_friction {
        columns.extend(columns! { StabilityPoint:
            name::FRICTION_WORK, "E* t^3", |(p, _)| p.friction_work,
                "work dissipated by friction between scales up to this point";
        });
    }
    columns
}

/// Returns the columns of the forces of a round tip on the scales.
///
/// There is a column for each scale from the first to the last scale that the tip touches.
pub fn tip_force_columns(forces: &[TipForces]) -> Vec<Column<usize>> {
    let scales = forces.iter().flatten().map(|(scale, _)| *scale);
    let (Some(first), Some(last)) = (scales.clone().min(), scales.max()) else { return Vec::new() };
    (first..=last).map(|scale| {
        let on = |of: &TipForces| of.iter().find(|(touched, _)| *touched == scale).map(|of| of.1);
        // If the tip does not touch a scale, the force on this scale is 0, not unknown.
        let values: Vec<f64> = forces.iter().map(|of| on(of).unwrap_or(0.0)).collect();
        Column::computed(
            format!("tip_force_{scale}").into(),
            "E_s L t/(1-nu^2)",
            "normal force of a round tip on the scale in the name: 0 is the punctured one, -1 its left neighbour",
            move |&row: &usize| values[row].into(),
        )
    }).collect()
}

/// One row of `events.csv`: a contact event, a snap, or a fold of the surface.
pub struct PunctureEvent {
    point: PuncturePoint,
    left_scale: Option<i64>,
    right_scale: Option<i64>,
    kind: Option<&'static str>,
    change: &'static str,
    drop: Option<f64>,
}

impl PunctureEvent {
    /// Returns the events of a puncture, in order.
    pub fn all(puncture: &Puncture) -> Vec<Self> {
        // Force, depth and tilt may all reverse along a path, so none of them can order folds,
        // snaps and contact events. Each fold and snap stores the number of contact events before.
        let mut snaps = puncture.snaps.iter().peekable();
        let mut folds = puncture.folds.iter().peekable();
        let mut all = Vec::with_capacity(puncture.events.len());
        for count in 0..=puncture.events.len() {
            let is_last = count == puncture.events.len();
            while let Some(fold) = folds.next_if(|fold| is_last || fold.events_before <= count) {
                all.push(Self::fold(fold));
            }
            while let Some(snap) = snaps.next_if(|snap| is_last || snap.events_before <= count) {
                all.push(Self::snap(snap));
            }
            all.extend(puncture.events.get(count).map(Self::contact));
        }
        all
    }

    /// Creates the row of a contact event.
    fn contact(event: &ContactEvent<PuncturePoint>) -> Self {
        let ContactEvent { point, left_scale, right_scale, .. } = *event;
        let (kind, change) = (Some(event.corner_edge.name()), event.change.name());
        Self { point, left_scale, right_scale, kind, change, drop: None }
    }

    /// Creates the row of a snap.
    fn snap(snap: &Snap) -> Self {
        let Snap { point, drop, .. } = *snap;
        Self { point, left_scale: None, right_scale: None, kind: None, change: "snap", drop }
    }

    /// Creates the row of a fold: the surface in a gap folds or unfolds.
    fn fold(fold: &Fold) -> Self {
        let [left_scale, right_scale] = [fold.left_scale, fold.left_scale + 1].map(Some);
        let (point, kind, change) = (fold.point, Some("gap"), fold.name());
        Self { point, left_scale, right_scale, kind, change, drop: None }
    }
}

/// The columns of `events.csv`.
pub static EVENTS: &[Column<PunctureEvent>] = &columns! { PunctureEvent:
    "displacement", "t", |e| e.point.displacement, "downward displacement of the punctured point";
    "force", "E_s L t/(1-nu^2)", |e| e.point.force, "puncture force";
    "tilt_deg", "deg", |e| e.point.tilt_deg, "clockwise tilt of the punctured scale";
    "left_scale", "-", |e| e.left_scale, "left scale of the pair, 0 is the punctured one";
    "right_scale", "-", |e| e.right_scale, "right scale of the pair, usually the next one";
    "kind", "-", |e| e.kind, "corner and edge in contact, or gap for two bases";
    "change", "-", |e| e.change,
        "change of the contact, or of the surface in the gap; snap where a needle with increasing depth leaves the path";
    "drop", "E_s L t/(1-nu^2)", |e| e.drop,
        "drop of the force in a snap at constant depth; empty if the path ends before it reaches this depth again";
};

/// The columns of `scales.csv`.
pub static SCALES: &[Column<ScaleState>] = &columns! { ScaleState:
    "scale", "-", |s| s.scale,
        "number of the scale: 0 is the punctured scale, positive to the right";
    "displacement_x", "t", |s| s.displacement[0],
        "displacement of the midpoint of the base, to the right";
    "displacement_y", "t", |s| s.displacement[1],
        "displacement of the midpoint of the base, upward";
    "rotation_deg", "deg", |s| s.rotation_deg, "counter-clockwise rotation";
    "reaction", "E_s t^2/(1-nu^2)", |s| s.reaction, "upward reaction of the substrate";
};

/// The columns of `places.csv`.
pub static LOAD_POSITIONS: &[Column<LoadPosition>] = &columns! { LoadPosition:
    "place", "-", |p| p.position,
        "load position: 0 the left corner of the top, 1 the right; above 1, a round tip between two scales";
    name::CRITICAL_FORCE, "E_s L t/(1-nu^2)", |p| p.force,
        "puncture force at which the scale is critically tilted in either direction, or a guided needle is through";
    name::CRITICAL_DISPLACEMENT, "t", |p| p.displacement,
        "downward displacement of the load at the critical force";
    "tilt_deg", "deg", |p| p.tilt_deg,
        "clockwise tilt of the punctured scale at the critical force";
    name::CRITICAL_EVENT, "-", |p| p.critical_event.map(CriticalEvent::name),
        "event that ended the path of a guided needle: tilt or through";
    "largest_force", "E_s L t/(1-nu^2)", |p| p.largest_force,
        "largest puncture force of the path; empty if the load tilts no scale from the first step on";
    "status", "-", |p| Outcome::from(p.status).text(),
        "complete, or why there is no critical force";
};

/// The columns of `steps.csv`.
pub static STEPS: &[Column<Iteration>] = &columns! { Iteration:
    "step", "-", |i| i.step, "step of the path";
    "iteration", "-", |i| i.iteration, "Newton iteration within the step";
    "residual", "-", |i| i.residual, "largest scaled residual";
    "tilt_deg", "deg", |i| i.angle_deg, "clockwise tilt of the punctured scale";
};

/// Returns the columns of `flexure_path.csv`.
///
/// The column of the work of friction exists only for scales with friction.
pub fn flexure_path_columns(has_friction: bool) -> Vec<Column<flexure::FlexurePoint>> {
    let mut columns = Vec::from(columns! { flexure::FlexurePoint:
        "curvature", "1/t", |p| p.curvature, "curvature of the strip";
        "moment", "E_m I_m/t", |p| p.moment, "bending moment";
        "stiffness", "E_m I_m", |p| p.stiffness,
            "slope of the moment against the curvature on the outgoing branch";
        "end_rotation_deg", "deg", |p| p.end_rotation_deg, "rotation of each end";
        "bending_energy", "E_m t^3", |p| p.bending_energy, "energy that bends the membrane";
        "axial_energy", "E_m t^3", |p| p.axial_energy, "energy that stretches the membrane";
        "contact_energy", "E_m t^3", |p| p.contact_energy, "energy of the contacts";
        name::CONTACTS, "-", |p| p.contacts,
            "number of closed contacts of the strip, rounded to whole gaps";
        "membrane_strain", "-", |p| p.membrane_strain,
            "largest strain at the surface of the membrane";
    });
    if has_friction {
        columns.extend(columns! { flexure::FlexurePoint:
            name::FRICTION_WORK, "E_m t^3", |p| p.friction_work,
                "work dissipated by friction between scales up to this point, for the whole strip";
        });
    }
    columns
}
/// The columns of `flexure_events.csv`.
pub static FLEXURE_EVENTS: &[Column<ContactEvent<flexure::FlexurePoint>>] = &columns! { ContactEvent<flexure::FlexurePoint>:
    "curvature", "1/t", |e| e.point.curvature, "curvature of the strip";
    "moment", "E_m I_m/t", |e| e.point.moment, "bending moment";
    "end_rotation_deg", "deg", |e| e.point.end_rotation_deg, "rotation of each end";
    "gap", "-", |e| e.left_scale, "number of the gap, from 0; empty if all gaps change alike";
    "kind", "-", |e| e.corner_edge.name(), "corner and edge in contact";
    "change", "-", |e| e.change.name(), "change of the contact";
};

/// A scale of a bent strip: index, displacement (`t`) and rotation (radians).
///
/// The index counts from the first (fixed) scale.
pub type BentScale = (usize, [f64; 3]);

/// The columns of `flexure_scales.csv`.
pub static FLEXURE_SCALES: &[Column<BentScale>] = &columns! { BentScale:
    "scale", "-", |s| s.0, "number of the scale; 0 is the first scale, which is fixed";
    "displacement_x", "t", |s| s.1[0], "displacement of the midpoint of the base, to the right";
    "displacement_y", "t", |s| s.1[1], "displacement of the midpoint of the base, upward";
    "rotation_deg", "deg", |s| s.1[2].to_degrees(), "counter-clockwise rotation";
};

/// The columns of `flexure_steps.csv`.
pub static FLEXURE_STEPS: &[Column<Iteration>] = &columns! { Iteration:
    "step", "-", |i| i.step, "step of the path";
    "iteration", "-", |i| i.iteration, "Newton iteration within the step";
    "residual", "-", |i| i.residual, "largest scaled residual";
    "end_rotation_deg", "deg", |i| i.angle_deg, "rotation of each end";
};

//! The columns of the path tables of one design: paths, events, scales and iterations.

use skin::flexure;
use skin::puncture::{
    CriticalEvent, Fold, Instability, LoadedPlace, Puncture, PuncturePoint, ScaleState, Snap,
    TipForces,
};
use skin::{ContactEvent, Iteration};

use super::column::Column;
use super::name;
use crate::design::outcome::Outcome;

/// An equilibrium of a puncture and its instability.
pub type StabilityPoint = (PuncturePoint, Instability);

/// The columns of `path.csv`; those of a guided needle and of scales that rub stand in no other.
pub fn path_columns(is_guided: bool, rubs: bool) -> Vec<Column<StabilityPoint>> {
    let mut columns: Vec<Column<StabilityPoint>> = vec![
        Column::new(
            "displacement",
            "t",
            "downward displacement of the punctured point",
            |(p, _)| p.displacement.into(),
        ),
        Column::new("force", "E_s L t/(1-nu^2)", "puncture force", |(p, _)| p.force.into()),
        Column::new("tilt_deg", "deg", "clockwise tilt of the punctured scale", |(p, _)| {
            p.tilt_deg.into()
        }),
        Column::new(name::CONTACTS, "-", "closed contacts", |(p, _)| p.contacts.into()),
        Column::new(
            "unstable_under_load",
            "-",
            "negative eigenvalues of the stiffness if the load is held, as the path leaves",
            |(_, i)| i.load.into(),
        ),
        Column::new(
            "unstable_under_depth",
            "-",
            "negative eigenvalues of the stiffness if the depth of the punctured point is held",
            |(_, i)| i.depth.into(),
        ),
        Column::new(
            "unstable_under_tilt",
            "-",
            "negative eigenvalues of the stiffness if the tilt of the punctured scale is held",
            |(_, i)| i.tilt.into(),
        ),
        Column::new(
            name::GAP_STRETCH_MIN,
            "-",
            "width of the tightest gap between bases over that at rest",
            |(p, _)| p.gap_stretch.map(|stretch| stretch.min).into(),
        ),
        Column::new(
            name::GAP_STRETCH_MAX,
            "-",
            "width of the widest gap between bases over that at rest",
            |(p, _)| p.gap_stretch.map(|stretch| stretch.max).into(),
        ),
    ];
    if is_guided {
        columns.push(Column::new(
            "lateral_force",
            "E_s L t/(1-nu^2)",
            "force of the guided needle on the scales along the row, to the right",
            |(p, _)| p.lateral_force.into(),
        ));
    }
    if rubs {
        columns.push(Column::new(
            name::FRICTION_WORK,
            "E* t^3",
            "work that friction between scales has taken up to here",
            |(p, _)| p.friction_work.into(),
        ));
    }
    columns
}

/// The columns of `path.csv` for a round tip, one for each scale between the outermost that it comes to touch.
pub fn tip_force_columns(forces: &[TipForces]) -> Vec<Column<usize>> {
    let scales = || forces.iter().flatten().map(|(scale, _)| *scale);
    let (Some(first), Some(last)) = (scales().min(), scales().max()) else { return Vec::new() };
    let column = |scale: i64| {
        let on = |of: &TipForces| of.iter().find(|(touched, _)| *touched == scale).map(|of| of.1);
        // A scale that the tip does not touch bears nothing: that is known, and no empty cell.
        let values: Vec<f64> = forces.iter().map(|of| on(of).unwrap_or(0.0)).collect();
        Column::made(
            format!("tip_force_{scale}").into(),
            "E_s L t/(1-nu^2)",
            "normal force of a round tip on that scale: 0 is the punctured one, -1 its left neighbour",
            move |&row: &usize| values[row].into(),
        )
    };
    (first..=last).map(column).collect()
}

/// An event of a puncture.
pub enum PunctureEvent {
    /// A contact changes its state.
    Contact(ContactEvent<PuncturePoint>),
    /// The row snaps.
    Snap(Snap),
    /// The surface of the substrate folds over in a gap, or unfolds.
    Fold(Fold),
}

impl PunctureEvent {
    /// The events of a puncture, in order.
    pub fn all(puncture: &Puncture) -> Vec<Self> {
        // A path may turn back in force, depth and tilt, so none of them can order the three lists:
        // each fold and snap knows how many contact events came before it.
        let mut snaps = puncture.snaps.iter().peekable();
        let mut folds = puncture.folds.iter().peekable();
        let mut all = Vec::with_capacity(puncture.events.len());
        for count in 0..=puncture.events.len() {
            let is_last = count == puncture.events.len();
            while let Some(fold) = folds.next_if(|fold| is_last || fold.events_before <= count) {
                all.push(Self::Fold(*fold));
            }
            while let Some(snap) = snaps.next_if(|snap| is_last || snap.events_before <= count) {
                all.push(Self::Snap(*snap));
            }
            all.extend(puncture.events.get(count).copied().map(Self::Contact));
        }
        all
    }

    fn point(&self) -> PuncturePoint {
        match self {
            Self::Contact(event) => event.point,
            Self::Snap(snap) => snap.point,
            Self::Fold(fold) => fold.point,
        }
    }

    fn left_scale(&self) -> Option<i64> {
        match self {
            Self::Contact(event) => event.left_scale,
            Self::Snap(_) => None,
            Self::Fold(fold) => Some(fold.left_scale),
        }
    }

    fn right_scale(&self) -> Option<i64> {
        match self {
            Self::Contact(event) => event.right_scale,
            Self::Snap(_) => None,
            Self::Fold(fold) => Some(fold.left_scale + 1),
        }
    }

    fn kind(&self) -> Option<&'static str> {
        match self {
            Self::Contact(event) => Some(event.corner_edge.name()),
            Self::Snap(_) => None,
            Self::Fold(_) => Some("gap"),
        }
    }

    fn change(&self) -> &'static str {
        match self {
            Self::Contact(event) => event.change.name(),
            Self::Snap(_) => "snap",
            Self::Fold(fold) => fold.name(),
        }
    }

    fn drop(&self) -> Option<f64> {
        match self {
            Self::Contact(_) | Self::Fold(_) => None,
            Self::Snap(snap) => snap.drop,
        }
    }
}

/// The columns of `events.csv`.
pub static EVENTS: &[Column<PunctureEvent>] = &[
    Column::new("displacement", "t", "downward displacement of the punctured point", |e| {
        e.point().displacement.into()
    }),
    Column::new("force", "E_s L t/(1-nu^2)", "puncture force", |e| e.point().force.into()),
    Column::new("tilt_deg", "deg", "clockwise tilt of the punctured scale", |e| {
        e.point().tilt_deg.into()
    }),
    Column::new("left_scale", "-", "left scale of the pair, 0 is the punctured one", |e| {
        e.left_scale().into()
    }),
    Column::new("right_scale", "-", "right scale of the pair, nearly always the next one", |e| {
        e.right_scale().into()
    }),
    Column::new("kind", "-", "which corner meets which edge; gap between two bases", |e| {
        e.kind().into()
    }),
    Column::new(
        "change",
        "-",
        "what happens to the contact, or to the surface in the gap; snap where a needle that only goes deeper leaves the path",
        |e| e.change().into(),
    ),
    Column::new(
        "drop",
        "E_s L t/(1-nu^2)",
        "force before a snap less that after it, at the same depth; empty if the path ends before",
        |e| e.drop().into(),
    ),
];

/// The columns of `scales.csv`.
pub static SCALES: &[Column<ScaleState>] = &[
    Column::new("scale", "-", "0 is the punctured scale, positive to the right", |s| {
        s.scale.into()
    }),
    Column::new(
        "displacement_x",
        "t",
        "displacement of the midpoint of the base, to the right",
        |s| s.displacement[0].into(),
    ),
    Column::new("displacement_y", "t", "displacement of the midpoint of the base, upward", |s| {
        s.displacement[1].into()
    }),
    Column::new("rotation_deg", "deg", "counter-clockwise rotation", |s| s.rotation_deg.into()),
    Column::new("reaction", "E_s t^2/(1-nu^2)", "upward reaction of the substrate", |s| {
        s.reaction.into()
    }),
];

/// The columns of `places.csv`.
pub static LOADED_PLACES: &[Column<LoadedPlace>] = &[
    Column::new(
        "place",
        "-",
        "place of the load: 0 the left corner of the top, 1 the right; beyond, a round tip between two scales",
        |p| p.position.into(),
    ),
    Column::new(
        name::CRITICAL_FORCE,
        "E_s L t/(1-nu^2)",
        "puncture force at which the scale is critically tilted, either way, or a guided needle is through",
        |p| p.force.into(),
    ),
    Column::new(name::CRITICAL_DISPLACEMENT, "t", "downward displacement of the load there", |p| {
        p.displacement.into()
    }),
    Column::new("tilt_deg", "deg", "clockwise tilt of the punctured scale there", |p| {
        p.tilt_deg.into()
    }),
    Column::new(name::CRITICAL_EVENT, "-", "which of the two it was, under a guided needle", |p| {
        p.critical_event.map(CriticalEvent::name).into()
    }),
    Column::new(
        "largest_force",
        "E_s L t/(1-nu^2)",
        "largest puncture force of the path; empty where the load tilts nothing from the first step on",
        |p| p.borne.into(),
    ),
    Column::new("status", "-", "complete, or why there is no critical force", |p| {
        Outcome::from(p.status).text().into()
    }),
];

/// The columns of `steps.csv`.
pub static STEPS: &[Column<Iteration>] = &[
    Column::new("step", "-", "step of the path", |i| i.step.into()),
    Column::new("iteration", "-", "Newton iteration within the step", |i| i.iteration.into()),
    Column::new("residual", "-", "largest scaled residual", |i| i.residual.into()),
    Column::new("tilt_deg", "deg", "clockwise tilt of the punctured scale", |i| i.angle_deg.into()),
];

/// The columns of `flexure_path.csv`; that of scales that rub stands in no other.
pub fn flexure_path_columns(rubs: bool) -> Vec<Column<flexure::FlexurePoint>> {
    let mut columns: Vec<Column<flexure::FlexurePoint>> = vec![
        Column::new("curvature", "1/t", "curvature of the strip", |p| p.curvature.into()),
        Column::new("moment", "E_m I_m/t", "bending moment", |p| p.moment.into()),
        Column::new(
            "stiffness",
            "E_m I_m",
            "moment per curvature of the path that goes on from here",
            |p| p.stiffness.into(),
        ),
        Column::new("end_rotation_deg", "deg", "rotation of each end", |p| {
            p.end_rotation_deg.into()
        }),
        Column::new("bending_energy", "E_m t^3", "energy that bends the membrane", |p| {
            p.bending_energy.into()
        }),
        Column::new("axial_energy", "E_m t^3", "energy that stretches the membrane", |p| {
            p.axial_energy.into()
        }),
        Column::new("contact_energy", "E_m t^3", "energy of the contacts", |p| {
            p.contact_energy.into()
        }),
        Column::new(
            name::CONTACTS,
            "-",
            "closed contacts of the strip, rounded to whole gaps",
            |p| p.contacts.into(),
        ),
        Column::new("membrane_strain", "-", "largest strain at the surface of the membrane", |p| {
            p.membrane_strain.into()
        }),
    ];
    if rubs {
        columns.push(Column::new(
            name::FRICTION_WORK,
            "E_m t^3",
            "work that friction between scales has taken up to here, of the whole strip",
            |p| p.friction_work.into(),
        ));
    }
    columns
}
/// The columns of `flexure_events.csv`.
pub static FLEXURE_EVENTS: &[Column<ContactEvent<flexure::FlexurePoint>>] = &[
    Column::new("curvature", "1/t", "curvature of the strip", |e| e.point.curvature.into()),
    Column::new("moment", "E_m I_m/t", "bending moment", |e| e.point.moment.into()),
    Column::new("end_rotation_deg", "deg", "rotation of each end", |e| {
        e.point.end_rotation_deg.into()
    }),
    Column::new("gap", "-", "gap, 0 is the first; empty if every gap does the same", |e| {
        e.left_scale.into()
    }),
    Column::new("kind", "-", "which corner meets which edge", |e| e.corner_edge.name().into()),
    Column::new("change", "-", "what happens to the contact", |e| e.change.name().into()),
];

/// A scale of a bent strip: its place from the first, which is held, and how far it has moved
/// (over `t`) and turned (radians).
pub type BentScale = (usize, [f64; 3]);

/// The columns of `flexure_scales.csv`.
pub static FLEXURE_SCALES: &[Column<BentScale>] = &[
    Column::new("scale", "-", "0 is the first scale, which is held", |s| s.0.into()),
    Column::new(
        "displacement_x",
        "t",
        "displacement of the midpoint of the base, to the right",
        |s| s.1[0].into(),
    ),
    Column::new("displacement_y", "t", "displacement of the midpoint of the base, upward", |s| {
        s.1[1].into()
    }),
    Column::new("rotation_deg", "deg", "counter-clockwise rotation", |s| {
        s.1[2].to_degrees().into()
    }),
];

/// The columns of `flexure_steps.csv`.
pub static FLEXURE_STEPS: &[Column<Iteration>] = &[
    Column::new("step", "-", "step of the path", |i| i.step.into()),
    Column::new("iteration", "-", "Newton iteration within the step", |i| i.iteration.into()),
    Column::new("residual", "-", "largest scaled residual", |i| i.residual.into()),
    Column::new("end_rotation_deg", "deg", "rotation of each end", |i| i.angle_deg.into()),
];

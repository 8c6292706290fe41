//! The measured values of a design, an entry each: a new one is added here, and nowhere else but where it is measured.

use skin::flexure::FlexureMeasures;
use skin::puncture::PunctureMeasures;

use super::cell::Cell;
use super::measured_value::{
    Goal, MeasuredValue, Physical, Place, SampledValue, Shown, TiltValue, Value,
};
use crate::design::design_result::{DesignResult, PunctureResult};
use crate::design::sample_statistics::SampleStatistics;
use crate::quantity::Quantity;

const NONE: &[&str] = &[];
const COVERAGE: &[&str] = &["coverage"];
const FORCE: &[&str] = &["critical_force"];
const DEPTH: &[&str] = &["penetration"];
const BOTH: &[&str] = &["critical_force", "penetration"];
const COMPLIANCE: &[&str] = &["compliance"];

const LARGE: Option<Goal> = Some(Goal::Maximize);
const SMALL: Option<Goal> = Some(Goal::Minimize);

/// The force at which the surface first folds over.
pub const FOLD_FORCE: &str = "fold_force";
/// The stretch of the tightest gap, not above 0 where the surface is folded over.
pub const GAP_STRETCH_MIN: &str = "gap_stretch_min";
/// The stretch of the widest gap.
pub const GAP_STRETCH_MAX: &str = "gap_stretch_max";
/// The largest stiffness on the path.
pub const MAX_STIFFNESS: &str = "max_stiffness";
/// The stiffness of the secant.
pub const SECANT_STIFFNESS: &str = "secant_stiffness";
/// The force that the model can answer for.
pub const SOUND_FORCE: &str = "sound_force";
/// The column of the mass of the scales, which needs no solution.
pub const AREAL_MASS: &str = "areal_mass_kg_m2";

/// Every measured value, in the order of `designs.csv`.
pub(crate) static VALUES: &[MeasuredValue] = &[
    MeasuredValue {
        value: Value::Coverage,
        good: LARGE,
        shown: Shown::First,
        ..other(
            "coverage",
            COVERAGE,
            "share of the thickness that scales fill along a vertical line down from the top right corner of a scale; 0 for upright scales",
            |_| Cell::Empty,
        )
    },
    MeasuredValue {
        physical: &[
            same(Quantity::Force),
            other_thing(
                Quantity::ForcePerWidth,
                "critical_force_per_width",
                "puncture force at the critical tilt, over the width of the scales",
            ),
        ],
        good: LARGE,
        samples: Some(SampledValue { noun: "critical force", statistics: |s| s.critical_force }),
        at_tilts: Some(TiltValue {
            meaning: "puncture force where the tilt, or its tangent the friction, first is that of the name",
            value: |m| m.force,
        }),
        shown: Shown::First,
        ..force("critical_force", Place::End, "puncture force at the critical tilt", |m| {
            &mut m.critical_force
        })
    },
    MeasuredValue {
        tables: DEPTH,
        good: SMALL,
        samples: Some(SampledValue { noun: "penetration", statistics: |s| s.penetration }),
        at_tilts: Some(TiltValue {
            meaning: "depth of the deepest base corner where the tilt, or its tangent, first is that of the name",
            value: |m| m.penetration,
        }),
        shown: Shown::First,
        ..depth(
            "penetration",
            Place::End,
            "depth of the deepest base corner of any scale at the critical tilt",
            |m| &mut m.penetration,
        )
    },
    failed_samples(
        "puncture_samples_failed",
        BOTH,
        "imperfect samples whose puncture has no values, left out of mean and quantiles",
        |s| s.puncture_failed,
    ),
    MeasuredValue {
        shown: Shown::Last,
        ..other("puncture_status", BOTH, "complete, or why the puncture has no values", |r| {
            punctured(r, |p| p.outcome.text())
        })
    },
    MeasuredValue {
        good: LARGE,
        shown: Shown::Then,
        ..force(
            "peak_force",
            Place::Peak,
            "largest puncture force up to the critical tilt, or up to where the path stopped",
            |m| &mut m.peak_force,
        )
    },
    MeasuredValue {
        tables: BOTH,
        at_tilts: Some(TiltValue {
            meaning: "displacement of the punctured point where the tilt, or its tangent, first is that of the name",
            value: |m| m.displacement,
        }),
        ..depth(
            "critical_displacement",
            Place::End,
            "downward displacement of the punctured point at the critical tilt",
            |m| &mut m.critical_displacement,
        )
    },
    MeasuredValue {
        tables: DEPTH,
        good: SMALL,
        ..depth(
            "sink",
            Place::End,
            "depth of the deepest midpoint of a base at the critical tilt",
            |m| &mut m.sink,
        )
    },
    depth(
        "first_contact_displacement",
        Place::Contact,
        "displacement of the punctured point when scales first touch",
        |m| &mut m.first_contact_displacement,
    ),
    MeasuredValue {
        place: Place::End,
        shown: Shown::Then,
        ..other("contacts", BOTH, "closed contacts at the critical tilt", |r| {
            measured(r, |m| m.contacts)
        })
    },
    MeasuredValue {
        place: Place::End,
        good: LARGE,
        ..other(
            "engaged_scales",
            BOTH,
            "scales that touch a neighbour at the critical tilt, the punctured one included",
            |r| measured(r, |m| m.engaged_scales),
        )
    },
    other("scales", BOTH, "scales in the row that was solved", |r| {
        measured(r, |m| (m.scales > 0).then_some(m.scales))
    }),
    stiffness("initial_stiffness", Place::Rest, "puncture stiffness at rest", |m| {
        &mut m.initial_stiffness
    }),
    MeasuredValue {
        shown: Shown::Then,
        ..stiffness(MAX_STIFFNESS, Place::Anywhere, "largest puncture stiffness on the path", |m| {
            &mut m.max_stiffness
        })
    },
    stiffness(
        SECANT_STIFFNESS,
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
    MeasuredValue {
        physical: &[other_thing(
            Quantity::Rigidity,
            "flexural_rigidity",
            "flexural rigidity: largest slope of the moment against the curvature",
        )],
        good: LARGE,
        samples: Some(SampledValue { noun: "flexural compliance", statistics: |s| s.compliance }),
        shown: Shown::First,
        ..bending(
            "compliance",
            "1/(E_m I_m)",
            Place::Anywhere,
            "flexural compliance: 1 over the largest slope of the moment against the curvature",
            |m| &mut m.compliance,
        )
    },
    MeasuredValue {
        shown: Shown::Last,
        ..other("flexure_status", COMPLIANCE, "complete, or why the bending has no values", |r| {
            r.flexure.map(|f| f.outcome.text()).into()
        })
    },
    MeasuredValue {
        physical: &[other_thing(
            Quantity::Rigidity,
            "initial_flexural_rigidity",
            "flexural rigidity at rest",
        )],
        good: LARGE,
        ..bending(
            "initial_compliance",
            "1/(E_m I_m)",
            Place::Rest,
            "flexural compliance at rest",
            |m| &mut m.initial_compliance,
        )
    },
    MeasuredValue {
        shown: Shown::Then,
        ..other(
            "flexure_contact",
            COMPLIANCE,
            "yes or no: whether bending brings scales into contact",
            |r| bent(r, |m| m.contact.map(yes_or_no)),
        )
    },
    MeasuredValue {
        good: LARGE,
        ..bending(
            "first_contact_curvature",
            "1/t",
            Place::Contact,
            "curvature when scales first touch",
            |m| &mut m.first_contact_curvature,
        )
    },
    MeasuredValue {
        physical: &[same(Quantity::Moment)],
        ..bending("max_moment", "E_m I_m/t", Place::Anywhere, "largest moment on the path", |m| {
            &mut m.max_moment
        })
    },
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
        "settings",
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
    MeasuredValue {
        good: SMALL,
        shown: Shown::Then,
        ..bending(
            "membrane_strain_max",
            "-",
            Place::Anywhere,
            "largest strain at the surface of the membrane; above 0.2 its law of small strains is outside its range",
            |m| &mut m.membrane_strain_max,
        )
    },
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
    MeasuredValue {
        place: Place::Anywhere,
        ..other(
            "snaps",
            FORCE,
            "times that the row snaps under a needle that only goes deeper",
            |r| punctured(r, |p| p.measures.snaps),
        )
    },
    MeasuredValue {
        good: LARGE,
        shown: Shown::Then,
        ..number(
            GAP_STRETCH_MIN,
            "-",
            Place::End,
            "width of the tightest gap between bases at the critical tilt over that at rest; not above 0 where the surface is folded over",
            |m| &mut m.gap_stretch_min,
        )
    },
    MeasuredValue {
        good: SMALL,
        shown: Shown::Then,
        ..number(
            GAP_STRETCH_MAX,
            "-",
            Place::End,
            "width of the widest gap between bases at the critical tilt over that at rest",
            |m| &mut m.gap_stretch_max,
        )
    },
    MeasuredValue {
        good: LARGE,
        shown: Shown::Then,
        ..force(
            FOLD_FORCE,
            Place::Fold,
            "puncture force at which the surface first folds over; empty if it does not",
            |m| &mut m.fold_force,
        )
    },
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
    MeasuredValue {
        good: LARGE,
        shown: Shown::First,
        ..force(
            SOUND_FORCE,
            Place::FoldOrEnd,
            "puncture force at the critical tilt or at the first fold, whichever comes first: the largest that the model can answer for",
            |m| &mut m.sound_force,
        )
    },
    MeasuredValue {
        physical: &[other_thing(
            Quantity::Radius,
            "bend_radius",
            "smallest radius to which the skin bends before scales touch",
        )],
        good: LARGE,
        shown: Shown::Then,
        ..bending(
            "contact_curvature",
            "1/t",
            Place::Contact,
            "curvature at which scales touch, wherever the bending ends; empty for a gap that cannot close",
            |m| &mut m.contact_curvature,
        )
    },
    MeasuredValue {
        name: "closing_range",
        unit: "1/t",
        tables: COMPLIANCE,
        value: Value::SamplesAlone,
        samples: Some(SampledValue {
            noun: "curvature from the first contact to that in the last gap that closes,",
            statistics: |s| s.closing_range,
        }),
        ..BLANK
    },
    failed_samples(
        "flexure_samples_failed",
        COMPLIANCE,
        "imperfect samples whose bending has no values, left out of mean and quantiles",
        |s| s.flexure_failed,
    ),
    MeasuredValue {
        name: AREAL_MASS,
        unit: "kg/m^2",
        meaning: "mass of the scales over the area of the skin",
        tables: COVERAGE,
        value: Value::ArealMass,
        good: SMALL,
        ..BLANK
    },
];

/// A value of which nothing is known yet.
const BLANK: MeasuredValue = MeasuredValue {
    name: "",
    unit: "-",
    meaning: "",
    tables: NONE,
    place: Place::Nowhere,
    value: Value::SamplesAlone,
    physical: &[],
    good: None,
    samples: None,
    at_tilts: None,
    shown: Shown::Chosen,
};

type PunctureField = fn(&mut PunctureMeasures) -> &mut Option<f64>;
type FlexureField = fn(&mut FlexureMeasures) -> &mut Option<f64>;

const fn same(quantity: Quantity) -> Physical {
    Physical { quantity, other: None }
}

const fn other_thing(quantity: Quantity, name: &'static str, meaning: &'static str) -> Physical {
    Physical { quantity, other: Some((name, meaning)) }
}

/// A number of a puncture.
const fn number(
    name: &'static str,
    unit: &'static str,
    place: Place,
    meaning: &'static str,
    field: PunctureField,
) -> MeasuredValue {
    MeasuredValue {
        name,
        unit,
        meaning,
        tables: FORCE,
        place,
        value: Value::Puncture(field),
        ..BLANK
    }
}

const fn force(
    name: &'static str,
    place: Place,
    meaning: &'static str,
    field: PunctureField,
) -> MeasuredValue {
    const IN_NEWTON: &[Physical] = &[same(Quantity::Force)];
    MeasuredValue { physical: IN_NEWTON, ..number(name, "E_s L t/(1-nu^2)", place, meaning, field) }
}

const fn depth(
    name: &'static str,
    place: Place,
    meaning: &'static str,
    field: PunctureField,
) -> MeasuredValue {
    const IN_MM: &[Physical] = &[same(Quantity::Length)];
    MeasuredValue { physical: IN_MM, ..number(name, "t", place, meaning, field) }
}

const fn stiffness(
    name: &'static str,
    place: Place,
    meaning: &'static str,
    field: PunctureField,
) -> MeasuredValue {
    const PER_MM: &[Physical] = &[same(Quantity::Stiffness)];
    MeasuredValue { physical: PER_MM, ..number(name, "E_s t", place, meaning, field) }
}

/// A number of bending.
const fn bending(
    name: &'static str,
    unit: &'static str,
    place: Place,
    meaning: &'static str,
    field: FlexureField,
) -> MeasuredValue {
    MeasuredValue {
        name,
        unit,
        meaning,
        tables: COMPLIANCE,
        place,
        value: Value::Flexure(field),
        ..BLANK
    }
}

/// A count, a text, or a number without derivatives.
const fn other(
    name: &'static str,
    tables: &'static [&'static str],
    meaning: &'static str,
    cell: fn(&DesignResult) -> Cell,
) -> MeasuredValue {
    MeasuredValue { name, meaning, tables, value: Value::Other(cell), ..BLANK }
}

const fn failed_samples(
    name: &'static str,
    tables: &'static [&'static str],
    meaning: &'static str,
    count: fn(&SampleStatistics) -> Option<usize>,
) -> MeasuredValue {
    MeasuredValue { name, meaning, tables, value: Value::Samples(count), ..BLANK }
}

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

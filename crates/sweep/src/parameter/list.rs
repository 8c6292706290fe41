//! The one list of parameters: it drives validation, messages, axes, columns and documentation.

use skin::Base;
use skin::flexure::{MembraneMesh, Method};
use skin::puncture::{Needle, NumberList, RowLength};
use substrate::{Coupling, SubstrateLaw};

use crate::case::Case;
use crate::parameter::Bound::{Excluded, Included};
use crate::parameter::ParameterKind::{
    Count, CountOrWord, Number, Numbers, OptionalNumber, SignedNumber, Word,
};
use crate::parameter::Role::{
    Continuous, EndsBending, EndsPuncture, Geometry, InMm, InsteadOf, Made, MovesSprings,
    Scattered, UnitOfBending,
};
use crate::parameter::{CountRange, Parameter, Range, Role, Scalar, key};

// Beyond these ranges differences of lengths and of stiffnesses are round-off, and what a path does is that of its digits.
const LENGTH: Range = Range::closed(1e-3, 1e3);
const POSITIVE: Range = Range::closed(1e-6, 1e9);
// A length in mm is held to bounds where it is divided by the thickness.
const ANY: Range = Range::closed(-1e9, 1e9);
pub(super) const FRACTION: Range = Range { low: Excluded(0.0), high: Included(1.0) };
// Scales are rigid but where they touch: softer than what they stand on they would bend.
const STIFF: Range = Range::closed(1.0, 1e9);

/// The word of a count that is to be found.
const AUTO: &str = "auto";

/// The roles of a number that describes the skin and its load, and no more.
const NUMBER: &[Role] = &[Continuous, Made];

/// A length in mm beside the same over the thickness, which follows from it.
macro_rules! in_mm {
    ($stem:literal, $section:literal, $range:expr, $roles:expr, $field:expr) => {
        Parameter {
            key: concat!($stem, "_mm"),
            section: $section,
            unit: "mm",
            meaning: concat!(
                $stem,
                "_over_t in mm, instead of that; with thickness_mm in [material]"
            ),
            roles: $roles,
            kind: OptionalNumber { range: $range, field: $field },
        }
    };
}

/// Every parameter, in the order of the documentation. Keys are unique over all sections, because
/// an axis is named by its key alone.
pub static PARAMETERS: &[Parameter] = &[
    Parameter {
        key: key::GAP,
        section: "designs",
        unit: "t",
        meaning: "gap d between neighbouring bases",
        roles: &[Geometry, Continuous, Made, Scattered, MovesSprings],
        kind: Number { range: LENGTH, field: |c| &mut c.design.gap },
    },
    in_mm!("gap", "designs", POSITIVE, &[InMm(key::GAP), Made, Scattered, MovesSprings], |c| {
        &mut c.in_mm.gap
    }),
    Parameter {
        key: key::LENGTH,
        section: "designs",
        unit: "t",
        meaning: "length L of a scale",
        roles: &[Geometry, Continuous, Made, MovesSprings],
        kind: Number { range: LENGTH, field: |c| &mut c.design.length },
    },
    in_mm!("length", "designs", POSITIVE, &[InMm(key::LENGTH), Made, MovesSprings], |c| &mut c
        .in_mm
        .length),
    Parameter {
        key: key::PITCH,
        section: "designs",
        unit: "mm",
        meaning: "base and gap of a scale in mm, instead of its gap or, beside a gap, of its length; with thickness_mm in [material]",
        roles: &[InMm(key::GAP), Made, MovesSprings],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.in_mm.pitch },
    },
    Parameter {
        key: key::SLANT,
        section: "designs",
        unit: "deg",
        meaning: "slant of the scales from the vertical, to the right",
        roles: &[Geometry, Continuous, Made, Scattered],
        kind: Number {
            range: Range { low: Included(0.0), high: Excluded(90.0) },
            field: |c| &mut c.design.slant_deg,
        },
    },
    Parameter {
        key: "base",
        section: "scale",
        unit: "-",
        meaning: "length of the base of a scale, L or 2L",
        roles: &[MovesSprings],
        kind: Word {
            words: &["L", "2L"],
            get: |c| usize::from(c.design.base == Base::TwoL),
            set: |c, word| c.design.base = [Base::L, Base::TwoL][word],
        },
    },
    Parameter {
        key: key::WIDTH,
        section: "scale",
        unit: "t",
        meaning: "out-of-plane width b of the scales",
        roles: &[Continuous, Made, MovesSprings],
        kind: Number { range: LENGTH, field: |c| &mut c.design.width },
    },
    in_mm!("width", "scale", POSITIVE, &[InMm(key::WIDTH), Made, MovesSprings], |c| &mut c
        .in_mm
        .width),
    Parameter {
        key: key::POISSON_RATIO,
        section: "substrate",
        unit: "-",
        meaning: "Poisson's ratio of the substrate",
        roles: &[Continuous, Made, MovesSprings],
        kind: Number { range: Range::closed(0.0, 0.5), field: |c| &mut c.puncture.poisson_ratio },
    },
    Parameter {
        key: key::TISSUE,
        section: "substrate",
        unit: "t",
        meaning: "thickness of the substrate on a rigid base, as of tissue on bone; of a half-space unless it is given",
        roles: &[Continuous, Made, MovesSprings],
        kind: OptionalNumber { range: LENGTH, field: |c| &mut c.tissue_thickness },
    },
    in_mm!(
        "tissue_thickness",
        "substrate",
        POSITIVE,
        &[InMm(key::TISSUE), Made, MovesSprings],
        |c| &mut c.in_mm.tissue_thickness
    ),
    Parameter {
        key: "coupling",
        section: "substrate",
        unit: "-",
        meaning: "neighbours that the substrate couples a scale with, the nearest or all that matter",
        roles: &[MovesSprings],
        kind: Word {
            words: &["nearest", "full"],
            get: |c| usize::from(c.coupling == Coupling::Full),
            set: |c, word| c.coupling = [Coupling::Nearest, Coupling::Full][word],
        },
    },
    Parameter {
        key: "law",
        section: "substrate",
        unit: "-",
        meaning: "how the substrate answers where the gap between two bases is stretched or pressed: by linear springs, or as rubber, which cannot fold over",
        roles: &[],
        kind: Word {
            words: &["linear", "neo-hookean"],
            get: |c| usize::from(c.puncture.substrate_law == SubstrateLaw::NeoHookean),
            set: |c, word| {
                c.puncture.substrate_law = [SubstrateLaw::Linear, SubstrateLaw::NeoHookean][word];
            },
        },
    },
    Parameter {
        key: "c1",
        section: "contact",
        unit: "-",
        meaning: "prefactor C1 of the contact law",
        roles: NUMBER,
        kind: Number { range: Range::closed(1e-3, 1e3), field: |c| &mut c.common.law.c1 },
    },
    Parameter {
        key: "c2",
        section: "contact",
        unit: "-",
        meaning: "exponent C2 of the contact law",
        roles: NUMBER,
        kind: Number {
            // A flat end has an exponent of 1, a sphere of 1.5; at larger ones contacts begin without any stiffness.
            range: Range::closed(0.05, 1.5),
            field: |c| &mut c.common.law.c2,
        },
    },
    Parameter {
        key: key::FRICTION,
        section: "contact",
        unit: "-",
        meaning: "coefficient of friction between two scales",
        roles: NUMBER,
        kind: Number {
            // Rubber on a rough surface has about 2.
            range: Range::closed(0.0, 2.0),
            field: |c| &mut c.common.friction,
        },
    },
    Parameter {
        key: "scales",
        section: "puncture",
        unit: "-",
        meaning: "scales in the row",
        roles: &[],
        kind: CountOrWord {
            word: AUTO,
            range: CountRange { low: 1, high: 1_000_000 },
            get: |c| match c.puncture.scales {
                RowLength::Auto => None,
                RowLength::Scales(count) => Some(count),
            },
            set: |c, count| {
                c.puncture.scales = count.map_or(RowLength::Auto, RowLength::Scales);
            },
        },
    },
    Parameter {
        key: key::LOAD_POSITION,
        section: "puncture",
        unit: "-",
        meaning: "place of the load on the top of the punctured scale, 0 its left corner, 1 its right",
        roles: NUMBER,
        kind: Number { range: Range::closed(0.0, 1.0), field: |c| &mut c.puncture.load_position },
    },
    Parameter {
        key: key::LOAD_INSET,
        section: "puncture",
        unit: "t",
        meaning: "distance of the load from the right corner of the top, inward as far as the middle; instead of load_position",
        roles: &[InsteadOf(key::LOAD_POSITION)],
        kind: OptionalNumber { range: Range::closed(0.0, 1e6), field: |c| &mut c.load_inset },
    },
    in_mm!("load_inset", "puncture", ANY, &[InMm(key::LOAD_INSET)], |c| &mut c.in_mm.load_inset),
    Parameter {
        key: key::NEEDLE,
        section: "puncture",
        unit: "-",
        meaning: "free: a load that follows its point of the scale sideways, as in the paper; guided: a tip that moves straight down and slides on the scale",
        roles: &[EndsPuncture],
        kind: Word {
            words: &["free", "guided"],
            get: |c| usize::from(c.puncture.needle.is_guided()),
            set: |c, word| {
                c.puncture.needle = [Needle::Free, Needle::Guided { friction: 0.0 }][word];
                settle_needle(c);
            },
        },
    },
    Parameter {
        key: key::NEEDLE_RADIUS,
        section: "puncture",
        unit: "t",
        meaning: "radius of the round tip of a guided needle without friction, which may touch several scales; sharp unless it is given",
        roles: NUMBER,
        kind: OptionalNumber { range: LENGTH, field: |c| &mut c.puncture.needle_radius },
    },
    in_mm!("needle_radius", "puncture", POSITIVE, &[InMm(key::NEEDLE_RADIUS), Made], |c| &mut c
        .in_mm
        .needle_radius),
    Parameter {
        key: key::UNLOAD,
        section: "puncture",
        unit: "-",
        meaning: "whether the load is taken away again at the end of the puncture",
        roles: &[],
        kind: Word {
            words: &["false", "true"],
            get: |c| usize::from(c.puncture.unload),
            set: |c, word| c.puncture.unload = word == 1,
        },
    },
    Parameter {
        key: key::CRITICAL_TILT,
        section: "puncture",
        unit: "deg",
        meaning: "tilt of the punctured scale at which the puncture ends; of several the largest, with columns for each",
        roles: &[Continuous, EndsPuncture],
        kind: Numbers {
            // Below 1e-14 the path to it drowns in round-off.
            range: Range { low: Included(1e-9), high: Excluded(90.0) },
            word: None,
            get: |c| match c.puncture.tilts_deg {
                tilts if tilts.is_empty() => Scalar::Number(c.puncture.critical_tilt_deg),
                tilts => Scalar::List(tilts),
            },
            set: |c, tilts| {
                c.critical_tilt = tilts;
                settle_needle(c);
            },
        },
    },
    Parameter {
        key: key::NEEDLE_FRICTION,
        section: "puncture",
        unit: "-",
        meaning: "friction between needle and scale; of a free needle its arctangent is the critical tilt, instead of that, of a guided one both may be given",
        roles: &[Continuous, EndsPuncture, InsteadOf(key::CRITICAL_TILT)],
        kind: Numbers {
            // Of 1000 the arctangent is 89.94°; of 1e16 it is 90°, to the last digit.
            range: Range::closed(0.0, 1e3),
            word: Some("none"),
            get: |c| c.needle_friction.unwrap_or(Scalar::Word("none")),
            set: |c, friction| {
                c.needle_friction = Some(friction).filter(|f| !matches!(f, Scalar::Word(_)));
                settle_needle(c);
            },
        },
    },
    Parameter {
        key: key::DEPTH,
        section: "puncture",
        unit: "t",
        meaning: "depth of the punctured point at which the force is measured besides, in force_at_depth",
        roles: &[],
        kind: OptionalNumber { range: LENGTH, field: |c| &mut c.puncture.depth },
    },
    in_mm!("depth", "puncture", POSITIVE, &[InMm(key::DEPTH)], |c| &mut c.in_mm.depth),
    Parameter {
        key: key::PLACES,
        section: "puncture",
        unit: "-",
        meaning: "places of the load that are tried besides, from the left corner of the top to the right, for weakest_force",
        roles: &[],
        kind: CountOrWord {
            word: "none",
            range: CountRange { low: 2, high: 1000 },
            get: |c| c.puncture.places,
            set: |c, count| c.puncture.places = count,
        },
    },
    Parameter {
        key: key::CONTACT_OVER_SUBSTRATE,
        section: "puncture",
        unit: "-",
        meaning: "modulus of the scales in contact, E_ct, over that of the substrate, E_s",
        roles: NUMBER,
        kind: Number { range: STIFF, field: |c| &mut c.puncture.contact_modulus_over_substrate },
    },
    Parameter {
        key: "method",
        section: "flexure",
        unit: "-",
        meaning: "what is bent: one gap, since all deform alike, or the chain of all",
        roles: &[],
        kind: Word {
            words: &["unit-cell", "chain"],
            get: |c| usize::from(c.flexure.method == Method::Chain),
            set: |c, word| c.flexure.method = [Method::UnitCell, Method::Chain][word],
        },
    },
    Parameter {
        key: key::MEMBRANE_LENGTH,
        section: "flexure",
        unit: "t",
        meaning: "length of the membrane; a chain and imperfect strips round it to whole gaps",
        roles: &[Continuous, Made, EndsBending],
        kind: Number { range: LENGTH, field: |c| &mut c.flexure.membrane_length },
    },
    in_mm!(
        "membrane_length",
        "flexure",
        POSITIVE,
        &[InMm(key::MEMBRANE_LENGTH), Made, EndsBending],
        |c| &mut c.in_mm.membrane_length
    ),
    Parameter {
        key: "gaps",
        section: "flexure",
        unit: "-",
        meaning: "gaps of the strip, the same number for every design, instead of a length",
        roles: &[InsteadOf(key::MEMBRANE_LENGTH)],
        kind: CountOrWord {
            word: AUTO,
            range: CountRange { low: 1, high: 1_000_000 },
            get: |c| c.flexure.gaps,
            set: |c, count| c.flexure.gaps = count,
        },
    },
    Parameter {
        key: key::MEMBRANE_THICKNESS,
        section: "flexure",
        unit: "t",
        meaning: "thickness h of the membrane",
        roles: &[Continuous, Made, UnitOfBending],
        kind: Number { range: LENGTH, field: |c| &mut c.flexure.membrane_thickness },
    },
    in_mm!(
        "membrane_thickness",
        "flexure",
        POSITIVE,
        &[InMm(key::MEMBRANE_THICKNESS), Made, UnitOfBending],
        |c| &mut c.in_mm.membrane_thickness
    ),
    Parameter {
        key: key::MEMBRANE_AXIS,
        section: "flexure",
        unit: "t",
        meaning: "depth of the axis of the membrane below the bases of the scales",
        roles: NUMBER,
        kind: Number {
            range: Range::closed(-1e3, 1e3),
            field: |c| &mut c.flexure.membrane_axis_offset,
        },
    },
    in_mm!("membrane_axis_offset", "flexure", ANY, &[InMm(key::MEMBRANE_AXIS), Made], |c| &mut c
        .in_mm
        .membrane_axis_offset),
    Parameter {
        key: "elements_per_gap",
        section: "flexure",
        unit: "-",
        meaning: "beam elements of the membrane between two scales, or as fine as the measures need",
        roles: &[],
        kind: CountOrWord {
            word: AUTO,
            range: CountRange { low: 1, high: 1000 },
            get: |c| match c.flexure.elements_per_gap {
                MembraneMesh::Auto => None,
                MembraneMesh::Elements(count) => Some(count),
            },
            set: |c, count| {
                c.flexure.elements_per_gap =
                    count.map_or(MembraneMesh::Auto, MembraneMesh::Elements);
            },
        },
    },
    Parameter {
        key: key::UNBEND,
        section: "flexure",
        unit: "-",
        meaning: "whether the moment is taken away again at the end of bending",
        roles: &[],
        kind: Word {
            words: &["false", "true"],
            get: |c| usize::from(c.flexure.unload),
            set: |c, word| c.flexure.unload = word == 1,
        },
    },
    Parameter {
        key: "max_end_rotation_deg",
        section: "flexure",
        unit: "deg",
        meaning: "rotation of each end at which bending ends; below zero, bending the other way, scales outside",
        roles: &[Continuous, Made, EndsBending],
        kind: SignedNumber {
            size: Range { low: Excluded(0.0), high: Included(180.0) },
            field: |c| &mut c.flexure.max_end_rotation_deg,
        },
    },
    Parameter {
        key: key::CONTACT_OVER_MEMBRANE,
        section: "flexure",
        unit: "-",
        meaning: "modulus of the scales in contact, E_ct, over that of the membrane, E_m",
        roles: NUMBER,
        kind: Number { range: STIFF, field: |c| &mut c.flexure.contact_modulus_over_membrane },
    },
    Parameter {
        key: "gap_cv",
        section: "imperfection",
        unit: "-",
        meaning: "coefficient of variation of the gaps of imperfect rows",
        roles: &[],
        kind: Number { range: Range::closed(0.0, 1.0), field: |c| &mut c.imperfection.gap_cv },
    },
    Parameter {
        key: "slant_sd_deg",
        section: "imperfection",
        unit: "deg",
        meaning: "standard deviation of the slants of imperfect rows",
        roles: &[],
        kind: Number {
            range: Range::closed(0.0, 30.0),
            field: |c| &mut c.imperfection.slant_sd_deg,
        },
    },
    Parameter {
        key: "samples",
        section: "imperfection",
        unit: "-",
        meaning: "imperfect rows that are solved, if gaps or slants scatter",
        roles: &[],
        kind: Count {
            range: CountRange { low: 1, high: 1_000_000 },
            field: |c| &mut c.samples.count,
        },
    },
    Parameter {
        key: "seed",
        section: "imperfection",
        unit: "-",
        meaning: "seed of the random gaps and slants",
        roles: &[],
        kind: Count {
            range: CountRange { low: 0, high: 1_000_000_000 },
            field: |c| &mut c.samples.seed,
        },
    },
    Parameter {
        key: "first_step",
        section: "solver",
        unit: "-",
        meaning: "first step, as a fraction of the whole path",
        roles: &[],
        kind: Number { range: FRACTION, field: |c| &mut c.common.solver.first_step },
    },
    Parameter {
        key: "max_step",
        section: "solver",
        unit: "-",
        meaning: "largest step, as a fraction of the whole path",
        roles: &[],
        kind: Number { range: FRACTION, field: |c| &mut c.common.solver.max_step },
    },
    Parameter {
        key: "min_step",
        section: "solver",
        unit: "-",
        meaning: "smallest step, as a fraction of the whole path, below which the path stops",
        roles: &[],
        kind: Number { range: FRACTION, field: |c| &mut c.common.solver.min_step },
    },
    Parameter {
        key: "tolerance",
        section: "solver",
        unit: "-",
        meaning: "largest scaled residual of an equilibrium",
        roles: &[],
        kind: Number {
            range: Range { low: Excluded(0.0), high: Included(0.01) },
            field: |c| &mut c.common.solver.tolerance,
        },
    },
    Parameter {
        key: "max_iterations",
        section: "solver",
        unit: "-",
        meaning: "Newton iterations after which a step is cut to a third",
        roles: &[],
        kind: Count {
            range: CountRange { low: 1, high: 1000 },
            field: |c| &mut c.common.solver.max_iterations,
        },
    },
    Parameter {
        key: "max_points",
        section: "solver",
        unit: "-",
        meaning: "equilibria after which the path stops",
        roles: &[],
        kind: Count {
            range: CountRange { low: 2, high: 1_000_000_000 },
            field: |c| &mut c.common.solver.max_points,
        },
    },
    Parameter {
        key: key::THICKNESS,
        section: "material",
        unit: "mm",
        meaning: "thickness t of the scales",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.thickness_mm },
    },
    Parameter {
        key: key::SUBSTRATE_MODULUS,
        section: "material",
        unit: "MPa",
        meaning: "modulus E_s of the substrate",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.substrate_modulus_mpa },
    },
    Parameter {
        key: key::MEMBRANE_MODULUS,
        section: "material",
        unit: "MPa",
        meaning: "modulus E_m of the membrane",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.membrane_modulus_mpa },
    },
    Parameter {
        key: key::SCALE_MODULUS,
        section: "material",
        unit: "MPa",
        meaning: "modulus E_ct of the scales in contact, in the place of its ratios to the other two",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.scale_modulus_mpa },
    },
    Parameter {
        key: key::DENSITY,
        section: "material",
        unit: "kg/m^3",
        meaning: "density of the scales",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.scale_density_kg_m3 },
    },
];

/// Makes tilts and friction of a puncture what the case says of them, in whatever order it was said.
fn settle_needle(case: &mut Case) {
    let friction = case.needle_friction;
    if let Needle::Guided { friction: of_needle } = &mut case.puncture.needle {
        *of_needle = friction.and_then(Scalar::number).unwrap_or(0.0);
        return set_tilts(case, case.critical_tilt, |tilt| tilt);
    }
    match friction {
        Some(friction) => set_tilts(case, friction, |friction| friction.atan().to_degrees()),
        None => set_tilts(case, case.critical_tilt, |tilt| tilt),
    }
}

/// Sets the tilt at which a puncture ends, and those on the way, to what is made of a number or a list; a word leaves them.
fn set_tilts(case: &mut Case, value: Scalar, tilt: fn(f64) -> f64) {
    let tilts = match value {
        Scalar::Number(number) => {
            case.puncture.critical_tilt_deg = tilt(number);
            NumberList::default()
        }
        Scalar::List(numbers) => numbers.map(tilt),
        Scalar::Count(_) | Scalar::Word(_) => return,
    };
    case.puncture.critical_tilt_deg = tilts.last().unwrap_or(case.puncture.critical_tilt_deg);
    case.puncture.tilts_deg = tilts;
}

//! The list of all parameters of definitions.
//!
//! Validation, messages, axes, columns, schemas and documentation use this list.
//!
//! To add a parameter:
//!
//! 1. Add a field with its default to [`Case`] or to the parameters of `skin` in it, for example
//!    [`skin::puncture::PunctureParameters`].
//! 2. Add an entry to [`PARAMETERS`] in its section: key, unit, roles (`Role`), kind with range and
//!    field, meaning. A key that other code refers to is a constant in `key.rs`.
//! 3. If it excludes or requires other parameters, add a check to `wrong_together` in
//!    `definition/reader.rs`. A length in mm gets a second entry with [`InMm`] and a field in
//!    `Millimetres`.
//! 4. Add the key with its default to `sweeps/paper.toml`, and regenerate the signatures of the
//!    Python package (`python -m squama._manual`).
//!
//! Tests enforce steps 2 and 4: `roles_agree_with_each_other` in `role.rs`, the snapshots of
//! `tests/sweep`, `the_paper_sweep_lists_every_key_with_its_default` in `apps/report`, and the test
//! of the signatures in `apps/python`.

use skin::Base;
use skin::flexure::{MembraneMesh, Method};
use skin::puncture::{Bending, Needle, NumberList, RowLength};
use substrate::{Coupling, SubstrateLaw};

use crate::case::{Case, set_tilts};
use crate::parameter::Bound::{Excluded, Included};
use crate::parameter::ParameterKind::{
    Count, CountOrWord, Number, Numbers, OptionalNumber, SignedNumber, Word,
};
use crate::parameter::Role::{
    Continuous, EndsBending, EndsPuncture, Geometry, InMm, InsteadOf, MovesSprings, Scattered,
    Toleranced, UnitOfBending,
};
use crate::parameter::{CountRange, Parameter, ParameterKind, Range, key};
use crate::scalar::Scalar;

// Beyond these ranges, differences of lengths and stiffnesses are dominated by round-off.
const LENGTH: Range = Range::closed(1e-3, 1e3);
const POSITIVE: Range = Range::closed(1e-6, 1e9);
// The bounds of a length in mm apply after the division by the thickness.
const ANY: Range = Range::closed(-1e9, 1e9);
pub(super) const FRACTION: Range = Range { low: Excluded(0.0), high: Included(1.0) };
// The model has rigid scales, which is invalid for scales softer than their substrate.
const STIFF: Range = Range::closed(1.0, 1e9);

/// Word instead of a count that squama determines.
const AUTO: &str = "auto";

type Field<T> = fn(&mut Case) -> &mut T;

// The constructors of kinds are `const`, because the list of parameters is a static.
const fn number(range: Range, field: Field<f64>) -> ParameterKind {
    Number { range, field }
}

const fn optional(range: Range, field: Field<Option<f64>>) -> ParameterKind {
    OptionalNumber { range, field }
}

const fn count(low: usize, high: usize, field: Field<usize>) -> ParameterKind {
    Count { range: CountRange { low, high }, field }
}

const fn count_or(
    word: &'static str,
    low: usize,
    high: usize,
    get: fn(&Case) -> Option<usize>,
    set: fn(&mut Case, Option<usize>),
) -> ParameterKind {
    CountOrWord { range: CountRange { low, high }, word, get, set }
}

/// Builds the kind of a parameter with a few words as values.
macro_rules! words {
    ($($field:ident).+: $($word:literal = $value:expr),+) => {
        Word {
            words: &[$($word),+],
            get: |case| {
                [$($value),+].iter().position(|value| *value == case.$($field).+).unwrap_or(0)
            },
            set: |case, word| case.$($field).+ = [$($value),+][word],
        }
    };
}

/// Builds the meaning of a length in mm.
macro_rules! in_mm {
    ($stem:literal, $what:literal) => {
        concat!($what, ", instead of ", $stem, "_over_t; with thickness_mm in [material]")
    };
}

/// Builds the list of parameters by section.
///
/// Each entry: key, unit, roles, kind, meaning.
macro_rules! parameters {
    ($($section:literal {
        $($key:expr, $unit:literal, [$($role:expr),*], $kind:expr, $meaning:expr;)*
    })*) => {
        &[$($(Parameter {
            key: $key,
            section: $section,
            unit: $unit,
            meaning: $meaning,
            roles: &[$($role),*],
            kind: $kind,
        },)*)*]
    };
}

/// Every parameter, in the order of the documentation.
///
/// Keys are unique over all sections, because an axis is named by its key alone.
pub static PARAMETERS: &[Parameter] = parameters! {
    "designs" {
        key::GAP, "t", [Geometry, Continuous, Toleranced, Scattered, MovesSprings],
            number(LENGTH, |c| &mut c.design.gap), "gap d between neighbouring bases";
        "gap_mm", "mm", [InMm(key::GAP), Toleranced, Scattered, MovesSprings],
            optional(POSITIVE, |c| &mut c.in_mm.gap), in_mm!("gap", "gap between neighbouring bases");
        key::LENGTH, "t", [Geometry, Continuous, Toleranced, MovesSprings],
            number(LENGTH, |c| &mut c.design.length), "length L of a scale";
        "length_mm", "mm", [InMm(key::LENGTH), Toleranced, MovesSprings],
            optional(POSITIVE, |c| &mut c.in_mm.length), in_mm!("length", "length of a scale");
        key::PITCH, "mm", [InMm(key::GAP), Toleranced, MovesSprings],
            optional(POSITIVE, |c| &mut c.in_mm.pitch),
            "base plus gap in mm, instead of the gap or, in addition to a gap, instead of the length; with thickness_mm in [material]";
        key::SLANT, "deg", [Geometry, Continuous, Toleranced, Scattered],
            number(Range { low: Included(0.0), high: Excluded(90.0) }, |c| &mut c.design.slant_deg),
            "slant of the scales from the vertical, to the right";
    }

    "scale" {
        "base", "-", [MovesSprings],
            words!(design.base: "L" = Base::L, "2L" = Base::TwoL),
            "length of the base of a scale, L or 2L";
        key::WIDTH, "t", [Continuous, Toleranced, MovesSprings],
            number(LENGTH, |c| &mut c.design.width), "out-of-plane width b of the scales";
        "width_mm", "mm", [InMm(key::WIDTH), Toleranced, MovesSprings],
            optional(POSITIVE, |c| &mut c.in_mm.width), in_mm!("width", "out-of-plane width of the scales");
        key::BENDING, "-", [],
            words!(puncture.bending: "rigid" = Bending::Rigid, "elastic" = Bending::Elastic),
            "rigid scales, or elastic ones, which bend in the puncture as beams of modulus E_ct";
    }

    "substrate" {
        key::POISSON_RATIO, "-", [Continuous, Toleranced, MovesSprings],
            number(Range::closed(0.0, 0.5), |c| &mut c.puncture.poisson_ratio),
            "Poisson's ratio of the substrate";
        key::TISSUE, "t", [Continuous, Toleranced, MovesSprings],
            optional(LENGTH, |c| &mut c.tissue_thickness),
            "thickness of the substrate on a rigid base, such as tissue on bone; a half-space unless given";
        key::TISSUE_MM, "mm", [InMm(key::TISSUE), Toleranced, MovesSprings],
            optional(POSITIVE, |c| &mut c.in_mm.tissue_thickness),
            in_mm!("tissue_thickness", "thickness of the tissue on a rigid base");
        "coupling", "-", [MovesSprings],
            words!(coupling: "nearest" = Coupling::Nearest, "full" = Coupling::Full),
            "neighbours coupled to a scale by the substrate: the nearest, or all with a relevant effect";
        "law", "-", [],
            words!(puncture.substrate_law: "linear" = SubstrateLaw::Linear, "neo-hookean" = SubstrateLaw::NeoHookean),
            "response of the substrate in the gap between two bases: linear springs, or rubber, which cannot fold over";
    }

    "body" {
        key::CURVATURE, "1/t", [Continuous, Toleranced],
            number(Range::closed(-1.0, 1.0), |c| &mut c.puncture.curvature),
            "curvature 1/R of the body below the skin: positive for a convex body, such as a finger, negative for a concave one";
        key::RADIUS, "t", [Continuous, Toleranced, InsteadOf(key::CURVATURE)],
            optional(ANY, |c| &mut c.body_radius),
            "radius R of the body below the skin, instead of the curvature; negative for a concave body";
        key::RADIUS_MM, "mm", [InMm(key::RADIUS), Toleranced],
            optional(ANY, |c| &mut c.in_mm.radius),
            in_mm!("radius", "radius of the body below the skin");
        key::RADIUS_TO, "t", [Continuous, Toleranced],
            optional(ANY, |c| &mut c.body_radius_to),
            "other end of the range of radii over which worst_force_between is the smallest force; negative for a concave body";
        key::RADIUS_TO_MM, "mm", [InMm(key::RADIUS_TO), Toleranced],
            optional(ANY, |c| &mut c.in_mm.radius_to),
            in_mm!("radius_to", "other end of the range of radii");
    }

    "contact" {
        "c1", "-", [Continuous, Toleranced],
            number(Range::closed(1e-3, 1e3), |c| &mut c.common.law.c1), "prefactor C1 of the contact law";
        // The exponent of a flat punch is 1. The upper bound is the exponent of a sphere (Hertz).
        "c2", "-", [Continuous, Toleranced],
            number(Range::closed(0.05, 1.5), |c| &mut c.common.law.c2), "exponent C2 of the contact law";
        // The upper bound is about the friction of rubber on a rough surface.
        key::FRICTION, "-", [Continuous, Toleranced],
            number(Range::closed(0.0, 2.0), |c| &mut c.common.friction),
            "coefficient of friction between two scales";
    }

    "puncture" {
        "scales", "-", [],
            count_or(AUTO, 1, 1_000_000,
                |c| match c.puncture.scales {
                    RowLength::Auto => None,
                    RowLength::Scales(count) => Some(count),
                },
                |c, count| c.puncture.scales = count.map_or(RowLength::Auto, RowLength::Scales)),
            "number of scales in the row";
        // The largest position beyond 1 depends on gap and tip: `has_valid_load_position` checks
        // the tip, and `punctured` limits the position to the next scale.
        key::LOAD_POSITION, "-", [Continuous, Toleranced],
            number(Range::closed(0.0, 1e6), |c| &mut c.puncture.load_position),
            "load position on the top of the punctured scale: 0 the left corner, 1 the right; for a round tip up to 1 + gap/base, the left corner of the next scale";
        key::LOAD_INSET, "t", [Continuous, Toleranced, InsteadOf(key::LOAD_POSITION)],
            optional(Range::closed(0.0, 1e6), |c| &mut c.load_inset),
            "distance of the load from the right corner of the top, inward, at most to the middle; instead of load_position";
        "load_inset_mm", "mm", [InMm(key::LOAD_INSET), Toleranced],
            optional(ANY, |c| &mut c.in_mm.load_inset),
            in_mm!("load_inset", "distance of the load from the right corner of the top");
        key::NEEDLE, "-", [EndsPuncture],
            Word {
                words: &["free", "guided"],
                get: |c| usize::from(c.puncture.needle.is_guided()),
                // The field `needle_friction` of the case replaces this friction of 0.
                set: |c, word| c.puncture.needle = [Needle::Free, Needle::Guided { friction: 0.0 }][word],
            },
            "free: a load fixed to a point of the scale, which may move sideways, as in the paper; guided: a tip that moves straight down and slides on the scale";
        key::NEEDLE_RADIUS, "t", [Continuous, Toleranced],
            optional(LENGTH, |c| &mut c.puncture.needle_radius),
            "radius of the round tip of a guided needle, which may touch several scales; sharp unless given";
        "needle_radius_mm", "mm", [InMm(key::NEEDLE_RADIUS), Toleranced],
            optional(POSITIVE, |c| &mut c.in_mm.needle_radius),
            in_mm!("needle_radius", "radius of the round tip of a guided needle");
        key::UNLOAD, "-", [],
            words!(puncture.unload: "false" = false, "true" = true),
            "whether the load is removed at the end of the puncture";
        key::CRITICAL_TILT, "deg", [Continuous, EndsPuncture],
            Numbers {
                // Below 1e-14 the path to the tilt is dominated by round-off.
                range: Range { low: Included(1e-9), high: Excluded(90.0) },
                word: None,
                get: tilts,
                set: |c, tilts| set_tilts(&mut c.puncture, tilts, |tilt| tilt),
            },
            "tilt of the punctured scale at which the puncture ends; for a list the largest, with columns for each";
        key::NEEDLE_FRICTION, "-", [Continuous, EndsPuncture, InsteadOf(key::CRITICAL_TILT)],
            Numbers {
                // The critical tilt of a free needle is the arctangent of its friction, and must be
                // below 90°: arctan 1000 is 89.94°, but arctan 1e16 rounds to 90°.
                range: Range::closed(0.0, 1e3),
                word: Some("none"),
                get: |c| c.needle_friction.unwrap_or(Scalar::Word("none")),
                set: |c, friction| {
                    c.needle_friction = Some(friction).filter(|f| !matches!(f, Scalar::Word(_)));
                },
            },
            "friction between needle and scale; for a free needle it replaces the critical tilt, which is its arctangent; for a guided one both may be given";
        key::DEPTH, "t", [],
            optional(LENGTH, |c| &mut c.puncture.depth),
            "additional depth of the punctured point at which force_at_depth is measured";
        key::DEPTH_MM, "mm", [InMm(key::DEPTH)],
            optional(POSITIVE, |c| &mut c.in_mm.depth),
            in_mm!("depth", "depth at which force_at_depth is measured");
        key::NEEDLE_FORCE, "E_s t^2", [Continuous, Toleranced],
            optional(POSITIVE, |c| &mut c.needle_force),
            "force of the needle at which tissue_pressure_at_force is measured";
        key::NEEDLE_FORCE_N, "N", [],
            optional(POSITIVE, |c| &mut c.needle_force_n),
            "force of the needle, instead of force_over_substrate; with thickness_mm and substrate_modulus_MPa in [material]";
        key::PLACES, "-", [],
            count_or("none", 2, 1000, |c| c.puncture.places, |c, count| c.puncture.places = count),
            "number of load positions evaluated for weakest_force, from the left corner of the top to the right, for a round tip over one pitch";
        key::CONTACT_OVER_SUBSTRATE, "-", [Continuous, Toleranced],
            number(STIFF, |c| &mut c.puncture.contact_modulus_over_substrate),
            "modulus of the scales in contact, E_ct, divided by the modulus of the substrate, E_s";
        key::FAILURE, "-", [],
            words!(judge_failure: "false" = false, "true" = true),
            "whether to find the first failure and the largest stresses; a strength of scales or bonds requests them, too";
        key::SCALE_STRENGTH_OVER_SUBSTRATE, "-", [Continuous, Toleranced],
            optional(POSITIVE, |c| &mut c.strengths.scale),
            "strength of the scales divided by the modulus of the substrate, E_s; scales cannot break unless given";
        key::BOND_STRENGTH_OVER_SUBSTRATE, "-", [Continuous, Toleranced],
            optional(POSITIVE, |c| &mut c.strengths.bond),
            "strength of the bonds between scales and substrate, divided by E_s; bonds cannot fail unless given";
    }

    "array" {
        key::ACROSS, "-", [],
            words!(across: "false" = false, "true" = true),
            "whether to also puncture the row across, perpendicular to the row; gap_across_over_t requests this, too";
        key::GAP_ACROSS, "t", [Continuous, Toleranced],
            optional(LENGTH, |c| &mut c.gap_across),
            "gap between neighbouring scales across the row; the gap along it unless given";
        key::GAP_ACROSS_MM, "mm", [InMm(key::GAP_ACROSS), Toleranced],
            optional(POSITIVE, |c| &mut c.in_mm.gap_across),
            in_mm!("gap_across", "gap between neighbouring scales across the row");
    }

    "flexure" {
        "method", "-", [],
            words!(flexure.method: "unit-cell" = Method::UnitCell, "chain" = Method::Chain),
            "model of the strip: one gap, because all gaps deform alike, or the chain of all gaps";
        key::MEMBRANE_LENGTH, "t", [Continuous, Toleranced, EndsBending],
            number(LENGTH, |c| &mut c.flexure.membrane_length),
            "length of the membrane; rounded to whole gaps for a chain and for imperfect strips";
        "membrane_length_mm", "mm", [InMm(key::MEMBRANE_LENGTH), Toleranced, EndsBending],
            optional(POSITIVE, |c| &mut c.in_mm.membrane_length),
            in_mm!("membrane_length", "length of the membrane");
        "gaps", "-", [InsteadOf(key::MEMBRANE_LENGTH)],
            count_or(AUTO, 1, 1_000_000, |c| c.flexure.gaps, |c, count| c.flexure.gaps = count),
            "number of gaps of the strip, equal for all designs, instead of a length";
        key::MEMBRANE_THICKNESS, "t", [Continuous, Toleranced, UnitOfBending],
            number(LENGTH, |c| &mut c.flexure.membrane_thickness), "thickness h of the membrane";
        "membrane_thickness_mm", "mm", [InMm(key::MEMBRANE_THICKNESS), Toleranced, UnitOfBending],
            optional(POSITIVE, |c| &mut c.in_mm.membrane_thickness),
            in_mm!("membrane_thickness", "thickness of the membrane");
        key::MEMBRANE_AXIS, "t", [Continuous, Toleranced],
            number(Range::closed(-1e3, 1e3), |c| &mut c.flexure.membrane_axis_offset),
            "depth of the axis of the membrane below the bases of the scales";
        "membrane_axis_offset_mm", "mm", [InMm(key::MEMBRANE_AXIS), Toleranced],
            optional(ANY, |c| &mut c.in_mm.membrane_axis_offset),
            in_mm!("membrane_axis_offset", "depth of the axis of the membrane below the bases");
        "elements_per_gap", "-", [],
            count_or(AUTO, 1, 1000,
                |c| match c.flexure.elements_per_gap {
                    MembraneMesh::Auto => None,
                    MembraneMesh::Elements(count) => Some(count),
                },
                |c, count| {
                    c.flexure.elements_per_gap = count.map_or(MembraneMesh::Auto, MembraneMesh::Elements);
                }),
            "number of beam elements of the membrane between two scales; auto: as fine as the measures require";
        key::UNBEND, "-", [],
            words!(flexure.unload: "false" = false, "true" = true),
            "whether the moment is removed at the end of bending";
        "max_end_rotation_deg", "deg", [Continuous, Toleranced, EndsBending],
            SignedNumber {
                size: Range { low: Excluded(0.0), high: Included(180.0) },
                field: |c| &mut c.flexure.max_end_rotation_deg,
            },
            "rotation of each end at which bending ends; negative values bend the other way, with the scales outside";
        key::CONTACT_OVER_MEMBRANE, "-", [Continuous, Toleranced],
            number(STIFF, |c| &mut c.flexure.contact_modulus_over_membrane),
            "modulus of the scales in contact, E_ct, divided by the modulus of the membrane, E_m";
    }

    "imperfection" {
        "gap_cv", "-", [],
            number(Range::closed(0.0, 1.0), |c| &mut c.imperfection.gap_cv),
            "coefficient of variation of the gaps of imperfect rows";
        "slant_sd_deg", "deg", [],
            number(Range::closed(0.0, 30.0), |c| &mut c.imperfection.slant_sd_deg),
            "standard deviation of the slants of imperfect rows";
        "samples", "-", [],
            count(1, 1_000_000, |c| &mut c.samples.count),
            "number of imperfect rows, if gaps or slants scatter";
        "seed", "-", [],
            count(0, 1_000_000_000, |c| &mut c.samples.seed), "seed of the random gaps and slants";
    }

    "solver" {
        "first_step", "-", [],
            number(FRACTION, |c| &mut c.common.solver.first_step),
            "first step, as a fraction of the whole path";
        "max_step", "-", [],
            number(FRACTION, |c| &mut c.common.solver.max_step),
            "largest step, as a fraction of the whole path";
        "min_step", "-", [],
            number(FRACTION, |c| &mut c.common.solver.min_step),
            "smallest step, as a fraction of the whole path; the path stops below it";
        "tolerance", "-", [],
            number(Range { low: Excluded(0.0), high: Included(0.01) }, |c| &mut c.common.solver.tolerance),
            "largest scaled residual of an equilibrium";
        "max_iterations", "-", [],
            count(1, 1000, |c| &mut c.common.solver.max_iterations),
            "maximum number of Newton iterations before a step is cut to a third";
        "max_points", "-", [],
            count(2, 1_000_000_000, |c| &mut c.common.solver.max_points),
            "maximum number of equilibria of a path";
    }

    "material" {
        key::THICKNESS, "mm", [Toleranced],
            optional(POSITIVE, |c| &mut c.material.thickness_mm), "thickness t of the scales";
        key::SUBSTRATE_MODULUS, "MPa", [Toleranced],
            optional(POSITIVE, |c| &mut c.material.substrate_modulus_mpa), "modulus E_s of the substrate";
        key::MEMBRANE_MODULUS, "MPa", [Toleranced],
            optional(POSITIVE, |c| &mut c.material.membrane_modulus_mpa), "modulus E_m of the membrane";
        key::SCALE_MODULUS, "MPa", [Toleranced],
            optional(POSITIVE, |c| &mut c.material.scale_modulus_mpa),
            "modulus E_ct of the scales in contact, instead of contact_modulus_over_substrate and contact_modulus_over_membrane";
        key::SCALE_STRENGTH, "MPa", [Toleranced],
            optional(POSITIVE, |c| &mut c.material.scale_strength_mpa),
            "bending strength of the scales, instead of scale_strength_over_substrate";
        key::BOND_STRENGTH, "MPa", [Toleranced],
            optional(POSITIVE, |c| &mut c.material.bond_strength_mpa),
            "strength of the bonds between scales and substrate, instead of bond_strength_over_substrate";
        key::DENSITY, "kg/m^3", [Toleranced],
            optional(POSITIVE, |c| &mut c.material.scale_density_kg_m3), "density of the scales";
    }
};

/// Returns the critical tilt in degrees or, if a case has several tilts, the list of all tilts.
///
/// The tilts of a free needle may follow from its friction.
fn tilts(case: &Case) -> Scalar {
    let punctured = case.punctured();
    let listed = punctured.tilts_before_deg.and_then(|_| {
        let tilts: Vec<f64> = punctured.tilts_deg().collect();
        NumberList::new(&tilts)
    });
    listed.map_or(Scalar::Number(punctured.critical_tilt_deg), Scalar::List)
}

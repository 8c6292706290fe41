//! What is made: the geometry of the scales, the substrate below them, and how they touch.

use skin::Base;
use substrate::{Coupling, SubstrateLaw};

use super::{LENGTH, NUMBER, POSITIVE, of};
use crate::parameter::Bound::{Excluded, Included};
use crate::parameter::ParameterKind::{Number, OptionalNumber, Word};
use crate::parameter::Role::{Continuous, Geometry, InMm, Made, MovesSprings, Scattered};
use crate::parameter::{Parameter, Range, key};

const DESIGNS: Parameter = of("designs");
const SCALE: Parameter = of("scale");
const SUBSTRATE: Parameter = of("substrate");
const CONTACT: Parameter = of("contact");

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        key: key::GAP,
        unit: "t",
        meaning: "gap d between neighbouring bases",
        roles: &[Geometry, Continuous, Made, Scattered, MovesSprings],
        kind: Number { range: LENGTH, field: |c| &mut c.design.gap },
        ..DESIGNS
    },
    in_mm!(
        "gap",
        "gap between neighbouring bases",
        DESIGNS,
        POSITIVE,
        &[InMm(key::GAP), Made, Scattered, MovesSprings],
        |c| { &mut c.in_mm.gap }
    ),
    Parameter {
        key: key::LENGTH,
        unit: "t",
        meaning: "length L of a scale",
        roles: &[Geometry, Continuous, Made, MovesSprings],
        kind: Number { range: LENGTH, field: |c| &mut c.design.length },
        ..DESIGNS
    },
    in_mm!(
        "length",
        "length of a scale",
        DESIGNS,
        POSITIVE,
        &[InMm(key::LENGTH), Made, MovesSprings],
        |c| &mut c.in_mm.length
    ),
    Parameter {
        key: key::PITCH,
        unit: "mm",
        meaning: "base and gap of a scale in mm, instead of its gap or, beside a gap, of its length; with thickness_mm in [material]",
        roles: &[InMm(key::GAP), Made, MovesSprings],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.in_mm.pitch },
        ..DESIGNS
    },
    Parameter {
        key: key::SLANT,
        unit: "deg",
        meaning: "slant of the scales from the vertical, to the right",
        roles: &[Geometry, Continuous, Made, Scattered],
        kind: Number {
            range: Range { low: Included(0.0), high: Excluded(90.0) },
            field: |c| &mut c.design.slant_deg,
        },
        ..DESIGNS
    },
    Parameter {
        key: "base",
        meaning: "length of the base of a scale, L or 2L",
        roles: &[MovesSprings],
        kind: Word {
            words: &["L", "2L"],
            get: |c| usize::from(c.design.base == Base::TwoL),
            set: |c, word| c.design.base = [Base::L, Base::TwoL][word],
        },
        ..SCALE
    },
    Parameter {
        key: key::WIDTH,
        unit: "t",
        meaning: "out-of-plane width b of the scales",
        roles: &[Continuous, Made, MovesSprings],
        kind: Number { range: LENGTH, field: |c| &mut c.design.width },
        ..SCALE
    },
    in_mm!(
        "width",
        "width of a scale out of the plane",
        SCALE,
        POSITIVE,
        &[InMm(key::WIDTH), Made, MovesSprings],
        |c| &mut c.in_mm.width
    ),
    Parameter {
        key: key::POISSON_RATIO,
        meaning: "Poisson's ratio of the substrate",
        roles: &[Continuous, Made, MovesSprings],
        kind: Number { range: Range::closed(0.0, 0.5), field: |c| &mut c.puncture.poisson_ratio },
        ..SUBSTRATE
    },
    Parameter {
        key: key::TISSUE,
        unit: "t",
        meaning: "thickness of the substrate on a rigid base, as of tissue on bone; of a half-space unless it is given",
        roles: &[Continuous, Made, MovesSprings],
        kind: OptionalNumber { range: LENGTH, field: |c| &mut c.tissue_thickness },
        ..SUBSTRATE
    },
    in_mm!(
        "tissue_thickness",
        "thickness of the tissue on a rigid base",
        SUBSTRATE,
        POSITIVE,
        &[InMm(key::TISSUE), Made, MovesSprings],
        |c| &mut c.in_mm.tissue_thickness
    ),
    Parameter {
        key: "coupling",
        meaning: "neighbours that the substrate couples a scale with, the nearest or all that matter",
        roles: &[MovesSprings],
        kind: Word {
            words: &["nearest", "full"],
            get: |c| usize::from(c.coupling == Coupling::Full),
            set: |c, word| c.coupling = [Coupling::Nearest, Coupling::Full][word],
        },
        ..SUBSTRATE
    },
    Parameter {
        key: "law",
        meaning: "how the substrate answers where the gap between two bases is stretched or pressed: by linear springs, or as rubber, which cannot fold over",
        kind: Word {
            words: &["linear", "neo-hookean"],
            get: |c| usize::from(c.puncture.substrate_law == SubstrateLaw::NeoHookean),
            set: |c, word| {
                c.puncture.substrate_law = [SubstrateLaw::Linear, SubstrateLaw::NeoHookean][word];
            },
        },
        ..SUBSTRATE
    },
    Parameter {
        key: "c1",
        meaning: "prefactor C1 of the contact law",
        roles: NUMBER,
        kind: Number { range: Range::closed(1e-3, 1e3), field: |c| &mut c.common.law.c1 },
        ..CONTACT
    },
    Parameter {
        key: "c2",
        meaning: "exponent C2 of the contact law",
        roles: NUMBER,
        kind: Number {
            // A flat end has an exponent of 1, a sphere of 1.5; at larger ones contacts begin without any stiffness.
            range: Range::closed(0.05, 1.5),
            field: |c| &mut c.common.law.c2,
        },
        ..CONTACT
    },
    Parameter {
        key: key::FRICTION,
        meaning: "coefficient of friction between two scales",
        roles: NUMBER,
        kind: Number {
            // Rubber on a rough surface has about 2.
            range: Range::closed(0.0, 2.0),
            field: |c| &mut c.common.friction,
        },
        ..CONTACT
    },
];

//! What is made: the geometry of the scales, the substrate below them, and how they touch.

use skin::Base;
use substrate::{Coupling, SubstrateLaw};

use super::{LENGTH, NUMBER, POSITIVE};
use crate::parameter::Bound::{Excluded, Included};
use crate::parameter::ParameterKind::{Number, OptionalNumber, Word};
use crate::parameter::Role::{Continuous, Geometry, InMm, Made, MovesSprings, Scattered};
use crate::parameter::{Parameter, Range, key};

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        key: key::GAP,
        section: "designs",
        unit: "t",
        meaning: "gap d between neighbouring bases",
        roles: &[Geometry, Continuous, Made, Scattered, MovesSprings],
        kind: Number { range: LENGTH, field: |c| &mut c.design.gap },
    },
    in_mm!(
        "gap",
        "gap between neighbouring bases",
        "designs",
        POSITIVE,
        &[InMm(key::GAP), Made, Scattered, MovesSprings],
        |c| { &mut c.in_mm.gap }
    ),
    Parameter {
        key: key::LENGTH,
        section: "designs",
        unit: "t",
        meaning: "length L of a scale",
        roles: &[Geometry, Continuous, Made, MovesSprings],
        kind: Number { range: LENGTH, field: |c| &mut c.design.length },
    },
    in_mm!(
        "length",
        "length of a scale",
        "designs",
        POSITIVE,
        &[InMm(key::LENGTH), Made, MovesSprings],
        |c| &mut c.in_mm.length
    ),
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
    in_mm!(
        "width",
        "width of a scale out of the plane",
        "scale",
        POSITIVE,
        &[InMm(key::WIDTH), Made, MovesSprings],
        |c| &mut c.in_mm.width
    ),
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
        "thickness of the tissue on a rigid base",
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
];

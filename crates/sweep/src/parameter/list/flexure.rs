//! How a skin is bent: the strip, its membrane, and where the path ends.

use skin::flexure::{MembraneMesh, Method};

use super::{ANY, AUTO, LENGTH, NUMBER, POSITIVE, STIFF, of};
use crate::parameter::Bound::{Excluded, Included};
use crate::parameter::ParameterKind::{CountOrWord, Number, OptionalNumber, SignedNumber, Word};
use crate::parameter::Role::{Continuous, EndsBending, InMm, InsteadOf, Made, UnitOfBending};
use crate::parameter::{CountRange, Parameter, Range, key};

const FLEXURE: Parameter = of("flexure");

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        key: "method",
        meaning: "what is bent: one gap, since all deform alike, or the chain of all",
        kind: Word {
            words: &["unit-cell", "chain"],
            get: |c| usize::from(c.flexure.method == Method::Chain),
            set: |c, word| c.flexure.method = [Method::UnitCell, Method::Chain][word],
        },
        ..FLEXURE
    },
    Parameter {
        key: key::MEMBRANE_LENGTH,
        unit: "t",
        meaning: "length of the membrane; a chain and imperfect strips round it to whole gaps",
        roles: &[Continuous, Made, EndsBending],
        kind: Number { range: LENGTH, field: |c| &mut c.flexure.membrane_length },
        ..FLEXURE
    },
    in_mm!(
        "membrane_length",
        "length of the membrane",
        FLEXURE,
        POSITIVE,
        &[InMm(key::MEMBRANE_LENGTH), Made, EndsBending],
        |c| &mut c.in_mm.membrane_length
    ),
    Parameter {
        key: "gaps",
        meaning: "gaps of the strip, the same number for every design, instead of a length",
        roles: &[InsteadOf(key::MEMBRANE_LENGTH)],
        kind: CountOrWord {
            word: AUTO,
            range: CountRange { low: 1, high: 1_000_000 },
            get: |c| c.flexure.gaps,
            set: |c, count| c.flexure.gaps = count,
        },
        ..FLEXURE
    },
    Parameter {
        key: key::MEMBRANE_THICKNESS,
        unit: "t",
        meaning: "thickness h of the membrane",
        roles: &[Continuous, Made, UnitOfBending],
        kind: Number { range: LENGTH, field: |c| &mut c.flexure.membrane_thickness },
        ..FLEXURE
    },
    in_mm!(
        "membrane_thickness",
        "thickness of the membrane",
        FLEXURE,
        POSITIVE,
        &[InMm(key::MEMBRANE_THICKNESS), Made, UnitOfBending],
        |c| &mut c.in_mm.membrane_thickness
    ),
    Parameter {
        key: key::MEMBRANE_AXIS,
        unit: "t",
        meaning: "depth of the axis of the membrane below the bases of the scales",
        roles: NUMBER,
        kind: Number {
            range: Range::closed(-1e3, 1e3),
            field: |c| &mut c.flexure.membrane_axis_offset,
        },
        ..FLEXURE
    },
    in_mm!(
        "membrane_axis_offset",
        "depth of the axis of the membrane below the bases",
        FLEXURE,
        ANY,
        &[InMm(key::MEMBRANE_AXIS), Made],
        |c| &mut c.in_mm.membrane_axis_offset
    ),
    Parameter {
        key: "elements_per_gap",
        meaning: "beam elements of the membrane between two scales, or as fine as the measures need",
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
        ..FLEXURE
    },
    Parameter {
        key: key::UNBEND,
        meaning: "whether the moment is taken away again at the end of bending",
        kind: Word {
            words: &["false", "true"],
            get: |c| usize::from(c.flexure.unload),
            set: |c, word| c.flexure.unload = word == 1,
        },
        ..FLEXURE
    },
    Parameter {
        key: "max_end_rotation_deg",
        unit: "deg",
        meaning: "rotation of each end at which bending ends; below zero, bending the other way, scales outside",
        roles: &[Continuous, Made, EndsBending],
        kind: SignedNumber {
            size: Range { low: Excluded(0.0), high: Included(180.0) },
            field: |c| &mut c.flexure.max_end_rotation_deg,
        },
        ..FLEXURE
    },
    Parameter {
        key: key::CONTACT_OVER_MEMBRANE,
        meaning: "modulus of the scales in contact, E_ct, over that of the membrane, E_m",
        roles: NUMBER,
        kind: Number { range: STIFF, field: |c| &mut c.flexure.contact_modulus_over_membrane },
        ..FLEXURE
    },
];

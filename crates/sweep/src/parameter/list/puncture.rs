//! How a skin is punctured: the row, the load and its needle, and where the path ends.

use skin::puncture::{Needle, NumberList, RowLength};

use super::{ANY, AUTO, LENGTH, NUMBER, POSITIVE, STIFF, of};
use crate::case::{Case, set_tilts};
use crate::parameter::Bound::{Excluded, Included};
use crate::parameter::ParameterKind::{CountOrWord, Number, Numbers, OptionalNumber, Word};
use crate::parameter::Role::{Continuous, EndsPuncture, InMm, InsteadOf, Made};
use crate::parameter::{CountRange, Parameter, Range, Scalar, key};

const PUNCTURE: Parameter = of("puncture");

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        key: "scales",
        meaning: "scales in the row",
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
        ..PUNCTURE
    },
    Parameter {
        key: key::LOAD_POSITION,
        meaning: "place of the load on the top of the punctured scale, 0 its left corner, 1 its right; of a round tip also beyond, at most 1 + gap/base, the left corner of the next scale",
        roles: NUMBER,
        // How far beyond 1 it may stand depends on gap and tip: `load_can_stand` refuses, and
        // `punctured` keeps it before the next scale.
        kind: Number { range: Range::closed(0.0, 1e6), field: |c| &mut c.puncture.load_position },
        ..PUNCTURE
    },
    Parameter {
        key: key::LOAD_INSET,
        unit: "t",
        meaning: "distance of the load from the right corner of the top, inward as far as the middle; instead of load_position",
        roles: &[InsteadOf(key::LOAD_POSITION)],
        kind: OptionalNumber { range: Range::closed(0.0, 1e6), field: |c| &mut c.load_inset },
        ..PUNCTURE
    },
    in_mm!(
        "load_inset",
        "distance of the load from the right corner of the top",
        PUNCTURE,
        ANY,
        &[InMm(key::LOAD_INSET)],
        |c| &mut c.in_mm.load_inset
    ),
    Parameter {
        key: key::NEEDLE,
        meaning: "free: a load that follows its point of the scale sideways, as in the paper; guided: a tip that moves straight down and slides on the scale",
        roles: &[EndsPuncture],
        kind: Word {
            words: &["free", "guided"],
            get: |c| usize::from(c.puncture.needle.is_guided()),
            // Its friction is that of the case.
            set: |c, word| {
                c.puncture.needle = [Needle::Free, Needle::Guided { friction: 0.0 }][word];
            },
        },
        ..PUNCTURE
    },
    Parameter {
        key: key::NEEDLE_RADIUS,
        unit: "t",
        meaning: "radius of the round tip of a guided needle, which may touch several scales; sharp unless it is given",
        roles: NUMBER,
        kind: OptionalNumber { range: LENGTH, field: |c| &mut c.puncture.needle_radius },
        ..PUNCTURE
    },
    in_mm!(
        "needle_radius",
        "radius of the round tip of a guided needle",
        PUNCTURE,
        POSITIVE,
        &[InMm(key::NEEDLE_RADIUS), Made],
        |c| &mut c.in_mm.needle_radius
    ),
    Parameter {
        key: key::UNLOAD,
        meaning: "whether the load is taken away again at the end of the puncture",
        kind: Word {
            words: &["false", "true"],
            get: |c| usize::from(c.puncture.unload),
            set: |c, word| c.puncture.unload = word == 1,
        },
        ..PUNCTURE
    },
    Parameter {
        key: key::CRITICAL_TILT,
        unit: "deg",
        meaning: "tilt of the punctured scale at which the puncture ends; of several the largest, with columns for each",
        roles: &[Continuous, EndsPuncture],
        kind: Numbers {
            // Below 1e-14 the path to it drowns in round-off.
            range: Range { low: Included(1e-9), high: Excluded(90.0) },
            word: None,
            get: tilts,
            set: |c, tilts| set_tilts(&mut c.puncture, tilts, |tilt| tilt),
        },
        ..PUNCTURE
    },
    Parameter {
        key: key::NEEDLE_FRICTION,
        meaning: "friction between needle and scale; of a free needle its arctangent is the critical tilt, instead of that, of a guided one both may be given",
        roles: &[Continuous, EndsPuncture, InsteadOf(key::CRITICAL_TILT)],
        kind: Numbers {
            // Of 1000 the arctangent is 89.94°; of 1e16 it is 90°, to the last digit.
            range: Range::closed(0.0, 1e3),
            word: Some("none"),
            get: |c| c.needle_friction.unwrap_or(Scalar::Word("none")),
            set: |c, friction| {
                c.needle_friction = Some(friction).filter(|f| !matches!(f, Scalar::Word(_)));
            },
        },
        ..PUNCTURE
    },
    Parameter {
        key: key::DEPTH,
        unit: "t",
        meaning: "depth of the punctured point at which the force is measured besides, in force_at_depth",
        kind: OptionalNumber { range: LENGTH, field: |c| &mut c.puncture.depth },
        ..PUNCTURE
    },
    in_mm!(
        "depth",
        "depth at which force_at_depth is measured",
        PUNCTURE,
        POSITIVE,
        &[InMm(key::DEPTH)],
        |c| &mut c.in_mm.depth
    ),
    Parameter {
        key: key::PLACES,
        meaning: "places of the load that are tried besides, from the left corner of the top to the right, of a round tip over one pitch, for weakest_force",
        kind: CountOrWord {
            word: "none",
            range: CountRange { low: 2, high: 1000 },
            get: |c| c.puncture.places,
            set: |c, count| c.puncture.places = count,
        },
        ..PUNCTURE
    },
    Parameter {
        key: key::CONTACT_OVER_SUBSTRATE,
        meaning: "modulus of the scales in contact, E_ct, over that of the substrate, E_s",
        roles: NUMBER,
        kind: Number { range: STIFF, field: |c| &mut c.puncture.contact_modulus_over_substrate },
        ..PUNCTURE
    },
];

/// The tilts of a puncture as it is solved: those of a free needle may follow from its friction.
fn tilts(case: &Case) -> Scalar {
    let punctured = case.punctured();
    let listed = punctured.tilts_before_deg.and_then(|_| {
        let tilts: Vec<f64> = punctured.tilts_deg().collect();
        NumberList::new(&tilts)
    });
    listed.map_or(Scalar::Number(punctured.critical_tilt_deg), Scalar::List)
}

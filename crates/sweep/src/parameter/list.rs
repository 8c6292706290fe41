//! The one list of parameters: it drives validation, messages, axes, columns and documentation.

use crate::parameter::Bound::{Excluded, Included};
use crate::parameter::Role::{Continuous, Made};
use crate::parameter::{Parameter, ParameterKind, Range, Role};

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

/// What a parameter of a section is unless its entry says otherwise: without a unit, and with no role.
const fn of(section: &'static str) -> Parameter {
    // Every entry has a key and values of its own.
    let kind = ParameterKind::Word { words: &[], get: |_| 0, set: |_, _| {} };
    Parameter { key: "", section, unit: "-", meaning: "", roles: &[], kind }
}

/// A length in mm beside the same over the thickness, which follows from it.
macro_rules! in_mm {
    ($stem:literal, $what:literal, $section:expr, $range:expr, $roles:expr, $field:expr) => {
        Parameter {
            key: concat!($stem, "_mm"),
            unit: "mm",
            meaning: concat!(
                $what,
                ", instead of ",
                $stem,
                "_over_t; with thickness_mm in [material]"
            ),
            roles: $roles,
            kind: OptionalNumber { range: $range, field: $field },
            ..$section
        }
    };
}

mod flexure;
mod puncture;
mod skin;
mod solution;

const PARTS: [&[Parameter]; 4] =
    [skin::PARAMETERS, puncture::PARAMETERS, flexure::PARAMETERS, solution::PARAMETERS];

/// Every parameter, in the order of the documentation. Keys are unique over all sections, because
/// an axis is named by its key alone.
// One slice, not a chain of iterators: others take parameters by their place, and keep them for as long as the program runs.
pub static PARAMETERS: &[Parameter] = &joined::<{ count() }>();

const fn count() -> usize {
    let (mut all, mut part) = (0, 0);
    // Constant functions have no iterators.
    while part < PARTS.len() {
        all += PARTS[part].len();
        part += 1;
    }
    all
}

const fn joined<const N: usize>() -> [Parameter; N] {
    // Any parameter will do to begin with: each place is written over.
    let mut all = [PARTS[0][0]; N];
    let (mut place, mut part) = (0, 0);
    while part < PARTS.len() {
        let mut i = 0;
        while i < PARTS[part].len() {
            all[place] = PARTS[part][i];
            (place, i) = (place + 1, i + 1);
        }
        part += 1;
    }
    all
}

//! Goals about samples: statistics over the random deviations of a design.
//!
//! The deviations of sample `i` are drawn once and are the same for every design (common random
//! numbers). Quantiles and yields are therefore deterministic functions of the design:
//!
//! ```text
//! yield ≥ y   ⇔   m₍ₖ₎ ≥ 0,   k = n − ⌈y n⌉ + 1                                          (O6)
//! ```
//!
//! Here `m₍₁₎ ≤ … ≤ m₍ₙ₎` are the sorted margins of the samples. The margin of a sample is its
//! least margin over all requirements, relative to their limits. A yield is a step function of the
//! design, but the margin `m₍ₖ₎` is continuous.

pub(crate) mod confirmation;
pub(crate) mod search;

//! Goals about samples: designs with the deviations of their tolerances, and the statistics over them that a goal may name.
//!
//! The deviations of sample `i` are the same for every design and drawn once (common random numbers), so that quantiles and yields are
//! functions of the design like any other:
//!
//! ```text
//! yield ≥ y   ⇔   m₍ₖ₎ ≥ 0,   k = n − ⌈y n⌉ + 1                                          (O6)
//! ```
//!
//! with the margins `m₍₁₎ ≤ … ≤ m₍ₙ₎` of the samples in their order, each the least of its margins over all requirements, relative to
//! their limits. A yield is a staircase over the designs, the margin on the right is continuous.

pub(crate) mod confirmation;
pub(crate) mod search;

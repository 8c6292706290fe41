//! Searches for goals with quantiles or yields, i.e. statistics over samples of a design.
//!
//! Sample `i` has the same random numbers in each design (common random numbers). So quantiles and
//! yields are deterministic functions of the design:
//!
//! ```text
//! yield ≥ y   ⇔   m₍ₖ₎ ≥ 0,   k = n − ⌈y n⌉ + 1                                          (O6)
//! ```
//!
//! `m₍₁₎ ≤ … ≤ m₍ₙ₎` are the sorted margins of the `n` samples. The margin of a sample is its
//! smallest margin over all requirements, relative to their limits. A yield is a step function of
//! the design, but the margin `m₍ₖ₎` is continuous.

pub(crate) mod confirmation;
pub(crate) mod search;

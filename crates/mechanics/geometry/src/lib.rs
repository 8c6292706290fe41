//! Undeformed geometry of scales and rows of scales.
//!
//! A scale is a parallelogram of height `t`. Its sides are inclined by the slant `α` from the
//! vertical. Scales with bases `2a` at gaps `d` form a row of pitch `p = 2a + d`. Lengths are in
//! units of the scale thickness `t`; `y` points up out of the substrate, and angles are
//! counter-clockwise. A vertical line runs from the top right corner of a scale down to the
//! substrate. The coverage of a row is the fraction of this line that lies inside the scales to the
//! right of this scale (Eq. G2 of `docs/theory/model.md`):
//!
//! ```text
//! λ = Σₖ |[S − k p, S − k p + 2a] ∩ [0, S]| / S,     S = t tan α,  k = 1, 2 …
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`Parallelogram`] | one scale: half-width of its base and slant |
//! | [`Corner`] | a corner of a scale |
//! | [`Row`] | identical scales at a constant gap: pitch, coverage |
//! | [`RowChange`] | rates of change of the lengths of a row, for derivatives of the coverage |
//! | [`UnevenRow`] | scales of unequal slants at unequal gaps |
//! | [`Body`], [`Frame`] | a curved body under a row, and its tangent frames |
//! | [`OutOfRange`] | error for a parameter outside its valid range |
//!
//! ```
//! use geometry::{Parallelogram, Row};
//!
//! let row = Row::new(Parallelogram::new(0.5, 45.0)?, 0.1)?;
//! assert!((row.pitch() - 1.1).abs() < 1e-15);
//! assert!((row.coverage() - 0.9).abs() < 1e-12);
//! # Ok::<(), geometry::OutOfRange>(())
//! ```

mod body;
mod coverage;
mod out_of_range;
mod parallelogram;
mod row;
mod uneven_row;

pub use body::{Body, Frame};
pub use out_of_range::OutOfRange;
pub use parallelogram::{Corner, Parallelogram};
pub use row::{Row, RowChange};
pub use uneven_row::{UnevenRow, clearance, polygon_distance};

/// Point or vector in the plane of the row, in units of `t`.
pub type Vec2 = nalgebra::Vector2<f64>;

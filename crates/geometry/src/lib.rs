//! Scales and rows of scales, undeformed.
//!
//! Lengths are in units of the scale thickness `t`; `y` points up out of the substrate and angles
//! are counter-clockwise.
//!
//! | Type | Role |
//! |---|---|
//! | [`Parallelogram`] | one scale: half-width of its base and slant |
//! | [`Row`] | identical scales at a constant gap: pitch, coverage |
//! | [`UnevenRow`] | scales of unequal slants at unequal gaps |
//!
//! ```
//! use geometry::{Parallelogram, Row};
//!
//! let row = Row::new(Parallelogram::new(0.5, 45.0)?, 0.1)?;
//! assert!((row.pitch() - 1.1).abs() < 1e-15);
//! assert!((row.coverage() - 0.9).abs() < 1e-12);
//! # Ok::<(), geometry::InvalidGeometry>(())
//! ```

mod coverage;
mod parallelogram;
mod row;
mod uneven_row;

pub use parallelogram::{Corner, InvalidGeometry, Parallelogram};
pub use row::Row;
pub use uneven_row::{UnevenRow, clearance};

/// A point or a vector of the plane, in units of `t`.
pub type Vec2 = nalgebra::Vector2<f64>;

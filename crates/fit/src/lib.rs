//! The skin behind the curve of a testing machine.
//!
//! | Type | Role |
//! |---|---|
//! | [`MeasuredCurve`], [`Test`] | force over displacement or moment over curvature, from a CSV file |

mod measured;

pub use measured::{InvalidMeasured, MeasuredCurve, Test};

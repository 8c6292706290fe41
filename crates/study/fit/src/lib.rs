//! The skin behind the curve of a testing machine.
//!
//! ```text
//! TEST.toml ─► FitDefinition ─┬─► model    curves of a skin with their derivatives (run::Evaluator)
//! files.csv ─► MeasuredCurve ─┘   search   least squares within the ranges of what is sought
//!                                 fitted   intervals, correlations, what the curves do not tell
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`MeasuredCurve`], [`Test`] | force over displacement or moment over curvature, from a CSV file |
//! | [`FitDefinition`], [`Unknown`] | what is sought, and the curves that are to tell it |
//! | [`Fitted`], [`Estimate`], [`FittedCurve`] | what was found, and how surely |

mod definition;
mod fit_result;
mod measured_curve;
mod model;
mod search;

pub use definition::{FitDefinition, InvalidFit, Unknown};
pub use fit_result::{Estimate, FitError, Fitted, FittedCurve};
pub use measured_curve::{InvalidMeasured, MeasuredCurve, Test};

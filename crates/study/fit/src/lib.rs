//! Fits parameters of a skin to force or moment curves of a testing machine.

mod definition;
mod error;
mod fit_result;
mod measured_curve;
mod model;
mod profile;
mod search;

pub use definition::{FitDefinition, InvalidFit, PER_SPECIMEN, Unknown, curves_schema};
pub use error::FitError;
pub use fit_result::{Estimate, Fitted, FittedCurve, Scatter};
pub use measured_curve::{
    CurveEvent, CurveEventKind, InvalidMeasured, MeanCurve, MeasuredCurve, Test,
};

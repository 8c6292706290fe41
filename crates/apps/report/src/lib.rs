//! Drawings of designs, and figures and pages of sweeps.
//!
//! This crate draws the tables of a run and solved designs; it does not solve designs itself. A
//! drawing maps a point `(x, y)` of the plane, in units of `t`, to `(x₀ + s x, y₀ − s y)` px.
//!
//! | Item | Role |
//! |---|---|
//! | [`drawings`] | a punctured row of scales or a bent strip, to scale, as SVG or as an animation |
//! | [`curves()`], [`MeasuredCurves`] | paths of solved designs, with test data overlaid |
//! | [`figures()`], [`Figure`] | figures of a sweep, from its table |
//! | [`Histogram`], [`share_bars`], [`Shares`] | histogram of samples of a measure; bars of the contributions to its variance |
//! | [`fit_figure`], [`FitPanel`] | measured and fitted curves, and residuals |
//! | [`SearchFigure`], [`SearchedDesign`] | history and front of a search |
//! | [`map()`], [`MapRequest`] | map of any column over any two parameters, with contours |
//! | [`Designs`] | the table of a sweep, column by column |
//! | [`Page`], [`PageDesign`] | figures, ranking, table and drawings on one HTML page |
//! | [`Explorer`] | an interactive design with its solver, at the top of the page of a sweep or on its own page |
//! | [`GapFactors`] | change of the measures for a gap 10 % smaller or larger, for the page |
//! | `png` | conversion of a drawing or figure to an image (feature `png`) |
//! | [`export`] | the tables as one workbook for spreadsheets (feature `xlsx`) |
//!
//! ```
//! use report::drawings::PunctureDrawing;
//! use skin::puncture::{At, snapshots};
//! use substrate::calibrate;
//! use sweep::Sweep;
//!
//! // A row of five scales at rest, and with its middle scale tilted by 10°.
//! let text = "name = 'x'\npuncture.scales = 5\ndesigns.gap_over_t = 0.2\ndesigns.length_over_t = 0.5\ndesigns.slant_deg = 60";
//! let case = Sweep::parse(text, "x.toml", &[])?.grid().case(0);
//! let springs = calibrate(&case.footprint()?)?;
//! let solved = snapshots(&case.design, &springs, &case.common, &case.punctured(), &[At::Tilt(10.0)])?;
//! let states: Vec<_> = solved.at.into_iter().flatten().collect();
//! let name = "five scales";
//! let svg = PunctureDrawing { name, case: &case, states: &states }.svg()?;
//! assert!(svg.contains("five scales"));
//! # #[cfg(feature = "png")]
//! assert!(report::png(&svg, 96.0)?.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;
mod chart;
mod colors;
mod curves;
mod designs;
pub mod drawings;
mod explore;
#[cfg(feature = "xlsx")]
mod export;
mod facts;
mod figures;
mod fits;
mod label;
mod packed;
mod page;
mod palette;
mod paper;
#[cfg(feature = "png")]
mod png;
mod search_page;
mod spreads;
mod svg;
mod template;

pub use curves::{DesignCurves, FailureLimit, MeasuredCurves, curves};
pub use designs::Designs;
pub use explore::{Explorer, SolvedTable};
#[cfg(feature = "xlsx")]
pub use export::{ExportError, Exported, OtherTable, export};
pub use facts::facts;
pub use figures::{
    EVALUATION, Figure, InvalidMap, MapRequest, ParallelFigure, SearchFigure, SearchedDesign,
    figures, map,
};
pub use fits::{FitPanel, fit_figure};
pub use page::{Fact, GapFactors, Page, PageDesign, PageFront};
pub use palette::{Mark, SlantPalette};
pub use paper::Paper;
#[cfg(feature = "png")]
pub use png::{ImageError, png};
pub use search_page::SearchPage;
pub use spreads::{Histogram, Shares, share_bars};
pub use svg::{resized, smallest_letters, untitled};

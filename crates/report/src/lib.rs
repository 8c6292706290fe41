//! Drawings of designs, figures of sweeps.
//!
//! | Item | Role |
//! |---|---|
//! | [`drawings`] | a row of scales punctured, a strip bent: to scale, as SVG or as an animation |
//! | [`curves()`] | paths of solved designs |
//! | [`figures()`] | what a sweep found, from its table |
//! | [`Page`] | all of it on one page |
//! | [`png`] | any of them as an image |
//!
//! ```
//! use report::drawings::Puncture;
//! use skin::puncture::{At, Parameters, RowLength, snapshots};
//! use skin::{Base, Common, Design};
//! use substrate::calibrate;
//!
//! // A row of five scales at rest and when the middle one has tilted by 10°.
//! let design = Design { gap: 0.2, length: 0.5, slant_deg: 60.0, base: Base::L, width: 1.0 };
//! let springs = calibrate(&design.footprint(0.5)?)?;
//! let parameters = Parameters { scales: RowLength::Scales(5), ..Parameters::default() };
//! let solved = snapshots(&design, &springs, &Common::default(), &parameters, &[At::Tilt(10.0)])?;
//! let states: Vec<_> = solved.at.into_iter().flatten().collect();
//! let name = "five scales";
//! let svg = Puncture { name, design: &design, load_position: 1.0, states: &states }.svg()?;
//! assert!(svg.contains("five scales"));
//! assert!(report::png(&svg)?.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;
mod chart;
mod curves;
mod designs;
pub mod drawings;
mod figures;
mod label;
mod page;
mod palette;
mod png;
mod svg;

pub use curves::{Solved, curves};
pub use designs::Designs;
pub use figures::{Figure, figures};
pub use page::{Fact, Page};
pub use palette::{Mark, slant_color};
pub use png::{NoImage, png};

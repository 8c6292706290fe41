//! Drawings of designs, figures of sweeps.
//!
//! | Item | Role |
//! |---|---|
//! | [`drawings`] | a row of scales punctured, a strip bent: to scale, as SVG or as an animation |
//! | [`curves()`] | paths of solved designs |
//! | [`figures()`] | what a sweep found, from its table |
//! | [`Page`] | all of it on one page |
//! | [`png`] | any of them as an image |

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

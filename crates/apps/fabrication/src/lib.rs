//! Files for manufacturing a patch of skin, in millimetres.
//!
//! Formats are 3MF and STL for 3D printers, STEP for CAD programs, DXF and SVG for laser cutters.
//!
//! All solids are [prisms](Prism): a scale is a parallelogram, the membrane a rectangle, extruded
//! across the rows. The formats are written without libraries, because each writer takes a page.

mod dxf;
mod mesh;
mod patch;
mod sheet;
mod step;
mod stl;
mod svg;
mod three_mf;

pub use patch::{NoPatch, Patch, Prism};
pub use sheet::{NoSheet, Outline, Sheet};

/// A file format for a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 3MF: a mesh with units; scales and membrane are separate parts.
    ThreeMf,
    /// Binary STL: one mesh of all solids, without a unit.
    Stl,
    /// STEP (AP214): exact solids for CAD programs.
    Step,
    /// DXF: outlines for laser cutters.
    Dxf,
    /// SVG: the same outlines as DXF.
    Svg,
}

impl Format {
    /// Returns the format for a file extension without the dot, ignoring case.
    pub fn of_extension(extension: &str) -> Option<Self> {
        Some(match extension.to_ascii_lowercase().as_str() {
            "3mf" => Self::ThreeMf,
            "stl" => Self::Stl,
            "step" | "stp" => Self::Step,
            "dxf" => Self::Dxf,
            "svg" => Self::Svg,
            _ => return None,
        })
    }

    /// Returns true for formats with outlines to cut.
    pub fn is_flat(self) -> bool {
        matches!(self, Self::Dxf | Self::Svg)
    }

    /// Returns the file: solids from `patch`, or outlines from `sheet`.
    pub fn bytes(self, patch: &Patch, sheet: &Sheet) -> Vec<u8> {
        match self {
            Self::ThreeMf => three_mf::write(patch),
            Self::Stl => stl::write(patch),
            Self::Step => step::write(patch).into_bytes(),
            Self::Dxf => dxf::write(sheet).into_bytes(),
            Self::Svg => svg::write(sheet).into_bytes(),
        }
    }
}

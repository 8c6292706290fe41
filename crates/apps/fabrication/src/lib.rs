//! Files for makers: a patch of skin in millimetres, for printers (3MF, STL), CAD programs (STEP) and laser cutters (DXF, SVG).
//!
//! All solids are [prisms](Prism): a scale is a parallelogram, the membrane a rectangle, extruded across the rows. The files are
//! written here because each takes a page, and because a skin needs none of what the large libraries are made for.

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

/// A kind of file that a patch can be written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 3MF: a mesh that names its unit, scales and membrane as two parts.
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
    /// The format whose files end in `extension`, without the dot and in any case of letters.
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

    /// Whether the file holds outlines to cut, not solids.
    pub fn is_flat(self) -> bool {
        matches!(self, Self::Dxf | Self::Svg)
    }

    /// The contents of the file. Solids are those of `patch`, outlines those of `sheet`.
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

//! Files for manufacturing and checking a patch of skin, in millimetres.
//!
//! Formats are 3MF and STL for 3D printers, STEP for CAD programs, DXF and SVG for laser cutters,
//! and a [deck](deck()) for finite-element programs.
//!
//! All solids are [prisms](Prism), extruded across the rows. The outline of a scale is a
//! parallelogram; the outline of the membrane is a rectangle or, on a curved body, a bent strip.
//! Decks and outlines for laser cutters are always flat. This crate writes all formats itself,
//! because each writer is about a page of code; only the compression of 3MF uses a library.

mod deck;
mod dxf;
mod mesh;
mod patch;
mod sheet;
mod step;
mod stl;
mod svg;
mod three_mf;

pub use deck::{DeckError, Puncture, deck};
pub use patch::{Patch, PatchError, Prism, Solids};
pub use sheet::{Outline, Sheet, SheetError};

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

    /// Returns true if files of this format contain outlines to cut instead of solids.
    pub fn is_flat(self) -> bool {
        matches!(self, Self::Dxf | Self::Svg)
    }

    /// Returns the contents of a file with the solids of `patch`, or with the outlines of `sheet`.
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

#[cfg(test)]
mod tests {
    use geometry::{Body, Parallelogram, Row};

    use super::*;

    #[test]
    fn files_have_finite_numbers_at_every_valid_size() {
        let sizes = [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e12];
        let mut written = 0;
        for (slant, thickness) in
            [0.0, 60.0, 89.999_999].into_iter().flat_map(|s| sizes.map(|t| (s, t)))
        {
            for width in sizes {
                let row = Row::new(Parallelogram::new(0.5, slant).expect("a valid slant"), 0.3);
                let lengths = [width, 0.1 * width, 0.3 * width];
                let patch = Patch::new(row.expect("a valid gap"), thickness, lengths, [2, 2]);
                let Some(mut patch) = patch.ok() else { continue };
                // Every second patch lies on a body with a radius of 100 t.
                if written % 2 == 1 {
                    patch = patch.on_body(Body { curvature: 0.01 }).unwrap_or(patch);
                }
                for (kerf, template) in [(0.0, 0.0), (0.1, 1.0), (1e5, 1e6)] {
                    let Ok(sheet) = Sheet::new(&patch, kerf, template) else { continue };
                    assert!(sheet.web().is_finite());
                    for format in [Format::Step, Format::Dxf, Format::Svg] {
                        let text =
                            String::from_utf8(format.bytes(&patch, &sheet)).expect("UTF-8 text");
                        let words = text.split(|c: char| !c.is_ascii_alphanumeric());
                        let wrong = words.filter(|word| ["NaN", "inf"].contains(word)).count();
                        assert_eq!(wrong, 0, "{format:?} of {patch:?}");
                    }
                    let stl = Format::Stl.bytes(&patch, &sheet);
                    for bytes in stl[84..].chunks(50).flat_map(|facet| facet[..48].chunks(4)) {
                        let number = f32::from_le_bytes(bytes.try_into().expect("4 bytes"));
                        assert!(number.is_finite(), "{patch:?}");
                    }
                    written += 1;
                }
            }
        }
        assert!(written > 30, "{written}");
    }
}

//! Animations of a path: one HTML page in which every frame is a solved equilibrium.

use geometry::OutOfRange;

use super::{CAPTION, DrawingPanel, FlexureDrawing, MARGIN, PunctureDrawing, WIDTH};
use crate::colors::INK;
use crate::label::{Anchor, label, plain};
use crate::svg::{Element, px};

/// The page around the frames.
const PAGE: &str = include_str!("../../assets/animation.html");

impl PunctureDrawing<'_> {
    /// Returns the states as the frames of one self-contained HTML page.
    ///
    /// # Errors
    /// If the design is invalid.
    pub fn animation(&self) -> Result<String, OutOfRange> {
        Ok(page(&self.title(), self.frames()?))
    }
}

impl FlexureDrawing<'_> {
    /// Returns the states as the frames of one self-contained HTML page.
    ///
    /// # Errors
    /// If the design is invalid.
    pub fn animation(&self) -> Result<String, OutOfRange> {
        Ok(page(&self.title(), self.frames()?))
    }
}

fn page(title: &str, frames: Vec<DrawingPanel>) -> String {
    // All frames have the same height, so that the page does not jump between frames.
    let highest = frames.iter().map(|frame| frame.height).fold(0.0, f64::max);
    let height = CAPTION + highest + 0.5 * MARGIN;
    let drawn: Vec<_> = frames.into_iter().map(frame).collect();
    // The frames are inserted last, so that they are not searched for placeholders.
    PAGE.replace("{{title}}", &plain(title))
        .replace("{{width}}", &px(WIDTH))
        .replace("{{height}}", &px(height))
        .replace("{{last}}", &drawn.len().saturating_sub(1).to_string())
        .replace("{{frames}}", &drawn.join("\n"))
}

fn frame(DrawingPanel { caption, inside, .. }: DrawingPanel) -> String {
    let caption = label(&caption, [MARGIN, 17.0], 14.0, Anchor::Start).with("fill", INK);
    let body = Element::group("body")
        .with("transform", format!("translate(0 {CAPTION})"))
        .containing(inside);
    Element::group("frame").containing([caption, body]).to_text()
}

//! Animations of a path: one HTML page, every frame a solved equilibrium.

use geometry::OutOfRange;

use super::{CAPTION, FlexureDrawing, Frames, MARGIN, PunctureDrawing, WIDTH};
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

fn page(title: &str, frames: Frames) -> String {
    let height = CAPTION + frames.height + 0.5 * MARGIN;
    let drawn: Vec<_> =
        frames.states.into_iter().map(|(caption, body)| frame(&caption, body)).collect();
    PAGE.replace("{{title}}", &plain(title))
        .replace("{{width}}", &px(WIDTH))
        .replace("{{height}}", &px(height))
        .replace("{{last}}", &drawn.len().saturating_sub(1).to_string())
        .replace("{{frames}}", &drawn.join("\n"))
}

fn frame(caption: &str, body: Vec<Element>) -> String {
    let caption = label(caption, [MARGIN, 17.0], 14.0, Anchor::Start).with("fill", INK);
    let body = Element::group("body")
        .with("transform", format!("translate(0 {CAPTION})"))
        .containing(body);
    Element::group("frame").containing([caption, body]).to_text()
}

//! Drawings of a design, to scale.

mod animation;
mod bodies;
mod contacts;
mod row;
mod scale_bar;
mod strip;
mod surface;
mod view;

pub use bodies::overlaps;
pub use row::PunctureDrawing;
pub use strip::FlexureDrawing;

use skin::{Contact, Design};
use sweep::Case;
use text::number;

use crate::colors::INK;
use crate::label::{Anchor, label, plain, width};
use crate::svg::{Element, document, heading};

/// Width of a drawing, px.
const WIDTH: f64 = 960.0;
/// The margin around a drawing, px.
const MARGIN: f64 = 24.0;
/// Height of the title, px.
const HEAD: f64 = 40.0;
/// Height of the caption above a panel, px.
const CAPTION: f64 = 26.0;

/// A panel of a drawing. Its coordinates start at the upper left corner of the panel.
struct DrawingPanel {
    height: f64,
    caption: String,
    inside: Vec<Element>,
}

/// Returns a drawing with a title and `panels` below each other.
fn stacked(title: &str, panels: Vec<DrawingPanel>) -> String {
    let mut inside = vec![heading(label(title, [MARGIN, 28.0], 16.0, Anchor::Start))];
    let mut top = HEAD;
    for (k, panel) in panels.into_iter().enumerate() {
        let height = panel.height;
        inside.push(placed(panel, top, k));
        top += CAPTION + height;
    }
    document(WIDTH, top + 0.5 * MARGIN, &plain(title), inside)
}

/// Returns a panel with its letter and caption, moved down to `top`.
fn placed(DrawingPanel { caption, inside, .. }: DrawingPanel, top: f64, number: usize) -> Element {
    let letter = char::from(b'a' + u8::try_from(number % 26).unwrap_or(0));
    let text = format!("({letter})  {caption}");
    // A long caption is set in a smaller font.
    let size = (13.0 * (WIDTH - 2.0 * MARGIN) / width(&text, 13.0)).min(13.0);
    let caption = label(&text, [MARGIN, 17.0], size, Anchor::Start).with("fill", INK);
    let body = Element::group("body")
        .with("transform", format!("translate(0 {CAPTION})"))
        .containing(inside);
    Element::group("panel")
        .with("transform", format!("translate(0 {top})"))
        .containing([caption, body])
}

/// Formats the geometry of a case for labels, in mm if its thickness is known.
pub fn geometry_label(case: &Case) -> String {
    let Design { gap, length, slant_deg, .. } = case.design;
    let thickness = case.material.thickness_mm;
    let unit = thickness.unwrap_or(1.0);
    // Round the values, because designs found by a search have 16 digits.
    let [gap, length, slant, unit] =
        [gap * unit, length * unit, slant_deg, unit].map(|value| number::rounded(value, 6));
    match thickness {
        Some(_) => format!("$d$ = {gap} mm, $L$ = {length} mm, $t$ = {unit} mm, $α$ = {slant}°"),
        None => format!("$d/t$ = {gap}, $L/t$ = {length}, $α$ = {slant}°"),
    }
}

/// Describes contacts in words: their number, and how many slip.
fn contacts_label(contacts: &[Contact]) -> String {
    let count = match contacts.len() {
        0 => return "no contact".to_owned(),
        1 => "1 contact".to_owned(),
        count => format!("{count} contacts"),
    };
    // Without friction, contacts neither stick nor slip.
    match contacts.iter().filter(|contact| contact.slips == Some(true)).count() {
        _ if contacts.iter().all(|contact| contact.slips.is_none()) => count,
        0 => format!("{count}, all stick"),
        slip => format!("{count}, {slip} slip (rings)"),
    }
}

//! Elements of an SVG drawing.

use std::fmt::Write as _;

use crate::colors::INK;

/// Fonts of all drawings: the embedded font, then replacements of about the same widths.
const FONTS: &str = "Liberation Sans, Arial, Helvetica, sans-serif";

/// A point on paper, px: x to the right, y down.
pub(crate) type Spot = [f64; 2];

/// An SVG element with attributes, text and child elements.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    text: Option<String>,
    inside: Vec<Element>,
}

impl Element {
    pub(crate) fn new(name: &'static str) -> Self {
        Self { name, attributes: Vec::new(), text: None, inside: Vec::new() }
    }

    /// Creates a group with a class that names its content.
    pub(crate) fn group(class: &str) -> Self {
        Self::new("g").with("class", class)
    }

    pub(crate) fn with(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.attributes.push((name, value.into()));
        self
    }

    /// Adds an attribute with a value in px, rounded to 0.01 px.
    pub(crate) fn at(self, name: &'static str, value: f64) -> Self {
        self.with(name, px(value))
    }

    pub(crate) fn add(&mut self, element: Self) {
        self.inside.push(element);
    }

    pub(crate) fn containing(mut self, elements: impl IntoIterator<Item = Self>) -> Self {
        self.inside.extend(elements);
        self
    }

    pub(crate) fn text(mut self, text: &str) -> Self {
        self.text = Some(text.to_owned());
        self
    }

    fn write(&self, out: &mut String, depth: usize) {
        let _ = write!(out, "<{}", self.name);
        for (name, value) in &self.attributes {
            let _ = write!(out, " {name}=\"");
            push_escaped(out, value);
            out.push('"');
        }
        if self.inside.is_empty() && self.text.is_none() {
            out.push_str("/>");
            return;
        }
        out.push('>');
        push_escaped(out, self.text.as_deref().unwrap_or_default());
        // White space inside a text element would be visible.
        let lines = self.name != "text" && !self.inside.is_empty();
        for element in &self.inside {
            if lines {
                new_line(out, depth + 1);
            }
            element.write(out, depth + 1);
        }
        if lines {
            new_line(out, depth);
        }
        let _ = write!(out, "</{}>", self.name);
    }

    /// Returns the element as text.
    pub(crate) fn to_text(&self) -> String {
        let mut out = String::new();
        self.write(&mut out, 0);
        out
    }
}

fn new_line(out: &mut String, depth: usize) {
    out.push('\n');
    out.extend(std::iter::repeat_n(' ', depth));
}

/// Appends `text` to `out`, with the special characters of XML escaped.
fn push_escaped(out: &mut String, mut text: &str) {
    while let Some(at) = text.bytes().position(|byte| matches!(byte, b'&' | b'<' | b'>' | b'"')) {
        out.push_str(&text[..at]);
        out.push_str(match text.as_bytes()[at] {
            b'&' => "&amp;",
            b'<' => "&lt;",
            b'>' => "&gt;",
            _ => "&quot;",
        });
        text = &text[at + 1..];
    }
    out.push_str(text);
}

/// Formats a coordinate to a hundredth of a pixel.
pub(crate) fn px(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    // Adding zero replaces −0 by 0.
    (rounded + 0.0).to_string()
}

/// Returns a complete drawing of `width` by `height` px on white paper.
pub(crate) fn document(width: f64, height: f64, title: &str, inside: Vec<Element>) -> String {
    let paper = Element::new("rect").at("width", width).at("height", height).with("fill", "#fff");
    let root = Element::new("svg")
        .with("xmlns", "http://www.w3.org/2000/svg")
        .at("width", width)
        .at("height", height)
        .with("viewBox", format!("0 0 {} {}", px(width), px(height)))
        .with("font-family", FONTS)
        .with("role", "img")
        .containing([Element::new("title").text(title), paper])
        .containing(inside);
    format!("{}\n", root.to_text())
}

/// Height of the title of a drawing, px.
const TITLE: f64 = 32.0;

/// Formats a text element as the title of a drawing, with a class by which [`untitled`] finds it.
pub(crate) fn heading(title: Element) -> Element {
    title.with("class", "title").with("fill", INK).with("font-weight", "bold")
}

/// Returns a drawing without its title and without the height of the title.
///
/// A drawing without a title is returned unchanged.
pub fn untitled(svg: &str) -> String {
    without_title(svg).unwrap_or_else(|| svg.to_owned())
}

fn without_title(svg: &str) -> Option<String> {
    let (before, rest) = svg.split_once("class=\"title\"")?;
    let (before, _) = before.rsplit_once("<text")?;
    let (_, after) = rest.split_once("</text>")?;
    let (start, size) = before.split_once("viewBox=\"0 0 ")?;
    let (size, end) = size.split_once('"')?;
    let (width, height) = size.split_once(' ')?;
    let lower = px(height.parse::<f64>().ok()? - TITLE);
    let start = start.replacen(&format!("height=\"{height}\""), &format!("height=\"{lower}\""), 1);
    // The SVG element `title` is kept for screen readers.
    Some(format!("{start}viewBox=\"0 {TITLE} {width} {lower}\"{}{}", end, after.trim_start()))
}

/// Returns a drawing scaled to a printed width of `width` mm.
pub fn resized(svg: &str, width: f64) -> String {
    in_millimetres(svg, width).unwrap_or_else(|| svg.to_owned())
}

fn in_millimetres(svg: &str, width: f64) -> Option<String> {
    // The root element is first, so the first width and height belong to the drawing.
    let (start, rest) = svg.split_once(" width=\"")?;
    let (across, rest) = rest.split_once("\" height=\"")?;
    let (down, rest) = rest.split_once('"')?;
    let height = px(width * down.parse::<f64>().ok()? / across.parse::<f64>().ok()?);
    let width = px(width);
    Some(format!("{start} width=\"{width}mm\" height=\"{height}mm\"{rest}"))
}

/// Returns the smallest font size of a drawing printed `width` mm wide, in points.
///
/// Subscripts and superscripts do not count. `None` if the drawing has no text.
pub fn smallest_letters(svg: &str, width: f64) -> Option<f64> {
    let per_unit = POINTS_PER_MM * width / attribute(svg, " width=\"")?;
    let texts = svg.split("<text").skip(1).filter_map(|text| text.split_once('>'));
    let sizes = texts.filter_map(|(text, _)| attribute(text, "font-size=\""));
    sizes.map(|size| size * per_unit).min_by(f64::total_cmp)
}

/// Returns the number between `start`, such as `width="`, and the next quotation mark.
fn attribute(text: &str, start: &str) -> Option<f64> {
    text.split_once(start)?.1.split_once('"')?.0.parse().ok()
}

/// Typographic points per millimetre.
const POINTS_PER_MM: f64 = 72.0 / 25.4;

/// Returns the attribute `d` of an SVG path through `points`; `text` formats the coordinates.
pub(crate) fn path_data(points: &[Spot], closed: bool, text: fn(f64) -> String) -> String {
    let corners = points.iter().map(|[x, y]| format!("{} {}", text(*x), text(*y)));
    let line = corners.collect::<Vec<_>>().join(" L");
    let start = if points.is_empty() { "" } else { "M" };
    format!("{start}{line}{}", if closed { " Z" } else { "" })
}

pub(crate) fn rect([x, y]: Spot, [width, height]: [f64; 2]) -> Element {
    Element::new("rect").at("x", x).at("y", y).at("width", width).at("height", height)
}

pub(crate) fn polygon(points: &[Spot]) -> Element {
    Element::new("path").with("d", path_data(points, true, px))
}

pub(crate) fn polyline(points: &[Spot]) -> Element {
    Element::new("path").with("d", path_data(points, false, px)).with("fill", "none")
}

pub(crate) fn line(from: Spot, to: Spot, stroke: &str, width: f64) -> Element {
    Element::new("line")
        .at("x1", from[0])
        .at("y1", from[1])
        .at("x2", to[0])
        .at("y2", to[1])
        .with("stroke", stroke)
        .at("stroke-width", width)
}

pub(crate) fn circle(center: Spot, radius: f64) -> Element {
    Element::new("circle").at("cx", center[0]).at("cy", center[1]).at("r", radius)
}

/// Draws an arrow with its head at `to`. A short arrow has a smaller head.
pub(crate) fn arrow(from: Spot, to: Spot, color: &str, width: f64) -> Element {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let length = dx.hypot(dy);
    let head = (4.5 * width).min(0.7 * length);
    // Arrows have a positive length, so the direction is defined.
    let (along, across) = ([dx / length, dy / length], [-dy / length, dx / length]);
    // Distance of each point from the tip, in lengths of the head, and from the axis of the arrow,
    // in half-widths of the head.
    let corners = [(0.8, 0.0), (1.0, 1.0), (0.75, 0.0), (1.0, -1.0)];
    let [end, left, notch, right] = corners.map(|(back, side)| {
        [0, 1].map(|k| to[k] - back * head * along[k] + side * 0.42 * head * across[k])
    });
    let shaft = line(from, end, color, width);
    let head = polygon(&[to, left, notch, right]).with("fill", color);
    Element::group("arrow").containing([shaft, head])
}

#[cfg(test)]
mod tests {
    use super::{Element, document, heading, resized, untitled};

    #[test]
    fn untitled_drawings_lose_the_height_of_the_title() {
        let title = heading(Element::new("text").at("x", 20.0).text("a < b"));
        let svg = document(300.0, 200.0, "a < b", vec![title, Element::group("rest")]);
        let bare = untitled(&svg);
        assert!(bare.contains("height=\"168\" viewBox=\"0 32 300 168\""), "{bare}");
        assert!(!bare.contains("<text") && bare.contains("<g class=\"rest\"/>"), "{bare}");
        assert!(bare.contains("<title>a &lt; b</title>"), "screen readers read the title: {bare}");
        assert_eq!(untitled(&bare), bare);
        let printed = resized(&bare, 85.0);
        assert!(printed.contains(" width=\"85mm\" height=\""), "{printed}");
        assert!(printed.contains("viewBox=\"0 32 "), "{printed}");
    }
}

//! Labels with symbols: a small part of TeX's notation.

use crate::svg::{Element, Spot};

/// Where a label is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// A run of characters of one kind.
#[derive(Clone, Debug, Default, PartialEq)]
struct Run {
    text: String,
    italic: bool,
    /// -1 below, 1 above the line.
    level: i8,
}

/// The runs of `source`, in which `$` begins and ends italics, and `_x`, `^x`, `_{xy}`, `^{xy}` stand
/// below and above the line.
fn runs(source: &str) -> Vec<Run> {
    let mut runs = vec![Run::default()];
    let (mut italic, mut level) = (false, 0);
    let mut braced = false;
    for c in source.chars() {
        match c {
            '$' => italic = !italic,
            '_' if !braced => level = -1,
            '^' if !braced => level = 1,
            '{' if level != 0 => braced = true,
            '}' if braced => (braced, level) = (false, 0),
            c => {
                push(&mut runs, c, italic && level == 0, level);
                if !braced {
                    level = 0;
                }
            }
        }
    }
    runs.retain(|run| !run.text.is_empty());
    runs
}

fn push(runs: &mut Vec<Run>, c: char, italic: bool, level: i8) {
    match runs.last_mut() {
        Some(run) if run.italic == italic && run.level == level => run.text.push(c),
        _ => runs.push(Run { text: c.to_string(), italic, level }),
    }
}

/// The characters of `source` alone.
pub(crate) fn plain(source: &str) -> String {
    runs(source).into_iter().map(|run| run.text).collect()
}

/// About the width of `source`, px.
pub(crate) fn width(source: &str, size: f64) -> f64 {
    let run = |run: Run| run.text.chars().count() as f64 * if run.level == 0 { 0.53 } else { 0.38 };
    runs(source).into_iter().map(run).sum::<f64>() * size
}

/// `source` as an SVG text at `spot`.
pub(crate) fn label(source: &str, [x, y]: Spot, size: f64, anchor: Anchor) -> Element {
    let mut text = Element::new("text").at("x", x).at("y", y).at("font-size", size);
    match anchor {
        Anchor::Start => {}
        Anchor::Middle => text = text.with("text-anchor", "middle"),
        Anchor::End => text = text.with("text-anchor", "end"),
    }
    let mut height = 0.0;
    for run in runs(source) {
        let target = f64::from(run.level) * if run.level > 0 { 0.36 } else { 0.22 } * size;
        let mut span = Element::new("tspan");
        if run.italic {
            span = span.with("font-style", "italic");
        }
        if run.level != 0 {
            span = span.at("font-size", 0.7 * size);
        }
        if target != height {
            span = span.at("dy", height - target);
            height = target;
        }
        text.add(span.text(&run.text));
    }
    text
}

/// `source` turned to be read from the right.
pub(crate) fn upright(source: &str, spot: Spot, size: f64) -> Element {
    let turn = format!("rotate(-90 {} {})", crate::svg::px(spot[0]), crate::svg::px(spot[1]));
    label(source, spot, size, Anchor::Middle).with("transform", turn)
}

#[cfg(test)]
mod tests {
    use super::{Anchor, label, plain};

    #[test]
    fn symbols_keep_their_place() {
        assert_eq!(plain("$F_c^*$, dimensionless"), "Fc*, dimensionless");
        let text = label("$F_{ct}^*$ x", [0.0, 0.0], 10.0, Anchor::Start).to_text();
        assert_eq!(
            text,
            "<text x=\"0\" y=\"0\" font-size=\"10\"><tspan font-style=\"italic\">F</tspan>\
             <tspan font-size=\"7\" dy=\"2.2\">ct</tspan><tspan font-size=\"7\" dy=\"-5.8\">*</tspan>\
             <tspan dy=\"3.6\"> x</tspan></text>"
        );
    }
}

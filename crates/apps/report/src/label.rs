//! Labels with symbols, in a small part of TeX's notation.

use crate::svg::{Element, Spot};

/// The point of a label that is placed at the position of the label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// A run of characters of one style.
#[derive(Clone, Debug, Default, PartialEq)]
struct TextRun {
    text: String,
    italic: bool,
    /// Vertical level: -1 subscript, 0 baseline, 1 superscript.
    level: i8,
}

/// Splits `source` into runs of one style.
///
/// `$` toggles italics; `_x`, `^x`, `_{xy}`, `^{xy}` are sub- and superscripts.
fn runs(source: &str) -> Vec<TextRun> {
    let mut runs = vec![TextRun::default()];
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
                let italic = italic && level == 0;
                match runs.last_mut() {
                    Some(run) if run.italic == italic && run.level == level => run.text.push(c),
                    _ => runs.push(TextRun { text: c.to_string(), italic, level }),
                }
                if !braced {
                    level = 0;
                }
            }
        }
    }
    runs.retain(|run| !run.text.is_empty());
    runs
}

/// Returns the text of `source` without markup.
pub(crate) fn plain(source: &str) -> String {
    runs(source).into_iter().map(|run| run.text).collect()
}

/// Returns the approximate width of `source` at the font size `size`, px.
pub(crate) fn width(source: &str, size: f64) -> f64 {
    let run =
        |run: TextRun| run.text.chars().count() as f64 * if run.level == 0 { 0.53 } else { 0.38 };
    runs(source).into_iter().map(run).sum::<f64>() * size
}

/// Returns the font size, at most `size`, at which `source` fits into `room` px.
pub(crate) fn fitting(source: &str, size: f64, room: f64) -> f64 {
    let full = width(source, size);
    if full > room { size * room / full } else { size }
}

/// Splits `source` at spaces into lines of at most `room` px, at the font size `size`.
///
/// A word that is longer than `room` has a line of its own.
pub(crate) fn wrapped(source: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in source.split(' ').filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}"), size) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Returns `source` as an SVG text at `(x, y)`.
pub(crate) fn label(source: &str, [x, y]: Spot, size: f64, anchor: Anchor) -> Element {
    let mut text = Element::new("text").at("x", x).at("y", y).at("font-size", size);
    match anchor {
        Anchor::Start => {}
        Anchor::Middle => text = text.with("text-anchor", "middle"),
        Anchor::End => text = text.with("text-anchor", "end"),
    }
    let runs = runs(source);
    if runs.len() > 1 {
        // Without this attribute, some renderers drop spaces at the ends of runs.
        text = text.with("xml:space", "preserve");
    }
    let mut height = 0.0;
    for run in runs {
        let target = f64::from(run.level) * if run.level > 0 { 0.36 } else { 0.22 } * size;
        let mut span = Element::new("tspan");
        if run.italic {
            span = span.with("font-style", "italic");
        }
        if run.level != 0 {
            span = span.at("font-size", 0.7 * size);
        }
        if target != height {
            // `dy` is relative to the previous run, not to the baseline.
            span = span.at("dy", height - target);
            height = target;
        }
        text.add(span.text(&run.text));
    }
    text
}

/// Returns `source` as an SVG text rotated by 90°, reading upwards.
pub(crate) fn upright(source: &str, spot: Spot, size: f64) -> Element {
    let turn = format!("rotate(-90 {} {})", crate::svg::px(spot[0]), crate::svg::px(spot[1]));
    label(source, spot, size, Anchor::Middle).with("transform", turn)
}

#[cfg(test)]
mod tests {
    use super::{Anchor, label, plain, width, wrapped};

    #[test]
    fn wrapped_lines_fit_and_keep_all_words() {
        let text = "× a contact closes;  ○ the surface folds over;  fine dots: unstable";
        let lines = wrapped(text, 12.0, 150.0);
        assert!(
            lines.len() > 2 && lines.iter().all(|line| width(line, 12.0) <= 150.0),
            "{lines:?}"
        );
        assert_eq!(lines.join(" ").split(' ').count(), text.split_whitespace().count());
    }

    #[test]
    fn svg_labels_keep_subscripts_superscripts_and_spaces() {
        assert_eq!(plain("$F_c^*$, dimensionless"), "Fc*, dimensionless");
        let text = label("$F_{ct}^*$ x", [0.0, 0.0], 10.0, Anchor::Start).to_text();
        assert_eq!(
            text,
            "<text x=\"0\" y=\"0\" font-size=\"10\" xml:space=\"preserve\"><tspan font-style=\"italic\">F</tspan>\
             <tspan font-size=\"7\" dy=\"2.2\">ct</tspan><tspan font-size=\"7\" dy=\"-5.8\">*</tspan>\
             <tspan dy=\"3.6\"> x</tspan></text>"
        );
    }
}

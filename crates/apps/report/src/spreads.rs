//! Figures of tolerances: histograms of samples, and contributions to a variance.

use crate::axis::{ChartAxis, ends};
use crate::chart::{Area, ChartPanel};
use crate::colors::{INK, RED, map_color};
use crate::figures::names::axis_label;
use crate::figures::{name_with_unit, sheet};
use crate::label::{Anchor, fitting, label, width};
use crate::svg::{Element, Spot, line, rect};

const WIDTH: f64 = 760.0;
const HISTOGRAM_HEIGHT: f64 = 420.0;

/// Minimum and maximum number of bars of a histogram.
const BARS: [usize; 2] = [8, 40];

/// A histogram of the samples of a measure, with the nominal value and bounds.
#[derive(Clone, Copy, Debug)]
pub struct Histogram<'a> {
    /// Name of the design.
    pub name: &'a str,
    /// Column name of the measure.
    pub measure: &'a str,
    /// The samples, at least one.
    pub values: &'a [f64],
    /// Value of the measure for the nominal design, without deviations.
    pub nominal: Option<f64>,
    /// Text, such as `≥ 2`, and value of each bound.
    pub bounds: &'a [(String, f64)],
}

impl Histogram<'_> {
    /// Draws the histogram, with red lines at the bounds and a dark line at the nominal value.
    pub fn svg(&self) -> String {
        let shown = self.values.iter().copied().chain(self.nominal);
        // The axis includes bounds beyond all samples, to show their distance from the samples.
        let (low, high) = ends(shown.chain(self.bounds.iter().map(|(_, at)| *at)));
        let x = ChartAxis::linear(&axis_label(self.measure), low, high);
        let bars = self.bars();
        let y = ChartAxis::spanning("samples", bars.iter().map(|(.., count)| *count));
        let height = HISTOGRAM_HEIGHT - 150.0;
        let area = Area { left: 74.0, top: 90.0, width: WIDTH - 110.0, height };
        let panel = ChartPanel::new(area, &x, &y);
        let mut inside = panel.axes(52.0).to_vec();
        inside.extend(bars.iter().filter_map(|bar| Self::bar(&panel, *bar)));
        inside.extend(self.nominal.and_then(|at| marked(&panel, "nominal", at, INK, 0.0)));
        let bounds = self.bounds.iter().enumerate();
        inside.extend(
            // The text of each bound has its own line, because bounds may be close together.
            bounds.filter_map(|(k, (text, at))| {
                marked(&panel, text, *at, RED, 14.0 * (k + 1) as f64)
            }),
        );
        let title = format!("{}: {} samples", self.name, self.values.len());
        sheet(WIDTH, HISTOGRAM_HEIGHT, &title, inside)
    }

    /// Returns lower end, upper end and number of samples of each bar.
    fn bars(&self) -> Vec<(f64, f64, f64)> {
        let (low, high) = ends(self.values.iter().copied());
        // More bars than the square root of the number of samples would show only noise.
        let count = ((self.values.len() as f64).sqrt() as usize).clamp(BARS[0], BARS[1]);
        let step = (high - low) / count as f64;
        let mut counts = vec![0.0; count];
        for value in self.values {
            // If all values are equal, 0/0 is cast to the first bar.
            let bar = ((value - low) / step) as usize;
            counts[bar.min(count - 1)] += 1.0;
        }
        counts
            .into_iter()
            .enumerate()
            .map(|(k, count)| (low + k as f64 * step, low + (k + 1) as f64 * step, count))
            .collect()
    }

    fn bar(panel: &ChartPanel<'_>, (from, to, count): (f64, f64, f64)) -> Option<Element> {
        let ([left, top], [right, bottom]) = (panel.place(from, count)?, panel.place(to, 0.0)?);
        let size = [(right - left - 1.0).max(1.0), bottom - top];
        Some(rect([left, top], size).with("fill", map_color(0.45)))
    }
}

/// Draws a vertical line at the value `at`, with a text above the panel.
///
/// A larger `above`, in px, extends the line and raises the text.
fn marked(
    panel: &ChartPanel<'_>,
    text: &str,
    at: f64,
    color: &'static str,
    above: f64,
) -> Option<Element> {
    let [x, bottom] = panel.place(at, 0.0)?;
    let top = panel.area.top;
    let is_right = x > panel.area.center()[0];
    let anchor = if is_right { Anchor::End } else { Anchor::Start };
    let text = label(text, [x, top - 8.0 - above], 12.0, anchor).with("fill", color);
    Some(
        Element::group("mark")
            .containing([line([x, top - 4.0 - above], [x, bottom], color, 1.6), text]),
    )
}

/// A measure, and the sources of its variance, each with its fraction of the variance.
pub type Shares = (String, Vec<(String, f64)>);

/// Height of the row of a measure, px.
const ROW: f64 = 30.0;
/// Width of the names of the measures, px.
const NAMES: f64 = 230.0;

/// Draws a bar for each measure, divided by the contributions of the sources to the variance.
pub fn share_bars(name: &str, measures: &[Shares]) -> String {
    let mut sources: Vec<&str> = Vec::new();
    for (source, _) in measures.iter().flat_map(|(_, shares)| shares) {
        if !sources.contains(&source.as_str()) {
            sources.push(source);
        }
    }
    let mut inside: Vec<Element> =
        sources.iter().enumerate().flat_map(|(k, source)| legend(k, source, &sources)).collect();
    let top = 62.0 + 18.0 * sources.len().div_ceil(2) as f64;
    for (row, (measure, shares)) in measures.iter().enumerate() {
        let y = top + ROW * row as f64;
        let name = name_with_unit(measure);
        let size = fitting(&name, 12.0, NAMES - 20.0);
        let name = label(&name, [NAMES - 8.0, y + 16.0], size, Anchor::End);
        inside.push(name.with("fill", INK));
        inside.extend(parts(shares, &sources, y));
    }
    let title = format!("{name}: sources of the spread, as fractions of the variance");
    sheet(WIDTH, top + ROW * measures.len() as f64 + 16.0, &title, inside)
}

/// Draws the legend of source `k`: its colour and name.
fn legend(k: usize, source: &str, sources: &[&str]) -> [Element; 2] {
    let [x, y] = [24.0 + 360.0 * (k % 2) as f64, 50.0 + 18.0 * (k / 2) as f64];
    let (parameter, level) = source.split_once(' ').unwrap_or((source, ""));
    let name = format!("{} {level}", name_with_unit(parameter));
    let name = label(name.trim_end(), [x + 18.0, y + 2.0], 12.0, Anchor::Start);
    [block([x, y - 9.0], [12.0, 12.0], &color(k, sources)), name.with("fill", INK)]
}

fn color(k: usize, sources: &[&str]) -> String {
    map_color((k as f64 + 0.5) / sources.len() as f64)
}

/// Draws the parts of one bar, from the left.
fn parts(shares: &[(String, f64)], sources: &[&str], y: f64) -> Vec<Element> {
    let full = WIDTH - NAMES - 24.0;
    let (mut left, mut drawn) = (NAMES, Vec::new());
    for (k, source) in sources.iter().enumerate() {
        let share = shares.iter().find(|(of, _)| of == source).map_or(0.0, |(_, share)| *share);
        let wide = full * share;
        drawn.push(block([left, y], [wide, ROW - 8.0], &color(k, sources)));
        let text = format!("{:.0} %", 100.0 * share);
        if width(&text, 12.0) + 8.0 < wide {
            drawn.push(on_bar(&text, [left + 0.5 * wide, y + 15.0]));
        }
        left += wide;
    }
    drawn
}

fn block(at: Spot, size: [f64; 2], color: &str) -> Element {
    rect(at, size).with("fill", color).with("stroke", "#fff").at("stroke-width", 0.8)
}

/// Draws a text that is legible on bars of any colour.
fn on_bar(text: &str, at: [f64; 2]) -> Element {
    let text = label(text, at, 12.0, Anchor::Middle).with("fill", INK);
    text.with("stroke", "#fff").at("stroke-width", 3.0).with("paint-order", "stroke")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sample_is_counted_in_one_bar() {
        let values: Vec<f64> = (0..100).map(|k| f64::from(k).sqrt()).collect();
        let [bars, equal] = [&values[..], &[2.0; 3]].map(|values| {
            let histogram =
                Histogram { name: "x", measure: "y", values, nominal: None, bounds: &[] };
            histogram.bars()
        });
        assert_eq!((bars.len(), bars.iter().map(|(.., count)| count).sum::<f64>()), (10, 100.0));
        // The first of ten bars covers a tenth of the range, which contains only the sample 0.
        assert_eq!((bars[0].0, bars[0].2), (0.0, 1.0));
        assert_eq!(equal.iter().map(|(.., count)| count).sum::<f64>(), 3.0);
    }

    #[test]
    fn variance_bars_state_the_fractions_and_the_sources() {
        let shares = vec![("gap_mm".to_owned(), 0.75), ("slant_deg".to_owned(), 0.25)];
        let svg = share_bars("x", &[("force".to_owned(), shares)]);
        for text in ["75 %", "25 %", "gap (mm)", "slant (°)"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
    }
}

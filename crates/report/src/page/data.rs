//! The data of a page, as its scripts read them.

use results::columns::{FOLD_FORCE, GAP_STRETCH_MIN, Goal, Shown, plain_goal, shown};
use results::shell_word;
use results::yardsticks;
use serde_json::{Map, Value, json};
use sweep::visible;

use super::simplified::simplified;
use super::{Fact, GapFactors, Page, PageDesign};
use crate::axis::ChartAxis;
use crate::designs::Designs;
use crate::palette::{SlantPalette, map_color};

/// Colours of the scale of a map.
const SHADES: u32 = 64;
/// Digits of the points of curves.
const DIGITS: usize = 4;
/// The highest value of a curve over the lowest that a logarithmic axis shows of it.
const LOWEST: f64 = 1000.0;
/// Labelled ticks of a logarithmic axis of curves, about: charts show a part of it.
const LOG_TICKS: usize = 12;

/// Returns the data of a page.
pub(super) fn of(page: &Page) -> Value {
    let headers = page.designs.headers();
    let columns = headers.iter().zip(&page.columns);
    let varied = page.designs.varied();
    let measured_by = |name: &str| -> Vec<_> {
        yardsticks(name).into_iter().filter(|parameter| varied.contains(parameter)).collect()
    };
    let column = |(name, (unit, meaning)): (&String, &(String, String))| json!({"name": name, "unit": unit, "meaning": meaning, "goal": plain_goal(name).map(Goal::key), "measuredBy": measured_by(name)});
    let fact = |(name, value): &Fact| json!({"name": name, "value": value});
    let shared = |[key, value, meaning]: &[String; 3]| json!({"key": key, "value": value, "meaning": meaning});
    let last = [shown(Shown::Then), shown(Shown::Last)].concat();
    let shade = |k: u32| map_color((f64::from(k) + 0.5) / f64::from(SHADES));
    json!({
        "name": visible(&page.name),
        "folder": shell_word(&page.folder),
        "opening": page.opening,
        "axes": page.axes,
        "axesOf": axes_of(page),
        "fold": FOLD_FORCE,
        "tightest": GAP_STRETCH_MIN,
        "shown": {"first": shown(Shown::First), "last": last},
        "columns": columns.map(column).collect::<Vec<_>>(),
        "values": headers.iter().map(|header| cells(&page.designs, header)).collect::<Vec<_>>(),
        "slants": slants(page.designs.values("slant_deg")),
        "shades": (0..SHADES).map(shade).collect::<Vec<_>>(),
        "run": page.run.iter().map(fact).collect::<Vec<_>>(),
        "shared": page.shared.iter().map(shared).collect::<Vec<_>>(),
        "drawings": page.solved.iter().map(solved).collect::<Vec<_>>(),
        "logarithmic": logarithmic(&page.solved),
        "found": page.front.as_ref().map(|front| front.to_json(&page.designs)),
    })
}

/// Returns the axis of each column that has a number.
fn axes_of(page: &Page) -> Map<String, Value> {
    let headers = page.designs.headers().iter();
    let numeric = headers.filter(|header| page.designs.has(header));
    numeric
        .map(|name| (name.clone(), ChartAxis::fit("", page.designs.numbers(name)).to_json()))
        .collect()
}

/// Returns the cells of a column, from the top.
pub(super) fn cells(designs: &Designs, header: &str) -> Vec<Value> {
    (0..designs.count()).map(|row| cell(designs, header, row)).collect()
}

/// Returns a cell as a number where it is one; the number of a design keeps its zeros.
fn cell(designs: &Designs, header: &str, row: usize) -> Value {
    let text = designs.text(header, row);
    match designs.number(header, row) {
        _ if text.is_empty() => Value::Null,
        Some(number) if header != "design" => json!(number),
        _ => json!(visible(text)),
    }
}

/// Returns the colour and the mark of each slant.
fn slants(values: Vec<f64>) -> Vec<Value> {
    let palette = SlantPalette::new(values.clone());
    let slant = |degrees: f64| {
        json!({
            "degrees": degrees,
            "color": palette.color(degrees),
            "path": palette.mark(degrees).path(),
        })
    };
    values.into_iter().map(slant).collect()
}

fn solved(design: &PageDesign) -> Value {
    let curves: Map<String, Value> = paths(design)
        .into_iter()
        .filter(|(_, points)| points.len() > 1)
        .map(|(measure, points)| (measure.to_owned(), curve(points)))
        .collect();
    let change =
        |GapFactors { column, factors }: &GapFactors| json!({"column": column, "factors": factors});
    let changes: Vec<_> = design.gap_factors.iter().map(change).collect();
    json!({"design": design.number, "svg": design.svg, "curves": curves, "gapFactors": changes})
}

/// The paths of a design, each by the name of what is measured.
fn paths(design: &PageDesign) -> [(&'static str, &Vec<[f64; 2]>); 2] {
    [("puncture", &design.puncture), ("flexure", &design.flexure)]
}

/// Returns a curve with axes that it fits on.
fn curve(points: &[[f64; 2]]) -> Value {
    let axis = |k: usize| ChartAxis::spanning("", points.iter().map(|point| point[k])).to_json();
    let short = |value: f64| format!("{value:.DIGITS$e}").parse().unwrap_or(value);
    let points: Vec<_> = simplified(points).into_iter().map(|point| point.map(short)).collect();
    json!({"points": points, "x": axis(0), "y": axis(1)})
}

/// Returns a logarithmic axis for the curves of each measure, on which every curve is seen where it is highest.
fn logarithmic(solved: &[PageDesign]) -> Map<String, Value> {
    let mut axes = Map::new();
    for (k, measure) in ["puncture", "flexure"].into_iter().enumerate() {
        let highest = solved.iter().filter_map(|design| {
            let highest = paths(design)[k].1.iter().map(|point| point[1]).fold(0.0, f64::max);
            (highest > 0.0).then_some(highest)
        });
        let highest: Vec<f64> = highest.collect();
        if highest.is_empty() {
            continue;
        }
        let (low, high) = crate::axis::ends(highest.into_iter());
        let axis = ChartAxis::logarithmic("", low / LOWEST, high);
        axes.insert(measure.to_owned(), axis.to_json_with(LOG_TICKS));
    }
    axes
}

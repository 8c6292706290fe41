//! The data of a page, in the format that its scripts read.

use std::collections::BTreeMap;
use std::io::{self, Write};

use ranking::{CRITERIA, Criterion};
use results::columns::{Goal, Shown, mode_column, name, plain_goal, shown};
use results::measurement_conditions;
use serde_json::{Value, json};
use text::shell_word;
use text::visible;

use super::{Page, PageDesign, PageFront};
use crate::designs::Designs;
use crate::figures::pareto::physical_axes;
use crate::figures::physical;
use crate::packed::write_packed;
use crate::palette::SlantPalette;

/// Writes the cells of the table: numeric columns as bytes, text columns as JSON.
///
/// In each numeric column, the first bytes of all numbers precede the second bytes of all numbers,
/// and so on. Similar bytes are then adjacent, and compress to half the size.
pub(super) fn write_packed_cells(out: &mut impl Write, designs: &Designs) -> io::Result<()> {
    let (mut numbers, mut texts) = (Vec::new(), BTreeMap::new());
    for header in designs.headers() {
        match designs.only_numbers(header) {
            Some(column) => {
                for byte in 0..size_of::<f64>() {
                    numbers.extend(column.iter().map(|number| number.to_le_bytes()[byte]));
                }
            }
            None => _ = texts.insert(header, cells(designs, header)),
        }
    }
    write_packed(out, "cells", &numbers)?;
    write_packed(out, "texts", serde_json::to_string(&texts)?.as_bytes())
}

/// Writes the drawings of the designs that were solved again.
pub(super) fn write_drawings(out: &mut impl Write, page: &Page) -> io::Result<()> {
    let mut drawn = page.solved.iter().filter(|design| !design.svg.is_empty());
    drawn.try_for_each(|design| write_packed(out, &drawing_id(design), design.svg.as_bytes()))
}

/// Returns the id of the HTML element that contains the drawing of a design.
fn drawing_id(design: &PageDesign) -> String {
    format!("solved-{}", design.number)
}

/// Returns the data of a page; `figures` are the descriptions of the figures already written.
pub(super) fn of(page: &Page, figures: &[Value]) -> Value {
    let headers = page.designs.headers();
    let columns = headers.iter().zip(&page.columns);
    let varied = page.designs.varied();
    let last = [shown(Shown::Then), shown(Shown::Last)].concat();
    json!({
        "name": visible(&page.name),
        "folder": shell_word(&page.folder),
        "opening": page.opening,
        "axes": page.axes,
        "measures": CRITERIA.each_ref().map(|criterion| &criterion.column),
        "inUnits": physical_columns(&page.designs),
        "criteria": page.criteria.iter().map(named_criterion).collect::<Vec<_>>(),
        "pareto": pareto_criteria(&page.designs),
        "fold": name::FOLD_FORCE,
        "tightest": name::GAP_STRETCH_MIN,
        "strain": name::MEMBRANE_STRAIN,
        "failureForce": name::FAILURE_FORCE,
        "modes": headers.iter().filter_map(|header| Some((header, mode_column(header)?))).collect::<BTreeMap<_, _>>(),
        "stiffnesses": [name::MAX_STIFFNESS, name::SECANT_STIFFNESS],
        "mass": name::AREAL_MASS,
        "shown": {"first": shown(Shown::First), "last": last},
        "numeric": headers.iter().filter(|header| page.designs.has(header)).collect::<Vec<_>>(),
        "columns": columns.map(|(name, (unit, meaning))| json!({
            "name": name, "unit": unit, "meaning": meaning, "goal": plain_goal(name).map(Goal::key),
            "measuredBy": measurement_conditions(name).into_iter()
                .filter(|parameter| varied.contains(parameter)).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "count": page.designs.count(),
        "slants": slants(page.designs.values("slant_deg")),
        "run": page.run,
        "notes": page.notes,
        "shared": page.shared,
        "drawings": page.solved.iter().map(solved).collect::<Vec<_>>(),
        "figures": figures,
        "found": page.front.as_ref().map(PageFront::to_json),
    })
}

/// Returns a criterion as JSON. Only the criteria of the paper have names.
fn named_criterion(criterion: &Criterion) -> Value {
    let name = CRITERIA.contains(criterion).then_some(&criterion.name);
    json!({"column": criterion.column, "goal": criterion.goal.key(), "name": name})
}

/// Returns the criteria on the axes of the Pareto fronts.
fn pareto_criteria(designs: &Designs) -> Vec<Value> {
    let criteria = physical_axes(designs).map(|axis| axis.criterion());
    criteria.iter().map(named_criterion).collect()
}

/// Returns the physical columns of the paper's measures and of the failure force.
fn physical_columns(designs: &Designs) -> BTreeMap<&str, String> {
    let measures = CRITERIA.iter().map(|criterion| criterion.column.as_ref());
    let columns = measures.chain([name::FAILURE_FORCE]);
    columns.filter_map(|column| Some((column, physical(designs, column)?))).collect()
}

/// Returns the cells of a column, from the top.
pub(super) fn cells(designs: &Designs, header: &str) -> Vec<Value> {
    (0..designs.count()).map(|row| cell(designs, header, row)).collect()
}

/// Returns a cell as a number if possible; design numbers stay text, to keep leading zeros.
pub(super) fn cell(designs: &Designs, header: &str, row: usize) -> Value {
    let text = designs.text(header, row);
    match designs.number(header, row) {
        _ if text.is_empty() => Value::Null,
        Some(number) if header != "design" => json!(number),
        _ => json!(visible(&text)),
    }
}

/// Returns the colour and the mark of each slant.
fn slants(values: Vec<f64>) -> Vec<Value> {
    let palette = SlantPalette::new(values.clone());
    values
        .into_iter()
        .map(|degrees| {
            json!({
                "degrees": degrees,
                "color": palette.color(degrees),
                "mark": palette.mark(degrees).name(),
            })
        })
        .collect()
}

fn solved(design: &PageDesign) -> Value {
    let has_curves = design.puncture.len() > 1 || design.flexure.len() > 1;
    let svg = if design.svg.is_empty() { String::new() } else { drawing_id(design) };
    json!({"design": design.number, "svg": svg, "curves": has_curves, "gapFactors": design.gap_factors})
}

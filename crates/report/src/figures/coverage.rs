//! Coverage over gap and aspect ratio, a map for each slant.

use super::{COVERAGE, columns, sheet};
use crate::chart::{Area, NAME};
use crate::designs::Designs;
use crate::label::{Anchor, label, upright};
use crate::palette::{FAINT, INK, map_color};
use crate::svg::{Element, line};

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 96.0;
const TOP: f64 = 66.0;
const BETWEEN: [f64; 2] = [16.0, 34.0];
const HEIGHT: f64 = 200.0;

pub(super) fn figure(name: &str, designs: &Designs) -> String {
    let slants = designs.values("slant_deg");
    let (gaps, lengths) = (designs.values("gap_over_t"), designs.values("length_over_t"));
    let columns = columns(slants.len());
    let rows = slants.len().div_ceil(columns);
    let width = (WIDTH - LEFT - RIGHT - BETWEEN[0] * (columns - 1) as f64) / columns as f64;
    let mut inside = Vec::new();
    for (k, &slant) in slants.iter().enumerate() {
        let (column, row) = (k % columns, k / columns);
        let area = Area {
            left: LEFT + column as f64 * (width + BETWEEN[0]),
            top: TOP + row as f64 * (HEIGHT + BETWEEN[1]),
            width,
            height: HEIGHT,
        };
        let map = Map { area, gaps: &gaps, lengths: &lengths };
        inside.push(map.cells(designs, slant));
        inside.push(map.frame(slant, k + columns >= slants.len(), column == 0));
    }
    let bottom = TOP + rows as f64 * (HEIGHT + BETWEEN[1]) - BETWEEN[1];
    let middle = 0.5 * (LEFT + WIDTH - RIGHT);
    let across = "aspect ratio $L/t$, dimensionless";
    inside.push(label(across, [middle, bottom + 38.0], NAME, Anchor::Middle).with("fill", INK));
    let up = "gap $d/t$, dimensionless";
    inside.push(upright(up, [20.0, 0.5 * (TOP + bottom)], NAME).with("fill", INK));
    inside.push(bar(bottom - TOP));
    let title = format!("{name}: coverage by gap, aspect ratio and slant");
    sheet(WIDTH, bottom + 54.0, &title, inside)
}

/// One map: a cell for each gap and aspect ratio.
struct Map<'a> {
    area: Area,
    gaps: &'a [f64],
    lengths: &'a [f64],
}

impl Map<'_> {
    fn cell(&self) -> [f64; 2] {
        [self.area.width / self.lengths.len() as f64, self.area.height / self.gaps.len() as f64]
    }

    fn cells(&self, designs: &Designs, slant: f64) -> Element {
        let [width, height] = self.cell();
        let cell = |row: usize| {
            (designs.number("slant_deg", row)? == slant).then_some(())?;
            let position = |values: &[f64], column| {
                let value = designs.number(column, row)?;
                values.iter().position(|&other| other == value)
            };
            let i = position(self.lengths, "length_over_t")?;
            let j = position(self.gaps, "gap_over_t")?;
            let value = designs.number(COVERAGE.column, row)?;
            let color = if value > 0.0 { map_color(value) } else { "#fff".to_owned() };
            // A hair wider than its place, so that no seam shows.
            let rect = Element::new("rect")
                .at("x", self.area.left + i as f64 * width)
                .at("y", self.area.bottom() - (j + 1) as f64 * height)
                .at("width", width + 0.3)
                .at("height", height + 0.3);
            Some(rect.with("fill", color))
        };
        Element::group("map").containing((0..designs.count()).filter_map(cell))
    }

    fn frame(&self, slant: f64, x_labels: bool, y_labels: bool) -> Element {
        let Area { left, top, width, height } = self.area;
        let border = Element::new("rect")
            .at("x", left)
            .at("y", top)
            .at("width", width)
            .at("height", height)
            .with("fill", "none")
            .with("stroke", FAINT);
        let title = format!("$α$ = {slant}°");
        let mut frame = Element::group("frame").containing([
            border,
            label(&title, [left + 0.5 * width, top - 7.0], 12.0, Anchor::Middle).with("fill", INK),
        ]);
        let [w, h] = self.cell();
        if x_labels {
            // Every label has room for five characters.
            let every = (34.0 / w).ceil() as usize;
            for (i, value) in self.lengths.iter().enumerate().step_by(every.max(1)) {
                let spot = [left + (i as f64 + 0.5) * w, top + height + 15.0];
                frame.add(label(&value.to_string(), spot, 11.0, Anchor::Middle).with("fill", INK));
            }
        }
        if y_labels {
            let every = (15.0 / h).ceil() as usize;
            for (j, value) in self.gaps.iter().enumerate().step_by(every.max(1)) {
                let spot = [left - 6.0, top + height - (j as f64 + 0.5) * h + 4.0];
                frame.add(label(&value.to_string(), spot, 11.0, Anchor::End).with("fill", INK));
            }
        }
        frame
    }
}

/// Returns the scale of colours.
fn bar(height: f64) -> Element {
    let (left, width, steps) = (WIDTH - RIGHT + 22.0, 16.0, 60);
    let step = height / f64::from(steps);
    let cells = (0..steps).map(|k| {
        Element::new("rect")
            .at("x", left)
            .at("y", TOP + height - f64::from(k + 1) * step)
            .at("width", width)
            .at("height", step + 0.3)
            .with("fill", map_color((f64::from(k) + 0.5) / f64::from(steps)))
    });
    let ticks = (0..=5).flat_map(|k| {
        let value = f64::from(k) / 5.0;
        let y = TOP + height * (1.0 - value);
        [
            line([left + width, y], [left + width + 4.0, y], FAINT, 0.8),
            label(&format!("{value:.1}"), [left + width + 7.0, y + 4.0], 11.0, Anchor::Start)
                .with("fill", INK),
        ]
    });
    let name = upright(
        "coverage $λ$, dimensionless; white: none",
        [WIDTH - 12.0, TOP + 0.5 * height],
        12.0,
    );
    Element::group("scale").containing(cells).containing(ticks).containing([name.with("fill", INK)])
}

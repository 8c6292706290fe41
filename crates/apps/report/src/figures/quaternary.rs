//! Figure of the best designs for all weights of the four criteria, like Fig. 13 of the paper.
//!
//! The weights form a tetrahedron, which is drawn in slices.

use geometry::{Parallelogram, Row};
use ranking::{RankedDesign, Ranking, Weights};

use super::names::with_value;
use super::weight_slices::{RegionLook, WeightSlices};
use super::{name_with_unit, of_perfect, sheet};
use crate::colors::{FAINT, INK, RED, shaded};
use crate::designs::Designs;
use crate::label::{Anchor, fitting, label};
use crate::paper::Paper;
use crate::svg::{Element, Spot, circle, line, polygon, rect};

const WIDTH: f64 = 1000.0;
/// Maximum number of listed winners on wide and on narrow paper.
const LISTED: [usize; 2] = [9, 4];
/// Height of an entry of the list, px.
const ENTRY: f64 = 58.0;
/// Width of paper below which the list of winners does not fit beside the slices, px.
const NARROW: f64 = 700.0;

/// Draws the slices, and the list of the designs that are best for the most weights.
pub(super) fn figure(name: &str, designs: &Designs, ranking: &Ranking<'_>, paper: Paper) -> String {
    let winners = ranking.winners();
    // The list is beside the slices, or below them on narrow paper.
    let is_narrow = paper.width(WIDTH) < NARROW;
    let full = if is_narrow { paper.width(WIDTH) } else { WIDTH };
    let listed = LISTED[usize::from(is_narrow)];
    let regions = regions(designs, &winners, listed);
    let weights = WeightSlices {
        resolution: ranking.grid().resolution(),
        winners: ranking
            .quaternary()
            .iter()
            .map(|best| (std::array::from_fn(|c| best.weights.values()[c]), best.row()))
            .collect(),
        size: if is_narrow { full / 610.0 } else { 1.0 },
    };
    let bottom = weights.bottom();
    let first = if is_narrow { [32.0, bottom + 50.0] } else { [604.0, 78.0] };
    let best: Vec<_> = Weights::alone().map(|alone| ranking.winner(alone).design()).collect();
    let mut inside = weights.drawn(designs, &regions, &best);
    inside.extend(regions.iter().zip(&winners).enumerate().map(|(k, (region, winner))| {
        let spot = [first[0], first[1] + ENTRY * k as f64];
        entry(designs, region, winner.share(), spot, full)
    }));
    if winners.len() > listed {
        let rest: f64 = winners[listed..].iter().map(RankedDesign::share).sum();
        let text = format!("{} more designs: {:.1} %", winners.len() - listed, 100.0 * rest);
        let spot = [first[0] - 8.0, first[1] + ENTRY * listed as f64];
        inside.push(label(&text, spot, 12.0, Anchor::Start).with("fill", FAINT));
    }
    let balanced =
        format!("best for equal weights: {}", ranking.winner(Weights::BALANCED).design());
    let spot = [20.0, 50.0];
    inside.push(label(&balanced, spot, 13.0, Anchor::Start).with("fill", INK));
    let title = format!(
        "{name}: the best design for every weighting of the four criteria{}",
        of_perfect(designs)
    );
    let last = first[1] + ENTRY * (listed.min(winners.len()) as f64 + 0.2);
    sheet(full, if is_narrow { last } else { bottom + 16.0 }, &title, inside)
}

/// Returns colour and letter of the regions of the first `listed` winners.
///
/// The slant of the winner determines the colour. Further winners of the same slant are lighter or
/// darker.
fn regions(designs: &Designs, winners: &[RankedDesign<'_>], listed: usize) -> Vec<RegionLook> {
    const SHADES: [f64; 6] = [0.0, 0.55, -0.45, 0.3, -0.25, 0.78];
    let palette = designs.palette();
    let mut slants: Vec<f64> = Vec::new();
    let mut regions = Vec::new();
    for (row, letter) in winners.iter().map(RankedDesign::row).take(listed).zip('A'..) {
        let slant = designs.number("slant_deg", row).unwrap_or(90.0);
        let before = slants.iter().filter(|other| **other == slant).count();
        let color = shaded(&palette.color(slant), SHADES[before % SHADES.len()]);
        regions.push(RegionLook { row, color, letter: letter.to_string() });
        slants.push(slant);
    }
    regions
}

fn badge(text: &str, [x, y]: Spot) -> Element {
    Element::group("letter").containing([
        circle([x, y], 9.0).with("fill", "#fff").with("stroke", INK),
        label(text, [x, y + 4.2], 12.0, Anchor::Middle).with("fill", INK),
    ])
}

/// Draws an entry of the list of best designs, left of `right`.
///
/// `share` is the fraction of the weights for which the design is best.
fn entry(designs: &Designs, region: &RegionLook, share: f64, [x, y]: Spot, right: f64) -> Element {
    let lengths = ["gap", "length"].map(|length| {
        let in_mm = format!("{length}_mm");
        let column = if designs.has(&in_mm) { in_mm } else { format!("{length}_over_t") };
        with_value(&(column.as_str(), designs.text(&column, region.row)))
    });
    let [design, slant] = ["design", "slant_deg"].map(|column| designs.text(column, region.row));
    let text = format!("{design}:  {},  $α$ = {slant}°", lengths.join(",  "));
    // Narrow paper has no space for the drawing of the row.
    let row = (right >= NARROW).then_some(right - 120.0);
    let room = row.unwrap_or(right) - x - 44.0;
    let share = format!("best for {:.1} % of the weights", 100.0 * share);
    let doubt = designs.folded(region.row).then(|| "surface folds".to_owned());
    let share = [share].into_iter().chain(doubt).collect::<Vec<_>>().join(",  ");
    let swatch = rect([x + 14.0, y - 9.0], [12.0, 18.0]).with("fill", region.color.as_str());
    let mut swatch = Element::group("swatch").containing([swatch]);
    if designs.folded(region.row) {
        swatch.add(line([x + 12.0, y + 11.0], [x + 28.0, y - 11.0], RED, 1.6));
    }
    let entry = Element::group("entry").containing([
        badge(&region.letter, [x, y]),
        swatch,
        label(&text, [x + 34.0, y - 2.0], fitting(&text, 12.5, room), Anchor::Start)
            .with("fill", INK),
        label(&share, [x + 34.0, y + 15.0], fitting(&share, 12.0, room), Anchor::Start)
            .with("fill", FAINT),
    ]);
    let entry = entry.containing(further(designs, region.row, [x + 34.0, y + 30.0], right));
    entry.containing(row.and_then(|row| small_row(designs, region.row, [row, y + 16.0])))
}

/// Draws the values of the parameters besides gap, aspect ratio and slant, for an entry.
///
/// A long text has a smaller font. `None` if there are no such parameters.
fn further(designs: &Designs, row: usize, spot: Spot, right: f64) -> Option<Element> {
    let axes = designs.further_axes().into_iter();
    let values = axes.map(|axis| format!("{} {}", name_with_unit(axis), designs.text(axis, row)));
    let text = values.collect::<Vec<_>>().join(",  ");
    let size = fitting(&text, 11.0, right - spot[0]);
    (!text.is_empty()).then(|| label(&text, spot, size, Anchor::Start).with("fill", FAINT))
}

/// Draws a few scales of the row of a design, to scale, in at most 100 by 30 px.
///
/// `None` if the table has no valid geometry of the design.
fn small_row(designs: &Designs, row: usize, [x, y]: Spot) -> Option<Element> {
    let lengths = ["length_over_t", "gap_over_t", "slant_deg"];
    let [length, gap, slant] = lengths.map(|column| designs.number(column, row));
    let base = if designs.text("base", row) == "2L" { 1.0 } else { 0.5 };
    let half = base * length?;
    let scale = Parallelogram::new(half, slant?).ok()?;
    let pitch = Row::new(scale, gap?).ok()?.pitch();
    let room = 100.0;
    let size = (room / (scale.shift() + 2.0 * half + (4.0 * pitch).max(1.0))).min(30.0);
    let free = room / size - scale.shift() - 2.0 * half;
    let count = ((free / pitch).floor() + 1.0).min(60.0);
    // The cast is exact, because `count` is a whole number of at most 60.
    let bodies =
        (0..count as usize).map(|i| {
            polygon(&scale.corners().map(|corner| {
                [x + size * (half + i as f64 * pitch + corner.x), y - size * corner.y]
            }))
        });
    Some(
        Element::group("row")
            .with("fill", "#d5dee6")
            .with("stroke", "#33414d")
            .at("stroke-width", 0.6)
            .containing(bodies),
    )
}

//! The best design for every weighting of the four criteria, in a tetrahedron of weights (Fig. 13).

use geometry::{Parallelogram, Row};
use ranking::{RankedDesign, Ranking, Weights};

use super::{in_words, sheet};
use crate::designs::Designs;
use crate::label::{Anchor, label};
use crate::palette::{FAINT, INK, shaded};
use crate::svg::{Element, Spot, circle, line, polygon};

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 640.0;
/// The number of winners that are listed: as many as fit on the sheet.
const LISTED: usize = 9;
/// The spot of the middle of the tetrahedron.
const CENTER: Spot = [302.0, 366.0];
/// The distance of a corner of the tetrahedron from its middle, px.
const SIZE: f64 = 262.0;

/// Corners of the tetrahedron: coverage, critical force, penetration resistance, compliance.
const CORNERS: [[f64; 3]; 4] = [
    [0.0, 1.0, 0.0],
    [0.0, -0.333_333_333_333_333_3, 0.942_809_041_582_063_4],
    [-0.816_496_580_927_726, -0.333_333_333_333_333_3, -0.471_404_520_791_031_7],
    [0.816_496_580_927_726, -0.333_333_333_333_333_3, -0.471_404_520_791_031_7],
];
const NAMES: [&str; 4] = [
    "coverage ($m$ = 1)",
    "critical force ($n$ = 1)",
    "penetration resistance ($k$ = 1)",
    "compliance ($l$ = 1)",
];

/// The weights for which one design is best.
struct Region {
    /// The row of the design.
    row: usize,
    /// The part of the weights for which it is best, from 0 to 1.
    share: f64,
}

pub(super) fn figure(name: &str, designs: &Designs, ranking: &Ranking<'_>) -> String {
    let region = |winner: &RankedDesign<'_>| Region { row: winner.row(), share: winner.share() };
    let regions: Vec<_> = ranking.winners().iter().map(region).collect();
    let dots = Dots {
        radius: 0.3 * SIZE * 1.63 / f64::from(ranking.grid().resolution().max(4)),
        winners: ranking
            .quaternary()
            .iter()
            .map(|best| (std::array::from_fn(|c| best.weights.values()[c]), best.row()))
            .collect(),
    };
    let mut inside = vec![edges(&[[1, 2], [1, 3], [2, 3]], "4 3")];
    inside.push(points(designs, &dots, &regions));
    inside.push(edges(&[[0, 1], [0, 2], [0, 3]], "none"));
    let best: Vec<_> = Weights::alone().map(|alone| ranking.winner(alone).design()).collect();
    inside.push(corner_names(&best));
    inside.push(letters(&dots, &regions));
    let colors = colors(designs, &regions);
    inside.extend(regions.iter().zip(&colors).enumerate().map(|(k, (region, color))| {
        entry(designs, region, color, &letter(k), [604.0, 78.0 + 58.0 * k as f64])
    }));
    if regions.len() > LISTED {
        let rest: f64 = regions[LISTED..].iter().map(|region| region.share).sum();
        let text = format!("{} more designs: {:.1} %", regions.len() - LISTED, 100.0 * rest);
        let spot = [596.0, 78.0 + 58.0 * LISTED as f64];
        inside.push(label(&text, spot, 12.0, Anchor::Start).with("fill", FAINT));
    }
    let balanced =
        format!("best for equal weights: {}", ranking.winner(Weights::BALANCED).design());
    let spot = [20.0, 50.0];
    inside.push(label(&balanced, spot, 13.0, Anchor::Start).with("fill", INK));
    let title = format!("{name}: the best design for every weighting of the four criteria");
    sheet(WIDTH, HEIGHT, &title, inside)
}

/// A dot for every weight of a grid.
struct Dots {
    radius: f64,
    /// The weights, and the row of the design that is best for them.
    winners: Vec<([f64; 4], usize)>,
}

/// Returns a point of the tetrahedron on paper, and how near it is.
fn projected(weights: [f64; 4]) -> (Spot, f64) {
    let [x, y, z] =
        [0, 1, 2].map(|axis| (0..4).map(|k| weights[k] * CORNERS[k][axis]).sum::<f64>());
    // Turned about the vertical and tipped towards the reader.
    let (turn, tip) = (0.35_f64, 0.28_f64);
    let (u, w) = (x * turn.cos() + z * turn.sin(), z * turn.cos() - x * turn.sin());
    let (v, depth) = (y * tip.cos() - w * tip.sin(), w * tip.cos() + y * tip.sin());
    ([CENTER[0] + SIZE * u, CENTER[1] - SIZE * v], depth)
}

fn corner(k: usize) -> Spot {
    let mut weights = [0.0; 4];
    weights[k] = 1.0;
    projected(weights).0
}

fn edges(pairs: &[[usize; 2]], dashes: &str) -> Element {
    let edge = |[a, b]: &[usize; 2]| {
        line(corner(*a), corner(*b), FAINT, 1.0).with("stroke-dasharray", dashes)
    };
    Element::group("edges").containing(pairs.iter().map(edge))
}

/// Returns the criterion of each corner, and the design that is best for it alone.
fn corner_names(best: &[&str]) -> Element {
    // Beside the dots: above, below, and outside of the base.
    let shifts = [[-70.0, -33.0], [-60.0, 30.0], [-46.0, 52.0], [8.0, 26.0]];
    let name = |k: usize| {
        let [x, y] = corner(k);
        let spot = [x + shifts[k][0], y + shifts[k][1]];
        let best = format!("best: {}", best[k]);
        [
            label(NAMES[k], spot, 13.0, Anchor::Start).with("fill", INK),
            label(&best, [spot[0], spot[1] + 17.0], 12.0, Anchor::Start).with("fill", FAINT),
        ]
    };
    Element::group("corners").containing((0..4).flat_map(name))
}

/// Returns a dot for each weight in the colour of its best design, the far ones first.
fn points(designs: &Designs, all: &Dots, regions: &[Region]) -> Element {
    let colors = colors(designs, regions);
    let mut dots: Vec<_> =
        all.winners.iter().map(|(weights, row)| (projected(*weights), *row)).collect();
    dots.sort_by(|a, b| a.0.1.total_cmp(&b.0.1));
    let dot = |((at, depth), row): &((Spot, f64), usize)| {
        let listed = regions.iter().take(LISTED).position(|region| region.row == *row);
        let color = listed.map_or("#d9d9d9", |k| colors[k].as_str());
        // Far dots are smaller.
        circle(*at, all.radius * (0.85 + 0.15 * depth)).with("fill", color)
    };
    Element::group("weights")
        .with("stroke", "#fff")
        .at("stroke-width", 0.5)
        .containing(dots.iter().map(dot))
}

/// Returns the colour of each listed region: that of its slant, lighter or darker for further ones of one slant.
fn colors(designs: &Designs, regions: &[Region]) -> Vec<String> {
    const SHADES: [f64; 6] = [0.0, 0.55, -0.45, 0.3, -0.25, 0.78];
    let slant = |region: &Region| designs.number("slant_deg", region.row).unwrap_or(90.0);
    let listed = &regions[..regions.len().min(LISTED)];
    let palette = designs.palette();
    let color = |(k, region): (usize, &Region)| {
        let before = listed[..k].iter().filter(|other| slant(other) == slant(region)).count();
        shaded(&palette.color(slant(region)), SHADES[before % SHADES.len()])
    };
    listed.iter().enumerate().map(color).collect()
}

fn letter(k: usize) -> String {
    char::from(b'A' + u8::try_from(k).unwrap_or(0)).to_string()
}

/// Returns the letter of each listed design on the dot of its region that is seen best; none where other dots hide all.
fn letters(all: &Dots, regions: &[Region]) -> Element {
    let dots: Vec<_> =
        all.winners.iter().map(|(weights, row)| (projected(*weights), *row)).collect();
    let letter = |(k, region): (usize, &Region)| {
        let own = dots.iter().filter(|(_, row)| *row == region.row);
        let seen = own.map(|(place, row)| (place.0, clearance(&dots, *place, *row)));
        let best = seen.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (best.1 > all.radius).then(|| badge(&letter(k), best.0))
    };
    Element::group("letters").containing(regions.iter().take(LISTED).enumerate().filter_map(letter))
}

/// Returns how far the nearest dot of another design in front of a place is from it on paper.
fn clearance(dots: &[((Spot, f64), usize)], (spot, depth): (Spot, f64), row: usize) -> f64 {
    let before = dots.iter().filter(|((_, near), other)| *near > depth && *other != row);
    let away = before.map(|((other, _), _)| (other[0] - spot[0]).hypot(other[1] - spot[1]));
    away.fold(SIZE, f64::min)
}

fn badge(text: &str, [x, y]: Spot) -> Element {
    Element::group("letter").containing([
        circle([x, y], 9.0).with("fill", "#fff").with("stroke", INK),
        label(text, [x, y + 4.2], 12.0, Anchor::Middle).with("fill", INK),
    ])
}

/// Returns a design of the list: its letter, parameters, share, and row at rest.
fn entry(designs: &Designs, region: &Region, color: &str, letter: &str, [x, y]: Spot) -> Element {
    let value = |column| designs.text(column, region.row);
    let text = format!(
        "{}:  $d/t$ = {},  $L/t$ = {},  $α$ = {}°",
        value("design"),
        value("gap_over_t"),
        value("length_over_t"),
        value("slant_deg")
    );
    let further = designs.further_axes().into_iter();
    let further = further.map(|axis| format!("{} {}", in_words(axis), value(axis)));
    let share = format!("best for {:.1} % of the weights", 100.0 * region.share);
    let share = further.chain([share]).collect::<Vec<_>>().join(",  ");
    let swatch = Element::new("rect")
        .at("x", x + 14.0)
        .at("y", y - 9.0)
        .at("width", 12.0)
        .at("height", 18.0)
        .with("fill", color);
    let entry = Element::group("entry").containing([
        badge(letter, [x, y]),
        swatch,
        label(&text, [x + 34.0, y - 2.0], 12.5, Anchor::Start).with("fill", INK),
        label(&share, [x + 34.0, y + 15.0], 12.0, Anchor::Start).with("fill", FAINT),
    ]);
    entry.containing(small_row(designs, region.row, [x + 276.0, y + 16.0]))
}

/// Returns a few scales of a row, to scale, on 110 by 34 px.
fn small_row(designs: &Designs, row: usize, [x, y]: Spot) -> Option<Element> {
    let number = |column| designs.number(column, row);
    let base = if designs.text("base", row) == "2L" { 1.0 } else { 0.5 };
    let half = base * number("length_over_t")?;
    let scale = Parallelogram::new(half, number("slant_deg")?).ok()?;
    let pitch = Row::new(scale, number("gap_over_t")?).ok()?.pitch();
    let room = 100.0;
    let size = (room / (scale.shift() + 2.0 * half + (4.0 * pitch).max(1.0))).min(30.0);
    let free = room / size - scale.shift() - 2.0 * half;
    let count = ((free / pitch).floor() + 1.0).min(60.0);
    let place = |i: usize, corner: geometry::Vec2| {
        [x + size * (half + i as f64 * pitch + corner.x), y - size * corner.y]
    };
    let body = |i| polygon(&scale.corners().map(|corner| place(i, corner)));
    // A small whole number.
    let bodies = (0..count as usize).map(body);
    Some(
        Element::group("row")
            .with("fill", "#d5dee6")
            .with("stroke", "#33414d")
            .at("stroke-width", 0.6)
            .containing(bodies),
    )
}

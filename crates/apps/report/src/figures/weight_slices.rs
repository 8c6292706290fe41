//! Slices of the tetrahedron of the weights of four criteria.
//!
//! Each slice has a constant weight of coverage. In slices, no weighting hides another weighting.

use crate::colors::{FAINT, INK, RED};
use crate::designs::Designs;
use crate::label::{Anchor, label, wrapped};
use crate::svg::{Element, Spot, circle, line, polygon};

/// Number of slices, not counting the corner with all weight on coverage.
const SLICES: u32 = 5;
/// Side of the largest slice on wide paper, px.
const SIDE: f64 = 286.0;
/// Ratio of height to side of an equilateral triangle.
const RISE: f64 = 0.866_025_403_784_438_6;
/// Lower left corner of each slice on wide paper, px.
///
/// The last entry is the position of the corner with all weight on coverage.
const PLACES: [Spot; SLICES as usize + 1] =
    [[44.0, 340.0], [352.0, 340.0], [44.0, 566.0], [258.0, 566.0], [412.0, 566.0], [520.0, 566.0]];
/// Distance of the lowest text below the base of the lowest slice, px.
const BELOW: f64 = 74.0;
/// Radius of the circle around the letter of a region, px.
const LETTER: f64 = 6.6;
/// Maximum radius of the dot of a weighting, px.
const LARGEST_DOT: f64 = 8.0;
/// Colour of the regions of designs that are not in the list.
const OTHERS: &str = "#d9d9d9";

/// Colour and letter of the region of weights for which one design is best.
pub(crate) struct RegionLook {
    /// Row of this design in the table.
    pub(crate) row: usize,
    pub(crate) color: String,
    pub(crate) letter: String,
}

/// The slices, with the best design for every weighting.
pub(crate) struct WeightSlices {
    /// Number of steps along an edge of the tetrahedron.
    pub(crate) resolution: u32,
    /// The four weights of each weighting, and the row of its best design.
    pub(crate) winners: Vec<([f64; 4], usize)>,
    /// Scale factor of the slices; 1 on wide paper.
    pub(crate) size: f64,
}

/// A weighting as a dot on a slice.
struct Dot {
    spot: Spot,
    row: usize,
    slice: usize,
    weights: [f64; 4],
}

impl WeightSlices {
    /// Draws the slices.
    ///
    /// `best` holds the number of the best design for each criterion alone. It is empty if the
    /// criteria may change.
    pub(crate) fn drawn(
        &self,
        designs: &Designs,
        looks: &[RegionLook],
        best: &[&str],
    ) -> Vec<Element> {
        let dots = self.dots();
        let mut drawn: Vec<Element> =
            (0..self.slices().len()).map(|k| self.frame(k, best)).collect();
        drawn.push(
            Element::group("weights")
                .containing(dots.iter().flat_map(|dot| self.marked(designs, looks, dot))),
        );
        drawn.push(self.letters(&dots, looks));
        drawn
    }

    /// Returns the weight of coverage of each slice, in steps of the grid, ascending from 0.
    fn slices(&self) -> Vec<u32> {
        let mut steps: Vec<u32> = (0..=SLICES).map(|k| k * self.resolution / SLICES).collect();
        // A coarse grid may have fewer steps than slices.
        steps.dedup();
        steps
    }

    fn weight(&self, steps: u32) -> f64 {
        f64::from(steps) / f64::from(self.resolution)
    }

    /// Returns the spot of a weighting on slice `k`.
    ///
    /// The top corner of a slice has the remaining weight on critical force, the left corner on
    /// penetration resistance, and the right corner on compliance.
    fn spot(&self, k: usize, [_, n, _, l]: [f64; 4]) -> Spot {
        let [left, base] = PLACES[k].map(|place| self.size * place);
        let side = self.size * SIDE;
        // Smaller slices move down, because texts above and between the slices keep their size.
        let down = (1.0 - self.size) * if base > self.size * PLACES[0][1] { 120.0 } else { 60.0 };
        [left + side * (l + 0.5 * n), base + down - side * RISE * n]
    }

    /// Returns the y coordinate of the lowest text, px.
    pub(crate) fn bottom(&self) -> f64 {
        self.spot(2, [0.0; 4])[1] + BELOW
    }

    fn is_small(&self) -> bool {
        self.size < 1.0
    }

    fn dots(&self) -> Vec<Dot> {
        let slices = self.slices();
        self.winners
            .iter()
            .filter_map(|(weights, row)| {
                // Weightings between two slices of a fine grid are not drawn.
                let slice = slices
                    .iter()
                    .position(|steps| (self.weight(*steps) - weights[0]).abs() < 1e-9)?;
                Some(Dot { spot: self.spot(slice, *weights), row: *row, slice, weights: *weights })
            })
            .collect()
    }

    fn radius(&self) -> f64 {
        (0.48 * self.size * SIDE / f64::from(self.resolution)).min(LARGEST_DOT)
    }

    /// Draws a weighting as a dot in the colour of its best design.
    ///
    /// The dot is crossed out if the surface folds under this design.
    fn marked(&self, designs: &Designs, looks: &[RegionLook], dot: &Dot) -> Vec<Element> {
        let look = looks.iter().find(|look| look.row == dot.row);
        let color = look.map_or(OTHERS, |look| look.color.as_str());
        let steps =
            dot.weights.map(|weight| (weight * f64::from(self.resolution)).round().to_string());
        let own = circle(dot.spot, self.radius()).with("fill", color);
        let mut marked = vec![own.with("data-steps", steps.join(","))];
        if designs.folded(dot.row) {
            let [x, y] = dot.spot;
            let r = 0.7 * self.radius();
            marked.push(line([x - r, y + r], [x + r, y - r], RED, 1.0));
        }
        marked
    }

    /// Draws the outline and title of slice `k`, with the names of its corners.
    ///
    /// Only the first slice has full names.
    fn frame(&self, k: usize, best: &[&str]) -> Element {
        let m = self.weight(self.slices()[k]);
        let [top, left, right] = self.corners(k);
        let outline = polygon(&[top, left, right])
            .with("fill", "none")
            .with("stroke", FAINT)
            .at("stroke-width", 0.8);
        let is_named = if self.is_small() { k == 0 } else { m < 1.0 };
        let title = format!("{}$m$ = {}", if is_named { "coverage " } else { "" }, short(m));
        let below = [0.5 * (left[0] + right[0]), left[1] + 40.0];
        let mut frame = Element::group("slice").containing([outline, middle(&title, below, 12.5)]);
        frame = frame.containing(self.corner_names(k));
        let [coverage, force, resistance, compliance] = *best else { return frame };
        if m >= 1.0 {
            let best = format!("best: {coverage}");
            frame.add(middle(&best, [left[0], left[1] + 56.0], 12.0));
        } else if k == 0 {
            let alone = format!(
                "best alone: critical force {force}, penetration resistance {resistance}, compliance {compliance}"
            );
            let lines = wrapped(&alone, 12.0, self.size * 580.0).into_iter().enumerate();
            frame = frame.containing(lines.map(|(k, line)| {
                let spot = [20.0, self.bottom() + 16.0 * k as f64];
                label(&line, spot, 12.0, Anchor::Start).with("fill", FAINT)
            }));
        }
        frame
    }

    /// Returns the corners of slice `k`: top, left, right.
    fn corners(&self, k: usize) -> [Spot; 3] {
        let m = self.weight(self.slices()[k]);
        [1, 2, 3].map(|corner| {
            let mut weights = [m, 0.0, 0.0, 0.0];
            weights[corner] = 1.0 - m;
            self.spot(k, weights)
        })
    }

    /// Draws the names of the criteria at the corners of slice `k`.
    ///
    /// The first slice has words, the others have symbols.
    fn corner_names(&self, k: usize) -> impl Iterator<Item = Element> {
        let names: [&str; 3] = match k {
            0 if self.is_small() => ["critical force $n$", "resistance $k$", "compliance $l$"],
            0 => ["critical force $n$", "penetration resistance $k$", "compliance $l$"],
            _ if self.weight(self.slices()[k]) < 1.0 => ["$n$", "$k$", "$l$"],
            _ => ["", "", ""],
        };
        let [top, left, right] = self.corners(k);
        let away = if k == 0 { 34.0 } else { 0.0 };
        let spots = [
            [top[0], top[1] - 14.0],
            [left[0] + away, left[1] + 22.0],
            [right[0] - away, right[1] + 22.0],
        ];
        names.into_iter().zip(spots).map(|(name, spot)| middle(name, spot, 12.0))
    }

    /// Draws the letter of each listed design on one of its dots.
    ///
    /// This dot has the largest distance from the dots of other designs.
    fn letters(&self, dots: &[Dot], looks: &[RegionLook]) -> Element {
        Element::group("letters").containing(looks.iter().filter_map(|look| {
            let own = dots.iter().filter(|dot| dot.row == look.row);
            let clear = own.map(|dot| (dot.spot, clearance(dots, dot)));
            let (spot, clear) = clear.max_by(|a, b| a.1.total_cmp(&b.1))?;
            // Omit a letter that would cover dots of other designs; the list shows the colour.
            (clear > LETTER + 0.5 * self.radius()).then(|| letter_at(&look.letter, spot))
        }))
    }
}

/// Returns the distance of a dot from the nearest dot of another design on the same slice, px.
fn clearance(dots: &[Dot], own: &Dot) -> f64 {
    let others = dots.iter().filter(|dot| dot.slice == own.slice && dot.row != own.row);
    let away = others.map(|dot| (dot.spot[0] - own.spot[0]).hypot(dot.spot[1] - own.spot[1]));
    away.fold(SIDE, f64::min)
}

/// Draws a text centred horizontally at a spot.
fn middle(text: &str, spot: Spot, size: f64) -> Element {
    label(text, spot, size, Anchor::Middle).with("fill", INK)
}

fn letter_at(letter: &str, [x, y]: Spot) -> Element {
    Element::group("letter").containing([
        circle([x, y], LETTER).with("fill", "#fff").with("stroke", INK).at("stroke-width", 0.8),
        label(letter, [x, y + 3.6], 10.0, Anchor::Middle).with("fill", INK),
    ])
}

/// Rounds a weight to two decimals.
fn short(weight: f64) -> f64 {
    (weight * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::{Dot, WeightSlices};

    /// Returns slices of a grid in which each weighting has a different best design.
    fn slices(resolution: u32) -> WeightSlices {
        let all = (0..=resolution).flat_map(|m| {
            (0..=resolution - m).flat_map(move |n| {
                (0..=resolution - m - n).map(move |k| [m, n, k, resolution - m - n - k])
            })
        });
        let weights = all.map(|steps| steps.map(|step| f64::from(step) / f64::from(resolution)));
        WeightSlices {
            resolution,
            size: 1.0,
            winners: weights.enumerate().map(|(row, weights)| (weights, row)).collect(),
        }
    }

    #[test]
    fn dots_of_weightings_do_not_overlap() {
        for resolution in [1, 4, 10, 20, 23] {
            let slices = slices(resolution);
            let dots: Vec<Dot> = slices.dots();
            assert!(dots.len() > 3);
            for (k, dot) in dots.iter().enumerate() {
                for other in &dots[..k] {
                    let away = (dot.spot[0] - other.spot[0]).hypot(dot.spot[1] - other.spot[1]);
                    assert!(away > 2.0 * slices.radius(), "{resolution}: {away}");
                }
            }
        }
    }

    #[test]
    fn slices_cover_coverage_weights_from_zero_to_one() {
        assert_eq!(slices(20).slices(), [0, 4, 8, 12, 16, 20]);
        assert_eq!(slices(1).slices(), [0, 1]);
        assert_eq!(slices(20).dots().len(), 231 + 153 + 91 + 45 + 15 + 1);
    }
}

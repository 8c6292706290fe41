//! The tetrahedron of weights cut into slices of equal weight of coverage, so that no weighting hides another.

use crate::colors::{FAINT, INK, RED};
use crate::designs::Designs;
use crate::label::{Anchor, label};
use crate::svg::{Element, Spot, circle, line, polygon};

/// Slices, without the corner at which coverage counts alone.
const SLICES: u32 = 5;
/// Side of the largest slice, px.
const SIDE: f64 = 286.0;
/// Height of a triangle over its side.
const RISE: f64 = 0.866_025_403_784_438_6;
/// Left end and base of each slice, and of the corner.
const PLACES: [Spot; SLICES as usize + 1] =
    [[44.0, 340.0], [352.0, 340.0], [44.0, 552.0], [258.0, 552.0], [412.0, 552.0], [520.0, 552.0]];
/// Radius of the letter of a region, and of the largest dot, px.
const LETTER: f64 = 6.6;
const LARGEST_DOT: f64 = 8.0;
/// Colour of regions that are not listed.
const OTHERS: &str = "#d9d9d9";

/// How a region of weights looks.
pub(crate) struct RegionLook {
    /// Row of the design that is best there.
    pub(crate) row: usize,
    pub(crate) color: String,
    pub(crate) letter: String,
}

/// The best design for every weighting, in slices.
pub(crate) struct WeightSlices {
    /// Steps from one corner of the tetrahedron to the next.
    pub(crate) resolution: u32,
    /// Weights, and the row of the design that is best for them.
    pub(crate) winners: Vec<([f64; 4], usize)>,
}

/// A weighting on paper.
struct Dot {
    spot: Spot,
    row: usize,
    slice: usize,
    weights: [f64; 4],
}

impl WeightSlices {
    /// Draws the slices; `best` names the design that is best by each criterion alone, or none where that may change.
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

    /// Returns the steps of the weight of coverage at which the tetrahedron is cut, from 0 to its corner.
    fn slices(&self) -> Vec<u32> {
        let mut steps: Vec<u32> = (0..=SLICES).map(|k| k * self.resolution / SLICES).collect();
        // A coarse grid has fewer steps than there are slices.
        steps.dedup();
        steps
    }

    fn weight(&self, steps: u32) -> f64 {
        f64::from(steps) / f64::from(self.resolution)
    }

    /// Returns a weighting on its slice: critical force above, penetration resistance at the left, compliance at the right.
    fn spot(k: usize, [_, n, _, l]: [f64; 4]) -> Spot {
        let [left, base] = PLACES[k];
        [left + SIDE * (l + 0.5 * n), base - SIDE * RISE * n]
    }

    fn dots(&self) -> Vec<Dot> {
        let slices = self.slices();
        let dot = |(weights, row): &([f64; 4], usize)| {
            let is_here = |steps: &u32| (self.weight(*steps) - weights[0]).abs() < 1e-9;
            // Weightings between two slices are not drawn, however fine the grid is.
            let slice = slices.iter().position(is_here)?;
            Some(Dot { spot: Self::spot(slice, *weights), row: *row, slice, weights: *weights })
        };
        self.winners.iter().filter_map(dot).collect()
    }

    fn radius(&self) -> f64 {
        (0.48 * SIDE / f64::from(self.resolution)).min(LARGEST_DOT)
    }

    /// Returns a weighting in the colour of its best design, struck through where that folds.
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

    /// Returns the outline of a slice with the names of its corners, those of the first in full.
    fn frame(&self, k: usize, best: &[&str]) -> Element {
        let m = self.weight(self.slices()[k]);
        let [top, left, right] = self.corners(k);
        let outline = polygon(&[top, left, right])
            .with("fill", "none")
            .with("stroke", FAINT)
            .at("stroke-width", 0.8);
        let title =
            if m < 1.0 { format!("coverage $m$ = {}", short(m)) } else { "$m$ = 1".to_owned() };
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
            frame.add(label(&alone, [20.0, 622.0], 12.0, Anchor::Start).with("fill", FAINT));
        }
        frame
    }

    /// The corners of slice `k`: above, on the left and on the right.
    fn corners(&self, k: usize) -> [Spot; 3] {
        let m = self.weight(self.slices()[k]);
        [1, 2, 3].map(|corner| {
            let mut weights = [m, 0.0, 0.0, 0.0];
            weights[corner] = 1.0 - m;
            Self::spot(k, weights)
        })
    }

    /// The criteria at the corners of slice `k`, in words in the first one.
    fn corner_names(&self, k: usize) -> impl Iterator<Item = Element> {
        let names: [&str; 3] = match k {
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

    /// Returns the letter of each listed design on that of its dots which is farthest from dots of others.
    fn letters(&self, dots: &[Dot], looks: &[RegionLook]) -> Element {
        let letter = |look: &RegionLook| {
            let own = dots.iter().filter(|dot| dot.row == look.row);
            let clear = own.map(|dot| (dot.spot, clearance(dots, dot)));
            let (spot, clear) = clear.max_by(|a, b| a.1.total_cmp(&b.1))?;
            // A letter that would cover dots of others is left out: the list has the colour.
            (clear > LETTER + 0.5 * self.radius()).then(|| letter_at(&look.letter, spot))
        };
        Element::group("letters").containing(looks.iter().filter_map(letter))
    }
}

/// Returns how far the nearest dot of another design is on the same slice.
fn clearance(dots: &[Dot], own: &Dot) -> f64 {
    let others = dots.iter().filter(|dot| dot.slice == own.slice && dot.row != own.row);
    let away = others.map(|dot| (dot.spot[0] - own.spot[0]).hypot(dot.spot[1] - own.spot[1]));
    away.fold(SIDE, f64::min)
}

/// A text whose middle is at a spot.
fn middle(text: &str, spot: Spot, size: f64) -> Element {
    label(text, spot, size, Anchor::Middle).with("fill", INK)
}

fn letter_at(letter: &str, [x, y]: Spot) -> Element {
    Element::group("letter").containing([
        circle([x, y], LETTER).with("fill", "#fff").with("stroke", INK).at("stroke-width", 0.8),
        label(letter, [x, y + 3.6], 10.0, Anchor::Middle).with("fill", INK),
    ])
}

/// Returns a weight to two digits.
fn short(weight: f64) -> f64 {
    (weight * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::{Dot, WeightSlices};

    /// Every weighting of a grid, each the best of a design of its own.
    fn slices(resolution: u32) -> WeightSlices {
        let all = (0..=resolution).flat_map(|m| {
            (0..=resolution - m).flat_map(move |n| {
                (0..=resolution - m - n).map(move |k| [m, n, k, resolution - m - n - k])
            })
        });
        let weights = all.map(|steps| steps.map(|step| f64::from(step) / f64::from(resolution)));
        WeightSlices {
            resolution,
            winners: weights.enumerate().map(|(row, weights)| (weights, row)).collect(),
        }
    }

    #[test]
    fn no_dot_hides_another() {
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
    fn slices_are_cut_from_face_to_corner() {
        assert_eq!(slices(20).slices(), [0, 4, 8, 12, 16, 20]);
        assert_eq!(slices(1).slices(), [0, 1]);
        assert_eq!(slices(20).dots().len(), 231 + 153 + 91 + 45 + 15 + 1);
    }
}

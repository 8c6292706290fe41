//! Colours and marks of slants, the same in every figure and on the page.

use std::f64::consts::PI;

use text::number::DistinctNumbers;

use crate::colors::mixed;
use crate::svg::{Element, Spot, circle, polygon};

/// Colours of the slants 0°, 15° … 90°, from the colour-blind safe palette of Okabe and Ito.
const SLANTS: [[u8; 3]; 7] = [
    [0, 114, 178],
    [86, 180, 233],
    [0, 158, 115],
    [230, 159, 0],
    [213, 94, 0],
    [204, 121, 167],
    [60, 60, 60],
];

/// Colours and marks of the slants of a sweep.
///
/// If all slants are multiples of 15°, each has the same colour and mark in every such sweep.
/// Otherwise the slants take the seven colours and marks in ascending order. With more than seven
/// slants, marks repeat and colours are interpolated, but neighbouring slants always differ.
#[derive(Clone, Debug, PartialEq)]
pub struct SlantPalette(DistinctNumbers);

impl SlantPalette {
    /// Creates the palette of some slants, in degrees.
    pub fn new(slants: impl IntoIterator<Item = f64>) -> Self {
        Self(slants.into_iter().collect())
    }

    /// Returns the slants, sorted.
    pub fn slants(&self) -> &[f64] {
        self.0.as_slice()
    }

    /// Returns the colour of a slant.
    pub fn color(&self, slant_deg: f64) -> String {
        let last = SLANTS.len() - 1;
        let place = match self.slants().len() {
            _ if self.is_by_fifteen() => slant_deg / 15.0,
            0..=7 => self.place(slant_deg) as f64,
            count => self.place(slant_deg) as f64 * last as f64 / (count - 1) as f64,
        };
        mixed(&SLANTS, place / last as f64)
    }

    /// Returns the mark of a slant.
    pub fn mark(&self, slant_deg: f64) -> Mark {
        let place = if self.is_by_fifteen() {
            (slant_deg / 15.0).round() as usize
        } else {
            self.place(slant_deg)
        };
        Mark::ALL[place % Mark::ALL.len()]
    }

    fn place(&self, slant_deg: f64) -> usize {
        // A slant that the sweep does not contain takes the style of the next larger slant.
        self.0
            .position(slant_deg)
            .unwrap_or_else(|| self.slants().partition_point(|other| *other < slant_deg))
    }

    /// Returns true if all slants are multiples of 15°.
    fn is_by_fifteen(&self) -> bool {
        self.slants().iter().all(|slant| (slant / 15.0 - (slant / 15.0).round()).abs() < 1e-9)
    }
}

/// The shape that marks a slant.
///
/// Each variant states its slant in a sweep of multiples of 15°.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Circle, for a slant of 0°.
    Circle,
    /// Square, for 15°.
    Square,
    /// Diamond, for 30°.
    Diamond,
    /// Triangle that points up, for 45°.
    Up,
    /// Triangle that points down, for 60°.
    Down,
    /// Star, for 75°.
    Star,
    /// Hexagon, for 90°.
    Hexagon,
}

impl Mark {
    /// All marks, in the order of the slants.
    pub(crate) const ALL: [Self; 7] = [
        Self::Circle,
        Self::Square,
        Self::Diamond,
        Self::Up,
        Self::Down,
        Self::Star,
        Self::Hexagon,
    ];

    /// Returns the name of the mark, by which figures refer to its shape.
    pub(crate) fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }

    /// Draws the mark around `center`, with about the area of a circle of this `radius`.
    pub(crate) fn draw(self, center: Spot, radius: f64) -> Element {
        let (size, corners, start, inner) = match self {
            Self::Circle => return circle(center, radius),
            Self::Square => (1.25, 4, PI / 4.0, 1.0),
            Self::Diamond => (1.35, 4, 0.0, 1.0),
            Self::Up => (1.4, 3, PI / 2.0, 1.0),
            Self::Down => (1.4, 3, -PI / 2.0, 1.0),
            Self::Star => (1.5, 5, PI / 2.0, 0.45),
            Self::Hexagon => (1.15, 6, 0.0, 1.0),
        };
        polygon(&regular(center, size * radius, corners, start, inner))
    }
}

/// Returns the corners of a regular polygon or star around `(x, y)`.
///
/// The first corner is at the angle `start`, in radians counter-clockwise from the x axis. If
/// `inner` is below 1, the shape is a star, and `inner` is the ratio of its inner to outer radius.
fn regular([x, y]: Spot, radius: f64, corners: usize, start: f64, inner: f64) -> Vec<Spot> {
    (0..2 * corners)
        .filter(|k| inner < 1.0 || k.is_multiple_of(2))
        .map(|k| {
            let angle = start + k as f64 * PI / corners as f64;
            let r = if k.is_multiple_of(2) { radius } else { inner * radius };
            [x + r * angle.cos(), y - r * angle.sin()]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{Mark, SlantPalette};

    #[test]
    fn slants_of_the_paper_have_fixed_colours_and_marks() {
        for palette in [SlantPalette::new([0.0, 45.0]), SlantPalette::new([0.0, 15.0, 45.0, 75.0])]
        {
            assert_eq!(palette.color(0.0), "#0072b2");
            assert_eq!(palette.color(45.0), "#e69f00");
            assert_eq!(palette.mark(45.0), Mark::Up);
        }
    }

    #[test]
    fn slants_of_a_sweep_have_distinct_marks_and_colours() {
        let slants = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0];
        let palette = SlantPalette::new(slants);
        for (k, slant) in slants.iter().enumerate() {
            for other in &slants[..k] {
                assert_ne!(palette.color(*slant), palette.color(*other));
                assert_ne!(palette.mark(*slant), palette.mark(*other));
            }
        }
        let many = SlantPalette::new((0..30).map(|k| f64::from(3 * k)));
        for pair in many.slants().windows(2) {
            assert_ne!(many.mark(pair[0]), many.mark(pair[1]));
            assert_ne!(many.color(pair[0]), many.color(pair[1]));
        }
    }
}

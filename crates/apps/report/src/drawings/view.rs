//! The transformation from the plane of the scales to paper.

use crate::svg::Spot;

/// The transformation from points in units of `t`, `y` up, to spots on paper in px, `y` down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    /// Length of `t` on paper, px.
    pub(super) scale: f64,
    /// Spot of the origin of the plane.
    pub(super) origin: Spot,
}

impl View {
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> Spot {
        [self.origin[0] + self.scale * x, self.origin[1] - self.scale * y]
    }

    pub(super) fn all(&self, points: &[[f64; 2]]) -> Vec<Spot> {
        points.iter().map(|&point| self.place(point)).collect()
    }
}

/// A rectangle in the plane of the scales, in units of `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

impl Extent {
    /// Returns the smallest rectangle around `points`; there must be at least one point.
    pub(super) fn around<'p>(points: impl IntoIterator<Item = &'p [f64; 2]>) -> Self {
        let nothing = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };
        points.into_iter().fold(nothing, |Self { low, high }, point| Self {
            low: [0, 1].map(|k| low[k].min(point[k])),
            high: [0, 1].map(|k| high[k].max(point[k])),
        })
    }

    pub(super) fn middle(&self) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * (self.low[k] + self.high[k]))
    }

    pub(super) fn size(&self) -> [f64; 2] {
        [0, 1].map(|k| self.high[k] - self.low[k])
    }
}

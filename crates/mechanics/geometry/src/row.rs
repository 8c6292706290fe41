//! Rows of identical scales at a constant gap.

use crate::{Body, Corner, OutOfRange, Parallelogram, Vec2, coverage};

/// Row of identical scales with equal gaps between neighbouring bases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    scale: Parallelogram,
    gap: f64,
}

impl Row {
    /// Creates a row of copies of `scale` with the gap `gap` between neighbouring bases.
    ///
    /// The gap is in units of `t`.
    ///
    /// # Errors
    /// If the gap is not positive and finite.
    pub fn new(scale: Parallelogram, gap: f64) -> Result<Self, OutOfRange> {
        OutOfRange::unless(gap > 0.0 && gap.is_finite(), "gap", gap, "a positive length")?;
        Ok(Self { scale, gap })
    }

    /// Returns the shape that all scales share.
    pub fn scale(&self) -> &Parallelogram {
        &self.scale
    }

    /// Returns the gap `d` between neighbouring bases, in units of `t`.
    pub fn gap(&self) -> f64 {
        self.gap
    }

    /// Returns the pitch `p = 2a + d`, in units of `t`.
    pub fn pitch(&self) -> f64 {
        2.0 * self.scale.half_base() + self.gap
    }

    /// Returns the coverage `λ = t_s/t` (`docs/theory/model.md`, Eq. G2).
    ///
    /// A vertical line runs from the top right corner of a scale down to the substrate. `t_s` is
    /// the total length of the parts of this line that lie inside the scales further to the right.
    ///
    /// The coverage is 0 if the line crosses no scale, and always below 1.
    pub fn coverage(&self) -> f64 {
        coverage::coverage(self.scale.shift(), 2.0 * self.scale.half_base(), self.pitch())
    }

    /// Returns the shortest distance between two neighbouring scales on a body, in units of `t`.
    ///
    /// The result is meaningless if the scales overlap.
    pub fn clearance_on(&self, body: Body) -> f64 {
        if body.is_flat() {
            return self.gap * self.scale.slant().cos();
        }
        body.distance(&self.scale, &self.scale, self.pitch())
    }

    /// Returns the coverage of the row on a curved body.
    ///
    /// A line runs from the top right corner of a scale, opposite to the normal of this scale, down
    /// to the surface of the body. The coverage is the fraction of the line that lies inside the
    /// neighbours on the right. Each neighbour is aligned with its own normal.
    pub fn coverage_on(&self, body: Body) -> f64 {
        let corner = self.scale.corner(Corner::TopRight);
        let line = [corner, Vec2::new(corner.x, body.height(corner.x))];
        let length = line[0].y - line[1].y;
        // The farthest neighbour that the line crosses is at a distance of about `corner.x`. Twice
        // this distance is a safe bound.
        let bound = (2.0 * corner.x.abs().max(1.0) / self.pitch()).ceil() as usize + 1;
        let facing_load = body.scales_beside(self.pitch()).unwrap_or(bound);
        let inside = (1..=bound.min(facing_load)).map(|k| {
            let frame = body.frame(k as f64 * self.pitch());
            let corners = self.scale.corners().map(|c| frame.origin + frame.outward(c));
            length_inside(line, &corners)
        });
        (inside.sum::<f64>() / length).min(1.0)
    }

    /// Returns the directional derivative of the coverage along a change of the row's lengths.
    ///
    /// The coverage has a kink where the number of crossed scales changes. There the derivative is
    /// one-sided, in the direction of the change.
    pub fn coverage_rate(&self, change: &RowChange) -> f64 {
        let lengths = [self.scale.shift(), 2.0 * self.scale.half_base(), self.pitch()];
        let RowChange { shift, half_base, gap } = *change;
        coverage::coverage_rate(lengths, [shift, 2.0 * half_base, 2.0 * half_base + gap])
    }
}

/// Rates of change of the lengths of a row, with lengths in units of `t`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowChange {
    /// Rate of change of the shift `S` of the top relative to the base.
    pub shift: f64,
    /// Rate of change of the half-width `a` of the base.
    pub half_base: f64,
    /// Rate of change of the gap `d`.
    pub gap: f64,
}

/// Returns the length of the part of a vertical line that lies inside a convex polygon.
///
/// `top` and `bottom` are the ends of the line. The corners of the polygon are in counter-clockwise
/// order.
fn length_inside([top, bottom]: [Vec2; 2], corners: &[Vec2; 4]) -> f64 {
    let (mut high, mut low) = (top.y, bottom.y);
    for (k, start) in corners.iter().enumerate() {
        let along = corners[(k + 1) % 4] - start;
        // The polygon is to the left of each edge: `along × (point − start) ≥ 0`.
        let crossing = if along.x == 0.0 {
            None
        } else {
            Some(start.y + along.y / along.x * (top.x - start.x))
        };
        match crossing {
            None if along.y * (start.x - top.x) < 0.0 => return 0.0,
            None => {}
            Some(y) if along.x > 0.0 => low = low.max(y),
            Some(y) => high = high.min(y),
        }
    }
    (high - low).max(0.0)
}

//! Rows of scales with unequal slants at unequal gaps.

use crate::{OutOfRange, Parallelogram, Vec2};

/// Row with individual slants of the scales and individual widths of the gaps.
///
/// ```text
///   ┌────────┐           ┌────────┐      ┌────────┐
///   │   0    │           │   1    │      │   2    │
///   └───○────┘           └───○────┘      └───○────┘
///       ├ a ┼── gap 0 ──┼ a ─┼─ a ┼ gap 1 ┼ a ┤
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct UnevenRow {
    scales: Vec<Parallelogram>,
    gaps: Vec<f64>,
    /// Distances of the nodes from the first node.
    positions: Vec<f64>,
}

impl UnevenRow {
    /// Creates a row of `scales` with `gaps` (over `t`) between neighbouring bases.
    ///
    /// There is one gap less than there are scales.
    ///
    /// # Errors
    /// If a gap is not positive and finite, two neighbours overlap above their bases, or the
    /// numbers of scales and gaps do not match.
    pub fn new(scales: Vec<Parallelogram>, gaps: Vec<f64>) -> Result<Self, OutOfRange> {
        let one_fewer = gaps.len() + 1 == scales.len();
        let expected = "one fewer than there are scales";
        OutOfRange::unless(one_fewer, "number of gaps", gaps.len() as f64, expected)?;
        let mut positions = vec![0.0];
        for (pair, &gap) in scales.windows(2).zip(&gaps) {
            let narrowest = clearance(&pair[0], &pair[1], gap);
            let clear = narrowest > 0.0 && gap.is_finite();
            OutOfRange::unless(clear, "gap", narrowest, "neighbours that do not overlap")?;
            let pitch = pair[0].half_base() + gap + pair[1].half_base();
            positions.push(positions[positions.len() - 1] + pitch);
        }
        Ok(Self { scales, gaps, positions })
    }

    /// Returns the scales, from the left.
    pub fn scales(&self) -> &[Parallelogram] {
        &self.scales
    }

    /// Returns the gaps between neighbouring bases, from the left, over `t`.
    pub fn gaps(&self) -> &[f64] {
        &self.gaps
    }

    /// Returns the distance of the nodes of the scales `i` and `i + 1`, over `t`.
    pub fn pitch(&self, i: usize) -> f64 {
        self.scales[i].half_base() + self.gaps[i] + self.scales[i + 1].half_base()
    }

    /// Returns the distance of node `i` from the first node, over `t`.
    pub fn position(&self, i: usize) -> f64 {
        self.positions[i]
    }

    /// Returns the distance of the last node from the first node, over `t`.
    pub fn length(&self) -> f64 {
        self.positions[self.positions.len() - 1]
    }
}

/// Returns the smallest horizontal distance of two neighbours, over `t`.
///
/// It occurs at the base, where it is `gap`, or at the top if the scales lean towards each other.
/// Negative if they overlap.
pub fn clearance(left: &Parallelogram, right: &Parallelogram, gap: f64) -> f64 {
    gap.min(gap + right.shift() - left.shift())
}

/// Computes the distance of two polygons that do not overlap.
pub fn polygon_distance(one: &[Vec2; 4], other: &[Vec2; 4]) -> f64 {
    let mut least = f64::INFINITY;
    for (corners, edges) in [(one, other), (other, one)] {
        for corner in corners {
            for (k, start) in edges.iter().enumerate() {
                let (along, to_corner) = (edges[(k + 1) % 4] - start, corner - start);
                let foot = (to_corner.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                least = least.min((to_corner - foot * along).norm());
            }
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::{UnevenRow, clearance};
    use crate::Parallelogram;

    fn scale(slant_deg: f64) -> Parallelogram {
        Parallelogram::leaning(0.5, slant_deg).unwrap()
    }

    fn close(value: f64, expected: f64) {
        assert!((value - expected).abs() < 1e-12, "{value} {expected}");
    }

    #[test]
    fn nodes_follow_from_bases_and_gaps() {
        let row =
            UnevenRow::new(vec![scale(0.0), scale(5.0), scale(-2.0)], vec![0.1, 0.3]).unwrap();
        close(row.pitch(0), 1.1);
        close(row.position(2), 2.4);
        close(row.length(), 2.4);
    }

    #[test]
    fn scales_that_lean_into_each_other_are_refused() {
        // tan 45° = 1: the tops are closer to each other by 1 than the bases.
        close(clearance(&scale(45.0), &scale(0.0), 1.25), 0.25);
        close(clearance(&scale(0.0), &scale(45.0), 1.25), 1.25);
        let error = UnevenRow::new(vec![scale(45.0), scale(0.0)], vec![0.75]).unwrap_err();
        assert_eq!(error.quantity, "gap");
        close(error.value, -0.25);
        let error = UnevenRow::new(vec![scale(0.0)], vec![0.1]).unwrap_err();
        assert_eq!(error.quantity, "number of gaps");
    }
}

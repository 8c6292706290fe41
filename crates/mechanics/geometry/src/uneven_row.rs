//! Rows of scales with unequal slants at unequal gaps.

use crate::{OutOfRange, Parallelogram, Vec2};

/// Row in which each scale has its own slant and each gap its own width.
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
    /// Distance of each node from the first node, in units of `t`.
    positions: Vec<f64>,
}

impl UnevenRow {
    /// Creates a row of `scales` with `gaps` between neighbouring bases, from left to right.
    ///
    /// Gaps are in units of `t`. The number of gaps is the number of scales minus one.
    ///
    /// # Errors
    /// If a gap is not positive and finite, if two neighbours overlap at their tops, or if the
    /// number of gaps is not the number of scales minus one.
    pub fn new(scales: Vec<Parallelogram>, gaps: Vec<f64>) -> Result<Self, OutOfRange> {
        let one_fewer = gaps.len() + 1 == scales.len();
        let expected = "one fewer than there are scales";
        OutOfRange::unless(one_fewer, "number of gaps", gaps.len() as f64, expected)?;
        let mut positions = vec![0.0];
        for (pair, &gap) in scales.windows(2).zip(&gaps) {
            let narrowest = clearance(&pair[0], &pair[1], gap);
            let clear = narrowest > 0.0 && gap.is_finite();
            let quantity = "smallest distance between two neighbours";
            OutOfRange::unless(clear, quantity, narrowest, "a positive finite length")?;
            let pitch = pair[0].half_base() + gap + pair[1].half_base();
            positions.push(positions[positions.len() - 1] + pitch);
        }
        Ok(Self { scales, gaps, positions })
    }

    /// Returns the scales from left to right.
    pub fn scales(&self) -> &[Parallelogram] {
        &self.scales
    }

    /// Returns the gaps between neighbouring bases from left to right, in units of `t`.
    pub fn gaps(&self) -> &[f64] {
        &self.gaps
    }

    /// Returns the distance between the nodes of scales `i` and `i + 1`, in units of `t`.
    pub fn pitch(&self, i: usize) -> f64 {
        self.scales[i].half_base() + self.gaps[i] + self.scales[i + 1].half_base()
    }

    /// Returns the distance from the first node to node `i`, in units of `t`.
    pub fn position(&self, i: usize) -> f64 {
        self.positions[i]
    }

    /// Returns the distance from the first node to the last node, in units of `t`.
    pub fn length(&self) -> f64 {
        self.positions[self.positions.len() - 1]
    }
}

/// Returns the smallest horizontal distance between two neighbouring scales, in units of `t`.
///
/// `gap` is the distance between the bases. The smallest distance occurs at the bases, or at the
/// tops if the left scale leans further to the right than the right scale. Negative if the scales
/// overlap.
pub fn clearance(left: &Parallelogram, right: &Parallelogram, gap: f64) -> f64 {
    gap.min(gap + right.shift() - left.shift())
}

/// Returns the shortest distance between two polygons that do not overlap.
///
/// `one` and `other` contain the corners of the two polygons, in order along each perimeter.
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
    fn positions_of_nodes_follow_from_bases_and_gaps() {
        let row =
            UnevenRow::new(vec![scale(0.0), scale(5.0), scale(-2.0)], vec![0.1, 0.3]).unwrap();
        close(row.pitch(0), 1.1);
        close(row.position(2), 2.4);
        close(row.length(), 2.4);
    }

    #[test]
    fn rows_with_overlapping_tops_or_a_wrong_number_of_gaps_are_refused() {
        // The left scale leans by tan 45° = 1 to the right, so the distance between the tops is
        // smaller by 1 than the distance between the bases.
        close(clearance(&scale(45.0), &scale(0.0), 1.25), 0.25);
        close(clearance(&scale(0.0), &scale(45.0), 1.25), 1.25);
        let error = UnevenRow::new(vec![scale(45.0), scale(0.0)], vec![0.75]).unwrap_err();
        assert_eq!(error.quantity, "smallest distance between two neighbours");
        close(error.value, -0.25);
        let error = UnevenRow::new(vec![scale(0.0)], vec![0.1]).unwrap_err();
        assert_eq!(error.quantity, "number of gaps");
    }
}

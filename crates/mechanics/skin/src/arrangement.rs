//! Arrangement of a row at rest: scales, gaps and pitches.

use contact::Pair;
use geometry::{Body, Frame, OutOfRange, Parallelogram, Row, UnevenRow, clearance};

/// Row of equal scales at a constant gap, or of scales with individual slants and gaps.
#[derive(Clone, Debug)]
pub(crate) enum Arrangement {
    Even(Row),
    Uneven(UnevenRow),
}

impl Arrangement {
    pub(crate) fn scale(&self, i: usize) -> Parallelogram {
        match self {
            Self::Even(row) => *row.scale(),
            Self::Uneven(row) => row.scales()[i],
        }
    }

    /// Returns the gap between the bases of scales `i` and `i + 1`.
    pub(crate) fn gap(&self, i: usize) -> f64 {
        match self {
            Self::Even(row) => row.gap(),
            Self::Uneven(row) => row.gaps()[i],
        }
    }

    /// Returns the distance between the nodes of scales `i` and `i + 1`.
    pub(crate) fn pitch(&self, i: usize) -> f64 {
        match self {
            Self::Even(row) => row.pitch(),
            Self::Uneven(row) => row.pitch(i),
        }
    }

    /// Returns a row that consists of scales `i` and `i + 1` only.
    ///
    /// # Errors
    /// If both scales overlap, which a valid arrangement excludes.
    pub(crate) fn pair(&self, i: usize) -> Result<Self, OutOfRange> {
        let scales = vec![self.scale(i), self.scale(i + 1)];
        UnevenRow::new(scales, vec![self.gap(i)]).map(Self::Uneven)
    }

    /// Returns the distance from the node of the first scale to the node of scale `i`.
    pub(crate) fn position(&self, i: usize) -> f64 {
        match self {
            Self::Even(row) => i as f64 * row.pitch(),
            Self::Uneven(row) => row.position(i),
        }
    }

    /// Returns a lower bound of the distance between the faces of scales `i` and `i + 1` at rest.
    ///
    /// On a curved body it is the exact distance.
    pub(crate) fn clearance(&self, i: usize, body: Body) -> f64 {
        let [left, right] = [self.scale(i), self.scale(i + 1)];
        if !body.is_flat() {
            return body.distance(&left, &right, self.pitch(i));
        }
        // The horizontal distance times the cosine of a slant is the distance perpendicular to that
        // side. The larger slant gives the lower bound. Use its magnitude, because single scales
        // may lean to the left.
        let steepest = left.slant().abs().max(right.slant().abs());
        clearance(&left, &right, self.gap(i)) * steepest.cos()
    }

    /// Returns the mean distance between neighbouring nodes.
    pub(crate) fn mean_pitch(&self) -> f64 {
        match self {
            Self::Even(row) => row.pitch(),
            Self::Uneven(row) => row.length() / row.gaps().len() as f64,
        }
    }

    /// Returns the sum of the gaps divided by the sum of the pitches, `Σd/Σp`.
    ///
    /// It equals the compliance `κ*/M*` of a bent strip before contact.
    pub(crate) fn gap_fraction(&self) -> f64 {
        match self {
            Self::Even(row) => row.gap() / row.pitch(),
            Self::Uneven(row) => row.gaps().iter().sum::<f64>() / row.length(),
        }
    }

    /// Lists the pairs of scales that are up to `reach` pitches apart on `body`.
    ///
    /// Each entry holds a pair and the tangent frame of its right scale, relative to the frame of
    /// its left scale. Entries are ordered by left scale, then by distance. An even row has one
    /// entry for each distance, because all its pairs at one distance are equal.
    pub(crate) fn pairs(&self, reach: usize, body: Body) -> Vec<(Pair, Frame)> {
        match self {
            Self::Even(row) => (1..=reach)
                .map(|pitches| pair_on(body, [*row.scale(); 2], pitches as f64 * row.pitch()))
                .collect(),
            Self::Uneven(row) => {
                let last = row.gaps().len();
                let pairs =
                    (0..last).flat_map(|left| (1..=reach).map(move |pitches| (left, pitches)));
                let pairs = pairs.map(|(left, pitches)| {
                    // A pair that would reach beyond the end of the row gets the last scale as a
                    // placeholder. Such a pair is never evaluated.
                    let right = last.min(left + pitches);
                    let distance = (left..right).map(|i| row.pitch(i)).sum();
                    pair_on(body, [row.scales()[left], row.scales()[right]], distance)
                });
                pairs.collect()
            }
        }
    }
}

/// Creates a pair of scales at the arc length `distance` from each other on a body.
///
/// Also returns the tangent frame of the right scale, relative to the frame of the left scale.
fn pair_on(body: Body, scales: [Parallelogram; 2], distance: f64) -> (Pair, Frame) {
    let frame = body.frame(distance);
    (Pair::between(scales, frame.origin), frame)
}

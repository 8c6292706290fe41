//! The scales of a row at rest.

use contact::Pair;
use geometry::{OutOfRange, Parallelogram, Row, UnevenRow, clearance};

/// Scales that are alike at a constant gap, however many, or each with a slant and a gap of its own.
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

    /// The gap between the bases of the scales `i` and `i + 1`.
    pub(crate) fn gap(&self, i: usize) -> f64 {
        match self {
            Self::Even(row) => row.gap(),
            Self::Uneven(row) => row.gaps()[i],
        }
    }

    /// Distance of the nodes of the scales `i` and `i + 1`.
    pub(crate) fn pitch(&self, i: usize) -> f64 {
        match self {
            Self::Even(row) => row.pitch(),
            Self::Uneven(row) => row.pitch(i),
        }
    }

    /// The scales `i` and `i + 1` alone.
    ///
    /// # Errors
    /// None: they stood clear of each other in the row.
    pub(crate) fn pair(&self, i: usize) -> Result<Self, OutOfRange> {
        let scales = vec![self.scale(i), self.scale(i + 1)];
        UnevenRow::new(scales, vec![self.gap(i)]).map(Self::Uneven)
    }

    /// Distance of the node of scale `i` from that of the first.
    pub(crate) fn place(&self, i: usize) -> f64 {
        match self {
            Self::Even(row) => i as f64 * row.pitch(),
            Self::Uneven(row) => row.place(i),
        }
    }

    /// The narrowest distance of the scales `i` and `i + 1` across the steeper of their sides.
    pub(crate) fn clearance(&self, i: usize) -> f64 {
        let [left, right] = [self.scale(i), self.scale(i + 1)];
        // The distance along the row, times the cosine of a side, is that across it: the steeper
        // side gives the lower bound. Single scales may lean to the left.
        let steepest = left.slant().abs().max(right.slant().abs());
        clearance(&left, &right, self.gap(i)) * steepest.cos()
    }

    /// Mean distance of neighbouring nodes.
    pub(crate) fn mean_pitch(&self) -> f64 {
        match self {
            Self::Even(row) => row.pitch(),
            Self::Uneven(row) => row.length() / row.gaps().len() as f64,
        }
    }

    /// The gaps over the length that they and the bases of the scales have, `Σd/Σp`: the compliance of a strip without contact.
    pub(crate) fn share_of_gaps(&self) -> f64 {
        match self {
            Self::Even(row) => row.gap() / row.pitch(),
            Self::Uneven(row) => row.gaps().iter().sum::<f64>() / row.length(),
        }
    }

    /// The pairs of scales with up to `reach` pitches between them, by their left scale and then by their distance; of scales that are
    /// alike one for each distance.
    pub(crate) fn pairs(&self, reach: usize) -> Vec<Pair> {
        match self {
            Self::Even(row) => (1..=reach)
                .map(|pitches| Pair::new(*row.scale(), pitches as f64 * row.pitch()))
                .collect(),
            Self::Uneven(row) => {
                let last = row.gaps().len();
                let pair = |left: usize, right: usize| {
                    let pitch = (left..right).map(|i| row.pitch(i)).sum();
                    Pair::of([row.scales()[left], row.scales()[right]], pitch)
                };
                // Beyond the end of the row the last scale stands for those that are not there: nothing asks for these pairs.
                let of =
                    |left| (1..=reach).map(move |pitches| pair(left, last.min(left + pitches)));
                (0..last).flat_map(of).collect()
            }
        }
    }
}

//! All ways to share a whole weight among four criteria, on a grid.

/// The nodes of a regular grid in the tetrahedron of weights: `resolution` steps from each corner
/// to the next.
///
/// ```text
/// w = (i, j, k, l)/R,    i + j + k + l = R                                          (R4)
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TetrahedralGrid {
    resolution: u32,
}

impl Default for TetrahedralGrid {
    /// Steps of a twentieth.
    fn default() -> Self {
        Self { resolution: 20 }
    }
}

/// Steps of a node from the face opposite to each corner; they sum to the resolution.
pub type Steps = [u32; 4];

/// A resolution that no grid has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{found} is not accepted, expected a whole number of steps from 1 to {}",
    TetrahedralGrid::FINEST
)]
pub struct InvalidResolution {
    /// The text that was given.
    pub found: String,
}

impl std::str::FromStr for TetrahedralGrid {
    type Err = InvalidResolution;

    fn from_str(text: &str) -> Result<Self, InvalidResolution> {
        let resolution = text.parse().ok().filter(|steps| (1..=Self::FINEST).contains(steps));
        let error = || InvalidResolution { found: text.to_owned() };
        resolution.map(|resolution| Self { resolution }).ok_or_else(error)
    }
}

impl TetrahedralGrid {
    /// Most steps from corner to corner: some 1.4 million nodes.
    pub const FINEST: u32 = 200;

    /// Steps from corner to corner.
    pub fn resolution(self) -> u32 {
        self.resolution
    }

    /// Every node, the weight of the first criterion growing slowest.
    pub fn nodes(self) -> impl Iterator<Item = Steps> {
        let whole = self.resolution;
        (0..=whole).flat_map(move |i| {
            (0..=whole - i)
                .flat_map(move |j| (0..=whole - i - j).map(move |k| [i, j, k, whole - i - j - k]))
        })
    }

    /// The weights of a node.
    pub fn weights(self, steps: Steps) -> [f64; 4] {
        steps.map(|step| f64::from(step) / f64::from(self.resolution))
    }

    /// The part of the tetrahedron that lies nearer to this node than to any other, in units of
    /// [`Self::whole`].
    ///
    /// The nodes form a face-centred cubic lattice of as many cells as nodes. Half of the cell of
    /// a node on a face lies inside; 7/36 of one on an edge, and 1/24 of one at a corner: the only
    /// numbers with which the parts sum to the whole for every resolution.
    pub fn cell(steps: Steps) -> u64 {
        // In units of 1/72 of a cell all of these are whole, so that shares sum to 1 without round-off.
        match steps.iter().filter(|step| **step == 0).count() {
            0 => 72,
            1 => 36,
            2 => 14,
            _ => 3,
        }
    }

    /// The whole tetrahedron: `R³/6` cells.
    pub fn whole(self) -> u64 {
        // `72 R³/6`, as cells count 72 each.
        12 * u64::from(self.resolution).pow(3)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_grid_of_two_steps_has_corners_and_middles_of_edges() {
        let grid = TetrahedralGrid { resolution: 2 };
        let nodes: Vec<_> = grid.nodes().collect();
        assert_eq!(nodes.len(), 10);
        assert_eq!(nodes[0], [0, 0, 0, 2]);
        assert_eq!(nodes[9], [2, 0, 0, 0]);
        assert_eq!(grid.weights([1, 0, 1, 0]).map(|w| w * 4.0), [2.0, 0.0, 2.0, 0.0]);
    }

    #[test]
    fn resolutions_are_whole_numbers() {
        assert_eq!("20".parse(), Ok(TetrahedralGrid { resolution: 20 }));
        for wrong in ["0", "-1", "201", "2.5", ""] {
            assert!(wrong.parse::<TetrahedralGrid>().is_err());
        }
    }

    proptest! {
        #[test]
        fn cells_fill_the_tetrahedron(resolution in 1_u32..60) {
            let grid = TetrahedralGrid { resolution };
            let sum: u64 = grid.nodes().map(TetrahedralGrid::cell).sum();
            prop_assert_eq!(sum, grid.whole());
            let steps = grid.nodes().all(|steps| steps.iter().sum::<u32>() == resolution);
            prop_assert!(steps);
        }
    }
}

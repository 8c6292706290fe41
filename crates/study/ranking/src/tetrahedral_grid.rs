//! A grid of all weights of four criteria.

/// Nodes of a regular grid in the tetrahedron of weights.
///
/// The grid has `resolution` steps along each edge.
///
/// ```text
/// w = (i, j, k, l)/R,    i + j + k + l = R                                          (R4)
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TetrahedralGrid {
    resolution: u32,
}

impl Default for TetrahedralGrid {
    /// Returns the grid with 20 steps along each edge.
    fn default() -> Self {
        Self { resolution: 20 }
    }
}

/// Weights of a node, in steps of the grid. The sum of the steps is the resolution.
pub type Steps = [u32; 4];

/// Error: the resolution of a grid is not valid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{found} is not accepted, expected a whole number of steps from 1 to {}",
    TetrahedralGrid::FINEST
)]
pub struct InvalidResolution {
    /// The invalid text.
    pub found: String,
}

impl std::str::FromStr for TetrahedralGrid {
    type Err = InvalidResolution;

    fn from_str(text: &str) -> Result<Self, InvalidResolution> {
        let resolution = text.parse().ok().filter(|steps| (1..=Self::FINEST).contains(steps));
        resolution
            .map(|resolution| Self { resolution })
            .ok_or_else(|| InvalidResolution { found: text.to_owned() })
    }
}

impl TetrahedralGrid {
    /// Maximum number of steps along an edge, for about 1.4 million nodes.
    pub const FINEST: u32 = 200;

    /// Returns the number of steps along an edge.
    pub fn resolution(self) -> u32 {
        self.resolution
    }

    /// Returns all nodes, in an order in which the weight of the first criterion changes slowest.
    pub fn nodes(self) -> impl Iterator<Item = Steps> {
        let whole = self.resolution;
        (0..=whole).flat_map(move |i| {
            (0..=whole - i)
                .flat_map(move |j| (0..=whole - i - j).map(move |k| [i, j, k, whole - i - j - k]))
        })
    }

    /// Returns the weights of a node.
    pub fn weights(self, steps: Steps) -> [f64; 4] {
        steps.map(|step| f64::from(step) / f64::from(self.resolution))
    }

    /// Returns the part of the tetrahedron's volume closest to a node (R5), in 1/72 of a cell.
    ///
    /// The nodes form a face-centred cubic lattice, with one cell per node. The tetrahedron
    /// contains half of the cell of a node on a face, 7/36 of a cell on an edge, and 1/24 of a cell
    /// at a corner. Only with these fractions the cells fill the tetrahedron for every resolution.
    pub fn cell(steps: Steps) -> u64 {
        // The unit 1/72 of a cell makes all volumes integers, so that fractions sum to 1 exactly.
        match steps.iter().filter(|step| **step == 0).count() {
            0 => 72,
            1 => 36,
            2 => 14,
            _ => 3,
        }
    }

    /// Returns the volume of the tetrahedron, `R³/6` cells, in units of 1/72 of a cell.
    pub fn whole(self) -> u64 {
        // 72 R³/6 = 12 R³.
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
    fn resolutions_are_positive_integers() {
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

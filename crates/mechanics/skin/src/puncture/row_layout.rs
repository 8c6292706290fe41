//! Layout of the unknowns of a row.

use solver::Blocks;

/// Layout of the unknowns: scales, contact forces, load.
///
/// ```text
/// x y φ · λ λ' λ" λ λ' λ" | … | x y φ · F · λ λ' λ" λ λ' λ" | … | x y φ
/// scale 0  upper   lower       punctured                           last
/// ```
///
/// With friction each contact also has a stick multiplier and a slip distance. For a guided needle,
/// its unknowns follow the load. For a free needle on elastic scales, depth and total tilt follow
/// the load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RowLayout {
    /// Scales to the left of the punctured one.
    pub(crate) left: usize,
    /// Scales to the right of the punctured one.
    pub(crate) right: usize,
    /// Number of unknowns that follow the load; 0 for a free needle on rigid scales.
    pub(crate) needle: usize,
    /// Number of contact unknowns of a scale with the scales on its right.
    ///
    /// They belong to one pair of scales, or to several pairs if distant scales may touch.
    pub(crate) contacts: usize,
}

impl RowLayout {
    /// Counts the unknowns of a scale and of its contacts with scales on its right.
    pub(super) fn block(self) -> usize {
        3 + self.contacts
    }

    /// Returns the number of scales.
    pub(crate) fn scales(self) -> usize {
        self.left + 1 + self.right
    }

    /// Converts the index of a scale to its number, counted from the punctured scale.
    ///
    /// Numbers of scales to the right are positive.
    pub(crate) fn number(self, scale: usize) -> i64 {
        (scale.cast_signed() - self.left.cast_signed()) as i64
    }

    /// Returns the number of unknowns.
    pub(crate) fn size(self) -> usize {
        // The last scale has no contacts on its right.
        self.block() * self.scales() - self.contacts + 1 + self.needle
    }

    /// Returns the index of the unknown `x` of a scale; `y` and `φ` follow.
    pub(crate) fn scale(self, scale: usize) -> usize {
        self.block() * scale + if scale > self.left { 1 + self.needle } else { 0 }
    }

    /// Returns the index of the load.
    pub(crate) fn load(self) -> usize {
        self.block() * self.left + 3
    }

    /// Returns the blocks of the tangent, one for each scale.
    ///
    /// A block also holds the forces between its scale and the next scale towards the root. The
    /// root is the punctured scale if a scale is coupled with direct neighbours only (`reach` 1),
    /// otherwise the last scale.
    pub(super) fn blocks(self, reach: usize) -> Blocks {
        let scales = 0..self.scales();
        let root = if reach == 1 { self.left } else { self.left + self.right };
        Blocks {
            starts: scales
                .clone()
                .map(|scale| {
                    if scale <= root {
                        self.scale(scale)
                    } else {
                        self.force(self.contacts * (scale - 1))
                    }
                })
                .collect(),
            links: scales.map(|scale| self.scale(scale)).collect(),
            root,
            reach,
        }
    }

    /// Returns the units of the equations.
    ///
    /// Equilibrium equations of a scale have its `direct` stiffness as the unit, all others 1.
    pub(super) fn units(self, direct: [f64; 3]) -> Vec<f64> {
        let mut units = vec![1.0; self.size()];
        for scale in 0..self.scales() {
            units[self.scale(scale)..][..3].copy_from_slice(&direct);
        }
        units
    }

    /// Returns the index of the unknown of contact force number `force`.
    ///
    /// Forces are numbered along the row. If only direct neighbours may touch, without friction,
    /// the pair of scales `i` and `i + 1` has the numbers `6 i` to `6 i + 5`: three forces of the
    /// upper contact, then three of the lower one.
    pub(crate) fn force(self, force: usize) -> usize {
        let left = force / self.contacts;
        let behind_load = if left >= self.left { 1 + self.needle } else { 0 };
        self.block() * left + 3 + force % self.contacts + behind_load
    }
}

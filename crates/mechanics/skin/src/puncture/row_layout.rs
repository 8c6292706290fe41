//! Layout of the unknowns of a row.

use solver::Blocks;

/// Layout of the unknowns: scales, contact forces, load.
///
/// ```text
/// x y φ · λ λ' λ" λ λ' λ" | … | x y φ · F · λ λ' λ" λ λ' λ" | … | x y φ
/// scale 0  upper   lower       punctured                           last
/// ```
///
/// With friction each contact also has a stick multiplier and a slip distance. The unknowns of a
/// guided needle follow the load. For a free needle on elastic scales, depth and total tilt follow
/// it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RowLayout {
    /// Scales to the left of the punctured one.
    pub(crate) left: usize,
    /// Scales to the right of the punctured one.
    pub(crate) right: usize,
    /// Number of unknowns of a guided needle after the load; 0 for a free needle on rigid scales.
    pub(crate) needle: usize,
    /// Contact unknowns of a scale with scales on its right.
    ///
    /// They are one pair, unless distant scales touch.
    pub(crate) contacts: usize,
}

impl RowLayout {
    /// Counts the unknowns of a scale and of its contacts on the right.
    pub(super) fn block(self) -> usize {
        3 + self.contacts
    }

    pub(crate) fn scales(self) -> usize {
        self.left + 1 + self.right
    }

    /// Converts an index to the number counted from the punctured scale.
    ///
    /// Numbers are positive to the right.
    pub(crate) fn number(self, scale: usize) -> i64 {
        (scale.cast_signed() - self.left.cast_signed()) as i64
    }

    /// Returns the number of unknowns.
    pub(crate) fn size(self) -> usize {
        // The last scale has no contacts on its right.
        self.block() * self.scales() - self.contacts + 1 + self.needle
    }

    /// Returns the first of the three unknowns of a scale.
    pub(crate) fn scale(self, scale: usize) -> usize {
        self.block() * scale + if scale > self.left { 1 + self.needle } else { 0 }
    }

    pub(crate) fn load(self) -> usize {
        self.block() * self.left + 3
    }

    /// Returns one block per scale, with the contact forces on the side of the root.
    ///
    /// The root is the punctured scale, or the last scale if the substrate couples more than direct
    /// neighbours (`reach`).
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
    /// They are the direct stiffness for balances, 1 elsewhere.
    pub(super) fn units(self, direct: [f64; 3]) -> Vec<f64> {
        let mut units = vec![1.0; self.size()];
        for scale in 0..self.scales() {
            units[self.scale(scale)..][..3].copy_from_slice(&direct);
        }
        units
    }

    /// Returns the unknown of a contact force.
    ///
    /// Forces are numbered along the row: with reach 1 and no friction, pair `i`, `i + 1` starts at
    /// `6 i`, the three of the upper contact first.
    pub(crate) fn force(self, force: usize) -> usize {
        let left = force / self.contacts;
        let behind_load = if left >= self.left { 1 + self.needle } else { 0 };
        self.block() * left + 3 + force % self.contacts + behind_load
    }
}

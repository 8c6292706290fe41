//! Stability of a row under load, depth or tilt control.

use solver::{SkylineMatrix, System};

use super::system::Chain;
use crate::contacts::SkinState;

/// Placeholder for the row of an unknown that is not part of the stiffness matrix.
const LEFT_OUT: usize = usize::MAX;

/// Numbers of negative eigenvalues of the tangent stiffness of a row.
///
/// Each negative eigenvalue is an independent motion that releases energy. An equilibrium is stable
/// if there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Instability {
    /// Number at constant load, for example of a weight.
    pub load: usize,
    /// Number at constant depth of the loaded point, for example of a screw.
    pub depth: usize,
    /// Number at constant tilt of the punctured scale.
    pub tilt: usize,
}

impl Chain {
    /// Counts the negative eigenvalues at an equilibrium.
    ///
    /// `None` if the stiffness is exactly singular, or not symmetric because of friction.
    ///
    /// `K` is the stiffness of the loaded row, `p` the gradient of the depth and `e` the unit tilt.
    /// A constant depth removes one negative eigenvalue if `pᵀ K⁻¹ p < 0`, i.e. `du/dF < 0`. A
    /// constant tilt removes one if its compliance `eᵀ K⁻¹ e` is negative (P5). Two corners in
    /// contact on a ridge of the energy add one: the constraint of their contact keeps them
    /// together, and so hides this unstable motion from `K`.
    pub(super) fn instability(&self, state: &SkinState) -> Option<Instability> {
        if self.is_nonconservative(state) {
            return None;
        }
        let unknowns = self.stiffness_unknowns(state);
        let mut index = vec![LEFT_OUT; self.layout.size()];
        for (row, &unknown) in unknowns.iter().enumerate() {
            index[unknown] = row;
        }
        let factors = self.stiffness_matrix(state, unknowns.len(), &index).factorise().ok()?;
        // All unknowns of the stiffness are forces, except the motions of scales and needle.
        let motions = 3 * self.layout.scales() + usize::from(self.needle.is_some());
        let forces = unknowns.len() - motions;
        // Each force unknown is a multiplier, which adds one negative eigenvalue without a motion.
        let without_ridges = factors.negative_eigenvalues().checked_sub(forces)?;
        let load = without_ridges + self.contacts.ridges(state);
        let at = self.layout.scale(self.layout.left);
        let arm = self.loaded_arm(&state.z);
        let [mut depth, mut tilt] = match &self.needle {
            Some(needle) => [vec![(needle.depth, 1.0)], vec![(at + 2, 1.0)]],
            None => [vec![(at + 1, 1.0), (at + 2, arm.x)], vec![(at + 2, 1.0)]],
        };
        let mut of_beam = [0.0; 2];
        if self.is_elastic {
            [(depth, of_beam[0]), (tilt, of_beam[1])] = self.bending_loads(state);
        }
        let [depth, tilt] = [(depth, of_beam[0]), (tilt, of_beam[1])].map(|(loads, of_beam)| {
            let mut x = vec![0.0; unknowns.len()];
            for &(unknown, load) in &loads {
                x[index[unknown]] += load;
            }
            factors.solve(&mut x);
            let motions = loads.iter().map(|&(unknown, load)| load * x[index[unknown]]);
            let compliance = motions.sum::<f64>() + of_beam;
            load.saturating_sub(usize::from(compliance < 0.0))
        });
        Some(Instability { load, depth, tilt })
    }

    /// Lists the unknowns of the stiffness: displacements, contact forces, needle forces.
    ///
    /// Forces are not eliminated, because the compliance of a contact may be zero.
    fn stiffness_unknowns(&self, state: &SkinState) -> Vec<usize> {
        let scales = (0..self.layout.scales()).map(|scale| self.layout.scale(scale));
        let mut unknowns: Vec<usize> = scales.flat_map(|at| at..at + 3).collect();
        unknowns.extend(self.contacts.forces_in_stiffness(state));
        unknowns.extend(self.needle_in_stiffness(state));
        unknowns.sort_unstable();
        unknowns
    }

    /// Assembles the symmetric stiffness; `index` maps each unknown to its row.
    fn stiffness_matrix(&self, state: &SkinState, size: usize, index: &[usize]) -> SkylineMatrix {
        let mut entries = Vec::new();
        let mut entry =
            |row: usize, column: usize, value| entries.push((index[row], index[column], value));
        self.constant_tangent(&mut entry);
        self.for_bars(&state.z, |nodes, bar| bar.add_stiffness(nodes, &mut entry));
        if self.needle.is_some() {
            self.for_needle_stiffness(state, &mut entry);
        } else {
            // The arm of a dead load rotates with the scale, which changes its moment.
            let turn = self.layout.scale(self.layout.left) + 2;
            entry(turn, turn, -state.z[self.layout.load()] * self.loaded_arm(&state.z).y);
        }
        self.contacts.for_stiffness(state, &mut entry);
        self.for_bending_stiffness(state, entry);
        let mut first: Vec<usize> = (0..size).collect();
        for &(row, column, _) in &entries {
            first[row] = first[row].min(column);
        }
        let mut matrix = SkylineMatrix::new(first);
        for (row, column, value) in entries {
            matrix.add(row, column, value);
        }
        matrix
    }
}

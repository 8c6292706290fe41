//! What the closed contacts of a row add to its equations and to their tangent.

use contact::{COORDINATES, CornerContact, CornerResponse, Equation, FORCES};
use solver::{Residual, Tangent};

use super::rubbing::Rub;
use super::{Contacts, LEVELS, SkinState};

impl Contacts {
    /// Adds what the closed contacts contribute to the equations and to the tangent.
    pub(crate) fn linearise(
        &self,
        state: &SkinState,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let mut turned = None;
        for (pair, modes) in state.mode.contacts.chunks_exact(LEVELS.len()).enumerate() {
            // Most pairs are open, and add nothing that would need their poses.
            if modes.iter().all(|mode| *mode == CornerContact::Open) {
                continue;
            }
            let poses = self.poses_of(&state.z, pair, &mut turned);
            for (contact, mode) in Self::contacts_of(pair).zip(modes) {
                if *mode == CornerContact::Open {
                    continue;
                }
                let corners = self.corners(contact, &poses);
                let (forces, held) =
                    (self.forces_of(&state.z, contact), self.held(&state.mode, contact));
                let response = mode.acting_response(&corners, &self.law, forces, held);
                // In a row coordinates are unknowns, so whole blocks are added. In a strip a
                // rotation is the difference of two unknowns, and entries are added one by one.
                match self.whole_pair(contact) {
                    Some(scales) => {
                        self.add_blocks(
                            contact,
                            mode.acting(),
                            &response,
                            scales,
                            residual,
                            matrix,
                        );
                    }
                    None => self.add_parts(contact, mode.acting(), &response, residual, matrix),
                }
            }
        }
        // Friction is looked at apart: without it this pass costs nothing.
        if self.rub() {
            for pair in self.whole_pairs() {
                if Self::contacts_of(pair).any(|contact| state.mode.rubs[contact] != Rub::None) {
                    let poses = self.poses_of(&state.z, pair, &mut None);
                    self.add_friction(state, pair, &poses, residual, matrix);
                }
            }
        }
    }

    /// The first unknowns of the scales of a contact's pair, where its coordinates are unknowns, three of each scale in succession.
    pub(super) fn whole_pair(&self, contact: usize) -> Option<[usize; 2]> {
        let [left, right] = self.ends(Self::pair_of(contact));
        let scales = [self.scales[left]?, self.scales[right]?];
        (!self.relative).then_some(scales)
    }

    /// Adds a response where the coordinates of the pair are unknowns, three of each of the `scales` in succession.
    fn add_blocks(
        &self,
        contact: usize,
        acting: [bool; FORCES],
        response: &CornerResponse,
        scales: [usize; 2],
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let unknowns = self.unknowns_of(contact);
        let three = |row: &[f64; COORDINATES], side: usize| -> [f64; 3] {
            std::array::from_fn(|k| row[3 * side + k])
        };
        for (i, row) in scales.into_iter().enumerate() {
            let balance: [&Equation; 3] = std::array::from_fn(|k| &response.balance[3 * i + k]);
            for (k, equation) in balance.iter().enumerate() {
                residual.add(row + k, equation.value);
            }
            for (j, column) in scales.into_iter().enumerate() {
                let block = balance.map(|equation| three(&equation.by_coordinate, j));
                matrix.add_block(row, column, &block);
            }
            for force in (0..FORCES).filter(|&force| acting[force]) {
                let column = balance.map(|equation| [equation.by_force[force]]);
                matrix.add_block(row, unknowns[force], &column);
            }
        }
        // The condition of a force stands in the row of its own unknown.
        for force in (0..FORCES).filter(|&force| acting[force]) {
            let Some(condition) = &response.conditions[force] else { continue };
            residual.add(unknowns[force], condition.value);
            for (j, column) in scales.into_iter().enumerate() {
                matrix.add_block(unknowns[force], column, &[three(&condition.by_coordinate, j)]);
            }
            for other in (0..FORCES).filter(|&other| acting[other]) {
                matrix.add(unknowns[force], unknowns[other], condition.by_force[other]);
            }
        }
    }

    /// Adds a response where coordinates of the pair are sums of unknowns.
    fn add_parts(
        &self,
        contact: usize,
        acting: [bool; FORCES],
        response: &CornerResponse,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let parts = self.parts(contact);
        let unknowns = self.unknowns_of(contact);
        let mut add_row = |row: usize, sign: f64, equation: &Equation| {
            residual.add(row, sign * equation.value);
            for part in parts.iter().flatten() {
                let slope = part.sign * equation.by_coordinate[part.coordinate];
                matrix.add(row, part.unknown, sign * slope);
            }
            for force in (0..FORCES).filter(|&force| acting[force]) {
                matrix.add(row, unknowns[force], sign * equation.by_force[force]);
            }
        };
        // The balance of a coordinate belongs to the rows of all unknowns that it is made of.
        for part in parts.iter().flatten() {
            add_row(part.unknown, part.sign, &response.balance[part.coordinate]);
        }
        for force in (0..FORCES).filter(|&force| acting[force]) {
            if let Some(condition) = &response.conditions[force] {
                add_row(unknowns[force], 1.0, condition);
            }
        }
    }
}

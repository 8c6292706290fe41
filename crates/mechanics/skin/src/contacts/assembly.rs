//! Contributions of the closed contacts to residual and tangent.

use contact::{CornerContact, CornerResponse, FORCES};
use solver::{Residual, Tangent};

use super::friction::FrictionState;
use super::{Contacts, LEVELS, SkinState};

impl Contacts {
    /// Adds the closed contacts to the residual and the tangent.
    pub(crate) fn linearise(
        &self,
        state: &SkinState,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let mut turned = None;
        for (pair, modes) in state.mode.contacts.chunks_exact(LEVELS.len()).enumerate() {
            // Most pairs are open: skip them before computing poses.
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
                    (self.forces_of(&state.z, contact), self.locked_ratio(&state.mode, contact));
                let response = mode.acting_response(&corners, &self.law, forces, held);
                self.add_response(contact, mode.acting(), &response, residual, matrix);
            }
        }
        // Separate loop, so that rows without friction pay nothing for it.
        if self.has_friction() {
            for pair in self.whole_pairs() {
                if Self::contacts_of(pair)
                    .any(|contact| state.mode.friction_states[contact] != FrictionState::None)
                {
                    let poses = self.poses_of(&state.z, pair, &mut None);
                    self.add_friction(state, pair, &poses, residual, matrix);
                }
            }
        }
    }

    /// Adds the response of a closed contact with the given `acting` forces.
    fn add_response(
        &self,
        contact: usize,
        acting: [bool; FORCES],
        CornerResponse { balance, conditions }: &CornerResponse,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let (pair, unknowns) = (self.pair_unknowns(contact), self.unknowns_of(contact));
        let acting = (0..FORCES).filter(|&force| acting[force]);
        pair.add_balance(residual, &balance.map(|equation| equation.value));
        pair.add_square(matrix, &balance.map(|equation| equation.by_coordinate));
        for force in acting.clone() {
            pair.add_column(matrix, unknowns[force], &balance.map(|own| own.by_force[force]));
        }
        // The condition of a force is the equation in the row of its own unknown.
        for force in acting.clone() {
            let Some(condition) = &conditions[force] else { continue };
            residual.add(unknowns[force], condition.value);
            pair.add_row(matrix, unknowns[force], &condition.by_coordinate);
            for other in acting.clone() {
                matrix.add(unknowns[force], unknowns[other], condition.by_force[other]);
            }
        }
    }
}

//! Adds the closed contacts to the residual and the tangent of a row or a strip.

use contact::{CornerContact, CornerResponse, Curvature, FORCES, Force, Gap};
use solver::{Residual, Tangent};

use super::friction::FrictionState;
use super::pair_unknowns::PairUnknowns;
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
            // Skip open pairs, which are the majority, before computing poses.
            if modes.iter().all(|mode| *mode == CornerContact::Open) {
                continue;
            }
            let poses = self.poses_of(&state.z, pair, &mut turned);
            for (contact, mode) in Self::contacts_of(pair).zip(modes) {
                if *mode == CornerContact::Open {
                    continue;
                }
                let corners = self.corners(contact, &poses);
                if let (CornerContact::Edge(edge), PairUnknowns::Blocks(scales)) =
                    (*mode, self.pair_unknowns(contact))
                {
                    let force = self.unknowns_of(contact)[Force::Own as usize];
                    self.add_edge(&corners.gap(edge), scales, force, &state.z, residual, matrix);
                    continue;
                }
                let (forces, held) =
                    (self.forces_of(&state.z, contact), self.locked_ratio(&state.mode, contact));
                let response = mode.acting_response(&corners, &self.law, forces, held);
                self.add_response(contact, mode.acting(), &response, residual, matrix);
            }
        }
        // Friction has a separate loop, so that rows without friction are not slowed down.
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

    /// Adds a contact of a corner on an edge, in a row on a flat body.
    ///
    /// This is a fast path for the majority of contacts: it omits derivatives that vanish. The
    /// other terms equal the terms of [`CornerContact::acting_response`].
    fn add_edge(
        &self,
        gap: &Gap,
        scales: [usize; 2],
        unknown: usize,
        z: &[f64],
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let (force, approach) = (z[unknown], self.law.approach(z[unknown]));
        let Curvature { corner_is_left, normal_turned, arm, distance } = gap.curvature;
        let [left, right] = scales;
        let (corner, edge) = if corner_is_left { (left, right) } else { (right, left) };
        let [x, y, turn, both] =
            [normal_turned.x, normal_turned.y, arm, distance].map(|entry| -force * entry);
        // Add the left scale before the right scale, as for other contacts, because the order of a
        // sum affects its last digit.
        for is_by_corner in [corner_is_left, !corner_is_left] {
            if is_by_corner {
                matrix.add(corner + 2, corner + 2, -turn);
                matrix.add_block(edge + 2, corner, &[[x, y, turn]]);
            } else {
                matrix.add_block(corner, edge + 2, &[[x], [y], [turn]]);
                matrix.add_block(edge, edge, &[[0.0, 0.0, -x], [0.0, 0.0, -y], [-x, -y, both]]);
            }
        }
        for (scale, &[x, y, turn]) in scales.into_iter().zip(gap.gradient.as_chunks::<3>().0) {
            for (row, slope) in (scale..).zip([x, y, turn]) {
                residual.add(row, -force * slope);
            }
            matrix.add_block(scale, unknown, &[[-x], [-y], [-turn]]);
            matrix.add_block(unknown, scale, &[[x, y, turn]]);
        }
        residual.add(unknown, gap.value + approach.value);
        matrix.add(unknown, unknown, approach.slope);
    }

    /// Adds the response of a closed contact; `acting` flags its active forces.
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
        // The condition of a force is the equation in the row of the unknown of this force.
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

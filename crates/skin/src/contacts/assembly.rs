//! What the closed contacts of a row add to its equations and to their tangent.

use contact::{COORDINATES, CornerContact, CornerResponse, Equation, FORCES};
use solver::{Residual, Tangent};

use super::rubbing::Rub;
use super::{Contacts, LEVELS, Part, SkinState};

impl Contacts {
    /// Adds what the closed contacts contribute to the equations and to the tangent.
    pub(crate) fn linearise(
        &self,
        state: &SkinState,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        self.for_closed(state, |contact, acting, response| {
            self.add_response(contact, acting, response, residual);
            self.add_derivatives(contact, acting, response, matrix);
        });
        if self.rub() {
            for left in 0..self.scales.len() - 1 {
                if Self::contacts_of(left).any(|contact| state.mode.rubs[contact] != Rub::None) {
                    let poses = [self.left_pose(&state.z, left), self.pose(&state.z, left + 1)];
                    self.add_friction(state, left, &poses, residual, matrix);
                }
            }
        }
    }

    /// Shows the response of every closed contact, and which of its forces act.
    fn for_closed(
        &self,
        state: &SkinState,
        mut show: impl FnMut(usize, [bool; FORCES], &CornerResponse),
    ) {
        for (left, modes) in state.mode.chunks_exact(LEVELS.len()).enumerate() {
            if modes.iter().all(|mode| *mode == CornerContact::Open) {
                continue;
            }
            let poses = [self.left_pose(&state.z, left), self.pose(&state.z, left + 1)];
            for (contact, mode) in Self::contacts_of(left).zip(modes) {
                if *mode != CornerContact::Open {
                    let forces = self.forces_of(&state.z, contact);
                    let corners = self.corners(contact, &poses);
                    show(
                        contact,
                        mode.acting(),
                        &mode.acting_response(
                            &corners,
                            &self.law,
                            forces,
                            self.held(&state.mode, contact),
                        ),
                    );
                }
            }
        }
    }

    fn add_response(
        &self,
        contact: usize,
        acting: [bool; FORCES],
        response: &CornerResponse,
        residual: &mut Residual,
    ) {
        for Part { unknown, coordinate, sign } in self.parts(contact).into_iter().flatten() {
            residual.add(unknown, sign * response.balance[coordinate].value);
        }
        let unknowns = self.unknowns_of(contact);
        for force in (0..FORCES).filter(|&force| acting[force]) {
            if let Some(condition) = &response.conditions[force] {
                residual.add(unknowns[force], condition.value);
            }
        }
    }

    fn add_derivatives(
        &self,
        contact: usize,
        acting: [bool; FORCES],
        response: &CornerResponse,
        matrix: &mut impl Tangent,
    ) {
        match (
            self.relative,
            self.scales[Self::left(contact)],
            self.scales[Self::left(contact) + 1],
        ) {
            (false, Some(left), Some(right)) => {
                self.add_blocks(contact, acting, response, [left, right], matrix);
            }
            _ => self.add_parts(contact, acting, response, matrix),
        }
    }

    /// Adds derivatives where the coordinates of the pair are unknowns, three of each scale in succession.
    fn add_blocks(
        &self,
        contact: usize,
        acting: [bool; FORCES],
        response: &CornerResponse,
        scales: [usize; 2],
        matrix: &mut impl Tangent,
    ) {
        let unknowns = self.unknowns_of(contact);
        let three = |row: &[f64; COORDINATES], side: usize| -> [f64; 3] {
            std::array::from_fn(|k| row[3 * side + k])
        };
        for (i, row) in scales.into_iter().enumerate() {
            let balance: [&Equation; 3] = std::array::from_fn(|k| &response.balance[3 * i + k]);
            for (j, column) in scales.into_iter().enumerate() {
                let block = balance.map(|equation| three(&equation.by_coordinate, j));
                matrix.add_block(row, column, &block);
            }
            for force in (0..FORCES).filter(|&force| acting[force]) {
                let column = balance.map(|equation| [equation.by_force[force]]);
                matrix.add_block(row, unknowns[force], &column);
            }
        }
        for force in (0..FORCES).filter(|&force| acting[force]) {
            let Some(condition) = &response.conditions[force] else { continue };
            for (j, column) in scales.into_iter().enumerate() {
                matrix.add_block(unknowns[force], column, &[three(&condition.by_coordinate, j)]);
            }
            for other in (0..FORCES).filter(|&other| acting[other]) {
                matrix.add(unknowns[force], unknowns[other], condition.by_force[other]);
            }
        }
    }

    /// Adds derivatives where coordinates of the pair are sums of unknowns.
    fn add_parts(
        &self,
        contact: usize,
        acting: [bool; FORCES],
        response: &CornerResponse,
        matrix: &mut impl Tangent,
    ) {
        let parts = self.parts(contact);
        let unknowns = self.unknowns_of(contact);
        let mut add_row = |row: usize, sign: f64, equation: &Equation| {
            for part in parts.iter().flatten() {
                let slope = part.sign * equation.by_coordinate[part.coordinate];
                matrix.add(row, part.unknown, sign * slope);
            }
            for force in (0..FORCES).filter(|&force| acting[force]) {
                matrix.add(row, unknowns[force], sign * equation.by_force[force]);
            }
        };
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

//! Symmetric stiffness matrix of the closed contacts.

use contact::{CornerContact, FORCES};

use super::{Contacts, SkinState};

impl Contacts {
    /// Iterates over the unknowns of the active contact forces.
    ///
    /// They remain unknowns of the stiffness matrix (C8).
    pub(crate) fn forces_in_stiffness(&self, state: &SkinState) -> impl Iterator<Item = usize> {
        let contacts = state.mode.contacts.iter().enumerate();
        contacts.flat_map(|(contact, mode)| self.acting_unknowns(contact, *mode))
    }

    fn acting_unknowns(
        &self,
        contact: usize,
        mode: CornerContact,
    ) -> impl Iterator<Item = usize> + use<> {
        let (acting, unknowns) = (mode.acting(), self.unknowns_of(contact));
        (0..FORCES).filter(move |&force| acting[force]).map(move |force| unknowns[force])
    }

    /// Calls `entry(row, column, value)` for each entry of the stiffness of the closed contacts.
    ///
    /// The stiffness is symmetric. It has one negative eigenvalue for each force unknown, in
    /// addition to the negative eigenvalues of the stiffness after elimination of the forces
    /// (Haynsworth 1968, doi 10.1016/0024-3795(68)90050-5).
    pub(crate) fn for_stiffness(
        &self,
        state: &SkinState,
        mut entry: impl FnMut(usize, usize, f64),
    ) {
        for (contact, mode) in state.mode.contacts.iter().enumerate() {
            if *mode == CornerContact::Open {
                continue;
            }
            let poses = self.pair_poses(&state.z, contact);
            let forces = self.forces_of(&state.z, contact);
            let stiffness = mode.stiffness(&self.corners(contact, &poses), &self.law, forces);
            let pair = self.pair_unknowns(contact);
            pair.add_square(&mut entry, &stiffness.by_coordinate);
            // Keep the forces as unknowns: the compliance of a contact vanishes at first touch, so
            // they cannot be eliminated.
            let unknowns: Vec<_> = self.acting_unknowns(contact, *mode).collect();
            for (i, (force, balance)) in unknowns.iter().zip(&stiffness.by_force).enumerate() {
                pair.add_column(&mut entry, *force, balance);
                pair.add_row(&mut entry, *force, balance);
                for (j, other) in unknowns.iter().enumerate() {
                    entry(*force, *other, -stiffness.compliance[i][j]);
                }
            }
        }
    }

    /// Counts the contacts in which the coinciding corners lie on a ridge of the energy.
    pub(crate) fn ridges(&self, state: &SkinState) -> usize {
        state
            .mode
            .contacts
            .iter()
            .enumerate()
            .filter(|(contact, mode)| {
                matches!(mode, CornerContact::Corner(_)) && {
                    let poses = self.pair_poses(&state.z, *contact);
                    mode.is_on_ridge(&self.corners(*contact, &poses))
                }
            })
            .count()
    }
}

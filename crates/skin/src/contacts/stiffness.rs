//! The stiffness of closed contacts as a symmetric matrix.
//!
//! The tangent of a contact, `[[A, B], [C, D]]` in coordinates and forces, is not symmetric: conditions stand in its rows as it suits
//! the path. The stiffness `A − B D⁻¹ C` is, because forces and conditions come from an energy. Where `D` may vanish (at first
//! touch; where a side lies flush) the forces stay in the matrix, with conditions that are scaled and combined until they mirror `B`:
//!
//! ```text
//! [[A, B], [Bᵀ, −T D]],    T C = −Bᵀ
//! ```
//!
//! With `T D ≥ 0` that matrix has one negative eigenvalue for each force, besides those of the stiffness (Haynsworth 1968,
//! doi 10.1016/0024-3795(68)90050-5).

use contact::{COORDINATES, CornerContact, CornerResponse, Equation, FORCES, Force};

use super::{Contacts, SkinState};

/// The parts of a contact's tangent, `B` and `C` by forces, of which one or two act.
struct ContactTangent {
    acting: Vec<usize>,
    by_coordinate: [[f64; COORDINATES]; COORDINATES],
    /// Columns of `B`.
    balances: Vec<[f64; COORDINATES]>,
    conditions: Vec<Equation>,
}

impl ContactTangent {
    fn new(acting: [bool; FORCES], response: &CornerResponse) -> Self {
        let acting: Vec<usize> = (0..FORCES).filter(|&force| acting[force]).collect();
        let balance = |&force: &usize| response.balance.map(|row| row.by_force[force]);
        let condition = |&force: &usize| response.conditions[force].unwrap_or_default();
        Self {
            by_coordinate: response.balance.map(|row| row.by_coordinate),
            balances: acting.iter().map(balance).collect(),
            conditions: acting.iter().map(condition).collect(),
            acting,
        }
    }

    /// `D`, of one or two forces; of one its second row is that of a force that is held.
    fn compliance(&self) -> [[f64; 2]; 2] {
        let entry = |i: usize, j: usize| self.conditions[i].by_force[self.acting[j]];
        match self.acting.len() {
            1 => [[entry(0, 0), 0.0], [0.0, 1.0]],
            _ => [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]],
        }
    }

    /// `A − B D⁻¹ C`.
    fn stiffness(&self) -> [[f64; COORDINATES]; COORDINATES] {
        let inverse = inverse(self.compliance());
        let mut stiffness = self.by_coordinate;
        for (i, row) in stiffness.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let forces = inverse.map(|row| {
                    let terms = row.iter().zip(&self.conditions);
                    terms.map(|(d, condition)| d * condition.by_coordinate[j]).sum::<f64>()
                });
                *entry -= self.balances.iter().zip(forces).map(|(b, f)| b[i] * f).sum::<f64>();
            }
        }
        stiffness
    }

    /// `T D`, with `T = −Bᵀ Cᵀ (C Cᵀ)⁻¹`.
    fn mirrored_compliance(&self) -> [[f64; 2]; 2] {
        let row = |i: usize| self.conditions.get(i).map(|condition| &condition.by_coordinate);
        let squares = self.pairs(|i, j| Some(dot(row(i)?, row(j)?)));
        let mirrored = self.pairs(|i, j| Some(-dot(self.balances.get(i)?, row(j)?)));
        product(product(mirrored, inverse(squares)), self.compliance())
    }

    /// A 2 × 2 matrix of what each two forces have in common, the identity where there is no second force.
    fn pairs(&self, entry: impl Fn(usize, usize) -> Option<f64>) -> [[f64; 2]; 2] {
        let or_identity = |i, j| entry(i, j).unwrap_or(f64::from(u8::from(i == j)));
        std::array::from_fn(|i| std::array::from_fn(|j| or_identity(i, j)))
    }
}

impl Contacts {
    /// The unknowns of the forces that stand in the stiffness of the contacts.
    pub(crate) fn forces_in_stiffness(&self, state: &SkinState) -> impl Iterator<Item = usize> {
        state.mode.iter().enumerate().flat_map(|(contact, mode)| {
            let stay = !matches!(mode, CornerContact::Corner(_));
            let acting = mode.acting();
            let forces =
                Force::ALL.into_iter().filter(move |force| stay && acting[*force as usize]);
            let unknowns = self.unknowns_of(contact);
            forces.map(move |force| unknowns[force as usize])
        })
    }

    /// Shows every entry of the symmetric stiffness of the closed contacts: row, column, value.
    pub(crate) fn for_stiffness(
        &self,
        state: &SkinState,
        mut entry: impl FnMut(usize, usize, f64),
    ) {
        self.for_closed(state, |contact, acting, response| {
            let tangent = ContactTangent::new(acting, response);
            if let CornerContact::Corner(_) = state.mode[contact] {
                self.show_block(contact, &tangent.stiffness(), &mut entry);
            } else {
                self.show_block(contact, &tangent.by_coordinate, &mut entry);
                self.show_forces(contact, &tangent, &mut entry);
            }
        });
    }

    fn show_block(
        &self,
        contact: usize,
        block: &[[f64; COORDINATES]; COORDINATES],
        entry: &mut impl FnMut(usize, usize, f64),
    ) {
        let parts = self.parts(contact);
        for row in parts.iter().flatten() {
            for column in parts.iter().flatten() {
                let value = block[row.coordinate][column.coordinate];
                entry(row.unknown, column.unknown, row.sign * column.sign * value);
            }
        }
    }

    fn show_forces(
        &self,
        contact: usize,
        tangent: &ContactTangent,
        entry: &mut impl FnMut(usize, usize, f64),
    ) {
        let unknowns = self.unknowns_of(contact);
        let compliance = tangent.mirrored_compliance();
        for (i, (&force, balance)) in tangent.acting.iter().zip(&tangent.balances).enumerate() {
            for part in self.parts(contact).iter().flatten() {
                let value = part.sign * balance[part.coordinate];
                entry(part.unknown, unknowns[force], value);
                entry(unknowns[force], part.unknown, value);
            }
            for (j, &other) in tangent.acting.iter().enumerate() {
                entry(unknowns[force], unknowns[other], -compliance[i][j]);
            }
        }
    }
}

fn dot(a: &[f64; COORDINATES], b: &[f64; COORDINATES]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn inverse([[a, b], [c, d]]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let factor = 1.0 / (a * d - b * c);
    [[factor * d, -factor * b], [-factor * c, factor * a]]
}

fn product(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    a.map(|row| std::array::from_fn(|j| row[0] * b[0][j] + row[1] * b[1][j]))
}

//! Friction between neighbouring scales, with stick and slip.
//!
//! The contact force has a component `T` along its edge. On the left scale it acts in the direction
//! of the normal force rotated counter-clockwise by a quarter turn. With the normal forces `Λ` on
//! the edge and the slip coordinate `s` of the left scale in that direction
//!
//! ```text
//! |T| ≤ μ Λ,    stick:  s = s₀, T unknown,    slip:  T = −μ Λ sign ṡ                          (Q1)
//! ```
//!
//! Sticking is an equality constraint. Its unknown is the *stick multiplier* `a = T + μ Λ`, which
//! vanishes where the contact starts to slip forward; backward slip starts where `2 μ Λ − a`
//! vanishes. The unknown of a slipping contact is its slip distance, which only grows: where it
//! would decrease the contact sticks (Q2). Friction thus adds two constraints per contact:
//!
//! ```text
//! 0 ≤ a   while sticking          0 ≤ σ (s − s₀)  ⟂  2 μ Λ − a ≥ 0
//! ```
//!
//! If the sides of a pair lie on each other, its two contacts slide along one line and only the sum
//! of their friction matters. One of them, the *carrier*, then carries the friction of both; the
//! other one is *shared*. Coinciding corners are *locked*: they keep the ratio `T/Λ` with which
//! they met, which is the ratio for sliding on along the edge beyond the corner. A corner at the
//! position of a needle tip moves with the tip. While both slide the corner is locked with the
//! ratio of sliding in that direction; while both stick only the sum of their friction matters, and
//! tip and corner take equal fractions of their limits ([`TipFriction`]).

use contact::{CornerContact, CornerEdge, FORCES, Force, Gap, Pose, quarter};
use geometry::Vec2;
use solver::{Residual, Tangent};

use super::{Contacts, LEVELS, SkinMode, SkinState};

/// Slots of the friction constraints of a contact, after the force constraints.
pub(super) const STICK_MULTIPLIER: usize = FORCES;
pub(super) const SLIP_DISTANCE: usize = FORCES + 1;

/// Normal forces below this belong to a contact that has just closed.
pub(super) const NO_FORCE: f64 = 1e-12;

/// Relative tolerance within which `|T/Λ|` equals the coefficient of friction.
const SLIDES: f64 = 1e-9;

/// Friction state of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum FrictionState {
    /// Open, or the other contact of the pair carries its friction.
    #[default]
    None,
    /// Sticks at the slip coordinate `anchor`.
    Stick {
        /// Slip coordinate `s₀`.
        anchor: f64,
    },
    /// Slips with the sign of `ṡ`, since `s` was `start`.
    Slip {
        /// `σ`, 1 or −1.
        sign: f64,
        /// `s` at the start of slip.
        start: f64,
    },
    /// Locked with a constant ratio `T/Λ`.
    ///
    /// The corners coincide, or a needle tip is at the corner.
    Locked {
        /// Ratio `T/Λ`.
        ratio: f64,
    },
    /// A sticking needle tip is at the corner.
    ///
    /// The unknown is `T + 2 μ Λ`, which vanishes only with `Λ`, because the tip determines the
    /// limits of friction.
    WithTip,
}

impl FrictionState {
    /// Returns true if the contact carries friction itself.
    pub(super) fn carries_friction(self) -> bool {
        self != Self::None
    }

    /// Returns true if both stick, both are locked, or both slip in the same direction.
    pub(super) fn is_same_form(self, other: Self) -> bool {
        match (self, other) {
            (Self::Slip { sign, .. }, Self::Slip { sign: of_other, .. }) => sign == of_other,
            _ => std::mem::discriminant(&self) == std::mem::discriminant(&other),
        }
    }

    /// Returns whether the stick and the slip constraint are active.
    pub(super) fn acting(self) -> [bool; 2] {
        [matches!(self, Self::Stick { .. } | Self::WithTip), matches!(self, Self::Slip { .. })]
    }
}

/// Friction of a contact at a sticking needle tip.
pub(crate) struct TipFriction {
    /// Unknown `T + 2 μ Λ` of the contact.
    ///
    /// Its row takes the equation that the tip adds.
    pub(crate) unknown: usize,
    /// `T`.
    pub(crate) traction: f64,
    /// `μ Λ`.
    pub(crate) limit: f64,
    /// `μ`.
    pub(crate) friction: f64,
    /// Unknowns of the normal forces in `Λ`.
    pub(crate) normal_forces: Vec<usize>,
}

/// Friction of a closed contact: state, traction, slip coordinate with derivatives.
struct Sliding {
    friction_state: FrictionState,
    traction: f64,
    /// `∂T/∂Λ` at a constant stick multiplier.
    by_normal_force: f64,
    slide: Gap,
}

impl Contacts {
    /// Returns true if the contact law has friction.
    pub(crate) fn has_friction(&self) -> bool {
        self.law.friction() > 0.0
    }

    /// Returns true if friction acts at any contact.
    pub(crate) fn friction_acts(state: &SkinState) -> bool {
        state
            .mode
            .friction_states
            .iter()
            .any(|friction_state| *friction_state != FrictionState::None)
    }

    /// Counts the sticking and the slipping contacts.
    pub(crate) fn stick_slip_counts(state: &SkinState) -> [usize; 2] {
        [0, 1].map(|k| {
            state
                .mode
                .friction_states
                .iter()
                .filter(|friction_state| friction_state.acting()[k])
                .count()
        })
    }

    /// Returns true if a constraint belongs to friction.
    pub(crate) fn is_friction(&self, constraint: usize) -> bool {
        constraint < self.forces.len() && self.contact_of(constraint).1 >= FORCES
    }

    /// Returns true if a constraint is a friction constraint of a slipping contact.
    pub(crate) fn slips(&self, state: &SkinState, constraint: usize) -> bool {
        // Shared and locked contacts have friction constraints, too, but none of them is active.
        self.is_friction(constraint)
            && state.mode.friction_states[self.contact_of(constraint).0].acting() == [false, true]
    }

    /// Iterates over history variables: anchors, and ratios of locked contacts.
    pub(crate) fn anchors(state: &SkinState) -> impl Iterator<Item = (usize, f64)> {
        let friction_states = state.mode.friction_states.iter().enumerate();
        friction_states.filter_map(|(contact, friction_state)| match friction_state {
            FrictionState::Stick { anchor: kept } | FrictionState::Locked { ratio: kept } => {
                Some((contact, *kept))
            }
            FrictionState::None | FrictionState::Slip { .. } | FrictionState::WithTip => None,
        })
    }

    /// Evaluates in `state` the anchor or ratio that a contact will have in state `to`.
    pub(crate) fn anchor_value(
        &self,
        state: &SkinState,
        contact: usize,
        to: &SkinState,
    ) -> Option<f64> {
        match to.mode.friction_states[contact] {
            FrictionState::Locked { .. } => Some(self.ratio(state, contact)),
            _ => Some(self.slip_coordinate(state, to.mode.contacts[contact].edge()?, contact)),
        }
    }

    /// Shifts the anchor of a contact.
    ///
    /// For a perturbed row, which reaches the same state with another history.
    pub(crate) fn shift_anchor(&mut self, contact: usize, by: f64) {
        self.anchor_shifts.push((contact, by));
    }

    /// Returns the anchor of a contact, given its value in the mode.
    fn shifted_anchor(&self, contact: usize, of_mode: f64) -> f64 {
        let moved = self.anchor_shifts.iter().find(|(moved, _)| *moved == contact);
        of_mode + moved.map_or(0.0, |(_, by)| *by)
    }

    /// Returns the friction ratio of a locked contact; 0 for other contacts.
    pub(super) fn locked_ratio(&self, mode: &SkinMode, contact: usize) -> f64 {
        match mode.friction_states.get(contact) {
            Some(FrictionState::Locked { ratio }) => self.shifted_anchor(contact, *ratio),
            _ => 0.0,
        }
    }

    /// Makes all slipping contacts stick at their current position.
    pub(crate) fn stop_sliding(&self, state: &mut SkinState) {
        for contact in 0..state.mode.friction_states.len() {
            let (FrictionState::Slip { sign, .. }, Some(edge)) =
                (state.mode.friction_states[contact], Self::edge_of(&state.mode, contact))
            else {
                continue;
            };
            // Keep `T` continuous: the multiplier is 0 after forward slip and `2 μ Λ` after
            // backward slip.
            let multiplier = (1.0 - sign) * self.law.friction() * self.normal_force(state, contact);
            state.mode.friction_states[contact] =
                FrictionState::Stick { anchor: self.slip_coordinate(state, edge, contact) };
            self.set_friction(state, contact, multiplier, true);
        }
    }

    /// Computes the friction of a contact as a fraction of its limit, from −1 to 1.
    pub(crate) fn mobilised(&self, state: &SkinState, contact: usize) -> f64 {
        if !self.has_friction() {
            return 0.0;
        }
        self.ratio(state, Self::carrier_of(&state.mode, contact)) / self.law.friction()
    }

    /// Locks the friction of a contact because a needle tip is at its corner.
    ///
    /// The ratio `T/Λ` is unchanged, or with `sliding` it is the ratio of sliding with the tip, and
    /// `sliding` is the sign of `T`.
    pub(crate) fn lock(&self, state: &mut SkinState, contact: usize, sliding: Option<f64>) {
        if !self.has_friction() {
            return;
        }
        let carrier = Self::carrier_of(&state.mode, contact);
        let ratio =
            sliding.map_or_else(|| self.ratio(state, carrier), |sign| sign * self.law.friction());
        state.mode.friction_states[carrier] = FrictionState::Locked { ratio };
        // A locked contact has no friction unknown.
        self.set_friction(state, carrier, 0.0, true);
    }

    /// Makes the corner of a contact stick with the needle tip at its position.
    ///
    /// `T` stays as it is, or takes this `fraction` of its limit.
    pub(crate) fn stick_with_tip(
        &self,
        state: &mut SkinState,
        contact: usize,
        fraction: Option<f64>,
    ) {
        if !self.has_friction() {
            return;
        }
        let carrier = Self::carrier_of(&state.mode, contact);
        let ratio =
            fraction.map_or_else(|| self.ratio(state, carrier), |part| part * self.law.friction());
        let multiplier = (ratio + self.law.friction()) * self.normal_force(state, carrier);
        state.mode.friction_states[carrier] = FrictionState::WithTip;
        self.set_friction(state, carrier, multiplier, true);
    }

    /// Evaluates the friction of a contact that sticks with the tip at its corner.
    pub(crate) fn friction_with_tip(
        &self,
        state: &SkinState,
        contact: usize,
    ) -> Option<TipFriction> {
        if !self.has_friction() {
            return None;
        }
        let carrier = Self::carrier_of(&state.mode, contact);
        if state.mode.friction_states[carrier] != FrictionState::WithTip {
            return None;
        }
        let unknown = self.unknown(carrier, STICK_MULTIPLIER);
        let limit = self.law.friction() * self.normal_force(state, carrier);
        Some(TipFriction {
            unknown,
            traction: state.z[unknown] - 2.0 * limit,
            limit,
            friction: self.law.friction(),
            normal_forces: self.normal_force_unknowns(&state.mode, carrier).collect(),
        })
    }

    /// Releases a contact that a needle tip had locked or made stick.
    ///
    /// It then sticks or slips on its edge. If the needle tip `slides`, a corner at its friction
    /// limit keeps sliding, too.
    pub(crate) fn release(&self, state: &mut SkinState, contact: usize, slides: bool) {
        if !self.has_friction() {
            return;
        }
        let carrier = Self::carrier_of(&state.mode, contact);
        let (FrictionState::Locked { .. } | FrictionState::WithTip, Some(edge)) =
            (state.mode.friction_states[carrier], Self::edge_of(&state.mode, carrier))
        else {
            return;
        };
        let ratio = self.ratio(state, carrier);
        let position = self.slip_coordinate(state, edge, carrier);
        // Keep `T` continuous: it was `ratio Λ` while locked, and the multiplier is `T + μ Λ`.
        let multiplier = (ratio + self.law.friction()) * self.normal_force(state, carrier);
        state.mode.friction_states[carrier] = if slides && self.is_sliding(ratio) {
            // Friction opposes the motion, so the slip has the opposite sign of the ratio.
            FrictionState::Slip { sign: -ratio.signum(), start: position }
        } else {
            FrictionState::Stick { anchor: position }
        };
        self.set_friction(state, carrier, multiplier, true);
    }

    /// Adds the friction of a pair to its balance, and the stick and slip equations.
    pub(super) fn add_friction(
        &self,
        state: &SkinState,
        pair: usize,
        poses: &[Pose; 2],
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        for contact in Self::contacts_of(pair) {
            let Some(sliding) = self.friction_of(state, contact, poses) else { continue };
            let Sliding { friction_state, traction, by_normal_force, slide } = sliding;
            let [multiplier, slip] =
                [STICK_MULTIPLIER, SLIP_DISTANCE].map(|slot| self.unknown(contact, slot));
            let (pair, along) = (self.pair_unknowns(contact), slide.gradient);
            pair.add_balance(residual, &along.map(|slope| -traction * slope));
            pair.add_square(
                matrix,
                &slide.curvature.hessian().map(|row| row.map(|turning| -traction * turning)),
            );
            for force in self.normal_force_unknowns(&state.mode, contact) {
                pair.add_column(matrix, force, &along.map(|slope| -by_normal_force * slope));
            }
            match friction_state {
                FrictionState::Stick { anchor } => {
                    // While sticking `T = a − μ Λ`, so its derivative with respect to the
                    // multiplier is 1.
                    pair.add_column(matrix, multiplier, &along.map(|slope| -slope));
                    residual.add(multiplier, slide.value - self.shifted_anchor(contact, anchor));
                    pair.add_row(matrix, multiplier, &along);
                }
                FrictionState::Slip { sign, start } => {
                    // Counted from the start of slip, so the slip distance starts at zero and only
                    // grows.
                    residual.add(slip, -sign * (slide.value - start));
                    residual.add(slip, state.z[slip]);
                    pair.add_row(matrix, slip, &along.map(|slope| -sign * slope));
                    matrix.add(slip, slip, 1.0);
                }
                // The tip adds the equation of the row.
                FrictionState::WithTip => {
                    pair.add_column(matrix, multiplier, &along.map(|slope| -slope));
                }
                // No active constraint, hence no equation.
                FrictionState::None | FrictionState::Locked { .. } => {}
            }
        }
    }

    /// Evaluates the condition of an inactive friction constraint.
    ///
    /// With a direction for `z` it is the derivative of the condition.
    ///
    /// Only the slip condition of a sticking contact can be violated.
    pub(super) fn slot_condition(
        &self,
        state: &SkinState,
        z: &[f64],
        contact: usize,
        slot: usize,
    ) -> Option<f64> {
        let SkinState { mode, .. } = state;
        let FrictionState::Stick { .. } = mode.friction_states[contact] else { return None };
        if slot != SLIP_DISTANCE {
            return None;
        }
        // Linear in the unknowns, so a direction in place of `z` gives the derivative.
        let normal_force: f64 =
            self.normal_force_unknowns(mode, contact).map(|force| z[force]).sum();
        Some(2.0 * self.law.friction() * normal_force - z[self.unknown(contact, STICK_MULTIPLIER)])
    }

    /// Evaluates the directional derivative of a friction equation or condition.
    pub(super) fn slot_slope(
        &self,
        state: &SkinState,
        direction: &[f64],
        contact: usize,
        slot: usize,
    ) -> f64 {
        match (state.mode.friction_states[contact], slot) {
            (FrictionState::Stick { .. }, STICK_MULTIPLIER) => {
                self.slide_rate(state, direction, contact)
            }
            (FrictionState::Slip { sign, .. }, SLIP_DISTANCE) => {
                direction[self.unknown(contact, SLIP_DISTANCE)]
                    - sign * self.slide_rate(state, direction, contact)
            }
            _ => self.slot_condition(state, direction, contact, slot).unwrap_or(0.0),
        }
    }

    /// Evaluates the directional derivative of the tangential displacement of a contact.
    fn slide_rate(&self, state: &SkinState, direction: &[f64], contact: usize) -> f64 {
        let sliding = self.friction_of(state, contact, &self.pair_poses(&state.z, contact));
        sliding.map_or(0.0, |sliding| {
            self.pair_unknowns(contact).sum(&sliding.slide.gradient, direction)
        })
    }

    /// Fills in the slip conditions, or with a direction for `z` their derivatives.
    ///
    /// Contacts without such a condition get `otherwise`.
    pub(super) fn friction_conditions(
        &self,
        state: &SkinState,
        z: &[f64],
        otherwise: f64,
        values: &mut [f64],
    ) {
        for contact in 0..state.mode.friction_states.len() {
            values[self.slots * contact + SLIP_DISTANCE] =
                self.slot_condition(state, z, contact, SLIP_DISTANCE).unwrap_or(otherwise);
        }
    }

    /// Returns true if the other contact of the pair carries the friction of this one.
    pub(super) fn is_shared(mode: &SkinMode, contact: usize) -> bool {
        mode.friction_states[contact] == FrictionState::None
            && mode.contacts[contact] != CornerContact::Open
            && mode.friction_states[Self::other_contact(contact)].carries_friction()
    }

    /// Returns the contact that carries the friction of a contact.
    fn carrier_of(mode: &SkinMode, contact: usize) -> usize {
        if Self::is_shared(mode, contact) { Self::other_contact(contact) } else { contact }
    }

    /// Returns true if the contact, or the carrier of its friction, slips.
    pub(super) fn is_slipping(mode: &SkinMode, contact: usize) -> bool {
        matches!(mode.friction_states[Self::carrier_of(mode, contact)], FrictionState::Slip { .. })
    }

    /// Iterates over a carrier and the contact that shares it, if any.
    pub(super) fn sharing_contacts(mode: &SkinMode, carrier: usize) -> impl Iterator<Item = usize> {
        let shared =
            Some(Self::other_contact(carrier)).filter(|&other| Self::is_shared(mode, other));
        std::iter::once(carrier).chain(shared)
    }

    /// Computes the friction on the left scale for a given normal force.
    pub(super) fn traction_on_left(
        &self,
        state: &SkinState,
        contact: usize,
        normal_force: Vec2,
    ) -> Vec2 {
        let poses = self.pair_poses(&state.z, contact);
        match (self.friction_of(state, contact, &poses), normal_force.norm()) {
            // Without a force the direction is undefined. Coinciding corners have no edge to slide
            // on; their friction follows from the locked ratio.
            (Some(sliding), size) if size > 0.0 => sliding.traction * quarter(normal_force) / size,
            _ => self.locked_ratio(&state.mode, contact) * quarter(normal_force),
        }
    }

    fn friction_of(&self, state: &SkinState, contact: usize, poses: &[Pose; 2]) -> Option<Sliding> {
        let friction_state = *state.mode.friction_states.get(contact)?;
        let edge = Self::edge_of(&state.mode, contact)?;
        if friction_state == FrictionState::None {
            return None;
        }
        let by_normal_force = self.by_normal_force(contact, friction_state);
        let slide = self.slide(edge, contact, poses);
        let normal_force: f64 =
            self.normal_force_unknowns(&state.mode, contact).map(|force| state.z[force]).sum();
        // Inactive multipliers are zero, so this holds in every friction state.
        let multiplier = state.z[self.unknown(contact, STICK_MULTIPLIER)];
        Some(Sliding {
            friction_state,
            traction: multiplier + by_normal_force * normal_force,
            by_normal_force,
            slide,
        })
    }

    /// Returns `∂T/∂Λ` at a constant multiplier.
    pub(super) fn by_normal_force(&self, contact: usize, friction_state: FrictionState) -> f64 {
        match friction_state {
            FrictionState::Stick { .. } => -self.law.friction(),
            FrictionState::Slip { sign, .. } => -sign * self.law.friction(),
            FrictionState::Locked { ratio } => self.shifted_anchor(contact, ratio),
            FrictionState::WithTip => -2.0 * self.law.friction(),
            FrictionState::None => 0.0,
        }
    }

    /// Returns the edge on which a contact slides; `None` for coinciding corners.
    ///
    /// The contact law rotates the force of coinciding corners.
    pub(super) fn edge_of(mode: &SkinMode, contact: usize) -> Option<CornerEdge> {
        let contact = mode.contacts[contact];
        contact.edge().filter(|_| !matches!(contact, CornerContact::Corner(_)))
    }

    pub(super) fn slide(&self, edge: CornerEdge, contact: usize, [left, right]: &[Pose; 2]) -> Gap {
        self.pair(Self::pair_of(contact)).slide(edge, left, right)
    }

    /// Returns the unknown of a constraint of a contact.
    pub(super) fn unknown(&self, contact: usize, slot: usize) -> usize {
        self.forces[self.slots * contact + slot]
    }

    /// Iterates over the normal-force unknowns on the edge of a carrier.
    ///
    /// The shared contact is included.
    pub(super) fn normal_force_unknowns(
        &self,
        mode: &SkinMode,
        contact: usize,
    ) -> impl Iterator<Item = usize> {
        Self::sharing_contacts(mode, contact).flat_map(move |contact| {
            let acting = mode.contacts[contact].acting();
            let forces = [Force::Own, Force::Flush].map(|force| force as usize);
            let forces = forces.into_iter().filter(move |&force| acting[force]);
            forces.map(move |force| self.unknown(contact, force))
        })
    }

    /// Returns the other contact of the pair.
    pub(super) fn other_contact(contact: usize) -> usize {
        // The two contacts of a pair are consecutive, so their numbers add up to a known sum.
        let first = Self::contacts_of(Self::pair_of(contact)).start;
        2 * first + LEVELS.len() - 1 - contact
    }

    /// Computes `T/Λ` of a contact.
    pub(super) fn ratio(&self, state: &SkinState, contact: usize) -> f64 {
        match state.mode.friction_states[contact] {
            FrictionState::Locked { ratio } => ratio,
            FrictionState::Slip { sign, .. } => -sign * self.law.friction(),
            FrictionState::Stick { .. } | FrictionState::WithTip => {
                let normal_force = self.normal_force(state, contact);
                let multiplier = state.z[self.unknown(contact, STICK_MULTIPLIER)];
                // Without normal force the ratio would be a quotient of round-off errors.
                if normal_force > NO_FORCE {
                    multiplier / normal_force
                        + self.by_normal_force(contact, state.mode.friction_states[contact])
                } else {
                    0.0
                }
            }
            FrictionState::None if Self::is_shared(&state.mode, contact) => {
                // Both slide along one line, so the shared contact has the ratio of its carrier.
                self.ratio(state, Self::other_contact(contact))
            }
            FrictionState::None => 0.0,
        }
    }

    /// Returns true if the ratio equals the coefficient of friction.
    pub(super) fn is_sliding(&self, ratio: f64) -> bool {
        ratio.abs() >= self.law.friction() * (1.0 - SLIDES)
    }

    /// Computes the total normal force on the edge of a carrier.
    pub(super) fn normal_force(&self, state: &SkinState, contact: usize) -> f64 {
        self.normal_force_unknowns(&state.mode, contact).map(|force| state.z[force]).sum()
    }

    /// Computes the slip coordinate `s` of a contact.
    pub(super) fn slip_coordinate(
        &self,
        state: &SkinState,
        edge: CornerEdge,
        contact: usize,
    ) -> f64 {
        self.slide(edge, contact, &self.pair_poses(&state.z, contact)).value
    }
}

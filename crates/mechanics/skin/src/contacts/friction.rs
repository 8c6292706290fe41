//! Friction between neighbouring scales, with stick and slip.
//!
//! The contact force has a tangential component `T` along its edge. On the left scale `T` acts in
//! the direction of the normal force rotated counter-clockwise by a quarter turn. The slip
//! coordinate `s` is the position of the left scale in this direction, and `Λ` is the sum of the
//! normal forces on the edge:
//!
//! ```text
//! |T| ≤ μ Λ,    stick:  s = s₀, T unknown,    slip:  T = −μ Λ sign ṡ                          (Q1)
//! ```
//!
//! Sticking is an equality constraint. Its unknown is the *stick multiplier* `a = T + μ Λ`. The
//! contact starts to slip forward where `a` vanishes, and backward where `2 μ Λ − a` vanishes. The
//! unknown of a slipping contact is its slip distance `σ (s − s₀)` in the direction `σ` = ±1. The
//! slip distance cannot decrease: where it would decrease, the contact sticks (Q2). Friction thus
//! adds two constraints to each contact:
//!
//! ```text
//! 0 ≤ a   while sticking          0 ≤ σ (s − s₀)  ⟂  2 μ Λ − a ≥ 0
//! ```
//!
//! Special contacts:
//!
//! - If the sides of a pair lie on each other, both contacts of the pair slide along one line, and
//!   only the sum of their friction matters. One contact, the *carrier*, carries the friction of
//!   both; the other contact is *shared*.
//! - Coinciding corners are *locked*: they keep the ratio `T/Λ` from before they coincided. A
//!   contact that was sliding keeps this ratio along the next edge.
//! - A corner at the position of a needle tip moves with the tip. While the tip slides, the corner
//!   is locked with `T/Λ = ±μ`. While it sticks, only the sum of both friction forces matters, and
//!   tip and corner take equal fractions of their limits ([`TipFriction`]).

use contact::{CornerContact, CornerEdge, FORCES, Force, Gap, Pose, quarter};
use geometry::Vec2;
use solver::{Residual, Tangent};

use super::{Contacts, LEVELS, SkinMode, SkinState};

/// Index of the stick multiplier among the constraints of a contact.
pub(super) const STICK_MULTIPLIER: usize = FORCES;
/// Index of the slip distance among the constraints of a contact.
pub(super) const SLIP_DISTANCE: usize = FORCES + 1;

/// Normal force below which a contact counts as just closed.
pub(super) const NO_FORCE: f64 = 1e-12;

/// Relative tolerance within which `|T/Λ|` counts as equal to the coefficient of friction.
const SLIDES: f64 = 1e-9;

/// Friction state of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum FrictionState {
    /// The contact is open, or the other contact of the pair carries its friction.
    #[default]
    None,
    /// The contact sticks.
    Stick {
        /// Slip coordinate `s₀` at which it sticks.
        anchor: f64,
    },
    /// The contact slips.
    Slip {
        /// Sign `σ` of the slip rate `ṡ`: 1 or −1.
        sign: f64,
        /// Slip coordinate `s` at which the slip started.
        start: f64,
    },
    /// The contact keeps a constant ratio `T/Λ`.
    ///
    /// Either the corners coincide, or a sliding needle tip is at the corner.
    Locked {
        /// Ratio `T/Λ`.
        ratio: f64,
    },
    /// A sticking needle tip is at the corner of the contact.
    ///
    /// The unknown is `T + 2 μ Λ`. It vanishes only together with `Λ`, because the equations of the
    /// tip determine when tip and corner slide.
    WithTip,
}

impl FrictionState {
    /// Returns true if the contact carries friction itself.
    pub(super) fn carries_friction(self) -> bool {
        self != Self::None
    }

    /// Returns true if both states are of the same kind and, if they slip, in the same direction.
    pub(super) fn is_same_form(self, other: Self) -> bool {
        match (self, other) {
            (Self::Slip { sign, .. }, Self::Slip { sign: of_other, .. }) => sign == of_other,
            _ => std::mem::discriminant(&self) == std::mem::discriminant(&other),
        }
    }

    /// Returns two flags: whether the stick and whether the slip constraint is active.
    pub(super) fn acting(self) -> [bool; 2] {
        [matches!(self, Self::Stick { .. } | Self::WithTip), matches!(self, Self::Slip { .. })]
    }
}

/// Friction of a contact between scales with a sticking needle tip at its corner.
pub(crate) struct TipFriction {
    /// Index of the unknown `T + 2 μ Λ` of the contact.
    ///
    /// The row of this unknown contains the equation of the tip.
    pub(crate) unknown: usize,
    /// Tangential force `T`.
    pub(crate) traction: f64,
    /// Friction limit `μ Λ`.
    pub(crate) limit: f64,
    /// Coefficient of friction `μ` between scales.
    pub(crate) friction: f64,
    /// Indices of the unknown normal forces with the sum `Λ`.
    pub(crate) normal_forces: Vec<usize>,
}

/// Friction of a closed contact.
struct Sliding {
    friction_state: FrictionState,
    /// Tangential force `T`.
    traction: f64,
    /// Derivative `∂T/∂Λ` at a constant stick multiplier.
    by_normal_force: f64,
    /// Slip coordinate `s` with its derivatives.
    slide: Gap,
}

impl Contacts {
    /// Returns true if the contact law has friction.
    pub(crate) fn has_friction(&self) -> bool {
        self.law.friction() > 0.0
    }

    /// Returns true if at least one contact has a friction state other than `None`.
    pub(crate) fn friction_acts(state: &SkinState) -> bool {
        state
            .mode
            .friction_states
            .iter()
            .any(|friction_state| *friction_state != FrictionState::None)
    }

    /// Returns the number of sticking and the number of slipping contacts.
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

    /// Returns true if a constraint is the stick multiplier or the slip distance of a contact.
    pub(crate) fn is_friction(&self, constraint: usize) -> bool {
        constraint < self.forces.len() && self.contact_of(constraint).1 >= FORCES
    }

    /// Returns true if a constraint is a friction constraint of a slipping contact.
    pub(crate) fn slips(&self, state: &SkinState, constraint: usize) -> bool {
        // Shared and locked contacts also have friction constraints, but none of these is active.
        self.is_friction(constraint)
            && state.mode.friction_states[self.contact_of(constraint).0].acting() == [false, true]
    }

    /// Iterates over the anchors of sticking contacts and the ratios of locked contacts.
    ///
    /// Each item is the index of the contact and its anchor or ratio.
    pub(crate) fn anchors(state: &SkinState) -> impl Iterator<Item = (usize, f64)> {
        let friction_states = state.mode.friction_states.iter().enumerate();
        friction_states.filter_map(|(contact, friction_state)| match friction_state {
            FrictionState::Stick { anchor: value } | FrictionState::Locked { ratio: value } => {
                Some((contact, *value))
            }
            FrictionState::None | FrictionState::Slip { .. } | FrictionState::WithTip => None,
        })
    }

    /// Computes from `state` the anchor or ratio that a contact gets in the state `to`.
    ///
    /// Used to differentiate anchors at the event at which they are set.
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

    /// Shifts the anchor or ratio of a contact.
    ///
    /// Used in rows with a perturbed parameter, in which a contact sticks at another position.
    pub(crate) fn shift_anchor(&mut self, contact: usize, by: f64) {
        self.anchor_shifts.push((contact, by));
    }

    /// Returns the anchor or ratio of a contact: the value `of_mode` plus its shift, if any.
    fn shifted_anchor(&self, contact: usize, of_mode: f64) -> f64 {
        let moved = self.anchor_shifts.iter().find(|(moved, _)| *moved == contact);
        of_mode + moved.map_or(0.0, |(_, by)| *by)
    }

    /// Returns the ratio `T/Λ` of a locked contact; 0 for other contacts.
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
            // `T` is continuous if the multiplier is 0 after forward slip and `2 μ Λ` after
            // backward slip.
            let multiplier = (1.0 - sign) * self.law.friction() * self.normal_force(state, contact);
            state.mode.friction_states[contact] =
                FrictionState::Stick { anchor: self.slip_coordinate(state, edge, contact) };
            self.set_friction(state, contact, multiplier, true);
        }
    }

    /// Computes the friction `T/(μ Λ)` of a contact as a fraction of its limit, from −1 to 1.
    pub(crate) fn mobilised(&self, state: &SkinState, contact: usize) -> f64 {
        if !self.has_friction() {
            return 0.0;
        }
        self.ratio(state, Self::carrier_of(&state.mode, contact)) / self.law.friction()
    }

    /// Locks the friction of a contact because a needle tip is at its corner.
    ///
    /// If `sliding` is `None`, the ratio `T/Λ` keeps its value. Otherwise `sliding` is the sign of
    /// `T` while the corner slides with the tip, and the ratio is `±μ`.
    pub(crate) fn lock(&self, state: &mut SkinState, contact: usize, sliding: Option<f64>) {
        if !self.has_friction() {
            return;
        }
        let carrier = Self::carrier_of(&state.mode, contact);
        let ratio =
            sliding.map_or_else(|| self.ratio(state, carrier), |sign| sign * self.law.friction());
        state.mode.friction_states[carrier] = FrictionState::Locked { ratio };
        // A locked contact has no active friction unknown, so set both to zero.
        self.set_friction(state, carrier, 0.0, true);
    }

    /// Makes a contact stick together with the needle tip at its corner.
    ///
    /// `T` keeps its value, or becomes `fraction` times its limit `μ Λ` if a fraction is given.
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

    /// Evaluates the friction of a contact that sticks together with the tip at its corner.
    ///
    /// `None` if the contact is in another friction state.
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

    /// Releases a contact that was locked or stuck because a needle tip was at its corner.
    ///
    /// If the needle tip `slides` and the contact is at its friction limit, the contact slips on
    /// its edge; otherwise it sticks.
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
        // `T = ratio Λ` is continuous with the multiplier `T + μ Λ`.
        let multiplier = (ratio + self.law.friction()) * self.normal_force(state, carrier);
        state.mode.friction_states[carrier] = if slides && self.is_sliding(ratio) {
            // Friction opposes the slip, so the sign of the slip is opposite to the sign of `T/Λ`.
            FrictionState::Slip { sign: -ratio.signum(), start: position }
        } else {
            FrictionState::Stick { anchor: position }
        };
        self.set_friction(state, carrier, multiplier, true);
    }

    /// Adds the friction forces of a pair to its balance, and its stick and slip equations.
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
                    // While sticking `T = a − μ Λ`, so the derivative of `T` with respect to the
                    // multiplier `a` is 1.
                    pair.add_column(matrix, multiplier, &along.map(|slope| -slope));
                    residual.add(multiplier, slide.value - self.shifted_anchor(contact, anchor));
                    pair.add_row(matrix, multiplier, &along);
                }
                FrictionState::Slip { sign, start } => {
                    // The slip distance counts from `start`, so it is zero when the slip begins.
                    residual.add(slip, -sign * (slide.value - start));
                    residual.add(slip, state.z[slip]);
                    pair.add_row(matrix, slip, &along.map(|slope| -sign * slope));
                    matrix.add(slip, slip, 1.0);
                }
                // The equation in the row of the multiplier is added by the needle.
                FrictionState::WithTip => {
                    pair.add_column(matrix, multiplier, &along.map(|slope| -slope));
                }
                // These states have no active friction constraint, hence no equation.
                FrictionState::None | FrictionState::Locked { .. } => {}
            }
        }
    }

    /// Evaluates the condition `2 μ Λ − a` of backward slip for a sticking contact.
    ///
    /// If `z` is a direction instead of the unknowns, the result is the derivative of the condition
    /// along it. `None` for all other friction constraints, which have no condition while inactive.
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
        // The condition is linear in `z`, so a direction in place of `z` gives the derivative.
        let normal_force: f64 =
            self.normal_force_unknowns(mode, contact).map(|force| z[force]).sum();
        Some(2.0 * self.law.friction() * normal_force - z[self.unknown(contact, STICK_MULTIPLIER)])
    }

    /// Evaluates the derivative of a friction equation or condition along `direction`.
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

    /// Evaluates the derivative of the slip coordinate of a contact along `direction`.
    fn slide_rate(&self, state: &SkinState, direction: &[f64], contact: usize) -> f64 {
        let sliding = self.friction_of(state, contact, &self.pair_poses(&state.z, contact));
        sliding.map_or(0.0, |sliding| {
            self.pair_unknowns(contact).sum(&sliding.slide.gradient, direction)
        })
    }

    /// Writes the conditions of [`Self::slot_condition`] of all contacts into `values`.
    ///
    /// If `z` is a direction, the values are derivatives along it. Contacts without a condition get
    /// `otherwise`.
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

    /// Returns true if the other contact of the pair carries the friction of `contact`.
    pub(super) fn is_shared(mode: &SkinMode, contact: usize) -> bool {
        mode.friction_states[contact] == FrictionState::None
            && mode.contacts[contact] != CornerContact::Open
            && mode.friction_states[Self::other_contact(contact)].carries_friction()
    }

    /// Returns the contact that carries the friction of `contact`: itself or the other of its pair.
    fn carrier_of(mode: &SkinMode, contact: usize) -> usize {
        if Self::is_shared(mode, contact) { Self::other_contact(contact) } else { contact }
    }

    /// Returns true if the contact, or the carrier of its friction, slips.
    pub(super) fn is_slipping(mode: &SkinMode, contact: usize) -> bool {
        matches!(mode.friction_states[Self::carrier_of(mode, contact)], FrictionState::Slip { .. })
    }

    /// Iterates over a carrier and the shared contact of its pair, if any.
    pub(super) fn sharing_contacts(mode: &SkinMode, carrier: usize) -> impl Iterator<Item = usize> {
        let shared =
            Some(Self::other_contact(carrier)).filter(|&other| Self::is_shared(mode, other));
        std::iter::once(carrier).chain(shared)
    }

    /// Computes the friction force on the left scale from the `normal_force` on this scale.
    pub(super) fn traction_on_left(
        &self,
        state: &SkinState,
        contact: usize,
        normal_force: Vec2,
    ) -> Vec2 {
        let poses = self.pair_poses(&state.z, contact);
        match (self.friction_of(state, contact, &poses), normal_force.norm()) {
            // The direction of a zero force is undefined. Coinciding corners do not slide along an
            // edge; their friction follows from the locked ratio.
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
        // An inactive multiplier is zero, so the formula below is valid in every friction state.
        let multiplier = state.z[self.unknown(contact, STICK_MULTIPLIER)];
        Some(Sliding {
            friction_state,
            traction: multiplier + by_normal_force * normal_force,
            by_normal_force,
            slide,
        })
    }

    /// Returns the derivative `∂T/∂Λ` at a constant stick multiplier.
    pub(super) fn by_normal_force(&self, contact: usize, friction_state: FrictionState) -> f64 {
        match friction_state {
            FrictionState::Stick { .. } => -self.law.friction(),
            FrictionState::Slip { sign, .. } => -sign * self.law.friction(),
            FrictionState::Locked { ratio } => self.shifted_anchor(contact, ratio),
            FrictionState::WithTip => -2.0 * self.law.friction(),
            FrictionState::None => 0.0,
        }
    }

    /// Returns the corner and edge of a contact that can slide along its edge.
    ///
    /// `None` for open contacts and coinciding corners.
    pub(super) fn edge_of(mode: &SkinMode, contact: usize) -> Option<CornerEdge> {
        let contact = mode.contacts[contact];
        contact.edge().filter(|_| !matches!(contact, CornerContact::Corner(_)))
    }

    pub(super) fn slide(&self, edge: CornerEdge, contact: usize, [left, right]: &[Pose; 2]) -> Gap {
        self.pair(Self::pair_of(contact)).slide(edge, left, right)
    }

    /// Returns the index of the unknown of constraint number `slot` of a contact.
    pub(super) fn unknown(&self, contact: usize, slot: usize) -> usize {
        self.forces[self.slots * contact + slot]
    }

    /// Iterates over the unknown normal forces on the edge of a carrier.
    ///
    /// Includes the forces of the shared contact, if any.
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

    /// Returns the contact at the other level of the same pair.
    pub(super) fn other_contact(contact: usize) -> usize {
        // The pair has the contacts `first` and `first + 1`, with the sum `2 first + 1`.
        let first = Self::contacts_of(Self::pair_of(contact)).start;
        2 * first + LEVELS.len() - 1 - contact
    }

    /// Computes the ratio `T/Λ` of a contact; 0 if its normal force is zero.
    pub(super) fn ratio(&self, state: &SkinState, contact: usize) -> f64 {
        match state.mode.friction_states[contact] {
            FrictionState::Locked { ratio } => ratio,
            FrictionState::Slip { sign, .. } => -sign * self.law.friction(),
            FrictionState::Stick { .. } | FrictionState::WithTip => {
                let normal_force = self.normal_force(state, contact);
                let multiplier = state.z[self.unknown(contact, STICK_MULTIPLIER)];
                // Without a normal force the quotient would consist of round-off errors.
                if normal_force > NO_FORCE {
                    multiplier / normal_force
                        + self.by_normal_force(contact, state.mode.friction_states[contact])
                } else {
                    0.0
                }
            }
            FrictionState::None if Self::is_shared(&state.mode, contact) => {
                // Both contacts of the pair slide along one line, so they have the same ratio.
                self.ratio(state, Self::other_contact(contact))
            }
            FrictionState::None => 0.0,
        }
    }

    /// Returns true if the magnitude of the ratio `T/Λ` equals the coefficient of friction.
    pub(super) fn is_sliding(&self, ratio: f64) -> bool {
        ratio.abs() >= self.law.friction() * (1.0 - SLIDES)
    }

    /// Computes the normal force `Λ` of a carrier, including its shared contact.
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

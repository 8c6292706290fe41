//! Friction between neighbours: scales that stick and slip on each other.
//!
//! On an edge the contact force has a part `T` along it, on the left scale in the direction of the normal force turned counter-clockwise
//! by a quarter. With the normal forces `Λ` that bear on the edge and the way `s` that the left scale has slid in that direction
//!
//! ```text
//! |T| ≤ μ Λ,    stick:  s = s₀, T unknown,    slip:  T = −μ Λ sign ṡ                          (R1)
//! ```
//!
//! Sticking is an equality. Its unknown is the *grip* `a = T + μ Λ`, which vanishes where the contact begins to slip forward; backward it
//! slips where `2 μ Λ − a` does. A contact that slips has the way that it has come as an unknown that only grows: where it turns back the
//! contact sticks (R2). So a contact that rubs has two constraints more than one that does not:
//!
//! ```text
//! 0 ≤ a   where it sticks          0 ≤ σ (s − s₀)  ⟂  2 μ Λ − a ≥ 0
//! ```
//!
//! Two contacts of a pair whose sides lie on each other slide along one line: only the sum of their friction counts, and one of them, the
//! *host*, bears it for both. Corners that are together keep the ratio of `T` and `Λ` with which they came; it is that of sliding on, on
//! the edge behind the corner. So does a corner on whose place the tip of a needle stands: of one motion the needle then says how it rubs.

use contact::{CornerContact, CornerEdge, FORCES, Force, Gap, Pose, quarter};
use geometry::Vec2;
use solver::{Residual, Tangent};

use super::{Contacts, LEVELS, SkinMode, SkinPoint, SkinState};

/// Constraints of a contact that rubs, behind those of its forces.
pub(super) const STICK_MULTIPLIER: usize = FORCES;
pub(super) const SLIP_DISTANCE: usize = FORCES + 1;

/// A normal force smaller than this has just begun to act.
pub(super) const NO_FORCE: f64 = 1e-12;

/// A ratio this near to the coefficient of friction is that of sliding.
const SLIDES: f64 = 1e-9;

/// How a contact rubs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum FrictionState {
    /// Not at all: it is open, or the other contact of the pair bears its friction.
    #[default]
    None,
    /// It sticks where `s` is `at`, its anchor.
    Stick {
        /// `s₀`.
        anchor: f64,
    },
    /// It slips with this sign of `ṡ`, since `s` was `from`.
    Slip {
        /// `σ`, 1 or −1.
        sign: f64,
        /// `s` where it began to.
        start: f64,
    },
    /// The corners are together, or the tip of a needle is where the corner is, with this ratio of `T` and `Λ`.
    Locked {
        /// `T/Λ`.
        ratio: f64,
    },
}

impl FrictionState {
    /// Whether the contact bears friction of its own.
    pub(super) fn carries_friction(self) -> bool {
        self != Self::None
    }

    /// Whether both stick, or slip the same way.
    pub(super) fn is_same_form(self, other: Self) -> bool {
        match (self, other) {
            (Self::Slip { sign, .. }, Self::Slip { sign: of_other, .. }) => sign == of_other,
            _ => std::mem::discriminant(&self) == std::mem::discriminant(&other),
        }
    }

    /// Whether it sticks, and whether it slips.
    pub(super) fn acting(self) -> [bool; 2] {
        [matches!(self, Self::Stick { .. }), matches!(self, Self::Slip { .. })]
    }
}

/// How a closed contact slides: its friction, and the way with its derivatives.
struct Sliding {
    friction_state: FrictionState,
    traction: f64,
    /// `∂T/∂Λ`, with the grip held.
    by_normal_force: f64,
    slide: Gap,
}

impl Contacts {
    /// Whether neighbours rub.
    pub(crate) fn has_friction(&self) -> bool {
        self.law.friction() > 0.0
    }

    /// Whether friction acts anywhere.
    pub(crate) fn friction_acts(state: &SkinState) -> bool {
        state
            .mode
            .friction_states
            .iter()
            .any(|friction_state| *friction_state != FrictionState::None)
    }

    /// Numbers of contacts that stick and that slip.
    pub(crate) fn stick_slip_counts(state: &SkinState) -> [usize; 2] {
        let count = |k: usize| {
            state
                .mode
                .friction_states
                .iter()
                .filter(|friction_state| friction_state.acting()[k])
                .count()
        };
        [0, 1].map(count)
    }

    /// Whether a constraint is one of friction.
    pub(crate) fn is_friction(&self, constraint: usize) -> bool {
        constraint < self.forces.len() && self.contact_of(constraint).1 >= FORCES
    }

    /// Whether a constraint is one of friction of a contact that slips.
    pub(crate) fn slips(&self, state: &SkinState, constraint: usize) -> bool {
        // A guest and a contact that is held have constraints of friction, too, but none that acts.
        self.is_friction(constraint)
            && state.mode.friction_states[self.contact_of(constraint).0].acting() == [false, true]
    }

    /// What contacts keep of the way to a state: where they stick, or the ratio with which they are held.
    pub(crate) fn anchors(state: &SkinState) -> impl Iterator<Item = (usize, f64)> {
        let friction_states = state.mode.friction_states.iter().enumerate();
        friction_states.filter_map(|(contact, friction_state)| match friction_state {
            FrictionState::Stick { anchor: kept } | FrictionState::Locked { ratio: kept } => {
                Some((contact, *kept))
            }
            FrictionState::None | FrictionState::Slip { .. } => None,
        })
    }

    /// What a contact will keep in the state `to`, seen from the state before.
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

    /// Moves what a contact keeps to that of a neighbour of a row which has come to the same state on its own way.
    pub(crate) fn shift_anchor(&mut self, contact: usize, by: f64) {
        self.anchor_shifts.push((contact, by));
    }

    /// What a contact keeps on the way to this row, if it does so with this value.
    fn shifted_anchor(&self, contact: usize, of_mode: f64) -> f64 {
        let moved = self.anchor_shifts.iter().find(|(moved, _)| *moved == contact);
        of_mode + moved.map_or(0.0, |(_, by)| *by)
    }

    /// The ratio with which a contact is held; 0 if it is not.
    pub(super) fn locked_ratio(&self, mode: &SkinMode, contact: usize) -> f64 {
        match mode.friction_states.get(contact) {
            Some(FrictionState::Locked { ratio }) => self.shifted_anchor(contact, *ratio),
            _ => 0.0,
        }
    }

    /// Lets all contacts stick that slide, where they are.
    pub(crate) fn stop_sliding(&self, state: &mut SkinState) {
        for contact in 0..state.mode.friction_states.len() {
            let (FrictionState::Slip { sign, .. }, Some(edge)) =
                (state.mode.friction_states[contact], Self::edge_of(&state.mode, contact))
            else {
                continue;
            };
            // `T` stays as it was: the grip is 0 where it slid forward and `2 μ Λ` where backward.
            let multiplier = (1.0 - sign) * self.law.friction() * self.normal_force(state, contact);
            state.mode.friction_states[contact] =
                FrictionState::Stick { anchor: self.slip_coordinate(state, edge, contact) };
            self.set_friction(state, contact, multiplier, true);
        }
    }

    /// Lets the friction of a contact on an edge keep its ratio, since the tip of a needle has come to the place of the corner.
    pub(crate) fn lock(&self, state: &mut SkinState, contact: usize) {
        if !self.has_friction() {
            return;
        }
        let carrier = Self::carrier_of(&state.mode, contact);
        let ratio = self.ratio(state, carrier);
        state.mode.friction_states[carrier] = FrictionState::Locked { ratio };
        // A ratio that is held leaves no unknown for the friction.
        self.set_friction(state, carrier, 0.0, true);
    }

    /// Gives the friction of a contact that was held on an edge back to it. Of a tip that slides the corner slides on, too.
    pub(crate) fn release(&self, state: &mut SkinState, contact: usize, slides: bool) {
        if !self.has_friction() {
            return;
        }
        let carrier = Self::carrier_of(&state.mode, contact);
        let (FrictionState::Locked { ratio }, Some(edge)) =
            (state.mode.friction_states[carrier], Self::edge_of(&state.mode, carrier))
        else {
            return;
        };
        let position = self.slip_coordinate(state, edge, carrier);
        // `T` stays as it was while the contact was held, and the grip is `T + μ Λ`.
        let multiplier = (ratio + self.law.friction()) * self.normal_force(state, carrier);
        state.mode.friction_states[carrier] = if slides && self.is_sliding(ratio) {
            // Friction opposes the motion, so the way has the other sign.
            FrictionState::Slip { sign: -ratio.signum(), start: position }
        } else {
            FrictionState::Stick { anchor: position }
        };
        self.set_friction(state, carrier, multiplier, true);
    }

    /// Adds the friction of a pair to its balance, and the equations of grips and ways.
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
                &slide.hessian.map(|row| row.map(|turning| -traction * turning)),
            );
            for force in self.normal_force_unknowns(&state.mode, contact) {
                pair.add_column(matrix, force, &along.map(|slope| -by_normal_force * slope));
            }
            match friction_state {
                FrictionState::Stick { anchor } => {
                    // `T = a − μ Λ` where the contact sticks, so its derivative by the grip is 1.
                    pair.add_column(matrix, multiplier, &along.map(|slope| -slope));
                    residual.add(multiplier, slide.value - self.shifted_anchor(contact, anchor));
                    pair.add_row(matrix, multiplier, &along);
                }
                FrictionState::Slip { sign, start } => {
                    // Counted from where slipping began, the way is zero there and only grows.
                    residual.add(slip, -sign * (slide.value - start));
                    residual.add(slip, state.z[slip]);
                    pair.add_row(matrix, slip, &along.map(|slope| -sign * slope));
                    matrix.add(slip, slip, 1.0);
                }
                // Neither constraint acts here, so neither has an equation.
                FrictionState::None | FrictionState::Locked { .. } => {}
            }
        }
    }

    /// The condition of a grip or a way that does not act, or with a direction for `z` its derivative: that of the way of a contact that
    /// sticks alone may be violated.
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
        // This is linear in the unknowns: a direction in the place of `z` gives the derivative.
        let normal_force: f64 =
            self.normal_force_unknowns(mode, contact).map(|force| z[force]).sum();
        Some(2.0 * self.law.friction() * normal_force - z[self.unknown(contact, STICK_MULTIPLIER)])
    }

    /// The derivative of the equation of a grip or a way that acts, or of the condition of one that does not.
    pub(super) fn slot_slope(
        &self,
        state: &SkinState,
        direction: &[f64],
        contact: usize,
        slot: usize,
    ) -> f64 {
        let poses = self.pair_poses(&state.z, contact);
        let along =
            |sliding: Sliding| self.pair_unknowns(contact).sum(&sliding.slide.gradient, direction);
        let along = || self.friction_of(state, contact, &poses).map_or(0.0, along);
        match (state.mode.friction_states[contact], slot) {
            (FrictionState::Stick { .. }, STICK_MULTIPLIER) => along(),
            (FrictionState::Slip { sign, .. }, SLIP_DISTANCE) => {
                direction[self.unknown(contact, SLIP_DISTANCE)] - sign * along()
            }
            _ => self.slot_condition(state, direction, contact, slot).unwrap_or(0.0),
        }
    }

    /// Replaces the conditions of ways, or with a direction for `z` their derivatives: where there is none by `otherwise`.
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

    /// What friction takes between two neighbouring points of a path, `∫ μ Λ |ds|`. `spans` are the units of the directions in which the
    /// path leaves the one and comes to the other ([`solver::Path::spans`]): with them both factors are known to the third order.
    pub(crate) fn friction_work(&self, from: &SkinPoint, to: &SkinPoint, spans: [f64; 2]) -> f64 {
        let slips = from.state.mode.friction_states.iter().enumerate();
        let work = |(contact, friction_state): (usize, &FrictionState)| {
            let FrictionState::Slip { sign, start } = *friction_state else { return 0.0 };
            let Some(edge) = from.state.mode.contacts[contact].edge() else { return 0.0 };
            let normal_force = |z: &[f64]| -> f64 {
                // A force may have been handed on at the second point.
                let both = Self::sharing_contacts(&from.state.mode, contact);
                let both = both.map(|contact| self.forces_of(z, contact));
                both.map(|forces| forces[Force::Own as usize] + forces[Force::Flush as usize]).sum()
            };
            let slip = self.unknown(contact, SLIP_DISTANCE);
            // The contact may slip no more at the second point: its way is taken from the poses.
            let end = sign * (self.slip_coordinate(&to.state, edge, contact) - start);
            let slip_distances = [from.state.z[slip], end];
            let rates = [spans[0] * from.leaving[slip], spans[1] * to.arriving[slip]];
            let forces = [normal_force(&from.state.z), normal_force(&to.state.z)];
            let growth =
                [spans[0] * normal_force(&from.leaving), spans[1] * normal_force(&to.arriving)];
            self.law.friction() * product_integral([forces, growth], [slip_distances, rates])
        };
        slips.map(work).sum()
    }

    /// Whether the other contact of the pair bears the friction of this one.
    pub(super) fn is_shared(mode: &SkinMode, contact: usize) -> bool {
        mode.friction_states[contact] == FrictionState::None
            && mode.contacts[contact] != CornerContact::Open
            && mode.friction_states[Self::other_contact(contact)].carries_friction()
    }

    /// The contact that bears the friction of a contact.
    fn carrier_of(mode: &SkinMode, contact: usize) -> usize {
        if Self::is_shared(mode, contact) { Self::other_contact(contact) } else { contact }
    }

    /// Whether a contact slips, or that which bears its friction.
    pub(super) fn is_slipping(mode: &SkinMode, contact: usize) -> bool {
        matches!(mode.friction_states[Self::carrier_of(mode, contact)], FrictionState::Slip { .. })
    }

    /// A contact that bears friction, and the one whose friction it bears besides its own.
    fn sharing_contacts(mode: &SkinMode, carrier: usize) -> impl Iterator<Item = usize> {
        let shared =
            Some(Self::other_contact(carrier)).filter(|&other| Self::is_shared(mode, other));
        std::iter::once(carrier).chain(shared)
    }

    /// Friction on the left scale at a contact whose normal force has this direction.
    pub(super) fn traction_on_left(
        &self,
        state: &SkinState,
        contact: usize,
        normal_force: Vec2,
    ) -> Vec2 {
        let poses = self.pair_poses(&state.z, contact);
        match (self.friction_of(state, contact, &poses), normal_force.norm()) {
            // Without a force there is no direction to take. Corners that are together have no edge
            // to slide on: their friction is the ratio with which they are held.
            (Some(sliding), size) if size > 0.0 => sliding.traction * quarter(normal_force) / size,
            _ => self.locked_ratio(&state.mode, contact) * quarter(normal_force),
        }
    }

    fn friction_of(&self, state: &SkinState, contact: usize, poses: &[Pose; 2]) -> Option<Sliding> {
        let friction_state = *state.mode.friction_states.get(contact)?;
        let edge = Self::edge_of(&state.mode, contact)?;
        let by_normal_force = match friction_state {
            FrictionState::Stick { .. } => -self.law.friction(),
            FrictionState::Slip { sign, .. } => -sign * self.law.friction(),
            FrictionState::Locked { ratio } => self.shifted_anchor(contact, ratio),
            FrictionState::None => return None,
        };
        let slide = self.slide(edge, contact, poses);
        let normal_force: f64 =
            self.normal_force_unknowns(&state.mode, contact).map(|force| state.z[force]).sum();
        // A grip that does not act is zero, so that this holds for all ways to rub.
        let multiplier = state.z[self.unknown(contact, STICK_MULTIPLIER)];
        Some(Sliding {
            friction_state,
            traction: multiplier + by_normal_force * normal_force,
            by_normal_force,
            slide,
        })
    }

    /// The edge that a contact slides on; `None` where corners are together, whose force the law of the contact turns.
    fn edge_of(mode: &SkinMode, contact: usize) -> Option<CornerEdge> {
        let contact = mode.contacts[contact];
        contact.edge().filter(|_| !matches!(contact, CornerContact::Corner(_)))
    }

    fn slide(&self, edge: CornerEdge, contact: usize, [left, right]: &[Pose; 2]) -> Gap {
        self.pair(Self::pair_of(contact)).slide(edge, left, right)
    }

    /// Unknown of a constraint of a contact.
    pub(super) fn unknown(&self, contact: usize, slot: usize) -> usize {
        self.forces[self.slots * contact + slot]
    }

    /// Unknowns of the normal forces that bear on the edge of a contact: its own, and those of a contact whose friction it bears.
    fn normal_force_unknowns(
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

    /// The other contact of a pair.
    pub(super) fn other_contact(contact: usize) -> usize {
        // Contacts of a pair follow each other: the sum of their numbers gives the other one.
        let first = Self::contacts_of(Self::pair_of(contact)).start;
        2 * first + LEVELS.len() - 1 - contact
    }

    /// `T/Λ` of a contact.
    pub(super) fn ratio(&self, state: &SkinState, contact: usize) -> f64 {
        match state.mode.friction_states[contact] {
            FrictionState::Locked { ratio } => ratio,
            FrictionState::Slip { sign, .. } => -sign * self.law.friction(),
            FrictionState::Stick { .. } => {
                let normal_force = self.normal_force(state, contact);
                let multiplier = state.z[self.unknown(contact, STICK_MULTIPLIER)];
                // Without pressure the ratio would be round-off over round-off.
                if normal_force > NO_FORCE {
                    multiplier / normal_force - self.law.friction()
                } else {
                    0.0
                }
            }
            FrictionState::None if Self::is_shared(&state.mode, contact) => {
                // Both slide along one line, so that the guest has the ratio of its host.
                self.ratio(state, Self::other_contact(contact))
            }
            FrictionState::None => 0.0,
        }
    }

    /// Whether a ratio is that of sliding.
    pub(super) fn is_sliding(&self, ratio: f64) -> bool {
        ratio.abs() >= self.law.friction() * (1.0 - SLIDES)
    }

    /// The normal forces on the edge of a contact that bears its friction.
    pub(super) fn normal_force(&self, state: &SkinState, contact: usize) -> f64 {
        self.normal_force_unknowns(&state.mode, contact).map(|force| state.z[force]).sum()
    }

    /// `s` of a contact.
    pub(super) fn slip_coordinate(
        &self,
        state: &SkinState,
        edge: CornerEdge,
        contact: usize,
    ) -> f64 {
        self.slide(edge, contact, &self.pair_poses(&state.z, contact)).value
    }
}

/// `∫ f dg` over a unit interval, of cubics through values and slopes at both ends: exact with three points of Gauss.
pub(crate) fn product_integral(
    [values, slopes]: [[f64; 2]; 2],
    [of_g, slopes_of_g]: [[f64; 2]; 2],
) -> f64 {
    let points = [
        (0.5, 4.0 / 9.0),
        (0.5 - 0.15_f64.sqrt(), 5.0 / 18.0),
        (0.5 + 0.15_f64.sqrt(), 5.0 / 18.0),
    ];
    let integrand = |x: f64| {
        let [start, end] = values;
        let cubic = start * (1.0 + 2.0 * x) * (1.0 - x).powi(2)
            + end * x * x * (3.0 - 2.0 * x)
            + slopes[0] * x * (1.0 - x).powi(2)
            + slopes[1] * x * x * (x - 1.0);
        let rate = 6.0 * x * (1.0 - x) * (of_g[1] - of_g[0])
            + slopes_of_g[0] * (1.0 - x) * (1.0 - 3.0 * x)
            + slopes_of_g[1] * x * (3.0 * x - 2.0);
        cubic * rate
    };
    points.into_iter().map(|(x, weight)| weight * integrand(x)).sum()
}

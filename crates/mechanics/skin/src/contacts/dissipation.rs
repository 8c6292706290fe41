//! Frictional dissipation between scales along a path.

use std::iter::Sum;
use std::ops::{Add, Mul};

use super::friction::{FrictionState, SLIP_DISTANCE, STICK_MULTIPLIER};
use super::{Contacts, SkinPoint};

/// Dissipation `∫ T ds` along a segment of a path.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Dissipation {
    /// Dissipation if force and slip are cubic polynomials within the segment.
    pub(crate) value: f64,
    /// Dissipation by the trapezoidal rule.
    ///
    /// Its difference from `value` indicates the error of the integration.
    pub(crate) trapezoid: f64,
}

impl Add for Dissipation {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, trapezoid: self.trapezoid + other.trapezoid }
    }
}

impl Mul<f64> for Dissipation {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { value: factor * self.value, trapezoid: factor * self.trapezoid }
    }
}

impl Sum for Dissipation {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::default(), Add::add)
    }
}

impl Contacts {
    /// Computes the frictional dissipation `∫ μ Λ |ds|` between two path points.
    ///
    /// `spans` are the lengths of the segment in units of the outgoing direction at `from` and of
    /// the incoming direction at `to` ([`solver::Continuation::spans`]). They define cubics for the
    /// normal force `Λ` and the slip coordinate `s`.
    pub(crate) fn friction_work(
        &self,
        from: &SkinPoint,
        to: &SkinPoint,
        spans: [f64; 2],
    ) -> Dissipation {
        let contacts = from.state.mode.friction_states.iter().enumerate();
        let work = contacts.map(|(contact, friction_state)| match *friction_state {
            FrictionState::Slip { sign, start } => {
                self.work_of_slip(contact, [sign, start], from, to, spans)
            }
            _ => self.work_at_tip(contact, from, to, spans),
        });
        work.sum()
    }

    /// Computes the dissipation of a slipping contact.
    ///
    /// `sign` is the sign of `ṡ`, and `start` the slip coordinate at which the slip began.
    fn work_of_slip(
        &self,
        contact: usize,
        [sign, start]: [f64; 2],
        from: &SkinPoint,
        to: &SkinPoint,
        spans: [f64; 2],
    ) -> Dissipation {
        let mode = &from.state.mode;
        let Some(edge) = mode.contacts[contact].edge() else { return Dissipation::default() };
        let vectors = [&from.state.z, &to.state.z, &from.leaving, &to.arriving];
        let [first, last, leaving, arriving] = vectors.map(|z| {
            // Use the contacts of the first point: at the second point the force may have moved to
            // another contact.
            let both = Self::sharing_contacts(mode, contact);
            both.map(|contact| self.own_and_flush_force(z, contact)).sum::<f64>()
        });
        let slip = self.unknown(contact, SLIP_DISTANCE);
        // The slip distance is reset if the contact stops slipping at the second point, so compute
        // the slip from the poses.
        let end = sign * (self.slip_coordinate(&to.state, edge, contact) - start);
        let slip_distances = [from.state.z[slip], end];
        let rates = [spans[0] * from.leaving[slip], spans[1] * to.arriving[slip]];
        let growth = [spans[0] * leaving, spans[1] * arriving];
        product_integral([[first, last], growth], [slip_distances, rates]) * self.law.friction()
    }

    /// Computes the dissipation `−∫ T ds` of a contact with a needle tip at its corner.
    ///
    /// Zero if no needle tip is at the corner of the contact.
    fn work_at_tip(
        &self,
        contact: usize,
        from: &SkinPoint,
        to: &SkinPoint,
        spans: [f64; 2],
    ) -> Dissipation {
        let mode = &from.state.mode;
        let friction_state = mode.friction_states[contact];
        let (FrictionState::Locked { .. } | FrictionState::WithTip, Some(edge)) =
            (friction_state, Self::edge_of(mode, contact))
        else {
            return Dissipation::default();
        };
        // Use the friction state of the first point for both points, because it may change at the
        // second point.
        let by_normal_force = self.by_normal_force(contact, friction_state);
        let multiplier = self.unknown(contact, STICK_MULTIPLIER);
        let ends = [(&from.state, &from.leaving, spans[0]), (&to.state, &to.arriving, spans[1])];
        let ends = ends.map(|(state, direction, span)| {
            let [traction, growth] = [&state.z, direction].map(|z| {
                let normal_force: f64 =
                    self.normal_force_unknowns(mode, contact).map(|force| z[force]).sum();
                by_normal_force * normal_force
                    + if friction_state == FrictionState::WithTip { z[multiplier] } else { 0.0 }
            });
            let slide = self.slide(edge, contact, &self.pair_poses(&state.z, contact));
            let rate = self.pair_unknowns(contact).sum(&slide.gradient, direction);
            [traction, span * growth, slide.value, span * rate]
        });
        let [tractions, growth, slides, rates] = [0, 1, 2, 3].map(|k| ends.map(|end| end[k]));
        product_integral([tractions, growth], [slides, rates]) * -1.0
    }
}

/// Computes `∫ f dg` over a unit interval for two cubic polynomials `f` and `g`.
///
/// The arguments are `[values, slopes]` of `f` and of `g`, each at both ends of the interval. Three
/// Gauss points integrate the product exactly.
pub(crate) fn product_integral(
    [values, slopes]: [[f64; 2]; 2],
    [of_g, slopes_of_g]: [[f64; 2]; 2],
) -> Dissipation {
    let points = [
        (0.5, 4.0 / 9.0),
        (0.5 - 0.15_f64.sqrt(), 5.0 / 18.0),
        (0.5 + 0.15_f64.sqrt(), 5.0 / 18.0),
    ];
    let [start, end] = values;
    let terms = points.into_iter().map(|(x, weight)| {
        let cubic = start * (1.0 + 2.0 * x) * (1.0 - x).powi(2)
            + end * x * x * (3.0 - 2.0 * x)
            + slopes[0] * x * (1.0 - x).powi(2)
            + slopes[1] * x * x * (x - 1.0);
        let rate = 6.0 * x * (1.0 - x) * (of_g[1] - of_g[0])
            + slopes_of_g[0] * (1.0 - x) * (1.0 - 3.0 * x)
            + slopes_of_g[1] * x * (3.0 * x - 2.0);
        weight * (cubic * rate)
    });
    Dissipation { value: terms.sum(), trapezoid: 0.5 * (start + end) * (of_g[1] - of_g[0]) }
}

//! Locking of a beam with thin frictional plates on torsional springs.
//!
//! Plates of length `l` are attached to a beam at the pitch `d` by torsional springs at their
//! roots. At rest the plates are inclined by `θ₀` to the beam. After first contact, the plates
//! rotate about their roots to the inclination `θ`. The bent beam is an arc, with the angle `ψ`
//! between two neighbouring roots. The tip of each plate touches its neighbour if
//!
//! ```text
//! (l/d) ψ cos(ψ/2) = sin(θ + ψ/2)
//! ```
//!
//! At first contact `θ = θ₀`. The beam locks as soon as friction admits a contact force on a tip
//! without a moment about the root of the plate. With the friction coefficient `μ` this is at
//! `θ + ψ/2 = 90° − arctan μ`. If `θ₀ + ψ/2` already exceeds this angle at first contact, the beam
//! locks at first contact.
//!
//! Source: R. Ghosh, H. Ebrahimi, A. Vaziri, *Frictional effects in biomimetic scales engagement*,
//! EPL 113 (2016) 34003, doi 10.1209/0295-5075/113/34003.

use std::f64::consts::FRAC_PI_2;

use crate::bisected;

/// Arc angles between two roots at first contact and at locking, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engagement {
    /// Arc angle at which the plates first touch.
    pub touch: f64,
    /// Arc angle at which the beam locks.
    pub lock: f64,
}

/// Returns the arc angles at which inclined plates first touch and at which the beam locks.
///
/// `length_over_pitch` is `l/d`, `angle` is `θ₀` in radians, and `friction` is `μ`. `None` if the
/// plates do not touch, or the beam does not lock, before `ψ cos(ψ/2)` reaches its maximum.
pub fn engagement(length_over_pitch: f64, angle: f64, friction: f64) -> Option<Engagement> {
    let touch = root(|arc| arm(length_over_pitch, arc) - (angle + 0.5 * arc).sin())?;
    let lock = root(|arc| arm(length_over_pitch, arc) - (FRAC_PI_2 - friction.atan()).sin())?;
    Some(Engagement { touch, lock: lock.max(touch) })
}

/// Returns `(l/d) ψ cos(ψ/2)` for the arc angle `arc`.
fn arm(length_over_pitch: f64, arc: f64) -> f64 {
    length_over_pitch * arc * (0.5 * arc).cos()
}

/// Returns the zero of an increasing function of `ψ` below the maximum of `ψ cos(ψ/2)`.
///
/// The maximum is at the solution `last` of `ψ = 2 cot(ψ/2)`. `None` if the function has no zero.
fn root(f: impl Fn(f64) -> f64) -> Option<f64> {
    let last = 1.720_667_178_038_76;
    (f(last) >= 0.0).then(|| bisected([0.0, last], |arc| f(arc) < 0.0))
}

#[cfg(test)]
mod tests {
    use super::engagement;

    #[test]
    fn friction_advances_locking_and_steep_plates_lock_at_first_contact() {
        // Without friction the beam locks geometrically, at θ + ψ/2 = 90°.
        let smooth = engagement(5.0, 0.1, 0.0).expect("the plates touch");
        let arm = 5.0 * smooth.lock * (0.5 * smooth.lock).cos();
        assert!((arm - 1.0).abs() < 1e-12 && smooth.touch < smooth.lock);
        let rough = engagement(5.0, 0.1, 0.5).expect("the plates touch");
        assert!(
            rough.touch == smooth.touch && rough.lock < smooth.lock && rough.lock > rough.touch
        );
        let steep = engagement(5.0, 1.2, 0.5).expect("the plates touch");
        assert_eq!(steep.lock, steep.touch);
        assert_eq!(engagement(0.5, 0.1, 0.5), None);
    }
}

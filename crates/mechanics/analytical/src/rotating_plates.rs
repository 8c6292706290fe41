//! The bending of a beam with thin plates on torsional roots, which rub: where it locks.
//!
//! Plates of length `l` stand at the pitch `d`, inclined by `θ_0` to the beam, and turn about their roots once they touch.
//! On an arc of the angle `ψ` between two roots the tip of each lies on its neighbour where (R. Ghosh, H. Ebrahimi, A. Vaziri,
//! *Frictional effects in biomimetic scales engagement*, EPL 113 (2016) 34003, doi 10.1209/0295-5075/113/34003)
//!
//! ```text
//! (l/d) ψ cos(ψ/2) = sin(θ + ψ/2)
//! ```
//!
//! They touch first with `θ = θ_0`. The force on a tip has no moment left to turn its plate where it lies within the cone of
//! friction: the beam locks where `θ + ψ/2 = 90° − arctan μ`, or as soon as the plates touch if they stand steeper than that.

use std::f64::consts::FRAC_PI_2;

use crate::bisected;

/// The angle of the arc between two roots where plates touch and where they lock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engagement {
    /// The angle at which the plates touch first.
    pub touch: f64,
    /// The angle at which the beam locks.
    pub lock: f64,
}

/// Returns where plates of length `l/d`, inclined by `angle`, touch and where friction locks them, if they touch before
/// `ψ cos(ψ/2)` has its maximum.
pub fn engagement(length_over_pitch: f64, angle: f64, friction: f64) -> Option<Engagement> {
    let arm = |arc: f64| length_over_pitch * arc * (0.5 * arc).cos();
    let touch = root(|arc| arm(arc) - (angle + 0.5 * arc).sin())?;
    let lock = root(|arc| arm(arc) - (FRAC_PI_2 - friction.atan()).sin())?;
    Some(Engagement { touch, lock: lock.max(touch) })
}

/// The zero of an increasing function between 0 and the `ψ = 2 cot(ψ/2)` up to which `ψ cos(ψ/2)` rises.
fn root(f: impl Fn(f64) -> f64) -> Option<f64> {
    let last = 1.720_667_178_038_76;
    (f(last) >= 0.0).then(|| bisected([0.0, last], |arc| f(arc) < 0.0))
}

#[cfg(test)]
mod tests {
    use super::engagement;

    #[test]
    fn friction_brings_the_lock_forward_and_plates_that_stand_up_lock_where_they_touch() {
        // Without friction the lock is that of the kinematics: θ + ψ/2 = 90°.
        let smooth = engagement(5.0, 0.1, 0.0).expect("plates that touch");
        let arm = 5.0 * smooth.lock * (0.5 * smooth.lock).cos();
        assert!((arm - 1.0).abs() < 1e-12 && smooth.touch < smooth.lock);
        let rough = engagement(5.0, 0.1, 0.5).expect("plates that touch");
        assert!(
            rough.touch == smooth.touch && rough.lock < smooth.lock && rough.lock > rough.touch
        );
        let steep = engagement(5.0, 1.2, 0.5).expect("plates that touch");
        assert_eq!(steep.lock, steep.touch);
        assert_eq!(engagement(0.5, 0.1, 0.5), None);
    }
}

//! Locking of a beam with thin frictional plates on torsional roots.
//!
//! Plates of length `l` stand at the pitch `d`, inclined by `θ_0` to the beam, and rotate about
//! their roots once they touch. On an arc of angle `ψ` between two roots, the tip of each plate
//! lies on its neighbour if (R. Ghosh, H. Ebrahimi, A. Vaziri, *Frictional effects in biomimetic
//! scales engagement*, EPL 113 (2016) 34003, doi 10.1209/0295-5075/113/34003)
//!
//! ```text
//! (l/d) ψ cos(ψ/2) = sin(θ + ψ/2)
//! ```
//!
//! They first touch with `θ = θ_0`. Within the friction cone the force on a tip has no moment to
//! rotate its plate. The beam therefore locks at `θ + ψ/2 = 90° − arctan μ`, or on first touch if
//! the plates are steeper than that.

use std::f64::consts::FRAC_PI_2;

use crate::bisected;

/// Arc angles between two roots at first touch and at locking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engagement {
    /// Arc angle at which the plates first touch.
    pub touch: f64,
    /// Arc angle at which the beam locks.
    pub lock: f64,
}

/// Returns the angles of touch and of locking of inclined plates.
///
/// The plates have length `l/d` and are inclined by `angle`. `None` if they do not touch before the
/// maximum of `ψ cos(ψ/2)`.
pub fn engagement(length_over_pitch: f64, angle: f64, friction: f64) -> Option<Engagement> {
    let touch = root(|arc| arm(length_over_pitch, arc) - (angle + 0.5 * arc).sin())?;
    let lock = root(|arc| arm(length_over_pitch, arc) - (FRAC_PI_2 - friction.atan()).sin())?;
    Some(Engagement { touch, lock: lock.max(touch) })
}

fn arm(length_over_pitch: f64, arc: f64) -> f64 {
    length_over_pitch * arc * (0.5 * arc).cos()
}

/// Returns the zero of an increasing function of `ψ`, `None` if it has none.
///
/// The interval ends at the maximum of `ψ cos(ψ/2)`, where `ψ = 2 cot(ψ/2)`.
fn root(f: impl Fn(f64) -> f64) -> Option<f64> {
    let last = 1.720_667_178_038_76;
    (f(last) >= 0.0).then(|| bisected([0.0, last], |arc| f(arc) < 0.0))
}

#[cfg(test)]
mod tests {
    use super::engagement;

    #[test]
    fn friction_advances_locking_and_steep_plates_lock_at_first_touch() {
        // Without friction the beam locks kinematically, at θ + ψ/2 = 90°.
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

//! Contact law, Eq. (5).

use geometry::OutOfRange;

/// Constants of the contact law `F/(L b E_ct) = C₁ (δ/L)^C₂` (Eq. 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// Prefactor `C₁ > 0`, dimensionless.
    pub c1: f64,
    /// Exponent `C₂ > 0`, dimensionless.
    pub c2: f64,
}

impl Law {
    /// Constants as printed by Shafiei et al. (2021): `C₁ = 1.1`, `C₂ = 0.23`.
    pub const PRINTED: Self = Self { c1: 1.1, c2: 0.23 };

    /// Printed constants exchanged; finite elements support this reading.
    pub const EXCHANGED: Self = Self { c1: 0.23, c2: 1.1 };
}

/// Contact law of one design: the approach `δ` under a force `λ` on a corner.
///
/// ```text
/// δ(λ) = L (λ/λ₀)^(1/C₂),    λ₀ = C₁ L b E_ct                                      (C4)
/// ```
///
/// This is Eq. (5) in compliance form. For `C₂ < 1` the stiffness is infinite at first touch, so
/// the force as a function of the approach is unsuitable for Newton's method. The approach as a
/// function of the force is smooth, with zero slope at zero. For `C₂ > 1` the compliance is
/// infinite at first touch, but drops quickly: at `10⁻¹² λ₀` the slope is moderate. Below this
/// force a parabola with the same value and slope replaces the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// `λ₀`, the force at `δ = L`.
    force: f64,
    /// `L`.
    length: f64,
    exponent: f64,
    /// Coefficient of friction `μ` between two scales.
    friction: f64,
}

/// Force, as a fraction of `λ₀`, below which a parabola keeps the slope finite.
const SMALLEST_FORCE: f64 = 1e-12;

/// Approach of two scales under a contact force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Approach `δ`, over `t`.
    pub value: f64,
    /// `dδ/dλ`.
    pub slope: f64,
}

impl ContactLaw {
    /// Creates the law for scales of length `L` and width `b` (over `t`).
    ///
    /// The contact modulus `E_ct` is in the modulus unit of the forces.
    ///
    /// # Errors
    /// If a number is not positive and finite.
    pub fn new(law: Law, length: f64, width: f64, modulus: f64) -> Result<Self, OutOfRange> {
        let numbers = [
            ("c1 of the contact law", law.c1),
            ("c2 of the contact law", law.c2),
            ("length of the contact law", length),
            ("width of the contact law", width),
            ("modulus of the contact law", modulus),
        ];
        for (quantity, value) in numbers {
            let is_positive = value > 0.0 && value.is_finite();
            OutOfRange::unless(is_positive, quantity, value, "a positive number")?;
        }
        let force = law.c1 * length * width * modulus;
        Ok(Self { force, length, exponent: law.c2, friction: 0.0 })
    }

    /// Adds Coulomb friction with the coefficient `μ`.
    ///
    /// # Errors
    /// If the coefficient is negative or not finite.
    pub fn with_friction(self, friction: f64) -> Result<Self, OutOfRange> {
        let is_legal = friction >= 0.0 && friction.is_finite();
        OutOfRange::unless(
            is_legal,
            "friction between scales",
            friction,
            "a number of at least 0",
        )?;
        Ok(Self { friction, ..self })
    }

    /// Returns the coefficient of friction between two scales.
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// Computes the approach under a force, Eq. (C4).
    ///
    /// Negative forces, through which Newton's method may pass, give an odd continuation.
    pub fn approach(&self, force: f64) -> Approach {
        let n = self.exponent.recip();
        let ratio = force / self.force;
        if n < 1.0 && ratio.abs() < SMALLEST_FORCE {
            return self.first_approach(n, ratio / SMALLEST_FORCE);
        }
        let value = self.length * ratio.abs().powf(n).copysign(ratio);
        // Derived from the value, to save a second power.
        let slope = if ratio.abs() > SMALLEST_FORCE {
            n * value / force
        } else {
            n * self.length / self.force * SMALLEST_FORCE.powf(n - 1.0)
        };
        Approach { value, slope }
    }

    /// Evaluates the parabola `(2 − n) x − (1 − n) x |x|`.
    ///
    /// It meets `xⁿ` smoothly at `x = 1`. `x` is relative to the smallest force. Value and slope
    /// must be consistent: while a contact opens, the path turns within these forces, and Newton's
    /// method follows it.
    fn first_approach(&self, n: f64, x: f64) -> Approach {
        let unit = self.length * SMALLEST_FORCE.powf(n);
        Approach {
            value: unit * x * (2.0 - n - (1.0 - n) * x.abs()),
            slope: unit * (2.0 - n - 2.0 * (1.0 - n) * x.abs()) / (SMALLEST_FORCE * self.force),
        }
    }

    /// Computes the elastic energy `∫ λ dδ = λ δ / (1 + C₂)` of a contact.
    pub fn energy(&self, force: f64) -> f64 {
        force * self.approach(force).value / (1.0 + self.exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::{ContactLaw, Law};
    use approx::assert_relative_eq;

    fn laws() -> [(Law, ContactLaw); 3] {
        [Law::PRINTED, Law::EXCHANGED, Law { c1: 2.0, c2: 1.0 }]
            .map(|law| (law, ContactLaw::new(law, 0.4, 1.5, 7000.0).unwrap()))
    }

    #[test]
    fn force_and_approach_obey_equation_5() {
        for (law, contact) in laws() {
            for force in [1e-3, 0.1, 20.0, 900.0] {
                let approach = contact.approach(force).value;
                let expected = law.c1 * (approach / 0.4).powf(law.c2) * 0.4 * 1.5 * 7000.0;
                assert_relative_eq!(force, expected, max_relative = 1e-12);
            }
        }
    }

    #[test]
    fn slope_is_the_derivative_on_both_sides_of_zero() {
        for (_, contact) in laws() {
            for force in [-3.0_f64, -0.02, 0.02, 3.0] {
                let h = 1e-6 * force.abs();
                let difference =
                    contact.approach(force + h).value - contact.approach(force - h).value;
                let slope = contact.approach(force).slope;
                assert_relative_eq!(slope, difference / (2.0 * h), max_relative = 1e-7);
            }
        }
    }

    /// Also holds for an exponent with infinite slope at zero.
    ///
    /// The parabola replaces the power law there.
    #[test]
    fn slope_is_the_derivative_at_first_touch() {
        let (law, contact) = laws()[1];
        let smallest = 1e-12 * law.c1 * 0.4 * 1.5 * 7000.0;
        for part in [-0.9, -0.1, 0.1, 0.5, 0.9, 1.0, 1.1, 2.0] {
            let (force, h) = (part * smallest, 1e-4 * smallest);
            let [below, above] = [-h, h].map(|h| contact.approach(force + h).value);
            let difference = (above - below) / (2.0 * h);
            assert_relative_eq!(contact.approach(force).slope, difference, max_relative = 1e-4);
        }
    }

    #[test]
    fn the_slope_at_first_touch_is_finite() {
        for (_, contact) in laws() {
            assert!(contact.approach(0.0).slope.is_finite());
        }
    }

    #[test]
    fn energy_is_the_work_of_the_force() {
        for (_, contact) in laws() {
            let n = 20_000;
            let work: f64 = (0..n)
                .map(|i| {
                    let [low, high] =
                        [i, i + 1].map(|i| 50.0 * (f64::from(i) / f64::from(n)).powi(3));
                    let step = contact.approach(high).value - contact.approach(low).value;
                    0.5 * (low + high) * step
                })
                .sum();
            assert_relative_eq!(contact.energy(50.0), work, max_relative = 1e-6);
        }
    }

    #[test]
    fn constants_must_be_positive() {
        let error = ContactLaw::new(Law { c1: 1.1, c2: 0.0 }, 1.0, 1.0, 1.0).unwrap_err();
        assert_eq!(error.to_string(), "c2 of the contact law is 0, expected a positive number");
    }
}

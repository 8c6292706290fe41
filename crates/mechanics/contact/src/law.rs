//! Power law between force and approach of a contact, Eq. (5) of Shafiei et al. (2021).

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

    /// Printed values with `C₁` and `C₂` exchanged, which agree better with finite elements.
    pub const EXCHANGED: Self = Self { c1: 0.23, c2: 1.1 };
}

/// Contact law of one design: the approach `δ` under a force `λ` on a corner.
///
/// ```text
/// δ(λ) = L (λ/λ₀)^(1/C₂),    λ₀ = C₁ L b E_ct                                      (C4)
/// ```
///
/// This is Eq. (5) solved for the approach. For `C₂ < 1` the derivative `dλ/dδ` is infinite at
/// `δ = 0`, so `λ(δ)` is unsuitable for Newton's method, while `δ(λ)` is smooth and has zero slope
/// at `λ = 0`. For `C₂ > 1` the slope of `δ(λ)` is infinite at `λ = 0` but moderate from
/// `10⁻¹² λ₀` on. Below this force a parabola replaces the power law, with the value and the slope
/// of the power law at `10⁻¹² λ₀`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Force `λ₀` at the approach `δ = L`.
    force: f64,
    /// Length `L`, in units of `t`.
    length: f64,
    /// Exponent `C₂`.
    exponent: f64,
    /// Coefficient of friction `μ` between two scales.
    friction: f64,
}

/// Force, as a fraction of `λ₀`, below which a parabola replaces the power law for `C₂ > 1`.
const SMALLEST_FORCE: f64 = 1e-12;

/// Approach of two scales under a contact force `λ`, with its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Approach `δ`, in units of `t`.
    pub value: f64,
    /// Derivative `dδ/dλ`.
    pub slope: f64,
}

impl ContactLaw {
    /// Creates the law without friction for scales of length `L` and width `b`.
    ///
    /// Both lengths are in units of `t`. `modulus` is the contact modulus `E_ct`, in units of the
    /// modulus by which forces are divided (`E*` in puncture, `E_m` in bending).
    ///
    /// # Errors
    /// If a constant, a length or the modulus is not positive and finite.
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

    /// Returns the law with the coefficient `friction` of Coulomb friction.
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

    /// Returns the coefficient of friction `μ` between two scales.
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// Computes the approach `δ` under the force `λ`, Eq. (C4).
    ///
    /// Newton iterations may pass through negative forces, so `δ` is continued as an odd function:
    /// `δ(−λ) = −δ(λ)`.
    pub fn approach(&self, force: f64) -> Approach {
        let n = self.exponent.recip();
        let ratio = force / self.force;
        if n < 1.0 && ratio.abs() < SMALLEST_FORCE {
            return self.first_approach(n, ratio / SMALLEST_FORCE);
        }
        let value = self.length * ratio.abs().powf(n).copysign(ratio);
        // The slope is computed from the value, because a second power would be expensive.
        let slope = if ratio.abs() > SMALLEST_FORCE {
            n * value / force
        } else {
            n * self.length / self.force * SMALLEST_FORCE.powf(n - 1.0)
        };
        Approach { value, slope }
    }

    /// Computes the approach at small forces by the parabola `(2 − n) x − (1 − n) x |x|`.
    ///
    /// `x` is the force divided by the smallest force of the power law. At `x = 1` the parabola has
    /// the value and the slope of `xⁿ`. The returned slope is the exact derivative of the value:
    /// while a contact opens, the equilibrium path may turn at such small forces, and Newton's
    /// method must converge there.
    fn first_approach(&self, n: f64, x: f64) -> Approach {
        let unit = self.length * SMALLEST_FORCE.powf(n);
        Approach {
            value: unit * x * (2.0 - n - (1.0 - n) * x.abs()),
            slope: unit * (2.0 - n - 2.0 * (1.0 - n) * x.abs()) / (SMALLEST_FORCE * self.force),
        }
    }

    /// Returns the elastic energy `∫ λ dδ = λ δ/(1 + C₂)` of a contact under the force `λ`.
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
    fn force_and_approach_satisfy_equation_5() {
        for (law, contact) in laws() {
            for force in [1e-3, 0.1, 20.0, 900.0] {
                let approach = contact.approach(force).value;
                let expected = law.c1 * (approach / 0.4).powf(law.c2) * 0.4 * 1.5 * 7000.0;
                assert_relative_eq!(force, expected, max_relative = 1e-12);
            }
        }
    }

    #[test]
    fn slope_is_the_derivative_for_positive_and_negative_forces() {
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

    /// Checks the parabola for a law with `C₂ > 1`, around the smallest force of the power law.
    #[test]
    fn slope_is_the_derivative_of_the_parabola_at_small_forces() {
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
    fn the_slope_at_zero_force_is_finite() {
        for (_, contact) in laws() {
            assert!(contact.approach(0.0).slope.is_finite());
        }
    }

    #[test]
    fn energy_equals_the_work_of_the_force() {
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
    fn constants_that_are_not_positive_are_refused() {
        let error = ContactLaw::new(Law { c1: 1.1, c2: 0.0 }, 1.0, 1.0, 1.0).unwrap_err();
        assert_eq!(error.to_string(), "c2 of the contact law is 0, expected a positive number");
    }
}

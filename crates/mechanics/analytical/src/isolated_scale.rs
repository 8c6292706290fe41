//! Closed-form solution for the puncture of a scale without neighbours.
//!
//! The scale is supported by its two springs alone. A downward load `F` acts on a point of the
//! scale with the position `r` relative to the node. The scale rotates by `ψ` clockwise, its node
//! moves up by `y`, and the loaded point moves down by `u`:
//!
//! ```text
//! k_y y = −F,    k_φ ψ = F (r_x cos ψ + r_y sin ψ),    k_y = a α_y,  k_φ = a³ α_φ
//! u = −y + r_x sin ψ + r_y (1 − cos ψ)
//! ```
//!
//! These equations give `F(ψ)`, `u(ψ)` and the energies `½ k_y y²` and `½ k_φ ψ²` in closed form.
//! Forces are in units of `E* t²`, lengths in units of `t`.

/// Punctured scale without neighbours, supported by two springs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IsolatedScale {
    /// Stiffness `k_y = a α_y` of the spring for vertical displacement.
    pub normal: f64,
    /// Stiffness `k_φ = a³ α_φ` of the spring for rotation.
    pub rotation: f64,
    /// Vector `r` from the node to the loaded point, in the scale at rest.
    pub arm: [f64; 2],
}

impl IsolatedScale {
    /// Returns the load `F` at the tilt `psi` (radians).
    pub fn force(&self, psi: f64) -> f64 {
        let (sin, cos) = psi.sin_cos();
        self.rotation * psi / (self.arm[0] * cos + self.arm[1] * sin)
    }

    /// Returns the downward displacement `u` of the loaded point at the tilt `psi` (radians).
    pub fn displacement(&self, psi: f64) -> f64 {
        let (sin, cos) = psi.sin_cos();
        self.sink(psi) + self.arm[0] * sin + self.arm[1] * (1.0 - cos)
    }

    /// Returns the downward displacement `−y` of the node at the tilt `psi` (radians).
    pub fn sink(&self, psi: f64) -> f64 {
        self.force(psi) / self.normal
    }

    /// Returns the elastic energy of both springs at the tilt `psi` (radians).
    pub fn energy(&self, psi: f64) -> f64 {
        0.5 * (self.force(psi).powi(2) / self.normal + self.rotation * psi.powi(2))
    }

    /// Returns the stiffness `dF/du` at rest.
    pub fn initial_stiffness(&self) -> f64 {
        1.0 / (1.0 / self.normal + self.arm[0] * self.arm[0] / self.rotation)
    }
}

#[cfg(test)]
mod tests {
    use super::IsolatedScale;

    const SCALE: IsolatedScale = IsolatedScale { normal: 0.8, rotation: 0.3, arm: [1.2, 1.0] };

    #[test]
    fn the_initial_stiffness_is_the_slope_of_the_load_curve_at_rest() {
        let psi = 1e-7;
        let slope = SCALE.force(psi) / SCALE.displacement(psi);
        assert!((slope / SCALE.initial_stiffness() - 1.0).abs() < 1e-6, "{slope}");
    }

    /// Integrates the work `∫ F du` with the trapezoidal rule.
    #[test]
    fn the_work_of_the_load_equals_the_elastic_energy() {
        let (steps, end) = (2000, 0.4);
        let work: f64 = (0..steps)
            .map(|k| {
                let [from, to] = [k, k + 1].map(|k| end * f64::from(k) / f64::from(steps));
                let force = 0.5 * (SCALE.force(from) + SCALE.force(to));
                force * (SCALE.displacement(to) - SCALE.displacement(from))
            })
            .sum();
        assert!((work / SCALE.energy(end) - 1.0).abs() < 1e-6, "{work}");
    }
}

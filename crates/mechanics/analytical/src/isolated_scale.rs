//! Puncture of a scale without neighbours.
//!
//! The load `F` acts downwards at `r` from the node of a scale that has rotated by `ψ` clockwise
//! and is held only by its own springs,
//!
//! ```text
//! k_y y = −F,    k_φ ψ = F (r_x cos ψ + r_y sin ψ),    k_y = a α_y,  k_φ = a³ α_φ
//! u = −y + r_x sin ψ + r_y (1 − cos ψ)
//! ```
//!
//! so `F(ψ)` and `u(ψ)` are known in closed form, and so are the energies `½ k_y y²` and
//! `½ k_φ ψ²`. Forces are in units of `E* t²`, lengths in units of `t`.

/// Scale held by its own springs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IsolatedScale {
    /// `k_y = a α_y`.
    pub normal: f64,
    /// `k_φ = a³ α_φ`.
    pub rotation: f64,
    /// `r`: point of the load relative to the node of the scale at rest.
    pub arm: [f64; 2],
}

impl IsolatedScale {
    /// Returns the load `F` at the tilt `psi` (radians).
    pub fn force(&self, psi: f64) -> f64 {
        let (sin, cos) = psi.sin_cos();
        self.rotation * psi / (self.arm[0] * cos + self.arm[1] * sin)
    }

    /// Returns the displacement `u` of the loaded point at the tilt `psi` (radians).
    pub fn displacement(&self, psi: f64) -> f64 {
        let (sin, cos) = psi.sin_cos();
        self.sink(psi) + self.arm[0] * sin + self.arm[1] * (1.0 - cos)
    }

    /// Returns the settlement `−y` of the node at the tilt `psi` (radians).
    pub fn sink(&self, psi: f64) -> f64 {
        self.force(psi) / self.normal
    }

    /// Returns the elastic energy of the substrate at the tilt `psi` (radians).
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
    fn the_initial_stiffness_is_the_slope_at_rest() {
        let psi = 1e-7;
        let slope = SCALE.force(psi) / SCALE.displacement(psi);
        assert!((slope / SCALE.initial_stiffness() - 1.0).abs() < 1e-6, "{slope}");
    }

    /// `dU = F du` along the path.
    #[test]
    fn the_work_of_the_load_is_the_energy() {
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

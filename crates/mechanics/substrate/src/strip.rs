//! Strip of the substrate's surface between two neighbouring bases: its stretch and its law.

/// Response of the surface strip between two neighbouring bases.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SubstrateLaw {
    /// Linear springs, Eq. (1) of Shafiei et al. (2021).
    ///
    /// They allow two neighbouring bases to cross, which is physically impossible.
    #[default]
    Linear,
    /// Incompressible neo-Hookean bars, which no finite force compresses to zero length.
    NeoHookean,
}

/// Surface strip between the right end of one base and the left end of the next.
///
/// The width `s` is measured along the row, between the corners of the deformed bases:
///
/// ```text
///        BR_i ──── s ──── BL_{i+1}        s = d + e,    e = x' − x + a (2 − cos φ − cos φ')
/// g = s/d                                 1 at rest; the surface folds over where g ≤ 0           (V1)
/// ```
///
/// where `(x, y, φ)` and `(x', y', φ')` are the poses of the left and of the right scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceStrip {
    /// Width at rest, equal to the gap `d` between the bases.
    pub width: f64,
    /// Half-width `a` of the bases on both sides.
    pub half_base: f64,
}

impl SurfaceStrip {
    /// Computes the stretch `g` of the strip from the poses `(x, y, φ)` of both scales.
    pub fn stretch(&self, left: [f64; 3], right: [f64; 3]) -> f64 {
        self.stretch_by(right[0] - left[0], shortening(left[2]) + shortening(right[2]))
    }

    /// Computes the stretch `g` from relative displacement and shortening of the bases.
    ///
    /// `apart` is `x' − x`; `shortened` is `2 − cos φ − cos φ'`.
    pub fn stretch_by(&self, apart: f64, shortened: f64) -> f64 {
        1.0 + (apart + self.half_base * shortened) / self.width
    }

    /// Computes the rate of the stretch from poses and pose rates `(x, y, φ)` of both scales.
    pub fn stretch_rate(
        &self,
        [left, right]: [[f64; 3]; 2],
        [left_rate, right_rate]: [[f64; 3]; 2],
    ) -> f64 {
        let turned = left[2].sin() * left_rate[2] + right[2].sin() * right_rate[2];
        (right_rate[0] - left_rate[0] + self.half_base * turned) / self.width
    }
}

/// Computes the relative shortening `1 − cos φ` of a half-base along the row by its rotation.
pub fn shortening(rotation: f64) -> f64 {
    // 1 − cos φ = 2 sin²(φ/2), without cancellation.
    2.0 * (0.5 * rotation).sin().powi(2)
}

/// Returns the energy of a neo-Hookean bar and its first two derivatives.
///
/// Derivatives are with respect to the stretch `g`. All values are divided by `k d²`, where `k` is
/// the stiffness and `d` the length of the bar at rest:
///
/// ```text
/// w = (g² + 2/g − 3)/6,   w' = (g − g⁻²)/3,   w" = (1 + 2 g⁻³)/3,   w"(1) = 1                    (V3)
/// ```
///
/// The bar is incompressible and under uniaxial stress. The values are infinite for `g ≤ 0`, so a
/// bar never reaches zero length.
pub fn neo_hookean(stretch: f64) -> [f64; 3] {
    if stretch <= 0.0 {
        return [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY];
    }
    let inverse = 1.0 / stretch;
    let (g, square) = (stretch, inverse * inverse);
    // g² + 2/g − 3 = (g − 1)² (g + 2)/g, without cancellation.
    let energy = (g - 1.0).powi(2) * (g + 2.0) * inverse / 6.0;
    let force = (g - 1.0) * (g * g + g + 1.0) * square / 3.0;
    [energy, force, (1.0 + 2.0 * square * inverse) / 3.0]
}

#[cfg(test)]
mod tests {
    use super::{SurfaceStrip, neo_hookean};
    use approx::assert_relative_eq;

    const STRIP: SurfaceStrip = SurfaceStrip { width: 0.2, half_base: 0.5 };

    #[test]
    fn a_bar_at_rest_has_no_force_and_unit_stiffness() {
        assert_eq!(neo_hookean(1.0), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn force_and_stiffness_are_derivatives_of_the_energy() {
        for stretch in [0.05, 0.3, 0.9, 1.0, 1.1, 3.0, 20.0] {
            let step = 1e-5 * stretch;
            let [low, high] = [stretch - step, stretch + step].map(neo_hookean);
            let [_, force, stiffness] = neo_hookean(stretch);
            let slopes = [0, 1].map(|k| (high[k] - low[k]) / (2.0 * step));
            assert_relative_eq!(slopes[0], force, epsilon = 1e-9, max_relative = 1e-8);
            assert_relative_eq!(slopes[1], stiffness, max_relative = 1e-8);
        }
    }

    #[test]
    fn no_strip_can_be_compressed_to_zero_width() {
        assert!(neo_hookean(1e-6)[1] < -1e11);
        for stretch in [0.0, -0.5] {
            assert!(neo_hookean(stretch).iter().all(|number| number.is_infinite()));
        }
    }

    #[test]
    fn a_strip_is_measured_between_the_corners_of_rotated_bases() {
        let (left, right): ([f64; 3], [f64; 3]) = ([0.3, 0.1, -0.4], [0.1, -0.2, 0.7]);
        // Along the row: BL of the right base minus BR of the left base.
        let corner = 0.5 + 0.2 + 0.5 + right[0] - 0.5 * right[2].cos();
        let length = corner - (left[0] + 0.5 * left[2].cos());
        assert_relative_eq!(STRIP.stretch(left, right), length / 0.2, max_relative = 1e-14);
        let rates = [[0.2, 9.0, 0.3], [-0.1, 9.0, 0.5]];
        let [high, low] = [1e-6, -1e-6].map(|step| {
            let [left, right] = [0, 1].map(|scale| {
                std::array::from_fn(|k| [left, right][scale][k] + step * rates[scale][k])
            });
            STRIP.stretch(left, right)
        });
        let slope = (high - low) / 2e-6;
        assert_relative_eq!(STRIP.stretch_rate([left, right], rates), slope, max_relative = 1e-8);
    }
}

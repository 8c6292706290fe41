//! A scale as a beam that is clamped at its base: stress, bending and bond tractions (B1–B3).
//!
//! The axis of the beam leads from the node along `e = (sin α, cos α)`. The beam has the length
//! `l = 1/cos α`, the depth `h = 2a cos α` and the width `b`. Sections are perpendicular to `e`.
//! Lengths are in `t`, forces in `E* t²`, stresses in `E*`.

use geometry::{Parallelogram, Vec2};

/// Poisson's ratio of a scale, for its shear modulus `G = E_c/(2 (1 + ν_c))`.
///
/// Glassy polymers have 0.35 to 0.4, ceramics 0.2 to 0.25. The ratio only affects the part of a
/// deflection that is due to shear, which is small.
const POISSON_RATIO: f64 = 0.35;

/// Shear coefficient of a rectangular section.
const SHEAR_COEFFICIENT: f64 = 5.0 / 6.0;

/// Distance along the axis within which two loads act on the same section, in units of `t`.
///
/// For example, both top corners of an upright scale have the same height up to round-off.
const SAME_SECTION: f64 = 1e-9;

/// Force of a contact or of the needle on a scale, in the frame of the scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Load {
    /// Vector from the node to the loaded point.
    pub(super) arm: Vec2,
    pub(super) force: Vec2,
}

/// Tractions between the base of a scale and the substrate, assumed linear along the base (B3).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct BaseTractions {
    /// Largest tensile traction of the bond: mean traction plus the bending part.
    ///
    /// It is 0 if the whole base is in compression.
    pub(super) tension: f64,
    /// Mean shear traction.
    pub(super) shear: f64,
    /// Mean pressure on the substrate; negative where the scale is lifted.
    pub(super) pressure: f64,
}

/// Motion of the tip of a scale relative to its base, caused by bending (B2).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct TipMotion {
    /// Deflection perpendicular to the axis, by bending and shear, in units of `t`.
    pub(super) deflection: f64,
    /// Rotation of the section at the tip, radians, positive counter-clockwise.
    pub(super) rotation: f64,
}

/// A scale as a beam.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    /// Unit vector `e` of the axis.
    pub(super) along: Vec2,
    pub(super) length: f64,
    pub(super) depth: f64,
    width: f64,
    half_base: f64,
}

impl Beam {
    pub(super) fn new(scale: &Parallelogram, width: f64) -> Self {
        let (sin, cos) = scale.slant().sin_cos();
        let half_base = scale.half_base();
        Self {
            along: Vec2::new(sin, cos),
            length: cos.recip(),
            depth: 2.0 * half_base * cos,
            width,
            half_base,
        }
    }

    /// Computes the largest bending stress of any section (B1).
    pub(super) fn stress(&self, loads: &[Load]) -> f64 {
        // The bending moment is linear between loads, so its extremes lie at loads and at the base.
        let at_loads = loads.iter().map(|load| load.arm.dot(&self.along));
        let inside = at_loads.filter(|s| (0.0..=self.length).contains(s));
        // A load at a top corner may lie beyond the last section, so check the last section, too.
        let sections = inside.chain([0.0, self.length]);
        sections.map(|s| self.stress_below(loads, s)).fold(0.0, f64::max)
    }

    /// Computes the stress in the section at `s`, including loads that act on this section.
    fn stress_below(&self, loads: &[Load], s: f64) -> f64 {
        // A load at the base does not stress the section at the base.
        let beyond = loads.iter().filter(|load| {
            let at = load.arm.dot(&self.along);
            at >= s - SAME_SECTION && at > SAME_SECTION
        });
        let (mut moment, mut normal) = (0.0, 0.0);
        for Load { arm, force } in beyond {
            moment += (arm - s * self.along).perp(force);
            normal += force.dot(&self.along);
        }
        let area = self.width * self.depth;
        6.0 * moment.abs() / (area * self.depth) + normal.abs() / area
    }

    /// Computes the stiffness of a section in bending, `E_c I`, and in shear.
    pub(super) fn stiffness(&self, modulus: f64) -> [f64; 2] {
        let bending = modulus * self.width * self.depth.powi(3) / 12.0;
        let shear = modulus / (2.0 * (1.0 + POISSON_RATIO));
        [bending, SHEAR_COEFFICIENT * shear * self.width * self.depth]
    }

    /// Computes the motion of the tip of a scale with Young's `modulus` (B2).
    pub(super) fn tip_motion(&self, loads: &[Load], modulus: f64) -> TipMotion {
        let [bending, shear] = self.stiffness(modulus);
        let length = self.length;
        let mut tip = TipMotion::default();
        for Load { arm, force } in loads {
            // Between the base and the load, the bending moment at `s` is `moment − across s`.
            let (moment, across) = (arm.perp(force), self.along.perp(force));
            let end = arm.dot(&self.along).clamp(0.0, length);
            let (square, cube) = (end.powi(2) / 2.0, end.powi(3) / 3.0);
            tip.rotation += (moment * end - across * square) / bending;
            let bent = length * (moment * end - across * square) - moment * square + across * cube;
            tip.deflection += bent / bending + across * end / shear;
        }
        tip
    }

    /// Computes the tractions at the base, which are in equilibrium with the loads (B3).
    pub(super) fn base_tractions(&self, loads: &[Load]) -> BaseTractions {
        let (mut force, mut moment) = (Vec2::zeros(), 0.0);
        for load in loads {
            force += load.force;
            moment += load.arm.perp(&load.force);
        }
        let area = 2.0 * self.half_base * self.width;
        let section_modulus = area * self.half_base / 3.0;
        let mean = force.y / area;
        BaseTractions {
            tension: (mean + moment.abs() / section_modulus).max(0.0),
            shear: force.x.abs() / area,
            pressure: -mean,
        }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    const MODULUS: f64 = 7000.0;

    fn beam(half_base: f64, slant_deg: f64, width: f64) -> Beam {
        Beam::new(&Parallelogram::new(half_base, slant_deg).unwrap(), width)
    }

    /// Creates a load at the distance `s` along the axis and an `offset` to its left.
    ///
    /// The force has components along the axis and across it, to the left.
    fn load(beam: &Beam, [s, offset]: [f64; 2], [along, across]: [f64; 2]) -> Load {
        let side = Vec2::new(-beam.along.y, beam.along.x);
        Load { arm: s * beam.along + offset * side, force: along * beam.along + across * side }
    }

    #[test]
    fn a_cantilever_bends_as_in_closed_form() {
        for slant in [0.0, 40.0, 75.0] {
            let beam = beam(0.1, slant, 2.0);
            let (length, area) = (beam.length, beam.width * beam.depth);
            let bending = MODULUS * area * beam.depth.powi(2) / 12.0;
            let shear = MODULUS / 2.7 * area / 1.2;
            let tip = load(&beam, [length, 0.0], [0.0, 0.3]);
            assert_relative_eq!(
                beam.stress(&[tip]),
                6.0 * 0.3 * length / (area * beam.depth),
                max_relative = 1e-13
            );
            let motion = beam.tip_motion(&[tip], MODULUS);
            assert_relative_eq!(
                motion.rotation,
                0.3 * length.powi(2) / (2.0 * bending),
                max_relative = 1e-13
            );
            assert_relative_eq!(
                motion.deflection,
                0.3 * length.powi(3) / (3.0 * bending) + 0.3 * length / shear,
                max_relative = 1e-13
            );
            // A force in the middle of the axis leaves the outer half straight.
            let half = length / 2.0;
            let motion = beam.tip_motion(&[load(&beam, [half, 0.0], [0.0, 0.3])], MODULUS);
            let rotation = 0.3 * half.powi(2) / (2.0 * bending);
            let at_load = 0.3 * half.powi(3) / (3.0 * bending) + 0.3 * half / shear;
            assert_relative_eq!(motion.rotation, rotation, max_relative = 1e-13);
            let deflection = at_load + rotation * half;
            assert_relative_eq!(motion.deflection, deflection, max_relative = 1e-13);
        }
    }

    /// The stress must not depend on round-off in the order of two loads at the same height.
    #[test]
    fn loads_at_the_same_height_act_on_the_same_section() {
        let beam = beam(0.2, 0.0, 1.0);
        for off in [0.0, 1e-15, -1e-15] {
            let pair = [[0.8 + off, 0.1], [0.8, -0.1]];
            let stress = beam.stress(&pair.map(|position| load(&beam, position, [-1.0, 0.0])));
            assert_relative_eq!(stress, 2.0 / beam.depth, max_relative = 1e-12);
        }
    }

    #[test]
    fn a_force_beside_the_axis_compresses_and_bends() {
        let beam = beam(0.2, 30.0, 1.0);
        let pushed = load(&beam, [0.7 * beam.length, beam.depth / 2.0], [-2.0, 0.0]);
        // Four times the mean stress, as for a column loaded at its edge.
        let stress = 4.0 * 2.0 / (beam.width * beam.depth);
        assert_relative_eq!(beam.stress(&[pushed]), stress, max_relative = 1e-13);
        // Three loads in equilibrium bend the beam between them, but not at the base.
        let pair = [
            load(&beam, [0.8, 0.0], [0.0, 1.0]),
            load(&beam, [0.5, 0.0], [0.0, -2.0]),
            load(&beam, [0.2, 0.0], [0.0, 1.0]),
        ];
        let between = 6.0 * 0.3 / (beam.width * beam.depth.powi(2));
        assert_relative_eq!(beam.stress(&pair), between, max_relative = 1e-12);
        let base = beam.base_tractions(&pair);
        assert!(base.tension.abs() < 1e-13 && base.shear.abs() < 1e-13, "{base:?}");
    }

    #[test]
    fn tractions_vary_linearly_across_the_base() {
        let beam = beam(0.5, 0.0, 2.0);
        let area = 2.0;
        let pressed = Load { arm: Vec2::new(0.1, 1.0), force: Vec2::new(0.0, -3.0) };
        let base = beam.base_tractions(&[pressed]);
        assert_relative_eq!(base.pressure, 3.0 / area, max_relative = 1e-14);
        // A force within the middle third of the base causes no tension.
        assert_eq!((base.tension, base.shear), (0.0, 0.0));
        let pushed = Load { arm: Vec2::new(0.0, 1.0), force: Vec2::new(3.0, 0.0) };
        let base = beam.base_tractions(&[pushed]);
        // The tension is 6 M/(b (2a)²) with M = 3, the force times a lever arm of 1.
        assert_relative_eq!(base.tension, 6.0 * 3.0 / 2.0, max_relative = 1e-14);
        assert_relative_eq!(base.shear, 1.5, max_relative = 1e-14);
    }
}

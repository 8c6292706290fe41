//! Loads on a scale as a beam, and the flexibilities between them.

use contact::{COORDINATES, CornerEdge};
use geometry::Vec2;

use super::Beam;
use crate::contacts::{PairCoordinate, TouchingEdge};

/// Value with its first and second derivative with respect to the coordinate of a load.
type Varying = [f64; 3];

/// Force on a scale that bends as a beam.
///
/// The load has one coordinate: an angle if it acts at a fixed point in a direction that turns, or
/// its position if it slides along an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct BeamLoad {
    /// Index of the unknown force; `None` for the moment at the tip.
    pub(super) unknown: Option<usize>,
    pub(super) force: f64,
    /// Moment about the node, per unit force.
    pub(super) moment: Varying,
    /// Force perpendicular to the axis of the beam, per unit force.
    pub(super) across: Varying,
    /// Position along the beam, with its first derivative with respect to the coordinate.
    pub(super) section: [f64; 2],
    /// Indices of the unknowns on which the coordinate depends.
    pub(super) at: [usize; COORDINATES],
    /// Derivatives of the coordinate with respect to these unknowns.
    pub(super) slopes: [f64; COORDINATES],
    /// Second derivatives of the coordinate with respect to these unknowns.
    pub(super) curvature: [[f64; COORDINATES]; COORDINATES],
}

/// Flexibility `C_kl` of a scale (B7), with derivatives.
///
/// Derivatives are with respect to the coordinates of the first load `k` and the second load `l`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Flexibility {
    pub(super) value: f64,
    /// First derivative with respect to the coordinate of load `k`.
    pub(super) by_first: f64,
    /// Second derivative with respect to the coordinate of load `k`.
    pub(super) by_first_twice: f64,
    /// Mixed derivative with respect to the coordinates of both loads.
    pub(super) by_both: f64,
}

/// Length and stiffness of a scale as a beam.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    pub(super) length: f64,
    /// Half of the length over which the shear force of a load falls to 0.
    pub(super) spread: f64,
    /// Bending stiffness `E_c I`.
    pub(super) bending: f64,
    pub(super) shear_stiffness: f64,
}

impl BeamLoad {
    /// Creates a unit load at a point fixed to the scale, with an angle as its coordinate.
    ///
    /// `direction` is the direction of the load, which turns as this angle changes.
    pub(super) fn at_point(beam: &Beam, point: Vec2, direction: Vec2, section: f64) -> Self {
        let turned = contact::quarter(direction);
        let (moment, across) = (point.perp(&direction), beam.along.perp(&direction));
        Self {
            unknown: None,
            force: 0.0,
            moment: [moment, point.perp(&turned), -moment],
            across: [across, beam.along.perp(&turned), -across],
            section: [section, 0.0],
            at: [0; COORDINATES],
            slopes: [0.0; COORDINATES],
            curvature: [[0.0; COORDINATES]; COORDINATES],
        }
    }

    /// Iterates over the unknowns on which the coordinate depends, with its derivatives.
    pub(super) fn varying(&self) -> impl Iterator<Item = (usize, f64)> {
        self.at.into_iter().zip(self.slopes).filter(|(_, slope)| *slope != 0.0)
    }

    /// Computes the derivative of the coordinate of the load along a direction of the unknowns.
    pub(super) fn along(&self, direction: &[f64]) -> f64 {
        self.at.iter().zip(self.slopes).map(|(&at, slope)| slope * direction[at]).sum()
    }

    /// Returns `∫ M ds` and `−∫ M s ds` from the base to the section `z`.
    ///
    /// `M` is the moment of the unit load, or with `derivative` 1 or 2 the first or second
    /// derivative of this moment with respect to the coordinate.
    fn integrals(&self, derivative: usize, z: f64) -> [f64; 2] {
        let (moment, across) = (self.moment[derivative], self.across[derivative]);
        let (square, cube) = (z * z / 2.0, z * z * z / 3.0);
        [moment * z - across * square, across * cube - moment * square]
    }

    /// Creates a unit moment at the tip.
    pub(super) fn tip_moment(beam: &Beam, at: [usize; COORDINATES]) -> Self {
        Self {
            moment: [1.0, 0.0, 0.0],
            across: [0.0; 3],
            at,
            ..Self::at_point(beam, Vec2::zeros(), Vec2::zeros(), beam.length)
        }
    }

    /// Sets the coordinate of the load to `sign` times a coordinate of its pair of scales.
    fn along_pair(self, touching: &TouchingEdge, sign: f64, coordinate: &PairCoordinate) -> Self {
        Self {
            unknown: Some(touching.unknown),
            force: touching.force,
            at: touching.at,
            slopes: coordinate.slopes.map(|slope| sign * slope),
            curvature: coordinate.curvature.map(|row| row.map(|value| sign * value)),
            ..self
        }
    }

    /// Creates the load of a contact on one of its two scales, with the corner or with the edge.
    ///
    /// `None` for a force on the base, which does not bend the scale.
    pub(super) fn of_contact(beam: &Beam, touching: &TouchingEdge, scale: usize) -> Option<Self> {
        let is_left = touching.ends[0] == scale;
        if is_left == touching.edge.corner_is_left() {
            // The force on the corner has the direction of the normal of the edge, here in the
            // frame of the scale with the corner.
            let sign = if is_left { 1.0 } else { -1.0 };
            let angle = sign * touching.turn.value;
            let direction = contact::Pose::new(0.0, 0.0, angle).turn(touching.normal);
            let section = touching.corner.dot(&beam.along);
            let load = Self::at_point(beam, touching.corner, direction, section);
            return Some(load.along_pair(touching, sign, &touching.turn));
        }
        let along = contact::quarter(touching.normal);
        let slide = touching.slide.value;
        let load = Self::at_point(beam, slide * along, -touching.normal, 0.0);
        let across = load.across[0];
        let (arm, section) = match touching.edge {
            CornerEdge::BottomLeftOnBase => return None,
            // A load on the top acts on the last section, because the scale is rigid beyond it.
            CornerEdge::TopRightOnTop => (along.perp(&-touching.normal), [beam.length, 0.0]),
            // A side is parallel to the axis of the beam, so the force is perpendicular to it.
            _ => {
                let side = along.dot(&beam.along).signum();
                (across * side, [side * slide, side])
            }
        };
        let (moment, across) = ([arm * slide, arm, 0.0], [across, 0.0, 0.0]);
        Some(Self { moment, across, section, ..load }.along_pair(touching, 1.0, &touching.slide))
    }
}

impl Section {
    /// Computes the flexibility between the loads `k` and `l`, with derivatives.
    pub(super) fn flexibility(&self, k: &BeamLoad, l: &BeamLoad) -> Flexibility {
        let [own, other] = [k, l].map(|load| load.section[0].clamp(0.0, self.length));
        let z = own.min(other);
        let [zeroth, first] = l.integrals(0, z);
        let [zeroth_by_other, first_by_other] = l.integrals(1, z);
        // The integral ends at the load nearer to the base, where the moment of this load is zero.
        // So the motion of this upper limit contributes only to the second derivative.
        let moves = own <= other && own > 0.0 && own < self.length;
        let at_limit = if moves {
            k.section[1] * (l.moment[0] - l.across[0] * z) * (k.moment[1] - k.across[1] * z)
        } else {
            0.0
        };
        let bent = Flexibility {
            value: k.moment[0] * zeroth + k.across[0] * first,
            by_first: k.moment[1] * zeroth + k.across[1] * first,
            by_first_twice: k.moment[2] * zeroth + k.across[2] * first + at_limit,
            by_both: k.moment[1] * zeroth_by_other + k.across[1] * first_by_other,
        };
        let overlap = self.overlap(k.section[0], l.section[0]);
        let (a, b, rate) = (k.across, l.across, [k.section[1], l.section[1]]);
        let sheared = Flexibility {
            value: a[0] * b[0] * overlap.value,
            by_first: b[0] * (a[1] * overlap.value + a[0] * rate[0] * overlap.by_first),
            by_first_twice: b[0]
                * (a[2] * overlap.value
                    + 2.0 * a[1] * rate[0] * overlap.by_first
                    + a[0] * rate[0] * rate[0] * overlap.by_first_twice),
            by_both: a[1] * b[1] * overlap.value
                + a[1] * b[0] * rate[1] * overlap.by_second
                + a[0] * b[1] * rate[0] * overlap.by_first
                + a[0] * b[0] * rate[0] * rate[1] * overlap.by_both,
        };
        let (bending, shear) = (self.bending, self.shear_stiffness);
        Flexibility {
            value: bent.value / bending + sheared.value / shear,
            by_first: bent.by_first / bending + sheared.by_first / shear,
            by_first_twice: bent.by_first_twice / bending + sheared.by_first_twice / shear,
            by_both: bent.by_both / bending + sheared.by_both / shear,
        }
    }

    /// Returns the shear force in the section `x` caused by a unit transverse force at `s`.
    fn shear(&self, s: f64, x: f64) -> f64 {
        ((s + self.spread - x) / (2.0 * self.spread)).clamp(0.0, 1.0)
    }

    /// Integrates the product of two unit shear forces over the beam.
    ///
    /// The shear force of a load at `s` falls linearly from 1 at `s − w` to 0 at `s + w`.
    fn overlap(&self, s: f64, t: f64) -> Overlap {
        let (w, length) = (self.spread, self.length);
        let [near, far] = [s.min(t), s.max(t)];
        // Both shear forces are 1 below the first break. One of them is 0 above the last break.
        let breaks = [near - w, (far - w).min(near + w), near + w].map(|x| x.clamp(0.0, length));
        let mut overlap = Overlap { value: breaks[0], ..Overlap::default() };
        for pair in breaks.windows(2) {
            let [low, high] = [pair[0], pair[1]];
            if high <= low {
                continue;
            }
            let middle = f64::midpoint(low, high);
            overlap.value += integral([low, high], |x| self.shear(s, x) * self.shear(t, x));
            let [beside_first, beside_second] = [s, t].map(|at| (middle - at).abs() <= w);
            if beside_first {
                overlap.by_first += integral([low, high], |x| self.shear(t, x)) / (2.0 * w);
            }
            if beside_second {
                overlap.by_second += integral([low, high], |x| self.shear(s, x)) / (2.0 * w);
            }
            if beside_first && beside_second {
                overlap.by_both += (high - low) / (4.0 * w * w);
            }
        }
        for (x, sign) in [(s + w, 1.0), (s - w, -1.0)] {
            if (0.0..=length).contains(&x) {
                overlap.by_first_twice += sign * self.shear(t, x) / (2.0 * w);
            }
        }
        overlap
    }
}

/// Integrates a polynomial of degree 3 or less by the two-point Gauss–Legendre rule.
fn integral([low, high]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (f64::midpoint(low, high), (high - low) / 2.0);
    let offset = half / 3.0_f64.sqrt();
    half * (f(middle - offset) + f(middle + offset))
}

/// Integral of the product of two shear forces, with derivatives.
///
/// Derivatives are with respect to the positions of the first and the second force.
#[derive(Clone, Copy, Debug, Default)]
struct Overlap {
    value: f64,
    by_first: f64,
    by_second: f64,
    by_first_twice: f64,
    by_both: f64,
}

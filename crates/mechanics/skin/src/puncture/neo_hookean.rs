//! Neo-Hookean bars between neighbouring bases, which replace the springs along the row.

use solver::{Residual, Tangent};
use substrate::{SurfaceStrip, neo_hookean};

use super::system::Chain;

/// The bar between two neighbouring scales, minus the linear spring that it replaces.
///
/// The energy of this difference is
///
/// ```text
/// a β_x [ d² w(g) − ½ (x' − x)² ]                                                      (P4b)
/// ```
///
/// with the stretch `g = s/d`. The axial force of the bar acts at the corners of the bases, so it
/// also exerts moments on both scales: `∂s/∂φ = a sin φ`.
pub(super) struct Bar {
    half_base: f64,
    /// Force of the bar minus force of the spring.
    excess: f64,
    /// Total force of the bar.
    tension: f64,
    /// Stiffness of the replaced spring.
    spring: f64,
    /// Stiffness of the bar.
    stiffness: f64,
    /// Rotations of the left and the right scale.
    turns: [Turn; 2],
}

/// Functions of the rotation `φ` of a scale that a bar needs.
#[derive(Clone, Copy)]
struct Turn {
    sin: f64,
    /// `1 − cos φ`, computed without cancellation.
    shortened: f64,
}

impl Turn {
    fn new(rotation: f64) -> Self {
        let (sin, cos) = (0.5 * rotation).sin_cos();
        Self { sin: 2.0 * sin * cos, shortened: 2.0 * sin * sin }
    }
}

/// End of a bar: displacement `x` and rotation of its scale.
type End = (f64, Turn);

fn end([x, _, rotation]: [f64; 3]) -> End {
    (x, Turn::new(rotation))
}

impl Chain {
    /// Returns the surface strip to the right of a scale.
    pub(super) fn strip(&self, scale: usize) -> SurfaceStrip {
        SurfaceStrip { width: self.contacts.arrangement.gap(scale), half_base: self.half_base }
    }

    /// Calls `show` for each bar from the left, with the indices of `x` of its two scales.
    ///
    /// A linear substrate has no bars.
    pub(super) fn for_bars(&self, z: &[f64], mut show: impl FnMut([usize; 2], &Bar)) {
        let Some(spring) = self.bars else { return };
        let mut left = end(self.displacement(z, 0));
        for scale in 1..self.layout.scales() {
            let right = end(self.displacement(z, scale));
            let nodes = [scale - 1, scale].map(|i| self.layout.scale(i));
            show(nodes, &Bar::new(&self.strip(scale - 1), spring, [left, right]));
            left = right;
        }
    }

    /// Computes the energy of the bars minus the energy of the replaced springs.
    pub(super) fn bar_energy(&self, z: &[f64]) -> f64 {
        let Some(spring) = self.bars else { return 0.0 };
        (0..self.layout.scales() - 1)
            .map(|scale| {
                let [left, right] = [scale, scale + 1].map(|i| self.displacement(z, i));
                let strip = self.strip(scale);
                let [energy, ..] = neo_hookean(strip.stretch(left, right));
                spring * (strip.width.powi(2) * energy - 0.5 * (right[0] - left[0]).powi(2))
            })
            .sum()
    }

    /// Computes the largest difference between the force of a bar and of the replaced spring.
    ///
    /// Bar `i` connects scales with `displacements` `i` and `i + 1` across a gap of `widths[i]`.
    /// The difference is divided by the stiffness `a α_x` of a scale, so it is a displacement.
    pub(super) fn largest_excess(&self, displacements: &[[f64; 3]], widths: &[f64]) -> f64 {
        let Some(spring) = self.bars else { return 0.0 };
        displacements
            .windows(2)
            .zip(widths)
            .map(|(pair, &width)| {
                let [near, next] = [pair[0], pair[1]].map(end);
                let strip = SurfaceStrip { width, half_base: self.half_base };
                // Take the larger excess for this elongation and for the opposite one, so that the
                // result does not depend on the sign of the displacements.
                let [one, other] = [[near, next], [next, near]]
                    .map(|ends| Bar::new(&strip, spring, ends).excess.abs());
                one.max(other) / self.direct[0]
            })
            .fold(0.0, f64::max)
    }
}

impl Bar {
    fn new(strip: &SurfaceStrip, spring: f64, [left, right]: [End; 2]) -> Self {
        let apart = right.0 - left.0;
        let shortened = left.1.shortened + right.1.shortened;
        let [_, force, slope] = neo_hookean(strip.stretch_by(apart, shortened));
        let tension = spring * strip.width * force;
        Self {
            half_base: strip.half_base,
            // The linear spring stays in the constant tangent, so a bar adds only the difference.
            excess: tension - spring * apart,
            tension,
            spring,
            stiffness: spring * slope,
            turns: [left.1, right.1],
        }
    }

    /// Adds forces and tangent of the bar.
    ///
    /// `nodes` are the indices of `x` of its left and its right scale.
    pub(super) fn linearise(
        &self,
        nodes: [usize; 2],
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        self.add_force(nodes, residual);
        self.add_stiffness(nodes, matrix);
    }

    fn add_force(&self, [left, right]: [usize; 2], residual: &mut Residual) {
        residual.add(left, -self.excess);
        residual.add(right, self.excess);
        for (at, turn) in [left, right].into_iter().zip(self.turns) {
            // The replaced spring exerts no moment, so the moment of the total force is added.
            residual.add(at + 2, self.tension * self.half_base * turn.sin);
        }
    }

    pub(super) fn add_stiffness(&self, nodes: [usize; 2], matrix: &mut impl Tangent) {
        let along = self.stiffness - self.spring;
        let arms = self.turns.map(|turn| self.half_base * turn.sin);
        // The elongation decreases with x of the left scale and increases with x of the right one.
        let signs = [-1.0, 1.0];
        for (i, row) in nodes.into_iter().enumerate() {
            // `∂²s/∂φ² = a cos φ` (V3).
            let curved = self.tension * self.half_base * (1.0 - self.turns[i].shortened);
            let turned = self.stiffness * arms[i];
            for (j, column) in nodes.into_iter().enumerate() {
                let own = if i == j { curved } else { 0.0 };
                let along_row =
                    [signs[i] * signs[j] * along, 0.0, signs[i] * self.stiffness * arms[j]];
                matrix.add_block(row, column, &[along_row]);
                let by_turn = [signs[j] * turned, 0.0, turned * arms[j] + own];
                matrix.add_block(row + 2, column, &[by_turn]);
            }
        }
    }
}

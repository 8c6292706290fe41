//! Block with friction: history in the mode, and an unsymmetric tangent.

use approx::assert_relative_eq;
use solver::{
    Blocks, Change, Control, Residual, State, System, Tangent, Termination, check_tangent,
};

use crate::{follow_modes, steps};

/// Friction coefficient, and relative normal-force increase with displacement.
const FRICTION: f64 = 0.2;
const WEDGE: f64 = 0.5;

/// Block on a spring of stiffness 1, pushed by `f = 4 D (1 − D)` with friction.
///
/// The friction force obeys `|T| ≤ μ (1 + c u)`.
///
/// Unknowns `u, T, s⁺, s⁻, D`: the block sticks at the anchor `u₀`, its mode, while both slip
/// distances `s` are inactive.
struct Block {
    controls: [Control; 1],
    blocks: Option<Blocks>,
}

fn block(in_blocks: bool) -> Block {
    let blocks = Blocks { starts: vec![0], links: vec![0], root: 0, reach: 1 };
    Block { controls: [Control { index: 4, scale: 1.0 }], blocks: in_blocks.then_some(blocks) }
}

fn limit(u: f64) -> f64 {
    FRICTION * (1.0 + WEDGE * u)
}

impl System for Block {
    type Mode = f64;

    fn size(&self) -> usize {
        5
    }

    fn half_bandwidth(&self) -> usize {
        4
    }

    fn blocks(&self) -> Option<&Blocks> {
        self.blocks.as_ref()
    }

    fn load(&self) -> usize {
        4
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn constraints(&self) -> &[usize] {
        &[2, 3]
    }

    fn monotone(&self) -> &[usize] {
        &[0, 1]
    }

    fn mode_at_rest(&self) -> f64 {
        0.0
    }

    fn residual(&self, State { z, active, mode }: &State<f64>, residual: &mut Residual) {
        residual.clear(&[1.0; 5]);
        let push = 4.0 * z[4] * (1.0 - z[4]);
        for (row, term) in [(0, z[0]), (0, z[1]), (0, -push), (2, z[2]), (2, mode - z[0])] {
            residual.add(row, term);
        }
        for (row, term) in [(3, z[3]), (3, z[0] - mode)] {
            residual.add(row, term);
        }
        match active[..] {
            [true, _] => residual.add(1, z[1] - limit(z[0])),
            [_, true] => residual.add(1, z[1] + limit(z[0])),
            // This sign preserves the determinant where the block begins to slip, so that a
            // reversed path is detected.
            _ => residual.add(1, mode - z[0]),
        }
    }

    fn tangent(&self, State { z, active, .. }: &State<f64>, matrix: &mut impl Tangent) {
        let [by_u, by_friction] = match active[..] {
            [true, _] => [-FRICTION * WEDGE, 1.0],
            [_, true] => [FRICTION * WEDGE, 1.0],
            _ => [-1.0, 0.0],
        };
        let entries = [(0, 0, 1.0), (0, 1, 1.0), (0, 4, 8.0 * z[4] - 4.0)];
        let ways = [(2, 2, 1.0), (2, 0, -1.0), (3, 3, 1.0), (3, 0, 1.0)];
        for (row, column, value) in entries.into_iter().chain(ways) {
            matrix.add(row, column, value);
        }
        matrix.add(1, 0, by_u);
        matrix.add(1, 1, by_friction);
    }

    fn conditions(&self, State { z, .. }: &State<f64>, values: &mut Vec<f64>) {
        *values = vec![limit(z[0]) - z[1], limit(z[0]) + z[1]];
    }

    fn transition(&self, state: &mut State<f64>, change: Change) -> Option<usize> {
        // At the start and at the end of slip, the block is at its anchor.
        state.mode = state.z[0];
        Some(change.constraint)
    }
}

/// Displacement at the reversal, and at the end: `u = (f ∓ μ)/(1 ± μ c)`.
const TURNED: f64 = (1.0 - FRICTION) / (1.0 + FRICTION * WEDGE);
const LEFT: f64 = FRICTION / (1.0 - FRICTION * WEDGE);

#[test]
fn a_block_sticks_slips_sticks_and_slips_back() {
    for (in_blocks, largest) in [(true, 0.2), (false, 0.2), (true, 0.03), (false, 1.0)] {
        let (points, stop) = follow_modes(block(in_blocks), steps(largest));
        assert_eq!(stop, Termination::Reached);
        let changes: Vec<_> = points.iter().filter(|point| point.event.is_some()).collect();
        let [slides, stops, back, _] = &changes[..] else { panic!("{changes:?}") };
        // The block slips from f = μ on, stops at the maximum push, and slips back from f = u₀ − μ
        // (1 + c u₀) on.
        let [slide, slide_back] =
            [FRICTION, TURNED - limit(TURNED)].map(|push| 0.5 - 0.5 * (1.0 - push).sqrt());
        assert_relative_eq!(slides.state.z[4], slide, max_relative = 1e-10);
        assert_relative_eq!(stops.state.z[4], 0.5, max_relative = 1e-7);
        assert_relative_eq!(stops.state.z[0], TURNED, max_relative = 1e-12);
        assert_relative_eq!(back.state.z[4], 1.0 - slide_back, max_relative = 1e-10);
        assert_relative_eq!(points.last().unwrap().state.z[0], LEFT, max_relative = 1e-10);
    }
}

/// The tangent of a slipping block is not symmetric.
#[test]
fn the_tangent_of_a_slipping_block_agrees_with_differences() {
    let (points, _) = follow_modes(block(true), steps(0.05));
    for point in points {
        check_tangent(&block(true), &point.state, 1e-8).unwrap_or_else(|wrong| {
            // Rows of slip distances may differ: the tangent has the slope of the condition if a
            // slip distance is inactive, and its own equation if it is active.
            assert!(wrong.row >= 2, "{wrong}");
        });
    }
}

//! Block with friction: a system with history in its mode and an unsymmetric tangent.

use approx::assert_relative_eq;
use solver::{
    Blocks, Change, Control, Residual, State, System, Tangent, Termination, check_tangent,
};

use crate::{follow_modes, steps};

/// Friction coefficient `μ`.
const FRICTION: f64 = 0.2;
/// Relative increase `c` of the normal force per unit displacement.
const WEDGE: f64 = 0.5;

/// Block with friction on a spring of stiffness 1, under the force `f = 4 D (1 − D)`.
///
/// The friction force satisfies `|T| ≤ μ (1 + c u)`. The unknowns are the displacement `u`, `T`,
/// the slip distances `s⁺` and `s⁻` in both directions, and `D`, which is load and control
/// parameter. While both slip distances are inactive, the block sticks at the anchor `u₀`, which is
/// stored in the mode.
struct Block {
    controls: [Control; 1],
    blocks: Option<Blocks>,
}

/// Creates the block, with or without a block structure of its tangent.
fn block(in_blocks: bool) -> Block {
    let blocks = Blocks { starts: vec![0], links: vec![0], root: 0, reach: 1 };
    Block { controls: [Control { index: 4, scale: 1.0 }], blocks: in_blocks.then_some(blocks) }
}

/// Returns the largest magnitude of the friction force.
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
            // With this sign of the equation, the determinant keeps its sign when the block begins
            // to slip. The solver detects reversed paths by this sign.
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
        let slips = [(2, 2, 1.0), (2, 0, -1.0), (3, 3, 1.0), (3, 0, 1.0)];
        for (row, column, value) in entries.into_iter().chain(slips) {
            matrix.add(row, column, value);
        }
        matrix.add(1, 0, by_u);
        matrix.add(1, 1, by_friction);
    }

    fn conditions(&self, State { z, .. }: &State<f64>, values: &mut Vec<f64>) {
        *values = vec![limit(z[0]) - z[1], limit(z[0]) + z[1]];
    }

    fn transition(&self, state: &mut State<f64>, change: Change) -> Option<usize> {
        // When slip begins or ends, the current position becomes the anchor.
        state.mode = state.z[0];
        Some(change.constraint)
    }
}

/// Displacement `u = (1 − μ)/(1 + μ c)` at the largest force `f = 1`, at which forward slip ends.
const FARTHEST: f64 = (1.0 - FRICTION) / (1.0 + FRICTION * WEDGE);
/// Displacement `u = μ/(1 − μ c)` that remains at the end of the path, at `f = 0`.
const REMAINING: f64 = FRICTION / (1.0 - FRICTION * WEDGE);

#[test]
fn a_block_sticks_slips_sticks_and_slips_back() {
    for (in_blocks, largest) in [(true, 0.2), (false, 0.2), (true, 0.03), (false, 1.0)] {
        let (points, stop) = follow_modes(block(in_blocks), steps(largest));
        assert_eq!(stop, Termination::Reached);
        let changes: Vec<_> = points.iter().filter(|point| point.event.is_some()).collect();
        let [slides, stops, back, _] = &changes[..] else { panic!("{changes:?}") };
        // The block slips from f = μ on, sticks from the maximum f = 1 on, and slips back from
        // f = u₀ − μ (1 + c u₀) on.
        let [slide, slide_back] =
            [FRICTION, FARTHEST - limit(FARTHEST)].map(|push| 0.5 - 0.5 * (1.0 - push).sqrt());
        assert_relative_eq!(slides.state.z[4], slide, max_relative = 1e-10);
        assert_relative_eq!(stops.state.z[4], 0.5, max_relative = 1e-7);
        assert_relative_eq!(stops.state.z[0], FARTHEST, max_relative = 1e-12);
        assert_relative_eq!(back.state.z[4], 1.0 - slide_back, max_relative = 1e-10);
        assert_relative_eq!(points.last().unwrap().state.z[0], REMAINING, max_relative = 1e-10);
    }
}

/// Checks the tangent of the block, which is unsymmetric while the block slips.
#[test]
fn the_tangent_of_a_slipping_block_agrees_with_differences() {
    let (points, _) = follow_modes(block(true), steps(0.05));
    for point in points {
        check_tangent(&block(true), &point.state, 1e-8).unwrap_or_else(|wrong| {
            // Only the rows of slip distances may differ. For an active slip distance the check
            // compares the slope of `conditions` with differences of `residual`, which has another
            // equation in this row.
            assert!(wrong.row >= 2, "{wrong}");
        });
    }
}

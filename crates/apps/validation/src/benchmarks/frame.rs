//! Equilibrium paths of plane frames of co-rotational beams under a single load.

use membrane::{CorotationalBeam, Ends};
use solver::{
    Continuation, Control, Event, Residual, Settings, State, System, Tangent, Termination,
};

/// A node of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameNode {
    /// Position at rest.
    pub(super) position: [f64; 2],
    /// True for each of `u_x`, `u_y` and `φ` that is fixed.
    pub(super) fixed: [bool; 3],
}

impl FrameNode {
    pub(super) fn free(position: [f64; 2]) -> Self {
        Self { position, fixed: [false; 3] }
    }
}

/// The control parameter of a path, with its final value.
#[derive(Clone, Copy, Debug)]
pub(super) enum Drive {
    /// The downward displacement of the loaded node.
    Depth(f64),
    /// The load.
    Load(f64),
}

/// A chain of beams with unit bending stiffness and a vertical dead load on one node.
///
/// The unknowns are the displacements and rotations of the nodes, and the load. In the list of
/// unknowns, the load is placed after the unknowns of the loaded node.
#[derive(Clone, Debug)]
pub(super) struct PlaneFrame {
    nodes: Vec<FrameNode>,
    beams: Vec<CorotationalBeam>,
    loaded: usize,
    controls: [Control; 3],
    units: Vec<f64>,
}

impl PlaneFrame {
    /// Creates a frame of beams with axial stiffness `axial`.
    ///
    /// `None` if a beam has no length.
    pub(super) fn new(
        nodes: Vec<FrameNode>,
        axial: f64,
        loaded: usize,
        drive: Drive,
    ) -> Option<Self> {
        let beams = nodes.windows(2).map(|pair| {
            let [from, to] = [pair[0].position, pair[1].position];
            CorotationalBeam::new((to[0] - from[0]).hypot(to[1] - from[1]), axial, 1.0).ok()
        });
        let beams = beams.collect::<Option<Vec<_>>>()?;
        let stiffest = beams.iter().map(|beam| axial / beam.length()).fold(1.0, f64::max);
        // Residuals are scaled by the stiffest beam, also at fixed nodes.
        let units = vec![stiffest; 3 * nodes.len() + 1];
        let controls = match drive {
            // The negative scale starts the path downwards, because `u_y` points up.
            Drive::Depth(depth) => [(1, -depth), (0, depth), (2, 1.0)],
            Drive::Load(load) => [(3, load), (1, -1.0), (0, 1.0)],
        };
        let controls = controls.map(|(k, scale)| Control { index: 3 * loaded + k, scale });
        Some(Self { nodes, beams, loaded, controls, units })
    }

    fn unknown(&self, node: usize, k: usize) -> usize {
        // The load is placed after the unknowns of its node, which keeps the tangent banded.
        3 * node + k + usize::from(node > self.loaded)
    }

    /// Returns the poses of the ends of a beam, and the indices of their unknowns.
    ///
    /// The rotations of the ends are the direction of the beam at rest plus the unknown rotations.
    fn ends(&self, z: &[f64], beam: usize) -> (Ends, [usize; 6]) {
        let [from, to] = [self.nodes[beam].position, self.nodes[beam + 1].position];
        let direction = (to[1] - from[1]).atan2(to[0] - from[0]);
        let unknowns = std::array::from_fn(|k| self.unknown(beam + k / 3, k % 3));
        let rest = [from[0], from[1], direction, to[0], to[1], direction];
        (Ends::from_fn(|k, _| rest[k] + z[unknowns[k]]), unknowns)
    }

    fn is_fixed(&self, end: usize, beam: usize) -> bool {
        self.nodes[beam + end / 3].fixed[end % 3]
    }

    /// Returns the path to the final value of the control; `None` if the path stops before.
    pub(super) fn path(self, max_step: f64) -> Option<Vec<solver::Equilibrium>> {
        let settings = Settings { first_step: max_step, max_step, ..Settings::default() };
        let rest = State::at_rest(&self);
        let mut path = Continuation::new(self, rest, settings);
        let points: Vec<_> = path.by_ref().collect();
        (path.termination() == Some(Termination::Reached)).then_some(points)
    }

    /// Returns the load at its first extremum along the path; `None` if it has no extremum.
    pub(super) fn limit_load(self, max_step: f64) -> Option<f64> {
        let load = self.load();
        let points = self.path(max_step)?;
        let limit = points.iter().find(|point| point.event == Some(Event::LoadExtremum))?;
        Some(limit.state.z[load])
    }
}

impl System for PlaneFrame {
    type Mode = ();

    fn size(&self) -> usize {
        3 * self.nodes.len() + 1
    }

    fn half_bandwidth(&self) -> usize {
        6
    }

    fn load(&self) -> usize {
        3 * self.loaded + 3
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&self.units);
        for (i, beam) in self.beams.iter().enumerate() {
            let (ends, unknowns) = self.ends(z, i);
            let force = beam.response(&ends).force;
            for (k, &row) in unknowns.iter().enumerate().filter(|(k, _)| !self.is_fixed(*k, i)) {
                residual.add(row, force[k]);
            }
        }
        for (node, FrameNode { fixed, .. }) in self.nodes.iter().enumerate() {
            for k in (0..3).filter(|&k| fixed[k]) {
                let row = self.unknown(node, k);
                residual.add(row, self.units[row] * z[row]);
            }
        }
        residual.add(self.unknown(self.loaded, 1), z[self.load()]);
    }

    fn tangent(&self, State { z, .. }: &State, matrix: &mut impl Tangent) {
        for (i, beam) in self.beams.iter().enumerate() {
            let (ends, unknowns) = self.ends(z, i);
            let tangent = beam.response(&ends).tangent;
            for (k, &row) in unknowns.iter().enumerate().filter(|(k, _)| !self.is_fixed(*k, i)) {
                for (l, &column) in unknowns.iter().enumerate() {
                    matrix.add(row, column, tangent[(k, l)]);
                }
            }
        }
        for (node, FrameNode { fixed, .. }) in self.nodes.iter().enumerate() {
            for k in (0..3).filter(|&k| fixed[k]) {
                let row = self.unknown(node, k);
                matrix.add(row, row, self.units[row]);
            }
        }
        matrix.add(self.unknown(self.loaded, 1), self.load(), 1.0);
    }
}

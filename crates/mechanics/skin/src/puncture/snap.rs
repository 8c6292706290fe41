//! Stability along a path under load or depth control, and snap-through.

use solver::{Bracket, Continuation, Event};

use super::stability::Instability;
use super::system::Chain;
use super::{At, PunctureMeasures, PuncturePoint};
use crate::contacts::SkinPoint;
use crate::record::Skin;

/// Tolerance on the rate of the depth at its maximum, relative to the rates at the segment ends.
const FLAT: f64 = 1e-9;
/// Maximum number of evaluations in the search for a maximum of the depth.
const EVALUATIONS: usize = 60;

/// Halvings of a segment in which to search for an early dip of the depth.
///
/// The dip starts at the first point.
const HALVINGS: i32 = 20;

/// Snap-through under a monotonically descending needle.
///
/// The needle leaves the path at a maximum of the depth, and returns to it where the depth reaches
/// that maximum again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// Equilibrium at the maximum of the depth.
    pub point: PuncturePoint,
    /// `F*` at the maximum of the depth minus `F*` where the path reaches that depth again.
    ///
    /// `None` if the path ends first.
    pub drop: Option<f64>,
    /// Number of contact events before the maximum.
    pub events_before: usize,
}

/// Tracks stability and snaps along a path.
#[derive(Debug, Default)]
pub(super) struct SnapObserver {
    /// True if the load has decreased; before that the row is stable.
    has_unloaded: bool,
    /// Instability at every point that the path has left.
    instability: Vec<Instability>,
    /// Point at which stability under load control is lost.
    pub(super) load_limit: Option<SkinPoint>,
    /// First maximum of the depth.
    pub(super) depth_limit: Option<SkinPoint>,
    snaps: Vec<Snap>,
}

impl SnapObserver {
    /// Processes a path segment.
    ///
    /// On a path from a stable state the load increases as long as the stiffness has an even number
    /// of negative eigenvalues. Before the first decrease of the load there are none, so none are
    /// counted.
    pub(super) fn follow(
        &mut self,
        path: &mut Continuation<Chain>,
        [from, to]: [&SkinPoint; 2],
        events_before: usize,
    ) {
        self.has_unloaded |= to.arriving[path.system().layout.load()] < 0.0;
        self.count(path, from, to);
        self.follow_depth(path, from, to, events_before);
    }

    /// Records the instability of `from`.
    ///
    /// At a singular point it is evaluated half-way to the next.
    fn count(&mut self, path: &mut Continuation<Chain>, from: &SkinPoint, to: &SkinPoint) {
        if !self.has_unloaded {
            return self.instability.push(Instability::default());
        }
        let is_singular = from.event == Some(Event::LoadExtremum);
        let between = if is_singular { path.between(from, to, 0.5) } else { None };
        let instability = self.at(path.system(), between.as_ref().unwrap_or(from));
        self.instability.push(instability);
        if instability.load > 0 {
            self.load_limit.get_or_insert_with(|| from.clone());
        }
    }

    /// Counts the instability of a point; at a singular point repeats the previous one.
    fn at(&self, chain: &Chain, point: &SkinPoint) -> Instability {
        let SkinPoint { state, leaving, .. } = point;
        if chain.is_nonconservative(state) {
            // With friction the stiffness is not symmetric, so instability is only detected by
            // decreasing load or depth.
            let rates = [leaving[chain.layout.load()], chain.depth_slope(&state.z, leaving)];
            let [load, depth] = rates.map(|rate| usize::from(rate < 0.0));
            return Instability { load, depth, tilt: 0 };
        }
        chain
            .instability(state)
            .unwrap_or_else(|| self.instability.last().copied().unwrap_or_default())
    }

    fn follow_depth(
        &mut self,
        path: &mut Continuation<Chain>,
        from: &SkinPoint,
        to: &SkinPoint,
        events_before: usize,
    ) {
        // Before a snap has landed, the needle is off the path and meets no reversal.
        if self.open_snap().is_none()
            && let Some(turned) = turning_point(path, from, to)
        {
            let point = path.system().path_point(&turned);
            self.snaps.push(Snap { point, drop: None, events_before });
            self.depth_limit.get_or_insert(turned);
        }
        // A snap may land on the segment on which it started.
        if let Some(snap) = self.open_snap() {
            snap.land(path, from, to);
        }
    }

    /// Returns the snap that has not returned to the path yet.
    fn open_snap(&mut self) -> Option<&mut Snap> {
        self.snaps.last_mut().filter(|snap| snap.drop.is_none())
    }

    /// Adds the stability measures; returns instabilities of all points and snaps.
    pub(super) fn finish(
        mut self,
        path: &Continuation<Chain>,
        measures: &mut PunctureMeasures,
    ) -> (Vec<Instability>, Vec<Snap>) {
        let end = if self.has_unloaded {
            self.at(path.system(), path.point())
        } else {
            Instability::default()
        };
        self.instability.push(end);
        // After a decrease, an increasing load is inconclusive with friction: two modes may be
        // unstable.
        let is_known = !self.has_unloaded
            || end.load > 0
            || !path.system().is_nonconservative(&path.point().state);
        measures.stable_under_load = is_known.then_some(end.load == 0);
        // After a snap without landing the needle is off the path.
        measures.stable_under_depth = Some(end.depth == 0 && self.open_snap().is_none());
        let limit = self.load_limit.as_ref();
        measures.load_stability_force = limit.map(|point| path.system().force(&point.state));
        measures.depth_stability_force = self.snaps.first().map(|snap| snap.point.force);
        measures.snaps = self.snaps.len();
        (self.instability, self.snaps)
    }
}

impl Snap {
    /// Finds the point within a segment at which the depth reaches its value at the snap again.
    fn land(&mut self, path: &mut Continuation<Chain>, from: &SkinPoint, to: &SkinPoint) {
        let depth = self.point.displacement;
        if path.system().depth(&to.state.z) < depth {
            return;
        }
        let below = if path.system().depth(&from.state.z) < depth {
            Some(from.clone())
        } else {
            // The depth turns back at the first point and recovers before the second.
            (1..HALVINGS).find_map(|k| {
                let point = path.between(from, to, 0.5_f64.powi(k))?;
                (path.system().depth(&point.state.z) < depth).then_some(point)
            })
        };
        let location = At::Displacement(depth).location();
        let landed = below.and_then(|below| location.between(path, &below, to));
        // Ignore a dip lost in round-off.
        let landed = landed.as_ref().unwrap_or(to);
        self.drop = Some(self.point.force - path.system().force(&landed.state));
    }
}

/// Finds the maximum of the depth within a segment or at its start.
fn turning_point(
    path: &mut Continuation<Chain>,
    from: &SkinPoint,
    to: &SkinPoint,
) -> Option<SkinPoint> {
    let leaving = path.system().depth_slope(&from.state.z, &from.leaving);
    let arriving = path.system().depth_slope(&to.state.z, &to.arriving);
    // At a kink the depth decreases right from the point; otherwise the previous segment would have
    // shown it.
    if leaving < 0.0 {
        return Some(from.clone());
    }
    if arriving >= 0.0 {
        return None;
    }
    let mut bracket = Bracket::new((0.0, leaving), (1.0, arriving));
    let mut nearest = from.clone();
    for _ in 0..EVALUATIONS {
        let fraction = bracket.secant();
        nearest = path.between(from, to, fraction)?;
        let slope = path.system().depth_slope(&nearest.state.z, &nearest.arriving);
        if slope.abs() <= FLAT * (leaving - arriving) {
            break;
        }
        bracket.narrow(fraction, slope);
    }
    Some(nearest)
}

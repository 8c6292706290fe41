//! Stability along a path under load control and depth control, and snap-through.

use solver::{Bracket, Continuation, Event};

use super::stability::Instability;
use super::system::Chain;
use super::{At, PunctureMeasures, PuncturePoint};
use crate::contacts::SkinPoint;
use crate::record::Skin;

/// Largest rate of the depth at its maximum, relative to the rates at the ends of the segment.
const FLAT: f64 = 1e-9;

/// Maximum number of evaluations in the search for a maximum of the depth.
const EVALUATIONS: usize = 60;

/// Maximum number of bisections towards the start of a segment to find a decrease of the depth.
///
/// The depth decreases from the first point of the segment and recovers before its end.
const HALVINGS: i32 = 20;

/// Snap-through under a monotonically descending needle.
///
/// The needle leaves the path at a maximum of the depth. It returns to the path where the depth
/// reaches this maximum again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// Equilibrium at the maximum of the depth.
    pub point: PuncturePoint,
    /// `F*` at the maximum of the depth minus `F*` where the path reaches this depth again.
    ///
    /// `None` if the path ends before it reaches this depth again.
    pub drop: Option<f64>,
    /// Number of contact events before the maximum.
    pub events_before: usize,
}

/// Tracks stability and snaps along a path.
#[derive(Debug, Default)]
pub(super) struct SnapObserver {
    /// True if the load has decreased; until then the row is stable.
    has_unloaded: bool,
    /// Instability at every point of the path except the last one.
    instability: Vec<Instability>,
    /// First point that is unstable under load control.
    pub(super) load_limit: Option<SkinPoint>,
    /// First maximum of the depth.
    pub(super) depth_limit: Option<SkinPoint>,
    snaps: Vec<Snap>,
}

impl SnapObserver {
    /// Updates stability and snaps with a path segment.
    ///
    /// `events_before` is the number of contact events before the segment. On a path from a stable
    /// state the load increases while the stiffness has an even number of negative eigenvalues.
    /// Before the first decrease of the load this number is 0, so it is not computed.
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

    /// Records the instability at `from`.
    ///
    /// The stiffness is singular at an extremum of the load, where the instability of the
    /// equilibrium half-way to `to` is recorded instead.
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

    /// Computes the instability at a point, or returns the last one if the stiffness is singular.
    fn at(&self, chain: &Chain, point: &SkinPoint) -> Instability {
        let SkinPoint { state, leaving, .. } = point;
        if chain.is_nonconservative(state) {
            // With friction the stiffness is not symmetric. Only a decreasing load or depth then
            // shows an instability.
            let rates = [leaving[chain.layout.load()], chain.depth_slope(&state.z, leaving)];
            let [load, depth] = rates.map(|rate| usize::from(rate < 0.0));
            return Instability { load, depth, tilt: 0 };
        }
        chain
            .instability(state)
            .unwrap_or_else(|| self.instability.last().copied().unwrap_or_default())
    }

    /// Detects snaps on a segment, and the return of the last snap to the path.
    fn follow_depth(
        &mut self,
        path: &mut Continuation<Chain>,
        from: &SkinPoint,
        to: &SkinPoint,
        events_before: usize,
    ) {
        // Until the last snap returns to the path, the needle is off the path. Ignore further
        // maxima of the depth.
        if self.open_snap().is_none()
            && let Some(turned) = turning_point(path, from, to)
        {
            let point = path.system().path_point(&turned);
            self.snaps.push(Snap { point, drop: None, events_before });
            self.depth_limit.get_or_insert(turned);
        }
        // A snap may return to the path on the segment on which it started.
        if let Some(snap) = self.open_snap() {
            snap.land(path, from, to);
        }
    }

    /// Returns the last snap if it has not returned to the path yet.
    fn open_snap(&mut self) -> Option<&mut Snap> {
        self.snaps.last_mut().filter(|snap| snap.drop.is_none())
    }

    /// Adds the stability measures; returns the instability at all points, and the snaps.
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
        // With friction, a load that increases again after a decrease does not prove stability:
        // two modes may be unstable.
        let is_known = !self.has_unloaded
            || end.load > 0
            || !path.system().is_nonconservative(&path.point().state);
        measures.stable_under_load = is_known.then_some(end.load == 0);
        // If the last snap has not returned to the path, the needle never reaches the end of the
        // path.
        measures.stable_under_depth = Some(end.depth == 0 && self.open_snap().is_none());
        let limit = self.load_limit.as_ref();
        measures.load_stability_force = limit.map(|point| path.system().force(&point.state));
        measures.depth_stability_force = self.snaps.first().map(|snap| snap.point.force);
        measures.snaps = self.snaps.len();
        (self.instability, self.snaps)
    }
}

impl Snap {
    /// Finds the point of a segment at which the depth reaches its value at the snap again.
    ///
    /// Sets the drop of the force if there is such a point.
    fn land(&mut self, path: &mut Continuation<Chain>, from: &SkinPoint, to: &SkinPoint) {
        let depth = self.point.displacement;
        if path.system().depth(&to.state.z) < depth {
            return;
        }
        let below = if path.system().depth(&from.state.z) < depth {
            Some(from.clone())
        } else {
            // The depth decreases from the first point and recovers before the second point.
            (1..HALVINGS).find_map(|k| {
                let point = path.between(from, to, 0.5_f64.powi(k))?;
                (path.system().depth(&point.state.z) < depth).then_some(point)
            })
        };
        let location = At::Displacement(depth).location();
        let landed = below.and_then(|below| location.between(path, &below, to));
        // Without a detectable decrease of the depth, use the end of the segment.
        let landed = landed.as_ref().unwrap_or(to);
        self.drop = Some(self.point.force - path.system().force(&landed.state));
    }
}

/// Finds the maximum of the depth within a segment or at its start; `None` without a maximum.
fn turning_point(
    path: &mut Continuation<Chain>,
    from: &SkinPoint,
    to: &SkinPoint,
) -> Option<SkinPoint> {
    let leaving = path.system().depth_slope(&from.state.z, &from.leaving);
    let arriving = path.system().depth_slope(&to.state.z, &to.arriving);
    // At a kink the depth decreases from the first point on. A smooth maximum at this point would
    // have been found on the previous segment.
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

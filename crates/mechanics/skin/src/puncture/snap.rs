//! How far along a path a needle can follow it, and where the row snaps.

use solver::{Bracket, Event, Path};

use super::stability::Instability;
use super::system::Chain;
use super::{At, PunctureMeasures, PuncturePoint};
use crate::contacts::SkinPoint;
use crate::record::Skin;

/// The largest depth is found where the rate of the depth is this part of that at the ends, or after so many equilibria.
const FLAT: f64 = 1e-9;
const EVALUATIONS: usize = 60;

/// A dip of the depth that begins at a point is looked for in this many halves of halves of the way to the next.
const HALVINGS: i32 = 20;

/// A snap: where the depth turns back, a needle that only goes deeper leaves the path, and comes to it again where the depth is as
/// large once more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// The equilibrium at which the depth turns back.
    pub point: PuncturePoint,
    /// `F*` there less `F*` where the depth is as large again; `None` if the path ends before.
    pub drop: Option<f64>,
    /// Contact events before it.
    pub events_before: usize,
}

/// Follows along a path how far a needle can follow it.
#[derive(Debug, Default)]
pub(super) struct SnapObserver {
    /// Whether the load has turned back: before that a row is stable.
    has_unloaded: bool,
    /// Of every point that the path has left.
    instability: Vec<Instability>,
    /// Where stability under the load ends.
    pub(super) load_limit: Option<SkinPoint>,
    /// Where the depth first turns back.
    pub(super) depth_limit: Option<SkinPoint>,
    snaps: Vec<Snap>,
}

impl SnapObserver {
    /// Follows the path from one point to the next.
    ///
    /// On a path that leaves a stable state the load rises as long as the stiffness has an even number of negative eigenvalues. So
    /// there are none before the load first turns, and nothing is counted.
    pub(super) fn follow(
        &mut self,
        path: &mut Path<Chain>,
        [from, to]: [&SkinPoint; 2],
        events_before: usize,
    ) {
        self.has_unloaded |= to.arriving[path.system().layout.load()] < 0.0;
        self.count(path, from, to);
        self.follow_depth(path, from, to, events_before);
    }

    /// At an extremum of the load the stiffness is singular, and what holds behind it is found half-way to the next point.
    fn count(&mut self, path: &mut Path<Chain>, from: &SkinPoint, to: &SkinPoint) {
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

    /// The instability of a point; that of the last one where its stiffness is singular.
    fn at(&self, chain: &Chain, point: &SkinPoint) -> Instability {
        let SkinPoint { state, leaving, .. } = point;
        if chain.is_nonconservative(state) {
            // What rubs has no symmetric stiffness: that something gives way shows where load or depth fall, and nowhere else.
            let falls = |rate: f64| usize::from(rate < 0.0);
            let [load, depth] =
                [leaving[chain.layout.load()], chain.depth_slope(&state.z, leaving)];
            return Instability { load: falls(load), depth: falls(depth), tilt: 0 };
        }
        let last = || self.instability.last().copied().unwrap_or_default();
        chain.instability(state).unwrap_or_else(last)
    }

    fn follow_depth(
        &mut self,
        path: &mut Path<Chain>,
        from: &SkinPoint,
        to: &SkinPoint,
        events_before: usize,
    ) {
        // Until a snap has landed the needle is not on this part of the path, and meets no turn of it.
        if self.open_snap().is_none()
            && let Some(turned) = turning_point(path, from, to)
        {
            let point = path.system().path_point(&turned);
            self.snaps.push(Snap { point, drop: None, events_before });
            self.depth_limit.get_or_insert(turned);
        }
        // A snap may land on the segment on which it began.
        if let Some(snap) = self.open_snap() {
            snap.land(path, from, to);
        }
    }

    /// The snap that has not come to the path again.
    fn open_snap(&mut self) -> Option<&mut Snap> {
        self.snaps.last_mut().filter(|snap| snap.drop.is_none())
    }

    /// Adds to the measures how far the path is stable. Returns the instability of every point of the path, and the snaps.
    pub(super) fn finish(
        mut self,
        path: &Path<Chain>,
        measures: &mut PunctureMeasures,
    ) -> (Vec<Instability>, Vec<Snap>) {
        let end = if self.has_unloaded {
            self.at(path.system(), path.point())
        } else {
            Instability::default()
        };
        self.instability.push(end);
        // Behind a fall of the load a load that rises says nothing where the needle rubs: two motions may give way.
        let is_known = !self.has_unloaded
            || end.load > 0
            || !path.system().is_nonconservative(&path.point().state);
        measures.stable_under_load = is_known.then_some(end.load == 0);
        // A snap that has not landed leaves the needle off the path.
        measures.stable_under_depth = Some(end.depth == 0 && self.open_snap().is_none());
        let limit = self.load_limit.as_ref();
        measures.load_stability_force = limit.map(|point| path.system().force(&point.state));
        measures.depth_stability_force = self.snaps.first().map(|snap| snap.point.force);
        measures.snaps = self.snaps.len();
        (self.instability, self.snaps)
    }
}

impl Snap {
    /// Finds where between two points the depth is as large as at the snap again, if it is.
    fn land(&mut self, path: &mut Path<Chain>, from: &SkinPoint, to: &SkinPoint) {
        let depth = self.point.displacement;
        let is_below =
            |path: &Path<Chain>, point: &SkinPoint| path.system().depth(&point.state.z) < depth;
        if is_below(path, to) {
            return;
        }
        let below = if is_below(path, from) {
            Some(from.clone())
        } else {
            // The depth turns back at the first point and is as large again before the second.
            (1..HALVINGS).find_map(|k| {
                let point = path.between(from, to, 0.5_f64.powi(k))?;
                is_below(path, &point).then_some(point)
            })
        };
        let location = At::Displacement(depth).location();
        let landed = below.and_then(|below| location.between(path, &below, to));
        // A dip that is lost in round-off is none.
        let landed = landed.as_ref().unwrap_or(to);
        self.drop = Some(self.point.force - path.system().force(&landed.state));
    }
}

/// Where the depth turns back between two points, or at the first of them.
fn turning_point(path: &mut Path<Chain>, from: &SkinPoint, to: &SkinPoint) -> Option<SkinPoint> {
    let rate = |path: &Path<Chain>, point: &SkinPoint, direction: &[f64]| {
        path.system().depth_slope(&point.state.z, direction)
    };
    let leaving = rate(path, from, &from.leaving);
    let arriving = rate(path, to, &to.arriving);
    // At a kink the depth falls from the point itself on: elsewhere the step before would have shown it.
    if leaving < 0.0 {
        return Some(from.clone());
    }
    if arriving >= 0.0 {
        return None;
    }
    let mut bracket = Bracket::new((0.0, leaving), (1.0, arriving));
    let mut nearest = from.clone();
    for _ in 0..EVALUATIONS {
        let place = bracket.secant();
        nearest = path.between(from, to, place)?;
        let slope = rate(path, &nearest, &nearest.arriving);
        if slope.abs() <= FLAT * (leaving - arriving) {
            break;
        }
        bracket.narrow(place, slope);
    }
    Some(nearest)
}

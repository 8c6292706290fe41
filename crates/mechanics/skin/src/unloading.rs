//! Unloading of a row or a strip to zero load.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use solver::{Continuation, Settings, Termination};

use crate::contacts::SkinPoint;
use crate::path_location::{PathLocation, PointLocator};
use crate::record::{Skin, Work};
use crate::sensitivity::{Curve, CurvePoint, curve_point};

/// The unloading path from the end of a loading path.
#[derive(Clone, Debug)]
pub struct Unloading<P> {
    /// Equilibria of the path, starting with the end of the loading path.
    pub path: Vec<P>,
    /// Reason why the path stopped: [`Termination::Unloaded`] at zero load.
    pub stop: Termination,
    /// Work of the load that is not recovered, i.e. the area of the load loop.
    ///
    /// It is over `E* t³`, or for a whole strip over `E_m t³`, and is dissipated by friction or
    /// remains stored.
    pub loop_work: Option<f64>,
}

/// Residual state after unloading; `None` if the unloading path is incomplete.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Remains {
    /// Area of the load loop.
    pub loop_work: Option<f64>,
    /// Residual displacement `u*` of the loaded point, or residual curvature `κ*`.
    pub displacement: Option<f64>,
}

impl<P> Unloading<P> {
    /// Reverses a path at its current point, after the dissipation `work`.
    pub(crate) fn follow<S: Skin<PathPoint = P>>(
        path: &mut Continuation<S>,
        mut work: Work,
    ) -> Self {
        if path.point().state.z[path.system().load()] == 0.0 {
            // A needle that is through at rest carries no load.
            let point = Self::noted(path.system(), path.point(), &work);
            let loop_work = path.system().repeats() * work.total();
            return Self {
                path: vec![point],
                stop: Termination::Unloaded,
                loop_work: Some(loop_work),
            };
        }
        path.turn_back();
        // The first point repeats the end of the loading path, with the unloading stiffness.
        let mut points = vec![Self::noted(path.system(), path.point(), &work)];
        loop {
            let from: Arc<SkinPoint> = path.point_shared();
            let Some(to) = path.next() else { break };
            work.add(path, &from, &to);
            points.push(Self::noted(path.system(), &to, &work));
        }
        let stop = path.termination().unwrap_or(Termination::Reached);
        let (skin, end) = (path.system(), path.point());
        // At a nonzero load the loop is not closed, and its area is meaningless.
        let loop_work = (stop == Termination::Unloaded).then(|| {
            // The stored energy covers the whole strip, the dissipation only the solved gaps.
            skin.stored(&end.state) + skin.repeats() * work.total()
        });
        Self { path: points, stop, loop_work }
    }

    fn noted<S: Skin<PathPoint = P>>(skin: &S, point: &SkinPoint, work: &Work) -> P {
        let mut here = skin.path_point(point);
        work.note(skin, &mut here);
        here
    }

    /// Evaluates the residual state, with `displacement` read from a recorded point.
    pub(crate) fn remains(&self, displacement: impl Fn(&P) -> f64) -> Remains {
        let end = self.path.last().filter(|_| self.stop == Termination::Unloaded);
        Remains { loop_work: self.loop_work, displacement: end.map(displacement) }
    }
}

/// Evaluates a curve at `locations` on the unloading path from `turn`, without derivatives.
///
/// Points that unloading does not reach are `None`.
pub(crate) fn unloaded<S: Skin + Clone>(
    path: &mut Continuation<S>,
    turn: Option<SkinPoint>,
    locations: impl Iterator<Item = PathLocation<S>>,
    settings: &Settings,
    curve: Curve<S>,
) -> Vec<Option<CurvePoint>> {
    let Some(turn) = turn else { return locations.map(|_| None).collect() };
    path.continue_with(path.system().clone(), turn);
    path.turn_back();
    let mut locator = PointLocator::new(path, locations);
    loop {
        let from = path.point_shared();
        let Some(to) = path.next() else { break };
        locator.follow(path, &from, &to);
    }
    let system = path.system();
    let points = locator.points.iter();
    points.map(|point| Some(curve_point(system, point.as_ref()?, &[], settings, curve))).collect()
}

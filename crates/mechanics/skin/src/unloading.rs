//! Unloading of a row or a strip to zero load.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use solver::{Continuation, Settings, Termination};

use crate::contacts::SkinPoint;
use crate::path_location::{PathLocation, PointLocator};
use crate::record::{Skin, Work};
use crate::sensitivity::{Curve, CurvePoint, curve_point};

/// The path from the end of a loading path back to zero load.
#[derive(Clone, Debug)]
pub struct Unloading<P> {
    /// Equilibria of the path, starting with the end of the loading path.
    pub path: Vec<P>,
    /// Reason why the path stopped: [`Termination::Unloaded`] at zero load.
    pub stop: Termination,
    /// Work of the load that unloading does not return, i.e. the area of the load loop.
    ///
    /// This work is dissipated by friction or remains stored. Its unit is `E* t³` for a row and
    /// `E_m t³` for a whole strip. `None` if the load does not return to zero.
    pub loop_work: Option<f64>,
}

/// Residual state after unloading; all values are `None` if the unloading path is incomplete.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Remains {
    /// Area of the load loop, in the unit of [`Unloading::loop_work`].
    pub loop_work: Option<f64>,
    /// Residual displacement `u*` of the loaded point, or residual curvature `κ*`.
    pub displacement: Option<f64>,
}

impl<P> Unloading<P> {
    /// Follows the unloading path from the current point of `path`.
    ///
    /// `work` is the dissipation on the loading path.
    pub(crate) fn follow<S: Skin<PathPoint = P>>(
        path: &mut Continuation<S>,
        mut work: Work,
    ) -> Self {
        if path.point().state.z[path.system().load()] == 0.0 {
            // A needle that fits between two scales reaches the soft surface at rest, without a
            // load.
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
        // If the path stops at a nonzero load, the loop is not closed and has no area.
        let loop_work = (stop == Termination::Unloaded).then(|| {
            // `stored` is the energy of the whole strip, `work` the dissipation of the solved gaps
            // only.
            skin.stored(&end.state) + skin.repeats() * work.total()
        });
        Self { path: points, stop, loop_work }
    }

    fn noted<S: Skin<PathPoint = P>>(skin: &S, point: &SkinPoint, work: &Work) -> P {
        let mut here = skin.path_point(point);
        work.note(skin, &mut here);
        here
    }

    /// Returns the residual state; `displacement` reads the displacement of a recorded point.
    pub(crate) fn remains(&self, displacement: impl Fn(&P) -> f64) -> Remains {
        let end = self.path.last().filter(|_| self.stop == Termination::Unloaded);
        Remains { loop_work: self.loop_work, displacement: end.map(displacement) }
    }
}

/// Follows the unloading path from the equilibrium `turn`, and evaluates a curve at `locations`.
///
/// The result has one entry for each location, without derivatives with respect to parameters. An
/// entry is `None` if the unloading path does not reach its location, or if `turn` is `None`.
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

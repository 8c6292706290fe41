//! The way back of a row that was punctured, or of a strip that was bent: the load falls to zero.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use solver::{Path, Stop};

use crate::contacts::SkinPoint;
use crate::record::{Skin, Work};

/// The way back from the end of a path.
#[derive(Clone, Debug)]
pub struct Unloading<P> {
    /// Its equilibria, from the end of the path on.
    pub path: Vec<P>,
    /// Why it ended: [`Stop::Unloaded`] where the load came to zero.
    pub stop: Stop,
    /// Work of the load that is not given back, over `E* t³` or, of a whole strip, over `E_m t³`: the area of the loop. Friction has taken
    /// it, or it is stored in what does not come back.
    pub loop_work: Option<f64>,
}

/// What is left of a puncture or a bending once the load is gone; `None` where the way back does not come to its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Remains {
    /// The area of the loop of the load.
    pub loop_work: Option<f64>,
    /// What remains of the displacement `u*` of the punctured point, or of the curvature `κ*`.
    pub displacement: Option<f64>,
}

impl<P> Unloading<P> {
    /// Turns a path back where it stands, after friction has taken `work`.
    pub(crate) fn follow<S: Skin<PathPoint = P>>(path: &mut Path<S>, mut work: Work) -> Self {
        path.turn_back();
        // The end of the path stands here once more: on the way back it has another stiffness.
        let mut points = vec![Self::noted(path.system(), path.point(), &work)];
        loop {
            let from: Arc<SkinPoint> = path.point_shared();
            let Some(to) = path.next() else { break };
            work.add(path, &from, &to);
            points.push(Self::noted(path.system(), &to, &work));
        }
        let stop = path.stop().unwrap_or(Stop::Reached);
        let (skin, end) = (path.system(), path.point());
        // The stored energy is that of the whole strip, the work that of the gaps solved for.
        let loop_work = || skin.stored(&end.state) + skin.repeats() * work.taken();
        // Short of no load the loop is not closed, and its area says nothing.
        Self { path: points, stop, loop_work: (stop == Stop::Unloaded).then(loop_work) }
    }

    fn noted<S: Skin<PathPoint = P>>(skin: &S, point: &SkinPoint, work: &Work) -> P {
        let mut here = skin.path_point(point);
        work.note(skin, &mut here);
        here
    }

    /// What is left, the displacement of a point of the path being known by this function.
    pub(crate) fn remains(&self, displacement: impl Fn(&P) -> f64) -> Remains {
        let end = self.path.last().filter(|_| self.stop == Stop::Unloaded);
        Remains { loop_work: self.loop_work, displacement: end.map(displacement) }
    }
}

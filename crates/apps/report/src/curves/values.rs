//! Values of the curves of a design.

use skin::flexure::FlexurePoint;
use skin::puncture::{Puncture, PuncturePoint, Weakest};

use super::{DesignCurves, FailureLimit};

/// Limits across the row are shown up to this multiple of the largest force of the path.
const HIGHEST_LEVEL: f64 = 1.5;

/// Points of the curve of a design, and of the marks on this curve.
#[derive(Default)]
pub(super) struct CurveValues {
    pub points: Vec<[f64; 2]>,
    /// The unloading path, from the end of `points`.
    pub unloading: Vec<[f64; 2]>,
    /// Contact events.
    pub crosses: Vec<[f64; 2]>,
    /// The first fold of the surface, or the point with the smallest force.
    pub rings: Vec<[f64; 2]>,
    /// Point at which a guided needle first touches a corner or another scale; may be empty.
    pub passing: Vec<[f64; 2]>,
    /// For each point, true if the segment after it is dotted.
    ///
    /// Dotted segments are unstable under a held depth, or skip points without a force.
    pub unstable: Vec<bool>,
    /// Limits of failure, each with its point.
    pub limits: Vec<(FailureLimit, [f64; 2])>,
}

impl CurveValues {
    /// Returns all points that the axes must cover.
    pub fn all(&self) -> impl Iterator<Item = &[f64; 2]> {
        self.points.iter().chain(&self.unloading).chain(self.limits.iter().map(|(_, at)| at))
    }

    /// Returns true if the segment after point `k` is dotted.
    pub fn is_unstable(&self, k: usize) -> bool {
        self.unstable.get(k) == Some(&true)
    }

    /// Multiplies the coordinates of all points by the factors `x` and `y`.
    pub fn in_units(&mut self, [x, y]: [f64; 2]) {
        let Self { points, unloading, crosses, rings, passing, limits, .. } = self;
        let all = [points, unloading, crosses, rings, passing].into_iter().flatten();
        for point in all.chain(limits.iter_mut().map(|(_, at)| at)) {
            *point = [point[0] * x, point[1] * y];
        }
    }
}

/// Returns the curve of force against displacement; `None` if the puncture was not solved.
pub(super) fn puncture(solved: &DesignCurves) -> Option<CurveValues> {
    let puncture = solved.puncture?;
    let unloading = puncture.unloading.iter().flat_map(|unloading| &unloading.path);
    let crosses = puncture.events.iter().map(|event| force_point(&event.point));
    // A needle with a prescribed depth also follows parts of the path that are unstable under a
    // dead load, so these parts are not dotted.
    let unstable = puncture.instability.iter().map(|instability| instability.depth > 0);
    let fold = puncture.folds.first().map(|fold| force_point(&fold.point));
    let passage = &puncture.measures.passage;
    let passing = passage.passing_displacement.zip(passage.passing_force);
    // A path that stopped early may end before the needle passes.
    let passing = passing.map(<[f64; 2]>::from).filter(|[displacement, _]| {
        puncture.path.iter().any(|point| point.displacement >= *displacement)
    });
    Some(CurveValues {
        points: puncture.path.iter().map(force_point).collect(),
        unloading: unloading.map(force_point).collect(),
        crosses: crosses.collect(),
        rings: fold.into_iter().collect(),
        passing: passing.into_iter().collect(),
        unstable: unstable.collect(),
        limits: shown_limits(solved, puncture),
    })
}

fn force_point(point: &PuncturePoint) -> [f64; 2] {
    [point.displacement, point.force]
}

/// Returns the limits of failure to draw, each with its point.
///
/// Omits limits across the row above [`HIGHEST_LEVEL`] times the largest force of the path.
fn shown_limits(solved: &DesignCurves, puncture: &Puncture) -> Vec<(FailureLimit, [f64; 2])> {
    let highest = puncture.path.iter().map(|point| point.force).fold(0.0, f64::max);
    let limits = solved
        .limits
        .iter()
        .filter(|limit| limit.displacement.is_some() || limit.force <= HIGHEST_LEVEL * highest);
    limits.map(|limit| (*limit, [limit.displacement.unwrap_or_default(), limit.force])).collect()
}

/// Returns the curve of critical force against load position.
pub(super) fn load_positions(solved: &DesignCurves) -> Option<CurveValues> {
    let all = &solved.puncture?.places;
    let weakest = Weakest::from_positions(all).ok().and_then(|of| Some([of.position?, of.force?]));
    let forces: Vec<_> = all.iter().map(|p| (p.position, p.force)).collect();
    Some(with_missing_forces(&forces, weakest)).filter(|curve| !curve.points.is_empty())
}

/// Returns the curve of critical force against the curvature of the body.
pub(super) fn bodies(solved: &DesignCurves) -> Option<CurveValues> {
    let forces = solved.on_bodies;
    let known = forces.iter().filter_map(|(curvature, force)| Some([*curvature, (*force)?]));
    let worst = known.reduce(|a, b| if b[1] < a[1] { b } else { a });
    Some(with_missing_forces(forces, worst)).filter(|curve| curve.points.len() > 1)
}

/// Returns the curve through the known `forces`, with a ring at the point `ring`.
///
/// A segment is dotted if a force between its ends is unknown.
fn with_missing_forces(forces: &[(f64, Option<f64>)], ring: Option<[f64; 2]>) -> CurveValues {
    let points: Vec<_> = forces.iter().filter_map(|(x, force)| Some([*x, (*force)?])).collect();
    let between = points.windows(2).map(|ends| ends[0][0]..ends[1][0]);
    let unstable = between
        .map(|range| forces.iter().any(|(x, force)| force.is_none() && range.contains(x)))
        .collect();
    CurveValues { points, rings: ring.into_iter().collect(), unstable, ..CurveValues::default() }
}

fn moment_point(point: &FlexurePoint) -> [f64; 2] {
    [point.curvature, point.moment]
}

/// Returns the curve of moment against curvature; `None` if bending was not solved.
pub(super) fn flexure(solved: &DesignCurves) -> Option<CurveValues> {
    let flexure = solved.flexure?;
    let unloading = flexure.unloading.iter().flat_map(|unloading| &unloading.path);
    let crosses = flexure.events.iter().map(|event| moment_point(&event.point));
    Some(CurveValues {
        points: flexure.path.iter().map(moment_point).collect(),
        unloading: unloading.map(moment_point).collect(),
        crosses: crosses.collect(),
        ..CurveValues::default()
    })
}

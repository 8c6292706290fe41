//! Observers that record and locate points while the path of a puncture is followed.

use solver::Continuation;

use super::adaptive_row::{AdaptiveRowPath, Segment};
use super::failure::FailureObserver;
use super::needle::{HistoryObserver, PassageObserver};
use super::snap::SnapObserver;
use super::surface_fold::FoldObserver;
use super::system::Chain;
use super::{At, PunctureParameters};
use crate::path_location::PointLocator;
use crate::record::{PathFunction, Record};

/// All observers of the path of a puncture.
pub(super) struct PathObservers {
    pub(super) record: Record<Chain>,
    /// Stability and snaps.
    pub(super) snaps: SnapObserver,
    pub(super) folds: FoldObserver,
    /// First failure; `None` unless failure is requested.
    pub(super) failure: Option<FailureObserver>,
    pub(super) history: HistoryObserver,
    pub(super) passage: PassageObserver,
    /// Points at the tilts at which measures are reported.
    pub(super) tilts: PointLocator<Chain>,
    /// Point at the depth at which the force is reported, if requested.
    pub(super) depth: PointLocator<Chain>,
    /// Point at the force at which the pressure on the tissue is reported, if requested.
    pub(super) force: PointLocator<Chain>,
    /// Points requested by the caller, for snapshots and curves.
    pub(super) requested: PointLocator<Chain>,
}

impl PathObservers {
    pub(super) fn new(
        path: &Continuation<Chain>,
        parameters: &PunctureParameters,
        functions: &[PathFunction<Chain>],
        requested: &[At],
    ) -> Self {
        let tilts = parameters.tilts_deg().map(|tilt| At::Tilt(tilt).location());
        let depth = parameters.depth.map(|depth| At::Displacement(depth).location());
        let force = parameters.force.map(|force| At::Force(force).location());
        Self {
            record: Record::new(path, functions),
            snaps: SnapObserver::default(),
            folds: FoldObserver::default(),
            failure: FailureObserver::new(path, parameters),
            history: HistoryObserver::default(),
            passage: PassageObserver::default(),
            tilts: PointLocator::new(path, tilts),
            depth: PointLocator::new(path, depth),
            force: PointLocator::new(path, force),
            requested: PointLocator::new(path, requested.iter().map(|at| at.location())),
        }
    }

    /// Passes a segment to all observers.
    pub(super) fn follow(&mut self, path: &mut Continuation<Chain>, segment: &Segment) {
        let Segment { from, to, unextended } = segment;
        self.history.follow(segment);
        self.passage.follow(path.system(), segment);
        // Count the events now, because the record adds the events of this segment below.
        let events_before = self.record.events.len();
        if !path.system().is_critical_only() {
            self.snaps.follow(path, [from, to], events_before);
        }
        self.tilts.follow(path, from, to);
        self.depth.follow(path, from, to);
        self.force.follow(path, from, to);
        self.requested.follow(path, from, to);
        let is_unfolded = self.folds.first.is_none();
        // A fold is a failure, so failures need the folds.
        if path.system().measures_folds() || self.failure.is_some() {
            self.folds.follow(path, [from, to], events_before);
        }
        if let Some(failure) = &mut self.failure {
            failure.follow(path, segment, self.folds.first.as_ref().filter(|_| is_unfolded));
        }
        self.record.visit(path, unextended, to);
    }

    /// Converts all recorded points to the unknowns of the final row.
    pub(super) fn lengthen(&mut self, path: &AdaptiveRowPath) {
        // This function must list every observer that stores points. Otherwise the points of an
        // observer would keep the unknowns of a shorter row.
        let SnapObserver { load_limit, depth_limit, .. } = &mut self.snaps;
        let single = [load_limit, depth_limit, &mut self.folds.first, &mut self.record.touching];
        let located = [&mut self.tilts, &mut self.depth, &mut self.force, &mut self.requested];
        let located = located.into_iter().flat_map(|located| &mut located.points);
        let points = single.into_iter().chain(located).flatten();
        let segments = self.history.segments.iter_mut().chain(&mut self.passage.passed);
        for point in points.chain(segments.flatten()) {
            *point = path.lengthened(point);
        }
        if let Some(failure) = &mut self.failure {
            failure.replace_points(|point| path.lengthened(point));
        }
        self.record.replace_points(|point| path.lengthened(point));
    }
}

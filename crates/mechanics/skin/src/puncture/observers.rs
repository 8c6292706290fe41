//! All that is looked for along the path of a puncture.

use solver::Path;

use super::adaptive_row::{AdaptiveRowPath, Segment};
use super::needle::{HistoryObserver, PassageObserver};
use super::snap::SnapObserver;
use super::surface_fold::FoldObserver;
use super::system::Chain;
use super::{At, PunctureParameters};
use crate::contacts::SkinPoint;
use crate::path_location::PointLocator;
use crate::record::{PathFunction, Record};

/// All that is looked for along the path of a puncture.
pub(super) struct PathObservers {
    pub(super) record: Record<Chain>,
    pub(super) needle: SnapObserver,
    pub(super) folds: FoldObserver,
    pub(super) history: HistoryObserver,
    pub(super) passage: PassageObserver,
    pub(super) tilts: PointLocator<Chain>,
    /// The depth at which the force is measured besides, if there is one.
    pub(super) depth: PointLocator<Chain>,
    /// Of snapshots.
    pub(super) requested: PointLocator<Chain>,
}

impl PathObservers {
    pub(super) fn new(
        path: &Path<Chain>,
        parameters: &PunctureParameters,
        functions: &[PathFunction<Chain>],
        places: &[At],
    ) -> Self {
        let tilts = parameters.tilts_deg().map(|tilt| At::Tilt(tilt).location());
        let depth = parameters.depth.map(|depth| At::Displacement(depth).location());
        Self {
            record: Record::new(path, functions),
            needle: SnapObserver::default(),
            folds: FoldObserver::default(),
            history: HistoryObserver::default(),
            passage: PassageObserver::default(),
            tilts: PointLocator::new(path, tilts),
            depth: PointLocator::new(path, depth),
            requested: PointLocator::new(path, places.iter().map(|place| place.location())),
        }
    }

    /// Follows the path over a segment.
    pub(super) fn follow(&mut self, path: &mut Path<Chain>, segment: &Segment) {
        let Segment { from, to, left } = segment;
        self.history.follow(segment);
        self.passage.follow(path.system(), segment);
        // The record is told of the segment last, so that its events so far are those before.
        let events_before = self.record.events.len();
        self.needle.follow(path, [from, to], events_before);
        self.tilts.follow(path, from, to);
        self.depth.follow(path, from, to);
        self.requested.follow(path, from, to);
        self.folds.follow(path, [from, to], events_before);
        self.record.visit(path, left, to);
    }

    /// Takes the points that were kept to the row as it is in the end.
    pub(super) fn lengthen(&mut self, path: &AdaptiveRowPath) {
        let longer = |point: &SkinPoint| path.lengthened(point);
        // Whatever keeps points has to be named here, or keeps some of a shorter row.
        let SnapObserver { load_limit, depth_limit, .. } = &mut self.needle;
        let single = [load_limit, depth_limit, &mut self.folds.first, &mut self.record.touching];
        let located = [&mut self.tilts, &mut self.depth, &mut self.requested];
        let located = located.into_iter().flat_map(|located| &mut located.points);
        let points = single.into_iter().chain(located).flatten();
        let segments = self.history.segments.iter_mut().chain(&mut self.passage.passed);
        for point in points.chain(segments.flatten()) {
            *point = longer(point);
        }
        self.record.replace_points(longer);
    }
}

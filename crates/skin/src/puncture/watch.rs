//! All that is looked for along the path of a puncture.

use solver::Path;

use super::NumberList;
use super::fold::FoldWatch;
use super::snap::Needle;
use super::system::Chain;
use super::tilts::TiltWatch;
use crate::contacts::SkinPoint;
use crate::record::{PathFunction, Record};

/// All that is looked for along the path of a puncture.
pub(super) struct PathWatch {
    pub(super) record: Record<Chain>,
    pub(super) needle: Needle,
    pub(super) folds: FoldWatch,
    pub(super) tilts: TiltWatch,
}

impl PathWatch {
    pub(super) fn new(
        path: &Path<Chain>,
        tilts: NumberList,
        functions: &[PathFunction<Chain>],
    ) -> Self {
        Self {
            record: Record::new(path, functions),
            needle: Needle::default(),
            folds: FoldWatch::default(),
            tilts: TiltWatch::new(tilts),
        }
    }

    /// Follows the path from one point to the next.
    pub(super) fn follow(&mut self, path: &mut Path<Chain>, from: &SkinPoint, to: &SkinPoint) {
        let events_before = self.record.events.len();
        self.needle.follow(path, [from, to], events_before);
        self.tilts.follow(path, from, to);
        self.folds.follow(path, [from, to], events_before);
        self.record.visit(path, to);
    }

    /// Makes points of a longer row of those that are kept; the path goes on from the `last`.
    pub(super) fn replace_points(
        &mut self,
        longer: impl Fn(&SkinPoint) -> SkinPoint,
        last: &SkinPoint,
    ) {
        self.needle.replace_points(&longer);
        self.folds.first = self.folds.first.as_ref().map(&longer);
        self.record.replace_points(longer, last);
    }
}

//! Index of a journal: offsets of the lines of its designs.

use std::collections::BTreeMap;
use std::num::NonZeroU64;
use std::ops::Range;

/// Number of designs for which one page holds offsets.
// A page has 4 kB. Few designs far apart cost one page each, a full grid eight bytes per design.
const PAGE: u64 = 512;

/// Offset of the valid line of each design in a journal.
///
/// If a design has several lines, the line with the largest rerun number is valid, regardless of
/// its position in the file. Pages without designs are not allocated.
#[derive(Clone, Debug, Default)]
pub(crate) struct Index {
    /// Pages of offsets by page number. No design has the offset 0, where the header is.
    pages: BTreeMap<u64, Vec<Option<NonZeroU64>>>,
    done: u64,
    /// Offsets of all lines of designs with several lines, by position and rerun number.
    reruns: BTreeMap<(u64, u64), u64>,
}

/// Offsets of two lines of one design; the second replaces the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Replaced {
    /// Offset of the earlier line.
    pub old: u64,
    /// Offset of the later line.
    pub new: u64,
}

impl Index {
    /// Adds the line of result number `rerun` of the design at `position`.
    pub fn insert(&mut self, position: u64, rerun: u64, offset: u64) {
        match self.offset(position) {
            None => self.done += 1,
            // The second line of a design also adds its first line to `reruns`. Most designs have
            // one line and need no entry in `reruns`.
            Some(known) if self.lines(position).next().is_none() => {
                self.reruns.insert((position, 0), known);
            }
            Some(_) => {}
        }
        if rerun > 0 || self.offset(position).is_some() {
            // If a line occurs twice, the first offset is kept.
            self.reruns.entry((position, rerun)).or_insert(offset);
        }
        let newest = self.lines(position).last().unwrap_or(offset);
        let page = self.pages.entry(position / PAGE).or_insert_with(|| vec![None; PAGE as usize]);
        page[(position % PAGE) as usize] = NonZeroU64::new(newest);
    }

    /// Returns the offsets of all lines of a design with several lines, in the order of reruns.
    fn lines(&self, position: u64) -> impl DoubleEndedIterator<Item = u64> {
        self.reruns.range((position, 0)..=(position, u64::MAX)).map(|(_, offset)| *offset)
    }

    /// Returns the offset of the valid line of the design at `position`.
    pub fn offset(&self, position: u64) -> Option<u64> {
        let page = self.pages.get(&(position / PAGE))?;
        page[(position % PAGE) as usize].map(NonZeroU64::get)
    }

    /// Returns the position of each finished design with the offset of its valid line.
    pub fn valid_lines(&self) -> impl Iterator<Item = (u64, u64)> {
        self.pages.iter().flat_map(|(page, slots)| {
            let positions = page * PAGE..;
            positions
                .zip(slots)
                .filter_map(|(position, slot)| Some((position, slot.as_ref()?.get())))
        })
    }

    /// Returns the offsets of all lines of the design at `position`, in the order of reruns.
    pub fn history(&self, position: u64) -> Vec<u64> {
        let lines: Vec<_> = self.lines(position).collect();
        if lines.is_empty() { self.offset(position).into_iter().collect() } else { lines }
    }

    /// Returns each replaced line with its replacement, ordered by design and rerun.
    pub fn replaced(&self) -> Vec<Replaced> {
        let lines = self.reruns.iter();
        let pairs = lines.clone().zip(lines.skip(1));
        let same = pairs.filter(|((old, _), (new, _))| old.0 == new.0);
        same.map(|((_, old), (_, new))| Replaced { old: *old, new: *new }).collect()
    }

    /// Returns the number of finished designs.
    pub fn done(&self) -> u64 {
        self.done
    }

    /// Returns the ranges of positions below `count` without a finished design.
    pub fn missing(&self, count: u64) -> Vec<Range<u64>> {
        let mut missing = Vec::new();
        let mut next = 0;
        for (position, _) in self.valid_lines() {
            missing.extend((next < position).then_some(next..position));
            next = position + 1;
        }
        missing.extend((next < count).then_some(next..count));
        missing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_and_replaced_designs_are_listed() {
        let mut index = Index::default();
        assert_eq!(index.missing(3), vec![0..3; 1]);
        for (position, rerun, offset) in [(4, 0, 10), (1, 0, 20), (2, 0, 30), (1, 1, 40)] {
            index.insert(position, rerun, offset);
        }
        assert_eq!(index.missing(7), [0..1, 3..4, 5..7]);
        assert_eq!(index.missing(5), [0..1, 3..4]);
        assert_eq!(index.valid_lines().collect::<Vec<_>>(), [(1, 40), (2, 30), (4, 10)]);
        assert_eq!(index.done(), 3);
        assert_eq!(index.replaced(), [Replaced { old: 20, new: 40 }]);
        assert_eq!((index.history(1), index.history(2)), (vec![20, 40], vec![30]));
    }

    #[test]
    fn designs_that_are_far_apart_need_few_pages() {
        let mut index = Index::default();
        for position in [999_999_999, 3, 500_000_000] {
            index.insert(position, 0, position + 1);
        }
        let missing = [0..3, 4..500_000_000, 500_000_001..999_999_999];
        assert_eq!(index.missing(1_000_000_000), missing);
        assert_eq!((index.done(), index.pages.len()), (3, 3));
        assert_eq!(index.offset(500_000_000), Some(500_000_001));
    }

    #[test]
    fn the_latest_rerun_is_valid_in_any_order_of_lines() {
        let lines = [(0, 10), (1, 20), (2, 30)];
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let mut index = Index::default();
            // Each line occurs twice, at two offsets.
            for (rerun, offset) in order.into_iter().map(|line| lines[line]) {
                index.insert(5, rerun, offset);
                index.insert(5, rerun, offset + 100);
            }
            assert_eq!((index.offset(5), index.done()), (Some(30), 1), "{order:?}");
            assert_eq!(index.history(5), [10, 20, 30]);
            let pairs = [Replaced { old: 10, new: 20 }, Replaced { old: 20, new: 30 }];
            assert_eq!(index.replaced(), pairs);
        }
    }
}

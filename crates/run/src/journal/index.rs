//! Where the lines of the designs stand.

use std::num::NonZeroU64;
use std::ops::Range;

/// For each design the offset of its last line: eight bytes per design, up to the last that is done.
#[derive(Clone, Debug, Default)]
pub(crate) struct Index {
    /// By position. The first line is no design, so none has offset 0.
    offsets: Vec<Option<NonZeroU64>>,
    done: u64,
    replaced: Vec<Replaced>,
}

/// A line that replaces an earlier one of the same design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Replaced {
    /// Position of the design.
    pub position: u64,
    /// Offset of the earlier line.
    pub old: u64,
    /// Offset of the line.
    pub new: u64,
}

impl Index {
    /// Notes the line of the design at `position`.
    pub fn insert(&mut self, position: u64, offset: u64) {
        // Designs that fit into memory have positions that fit into a machine word.
        let Ok(place) = usize::try_from(position) else { return };
        if place >= self.offsets.len() {
            self.offsets.resize(place + 1, None);
        }
        match self.offsets[place].replace(NonZeroU64::new(offset).unwrap_or(NonZeroU64::MIN)) {
            Some(old) => self.replaced.push(Replaced { position, old: old.get(), new: offset }),
            None => self.done += 1,
        }
    }

    /// Where the line of the design at `position` stands.
    pub fn offset(&self, position: u64) -> Option<u64> {
        let slot = self.offsets.get(usize::try_from(position).ok()?)?;
        slot.map(NonZeroU64::get)
    }

    /// Where the lines of all designs stand, in the order of the designs.
    pub fn offsets(&self) -> impl Iterator<Item = u64> {
        self.offsets.iter().flatten().map(|offset| offset.get())
    }

    /// Lines that replace an earlier one, in the order of the designs and then of the lines.
    pub fn replaced(&self) -> Vec<Replaced> {
        let mut replaced = self.replaced.clone();
        replaced.sort_unstable();
        replaced
    }

    /// How many designs are done.
    pub fn done(&self) -> u64 {
        self.done
    }

    /// The positions below `count` that are not done.
    pub fn missing(&self, count: u64) -> Vec<Range<u64>> {
        let mut missing = Vec::new();
        let mut next = 0;
        for (position, slot) in (0..).zip(&self.offsets) {
            if slot.is_some() {
                missing.push(next..position);
                next = position + 1;
            }
        }
        missing.push(next..count);
        missing.retain(|range| !range.is_empty());
        missing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_and_what_is_replaced() {
        let mut index = Index::default();
        assert_eq!(index.missing(3), vec![0..3; 1]);
        for (position, offset) in [(4, 10), (1, 20), (2, 30), (1, 40)] {
            index.insert(position, offset);
        }
        assert_eq!(index.missing(7), [0..1, 3..4, 5..7]);
        assert_eq!(index.missing(5), [0..1, 3..4]);
        assert_eq!(index.offsets().collect::<Vec<_>>(), [40, 30, 10]);
        let replaced = vec![Replaced { position: 1, old: 20, new: 40 }];
        assert_eq!((index.done(), index.replaced()), (3, replaced));
    }
}

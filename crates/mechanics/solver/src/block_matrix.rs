//! Matrices of small blocks, each coupled with the next block or with several next blocks.
#![expect(
    clippy::inline_always,
    reason = "the compiler then folds constant indices; additions take a twentieth of a sweep"
)]

use crate::tangent::Tangent;

/// Number of unknowns in a link, the part of a block to which outer blocks are coupled.
pub const LINK: usize = 3;

/// Largest number of inner neighbours to which a block may be coupled.
pub const FARTHEST_LINK: usize = 8;

/// Position of an unknown that is left out of the matrix.
const LEFT_OUT: usize = usize::MAX;

/// Partition of the unknowns of a system into a chain of blocks.
///
/// ```text
/// block 0 ── block 1 ── … ── root ── … ── last block
/// ```
///
/// Unknowns are coupled within their block and with neighbouring blocks. The *inner* one of two
/// neighbours is nearer to the root, the *outer* one farther from it. The *link* of a block
/// consists of [`LINK`] successive unknowns. Unknowns of an outer block may be coupled only with
/// the link of an inner block, not with the other unknowns of the inner block.
///
/// If a block is coupled with more than its next inner neighbour (`reach` above 1), the root must
/// be the last block. Otherwise blocks on both sides of the root would be coupled.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Blocks {
    /// First unknown of each block, in ascending order, from 0.
    pub starts: Vec<usize>,
    /// First unknown of the link of each block.
    pub links: Vec<usize>,
    /// Number of the root block, which is eliminated last.
    pub root: usize,
    /// Number of inner neighbours to which a block is coupled, 1 to [`FARTHEST_LINK`].
    pub reach: usize,
}

/// Block matrix that omits the rows and columns of some unknowns.
///
/// The rows and columns in arguments of methods are numbers of unknowns. The *position* of an
/// unknown is its index among the unknowns that are not left out. The values of a block of `n` such
/// unknowns are contiguous: first its `n × n` entries `D`, then the entries `C` of its rows in the
/// columns of the inner links (three for each link), then the entries `Bᵀ` of its columns in the
/// rows of the inner links.
#[derive(Clone, Debug, Default)]
pub struct BlockMatrix {
    /// Number of the root block.
    pub(crate) root: usize,
    /// Number of inner neighbours of a block for which entries are stored.
    pub(crate) reach: usize,
    /// First position of each block, followed by the number of positions.
    pub(crate) starts: Vec<usize>,
    /// First position of each link.
    pub(crate) links: Vec<usize>,
    /// Unknown at each position.
    pub(crate) kept: Vec<usize>,
    /// Block of the unknown at each position.
    blocks: Vec<usize>,
    /// Position of each unknown, or [`LEFT_OUT`].
    pub(crate) positions: Vec<usize>,
    /// Index in `values` of the first value of each block.
    pub(crate) at: Vec<usize>,
    /// For each position, the offset in `values` of its row for entries within its block.
    ///
    /// The index of a value is this offset plus the position of the column.
    within: Vec<usize>,
    /// For each position, the offset in `values` of its row for columns of inner links.
    ///
    /// The index of a value is this offset plus the entry of `in_links` for the column.
    coupling: Vec<usize>,
    /// For each position, its index among the unknowns of all links, or [`LEFT_OUT`] outside links.
    in_links: Vec<usize>,
    /// Values of all blocks.
    pub(crate) values: Vec<f64>,
}

/// Part of the matrix to which an entry belongs.
enum Part {
    /// Row and column belong to the same block.
    Within,
    /// The row belongs to the outer block, the column to the link of the inner block.
    Columns,
    /// The column belongs to the outer block, the row to the link of the inner block.
    Rows,
}

/// Parts `D`, `C` and `Bᵀ` of a block of `N` unknowns with `W` unknowns in its inner links.
pub(crate) type PartsMut<'a, const N: usize, const W: usize> =
    (&'a mut [[f64; N]; N], &'a mut [[f64; W]; N], &'a mut [[f64; W]; N]);

impl BlockMatrix {
    /// Sets the shape to `blocks` and all entries to 0.
    ///
    /// `left_out` is true for each unknown that is left out.
    pub fn reshape(&mut self, blocks: &Blocks, left_out: &[bool]) {
        self.root = blocks.root;
        // Only two values are used, because the elimination is compiled for each of them.
        self.reach = if blocks.reach > 1 { FARTHEST_LINK } else { 1 };
        debug_assert!(blocks.reach <= FARTHEST_LINK);
        debug_assert!(blocks.reach <= 1 || blocks.root + 1 == blocks.starts.len());
        let lists = [&mut self.kept, &mut self.blocks, &mut self.starts, &mut self.positions];
        lists.into_iter().for_each(Vec::clear);
        let size = left_out.len();
        self.positions.resize(size, LEFT_OUT);
        let ends = blocks.starts.iter().skip(1).chain([&size]);
        for (block, (&start, &end)) in blocks.starts.iter().zip(ends).enumerate() {
            self.starts.push(self.kept.len());
            for unknown in (start..end).filter(|&unknown| !left_out[unknown]) {
                self.positions[unknown] = self.kept.len();
                self.kept.push(unknown);
                self.blocks.push(block);
            }
        }
        self.starts.push(self.kept.len());
        self.links.clear();
        self.links.extend(blocks.links.iter().map(|&link| self.positions[link]));
        self.lay_out();
    }

    /// Assigns storage to all blocks and sets all values to 0.
    fn lay_out(&mut self) {
        let lists = [&mut self.at, &mut self.within, &mut self.coupling, &mut self.in_links];
        lists.into_iter().for_each(Vec::clear);
        let (mut stored, width) = (0, self.width());
        for block in 0..self.starts.len() - 1 {
            let (start, size) = (self.starts[block], self.starts[block + 1] - self.starts[block]);
            // The root has no inner neighbour, so its link offset is never used.
            let inner = if block < self.root { block + 1 } else { block.saturating_sub(1) };
            let link = LINK * inner;
            self.at.push(stored);
            for row in 0..size {
                // The offset may wrap below zero; adding the position of the column wraps back.
                self.within.push((stored + size * row).wrapping_sub(start));
                let coupled = stored + size * size + width * row;
                self.coupling.push(coupled.wrapping_sub(link));
                let in_link = (start + row).wrapping_sub(self.links[block]);
                self.in_links.push(if in_link < LINK { LINK * block + in_link } else { LEFT_OUT });
            }
            stored += size * (size + 2 * width);
        }
        self.values.clear();
        self.values.resize(stored, 0.0);
    }

    /// Returns the number of columns of `C`.
    fn width(&self) -> usize {
        LINK * self.reach
    }

    /// Returns the number of unknowns of a block that are not left out.
    pub(crate) fn size_of(&self, block: usize) -> usize {
        self.starts[block + 1] - self.starts[block]
    }

    /// Returns the number of values of `C`, which precede `Bᵀ`, in the block of a position.
    fn behind(&self, position: usize) -> usize {
        self.width() * self.size_of(self.blocks[position])
    }

    /// Returns the values of `D`, row by row, and the rows of `C` and `Bᵀ` of a block.
    #[inline(always)]
    pub(crate) fn parts<const W: usize>(&self, block: usize) -> (&[f64], [&[[f64; W]]; 2]) {
        let size = self.size_of(block);
        let values = &self.values[self.at[block]..][..size * (size + 2 * W)];
        let (d, coupling) = values.split_at(size * size);
        (d, coupling.as_chunks().0.split_at(size).into())
    }

    /// Returns mutable references to `D`, `C` and `Bᵀ` of a block of `N` unknowns.
    #[inline(always)]
    pub(crate) fn parts_mut<const N: usize, const W: usize>(
        &mut self,
        block: usize,
    ) -> Option<PartsMut<'_, N, W>> {
        let values = &mut self.values[self.at[block]..][..N * (N + 2 * W)];
        let (d, coupling) = values.split_at_mut(N * N);
        let (c, b) = coupling.as_chunks_mut().0.split_at_mut(N);
        Some((d.as_chunks_mut().0.try_into().ok()?, c.try_into().ok()?, b.try_into().ok()?))
    }

    /// Returns the number of blocks.
    pub fn blocks(&self) -> usize {
        self.at.len()
    }

    /// Returns an entry, or zero if the entry lies outside the blocks or is left out.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        let (row, column) = (self.positions[row], self.positions[column]);
        if row == LEFT_OUT || column == LEFT_OUT || !self.is_coupled(row, column) {
            return 0.0;
        }
        self.values[self.index(row, column)]
    }

    /// Returns true if the matrix stores the entry at the positions `row` and `column`.
    fn is_coupled(&self, row: usize, column: usize) -> bool {
        self.blocks[row] == self.blocks[column]
            || self.is_linked(row, column)
            || self.is_linked(column, row)
    }

    /// Returns true if the block of position `outer` is coupled with the position `inner`.
    ///
    /// `inner` must belong to the link of an inner neighbour that is at most `reach` blocks away.
    fn is_linked(&self, outer: usize, inner: usize) -> bool {
        let (from, to) = (self.blocks[outer], self.blocks[inner]);
        let is_inward = if from < to { to <= self.root } else { to >= self.root };
        is_inward && from.abs_diff(to) <= self.reach && self.in_links[inner] != LEFT_OUT
    }

    /// Returns the part to which the entry at the positions `row` and `column` belongs.
    #[inline(always)]
    fn part(&self, row: usize, column: usize) -> Part {
        debug_assert!(
            self.is_coupled(row, column),
            "entry ({row}, {column}) lies outside the blocks"
        );
        let (in_row, in_column) = (self.blocks[row], self.blocks[column]);
        if in_row == in_column {
            Part::Within
        } else if (in_row < in_column) == (in_row.max(in_column) <= self.root) {
            Part::Columns
        } else {
            Part::Rows
        }
    }

    /// Returns the index in `values` of the entry at the positions `row` and `column`.
    #[inline(always)]
    fn index(&self, row: usize, column: usize) -> usize {
        match self.part(row, column) {
            Part::Within => self.within[row].wrapping_add(column),
            Part::Columns => self.coupling[row].wrapping_add(self.in_links[column]),
            Part::Rows => {
                self.coupling[column].wrapping_add(self.behind(column) + self.in_links[row])
            }
        }
    }
}

impl Tangent for BlockMatrix {
    /// Adds `value` to an entry, unless its row or column is left out.
    fn add(&mut self, row: usize, column: usize, value: f64) {
        let (row, column) = (self.positions[row], self.positions[column]);
        if row != LEFT_OUT && column != LEFT_OUT {
            let index = self.index(row, column);
            self.values[index] += value;
        }
    }

    /// Adds `values` to successive entries of a row from `column` on, unless the row is left out.
    ///
    /// The columns must be successive unknowns of one block, and none of them may be left out.
    #[inline(always)]
    fn add_row(&mut self, row: usize, column: usize, values: impl ExactSizeIterator<Item = f64>) {
        let (row, column) = (self.positions[row], self.positions[column]);
        if row == LEFT_OUT || values.len() == 0 {
            return;
        }
        let (first, step) = match self.part(row, column) {
            Part::Within => (self.within[row].wrapping_add(column), 1),
            Part::Columns => (self.coupling[row].wrapping_add(self.in_links[column]), 1),
            Part::Rows => {
                let first = self.behind(column) + self.in_links[row];
                (self.coupling[column].wrapping_add(first), self.width())
            }
        };
        let entries = self.values[first..].iter_mut().step_by(step);
        entries.zip(values).for_each(|(entry, value)| *entry += value);
    }

    /// Adds `values` along the diagonal that starts at (`row`, `column`).
    ///
    /// The rows must be successive unknowns of one block, and none of them may be left out. The
    /// same applies to the columns.
    #[inline(always)]
    fn add_diagonal(&mut self, row: usize, column: usize, values: &[f64]) {
        let (row, column) = (self.positions[row], self.positions[column]);
        let first = self.index(row, column);
        let width = match values.len() {
            0 | 1 => 0,
            _ => self.index(row + 1, column + 1) - first,
        };
        for (k, value) in values.iter().enumerate() {
            self.values[first + width * k] += value;
        }
    }

    /// Adds a block of `values` with its first entry at (`row`, `column`).
    ///
    /// The rows must be successive unknowns of one block, and none of them may be left out. The
    /// same applies to the columns.
    #[inline(always)]
    fn add_block<const R: usize, const C: usize>(
        &mut self,
        row: usize,
        column: usize,
        values: &[[f64; C]; R],
    ) {
        let (row, column) = (self.positions[row], self.positions[column]);
        let (starts, first) = match self.part(row, column) {
            Part::Within => (&self.within[row..row + R], column),
            Part::Columns => (&self.coupling[row..row + R], self.in_links[column]),
            Part::Rows => {
                let first = self.behind(column) + self.in_links[row];
                for (j, start) in self.coupling[column..column + C].iter().enumerate() {
                    let start = start.wrapping_add(first);
                    for (entry, values) in self.values[start..start + R].iter_mut().zip(values) {
                        *entry += values[j];
                    }
                }
                return;
            }
        };
        for (start, values) in starts.iter().zip(values) {
            let start = start.wrapping_add(first);
            for (entry, value) in self.values[start..start + C].iter_mut().zip(values) {
                *entry += value;
            }
        }
    }
}

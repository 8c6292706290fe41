//! Block-tridiagonal matrices with small blocks, optionally of larger reach.
#![expect(
    clippy::inline_always,
    reason = "callers know the indices within a block, and adding takes a twentieth of a sweep"
)]

use crate::tangent::Tangent;

/// Number of unknowns of a block with which its outer neighbours are coupled.
pub const LINK: usize = 3;

/// Largest number of inner neighbours with which a block may be coupled.
pub const FARTHEST_LINK: usize = 8;

/// Marks the position of an unknown that is left out.
const LEFT_OUT: usize = usize::MAX;

/// Partition of the unknowns of a system into a chain of blocks.
///
/// ```text
/// block 0 ── block 1 ── … ── root ── … ── last block
/// ```
///
/// Unknowns are coupled within their block and with neighbouring blocks. Of two neighbours, the one
/// nearer to the root is the *inner* one, the other the *outer* one. All unknowns of the outer
/// block may be coupled with the *link* of the inner one, which is [`LINK`] successive unknowns,
/// and with no other unknown of it. If blocks are coupled beyond their next neighbour, the coupling
/// also crosses the root, so the root must then be the last block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Blocks {
    /// First unknown of each block, in ascending order, from 0.
    pub starts: Vec<usize>,
    /// First unknown of the link of each block.
    pub links: Vec<usize>,
    /// Number of the block at which elimination from both ends meets.
    pub root: usize,
    /// Number of inner neighbours coupled with a block: 1 to [`FARTHEST_LINK`].
    pub reach: usize,
}

/// Block matrix without the rows and columns of some unknowns.
///
/// Methods take unknowns as indices of rows and columns. The *position* of an unknown is its index
/// among the kept ones. A block of `n` kept unknowns stores its `n × n` entries `D`, then the
/// entries `C` of its rows in the columns of the inner links (three for each link), then the
/// entries `Bᵀ` of its columns in the rows of these links. They are contiguous and in the order of
/// elimination.
#[derive(Clone, Debug, Default)]
pub struct BlockMatrix {
    /// Number of the root block.
    pub(crate) root: usize,
    /// Number of inner neighbours for which storage exists.
    pub(crate) reach: usize,
    /// Position of the first kept unknown of each block, then the number of positions.
    pub(crate) starts: Vec<usize>,
    /// Position of the first unknown of each link.
    pub(crate) links: Vec<usize>,
    /// Unknown at each position; `blocks` holds the block of each unknown.
    pub(crate) kept: Vec<usize>,
    blocks: Vec<usize>,
    /// Position of each unknown.
    pub(crate) positions: Vec<usize>,
    /// Index of the first value of each block.
    pub(crate) at: Vec<usize>,
    /// Offset of each row within its block, by position of the row.
    ///
    /// Offset plus position of the column is the index of a value. `coupling` is the same for the
    /// inner links, with the number of the column among all link unknowns instead of its position.
    within: Vec<usize>,
    coupling: Vec<usize>,
    /// Number of each unknown among all link unknowns, or [`LEFT_OUT`]; by position.
    in_links: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

/// Part of the matrix that holds an entry.
enum Part {
    Within,
    /// The row belongs to the outer block, the column to the link of the inner block.
    Columns,
    /// The column belongs to the outer block, the row to the link of the inner block.
    Rows,
}

/// `D`, `C` and `Bᵀ` of a block of `N` unknowns with `W` inner-link unknowns.
pub(crate) type PartsMut<'a, const N: usize, const W: usize> =
    (&'a mut [[f64; N]; N], &'a mut [[f64; W]; N], &'a mut [[f64; W]; N]);

impl BlockMatrix {
    /// Sets the shape to `blocks` without `left_out` unknowns, and all entries to 0.
    pub fn reshape(&mut self, blocks: &Blocks, left_out: &[bool]) {
        self.root = blocks.root;
        // Use one of two widths, so that elimination knows it as a constant.
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
                // The offset may wrap below zero; adding the column compensates.
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

    /// Returns the number of columns of the inner links.
    fn width(&self) -> usize {
        LINK * self.reach
    }

    /// Returns the number of kept unknowns of a block.
    pub(crate) fn size_of(&self, block: usize) -> usize {
        self.starts[block + 1] - self.starts[block]
    }

    /// Returns the distance of `Bᵀ` from `C` in the storage of the block at a position.
    fn behind(&self, position: usize) -> usize {
        self.width() * self.size_of(self.blocks[position])
    }

    /// Returns `D`, row by row, and the rows of `C` and `Bᵀ` of a block.
    #[inline(always)]
    pub(crate) fn parts<const W: usize>(&self, block: usize) -> (&[f64], [&[[f64; W]]; 2]) {
        let size = self.size_of(block);
        let values = &self.values[self.at[block]..][..size * (size + 2 * W)];
        let (d, coupling) = values.split_at(size * size);
        (d, coupling.as_chunks().0.split_at(size).into())
    }

    /// Returns the mutable parts of a block of `N` unknowns.
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

    /// Returns an entry, or zero if it lies outside the blocks or is left out.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        let (row, column) = (self.positions[row], self.positions[column]);
        if row == LEFT_OUT || column == LEFT_OUT || !self.is_coupled(row, column) {
            return 0.0;
        }
        self.values[self.index(row, column)]
    }

    /// Returns true if the unknowns at two positions may be coupled.
    fn is_coupled(&self, row: usize, column: usize) -> bool {
        self.blocks[row] == self.blocks[column]
            || self.is_linked(row, column)
            || self.is_linked(column, row)
    }

    /// Returns true if `inner` is in the link of an inner neighbour of `outer`'s block.
    fn is_linked(&self, outer: usize, inner: usize) -> bool {
        let (from, to) = (self.blocks[outer], self.blocks[inner]);
        let is_inward = if from < to { to <= self.root } else { to >= self.root };
        is_inward && from.abs_diff(to) <= self.reach && self.in_links[inner] != LEFT_OUT
    }

    /// Returns the part that holds an entry, given by positions.
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

    /// Returns the index of an entry among the values, given by positions.
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

    /// Adds `values` down the diagonal that starts at (`row`, `column`).
    ///
    /// The unknowns must be kept and follow each other within their blocks.
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
    /// The unknowns of these rows, and of these columns, must be kept and follow each other within
    /// a block.
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

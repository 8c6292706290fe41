//! Block-tridiagonal matrices of small blocks.
#![expect(
    clippy::inline_always,
    reason = "places within a block are known where it is added, and a twentieth of a sweep is spent there"
)]

use crate::tangent::Tangent;

/// Unknowns of a block that its outer neighbours are coupled with.
pub const LINK: usize = 3;

/// Inner neighbours that a block may be coupled with at most.
pub const FARTHEST_LINK: usize = 8;

/// Place of an unknown that is not solved for.
const LEFT_OUT: usize = usize::MAX;

/// How the unknowns of a system fall into a chain of blocks.
///
/// ```text
/// block 0 ── block 1 ── … ── root ── … ── last block
/// ```
///
/// Unknowns are coupled within their block and with the neighbouring blocks. Of two neighbours the one
/// nearer to the root is the *inner* one, the other the *outer* one. All unknowns of the outer block may be coupled with
/// the *link* of the inner one, which is [`LINK`] unknowns in succession, and with no other unknown of it. Where blocks reach farther
/// than to the next one, they do so across the root too, so the root is then the last block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Blocks {
    /// First unknown of each block, in ascending order, from 0.
    pub starts: Vec<usize>,
    /// First unknown of the link of each block.
    pub links: Vec<usize>,
    /// Number of the block at which elimination from both ends meets.
    pub root: usize,
    /// How many inner neighbours a block is coupled with: 1, or up to [`FARTHEST_LINK`].
    pub reach: usize,
}

/// A matrix that is block-tridiagonal, or reaches farther, of which the rows and columns of some unknowns are left out.
///
/// Rows and columns are named by the numbers of their unknowns. A block of `n` unknowns that are kept stores its own `n × n` entries
/// `D`, then the entries `C` of its rows in the columns of the inner links, three of each, and then those of its columns in the rows of
/// these links, `Bᵀ`: together, and in the order in which they are eliminated.
#[derive(Clone, Debug, Default)]
pub struct BlockMatrix {
    /// Number of the root block.
    pub(crate) root: usize,
    /// Inner neighbours that there is room for.
    pub(crate) reach: usize,
    /// Place of the first unknown of each block among those that are kept, and the number of places.
    pub(crate) starts: Vec<usize>,
    /// Place of the first unknown of each link.
    pub(crate) links: Vec<usize>,
    /// The unknown at each place, and its block.
    pub(crate) kept: Vec<usize>,
    blocks: Vec<usize>,
    /// The place of each unknown.
    pub(crate) places: Vec<usize>,
    /// The first of the values of each block.
    pub(crate) at: Vec<usize>,
    /// Where, by places, an entry of a row within its block stands, and one that couples with an inner link: behind these by the
    /// place of the column, or by the number of the unknown of the link among those of all links.
    within: Vec<usize>,
    coupling: Vec<usize>,
    /// By places, the number of an unknown among those of all links; no number beside the links.
    in_links: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

/// The part of the matrix in which an entry stands.
enum Part {
    Within,
    /// The row belongs to the outer block, the column to the link of the inner one.
    Columns,
    /// The other way round.
    Rows,
}

/// `D`, `C` and the rows of `Bᵀ` of a block of `N` unknowns that is coupled with `W` unknowns of inner links.
pub(crate) type PartsMut<'a, const N: usize, const W: usize> =
    (&'a mut [[f64; N]; N], &'a mut [[f64; W]; N], &'a mut [[f64; W]; N]);

impl BlockMatrix {
    /// Gives the matrix a shape: that of `blocks`, without the unknowns that are `left_out`.
    /// Every entry is zero afterwards.
    pub fn reshape(&mut self, blocks: &Blocks, left_out: &[bool]) {
        self.root = blocks.root;
        // One of two widths, so that elimination knows it as a constant.
        self.reach = if blocks.reach > 1 { FARTHEST_LINK } else { 1 };
        debug_assert!(blocks.reach <= FARTHEST_LINK);
        debug_assert!(blocks.reach <= 1 || blocks.root + 1 == blocks.starts.len());
        let lists = [&mut self.kept, &mut self.blocks, &mut self.starts, &mut self.places];
        lists.into_iter().for_each(Vec::clear);
        let size = left_out.len();
        self.places.resize(size, LEFT_OUT);
        let ends = blocks.starts.iter().skip(1).chain([&size]);
        for (block, (&start, &end)) in blocks.starts.iter().zip(ends).enumerate() {
            self.starts.push(self.kept.len());
            for unknown in (start..end).filter(|&unknown| !left_out[unknown]) {
                self.places[unknown] = self.kept.len();
                self.kept.push(unknown);
                self.blocks.push(block);
            }
        }
        self.starts.push(self.kept.len());
        self.links.clear();
        self.links.extend(blocks.links.iter().map(|&link| self.places[link]));
        self.lay_out();
    }

    fn lay_out(&mut self) {
        let lists = [&mut self.at, &mut self.within, &mut self.coupling, &mut self.in_links];
        lists.into_iter().for_each(Vec::clear);
        let (mut stored, width) = (0, self.width());
        for block in 0..self.starts.len() - 1 {
            let (start, size) = (self.starts[block], self.starts[block + 1] - self.starts[block]);
            // The root has no inner neighbour, and no entry of its is looked for there.
            let inner = if block < self.root { block + 1 } else { block.saturating_sub(1) };
            let link = LINK * inner;
            self.at.push(stored);
            for row in 0..size {
                // What comes before the first column cancels when a column is added: it may well be below zero.
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

    /// Entries of a row in the columns of the inner links.
    fn width(&self) -> usize {
        LINK * self.reach
    }

    /// Number of unknowns of a block that are kept.
    pub(crate) fn size_of(&self, block: usize) -> usize {
        self.starts[block + 1] - self.starts[block]
    }

    /// Where the entries of a column of a block in rows of inner links stand behind those of the row of the same unknown.
    fn behind(&self, place: usize) -> usize {
        self.width() * self.size_of(self.blocks[place])
    }

    /// `D` row by row, and the rows of `C` and of `Bᵀ`, of a block that is coupled with `W` unknowns of inner links.
    #[inline(always)]
    pub(crate) fn parts<const W: usize>(&self, block: usize) -> (&[f64], [&[[f64; W]]; 2]) {
        let size = self.size_of(block);
        let values = &self.values[self.at[block]..][..size * (size + 2 * W)];
        let (d, coupling) = values.split_at(size * size);
        (d, coupling.as_chunks().0.split_at(size).into())
    }

    /// The same of a block of `N` unknowns, to be changed.
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

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.at.len()
    }

    /// The entry at (`row`, `column`); zero outside the blocks and where it is left out.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        let (row, column) = (self.places[row], self.places[column]);
        if row == LEFT_OUT || column == LEFT_OUT || !self.is_coupled(row, column) {
            return 0.0;
        }
        self.values[self.index(row, column)]
    }

    /// Whether unknowns may be coupled; by their places.
    fn is_coupled(&self, row: usize, column: usize) -> bool {
        let behind = |outer: usize, inner: usize| {
            let (from, to) = (self.blocks[outer], self.blocks[inner]);
            let is_inward = if from < to { to <= self.root } else { to >= self.root };
            is_inward && from.abs_diff(to) <= self.reach && self.in_links[inner] != LEFT_OUT
        };
        self.blocks[row] == self.blocks[column] || behind(row, column) || behind(column, row)
    }

    /// The part in which an entry stands; row and column by their places.
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

    /// Where an entry stands among the values; row and column by their places.
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
    /// Adds `value` to an entry; does nothing where its row or column is left out.
    fn add(&mut self, row: usize, column: usize, value: f64) {
        let (row, column) = (self.places[row], self.places[column]);
        if row != LEFT_OUT && column != LEFT_OUT {
            let index = self.index(row, column);
            self.values[index] += value;
        }
    }

    /// Adds `values` to the entries from the one at (`row`, `column`) down the diagonal, of unknowns that follow each other in blocks.
    #[inline(always)]
    fn add_diagonal(&mut self, row: usize, column: usize, values: &[f64]) {
        let (row, column) = (self.places[row], self.places[column]);
        let first = self.index(row, column);
        let width = match values.len() {
            0 | 1 => 0,
            _ => self.index(row + 1, column + 1) - first,
        };
        for (k, value) in values.iter().enumerate() {
            self.values[first + width * k] += value;
        }
    }

    /// Adds `values` to the entries from the one at (`row`, `column`) on. The unknowns of these rows, and of these columns,
    /// are all kept and follow each other within a block.
    #[inline(always)]
    fn add_block<const R: usize, const C: usize>(
        &mut self,
        row: usize,
        column: usize,
        values: &[[f64; C]; R],
    ) {
        let (row, column) = (self.places[row], self.places[column]);
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

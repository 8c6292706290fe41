//! Block-tridiagonal matrices of small blocks.

use crate::tangent::Tangent;

/// Unknowns of a block that its outer neighbour is coupled with.
pub const LINK: usize = 3;

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
/// the *link* of the inner one, which is [`LINK`] unknowns in succession, and with no other unknown of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Blocks {
    /// First unknown of each block, in ascending order, from 0.
    pub starts: Vec<usize>,
    /// First unknown of the link of each block.
    pub links: Vec<usize>,
    /// Number of the block at which elimination from both ends meets.
    pub root: usize,
}

/// A block-tridiagonal matrix, of which the rows and columns of some unknowns are left out.
///
/// Rows and columns are named by the numbers of their unknowns. A block of `n` unknowns that are kept stores its own `n × n` entries
/// and then, for each of its unknowns, the three entries of its row in the columns of the inner link, and the three of its
/// column in the rows of that link: together, and in the order in which they are eliminated.
#[derive(Clone, Debug, Default)]
pub struct BlockMatrix {
    /// Number of the root block.
    pub(crate) root: usize,
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
    /// Where, by places, an entry of a row within its block stands, and one that couples with the inner link: behind these by the
    /// place of the column, or of the unknown of the link.
    within: Vec<usize>,
    coupling: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

/// The entries of a matrix in blocks.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockValues(Vec<f64>);

/// The part of the matrix in which an entry stands.
enum Part {
    Within,
    /// The row belongs to the outer block, the column to the link of the inner one.
    Columns,
    /// The other way round.
    Rows,
}

impl BlockMatrix {
    /// Gives the matrix a shape: that of `blocks` over `size` unknowns, without those that are `left_out`, in ascending order.
    /// Every entry is zero afterwards.
    pub fn reshape(&mut self, blocks: &Blocks, size: usize, left_out: &[usize]) {
        self.root = blocks.root;
        let lists = [&mut self.kept, &mut self.blocks, &mut self.starts, &mut self.places];
        lists.into_iter().for_each(Vec::clear);
        self.places.resize(size, LEFT_OUT);
        let mut left_out = left_out.iter().peekable();
        let ends = blocks.starts.iter().skip(1).chain([&size]);
        for (block, (&start, &end)) in blocks.starts.iter().zip(ends).enumerate() {
            self.starts.push(self.kept.len());
            for unknown in start..end {
                if left_out.next_if_eq(&&unknown).is_none() {
                    self.places[unknown] = self.kept.len();
                    self.kept.push(unknown);
                    self.blocks.push(block);
                }
            }
        }
        self.starts.push(self.kept.len());
        self.links.clear();
        self.links.extend(blocks.links.iter().map(|&link| self.places[link]));
        self.lay_out();
    }

    fn lay_out(&mut self) {
        let lists = [&mut self.at, &mut self.within, &mut self.coupling];
        lists.into_iter().for_each(Vec::clear);
        let mut stored = 0;
        for block in 0..self.starts.len() - 1 {
            let (start, size) = (self.starts[block], self.starts[block + 1] - self.starts[block]);
            let link = self.inner(block).map_or(0, |inner| self.links[inner]);
            self.at.push(stored);
            for row in 0..size {
                // What comes before the first column cancels when a column is added: it may well be below zero.
                self.within.push((stored + size * row).wrapping_sub(start));
                let coupled = stored + size * size + 2 * LINK * row;
                self.coupling.push(coupled.wrapping_sub(link));
            }
            stored += size * (size + 2 * LINK);
        }
        self.values.clear();
        self.values.resize(stored, 0.0);
    }

    /// The inner neighbour of a block; `None` for the root.
    pub(crate) fn inner(&self, block: usize) -> Option<usize> {
        match block.cmp(&self.root) {
            std::cmp::Ordering::Less => Some(block + 1),
            std::cmp::Ordering::Equal => None,
            std::cmp::Ordering::Greater => Some(block - 1),
        }
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.at.len()
    }

    /// Copies all entries to `values`.
    pub(crate) fn keep(&self, values: &mut BlockValues) {
        values.0.clone_from(&self.values);
    }

    /// Replaces all entries by those of a matrix of the same shape.
    pub(crate) fn set(&mut self, values: &BlockValues) {
        self.values.copy_from_slice(&values.0);
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
            let block = self.blocks[inner];
            let link = self.links[block]..self.links[block] + LINK;
            self.inner(self.blocks[outer]) == Some(block) && link.contains(&inner)
        };
        self.blocks[row] == self.blocks[column] || behind(row, column) || behind(column, row)
    }

    /// The part in which an entry stands; row and column by their places.
    #[inline]
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
    #[inline]
    fn index(&self, row: usize, column: usize) -> usize {
        match self.part(row, column) {
            Part::Within => self.within[row].wrapping_add(column),
            Part::Columns => self.coupling[row].wrapping_add(column),
            Part::Rows => self.coupling[column].wrapping_add(LINK + row),
        }
    }
}

impl Tangent for BlockMatrix {
    fn clear_row(&mut self, row: usize) {
        let place = self.places[row];
        let block = self.blocks[place];
        let neighbours = block.saturating_sub(1)..(block + 2).min(self.blocks());
        for column in self.starts[neighbours.start]..self.starts[neighbours.end] {
            if self.is_coupled(place, column) {
                let index = self.index(place, column);
                self.values[index] = 0.0;
            }
        }
    }

    /// Adds `value` to an entry; does nothing where its row or column is left out.
    fn add(&mut self, row: usize, column: usize, value: f64) {
        let (row, column) = (self.places[row], self.places[column]);
        if row != LEFT_OUT && column != LEFT_OUT {
            let index = self.index(row, column);
            self.values[index] += value;
        }
    }

    /// Adds `values` to the entries from the one at (`row`, `column`) down the diagonal, of unknowns that follow each other in blocks.
    #[inline]
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
    fn add_block<const R: usize, const C: usize>(
        &mut self,
        row: usize,
        column: usize,
        values: &[[f64; C]; R],
    ) {
        let (row, column) = (self.places[row], self.places[column]);
        let starts = match self.part(row, column) {
            Part::Within => &self.within[row..row + R],
            Part::Columns => &self.coupling[row..row + R],
            Part::Rows => {
                for (j, start) in self.coupling[column..column + C].iter().enumerate() {
                    let start = start.wrapping_add(LINK + row);
                    for (entry, values) in self.values[start..start + R].iter_mut().zip(values) {
                        *entry += values[j];
                    }
                }
                return;
            }
        };
        for (start, values) in starts.iter().zip(values) {
            let start = start.wrapping_add(column);
            for (entry, value) in self.values[start..start + C].iter_mut().zip(values) {
                *entry += value;
            }
        }
    }
}

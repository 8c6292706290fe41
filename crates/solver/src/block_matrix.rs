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
/// Rows and columns are named by the numbers of their unknowns. They are stored by their *places* among the
/// unknowns that are kept, each row with the columns from the first to the last that may be non-zero.
#[derive(Clone, Debug, Default)]
pub struct BlockMatrix {
    /// Number of the root block.
    pub(crate) root: usize,
    /// Place of the first unknown of each block, and the number of places.
    pub(crate) starts: Vec<usize>,
    /// Place of the first unknown of each link.
    pub(crate) links: Vec<usize>,
    /// The unknown at each place.
    kept: Vec<usize>,
    /// The place of each unknown.
    places: Vec<usize>,
    /// The columns of each row: the first, and one past the last.
    columns: Vec<[usize; 2]>,
    /// The entry in the first column of each row among the values.
    rows: Vec<usize>,
    values: Vec<f64>,
}

/// The entries of a matrix in blocks.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockValues(Vec<f64>);

impl BlockMatrix {
    /// Gives the matrix a shape: that of `blocks` over `size` unknowns, without those that are `left_out`, in ascending order.
    /// Every entry is zero afterwards.
    pub fn reshape(&mut self, blocks: &Blocks, size: usize, left_out: &[usize]) {
        let mut left_out = left_out.iter().peekable();
        self.kept.clear();
        self.places.clear();
        self.starts.clear();
        let mut starts = blocks.starts.iter().copied().peekable();
        for unknown in 0..size {
            while starts.next_if_eq(&unknown).is_some() {
                self.starts.push(self.kept.len());
            }
            if left_out.next_if_eq(&&unknown).is_some() {
                self.places.push(LEFT_OUT);
            } else {
                self.places.push(self.kept.len());
                self.kept.push(unknown);
            }
        }
        self.starts.push(self.kept.len());
        self.links.clear();
        self.links.extend(blocks.links.iter().map(|&link| self.places[link]));
        self.root = blocks.root;
        self.lay_out_rows();
    }

    fn lay_out_rows(&mut self) {
        self.columns.clear();
        self.rows.clear();
        let mut stored = 0;
        for block in 0..self.blocks() {
            for place in self.starts[block]..self.starts[block + 1] {
                let [first, end] = self.columns_of(block, place);
                self.columns.push([first, end]);
                self.rows.push(stored);
                stored += end - first;
            }
        }
        self.values.clear();
        self.values.resize(stored, 0.0);
    }

    /// The columns of a row of a block.
    fn columns_of(&self, block: usize, place: usize) -> [usize; 2] {
        let (mut first, mut end) = (self.starts[block], self.starts[block + 1]);
        if let Some(inner) = self.inner(block) {
            first = first.min(self.links[inner]);
            end = end.max(self.links[inner] + LINK);
        }
        if (self.links[block]..self.links[block] + LINK).contains(&place) {
            if block > 0 && block <= self.root {
                first = self.starts[block - 1];
            }
            if block >= self.root && block + 1 < self.blocks() {
                end = self.starts[block + 2];
            }
        }
        [first, end]
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
        self.starts.len() - 1
    }

    /// The unknowns that are kept, in order.
    pub fn kept(&self) -> &[usize] {
        &self.kept
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
        let is_stored = |[first, end]: &[usize; 2]| (*first..*end).contains(&column);
        if self.columns.get(row).is_some_and(is_stored) {
            self.values[self.at(row, column)]
        } else {
            0.0
        }
    }

    /// `N` entries of a row, from a column on; row and column by their places.
    pub(crate) fn entries<const N: usize>(&self, row: usize, column: usize) -> &[f64] {
        let at = self.at(row, column);
        &self.values[at..at + N]
    }

    /// Where an entry stands among the values; row and column by their places.
    fn at(&self, row: usize, column: usize) -> usize {
        let [first, end] = self.columns[row];
        debug_assert!(
            (first..end).contains(&column),
            "entry ({row}, {column}) lies outside the blocks"
        );
        self.rows[row] + column - first
    }
}

impl Tangent for BlockMatrix {
    fn clear_row(&mut self, row: usize) {
        let place = self.places[row];
        let [first, end] = self.columns[place];
        let start = self.rows[place];
        self.values[start..start + end - first].fill(0.0);
    }

    /// Adds `value` to an entry; does nothing where its row or column is left out.
    fn add(&mut self, row: usize, column: usize, value: f64) {
        let (row, column) = (self.places[row], self.places[column]);
        if row != LEFT_OUT && column != LEFT_OUT {
            let at = self.at(row, column);
            self.values[at] += value;
        }
    }

    /// Adds `values` to the entries from the one at (`row`, `column`) on. The unknowns of these rows, and of these columns,
    /// are all kept and follow each other.
    fn add_block<const R: usize, const C: usize>(
        &mut self,
        row: usize,
        column: usize,
        values: &[[f64; C]; R],
    ) {
        let (row, column) = (self.places[row], self.places[column]);
        for (i, values) in values.iter().enumerate() {
            debug_assert!(column + C <= self.columns[row + i][1]);
            let at = self.at(row + i, column);
            for (entry, value) in self.values[at..at + C].iter_mut().zip(values) {
                *entry += value;
            }
        }
    }
}

//! Block elimination of a [`BlockMatrix`], with row exchanges only within blocks.
#![expect(
    clippy::inline_always,
    reason = "only code that is inlined into its caller can use wide registers"
)]

use pulp::{Arch, NullaryFnOnce};

use crate::block_matrix::{BlockMatrix, FARTHEST_LINK, LINK};

/// Number of columns that link a block to its only inner neighbour (reach 1).
const NARROW: usize = LINK;
/// Number of columns that link a block to its inner neighbours at the largest reach.
const WIDE: usize = LINK * FARTHEST_LINK;

/// True if only matrices of reach 1 are eliminated block by block.
///
/// If this is true, [`BlockElimination::factorise`] returns an error for a larger reach, and the
/// caller uses a band LU factorisation. In a WebAssembly module the code for a larger reach would
/// take up a twelfth of the size, and speed matters less, because a page solves one design at a
/// time.
const IS_SMALL: bool = cfg!(target_arch = "wasm32");

/// Smallest acceptable pivot, relative to the largest entry of its column.
///
/// With a smaller pivot, elimination would lose digits that row exchanges between blocks can keep.
const SMALL: f64 = 1e-9;

/// Largest number of unknowns of a block.
pub const LARGEST_BLOCK: usize = 10;

/// Error for a matrix that cannot be eliminated block by block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "block {block} of {size} unknowns has no pivot that is large enough, or more than {LARGEST_BLOCK} unknowns"
)]
pub struct UnsafeBlock {
    /// Number of the block.
    pub block: usize,
    /// Number of unknowns of the block.
    pub size: usize,
}

/// Factorisation of a [`BlockMatrix`] by elimination from both ends towards the root.
///
/// `D` is the diagonal matrix of a block after elimination of the outer neighbours. `C` contains
/// the entries in the rows of the block and the columns of the inner links, `B` the entries in the
/// rows of the inner links and the columns of the block. Elimination of the block subtracts
/// `B D⁻¹ C` from the inner blocks (Golub & Van Loan, *Matrix Computations*, 4th ed. 2013, §4.5.1,
/// isbn 978-1-4214-0794-4).
///
/// Rows are exchanged only within a block. This is as stable as partial pivoting as long as each
/// block is regular if its inner neighbours are fixed; otherwise a small pivot reveals the singular
/// block.
#[derive(Clone, Debug, Default)]
pub struct BlockElimination {
    /// Matrix, to be filled by the caller.
    ///
    /// Factorisation replaces each `D` by its LU factors and each `C` by `D⁻¹ C`.
    pub matrix: BlockMatrix,
    /// For each position, the row with which its row was exchanged, as an index within the block.
    exchanges: Vec<usize>,
    /// For each block, true if the determinant of `D` is negative.
    negative: Vec<bool>,
    /// Right-hand side or solution at each position.
    work: Vec<f64>,
}

/// Matrix that elimination subtracts from the links of the inner neighbours.
type Update<const W: usize> = [[f64; W]; W];

/// Calls a generic method with the block size and the number `W` of columns of `C` as constants.
///
/// Evaluates `$refused` if the block size is zero or above [`LARGEST_BLOCK`].
macro_rules! with_size {
    ($size:expr, $self:ident . $method:ident ( $($argument:expr),* ) , $refused:expr) => {
        match $size {
            1 => $self.$method::<1, W>($($argument),*),
            2 => $self.$method::<2, W>($($argument),*),
            3 => $self.$method::<3, W>($($argument),*),
            4 => $self.$method::<4, W>($($argument),*),
            5 => $self.$method::<5, W>($($argument),*),
            6 => $self.$method::<6, W>($($argument),*),
            7 => $self.$method::<7, W>($($argument),*),
            8 => $self.$method::<8, W>($($argument),*),
            9 => $self.$method::<9, W>($($argument),*),
            10 => $self.$method::<10, W>($($argument),*),
            _ => $refused,
        }
    };
}

/// Factorisation at the largest reach, compiled for the widest registers of the processor.
struct WideFactorisation<'a>(&'a mut BlockElimination);
/// Substitution at the largest reach, compiled for the widest registers of the processor.
struct WideSubstitution<'a>(&'a mut BlockElimination, [usize; 2]);

impl NullaryFnOnce for WideFactorisation<'_> {
    type Output = Result<(), UnsafeBlock>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.0.factorise_all::<WIDE>()
    }
}

impl NullaryFnOnce for WideSubstitution<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.substitute::<WIDE>(self.1);
    }
}

impl BlockElimination {
    /// Replaces the matrix by its factors.
    ///
    /// # Errors
    /// If a block has no sufficiently large pivot or more than [`LARGEST_BLOCK`] unknowns.
    pub fn factorise(&mut self) -> Result<(), UnsafeBlock> {
        let (blocks, positions) = (self.matrix.blocks(), self.matrix.kept.len());
        self.exchanges.resize(positions, 0);
        self.work.resize(positions, 0.0);
        self.negative.clear();
        self.negative.resize(blocks, false);
        if self.matrix.reach == 1 {
            self.factorise_all::<NARROW>()
        } else if IS_SMALL {
            Err(UnsafeBlock { block: 0, size: self.matrix.size_of(0) })
        } else {
            Arch::new().dispatch(WideFactorisation(self))
        }
    }

    #[inline(always)]
    fn factorise_all<const W: usize>(&mut self) -> Result<(), UnsafeBlock> {
        let (root, blocks) = (self.matrix.root, self.matrix.blocks());
        // Eliminate from both ends inwards. A right-hand side that is zero except in the root, the
        // block of the load, then needs no forward substitution in the other blocks.
        let mut update = [[0.0; W]; W];
        for block in 0..root {
            self.eliminate(block, &mut update)?;
        }
        if root + 1 < blocks {
            let mut from_right = [[0.0; W]; W];
            for block in (root + 1..blocks).rev() {
                self.eliminate(block, &mut from_right)?;
            }
            for (sum, right) in update.iter_mut().flatten().zip(from_right.iter().flatten()) {
                *sum += right;
            }
        }
        self.eliminate(root, &mut update)
    }

    #[inline(always)]
    fn eliminate<const W: usize>(
        &mut self,
        block: usize,
        update: &mut Update<W>,
    ) -> Result<(), UnsafeBlock> {
        let size = self.matrix.size_of(block);
        let refused = UnsafeBlock { block, size };
        with_size!(size, self.eliminate_block(block, update), None).ok_or(refused)
    }

    /// Subtracts `update`, the contribution of the outer blocks, from a block and factorises it.
    ///
    /// Replaces `update` by the contribution to the inner neighbours.
    #[inline(always)]
    fn eliminate_block<const N: usize, const W: usize>(
        &mut self,
        block: usize,
        update: &mut Update<W>,
    ) -> Option<()> {
        let (start, is_root) = (self.matrix.starts[block], block == self.matrix.root);
        let link = self.matrix.links[block] - start;
        let (d, c, b) = self.matrix.parts_mut::<N, W>(block)?;
        // Pivots are compared with the entries before the update is subtracted, so that a pivot
        // that is small by cancellation is detected.
        let least = least_pivots(d);
        for i in 0..LINK {
            for j in 0..LINK {
                d[link + i][link + j] -= update[i][j];
            }
            for j in LINK..W {
                c[link + i][j - LINK] -= update[i][j];
                b[link + i][j - LINK] -= update[j][i];
            }
        }
        self.negative[block] = factorise(d, c, &mut self.exchanges[start..start + N], &least)?;
        // The root has no inner neighbour.
        if !is_root {
            substitute_back(d, c);
            propagate(update, b, c);
        }
        Some(())
    }

    /// Replaces the right-hand side `x` by the solution.
    ///
    /// At unknowns that are left out, the right-hand side is ignored and the solution is zero.
    pub fn solve(&mut self, x: &mut [f64]) {
        for (work, &kept) in self.work.iter_mut().zip(&self.matrix.kept) {
            *work = x[kept];
        }
        self.substitute_at_reach([0, self.matrix.blocks() - 1]);
        for (x, solution) in x.iter_mut().zip(self.solution()) {
            *x = solution;
        }
    }

    /// Returns the solution for a right-hand side that is 1 at `unknown` and zero elsewhere.
    ///
    /// The unknown must not be left out, and must lie in the root block or in a block before it.
    pub fn solve_unit(&mut self, unknown: usize) -> Vec<f64> {
        self.work.fill(0.0);
        let position = self.matrix.positions[unknown];
        self.work[position] = 1.0;
        let block = self.matrix.starts.partition_point(|&start| start <= position) - 1;
        self.substitute_at_reach([block, self.matrix.root]);
        self.solution().collect()
    }

    /// Replaces the right-hand side in `work` by the solution, with code compiled for the reach.
    ///
    /// The right-hand side must be zero before the first and after the second block of `between`.
    fn substitute_at_reach(&mut self, between: [usize; 2]) {
        if self.matrix.reach == 1 || IS_SMALL {
            self.substitute::<NARROW>(between);
        } else {
            Arch::new().dispatch(WideSubstitution(self, between));
        }
    }

    /// Substitutes inwards from `first` and `last` to the root, then outwards to all blocks.
    #[inline(always)]
    fn substitute<const W: usize>(&mut self, [first, last]: [usize; 2]) {
        let (root, blocks) = (self.matrix.root, self.matrix.blocks());
        let inwards = (first..root).chain((root + 1..=last).rev());
        for block in inwards.chain([root]) {
            with_size!(self.matrix.size_of(block), self.forward(block), ());
        }
        for block in (0..root).rev().chain(root + 1..blocks) {
            self.backward::<W>(block);
        }
    }

    /// Returns the number of inner neighbours to which a block is linked.
    fn inner_blocks(&self, block: usize) -> usize {
        self.matrix.reach.min(block.abs_diff(self.matrix.root))
    }

    /// Returns the first position of the link of the inner neighbour `away` blocks from `block`.
    fn inner_link(&self, block: usize, away: usize) -> usize {
        let inner = if block < self.matrix.root { block + away } else { block - away };
        self.matrix.links[inner]
    }

    /// Replaces the right-hand side `y` of a block by `D⁻¹ y` and updates the inner blocks.
    #[inline(always)]
    fn forward<const N: usize, const W: usize>(&mut self, block: usize) {
        let start = self.matrix.starts[block];
        let (factors, [_, b]) = self.matrix.parts::<W>(block);
        let (factors, _) = factors.as_chunks::<N>();
        let mut y = [[0.0; 1]; N];
        y.as_flattened_mut().copy_from_slice(&self.work[start..start + N]);
        for (k, &exchanged) in self.exchanges[start..start + N].iter().enumerate() {
            y.swap(k, exchanged);
        }
        for k in 0..N {
            let (head, tail) = y.split_at_mut(k + 1);
            for (y, factors) in tail.iter_mut().zip(&factors[k + 1..]) {
                subtract(y, factors[k], &head[k]);
            }
        }
        substitute_back(factors, &mut y);
        self.work[start..start + N].copy_from_slice(y.as_flattened());
        if block == self.matrix.root {
            return;
        }
        let mut update = [0.0; W];
        for (y, b) in y.iter().zip(b) {
            for (update, b) in update.iter_mut().zip(b) {
                *update += b * y[0];
            }
        }
        for away in 1..=self.inner_blocks(block) {
            let inner = self.inner_link(block, away);
            let update = &update[LINK * (away - 1)..][..LINK];
            for (work, update) in self.work[inner..inner + LINK].iter_mut().zip(update) {
                *work -= update;
            }
        }
    }

    /// Returns the solution at each unknown, zero for unknowns that are left out.
    fn solution(&self) -> impl Iterator<Item = f64> {
        self.matrix
            .positions
            .iter()
            .map(|&position| self.work.get(position).copied().unwrap_or(0.0))
    }

    /// Computes the solution `x = y − (D⁻¹ C) x_inner` of a block from the inner blocks.
    #[inline(always)]
    fn backward<const W: usize>(&mut self, block: usize) {
        let mut links = [0.0; W];
        for away in 1..=self.inner_blocks(block) {
            let inner = self.inner_link(block, away);
            links[LINK * (away - 1)..][..LINK].copy_from_slice(&self.work[inner..inner + LINK]);
        }
        let (_, [c, _]) = self.matrix.parts::<W>(block);
        for (work, c) in self.work[self.matrix.starts[block]..].iter_mut().zip(c) {
            let mut terms: [f64; W] = std::array::from_fn(|k| c[k] * links[k]);
            // Sum pairwise, as wide registers do: add the farther half of the links to the nearer
            // half until the terms of one link are left.
            let mut half = W;
            while half > LINK {
                half /= 2;
                for k in 0..half {
                    terms[k] += terms[k + half];
                }
            }
            *work -= terms[0] + terms[1] + terms[2];
        }
    }

    /// Returns the number of blocks in which the determinant of `D` is negative.
    ///
    /// The determinant of the matrix is negative if this number is odd.
    ///
    /// Let the matrix have the form `[[K, −Gᵀ], [G, C]]`, in which the rows of contact forces
    /// contain their conditions with positive compliances `C`. The determinant of a block is then
    /// negative if, with the inner blocks fixed, the number of negative eigenvalues of
    /// `K + Gᵀ C⁻¹ G` is odd (Haynsworth 1968, doi 10.1016/0024-3795(68)90050-5).
    pub fn negative_blocks(&self) -> usize {
        self.negative.iter().filter(|negative| **negative).count()
    }
}

/// Replaces `update`, the contribution to a block, by the contribution to its inner neighbours.
///
/// The new contribution is `B c` with `c = D⁻¹ C`, plus the entries of the old contribution that
/// belong to links beyond the block.
#[inline(always)]
fn propagate<const N: usize, const W: usize>(
    update: &mut Update<W>,
    b: &[[f64; W]; N],
    c: &[[f64; W]; N],
) {
    for i in 0..W {
        let mut row = [0.0; W];
        if i + LINK < W {
            row[..W - LINK].copy_from_slice(&update[i + LINK][LINK..]);
        }
        for (b, c) in b.iter().zip(c) {
            for (sum, c) in row.iter_mut().zip(c) {
                *sum += b[i] * c;
            }
        }
        update[i] = row;
    }
}

/// Returns the smallest acceptable pivot of each column.
#[inline(always)]
fn least_pivots<const N: usize>(d: &[[f64; N]; N]) -> [f64; N] {
    let mut least = [0.0_f64; N];
    for row in d {
        for (least, entry) in least.iter_mut().zip(row) {
            *least = least.max(entry.abs());
        }
    }
    least.map(|largest| SMALL * largest)
}

/// Replaces `d` by its LU factors, with partial pivoting.
///
/// The diagonal of the upper factor is stored as inverses. The same row operations are applied to
/// the right-hand sides `c`. Returns true if the determinant is negative, and `None` if a pivot
/// does not exceed its entry of `least`.
#[inline(always)]
fn factorise<const N: usize, const M: usize>(
    d: &mut [[f64; N]; N],
    c: &mut [[f64; M]; N],
    exchanges: &mut [usize],
    least: &[f64; N],
) -> Option<bool> {
    let mut negative = false;
    for k in 0..N {
        let (mut largest, mut pivot) = (d[k][k].abs(), k);
        for (i, row) in d.iter().enumerate().skip(k + 1) {
            if row[k].abs() > largest {
                (largest, pivot) = (row[k].abs(), i);
            }
        }
        // The negated comparison also rejects NaN.
        if !(largest > least[k] && largest.is_finite()) {
            return None;
        }
        exchanges[k] = pivot;
        if pivot != k {
            d.swap(k, pivot);
            c.swap(k, pivot);
            negative = !negative;
        }
        let (head, tail) = d.split_at_mut(k + 1);
        let pivot = &mut head[k];
        negative ^= pivot[k] < 0.0;
        // Store the inverse, because every substitution divides by the pivot, and a product is
        // faster than a quotient.
        pivot[k] = pivot[k].recip();
        let (c_head, c_tail) = c.split_at_mut(k + 1);
        for (row, c) in tail.iter_mut().zip(c_tail) {
            let factor = row[k] * pivot[k];
            row[k] = factor;
            for j in k + 1..N {
                row[j] -= factor * pivot[j];
            }
            subtract(c, factor, &c_head[k]);
        }
    }
    Some(negative)
}

/// Replaces the right-hand sides `x` by the solutions with the upper factor of `factors`.
#[inline(always)]
fn substitute_back<const N: usize, const M: usize>(factors: &[[f64; N]], x: &mut [[f64; M]; N]) {
    for k in (0..N).rev() {
        let (head, tail) = x.split_at_mut(k + 1);
        let x = &mut head[k];
        for (i, other) in (k + 1..).zip(tail) {
            subtract(x, factors[k][i], other);
        }
        for x in x {
            *x *= factors[k][k];
        }
    }
}

/// Computes `x ← x − factor y`.
#[inline(always)]
fn subtract<const M: usize>(x: &mut [f64; M], factor: f64, y: &[f64; M]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x -= factor * y;
    }
}

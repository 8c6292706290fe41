//! Elimination in block-tridiagonal matrices, pivots within the blocks.

use crate::block_matrix::{BlockMatrix, LINK};

/// A pivot below this part of the largest entry of its column is too small: digits are lost that rows of other
/// blocks might save.
const SMALL: f64 = 1e-9;

/// Unknowns of the largest block that is eliminated.
pub const LARGEST_BLOCK: usize = 10;

/// A matrix for which elimination block by block is not safe, or not meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "block {block} of {size} unknowns has no pivot that is large enough, or more than {LARGEST_BLOCK} unknowns"
)]
pub struct UnsafeBlock {
    /// Number of the block.
    pub block: usize,
    /// Number of its unknowns.
    pub size: usize,
}

/// Factors of a [`BlockMatrix`]: every block is eliminated into its inner neighbour, from both ends to the root.
///
/// With the matrix `D` of a block after elimination of its outer neighbour, `C` its columns of the inner link and `B` the rows
/// of that link, the elimination takes `B D⁻¹ C`, 3 by 3, from the inner block (Golub & Van Loan, *Matrix Computations*,
/// 4th ed. 2013, §4.5.1, isbn 978-1-4214-0794-4). Rows are exchanged within a block only, which is as good
/// as partial pivoting as long as a block is regular with its inner neighbours held. Where one is not,
/// its pivot is found too small.
#[derive(Clone, Debug, Default)]
pub struct BlockElimination {
    root: usize,
    /// Place of the first unknown of each block, and the number of places.
    starts: Vec<usize>,
    links: Vec<usize>,
    kept: Vec<usize>,
    /// The place of each unknown, beyond all places where it is left out.
    places: Vec<usize>,
    /// The first number of each block among the values: the factors of `D` row by row, then rows of `D⁻¹ C` and of `Bᵀ` in turn.
    at: Vec<usize>,
    values: Vec<f64>,
    /// By place: the row that was exchanged for this one, within its block.
    exchanges: Vec<usize>,
    /// Whether the determinant of each `D` is negative.
    negative: Vec<bool>,
    /// The right-hand side by places.
    work: Vec<f64>,
}

/// The matrix that elimination of a block takes from the link of its inner neighbour.
type Taken = [[f64; LINK]; LINK];

/// Calls a method with the size of a block as a constant.
macro_rules! with_size {
    ($size:expr, $self:ident . $method:ident ( $($argument:expr),* ) , $refused:expr) => {
        match $size {
            1 => $self.$method::<1>($($argument),*),
            2 => $self.$method::<2>($($argument),*),
            3 => $self.$method::<3>($($argument),*),
            4 => $self.$method::<4>($($argument),*),
            5 => $self.$method::<5>($($argument),*),
            6 => $self.$method::<6>($($argument),*),
            7 => $self.$method::<7>($($argument),*),
            8 => $self.$method::<8>($($argument),*),
            9 => $self.$method::<9>($($argument),*),
            10 => $self.$method::<10>($($argument),*),
            _ => $refused,
        }
    };
}

impl BlockElimination {
    /// Factorises `matrix`, forgetting the factors held before.
    ///
    /// # Errors
    /// If a block has no pivot that is large enough, or is too large.
    pub fn factorise(&mut self, matrix: &BlockMatrix) -> Result<(), UnsafeBlock> {
        self.reshape(matrix);
        let (root, blocks) = (self.root, matrix.blocks());
        // From both ends inwards: the load acts in the root, and a right-hand side that is zero elsewhere need not be
        // carried there.
        let mut taken = [Taken::default(); 2];
        for block in 0..root {
            self.eliminate(matrix, block, &mut taken[0])?;
        }
        for block in (root + 1..blocks).rev() {
            self.eliminate(matrix, block, &mut taken[1])?;
        }
        let [mut from_both, from_right] = taken;
        for (sum, right) in from_both.iter_mut().flatten().zip(from_right.iter().flatten()) {
            *sum += right;
        }
        self.eliminate(matrix, root, &mut from_both)
    }

    fn reshape(&mut self, matrix: &BlockMatrix) {
        self.root = matrix.root;
        self.starts.clone_from(&matrix.starts);
        self.links.clone_from(&matrix.links);
        self.kept.clone_from(&matrix.kept);
        self.places.clone_from(&matrix.places);
        self.at.clone_from(&matrix.at);
        // Old numbers may stay: all of them are overwritten block by block.
        self.values.resize(matrix.values.len(), 0.0);
        self.exchanges.resize(self.kept.len(), 0);
        self.work.resize(self.kept.len(), 0.0);
        self.negative.clear();
        self.negative.resize(matrix.blocks(), false);
    }

    fn size(&self, block: usize) -> usize {
        self.starts[block + 1] - self.starts[block]
    }

    fn eliminate(
        &mut self,
        matrix: &BlockMatrix,
        block: usize,
        taken: &mut Taken,
    ) -> Result<(), UnsafeBlock> {
        let size = self.size(block);
        let refused = UnsafeBlock { block, size };
        with_size!(size, self.eliminate_block(matrix, block, taken), None).ok_or(refused)
    }

    /// Factorises a block from whose link something is `taken`, and replaces that by what it takes from the link of the inner one.
    fn eliminate_block<const N: usize>(
        &mut self,
        matrix: &BlockMatrix,
        block: usize,
        taken: &mut Taken,
    ) -> Option<()> {
        let (start, at) = (self.starts[block], self.at[block]);
        let link = self.links[block] - start;
        let stored = &matrix.values[at..at + N * (N + 2 * LINK)];
        let (entries, coupling) = stored.split_at(N * N);
        let (mut d, mut c, mut b) = ([[0.0; N]; N], [[0.0; LINK]; N], [[0.0; LINK]; N]);
        d.as_flattened_mut().copy_from_slice(entries);
        for ((c, b), coupled) in c.iter_mut().zip(&mut b).zip(coupling.chunks_exact(2 * LINK)) {
            c.copy_from_slice(&coupled[..LINK]);
            b.copy_from_slice(&coupled[LINK..]);
        }
        // Measured before the neighbour's share is taken: what cancels there is what must be noticed.
        let least = least_pivots(&d);
        for (row, taken) in d[link..link + LINK].iter_mut().zip(taken.iter()) {
            for (entry, taken) in row[link..link + LINK].iter_mut().zip(taken) {
                *entry -= taken;
            }
        }
        let exchanges = &mut self.exchanges[start..start + N];
        self.negative[block] = factorise(&mut d, &mut c, exchanges, &least)?;
        let (factors, coupling) = self.values[at..at + stored.len()].split_at_mut(N * N);
        factors.copy_from_slice(d.as_flattened());
        // The root has nothing inward of it to be eliminated into.
        if block == self.root {
            return Some(());
        }
        substitute_back(&d, &mut c);
        for (coupled, (c, b)) in coupling.chunks_exact_mut(2 * LINK).zip(c.iter().zip(&b)) {
            coupled[..LINK].copy_from_slice(c);
            coupled[LINK..].copy_from_slice(b);
        }
        *taken = product(&b, &c);
        Some(())
    }

    /// Solves in place: `x` holds the right-hand side, then the solution, of all unknowns. Where an unknown was left out, the
    /// right-hand side does not count and the solution is zero.
    pub fn solve(&mut self, x: &mut [f64]) {
        for (work, &kept) in self.work.iter_mut().zip(&self.kept) {
            *work = x[kept];
        }
        let (root, blocks) = (self.root, self.at.len());
        for block in 0..root {
            self.forward(block, Some(block + 1));
        }
        for block in (root + 1..blocks).rev() {
            self.forward(block, Some(block - 1));
        }
        self.forward(root, None);
        self.outwards();
        for (x, solution) in x.iter_mut().zip(self.solution()) {
            *x = solution;
        }
    }

    /// The solution for a right-hand side of which one entry alone is not zero: that of `unknown`, which is kept and in the root
    /// block, is 1.
    pub fn solve_unit(&mut self, unknown: usize) -> Vec<f64> {
        self.work.fill(0.0);
        self.work[self.places[unknown]] = 1.0;
        self.forward(self.root, None);
        self.outwards();
        self.solution().collect()
    }

    fn forward(&mut self, block: usize, inner: Option<usize>) {
        with_size!(self.size(block), self.forward_block(block, inner), ());
    }

    /// `y ← D⁻¹ y` in a block, and what that takes from the right-hand side of the inner one.
    fn forward_block<const N: usize>(&mut self, block: usize, inner: Option<usize>) {
        let (start, at) = (self.starts[block], self.at[block]);
        let values = &self.values[at..at + N * (N + 2 * LINK)];
        let (factors, _) = values[..N * N].as_chunks::<N>();
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
        if let Some(inner) = inner {
            let inner = self.links[inner];
            let mut taken = [0.0; LINK];
            for (y, coupled) in y.iter().zip(values[N * N..].chunks_exact(2 * LINK)) {
                for (taken, b) in taken.iter_mut().zip(&coupled[LINK..]) {
                    *taken += b * y[0];
                }
            }
            for (work, taken) in self.work[inner..inner + LINK].iter_mut().zip(taken) {
                *work -= taken;
            }
        }
    }

    /// From the solution of the root to that of its neighbours and on.
    fn outwards(&mut self) {
        for block in (0..self.root).rev() {
            self.backward(block, self.links[block + 1]);
        }
        for block in self.root + 1..self.at.len() {
            self.backward(block, self.links[block - 1]);
        }
    }

    /// The solution of each unknown: zero where it is left out.
    fn solution(&self) -> impl Iterator<Item = f64> {
        self.places.iter().map(|&place| self.work.get(place).copied().unwrap_or(0.0))
    }

    /// `x = y − (D⁻¹ C) x_inner`.
    fn backward(&mut self, block: usize, inner: usize) {
        let size = self.size(block);
        let coupling = &self.values[self.at[block] + size * size..][..size * 2 * LINK];
        let link = [self.work[inner], self.work[inner + 1], self.work[inner + 2]];
        let (rows, _) = coupling.as_chunks::<{ 2 * LINK }>();
        for (work, c) in self.work[self.starts[block]..].iter_mut().zip(rows) {
            *work -= c[0] * link[0] + c[1] * link[1] + c[2] * link[2];
        }
    }

    /// How many blocks have a negative determinant once the outer ones are eliminated. The determinant of the matrix is
    /// negative if the number is odd.
    ///
    /// Where conditions of constraints stand in the rows of their forces, `[[K, −Gᵀ], [G, C]]` with positive compliances `C`,
    /// a block has a negative determinant if, with the inner ones held, an odd number of the eigenvalues of `K + Gᵀ C⁻¹ G` is negative
    /// (Haynsworth 1968, doi 10.1016/0024-3795(68)90050-5).
    pub fn negative_blocks(&self) -> usize {
        self.negative.iter().filter(|negative| **negative).count()
    }
}

/// `B C`, by the columns of `B`.
fn product<const N: usize>(b: &[[f64; LINK]; N], c: &[[f64; LINK]; N]) -> Taken {
    let mut product = Taken::default();
    for (b, c) in b.iter().zip(c) {
        for (row, b) in product.iter_mut().zip(b) {
            for (sum, c) in row.iter_mut().zip(c) {
                *sum += b * c;
            }
        }
    }
    product
}

/// The least pivots that will do, column by column.
fn least_pivots<const N: usize>(d: &[[f64; N]; N]) -> [f64; N] {
    let mut least = [0.0_f64; N];
    for row in d {
        for (least, entry) in least.iter_mut().zip(row) {
            *least = least.max(entry.abs());
        }
    }
    least.map(|largest| SMALL * largest)
}

/// LU factors in place with partial pivoting, inverses on the diagonal of the upper one, and the right-hand sides `c` with rows
/// exchanged and eliminated alike. Returns whether the determinant is negative; `None` if a pivot is not above the `least`.
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
        // The comparison is false for what is not a number, too.
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
        // Kept inverted, since every substitution needs it and a product is quicker than a quotient.
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

/// Back substitution of several right-hand sides in place.
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

/// `x ← x − factor y`.
fn subtract<const M: usize>(x: &mut [f64; M], factor: f64, y: &[f64; M]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x -= factor * y;
    }
}

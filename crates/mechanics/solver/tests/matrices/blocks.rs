//! Comparison of block elimination with dense LU factorisation.

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use solver::{BlockElimination, BlockMatrix, Blocks, FARTHEST_LINK, LINK, Tangent, UnsafeBlock};

/// Sizes of a chain of blocks.
#[derive(Clone, Debug)]
struct Chain {
    /// Numbers of unknowns before and after the link of each block.
    extras: Vec<[usize; 2]>,
    /// Number of the root block.
    root: usize,
    /// Number of inner neighbours to which a block is coupled.
    reach: usize,
}

impl Chain {
    /// Returns the block structure.
    fn blocks(&self) -> Blocks {
        let mut blocks = Blocks { root: self.root, reach: self.reach, ..Blocks::default() };
        let mut size = 0;
        for [before, after] in &self.extras {
            blocks.starts.push(size);
            blocks.links.push(size + before);
            size += before + LINK + after;
        }
        blocks
    }

    /// Returns the number of unknowns.
    fn size(&self) -> usize {
        self.extras.iter().map(|[before, after]| before + LINK + after).sum()
    }

    /// Returns the block of an unknown.
    fn block(&self, unknown: usize) -> usize {
        self.blocks().starts.partition_point(|&start| start <= unknown) - 1
    }

    /// Returns true if an unknown belongs to the link of its block.
    fn is_link(&self, unknown: usize) -> bool {
        let link = self.blocks().links[self.block(unknown)];
        (link..link + LINK).contains(&unknown)
    }

    /// Returns true if two unknowns may be coupled.
    fn couples(&self, i: usize, j: usize) -> bool {
        let [a, b] = [self.block(i), self.block(j)];
        // The unknown in the inner block must belong to the link.
        let inner = if a.abs_diff(self.root) < b.abs_diff(self.root) { i } else { j };
        a == b
            || self.is_link(inner)
                && a.abs_diff(b) <= self.reach
                && a.abs_diff(self.root) != b.abs_diff(self.root)
    }
}

/// Generates chains of at most seven blocks.
///
/// Each block has up to three unknowns before and after its link. If the reach is above 1, the root
/// is the last block.
fn chains() -> impl Strategy<Value = Chain> {
    let extras = prop::collection::vec(prop::array::uniform2(0_usize..4), 1..8);
    (extras, 0_usize..8, prop_oneof![Just(1), 2..=FARTHEST_LINK]).prop_map(
        |(extras, root, reach)| {
            let last = extras.len() - 1;
            Chain { root: if reach == 1 { root.min(last) } else { last }, extras, reach }
        },
    )
}

/// Converts a dense matrix to blocks, without the rows and columns `left_out`.
fn in_blocks(chain: &Chain, dense: &DMatrix<f64>, left_out: &[bool]) -> BlockMatrix {
    let mut matrix = BlockMatrix::default();
    matrix.reshape(&chain.blocks(), left_out);
    for i in 0..chain.size() {
        for j in (0..chain.size()).filter(|&j| chain.couples(i, j)) {
            matrix.add(i, j, dense[(i, j)]);
        }
    }
    matrix
}

/// Factorises `matrix` in the storage of `solver`.
fn factorise(solver: &mut BlockElimination, matrix: BlockMatrix) -> Result<(), UnsafeBlock> {
    solver.matrix = matrix;
    solver.factorise()
}

/// Returns the solution without the unknowns `left_out`, computed by dense LU factorisation.
///
/// The second value is the ratio of the smallest to the largest pivot, the third the determinant.
fn reference(dense: &DMatrix<f64>, left_out: &[bool], rhs: &[f64]) -> (Vec<f64>, f64, f64) {
    let kept: Vec<_> = (0..rhs.len()).filter(|&i| !left_out[i]).collect();
    let part = DMatrix::from_fn(kept.len(), kept.len(), |i, j| dense[(kept[i], kept[j])]);
    let lu = part.lu();
    let x = lu.solve(&DVector::from_fn(kept.len(), |i, _| rhs[kept[i]]));
    let x = x.unwrap_or_else(|| DVector::from_element(kept.len(), f64::NAN));
    let u = lu.u();
    let pivots = (0..kept.len()).map(|i| u[(i, i)].abs());
    let (low, high) = pivots.fold((f64::INFINITY, 0.0), |(l, h), p| (p.min(l), p.max(h)));
    let mut full = vec![0.0; rhs.len()];
    for (&k, x) in kept.iter().zip(x.iter()) {
        full[k] = *x;
    }
    (full, low / high, lu.determinant())
}

/// Asserts that two vectors agree; `tolerance` is relative to the largest expected entry.
fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    let largest = expected.iter().fold(1e-300_f64, |max, x| max.max(x.abs()));
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let off = (found - expected).abs() / largest;
        assert!(off <= tolerance, "{i}: {found} {expected} {off:e}");
    }
}

/// Number of different entries of a matrix.
///
/// It is small, because generating random numbers takes most of the time, and a prime number, so
/// that entries repeat irregularly.
const ENTRIES: usize = 509;

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, max_global_rejects: 20_000, ..ProptestConfig::default() })]

    #[test]
    fn solutions_agree_with_a_dense_solver(
        chain in chains(),
        entries in prop::collection::vec(-1.0_f64..1.0, ENTRIES),
        rhs in prop::collection::vec(-1.0_f64..1.0, 72),
        marks in prop::collection::vec(0_usize..4, 72),
    ) {
        let size = chain.size();
        let left_out: Vec<_> = (0..size).map(|i| !chain.is_link(i) && marks[i] == 0).collect();
        let dense = DMatrix::from_fn(size, size, |i, j| {
            if chain.couples(i, j) { entries[(72 * i + j) % ENTRIES] } else { 0.0 }
        });
        let (expected, pivots, determinant) = reference(&dense, &left_out, &rhs[..size]);
        prop_assume!(pivots > 1e-3);
        let mut solver = BlockElimination::default();
        // A previous factorisation must not affect the result.
        let _ = factorise(&mut solver, in_blocks(&chain, &dense, &vec![false; size]));
        let found = factorise(&mut solver, in_blocks(&chain, &dense, &left_out));
        // Block elimination is refused only in rare cases, if a random block is nearly singular.
        prop_assume!(found.is_ok());
        let mut x = rhs[..size].to_vec();
        solver.solve(&mut x);
        assert_close(&x, &expected, 1e-7);
        prop_assert_eq!(solver.negative_blocks() % 2 == 1, determinant < 0.0);
    }

    #[test]
    fn the_solution_for_a_unit_vector_equals_the_general_solution(
        chain in chains(), entries in prop::collection::vec(-1.0_f64..1.0, ENTRIES), which in 0_usize..72,
    ) {
        let size = chain.size();
        let dense = DMatrix::from_fn(size, size, |i, j| match i == j {
            true => 20.0 + entries[i],
            false if chain.couples(i, j) => entries[(72 * i + j) % ENTRIES],
            false => 0.0,
        });
        let matrix = in_blocks(&chain, &dense, &vec![false; size]);
        let blocks = chain.blocks();
        let end = blocks.starts.get(chain.root + 1).copied().unwrap_or(size);
        let unknown = which % end;
        let mut solver = BlockElimination::default();
        factorise(&mut solver, matrix).unwrap();
        let mut x = vec![0.0; size];
        x[unknown] = 1.0;
        solver.solve(&mut x);
        prop_assert_eq!(x, solver.solve_unit(unknown));
    }

    /// Uses symmetric matrices with blocks of three unknowns.
    ///
    /// All `D` together have as many negative eigenvalues as the matrix. The determinant of a `D`
    /// is negative if its number of negative eigenvalues is odd.
    #[test]
    fn negative_determinants_of_blocks_agree_with_the_number_of_negative_eigenvalues(
        count in 1_usize..6, root in 0_usize..6, entries in prop::collection::vec(-1.0_f64..1.0, 18 * 18),
        shift in 1.0_f64..4.0,
    ) {
        let chain = Chain { extras: vec![[0, 0]; count], root: root % count, reach: 1 };
        let size = chain.size();
        let dense = DMatrix::from_fn(size, size, |i, j| {
            let value = if chain.couples(i, j) { entries[18 * i.min(j) + i.max(j)] } else { 0.0 };
            if i == j { shift + value } else { value }
        });
        let eigenvalues = dense.symmetric_eigenvalues();
        prop_assume!(eigenvalues.iter().all(|value| value.abs() > 1e-6));
        let negative = eigenvalues.iter().filter(|value| **value < 0.0).count();
        let mut solver = BlockElimination::default();
        let found = factorise(&mut solver, in_blocks(&chain, &dense, &vec![false; size]));
        prop_assume!(found.is_ok());
        prop_assert_eq!(solver.negative_blocks() % 2, negative % 2);
        prop_assert!(solver.negative_blocks() <= negative);
    }
}

/// Tangent of a row of scales on springs, with stiff contacts between some neighbours.
///
/// The unknowns of a contact follow or precede the displacements of the outer scale of its pair.
/// The load follows the displacements of the root.
struct ContactRow {
    chain: Chain,
    dense: DMatrix<f64>,
}

impl ContactRow {
    /// Creates a row of scales with half-width `a` of the bases.
    ///
    /// `contacts` is the number of contacts of each pair of neighbours. `numbers` are random
    /// numbers.
    fn new(
        root: usize,
        contacts: &[usize],
        a: f64,
        compliance: f64,
        numbers: &mut impl Iterator<Item = f64>,
    ) -> Self {
        let extras = (0..=contacts.len()).map(|i| match i.cmp(&root) {
            std::cmp::Ordering::Less => [0, contacts[i]],
            std::cmp::Ordering::Equal => [0, 1],
            std::cmp::Ordering::Greater => [contacts[i - 1], 0],
        });
        let chain = Chain { extras: extras.collect(), root, reach: 1 };
        let links = chain.blocks().links;
        let mut number = || numbers.next().unwrap();
        let mut row = Self { dense: DMatrix::zeros(chain.size(), chain.size()), chain };
        for (i, &at) in links.iter().enumerate() {
            for (k, stiffness) in [2.7 * a, 3.4 * a, 2.5 * a.powi(3)].into_iter().enumerate() {
                row.dense[(at + k, at + k)] += stiffness;
                if let Some(&next) = links.get(i + 1) {
                    row.add_symmetric(at + k, next + k, -0.35 * stiffness);
                }
            }
        }
        for (i, &count) in contacts.iter().enumerate() {
            for contact in 0..count {
                let force = if i < root { links[i] + LINK } else { links[i + 1] - count } + contact;
                let slope = 3.0 * number();
                for (at, sign) in [(links[i], 1.0), (links[i + 1], -1.0)] {
                    let arm = if contact == 0 { 1.0 } else { 0.3 } + 0.5 * number();
                    for (k, part) in [sign, sign * slope, sign * arm].into_iter().enumerate() {
                        row.dense[(force, at + k)] = part;
                        row.dense[(at + k, force)] = -part;
                    }
                    // The direction of the force rotates with the scale.
                    row.dense[(at + 2, at + 2)] += 0.1 * a * number();
                }
                row.dense[(force, force)] = compliance;
            }
        }
        let load = links[root] + LINK;
        row.dense[(links[root] + 1, load)] = 1.0;
        row.dense[(links[root] + 2, load)] = 0.8;
        row.dense[(load, links[root] + 2)] = -5.7;
        row
    }

    /// Adds `value` to the entries (`i`, `j`) and (`j`, `i`).
    fn add_symmetric(&mut self, i: usize, j: usize, value: f64) {
        self.dense[(i, j)] += value;
        self.dense[(j, i)] += value;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn solutions_of_rows_with_stiff_contacts_agree_with_a_dense_solver(
        root in 0_usize..10, contacts in prop::collection::vec(0_usize..3, 9),
        half_base in -2.0_f64..0.0, compliance in -18.0_f64..-3.0,
        numbers in prop::collection::vec(-1.0_f64..1.0, 200),
    ) {
        let mut numbers = numbers.into_iter().cycle();
        let row = ContactRow::new(root, &contacts, 10_f64.powf(half_base), 10_f64.powf(compliance), &mut numbers);
        let size = row.chain.size();
        let rhs: Vec<_> = numbers.take(size).collect();
        let left_out = vec![false; size];
        let matrix = in_blocks(&row.chain, &row.dense, &left_out);
        let mut solver = BlockElimination::default();
        prop_assume!(factorise(&mut solver, matrix).is_ok());
        let mut x = rhs.clone();
        solver.solve(&mut x);
        // The residual of each equation is compared with the sum of the magnitudes of its terms.
        for (i, rhs) in rhs.iter().enumerate() {
            let terms = (0..size).map(|j| row.dense[(i, j)] * x[j]);
            let (sum, scale) = terms.fold((-rhs, 1.0), |(s, a), t| (s + t, a + t.abs()));
            prop_assert!(sum.abs() < 1e-10 * scale, "row {i}: {sum:e} of {scale:e}");
        }
        let (expected, ..) = reference(&row.dense, &left_out, &rhs);
        assert_close(&x, &expected, 1e-8);
    }
}

#[test]
fn a_singular_block_of_a_regular_matrix_is_refused() {
    // The outer block is zero; only the coupling to its inner neighbour makes the matrix regular.
    let chain = Chain { extras: vec![[0, 0]; 2], root: 1, reach: 1 };
    let dense =
        DMatrix::from_fn(6, 6, |i, j| f64::from(u8::from(i % 3 == j % 3 && (i >= 3 || j >= 3))));
    let mut solver = BlockElimination::default();
    let error = factorise(&mut solver, in_blocks(&chain, &dense, &[false; 6])).unwrap_err();
    assert_eq!((error.block, error.size), (0, 3));
}

#[test]
fn blocks_that_are_not_finite_are_refused() {
    for value in [f64::NAN, f64::INFINITY] {
        let chain = Chain { extras: vec![[0, 0]; 2], root: 1, reach: 1 };
        let dense = DMatrix::from_fn(6, 6, |i, j| match (i, j) {
            (4, 4) => value,
            _ => f64::from(u8::from(i == j)),
        });
        let mut solver = BlockElimination::default();
        let found = factorise(&mut solver, in_blocks(&chain, &dense, &[false; 6]));
        assert_eq!(found.unwrap_err().block, 1, "{value}");
    }
}

#[test]
fn a_block_with_too_many_unknowns_is_refused() {
    let chain = Chain { extras: vec![[0, 8]], root: 0, reach: 1 };
    let dense = DMatrix::identity(11, 11);
    let mut solver = BlockElimination::default();
    let error = factorise(&mut solver, in_blocks(&chain, &dense, &[false; 11])).unwrap_err();
    assert_eq!(error.size, 11);
}

#[test]
fn added_entries_are_returned_at_their_row_and_column() {
    let chain = Chain { extras: vec![[1, 2], [0, 1], [2, 0]], root: 1, reach: 1 };
    let size = chain.size();
    let mut left_out = vec![false; size];
    left_out[5] = true;
    let dense = DMatrix::from_fn(size, size, |i, j| (100 * i + j) as f64);
    let mut matrix = in_blocks(&chain, &dense, &left_out);
    matrix.add_block(1, 6, &[[0.5; 3]; 3]);
    matrix.add_block(6, 6, &[[0.25; 4]; 1]);
    for i in 0..size {
        for j in 0..size {
            let is_stored = chain.couples(i, j) && !left_out[i] && !left_out[j];
            let mut expected = if is_stored { dense[(i, j)] } else { 0.0 };
            expected += if (1..4).contains(&i) && (6..9).contains(&j) { 0.5 } else { 0.0 };
            expected += if i == 6 && (6..10).contains(&j) { 0.25 } else { 0.0 };
            assert_eq!(matrix.get(i, j), expected, "{i} {j}");
        }
    }
}

//! Factors of dense matrices.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Mat, Par, Spec};

/// LU factors with partial pivoting, on the calling thread alone: the same bits every time.
pub(crate) struct DenseLu {
    factors: Mat<f64>,
    order: Vec<usize>,
    inverse: Vec<usize>,
}

impl DenseLu {
    pub(crate) fn new(mut matrix: Mat<f64>) -> Self {
        let n = matrix.nrows();
        let (mut order, mut inverse) = (vec![0_usize; n], vec![0_usize; n]);
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Spec::default());
        factor::lu_in_place(
            matrix.as_mut(),
            &mut order,
            &mut inverse,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Spec::default(),
        );
        Self { factors: matrix, order, inverse }
    }

    pub(crate) fn solve(&self, mut right: Mat<f64>) -> Mat<f64> {
        let (n, columns) = (right.nrows(), right.ncols());
        let scratch = solve::solve_in_place_scratch::<usize, f64>(n, columns, Par::Seq);
        let order = PermRef::new_checked(&self.order, &self.inverse, n);
        let factors = self.factors.as_ref();
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        solve::solve_in_place(factors, factors, order, right.as_mut(), Par::Seq, stack);
        right
    }
}

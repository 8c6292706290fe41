//! Factors of the tangent of a system: block by block where that is possible, of a band matrix elsewhere.

use crate::block_elimination::BlockElimination;
use crate::block_matrix::BlockMatrix;
use crate::linear::{BandLu, BandMatrix, SingularMatrix};
use crate::system::{Residual, State, System, Tangent, inactive};

/// Factors of the tangent, with the row of a condition in the place of the missing one.
#[derive(Clone, Debug)]
pub(crate) struct TangentSolver {
    blocks: Option<InBlocks>,
    band: Option<InBand>,
    /// Whether the factors are those of the blocks.
    is_in_blocks: bool,
    /// Unknowns of the inactive constraints.
    inactive: Vec<usize>,
}

#[derive(Clone, Debug, Default)]
struct InBlocks {
    matrix: BlockMatrix,
    elimination: BlockElimination,
    /// What the matrix leaves out.
    left_out: Option<Vec<usize>>,
}

#[derive(Clone, Debug)]
struct InBand {
    matrix: BandMatrix,
    lu: BandLu,
}

impl TangentSolver {
    pub(crate) fn new(system: &impl System) -> Self {
        Self {
            blocks: system.blocks().map(|_| InBlocks::default()),
            band: None,
            is_in_blocks: false,
            inactive: Vec::with_capacity(system.constraints().len()),
        }
    }

    /// Evaluates the equations, and factorises the tangent without the unknowns of inactive constraints, its missing row
    /// replaced by `condition`.
    ///
    /// # Errors
    /// If the matrix has no factors.
    pub(crate) fn factorise<S: System>(
        &mut self,
        system: &S,
        state: &State<S::Mode>,
        condition: &[(usize, f64)],
        residual: &mut Residual,
    ) -> Result<(), SingularMatrix> {
        self.inactive.clear();
        self.inactive.extend(inactive(system, state));
        let inactive = &self.inactive;
        let blocks = self.blocks.as_mut();
        self.is_in_blocks = blocks
            .is_some_and(|blocks| blocks.factorise(system, state, condition, inactive, residual));
        if self.is_in_blocks {
            return Ok(());
        }
        let band = self.band.get_or_insert_with(|| InBand::new(system));
        band.factorise(system, state, condition, inactive, residual)
    }

    /// Solves in place: `x` holds the right-hand side, then the solution.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        match (&mut self.blocks, &mut self.band) {
            (Some(blocks), _) if self.is_in_blocks => blocks.elimination.solve(x),
            (_, Some(band)) => band.lu.solve(x),
            // Nothing has been factorised.
            _ => x.fill(f64::NAN),
        }
    }

    /// Solves for a right-hand side of which the entry of the load alone is not zero: it is 1.
    pub(crate) fn solve_unit(&mut self, load: usize, x: &mut [f64]) {
        match &mut self.blocks {
            Some(blocks) if self.is_in_blocks => blocks.elimination.solve_unit(load, x),
            _ => {
                x.fill(0.0);
                x[load] = 1.0;
                self.solve(x);
            }
        }
    }
}

impl InBlocks {
    /// Whether there are factors, and the pivots are large enough.
    fn factorise<S: System>(
        &mut self,
        system: &S,
        state: &State<S::Mode>,
        condition: &[(usize, f64)],
        inactive: &[usize],
        residual: &mut Residual,
    ) -> bool {
        let Some(blocks) = system.blocks() else { return false };
        if self.left_out.as_deref() == Some(inactive) {
            self.matrix.clear();
        } else {
            self.matrix.reshape(blocks, system.size(), inactive);
            let left_out = self.left_out.get_or_insert_default();
            left_out.clear();
            left_out.extend_from_slice(inactive);
        }
        system.linearise(state, residual, &mut self.matrix);
        self.matrix.clear_row(system.load());
        for &(index, coefficient) in condition {
            self.matrix.add(system.load(), index, coefficient);
        }
        self.elimination.factorise(&self.matrix).is_ok()
    }
}

impl InBand {
    fn new(system: &impl System) -> Self {
        let (size, half) = (system.size(), system.half_bandwidth());
        Self { matrix: BandMatrix::new(size, half), lu: BandLu::new(size, half) }
    }

    fn factorise<S: System>(
        &mut self,
        system: &S,
        state: &State<S::Mode>,
        condition: &[(usize, f64)],
        inactive: &[usize],
        residual: &mut Residual,
    ) -> Result<(), SingularMatrix> {
        self.matrix.clear();
        system.linearise(state, residual, &mut self.matrix);
        self.matrix.clear_row(system.load());
        for &(index, coefficient) in condition {
            self.matrix.add(system.load(), index, coefficient);
        }
        self.lu.factorise_without(&self.matrix, inactive)
    }
}

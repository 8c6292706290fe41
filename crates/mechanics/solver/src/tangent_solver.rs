//! Linear solver for the tangent: block elimination if possible, otherwise band LU factorisation.

use crate::block_elimination::BlockElimination;
use crate::block_matrix::Blocks;
use crate::linear::{BandLu, BandMatrix, SingularMatrix};
use crate::system::{Residual, State, System, inactive};
use crate::tangent::Tangent;

/// Factors of the tangent, with the row of a condition as the row of the load.
#[derive(Clone, Debug)]
pub(crate) struct TangentSolver {
    /// Block elimination, `None` if the system has no block structure.
    blocks: Option<InBlocks>,
    /// Band LU factorisation, `None` before its first use.
    band: Option<InBand>,
    /// True if the current factors are in `blocks`, false if they are in `band`.
    is_in_blocks: bool,
    /// True for each unknown that is zero and left out.
    inactive: Vec<bool>,
}

/// Tangent in blocks, with its factors.
#[derive(Clone, Debug, Default)]
struct InBlocks {
    /// Matrix, and its factors after elimination.
    elimination: BlockElimination,
    /// True for each unknown that the matrix leaves out; empty before the first assembly.
    left_out: Vec<bool>,
    /// Values of the constant part of the matrix.
    constant: Vec<f64>,
}

/// Tangent as a band matrix, with its factors.
#[derive(Clone, Debug)]
struct InBand {
    /// Matrix.
    matrix: BandMatrix,
    /// Constant part of the matrix.
    constant: BandMatrix,
    /// Factors of the matrix.
    lu: BandLu,
}

impl TangentSolver {
    /// Creates a solver without factors.
    pub(crate) fn new(system: &impl System) -> Self {
        Self {
            blocks: system.blocks().map(|_| InBlocks::default()),
            band: None,
            is_in_blocks: false,
            inactive: Vec::with_capacity(system.size()),
        }
    }

    /// Evaluates the equations into `residual` and factorises the tangent.
    ///
    /// The unknowns that are zero are left out, and `condition` is the row of the load.
    ///
    /// # Errors
    /// If the matrix is singular.
    pub(crate) fn factorise<S: System>(
        &mut self,
        system: &S,
        state: &State<S::Mode>,
        condition: &[(usize, f64)],
        residual: &mut Residual,
    ) -> Result<(), SingularMatrix> {
        self.inactive.clear();
        self.inactive.resize(system.size(), false);
        inactive(system, state).for_each(|unknown| self.inactive[unknown] = true);
        self.is_in_blocks = false;
        let blocks = system.blocks().filter(|_| system.is_in_blocks(state));
        if let (Some(in_blocks), Some(blocks)) = (&mut self.blocks, blocks) {
            in_blocks.begin(system, blocks, &self.inactive);
            assemble(system, state, condition, residual, &mut in_blocks.elimination.matrix);
            // If a pivot is too small, the band LU factorisation below may still succeed, because
            // it can exchange rows between blocks.
            self.is_in_blocks = in_blocks.elimination.factorise().is_ok();
        }
        if self.is_in_blocks {
            return Ok(());
        }
        // The band matrix is allocated at its first use, because most paths never need it.
        let InBand { matrix, constant, lu } = self.band.get_or_insert_with(|| InBand::new(system));
        matrix.set(constant);
        assemble(system, state, condition, residual, matrix);
        lu.factorise(matrix, &self.inactive)
    }

    /// Replaces the right-hand side `x` by the solution.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        match (&mut self.blocks, &mut self.band) {
            (Some(blocks), _) if self.is_in_blocks => blocks.elimination.solve(x),
            (_, Some(band)) => band.lu.solve(x),
            // No tangent has been factorised yet.
            _ => x.fill(f64::NAN),
        }
    }

    /// Returns true if the determinant of the last factorised tangent is negative.
    pub(crate) fn is_negative(&self) -> bool {
        match (&self.blocks, &self.band) {
            (Some(blocks), _) if self.is_in_blocks => blocks.elimination.negative_blocks() % 2 == 1,
            (_, Some(band)) => band.lu.is_negative(),
            _ => false,
        }
    }

    /// Returns the solution for a right-hand side of `size` entries, 1 at `load` and 0 elsewhere.
    pub(crate) fn solve_unit(&mut self, load: usize, size: usize) -> Vec<f64> {
        match &mut self.blocks {
            Some(blocks) if self.is_in_blocks => blocks.elimination.solve_unit(load),
            _ => {
                let mut x = vec![0.0; size];
                x[load] = 1.0;
                self.solve(&mut x);
                x
            }
        }
    }
}

/// Evaluates the equations into `residual` and adds the tangent to `matrix`.
///
/// `matrix` already contains its constant part. `condition` is added in the row of the load, in
/// which the system has no entries.
fn assemble<S: System>(
    system: &S,
    state: &State<S::Mode>,
    condition: &[(usize, f64)],
    residual: &mut Residual,
    matrix: &mut impl Tangent,
) {
    system.linearise(state, residual, matrix);
    for &(index, coefficient) in condition {
        matrix.add(system.load(), index, coefficient);
    }
}

impl InBlocks {
    /// Sets the matrix to its constant part, without the `inactive` unknowns.
    fn begin(&mut self, system: &impl System, blocks: &Blocks, inactive: &[bool]) {
        // Between events the shape of the matrix does not change, so the constant part is copied
        // instead of assembled again.
        let matrix = &mut self.elimination.matrix;
        if self.left_out == inactive {
            matrix.values.copy_from_slice(&self.constant);
        } else {
            matrix.reshape(blocks, inactive);
            system.constant_tangent(matrix);
            self.constant.clone_from(&matrix.values);
            inactive.clone_into(&mut self.left_out);
        }
    }
}

impl InBand {
    /// Creates storage and assembles the constant part of the matrix.
    fn new(system: &impl System) -> Self {
        let (size, half) = (system.size(), system.half_bandwidth());
        let mut constant = BandMatrix::new(size, half);
        system.constant_tangent(&mut constant);
        Self { matrix: BandMatrix::new(size, half), constant, lu: BandLu::new(size, half) }
    }
}

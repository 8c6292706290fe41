//! Factors of a tangent, by block elimination if possible, else as a band matrix.

use crate::block_elimination::BlockElimination;
use crate::block_matrix::Blocks;
use crate::linear::{BandLu, BandMatrix, SingularMatrix};
use crate::system::{Residual, State, System, inactive};
use crate::tangent::Tangent;

/// Factors of the tangent, with a condition in its missing row.
#[derive(Clone, Debug)]
pub(crate) struct TangentSolver {
    blocks: Option<InBlocks>,
    band: Option<InBand>,
    /// True if the block elimination holds the current factors.
    is_in_blocks: bool,
    /// True for each unknown of an inactive constraint.
    inactive: Vec<bool>,
}

#[derive(Clone, Debug, Default)]
struct InBlocks {
    elimination: BlockElimination,
    /// Flags of the unknowns that the matrix leaves out; empty before assembly.
    left_out: Vec<bool>,
    /// Values of the constant part of the matrix.
    constant: Vec<f64>,
}

#[derive(Clone, Debug)]
struct InBand {
    matrix: BandMatrix,
    /// Constant part of the matrix.
    constant: BandMatrix,
    lu: BandLu,
}

impl TangentSolver {
    pub(crate) fn new(system: &impl System) -> Self {
        Self {
            blocks: system.blocks().map(|_| InBlocks::default()),
            band: None,
            is_in_blocks: false,
            inactive: Vec::with_capacity(system.size()),
        }
    }

    /// Evaluates the equations and factorises the tangent.
    ///
    /// Leaves out the unknowns of inactive constraints and puts `condition` into the missing row.
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
            // A small pivot is not a failure yet: the band LU can exchange rows across blocks.
            self.is_in_blocks = in_blocks.elimination.factorise().is_ok();
        }
        if self.is_in_blocks {
            return Ok(());
        }
        // Allocate the band matrix on first use: most paths never need it.
        let InBand { matrix, constant, lu } = self.band.get_or_insert_with(|| InBand::new(system));
        matrix.set(constant);
        assemble(system, state, condition, residual, matrix);
        lu.factorise(matrix, &self.inactive)
    }

    /// Solves in place: `x` holds the right-hand side, then the solution.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        match (&mut self.blocks, &mut self.band) {
            (Some(blocks), _) if self.is_in_blocks => blocks.elimination.solve(x),
            (_, Some(band)) => band.lu.solve(x),
            // Nothing has been factorised yet.
            _ => x.fill(f64::NAN),
        }
    }

    /// Returns true if the determinant of the last tangent is negative.
    pub(crate) fn is_negative(&self) -> bool {
        match (&self.blocks, &self.band) {
            (Some(blocks), _) if self.is_in_blocks => blocks.elimination.negative_blocks() % 2 == 1,
            (_, Some(band)) => band.lu.is_negative(),
            _ => false,
        }
    }

    /// Solves for a right-hand side of `size` entries, 1 at the load and else 0.
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

/// Evaluates the equations and adds the tangent to `matrix`.
///
/// `matrix` already holds its constant part. Puts `condition` into the row of the load, in which
/// the system has no entries.
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
    /// Resets the matrix to its constant part, without the `inactive` unknowns.
    fn begin(&mut self, system: &impl System, blocks: &Blocks, inactive: &[bool]) {
        // Between events the shape is unchanged, so copy the constant part instead of assembling
        // it.
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
    fn new(system: &impl System) -> Self {
        let (size, half) = (system.size(), system.half_bandwidth());
        let mut constant = BandMatrix::new(size, half);
        system.constant_tangent(&mut constant);
        Self { matrix: BandMatrix::new(size, half), constant, lu: BandLu::new(size, half) }
    }
}

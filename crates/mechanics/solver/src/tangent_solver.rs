//! Factors of the tangent of a system: block by block where that is possible, of a band matrix elsewhere.

use crate::block_elimination::BlockElimination;
use crate::block_matrix::Blocks;
use crate::linear::{BandLu, BandMatrix, SingularMatrix};
use crate::system::{Residual, State, System, inactive};
use crate::tangent::Tangent;

/// Factors of the tangent, with the row of a condition in the place of the missing one.
#[derive(Clone, Debug)]
pub(crate) struct TangentSolver {
    blocks: Option<InBlocks>,
    band: Option<InBand>,
    /// Whether the factors are those of the blocks.
    is_in_blocks: bool,
    /// Whether each unknown is that of an inactive constraint.
    inactive: Vec<bool>,
}

#[derive(Clone, Debug, Default)]
struct InBlocks {
    elimination: BlockElimination,
    /// Whether the matrix leaves out each unknown; empty before the first.
    left_out: Vec<bool>,
    /// The values of the constant part of the matrix.
    constant: Vec<f64>,
}

#[derive(Clone, Debug)]
struct InBand {
    matrix: BandMatrix,
    /// The constant part of the matrix.
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
        self.inactive.resize(system.size(), false);
        inactive(system, state).for_each(|unknown| self.inactive[unknown] = true);
        self.is_in_blocks = false;
        let blocks = system.blocks().filter(|_| system.is_in_blocks(state));
        if let (Some(in_blocks), Some(blocks)) = (&mut self.blocks, blocks) {
            in_blocks.begin(system, blocks, &self.inactive);
            assemble(system, state, condition, residual, &mut in_blocks.elimination.matrix);
            // A pivot that is too small is no failure yet: the band may exchange rows across blocks.
            self.is_in_blocks = in_blocks.elimination.factorise().is_ok();
        }
        if self.is_in_blocks {
            return Ok(());
        }
        // Made when first needed: most paths never leave the blocks.
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
            // Nothing has been factorised.
            _ => x.fill(f64::NAN),
        }
    }

    /// Whether the determinant of the last tangent is negative.
    pub(crate) fn is_negative(&self) -> bool {
        match (&self.blocks, &self.band) {
            (Some(blocks), _) if self.is_in_blocks => blocks.elimination.negative_blocks() % 2 == 1,
            (_, Some(band)) => band.lu.is_negative(),
            _ => false,
        }
    }

    /// The solution for a right-hand side of `size` entries of which that of the load alone is not zero: it is 1.
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

/// Evaluates the equations, and adds the tangent to a `matrix` that holds its constant part, with `condition` in its missing row, in which
/// the system has nothing.
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
    /// Gives the matrix its constant part alone, without the unknowns that are `inactive`.
    fn begin(&mut self, system: &impl System, blocks: &Blocks, inactive: &[bool]) {
        // Between events the shape stays, and the constant part is one copy instead of an assembly.
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

//! Solves a design again with full coupling of the substrate.

use results::columns::{design_columns, name};
use serde::Serialize;
use substrate::Coupling;
use sweep::{Case, Sweep};

use crate::gap_change::{Patience, again, evaluator_of};

/// Measures of a design with nearest-neighbour and with full coupling.
///
/// Nearest-neighbour coupling is Eq. 1 of the paper.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CouplingChange {
    /// Number of the design.
    pub design: String,
    /// Measures, in the order of the requested columns.
    pub measures: Vec<CoupledMeasure>,
    /// True if the surface folds with full coupling only.
    pub folds: bool,
}

/// A measure of a design with both couplings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CoupledMeasure {
    /// Column name.
    pub column: String,
    /// Measure with nearest-neighbour coupling.
    pub nearest: f64,
    /// Measure with full coupling; `None` if there is no value.
    pub full: Option<f64>,
}

impl CouplingChange {
    /// Solves design `number` of `sweep` with both couplings.
    ///
    /// `columns` are the measures; columns without a number are omitted. Returns `None` if there is
    /// no such design, if its coupling is already full, if no measure changes, or if it takes
    /// longer than `patience`. Samples of imperfect rows are not solved.
    pub fn solve(
        sweep: &Sweep,
        number: &str,
        columns: &[&str],
        patience: Patience,
    ) -> Option<Self> {
        let couplings = [Coupling::Nearest, Coupling::Full];
        let change = |case: &mut Case, own| case.coupling = own;
        let evaluator = evaluator_of(sweep, &[columns, &[name::FOLD_FORCE]].concat());
        let (case, solved) = again(sweep, number, patience, &evaluator, couplings, change)?;
        (case.coupling == Coupling::Nearest).then_some(())?;
        let known = design_columns(sweep);
        let values = |wanted: &str| {
            let column = known.iter().find(|column| column.name == wanted)?;
            Some(solved.each_ref().map(|row| column.cell(row).number()))
        };
        let measure = |column: &&str| {
            let [nearest, full] = values(column)?;
            Some(CoupledMeasure { column: (*column).to_owned(), nearest: nearest?, full })
        };
        let folds = matches!(values(name::FOLD_FORCE), Some([None, Some(_)]));
        let measures: Vec<_> = columns.iter().filter_map(measure).collect();
        // Coverage, and bending without contact, do not depend on the substrate.
        let moves = folds || measures.iter().any(|measure| measure.full != Some(measure.nearest));
        moves.then(|| Self { design: number.to_owned(), measures, folds })
    }
}

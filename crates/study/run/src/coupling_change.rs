//! Solves a design again with full coupling of the substrate.

use results::columns::{design_columns, name};
use serde::Serialize;
use substrate::Coupling;
use sweep::Sweep;

use crate::gap_change::again;

/// The measures of a design with coupling to nearest neighbours (Eq. 1 of the paper), and with full
/// coupling of the substrate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CouplingChange {
    /// The number of the design.
    pub design: String,
    /// The measures, in the order of the columns that were asked for.
    pub measures: Vec<CoupledMeasure>,
    /// Whether the surface of the substrate folds over with the whole of it coupled, and does not otherwise.
    pub folds: bool,
}

/// One measure of a design with each coupling.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CoupledMeasure {
    /// The column of the measure.
    pub column: String,
    /// The measure with the nearest neighbours coupled.
    pub nearest: f64,
    /// The measure with the whole substrate coupled; `None` where it has no value.
    pub full: Option<f64>,
}

impl CouplingChange {
    /// The measures in `columns` of design `number` of `sweep`; columns without a number are left out. `None` if there is no such
    /// design, if it has the whole substrate coupled already, if nothing moves, or if solving it again would take long. Samples of imperfect rows
    /// are not solved.
    pub fn solve(sweep: &Sweep, number: &str, columns: &[&str]) -> Option<Self> {
        let couplings = [Coupling::Nearest, Coupling::Full];
        let (case, solved) = again(sweep, number, couplings, |case, own| case.coupling = own)?;
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
        // Coverage, and bending before scales touch, do not depend on the tissue.
        let moves = folds || measures.iter().any(|measure| measure.full != Some(measure.nearest));
        moves.then(|| Self { design: number.to_owned(), measures, folds })
    }
}

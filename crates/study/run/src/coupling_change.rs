//! Effect of the substrate's coupling: solves a design again with full coupling.

use results::columns::{design_columns, name};
use serde::Serialize;
use substrate::Coupling;
use sweep::{Case, Sweep};

use crate::gap_change::{Patience, case_to_solve, evaluator_of, value};

/// Measures of a design with nearest-neighbour coupling and with full coupling.
///
/// Nearest-neighbour coupling is Eq. (1) of Shafiei et al. (2021).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CouplingChange {
    /// Number of the design.
    pub design: String,
    /// Values of the measures, in the order of the requested columns.
    pub measures: Vec<CoupledMeasure>,
    /// True if the surface of the substrate folds only with full coupling.
    pub folds: bool,
}

/// Value of one measure with nearest-neighbour coupling and with full coupling.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CoupledMeasure {
    /// Name of the column in `designs.csv`.
    pub column: String,
    /// Value with nearest-neighbour coupling.
    pub nearest: f64,
    /// Value with full coupling; `None` if the path has no value.
    pub full: Option<f64>,
}

impl CouplingChange {
    /// Solves design `number` of `sweep` with both couplings.
    ///
    /// `columns` are the measures; columns without a number are omitted. Returns `None` if there is
    /// no such design, if its coupling is full already, if no measure depends on the coupling, or
    /// if its solution takes longer than `patience`. Scatter of gaps and slants is ignored.
    pub fn solve(
        sweep: &Sweep,
        number: &str,
        columns: &[&str],
        patience: Patience,
    ) -> Option<Self> {
        let (design, case) = case_to_solve(sweep, number, patience)?;
        (case.coupling == Coupling::Nearest).then_some(())?;
        let evaluator = evaluator_of(sweep, &[columns, &[name::FOLD_FORCE]].concat());
        let coupled = Case { coupling: Coupling::Full, ..case };
        let rows = [case, coupled].map(|case| evaluator.row(design, &case));
        let known = design_columns(sweep);
        let values = |name: &str| rows.each_ref().map(|row| value(&known, name, row));
        let measure = |column: &&str| {
            let [nearest, full] = values(column);
            Some(CoupledMeasure { column: (*column).to_owned(), nearest: nearest?, full })
        };
        let folds = matches!(values(name::FOLD_FORCE), [None, Some(_)]);
        let measures: Vec<_> = columns.iter().filter_map(measure).collect();
        // Coverage, and bending without contact, do not depend on the coupling.
        let changes = folds || measures.iter().any(|measure| measure.full != Some(measure.nearest));
        changes.then(|| Self { design: number.to_owned(), measures, folds })
    }
}

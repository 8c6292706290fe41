//! Solves a design again with smaller and larger gaps.

use results::columns::{design_columns, measure_of};
use results::{Column, DesignRow};
use serde::{Serialize, Serializer};
use skin::Imperfection;
use sweep::{Case, DesignNumber, Sweep};

use crate::solve::evaluator::Evaluator;
use crate::solve::work::work_of;

/// Factors on the gap of a design.
// Both directions, because a cliff may be on either side.
const FACTORS: [f64; 2] = [0.9, 1.1];

/// Ratio of a measure that counts as a cliff if the gap changes by 10 %.
///
/// The inverse ratio counts too.
const CLIFF: f64 = 1.5;

/// Maximum number of paths per design, so that users do not have to wait.
const MOST_WORK: u64 = 500;

/// Limit on the time to solve a design with a changed gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Patience {
    /// Designs that take longer are not solved, because users wait, for example for a ranking.
    Milliseconds,
    /// Every design is solved, as after a search, which has solved hundreds of designs like it.
    Unlimited,
}

/// Measures of a design with a gap 10 % smaller and 10 % larger.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GapChange {
    /// Number of the design.
    pub design: String,
    /// Nominal gap over the thickness.
    #[serde(rename = "gap_over_t")]
    pub gap: f64,
    /// Measures, in the order of the requested columns.
    pub measures: Vec<MeasureChange>,
}

/// A measure of a design with a gap 10 % smaller and 10 % larger.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeasureChange {
    /// Column name.
    pub column: String,
    /// Measure of the nominal design.
    pub value: f64,
    /// Measures with the smaller and the larger gap; `None` if there is no value.
    #[serde(flatten, serialize_with = "by_side")]
    pub changed: [Option<f64>; 2],
}

/// Serializes the values with the keys `gap_10_percent_smaller` and `gap_10_percent_larger`.
fn by_side<S: Serializer>(changed: &[Option<f64>; 2], serializer: S) -> Result<S::Ok, S::Error> {
    let names = ["gap_10_percent_smaller", "gap_10_percent_larger"];
    serializer.collect_map(names.into_iter().zip(changed))
}

impl MeasureChange {
    /// Returns whether the smaller and the larger gap are beyond a cliff.
    ///
    /// A measure that is zero or changes its sign has no ratio, and hence no cliff.
    pub fn cliffs(&self) -> [bool; 2] {
        self.changed.map(|changed| {
            let ratio = changed.map_or(1.0, |changed| changed / self.value);
            ratio.is_finite() && ratio > 0.0 && ratio.max(ratio.recip()) >= CLIFF
        })
    }
}

impl GapChange {
    /// Solves design `number` of `sweep` with both gaps.
    ///
    /// `columns` are the measures; columns without a number are omitted. Returns `None` if there is
    /// no such design, or if it takes longer than `patience`. Samples of imperfect rows are not
    /// solved.
    pub fn solve(
        sweep: &Sweep,
        number: &str,
        columns: &[&str],
        patience: Patience,
    ) -> Option<Self> {
        let (own, case) = case_to_solve(sweep, number, patience)?;
        let row = evaluator_of(sweep, columns).row(own, &case);
        let known = design_columns(sweep);
        let values = columns.iter().filter_map(|&name| Some((name, value(&known, name, &row)?)));
        Self::beside(sweep, number, &values.collect::<Vec<_>>(), patience)
    }

    /// Solves design `number` of `sweep` with the changed gaps only.
    ///
    /// `measured` holds the columns and values of the design itself, as tables hold them; see
    /// [`Self::solve`].
    pub fn beside(
        sweep: &Sweep,
        number: &str,
        measured: &[(&str, f64)],
        patience: Patience,
    ) -> Option<Self> {
        let (own, case) = case_to_solve(sweep, number, patience)?;
        let columns: Vec<&str> = measured.iter().map(|(column, _)| *column).collect();
        let evaluator = evaluator_of(sweep, &columns);
        let rows = FACTORS.map(|part| {
            let mut case = case;
            case.design.gap *= part;
            evaluator.row(own, &case)
        });
        let known = design_columns(sweep);
        let measures = measured.iter().map(|&(name, nominal)| MeasureChange {
            column: name.to_owned(),
            value: nominal,
            changed: rows.each_ref().map(|row| value(&known, name, row)),
        });
        let (design, gap) = (number.to_owned(), case.design.gap);
        Some(Self { design, gap, measures: measures.collect() })
    }
}

/// Returns the number in a column of a design; `None` without such a column or number.
pub(crate) fn value(known: &[Column<DesignRow>], name: &str, row: &DesignRow) -> Option<f64> {
    known.iter().find(|column| column.name == name)?.cell(row).number()
}

/// Returns an evaluator of the measures of `sweep` that `columns` need.
pub(crate) fn evaluator_of(sweep: &Sweep, columns: &[&str]) -> Evaluator {
    let mut measures = sweep.plain_measures();
    // Some columns, such as those at further tilts, belong to no measure by their name. They keep
    // all measures.
    measures.retain(|measure| {
        columns.iter().any(|column| measure_of(column).is_none_or(|own| own == *measure))
    });
    Evaluator::only_columns(&measures, columns)
}

/// Solves design `number` of `sweep`, without imperfect samples.
///
/// Returns `None` if the design does not exist or takes longer than `patience`.
pub fn solved_row(sweep: &Sweep, number: &str, patience: Patience) -> Option<DesignRow> {
    let (own, case) = case_to_solve(sweep, number, patience)?;
    Some(Evaluator::new(&sweep.plain_measures()).row(own, &case))
}

/// Returns design `number` of `sweep` without scatter, to be solved again with changes.
///
/// Random samples would take hundreds of paths, and hide cliffs of the nominal design. Returns
/// `None` if the design does not exist or takes longer than `patience`.
pub(crate) fn case_to_solve(
    sweep: &Sweep,
    number: &str,
    patience: Patience,
) -> Option<(DesignNumber, Case)> {
    let grid = sweep.grid();
    let index = grid.parse_number(number).ok()?;
    let case = Case { imperfection: Imperfection::default(), ..grid.case(index) };
    let accepted = patience == Patience::Unlimited || is_quick(sweep, &case);
    accepted.then(|| (grid.number(index), case))
}

/// Returns true if a design takes milliseconds.
///
/// Boundary elements of a layer take longer.
pub(crate) fn is_quick(sweep: &Sweep, case: &Case) -> bool {
    case.tissue_thickness.is_none() && work_of(case, sweep.measures()) <= MOST_WORK
}

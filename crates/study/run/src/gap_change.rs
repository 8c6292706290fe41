//! Sensitivity of a design to its gap: solves it again with a smaller and a larger gap.

use results::columns::{design_columns, measure_of};
use results::{Column, DesignRow};
use serde::{Serialize, Serializer};
use skin::Imperfection;
use skin::puncture::PunctureEnd;
use sweep::{Case, DesignNumber, Sweep};

use crate::solve::evaluator::Evaluator;
use crate::solve::work::work_of;

/// Factors by which the gap of a design is multiplied.
// Both directions, because a measure may jump in either direction.
const FACTORS: [f64; 2] = [0.9, 1.1];

/// Smallest ratio of a measure to its nominal value that counts as a cliff (large sensitivity).
///
/// The gap changes by 10 %. The inverse of this ratio counts, too.
const CLIFF: f64 = 1.5;

/// Largest work of a design, in paths, that counts as quick: users wait for the result.
const MOST_WORK: u64 = 500;

/// Limit on the time for solving one design again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Patience {
    /// Only designs that take milliseconds are solved, because users wait, e.g. for a ranking.
    Milliseconds,
    /// Every design is solved, e.g. after a search, which has solved hundreds of similar designs.
    Unlimited,
}

/// Measures of a design with a gap 10 % smaller and 10 % larger.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GapChange {
    /// Number of the design.
    pub design: String,
    /// Nominal gap divided by the thickness of a scale.
    #[serde(rename = "gap_over_t")]
    pub gap: f64,
    /// Changes of measures, in the order of the requested columns.
    pub measures: Vec<MeasureChange>,
}

/// Value of one measure with the nominal gap and with a gap 10 % smaller and 10 % larger.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeasureChange {
    /// Name of the column in `designs.csv`.
    pub column: String,
    /// Value with the nominal gap.
    pub value: f64,
    /// Values with the smaller and with the larger gap; `None` for a path without this value.
    #[serde(flatten, serialize_with = "by_side")]
    pub changed: [Option<f64>; 2],
}

/// Serializes both values with the keys `gap_10_percent_smaller` and `gap_10_percent_larger`.
fn by_side<S: Serializer>(changed: &[Option<f64>; 2], serializer: S) -> Result<S::Ok, S::Error> {
    let names = ["gap_10_percent_smaller", "gap_10_percent_larger"];
    serializer.collect_map(names.into_iter().zip(changed))
}

impl MeasureChange {
    /// Returns, for the smaller and for the larger gap, true if the measure changes by a cliff.
    ///
    /// A measure that is zero or changes its sign has no ratio and therefore no cliff.
    pub fn cliffs(&self) -> [bool; 2] {
        self.changed.map(|changed| {
            let ratio = changed.map_or(1.0, |changed| changed / self.value);
            ratio.is_finite() && ratio > 0.0 && ratio.max(ratio.recip()) >= CLIFF
        })
    }
}

impl GapChange {
    /// Solves design `number` of `sweep` with the nominal, the smaller and the larger gap.
    ///
    /// `columns` are the measures; columns without a number are omitted. Returns `None` if there is
    /// no such design, or if its solution takes longer than `patience`. Scatter of gaps and slants
    /// is ignored.
    pub fn solve(
        sweep: &Sweep,
        number: &str,
        columns: &[&str],
        patience: Patience,
    ) -> Option<Self> {
        let (design, case) = case_to_solve(sweep, number, patience)?;
        let (row, end) = evaluator_of(sweep, columns).row_and_end(design, &case, None);
        let known = design_columns(sweep);
        let values = columns.iter().filter_map(|&name| Some((name, value(&known, name, &row)?)));
        Self::beside(sweep, number, &values.collect::<Vec<_>>(), end.as_ref(), patience)
    }

    /// Solves design `number` of `sweep` with the smaller and the larger gap only.
    ///
    /// `end` is the path end of the nominal puncture. The punctures with changed gaps start from
    /// this end if possible. With `None` they are followed from rest.
    ///
    /// `measured` holds columns and values of the nominal design, for example from a table. Returns
    /// `None` under the same conditions as [`Self::solve`].
    pub fn beside(
        sweep: &Sweep,
        number: &str,
        measured: &[(&str, f64)],
        end: Option<&PunctureEnd>,
        patience: Patience,
    ) -> Option<Self> {
        let (solved, case) = case_to_solve(sweep, number, patience)?;
        let columns: Vec<&str> = measured.iter().map(|(column, _)| *column).collect();
        let evaluator = evaluator_of(sweep, &columns);
        let rows = FACTORS.map(|factor| {
            let mut case = case;
            case.design.gap *= factor;
            let end = end.filter(|_| evaluator.has_ends(&case));
            let near = end.and_then(|end| evaluator.row_near(solved, &case, &[], end));
            near.unwrap_or_else(|| evaluator.row(solved, &case))
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

/// Returns the number in a column of a design, or `None` without such a column or number.
pub(crate) fn value(known: &[Column<DesignRow>], name: &str, row: &DesignRow) -> Option<f64> {
    known.iter().find(|column| column.name == name)?.cell(row).number()
}

/// Returns an evaluator that computes the measures of `sweep` to which `columns` belong.
pub(crate) fn evaluator_of(sweep: &Sweep, columns: &[&str]) -> Evaluator {
    let mut measures = sweep.plain_measures();
    // A few columns, such as columns at further tilts, do not show their measure in their name. For
    // these columns all measures are computed.
    measures.retain(|measure| {
        columns.iter().any(|column| measure_of(column).is_none_or(|other| other == *measure))
    });
    Evaluator::only_columns(&measures, columns)
}

/// Solves design `number` of `sweep` without scatter of gaps and slants.
///
/// Returns `None` if the design does not exist or takes longer than `patience`.
pub fn solved_row(sweep: &Sweep, number: &str, patience: Patience) -> Option<DesignRow> {
    let (design, case) = case_to_solve(sweep, number, patience)?;
    Some(Evaluator::new(&sweep.plain_measures()).row(design, &case))
}

/// Returns number and case of design `number` of `sweep`, without scatter of gaps and slants.
///
/// Random samples would need hundreds of paths and would hide cliffs of the nominal design. Returns
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

/// Returns true if a design can be solved within milliseconds.
///
/// A design on a layer of finite thickness takes longer, because the layer needs boundary elements.
pub(crate) fn is_quick(sweep: &Sweep, case: &Case) -> bool {
    case.tissue_thickness.is_none() && work_of(case, sweep.measures()) <= MOST_WORK
}

//! Smallest force of a design over several load positions, with full coupling of the substrate.

use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use results::columns::{design_columns, is_invalid_after_fold, mode_column, name};
use results::{Column, DesignRow, Outcome, Quantity};
use serde::Serialize;
use skin::Status;
use substrate::Coupling;
use sweep::{Case, Sweep};

use crate::gap_change::{Patience, case_to_solve, value};
use crate::solve::evaluator::Evaluator;

/// Number of load positions on the top of a scale that are compared.
pub const PLACES: usize = 11;

/// Force of a design at its weakest load position, with full coupling of the substrate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WeakestPlace {
    /// Name of the column of the force in `designs.csv`.
    pub column: String,
    /// Force at the requested load position, with the coupling in the definition.
    pub requested: f64,
    /// Smallest force over [`PLACES`] load positions.
    ///
    /// `None` if a path ended at a load below the smallest force, which is then not certain.
    pub weakest: Option<f64>,
    /// Load position of the smallest force, or of the path that ended early.
    ///
    /// 0 is the left corner of the top, 1 the right corner.
    #[serde(rename = "place")]
    pub load_position: f64,
    /// Status of the path at `load_position`.
    pub outcome: Outcome,
    /// Name of the first failure at the weakest position, if `column` is a failure force.
    pub failure: Option<String>,
}

impl WeakestPlace {
    /// Solves design `number` of `sweep` at the requested load position and at [`PLACES`]
    /// positions.
    ///
    /// `columns` are columns of `designs.csv`. The result omits columns without a number, columns
    /// that are not puncture forces, and `weakest_force` if it already compares as many positions.
    /// The result is empty if there is no such design, or if the needle is free: a free needle acts
    /// on a fixed corner.
    pub fn solve(sweep: &Sweep, number: &str, columns: &[&str]) -> Vec<Self> {
        let Some((design, case)) = case_to_solve(sweep, number, Patience::Unlimited) else {
            return Vec::new();
        };
        if !case.punctured().needle.is_guided() {
            return Vec::new();
        }
        let evaluator = Evaluator::new(&sweep.plain_measures());
        let mut rows: Vec<_> = [vec![case], coupled_cases(&case)]
            .concat()
            .par_iter()
            .map(|case| evaluator.row(design, case))
            .collect();
        let coupled = rows.split_off(1);
        let requested = &rows[0];
        let known = design_columns(sweep);
        columns.iter().filter_map(|column| weakest(column, requested, &coupled, &known)).collect()
    }
}

/// Returns the cases of a design with full coupling.
///
/// The first case has the requested load position. The other [`PLACES`] cases have one of the
/// compared positions each.
fn coupled_cases(case: &Case) -> Vec<Case> {
    let mut coupled = Case { coupling: Coupling::Full, ..*case };
    coupled.puncture.places = None;
    // Each position is a separate case, because `puncture.places` does not locate failures. The
    // row across does not depend on these positions and is solved only with the first case.
    let mut placed = Case { across: false, gap_across: None, load_inset: None, ..coupled };
    let positions = case.punctured().positions(PLACES, &case.design);
    let placed = positions.into_iter().map(|position| {
        placed.puncture.load_position = position;
        placed
    });
    std::iter::once(coupled).chain(placed).collect()
}

/// Returns the column to compare between positions: for the weakest force, the critical force.
fn position_column(column: &str) -> Option<String> {
    let stem = column.strip_suffix("_N").unwrap_or(column);
    let suffix = &column[stem.len()..];
    match stem {
        name::CRITICAL_FORCE | name::SOUND_FORCE | name::FAILURE_FORCE => Some(column.to_owned()),
        name::WEAKEST_FORCE => Some(format!("{}{suffix}", name::CRITICAL_FORCE)),
        _ => None,
    }
}

/// Finds the smallest force of `column` over `positions`.
///
/// Returns `None` if `column` is not compared between load positions.
fn weakest(
    column: &str,
    requested: &DesignRow,
    positions: &[DesignRow],
    known: &[Column<DesignRow>],
) -> Option<WeakestPlace> {
    let nominal = value(known, column, requested)?;
    let single = position_column(column)?;
    let has_all = requested.case.puncture.places.is_some_and(|places| places >= PLACES);
    if single != column && has_all {
        return None;
    }
    let force = named(known, &single)?;
    let mut weakest: Option<(f64, &DesignRow)> = None;
    let mut ended: Option<(f64, &DesignRow)> = None;
    for row in positions {
        // If the surface folds with full coupling only, the force is not valid.
        let is_folded = is_invalid_after_fold(column) && folds(row) && !folds(requested);
        match force.cell(row).number().filter(|_| !is_folded) {
            Some(force) => keep_smaller(&mut weakest, force, row),
            None => {
                if let Some(largest) = largest_before_end(row, column) {
                    keep_smaller(&mut ended, largest, row);
                }
            }
        }
    }
    // If a path ended below the smallest force, the skin may be weaker at that position.
    let is_unknown =
        ended.is_some_and(|(largest, _)| weakest.is_none_or(|(force, _)| largest < force));
    let (force, row) = if is_unknown { ended } else { weakest }?;
    let mode = mode_column(column);
    Some(WeakestPlace {
        column: column.to_owned(),
        requested: nominal,
        weakest: (!is_unknown).then_some(force),
        load_position: row.case.punctured().load_position,
        outcome: row.result.puncture?.outcome,
        failure: mode
            .filter(|_| !is_unknown)
            .and_then(|mode| Some(named(known, mode)?.cell(row).to_string())),
    })
}

fn named<'a>(known: &'a [Column<DesignRow>], name: &str) -> Option<&'a Column<DesignRow>> {
    known.iter().find(|column| column.name == name)
}

fn folds(row: &DesignRow) -> bool {
    row.result.puncture.is_some_and(|puncture| puncture.measures.fold_force.is_some())
}

/// Replaces `kept` if `force` is smaller; of equal forces the first is kept.
fn keep_smaller<'a>(kept: &mut Option<(f64, &'a DesignRow)>, force: f64, row: &'a DesignRow) {
    if kept.is_none_or(|(smallest, _)| force < smallest) {
        *kept = Some((force, row));
    }
}

/// Returns the largest force on a path that ended early, in the unit of `column`.
///
/// Returns `None` if the load tilts no scale, because the position is then not a weak one.
fn largest_before_end(row: &DesignRow, column: &str) -> Option<f64> {
    let puncture = row.result.puncture?;
    let tilts_nothing = puncture.outcome == Status::Untilted.into() && puncture.points == 1;
    let force = puncture.measures.peak_force.unwrap_or_default();
    let in_units = if column.ends_with("_N") {
        Quantity::Force.physical(force, &row.case)
    } else {
        Some(force)
    };
    in_units.filter(|_| !tilts_nothing)
}

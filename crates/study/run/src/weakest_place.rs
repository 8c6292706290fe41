//! Solves a design again at more load positions, with full coupling of the substrate.

use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use results::columns::{design_columns, is_invalid_after_fold, mode_column, name};
use results::{Column, DesignRow, Outcome, Quantity};
use serde::Serialize;
use skin::Status;
use substrate::Coupling;
use sweep::{Case, Sweep};

use crate::gap_change::{Patience, case_to_solve, value};
use crate::solve::evaluator::Evaluator;

/// Number of load positions on the top of a scale.
pub const PLACES: usize = 11;

/// A force of a design at its weakest load position, with full coupling of the substrate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WeakestPlace {
    /// Column of the force.
    pub column: String,
    /// Force at the requested position, with the coupling of the design.
    pub requested: f64,
    /// Smallest force over [`PLACES`] positions.
    ///
    /// `None` if a path ended before it was reached.
    pub weakest: Option<f64>,
    /// Weakest position, or the position at which the path ended early.
    ///
    /// 0 is the left corner of the top, 1 the right corner.
    pub place: f64,
    /// How the path at that position ended.
    pub outcome: Outcome,
    /// First failure at the weakest position, for a failure force.
    pub failure: Option<String>,
}

impl WeakestPlace {
    /// Solves design `number` of `sweep` at [`PLACES`] load positions and at the requested one.
    ///
    /// `columns` are columns of `sweep`. Columns are omitted if they have no number, are not a
    /// puncture force, or compare as many positions already. Returns an empty list if there is no
    /// such design, or if its needle is not guided: a dead load is attached to its corner.
    pub fn solve(sweep: &Sweep, number: &str, columns: &[&str]) -> Vec<Self> {
        let Some((own, case)) = case_to_solve(sweep, number, Patience::Unlimited) else {
            return Vec::new();
        };
        if !case.punctured().needle.is_guided() {
            return Vec::new();
        }
        let evaluator = Evaluator::new(&sweep.plain_measures());
        let mut rows: Vec<_> = [vec![case], coupled_cases(&case)]
            .concat()
            .par_iter()
            .map(|case| evaluator.row(own, case))
            .collect();
        let coupled = rows.split_off(1);
        let requested = &rows[0];
        let known = design_columns(sweep);
        columns.iter().filter_map(|column| weakest(column, requested, &coupled, &known)).collect()
    }
}

/// Returns a design with full coupling at several load positions.
///
/// The requested position comes first, then [`PLACES`] positions.
fn coupled_cases(case: &Case) -> Vec<Case> {
    let mut coupled = Case { coupling: Coupling::Full, ..*case };
    coupled.puncture.places = None;
    // `puncture.places` locates no failures, so solve each position as a separate design. The row
    // across has no such positions: it is compared once, with the requested design.
    let mut placed = Case { across: false, gap_across: None, load_inset: None, ..coupled };
    let positions = case.punctured().positions(PLACES, &case.design);
    let placed = positions.into_iter().map(|position| {
        placed.puncture.load_position = position;
        placed
    });
    std::iter::once(coupled).chain(placed).collect()
}

/// Returns the column of a single load position; the minimum over the positions is compared.
fn position_column(column: &str) -> Option<String> {
    let stem = column.strip_suffix("_N").unwrap_or(column);
    let suffix = &column[stem.len()..];
    match stem {
        name::CRITICAL_FORCE | name::SOUND_FORCE | name::FAILURE_FORCE => Some(column.to_owned()),
        name::WEAKEST_FORCE => Some(format!("{}{suffix}", name::CRITICAL_FORCE)),
        _ => None,
    }
}

/// Selects the smallest force over the rows of several load positions.
fn weakest(
    column: &str,
    requested: &DesignRow,
    positions: &[DesignRow],
    known: &[Column<DesignRow>],
) -> Option<WeakestPlace> {
    let asked = value(known, column, requested)?;
    let single = position_column(column)?;
    let has_all = requested.case.puncture.places.is_some_and(|places| places >= PLACES);
    if single != column && has_all {
        return None;
    }
    let force = named(known, &single)?;
    let mut weakest: Option<(f64, &DesignRow)> = None;
    let mut ended: Option<(f64, &DesignRow)> = None;
    for row in positions {
        // The surface folds with full coupling only, so the force is not valid.
        let is_folded = is_invalid_after_fold(column) && folds(row) && !folds(requested);
        match force.cell(row).number().filter(|_| !is_folded) {
            Some(force) => keep_smaller(&mut weakest, force, row),
            None => {
                if let Some(borne) = borne_before_end(row, column) {
                    keep_smaller(&mut ended, borne, row);
                }
            }
        }
    }
    // The skin may be weaker where a path ended early.
    let is_open = ended.is_some_and(|(borne, _)| weakest.is_none_or(|(force, _)| borne < force));
    let (force, row) = if is_open { ended } else { weakest }?;
    let mode = mode_column(column);
    Some(WeakestPlace {
        column: column.to_owned(),
        requested: asked,
        weakest: (!is_open).then_some(force),
        place: row.case.punctured().load_position,
        outcome: row.result.puncture?.outcome,
        failure: mode
            .filter(|_| !is_open)
            .and_then(|mode| Some(named(known, mode)?.cell(row).to_string())),
    })
}

fn named<'a>(known: &'a [Column<DesignRow>], name: &str) -> Option<&'a Column<DesignRow>> {
    known.iter().find(|column| column.name == name)
}

fn folds(row: &DesignRow) -> bool {
    row.result.puncture.is_some_and(|puncture| puncture.measures.fold_force.is_some())
}

/// Keeps the row with the smaller force, or the first of equal ones.
fn keep_smaller<'a>(kept: &mut Option<(f64, &'a DesignRow)>, force: f64, row: &'a DesignRow) {
    if kept.is_none_or(|(smallest, _)| force < smallest) {
        *kept = Some((force, row));
    }
}

/// Returns the largest force of a path that ended early.
///
/// `None` if the load tilts no scale at all.
fn borne_before_end(row: &DesignRow, column: &str) -> Option<f64> {
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

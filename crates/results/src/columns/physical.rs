//! The columns in physical units, in runs with a material.

use sweep::Sweep;

use super::cell::Cell;
use super::column::Column;
use super::measured_value;
use super::measured_value::MeasuredValue;
use crate::design::row::DesignRow;
use crate::quantity::{MASS_NEEDS, Quantity, areal_mass};

/// A measured value in physical units.
struct PhysicalValue {
    name: &'static str,
    /// The dimensionless value that it is made from.
    of: &'static str,
    quantity: Quantity,
    /// The meaning, if it is not that of the dimensionless value.
    meaning: Option<&'static str>,
}

const fn same(name: &'static str, of: &'static str, quantity: Quantity) -> PhysicalValue {
    PhysicalValue { name, of, quantity, meaning: None }
}

const fn other(
    name: &'static str,
    of: &'static str,
    quantity: Quantity,
    meaning: &'static str,
) -> PhysicalValue {
    PhysicalValue { name, of, quantity, meaning: Some(meaning) }
}

use Quantity::{Force, ForcePerWidth, Length, Moment, Radius, Rigidity, Stiffness};

/// Every value, in the order of `designs.csv`.
static PHYSICAL_VALUES: &[PhysicalValue] = &[
    same("critical_force_N", "critical_force", Force),
    other(
        "critical_force_per_width_N_mm",
        "critical_force",
        ForcePerWidth,
        "puncture force at the critical tilt, over the width of the scales",
    ),
    same("penetration_mm", "penetration", Length),
    other(
        "flexural_rigidity_N_mm2",
        "compliance",
        Rigidity,
        "flexural rigidity: largest slope of the moment against the curvature",
    ),
    same("peak_force_N", "peak_force", Force),
    same("peak_displacement_mm", "peak_displacement", Length),
    same("load_stability_force_N", "load_stability_force", Force),
    same("depth_stability_force_N", "depth_stability_force", Force),
    same("fold_force_N", "fold_force", Force),
    same("fold_displacement_mm", "fold_displacement", Length),
    same("sound_force_N", "sound_force", Force),
    same("critical_displacement_mm", "critical_displacement", Length),
    same("sink_mm", "sink", Length),
    same("first_contact_displacement_mm", "first_contact_displacement", Length),
    same("initial_stiffness_N_mm", "initial_stiffness", Stiffness),
    same("max_stiffness_N_mm", "max_stiffness", Stiffness),
    same("secant_stiffness_N_mm", "secant_stiffness", Stiffness),
    other(
        "initial_flexural_rigidity_N_mm2",
        "initial_compliance",
        Rigidity,
        "flexural rigidity at rest",
    ),
    same("max_moment_N_mm", "max_moment", Moment),
    other(
        "bend_radius_mm",
        "contact_curvature",
        Radius,
        "smallest radius to which the skin bends before scales touch",
    ),
    same("critical_force_mean_N", "critical_force_mean", Force),
    same("critical_force_p05_N", "critical_force_p05", Force),
    same("critical_force_p50_N", "critical_force_p50", Force),
    same("critical_force_p95_N", "critical_force_p95", Force),
    same("penetration_mean_mm", "penetration_mean", Length),
    same("penetration_p05_mm", "penetration_p05", Length),
    same("penetration_p50_mm", "penetration_p50", Length),
    same("penetration_p95_mm", "penetration_p95", Length),
    other(
        "flexural_rigidity_p05_N_mm2",
        "compliance_p95",
        Rigidity,
        "5 % quantile of the flexural rigidity over the imperfect samples",
    ),
    other(
        "flexural_rigidity_p50_N_mm2",
        "compliance_p50",
        Rigidity,
        "median of the flexural rigidity over the imperfect samples",
    ),
    other(
        "flexural_rigidity_p95_N_mm2",
        "compliance_p05",
        Rigidity,
        "95 % quantile of the flexural rigidity over the imperfect samples",
    ),
];

/// The column of the mass of the scales, which needs no solution.
pub const AREAL_MASS: &str = "areal_mass_kg_m2";
const MASS_EXPLANATION: (&str, &str) = ("kg/m^2", "mass of the scales over the area of the skin");

impl PhysicalValue {
    /// The dimensionless value, if a run has it.
    fn source(&self) -> Option<&'static MeasuredValue> {
        measured_value(self.of)
    }

    fn meaning(&self) -> &'static str {
        self.meaning.or_else(|| Some(self.source()?.meaning)).unwrap_or_default()
    }

    fn cell(&self, row: &DesignRow) -> Cell {
        let dimensionless = self.source().map(|source| (source.cell)(row));
        let Some(Cell::Number(value)) = dimensionless else { return Cell::Empty };
        self.quantity.physical(value, &row.case).into()
    }
}

/// The columns in physical units of the designs of `sweep`, of the values that stand in `table`, or of all.
pub(super) fn physical_columns(sweep: &Sweep, table: Option<&str>) -> Vec<Column<DesignRow>> {
    let is_imperfect = sweep.is_imperfect();
    let belongs = |value: &PhysicalValue| {
        let source = value.source();
        let stands = source.is_some_and(|s| table.is_none_or(|table| s.tables.contains(&table)));
        let is_solved = is_imperfect || !source.is_some_and(MeasuredValue::is_of_samples);
        stands && is_solved && value.quantity.is_given(sweep)
    };
    let values = PHYSICAL_VALUES.iter().enumerate().filter(|(_, value)| belongs(value));
    let column = |(index, value): (usize, &PhysicalValue)| {
        let (name, unit) = (value.name.to_owned(), value.quantity.unit());
        Column::indexed(name, unit, value.meaning(), index, |row: &DesignRow, index| {
            PHYSICAL_VALUES[index].cell(row)
        })
    };
    let mut columns: Vec<_> = values.map(column).collect();
    let has_mass = table.is_none_or(|table| table == "coverage");
    if has_mass && MASS_NEEDS.iter().all(|key| sweep.gives(key)) {
        let (unit, meaning) = MASS_EXPLANATION;
        let mass = |row: &DesignRow| areal_mass(&row.case).into();
        columns.push(Column::new(AREAL_MASS, unit, meaning, mass));
    }
    columns
}

/// The dimensionless value that a column in physical units is made from, by its name, and how.
pub fn physical_source(name: &str) -> Option<(&'static str, Quantity)> {
    let value = PHYSICAL_VALUES.iter().find(|value| value.name == name)?;
    Some((value.of, value.quantity))
}

/// The unit of a value in physical units and what it is, by its name.
pub(super) fn explain_physical(name: &str) -> Option<(&'static str, &'static str)> {
    if name == AREAL_MASS {
        return Some(MASS_EXPLANATION);
    }
    let value = PHYSICAL_VALUES.iter().find(|value| value.name == name)?;
    Some((value.quantity.unit(), value.meaning()))
}

//! Columns derived from the entries of measured values.
//!
//! An entry gives a column for the value, columns for statistics over imperfect samples, and the
//! same columns in physical units.

use std::borrow::Cow;
use std::sync::LazyLock;

use sweep::Sweep;

use super::cell::Cell;
use super::column::Column;
use super::measured_value::{Goal, MeasuredValue, Physical, Value};
use super::values::VALUES;
use crate::design::design_result::DesignResult;
use crate::design::row::DesignRow;
use crate::design::sample_statistics::{QUANTILES, Statistics};
use crate::quantity::{MASS_NEEDS, Quantity, areal_mass};

/// A column derived from the entry of a measured value.
#[derive(Debug)]
pub struct ValueColumn {
    pub(super) value: &'static MeasuredValue,
    pub(super) quantity: Option<Quantity>,
    /// Index into [`STATISTICS`], for a statistic over imperfect samples.
    statistic: Option<usize>,
    pub(super) name: Cow<'static, str>,
    pub(super) unit: &'static str,
    pub(super) meaning: Cow<'static, str>,
}

/// Statistics over imperfect samples, in column order.
///
/// Each item holds the suffix of the column name and the description.
const STATISTICS: [(&str, &str); 4] = [
    ("mean", "mean"),
    (QUANTILES[0].0, "5 % quantile"),
    (QUANTILES[1].0, "median"),
    (QUANTILES[2].0, "95 % quantile"),
];

/// Every column of measured values, in the order of `designs.csv`.
///
/// Measure tables move their leading value to the front.
pub(super) static COLUMNS: LazyLock<Vec<ValueColumn>> = LazyLock::new(|| {
    let mut columns: Vec<_> =
        VALUES.iter().filter(|value| value.is_nominal()).map(value_column).collect();
    columns.extend(VALUES.iter().flat_map(statistics_columns));
    columns.extend(in_physical_units());
    columns
});

/// Returns the column of the dimensionless value itself.
fn value_column(value: &'static MeasuredValue) -> ValueColumn {
    let (name, meaning) = (value.name.into(), value.meaning.into());
    ValueColumn { value, quantity: None, statistic: None, name, unit: value.unit, meaning }
}

/// Returns the columns of the statistics of a value, or of a sample count.
fn statistics_columns(value: &'static MeasuredValue) -> Vec<ValueColumn> {
    let statistics = value.samples.iter().flat_map(|samples| {
        STATISTICS.iter().enumerate().map(|(k, (ending, words))| ValueColumn {
            statistic: Some(k),
            name: format!("{}_{ending}", value.name).into(),
            meaning: format!("{words} of the {} over the imperfect samples", samples.noun).into(),
            ..value_column(value)
        })
    });
    let count = matches!(value.value, Value::Samples(_)).then(|| value_column(value));
    count.into_iter().chain(statistics).collect()
}

/// Returns the columns in physical units.
///
/// The order is leading values, limits of the skin, other values, statistics, areal mass.
fn in_physical_units() -> impl Iterator<Item = ValueColumn> {
    let mut values: Vec<_> = VALUES.iter().collect();
    // Stable sort: each of the three groups keeps the order of `designs.csv`.
    values.sort_by_key(|value| {
        if value.names_a_table() { 0 } else { 2 - usize::from(value.point.is_limit()) }
    });
    let nominal = |value: &&'static MeasuredValue| -> Vec<_> {
        value.physical.iter().map(|physical| physical_column(value, physical)).collect()
    };
    let sampled = VALUES.iter().filter(|value| value.samples.is_some());
    let sampled = sampled.filter_map(|value| Some((value, value.physical.first()?)));
    let mass =
        VALUES.iter().filter(|value| matches!(value.value, Value::ArealMass)).map(value_column);
    let nominal: Vec<_> = values.iter().flat_map(nominal).collect();
    nominal.into_iter().chain(sampled.flat_map(|(v, p)| physical_statistics(v, p))).chain(mass)
}

fn physical_column(value: &'static MeasuredValue, physical: &Physical) -> ValueColumn {
    let Physical { quantity, other } = *physical;
    let (stem, meaning) = other.unwrap_or((value.name, value.meaning));
    let name = format!("{stem}_{}", quantity.suffix()).into();
    ValueColumn {
        quantity: Some(quantity),
        name,
        unit: quantity.unit(),
        meaning: meaning.into(),
        ..value_column(value)
    }
}

/// Returns the statistics of a value in physical units.
///
/// For an inverse quantity, the 5 % quantile is computed from the 95 % quantile of the value, and
/// the 95 % quantile from the 5 % quantile. The mean is omitted, because the mean of an inverse is
/// not the inverse of the mean.
fn physical_statistics(
    value: &'static MeasuredValue,
    Physical { quantity, other }: &'static Physical,
) -> impl Iterator<Item = ValueColumn> {
    let inverse = quantity.is_inverse();
    statistics_columns(value).into_iter().enumerate().skip(usize::from(inverse)).map(
        move |(k, column)| {
            let stem = other.map_or(value.name, |(name, _)| name);
            let (ending, words) = STATISTICS[k];
            let meaning =
                || format!("{words} of the {} over the imperfect samples", stem.replace('_', " "));
            ValueColumn {
                quantity: Some(*quantity),
                statistic: Some(if inverse { STATISTICS.len() - k } else { k }),
                name: format!("{stem}_{ending}_{}", quantity.suffix()).into(),
                unit: quantity.unit(),
                meaning: other.map_or(column.meaning, |_| meaning().into()),
                ..column
            }
        },
    )
}

impl MeasuredValue {
    /// Returns whether large or small values are better in the unit of `quantity`.
    ///
    /// `None` if neither is generally better.
    pub(super) fn good_as(&self, quantity: Option<Quantity>) -> Option<Goal> {
        let is_inverse = quantity.is_some_and(Quantity::is_inverse);
        self.good.map(|goal| if is_inverse { goal.inverse() } else { goal })
    }

    /// Returns the cell of the value in a result; empty if the result does not have the value.
    fn cell(&self, result: &DesignResult) -> Cell {
        match self.value {
            Value::Coverage => result.coverage.into(),
            // The accessor needs mutable measures. Copying them, a few hundred bytes, avoids a
            // second accessor for each measure.
            Value::Puncture(field) => {
                result.puncture.and_then(|mut p| *field(&mut p.measures)).into()
            }
            Value::Flexure(field) => {
                result.flexure.and_then(|mut f| *field(&mut f.measures)).into()
            }
            Value::OfPuncture(cell) => result.puncture.as_ref().map(cell).into(),
            Value::OfBending(cell) => result.flexure.as_ref().map(cell).into(),
            Value::Settings => result.settings.clone().into(),
            Value::Samples(count) => count(&result.samples).into(),
            Value::SamplesAlone | Value::ArealMass => Cell::Empty,
        }
    }

    /// Returns true if the value needs neither imperfections nor a material.
    fn is_nominal(&self) -> bool {
        !matches!(self.value, Value::Samples(_) | Value::SamplesAlone | Value::ArealMass)
    }
}

impl ValueColumn {
    /// Returns the column of the value `name`, in physical units if `sweep` gives the material.
    ///
    /// `None` if the designs of `sweep` do not have the value.
    pub fn in_units_of(sweep: &Sweep, name: &str) -> Option<&'static Self> {
        let dimensionless = Self::named(name)?;
        let of_value = COLUMNS.iter().filter(|column| {
            std::ptr::eq(column.value, dimensionless.value) && column.statistic.is_none()
        });
        let mut available = of_value.filter(|column| column.is_available(sweep, None));
        available.clone().find(|column| column.quantity.is_some()).or_else(|| available.next())
    }

    /// Returns the header.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the physical unit. `None` if the value is dimensionless.
    pub fn physical_unit(&self) -> Option<&'static str> {
        self.quantity.map(Quantity::unit)
    }

    /// Returns the number of this column in a row, if there is one.
    pub fn number(&self, row: &DesignRow) -> Option<f64> {
        self.cell(row).number()
    }

    /// Returns whether large or small numbers are better; `None` if neither is generally better.
    pub fn good(&self) -> Option<Goal> {
        self.value.good_as(self.quantity)
    }

    /// Returns the column with this name.
    pub(super) fn named(name: &str) -> Option<&'static Self> {
        COLUMNS.iter().find(|column| column.name == name)
    }

    /// Returns the dimensionless column of the same value and statistic.
    ///
    /// For a dimensionless column this is the column itself.
    pub(super) fn dimensionless(&self) -> Option<&'static Self> {
        // All columns of a value refer to the same static entry, so compare addresses.
        COLUMNS.iter().find(|column| {
            column.quantity.is_none()
                && std::ptr::eq(column.value, self.value)
                && column.statistic == self.statistic
        })
    }

    /// Returns true if the value has a column in physical units.
    pub(super) fn has_physical_unit(&self) -> bool {
        !self.value.physical.is_empty()
    }

    /// Returns true for statistics and counts of imperfect samples.
    fn is_of_samples(&self) -> bool {
        self.statistic.is_some() || matches!(self.value.value, Value::Samples(_))
    }

    /// Returns true for columns in physical units, including the areal mass.
    pub(super) fn is_physical(&self) -> bool {
        self.quantity.is_some() || matches!(self.value.value, Value::ArealMass)
    }

    /// Returns true if `table` has this column for the designs of `sweep`.
    ///
    /// For `None`, returns true if any table has this column.
    pub(super) fn is_available(&self, sweep: &Sweep, table: Option<&str>) -> bool {
        // The conditions that search for parameters by key are slow, so they come last.
        table.is_none_or(|table| self.value.tables.contains(&table))
            && (sweep.is_imperfect() || !self.is_of_samples())
            && (sweep.is_guided() || !self.value.is_of_guided_needle)
            && match self.value.value {
                Value::ArealMass => MASS_NEEDS.iter().all(|key| sweep.gives(key)),
                _ => self.quantity.is_none_or(|quantity| quantity.is_given(sweep)),
            }
            && (self.value.needs.is_empty() || self.value.needs.iter().any(|key| sweep.sets(key)))
    }

    fn cell(&self, row: &DesignRow) -> Cell {
        if let Value::ArealMass = self.value.value {
            return areal_mass(&row.case).into();
        }
        let statistic =
            |k: usize, of: Statistics| if k == 0 { of.mean } else { of.quantiles[k - 1] };
        let dimensionless = match (self.statistic, &self.value.samples) {
            (Some(k), Some(samples)) => {
                (samples.statistics)(&row.result.samples).map(|of| statistic(k, of)).into()
            }
            _ => self.value.cell(&row.result),
        };
        match (self.quantity, dimensionless) {
            (None, cell) => cell,
            (Some(quantity), Cell::Number(value)) => quantity.physical(value, &row.case).into(),
            // If no gap closes, there is no contact curvature and the skin bends to any radius, so
            // the smallest bend radius is 0.
            (Some(Quantity::Radius), Cell::Empty)
                if self.statistic.is_none() && row.result.flexure.is_some() =>
            {
                row.case.material.thickness_mm.map(|_| 0.0).into()
            }
            (Some(_), _) => Cell::Empty,
        }
    }

    /// Returns true if a measure table is named after this column.
    pub(super) fn names_a_table(&self) -> bool {
        self.quantity.is_none() && self.statistic.is_none() && self.value.names_a_table()
    }

    /// Returns the name without the suffix of the physical unit.
    pub(super) fn stem(&self) -> &str {
        let unit = self.quantity.map_or("", Quantity::suffix);
        self.name.strip_suffix(unit).unwrap_or(&self.name).trim_end_matches('_')
    }

    pub(super) fn column(&'static self) -> Column<DesignRow> {
        Column::computed(self.name.clone(), self.unit, &self.meaning, |row| self.cell(row))
    }
}

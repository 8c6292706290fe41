//! A measured value of a design, as a column of the tables in which it stands.

use super::cell::Cell;
use super::column::Column;
use super::samples::SAMPLE_VALUES;
use crate::design::row::DesignRow;
use crate::folder::MEASURE_TABLES;

/// A measured value, with the tables in which it stands besides `designs.csv`.
pub(super) struct MeasuredValue {
    pub(super) tables: &'static [&'static str],
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) meaning: &'static str,
    pub(super) cell: fn(&DesignRow) -> Cell,
}

impl MeasuredValue {
    pub(super) fn column(&self) -> Column<DesignRow> {
        Column::new(self.name, self.unit, self.meaning, self.cell)
    }

    /// Whether it is a statistic of imperfect samples.
    pub(super) fn is_of_samples(&self) -> bool {
        SAMPLE_VALUES.iter().any(|value| value.name == self.name)
    }

    /// Whether it is what a table of its own is about.
    pub(super) fn leads(&self) -> bool {
        MEASURE_TABLES.iter().any(|(table, _)| *table == self.name)
    }
}

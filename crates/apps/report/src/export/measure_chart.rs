//! The native spreadsheet chart of a measure against an axis of the grid.

use csv::StringRecord;
use rust_xlsxwriter::{Chart, ChartMarker, ChartMarkerType, ColNum, RowNum, Worksheet, XlsxError};

use results::columns::name;
use results::{CsvFormat, MEASURE_TABLES};

use crate::figures::physical_of;

/// Candidate columns for the horizontal axis; the first one that varies is used.
const ALONG: [&str; 3] = ["slant_deg", "length_over_t", "gap_over_t"];
/// The column with one series for each of its values.
const APART: &str = "gap_over_t";
/// Maximum number of series. If there would be more, the chart shows all designs as one series.
const SERIES: usize = 24;
/// Width and height of a chart, px.
const SIZE: (u32, u32) = (760, 460);

/// The chart of one measure. Its data is collected while the rows of its table are written.
#[derive(Debug)]
pub(super) struct MeasureChart {
    /// Name of the column of the measure, in physical units if the table has such a column.
    name: String,
    /// Index of this column.
    value: ColNum,
    along: Vec<AxisColumn>,
    /// Index of the column [`APART`].
    apart: Option<usize>,
    /// First row and value of each block of consecutive rows with equal values in [`APART`].
    runs: Vec<(RowNum, String)>,
    /// True if all values of the measure are positive.
    is_positive: bool,
}

/// A candidate column for the horizontal axis.
#[derive(Debug)]
struct AxisColumn {
    name: &'static str,
    /// Index of the column.
    place: usize,
    /// Value in the first row.
    first: Option<String>,
    /// True if the column has several values.
    varies: bool,
}

impl MeasureChart {
    /// Creates the chart for a table with this header.
    ///
    /// `None` if `table` is not the table of a measure.
    pub fn new(table: &str, header: &StringRecord) -> Option<Self> {
        MEASURE_TABLES.iter().find(|(measure, _)| *measure == table)?;
        let name = physical_of(header, table).unwrap_or(table);
        let value = ColNum::try_from(place(header, name)?).ok()?;
        let along: Vec<_> = ALONG
            .into_iter()
            .filter_map(|name| {
                let place = place(header, name)?;
                Some(AxisColumn { name, place, first: None, varies: false })
            })
            .collect();
        let apart = place(header, APART);
        (!along.is_empty()).then(|| Self {
            name: name.to_owned(),
            value,
            along,
            apart,
            runs: Vec::new(),
            is_positive: true,
        })
    }

    /// Records a row of the table; the first row below the header is row 1.
    pub fn add(&mut self, row: RowNum, format: CsvFormat, cells: &StringRecord) {
        for axis in &mut self.along {
            let cell = cells.get(axis.place).unwrap_or_default();
            let first = axis.first.get_or_insert_with(|| cell.to_owned());
            axis.varies |= first != cell;
        }
        let apart = self.apart.and_then(|place| cells.get(place)).unwrap_or_default();
        // Stop at `SERIES` + 1 blocks: all blocks of a long table would need much memory.
        if self.runs.len() <= SERIES && self.runs.last().is_none_or(|(_, value)| value != apart) {
            self.runs.push((row, apart.to_owned()));
        }
        let value = cells.get(usize::from(self.value)).and_then(|cell| format.number(cell));
        self.is_positive &= value.is_none_or(|value| value > 0.0);
    }

    /// Inserts the chart into the sheet of its table, to the right of the `columns` columns.
    ///
    /// The table has `rows` rows below its header.
    pub fn insert(
        &self,
        page: &mut Worksheet,
        table: &str,
        rows: RowNum,
        columns: ColNum,
    ) -> Result<(), XlsxError> {
        let axis = self.along.iter().find(|axis| axis.varies).or(self.along.first());
        let Some(axis) = axis.filter(|_| rows > 0) else { return Ok(()) };
        let place = ColNum::try_from(axis.place).unwrap_or(0);
        let mut marker = ChartMarker::new();
        marker.set_type(ChartMarkerType::Circle).set_size(4);
        let mut chart = Chart::new_scatter();
        for (name, first, last) in self.series(axis, rows) {
            let series = chart.add_series();
            series.set_categories((table, first, place, last, place));
            series.set_values((table, first, self.value, last, self.value));
            series.set_name(name.as_str()).set_marker(&marker);
        }
        chart.title().set_name(table.replace('_', " ").as_str());
        chart.x_axis().set_name(axis.name);
        chart.y_axis().set_name(&self.name);
        if self.is_positive && table != name::COVERAGE {
            chart.y_axis().set_log_base(10);
        }
        chart.set_width(SIZE.0).set_height(SIZE.1);
        page.insert_chart(1, columns + 1, &chart)?;
        Ok(())
    }

    /// Returns the name, first row and last row of each series.
    ///
    /// There is one series for each gap if the rows of each gap are contiguous.
    fn series(&self, axis: &AxisColumn, rows: RowNum) -> Vec<(String, RowNum, RowNum)> {
        let mut values: Vec<&str> = self.runs.iter().map(|(_, value)| value.as_str()).collect();
        values.sort_unstable();
        values.dedup();
        // A series is one range of cells, so the designs of a gap value can form a series only if
        // their rows are contiguous.
        let are_contiguous = values.len() == self.runs.len() && self.runs.len() <= SERIES;
        if !are_contiguous || axis.name == APART {
            return vec![("all designs".to_owned(), 1, rows)];
        }
        let ends = self.runs.iter().skip(1).map(|(row, _)| row - 1).chain([rows]);
        let runs = self.runs.iter().zip(ends);
        runs.map(|((first, value), last)| (format!("{APART} {value}"), *first, last)).collect()
    }
}

fn place(header: &StringRecord, name: &str) -> Option<usize> {
    header.iter().position(|column| column == name)
}

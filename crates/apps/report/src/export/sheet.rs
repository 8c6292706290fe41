//! Sheets of a workbook: one for each table, and one that explains all columns.

use csv::StringRecord;
use rust_xlsxwriter::{
    ColNum, Color, ConditionalFormat3ColorScale, Format, FormatAlign, FormatBorder, Workbook,
    Worksheet, XlsxError,
};

use results::{CsvFormat, Outcome};

use super::explanation::{explained, is_leading};
use super::profile::ColumnProfile;
use super::{MeasureChart, TableProfile};

/// Text colour and background colour of a failure.
const RED: [Color; 2] = [Color::RGB(0x009C_0006), Color::RGB(0x00FF_C7CE)];
/// The background of headers.
const GREY: Color = Color::RGB(0x00E6_E6E6);
/// Colour scale of a measure: light to dark blue-green, on which black text stays legible.
const SCALE: [u32; 3] = [0x00FF_FFD9, 0x007F_CDBB, 0x0041_B6C4];

/// Width of the button of a filter, characters.
const BUTTON: usize = 3;
/// Maximum number of columns of a table that is scaled to the width of one printed page.
///
/// More columns would be too small to read.
const ON_PAPER: usize = 14;
/// Minimum and maximum width of a column, characters.
const WIDTHS: (usize, usize) = (8, 60);

/// Cell formats.
struct Formats {
    header: Format,
    /// Format of the status of a failed design.
    failed: Format,
    /// Format of the number of a design.
    number: Format,
    /// Format of the number of a failed design.
    failed_number: Format,
}

impl Formats {
    /// Creates the formats; design numbers show `digits` digits.
    fn new(digits: usize) -> Self {
        let header = Format::new().set_bold().set_background_color(GREY);
        let header = header.set_border_bottom(FormatBorder::Thin).set_align(FormatAlign::Left);
        let number = Format::new().set_num_format("0".repeat(digits));
        let [failed, failed_number] = [Format::new(), number.clone()]
            .map(|format| format.set_font_color(RED[0]).set_background_color(RED[1]));
        Self { header, failed, number, failed_number }
    }
}

/// The sheet of a table, to which rows are added one by one.
pub(super) struct Sheet {
    /// The name of the table.
    pub table: String,
    page: Worksheet,
    format: CsvFormat,
    columns: Vec<SheetColumn>,
    formats: Formats,
    chart: Option<MeasureChart>,
    /// Number of rows below the header.
    pub rows: u32,
}

/// A column of a sheet.
struct SheetColumn {
    /// Index of the column; a sheet has fewer than 2^14 columns.
    place: ColNum,
    /// True if the column holds numbers of designs.
    is_number: bool,
    /// True if the column holds the status of designs.
    is_status: bool,
    /// True if the column has a colour scale.
    is_measure: bool,
    /// Format of the numbers in the column.
    number: Format,
    /// Width of the longest cell, characters.
    width: usize,
}

impl SheetColumn {
    fn new(table: &str, place: usize, name: &str, profile: &ColumnProfile) -> Self {
        let header = name.chars().count() + BUTTON;
        Self {
            place: ColNum::try_from(place).unwrap_or(ColNum::MAX),
            is_number: name == "design" || name.ends_with("_design"),
            is_status: name.ends_with("_status") || (table == "failures" && name == "reason"),
            is_measure: is_leading(table, name),
            number: Format::new().set_num_format(profile.number_format()),
            width: header.max(profile.width() + 1),
        }
    }

    /// Returns true if `cell` is the status of a failed design.
    fn says_failed(&self, cell: &str) -> bool {
        self.is_status && !cell.is_empty() && cell != Outcome::Complete.text()
    }
}

impl Sheet {
    /// Creates a sheet with its header.
    pub fn new(
        workbook: &mut Workbook,
        table: &str,
        profile: &TableProfile,
    ) -> Result<Self, XlsxError> {
        let TableProfile { format, header, columns: profiles } = profile;
        let mut page = workbook.new_worksheet_with_constant_memory()?;
        page.set_name(table)?;
        page.set_landscape();
        page.set_repeat_rows(0, 0)?;
        if header.len() <= ON_PAPER {
            page.set_print_fit_to_pages(1, 0);
        }
        let columns = header.iter().zip(profiles).enumerate();
        let columns: Vec<_> = columns
            .map(|(place, (name, profile))| SheetColumn::new(table, place, name, profile))
            .collect();
        let formats = Formats::new(4);
        for (column, name) in columns.iter().zip(header) {
            page.write_string_with_format(0, column.place, name, &formats.header)?;
        }
        let chart = MeasureChart::new(table, header);
        let (table, format) = (table.to_owned(), *format);
        Ok(Self { table, page, format, columns, formats, chart, rows: 0 })
    }

    /// Adds a row.
    pub fn add(&mut self, cells: &StringRecord) -> Result<(), XlsxError> {
        if self.rows == 0 {
            // Display design numbers with as many digits as in the table.
            let number = self.columns.iter().position(|column| column.is_number);
            let digits = number.and_then(|place| cells.get(place)).map_or(0, str::len);
            self.formats = Formats::new(digits.max(1));
        }
        self.rows += 1;
        let has_failed =
            self.columns.iter().zip(cells).any(|(column, cell)| column.says_failed(cell));
        for (column, cell) in self.columns.iter().zip(cells).filter(|(_, c)| !c.is_empty()) {
            let (page, place) = (&mut self.page, column.place);
            let formats = &self.formats;
            let format = match (column.is_number, has_failed) {
                (true, true) => &formats.failed_number,
                (true, false) => &formats.number,
                _ => &column.number,
            };
            match self.format.number(cell) {
                Some(number) => page.write_number_with_format(self.rows, place, number, format)?,
                None if column.says_failed(cell) => {
                    page.write_string_with_format(self.rows, place, cell, &formats.failed)?
                }
                // A workbook stores the type of a cell, so a text is never a formula.
                None => page.write_string(self.rows, place, CsvFormat::text(cell))?,
            };
        }
        if let Some(chart) = &mut self.chart {
            chart.add(self.rows, self.format, cells);
        }
        Ok(())
    }

    /// Returns the page, with filters, colours and the chart of a measure.
    pub fn finish(mut self) -> Result<Worksheet, XlsxError> {
        // A filter needs at least one row.
        let (last_row, last_column) = (self.rows.max(1), self.columns.len().saturating_sub(1));
        let last_column = ColNum::try_from(last_column).unwrap_or(ColNum::MAX);
        let begins_with_number = self.columns.first().is_some_and(|column| column.is_number);
        // The column with the number of the design stays visible while other columns scroll.
        self.page.set_freeze_panes(1, ColNum::from(begins_with_number))?;
        self.page.autofilter(0, 0, last_row, last_column)?;
        let [low, middle, high] = SCALE.map(Color::RGB);
        let scale = ConditionalFormat3ColorScale::new().set_minimum_color(low);
        let scale = scale.set_midpoint_color(middle).set_maximum_color(high);
        for column in &self.columns {
            let width = column.width.clamp(WIDTHS.0, WIDTHS.1) as f64;
            self.page.set_column_width(column.place, width)?;
            if column.is_measure {
                let place = column.place;
                self.page.add_conditional_format(1, place, last_row, place, &scale)?;
            }
        }
        if self.table == "failures" && self.rows > 0 {
            self.page.set_tab_color(RED[0]);
        }
        if let Some(chart) = &self.chart {
            chart.insert(&mut self.page, &self.table, self.rows, last_column)?;
        }
        Ok(self.page)
    }
}

/// The sheet that explains the columns of all other sheets.
pub(super) struct Guide {
    page: Worksheet,
    row: u32,
}

impl Guide {
    /// The columns of the sheet and their widths.
    const COLUMNS: [(&str, f64); 4] =
        [("sheet", 16.0), ("column", 28.0), ("unit", 30.0), ("meaning", 90.0)];

    /// Creates the sheet with its header.
    pub fn new(workbook: &mut Workbook) -> Result<Self, XlsxError> {
        let mut page = workbook.new_worksheet_with_constant_memory()?;
        page.set_name("columns")?.set_freeze_panes(1, 0)?;
        let header = Formats::new(1).header;
        for (place, (name, width)) in (0..).zip(Self::COLUMNS) {
            page.set_column_width(place, width)?;
            page.write_string_with_format(0, place, name, &header)?;
        }
        Ok(Self { page, row: 0 })
    }

    /// Adds explanations of the columns of a table.
    ///
    /// `own` holds name, unit and meaning of columns that are specific to this folder.
    pub fn explain(
        &mut self,
        table: &str,
        own: &[(String, &'static str, &'static str)],
        header: &StringRecord,
    ) -> Result<(), XlsxError> {
        for name in header {
            self.row += 1;
            let own = own.iter().find(|column| column.0 == name);
            let own = own.map(|&(_, unit, meaning)| (unit, meaning));
            let (unit, meaning) =
                own.or_else(|| explained(table, name)).unwrap_or(("-", "no column of squama"));
            for (place, text) in (0..).zip([table, name, unit, meaning]) {
                self.page.write_string(self.row, place, text)?;
            }
        }
        Ok(())
    }

    /// Adds a note that applies to all tables.
    pub fn note(&mut self, text: &str) -> Result<(), XlsxError> {
        self.row += 1;
        self.page.write_string(self.row, 3, text)?;
        Ok(())
    }

    /// Returns the finished sheet.
    pub fn finish(mut self) -> Result<Worksheet, XlsxError> {
        self.page.autofilter(0, 0, self.row, 3)?;
        Ok(self.page)
    }
}

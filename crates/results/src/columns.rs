//! The one list of columns: every table, and every explanation of a column, comes from here.

pub mod cell;
mod path;
mod samples;
mod values;

use sweep::{Axis, Measure, PARAMETERS, Parameter, Sweep};

use crate::design::design_result::Record;
use crate::folder::RunFolder;
use samples::SPREADS;
use values::VALUES;

pub use cell::Cell;
pub use path::{
    BentScale, EVENTS, FLEXURE_EVENTS, FLEXURE_PATH, FLEXURE_SCALES, FLEXURE_STEPS, PATH, SCALES,
    STEPS,
};

/// A column of a table whose rows are made from `R`.
pub struct Column<R> {
    /// Its header.
    pub name: &'static str,
    /// Unit, `-` if it has none.
    pub unit: &'static str,
    /// What it holds, in half a sentence.
    pub meaning: &'static str,
    cell: Source<R>,
}

/// How the cell of a row is found.
enum Source<R> {
    Value(fn(&R) -> Cell),
    Parameter(&'static Parameter, fn(&R, &Parameter) -> Cell),
}

impl<R> Column<R> {
    /// A column whose cells `cell` makes.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        meaning: &'static str,
        cell: fn(&R) -> Cell,
    ) -> Self {
        Self { name, unit, meaning, cell: Source::Value(cell) }
    }

    /// The column of a parameter, whose cells `cell` makes.
    pub fn parameter(parameter: &'static Parameter, cell: fn(&R, &Parameter) -> Cell) -> Self {
        Self {
            name: header(parameter),
            unit: parameter.unit,
            meaning: parameter.meaning,
            cell: Source::Parameter(parameter, cell),
        }
    }

    /// The cell of this column in the row of `record`.
    pub fn cell(&self, record: &R) -> Cell {
        match self.cell {
            Source::Value(cell) => cell(record),
            Source::Parameter(parameter, cell) => cell(record, parameter),
        }
    }
}

/// The column of the number of a design.
pub fn number<R>(cell: fn(&R) -> Cell) -> Column<R> {
    Column::new("design", "-", "position of the design in the grid of its sweep", cell)
}

/// The header of the column of a parameter: its key, but for those that are also values. A row may have more scales than
/// were asked for, and a strip as many gaps as its length holds.
fn header(parameter: &Parameter) -> &'static str {
    match parameter.key {
        "scales" => "scales_asked",
        "gaps" => "gaps_asked",
        key => key,
    }
}

/// The parameter whose column has that header.
pub fn parameter_of(name: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| header(parameter) == name)
}

/// A measured value, with the tables in which it stands besides `designs.csv`.
struct Value {
    tables: &'static [&'static str],
    name: &'static str,
    unit: &'static str,
    meaning: &'static str,
    cell: fn(&Record) -> Cell,
}

/// The tables of one measure, named by the value that they are about.
pub const MEASURE_TABLES: [(&str, Measure); 4] = [
    ("coverage", Measure::Coverage),
    ("critical_force", Measure::Puncture),
    ("penetration", Measure::Puncture),
    ("compliance", Measure::Flexure),
];

impl Value {
    fn column(&self) -> Column<Record> {
        Column::new(self.name, self.unit, self.meaning, self.cell)
    }

    /// Whether it is what a table of its own is about.
    fn leads(&self) -> bool {
        MEASURE_TABLES.iter().any(|(table, _)| *table == self.name)
    }
}

/// The measured values of the designs of `sweep`.
fn values(sweep: &Sweep) -> impl Iterator<Item = &'static Value> {
    let spreads = if sweep.is_imperfect() { SPREADS } else { &[] };
    VALUES.iter().chain(spreads)
}

/// The unit of a measured value and what it is, by its name.
pub fn explain_value(name: &str) -> Option<(&'static str, &'static str)> {
    let value = VALUES.iter().find(|value| value.name == name)?;
    Some((value.unit, value.meaning))
}

/// A table: the name of its file, and its columns.
pub struct TableLayout<R> {
    /// Name of the file.
    pub file: String,
    /// Columns, from the left.
    pub columns: Vec<Column<R>>,
}

/// The tables of `sweep`: `designs.csv`, and those of the measures that it asks for.
pub fn tables(sweep: &Sweep) -> Vec<TableLayout<Record>> {
    let asked = MEASURE_TABLES.iter().filter(|(_, measure)| sweep.measures().contains(measure));
    let mut tables =
        vec![TableLayout { file: RunFolder::DESIGNS.to_owned(), columns: design_columns(sweep) }];
    tables.extend(asked.map(|(table, _)| TableLayout {
        file: RunFolder::measure_table(table),
        columns: measure_columns(sweep, table),
    }));
    tables
}

/// The columns of `designs.csv`: the same whatever is measured, but for the axes and those that only
/// imperfections have.
pub fn design_columns(sweep: &Sweep) -> Vec<Column<Record>> {
    let (leading, others): (Vec<_>, Vec<_>) = values(sweep).partition(|value| value.leads());
    assemble(sweep, leading, others)
}

fn measure_columns(sweep: &Sweep, table: &str) -> Vec<Column<Record>> {
    let belongs = |value: &&Value| value.tables.contains(&table);
    let (leading, others): (Vec<_>, Vec<_>) =
        values(sweep).filter(belongs).partition(|value| value.name == table);
    assemble(sweep, leading, others)
}

/// The columns that say which design a row is about.
pub fn identity_columns(sweep: &Sweep) -> Vec<Column<Record>> {
    assemble(sweep, Vec::new(), Vec::new())
}

/// Number and design, the leading values, the axes that not every sweep has, the other values.
fn assemble(sweep: &Sweep, leading: Vec<&Value>, others: Vec<&Value>) -> Vec<Column<Record>> {
    let parameter = |parameter| {
        Column::parameter(parameter, |r: &Record, parameter| parameter.get(&r.case).into())
    };
    let geometry = ["gap_over_t", "length_over_t", "slant_deg"];
    let mut columns = vec![number(|r: &Record| r.number.to_string().into())];
    columns.extend(geometry.into_iter().filter_map(Parameter::named).map(parameter));
    columns.extend(leading.into_iter().map(Value::column));
    let axes = sweep.grid().axes().iter().map(Axis::parameter);
    let extra = axes.filter(|parameter| !geometry.contains(&parameter.key));
    columns.extend(extra.map(parameter));
    columns.extend(others.into_iter().map(Value::column));
    columns
}

//! The columns of the tables of a comparison.

use results::Column;
use results::columns::{Cell, number};
use sweep::Parameter;

use super::{ColumnDifference, Difference, Extreme, absolute, relative};

static COMPARISON: &[Column<ColumnDifference>] = &[
    Column::new("column", "-", "column of designs.csv", |c| c.name.clone().into()),
    Column::new("compared", "-", "designs that have a value in both runs", |c| c.compared.into()),
    Column::new("differing", "-", "those whose values differ by more than the tolerance", |c| {
        c.differing.into()
    }),
    Column::new("only_first", "-", "designs that have a value in the first run alone", |c| {
        c.only_first.into()
    }),
    Column::new("only_second", "-", "designs that have a value in the second run alone", |c| {
        c.only_second.into()
    }),
    Column::new(
        "largest_relative",
        "-",
        "largest difference, over the larger of the two values",
        |c| extreme(c.relative.as_ref(), |e| e.difference.into()),
    ),
    Column::new("relative_design", "-", "design that has it, as the first run numbers it", |c| {
        extreme(c.relative.as_ref(), |e| e.design.clone().into())
    }),
    Column::new("relative_first", "-", "its value in the first run", |c| {
        extreme(c.relative.as_ref(), |e| e.first.into())
    }),
    Column::new("relative_second", "-", "its value in the second run", |c| {
        extreme(c.relative.as_ref(), |e| e.second.into())
    }),
    Column::new("largest_absolute", "-", "largest difference, in the unit of the column", |c| {
        extreme(c.absolute.as_ref(), |e| e.difference.into())
    }),
    Column::new("absolute_design", "-", "design that has it, as the first run numbers it", |c| {
        extreme(c.absolute.as_ref(), |e| e.design.clone().into())
    }),
    Column::new("absolute_first", "-", "its value in the first run", |c| {
        extreme(c.absolute.as_ref(), |e| e.first.into())
    }),
    Column::new("absolute_second", "-", "its value in the second run", |c| {
        extreme(c.absolute.as_ref(), |e| e.second.into())
    }),
    Column::new(
        "rank_correlation",
        "-",
        "Spearman's rank correlation of the two runs, 1 if both put the designs in the same order",
        |c| c.correlation.into(),
    ),
];

fn extreme(extreme: Option<&Extreme>, cell: fn(&Extreme) -> Cell) -> Cell {
    extreme.map_or(Cell::Empty, cell)
}

/// The columns of `compare.csv`.
pub fn comparison_columns() -> &'static [Column<ColumnDifference>] {
    COMPARISON
}

/// The columns of `differences.csv` for designs with these parameters.
pub fn difference_columns<'a>(parameters: &[&'static Parameter]) -> Vec<Column<Difference<'a>>> {
    let parameter = |parameter: &&'static Parameter| {
        Column::parameter(parameter, |d: &Difference<'a>| {
            d.parameter(parameter).into_owned().into()
        })
    };
    let mut columns = vec![
        number(|d: &Difference<'a>| d.designs()[0].to_owned().into()),
        Column::new("other_design", "-", "the same design as the second run numbers it", |d| {
            d.designs()[1].to_owned().into()
        }),
    ];
    columns.extend(parameters.iter().map(parameter));
    columns.extend([
        Column::new("column", "-", "column of designs.csv", |d: &Difference<'a>| {
            d.column().to_owned().into()
        }),
        Column::new("first", "-", "value in the first run", |d| d.texts()[0].to_string().into()),
        Column::new("second", "-", "value in the second run", |d| d.texts()[1].to_string().into()),
        Column::new("absolute", "-", "their difference", |d| d.numbers().map(absolute).into()),
        Column::new("relative", "-", "the same over the larger of the two", |d| {
            d.numbers().map(relative).into()
        }),
    ]);
    columns
}

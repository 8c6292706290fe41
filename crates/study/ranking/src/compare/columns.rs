//! Columns of the tables of a comparison.

use results::columns::number;
use results::{Column, columns};
use sweep::Parameter;

use super::{ColumnDifference, Difference, absolute, relative};

/// Columns of `compare.csv`.
pub static COMPARISON_COLUMNS: &[Column<ColumnDifference>] = &columns! { ColumnDifference:
    "column", "-", |c| c.name.clone(), "column of designs.csv";
    "compared", "-", |c| c.compared, "number of designs with a value in both runs";
    "differing", "-", |c| c.differing,
        "number of designs with values that differ by more than the tolerance";
    "only_first", "-", |c| c.only_first, "number of designs with a value in the first run only";
    "only_second", "-", |c| c.only_second, "number of designs with a value in the second run only";
    "largest_relative", "-", |c| c.relative.as_ref().map(|e| e.difference),
        "largest difference divided by the larger magnitude of both values";
    "relative_design", "-", |c| c.relative.as_ref().map(|e| e.design.clone()),
        "number, in the first run, of the design with the largest relative difference";
    "relative_first", "-", |c| c.relative.as_ref().map(|e| e.first),
        "value of relative_design in the first run";
    "relative_second", "-", |c| c.relative.as_ref().map(|e| e.second),
        "value of relative_design in the second run";
    "largest_absolute", "-", |c| c.absolute.as_ref().map(|e| e.difference),
        "largest absolute difference, in the unit of the column";
    "absolute_design", "-", |c| c.absolute.as_ref().map(|e| e.design.clone()),
        "number, in the first run, of the design with the largest absolute difference";
    "absolute_first", "-", |c| c.absolute.as_ref().map(|e| e.first),
        "value of absolute_design in the first run";
    "absolute_second", "-", |c| c.absolute.as_ref().map(|e| e.second),
        "value of absolute_design in the second run";
    "rank_correlation", "-", |c| c.correlation,
        "Spearman's rank correlation of both runs, 1 if their designs have the same order";
};

/// Returns the columns of `differences.csv`, with the columns of `parameters`.
pub fn difference_columns<'a>(parameters: &[&'static Parameter]) -> Vec<Column<Difference<'a>>> {
    let mut columns = vec![number(|d: &Difference<'a>| d.designs()[0].to_owned().into())];
    columns.extend(columns! { Difference<'a>:
        "other_design", "-", |d| d.designs()[1].to_owned(),
            "number of the same design in the second run";
    });
    columns.extend(parameters.iter().map(|parameter| {
        Column::parameter(parameter, |d: &Difference<'a>| {
            d.parameter(parameter).into_owned().into()
        })
    }));
    columns.extend(columns! { Difference<'a>:
        "column", "-", |d| d.column().to_owned(), "column of designs.csv";
        "first", "-", |d| d.texts()[0].to_string(), "value in the first run";
        "second", "-", |d| d.texts()[1].to_string(), "value in the second run";
        "absolute", "-", |d| d.numbers().map(absolute), "absolute difference of both values";
        "relative", "-", |d| d.numbers().map(relative),
            "absolute difference divided by the larger magnitude of both values";
    });
    columns
}

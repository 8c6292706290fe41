//! The meaning of a column of a table, looked up by the names of both.

use ranking::{
    COMPARISON_COLUMNS, Preferences, difference_columns, pareto_columns, quaternary_columns,
    ranking_columns, winner_columns,
};
use results::columns::{Cell, explain_value, number, parameter_of};
use results::{Column, MEASURE_TABLES, RERUN_COLUMNS, failure_detail_columns};

/// Unit and meaning of a column, in half a sentence.
type Explanation = (&'static str, &'static str);

/// The meaning of the column `name` of the table `table` (without `.csv`); `None` if this program writes no such column.
pub(super) fn explained(table: &str, name: &str) -> Option<Explanation> {
    // The own meaning comes first: `contacts` of failures are others than those of designs.
    own(table, name).or_else(|| common(name))
}

/// A column that this table has, or explains otherwise than others do.
fn own(table: &str, name: &str) -> Option<Explanation> {
    match table {
        "failures" => among(&failure_detail_columns(), name),
        "reruns" => among(RERUN_COLUMNS, name),
        // Columns of other criteria than the paper's are known by the ends of their names.
        "ranking" => among(&ranking_columns(&[], &Preferences::paper()), name),
        "pareto" => among(&pareto_columns(&[], &Preferences::paper()), name),
        "winners" => among(&winner_columns(&[], &Preferences::paper()), name),
        "quaternary" => among(&quaternary_columns(&[], &Preferences::paper()), name),
        "compare" => among(COMPARISON_COLUMNS, name),
        "differences" => among(&difference_columns(&[]), name),
        _ => None,
    }
}

/// Numbers, parameters and measured values mean the same everywhere.
fn common(name: &str) -> Option<Explanation> {
    let parameter = || parameter_of(name).map(|parameter| (parameter.unit, parameter.meaning));
    among(&[number(|(): &()| Cell::Empty)], name)
        .or_else(|| explain_value(name))
        .or_else(parameter)
        .or_else(|| of_criterion(name))
}

/// A column of a ranking by criteria of one's own.
fn of_criterion(name: &str) -> Option<Explanation> {
    match name.rsplit_once('_')?.1 {
        "rescaled" => {
            Some(("-", "criterion from 0, the worst of all ranked designs, to 1, the best"))
        }
        "weight" => Some(("-", "weight of the criterion")),
        _ => None,
    }
}

fn among<R>(columns: &[Column<R>], name: &str) -> Option<Explanation> {
    let column = columns.iter().find(|column| column.name == name)?;
    Some((column.unit, column.meaning))
}

/// Whether a column holds the values that its table is about.
pub(super) fn is_leading(table: &str, name: &str) -> bool {
    match table {
        "designs" => MEASURE_TABLES.iter().any(|(measure, _)| *measure == name),
        "ranking" | "quaternary" => name == "fitness",
        "pareto" | "winners" => name == "share",
        "differences" => name == "relative",
        "compare" => name == "largest_relative",
        table => table == name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use results::columns::tables;
    use sweep::Sweep;

    #[test]
    fn every_column_of_a_run_is_explained() {
        let text = "name = 'x'\ndesigns.c2 = [0.23, 1]\ndesigns.scales = [21, 31]";
        let sweep = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
        for table in tables(&sweep) {
            for column in table.columns {
                let explained = explained(table.file.trim_end_matches(".csv"), &column.name);
                let Column { name, unit, meaning, .. } = column;
                assert_eq!(explained, Some((unit, meaning)), "{name}");
            }
        }
        for Column { name, .. } in results::failure_columns(&sweep) {
            assert!(explained("failures", &name).is_some(), "{name}");
        }
    }

    #[test]
    fn a_name_means_what_its_table_means_by_it() {
        let contacts = ["designs", "failures"].map(|table| explained(table, "contacts"));
        assert_ne!(contacts[0], contacts[1]);
        assert_eq!(explained("designs", "somebody's own column"), None);
    }
}

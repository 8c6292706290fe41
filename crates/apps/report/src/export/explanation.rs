//! Explanations of columns, found by the names of table and column.

use ranking::{
    COMPARISON_COLUMNS, Preferences, difference_columns, pareto_columns, quaternary_columns,
    ranking_columns, winner_columns,
};
use results::columns::{Cell, explain_value, number, parameter_of};
use results::{Column, MEASURE_TABLES, RERUN_COLUMNS, failure_detail_columns};

/// Unit and meaning of a column; the meaning is a short phrase.
type Explanation = (&'static str, &'static str);

/// Returns the explanation of column `name` of table `table` (without `.csv`).
///
/// `None` if this program writes no such column.
pub(super) fn explained(table: &str, name: &str) -> Option<Explanation> {
    // Explanations of the table have priority: `contacts` has a different meaning in `failures`.
    own(table, name).or_else(|| common(name))
}

/// Returns the explanation of a column that is specific to this table.
fn own(table: &str, name: &str) -> Option<Explanation> {
    match table {
        "failures" => among(&failure_detail_columns(), name),
        "reruns" => among(RERUN_COLUMNS, name),
        // Columns of user-defined criteria are recognised by the ends of their names, in `common`.
        "ranking" => among(&ranking_columns(&[], &Preferences::paper()), name),
        "pareto" => among(&pareto_columns(&[], &Preferences::paper()), name),
        "winners" => among(&winner_columns(&[], &Preferences::paper()), name),
        "quaternary" => among(&quaternary_columns(&[], &Preferences::paper()), name),
        "compare" => among(COMPARISON_COLUMNS, name),
        "differences" => among(&difference_columns(&[]), name),
        _ => None,
    }
}

/// Returns the explanation of a column that has the same meaning in all tables.
fn common(name: &str) -> Option<Explanation> {
    among(&[number(|(): &()| Cell::Empty)], name)
        .or_else(|| explain_value(name))
        .or_else(|| parameter_of(name).map(|parameter| (parameter.unit, parameter.meaning)))
        .or_else(|| of_criterion(name))
}

/// Returns the explanation of a column of a user-defined criterion in a ranking.
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

/// Returns true if a column holds the main values of its table.
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
    fn explanations_depend_on_the_table() {
        let contacts = ["designs", "failures"].map(|table| explained(table, "contacts"));
        assert_ne!(contacts[0], contacts[1]);
        assert_eq!(explained("designs", "somebody's own column"), None);
    }
}

//! The meaning of a column of a table, looked up by the names of both.

use ranking::{
    Preferences, comparison_columns, difference_columns, pareto_columns, quaternary_columns,
    ranking_columns, winner_columns,
};
use results::columns::{Cell, explain_value, number, parameter_of};
use results::{Column, MEASURE_TABLES, RERUN_COLUMNS, failure_detail_columns};

/// Unit and meaning of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Explanation {
    /// Unit, `-` if it has none.
    pub unit: &'static str,
    /// The content of the column, in half a sentence.
    pub meaning: &'static str,
}

impl Explanation {
    /// The meaning of the column `name` of the table `table` (without `.csv`); `None` if this program
    /// writes no such column.
    pub fn of(table: &str, name: &str) -> Option<Self> {
        // The own meaning comes first: `contacts` of failures are others than those of designs.
        Self::own(table, name).or_else(|| Self::common(name))
    }

    /// A column that this table has, or explains otherwise than others do.
    fn own(table: &str, name: &str) -> Option<Self> {
        match table {
            "failures" => among(&failure_detail_columns(), name),
            "reruns" => among(RERUN_COLUMNS, name),
            // Columns of other criteria than the paper's are known by the ends of their names.
            "ranking" => among(&ranking_columns(&[], &Preferences::paper()), name),
            "pareto" => among(&pareto_columns(&[], &Preferences::paper()), name),
            "winners" => among(&winner_columns(&[], &Preferences::paper()), name),
            "quaternary" => among(&quaternary_columns(&[], &Preferences::paper()), name),
            "compare" => among(comparison_columns(), name),
            "differences" => among(&difference_columns(&[]), name),
            _ => None,
        }
    }

    /// Numbers, parameters and measured values mean the same everywhere.
    fn common(name: &str) -> Option<Self> {
        let numbers = [number(|(): &()| Cell::Empty)];
        let measured = || {
            let (unit, meaning) = explain_value(name)?;
            Some(Self { unit, meaning })
        };
        let parameter = || {
            let parameter = parameter_of(name)?;
            Some(Self { unit: parameter.unit, meaning: parameter.meaning })
        };
        among(&numbers, name)
            .or_else(measured)
            .or_else(parameter)
            .or_else(|| Self::of_criterion(name))
    }
}

impl Explanation {
    /// A column of a ranking by criteria of one's own.
    fn of_criterion(name: &str) -> Option<Self> {
        let meaning = match name.rsplit_once('_')?.1 {
            "rescaled" => "criterion from 0, the worst of all ranked designs, to 1, the best",
            "weight" => "weight of the criterion",
            _ => return None,
        };
        Some(Self { unit: "-", meaning })
    }
}

fn among<R>(columns: &[Column<R>], name: &str) -> Option<Explanation> {
    let column = columns.iter().find(|column| column.name == name)?;
    Some(Explanation { unit: column.unit, meaning: column.meaning })
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
                let explained = Explanation::of(table.file.trim_end_matches(".csv"), &column.name);
                let Column { name, unit, meaning, .. } = column;
                assert_eq!(explained, Some(Explanation { unit, meaning }), "{name}");
            }
        }
        for Column { name, .. } in results::failure_columns(&sweep) {
            assert!(Explanation::of("failures", &name).is_some(), "{name}");
        }
    }

    #[test]
    fn a_name_means_what_its_table_means_by_it() {
        let contacts = ["designs", "failures"].map(|table| Explanation::of(table, "contacts"));
        assert_ne!(contacts[0], contacts[1]);
        assert_eq!(Explanation::of("designs", "somebody's own column"), None);
    }
}

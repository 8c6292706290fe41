//! The headers of the tables, which other programs rely on.

use results::columns::tables;

use crate::sweep;

fn headers(text: &str) -> String {
    let sweep = sweep(text);
    let line = |table: results::columns::TableLayout| {
        let names: Vec<_> = table.columns.iter().map(|column| column.name.as_ref()).collect();
        format!("{}: {}", table.file, names.join(","))
    };
    tables(&sweep).into_iter().map(line).collect::<Vec<_>>().join("\n")
}

#[test]
fn of_the_paper_sweep() {
    insta::assert_snapshot!(headers("name = 'x'"));
}

#[test]
fn with_another_axis_and_another_measure() {
    insta::assert_snapshot!(headers("name = 'x'\nmeasures = ['coverage']\ndesigns.c2 = [1, 2]"));
}

#[test]
fn every_parameter_may_be_an_axis_with_a_column_of_its_own() {
    let axis = |p: &sweep::Parameter| format!("{} = {}\n", p.key, p.default().to_toml());
    // A strip has either a length or a number of gaps.
    let names_without = |other: &str| {
        let chosen = sweep::PARAMETERS.iter().filter(|p| p.key != other);
        let axes: String = chosen.map(axis).collect();
        let sweep = sweep(&format!("name = 'x'\n[designs]\n{axes}"));
        results::columns::design_columns(&sweep)
            .into_iter()
            .map(|c| c.name.into_owned())
            .collect::<Vec<_>>()
    };
    let mut names = names_without("gaps");
    assert!(names.iter().any(|name| name == "membrane_length_over_t"));
    assert!(names_without("membrane_length_over_t").iter().any(|name| name == "gaps_asked"));
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
}

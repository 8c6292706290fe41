//! The headers of the tables, which other programs rely on.

use results::columns::tables;

use crate::sweep;

fn headers(text: &str) -> String {
    let sweep = sweep(text);
    let line = |table: results::columns::TableLayout| {
        let names: Vec<_> = table.columns.iter().map(|column| column.name).collect();
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
    let axes: String = sweep::PARAMETERS.iter().map(axis).collect();
    let columns =
        results::columns::design_columns(&sweep(&format!("name = 'x'\n[designs]\n{axes}")));
    let mut names: Vec<_> = columns.iter().map(|column| column.name).collect();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
}

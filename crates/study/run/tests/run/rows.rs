//! Rows do not depend on other designs that are solved.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use proptest::prelude::*;
use results::columns::design_columns;
use run::{Evaluator, GapChange};
use skin::Design;
use sweep::{Case, Sweep};

/// Returns the axes of a small grid.
fn axes() -> Vec<(&'static str, Vec<f64>)> {
    vec![
        ("gap_over_t", vec![0.1, 0.4]),
        ("length_over_t", vec![0.3, 1.0]),
        ("slant_deg", vec![0.0, 45.0, 75.0]),
    ]
}

/// Returns the rows of the sweep over these axes, sorted, without numbers.
fn rows(axes: &[(&str, Vec<f64>)]) -> BTreeSet<Vec<String>> {
    let axes: Vec<_> = axes.iter().map(|(key, values)| format!("{key} = {values:?}")).collect();
    let axes = axes.join("\n");
    let text = format!("name = 'x'\npuncture.scales = 21\n[designs]\n{axes}");
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep");
    let (evaluator, mut columns) = (Evaluator::new(sweep.measures()), design_columns(&sweep));
    columns.retain(|column| column.name != "design");
    columns.sort_by(|a, b| a.name.cmp(&b.name));
    let row = |index| {
        let row = evaluator.solve(sweep.grid().number(index), &sweep.grid().case(index)).row;
        columns.iter().map(|column| column.cell(&row).to_string()).collect()
    };
    (0..sweep.grid().len()).map(row).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// A row does not depend on the designs solved before it, nor on its position.
    #[test]
    fn rows_do_not_depend_on_their_order(
        axes in Just(axes()).prop_shuffle().prop_flat_map(|axes| {
            let shuffled = |(key, values)| (Just(key), Just(values).prop_shuffle());
            axes.into_iter().map(shuffled).collect::<Vec<_>>()
        }),
    ) {
        static ROWS: LazyLock<BTreeSet<Vec<String>>> = LazyLock::new(|| rows(&self::axes()));
        prop_assert_eq!(ROWS.len(), 12);
        prop_assert_eq!(rows(&axes), ROWS.clone());
    }
}

/// `row` and `solve` give the same row.
///
/// The paths of `solve` include every fold, and the stretches at every point.
#[test]
fn rows_do_not_depend_on_whether_paths_are_stored() {
    let text = "name = 'x'\nmeasures = ['puncture', 'flexure']\n[designs]\ngap_over_t = 0.1\nlength_over_t = [0.2, 1]\nslant_deg = 75";
    let sweep = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
    let evaluator = Evaluator::new(sweep.measures());
    for index in 0..sweep.grid().len() {
        let (number, case) = (sweep.grid().number(index), sweep.grid().case(index));
        let solved = evaluator.solve(number, &case);
        assert_eq!(evaluator.row(number, &case), solved.row, "design {index}");
        let puncture = solved.puncture.expect("a puncture");
        assert!(puncture.folds.len() > 1, "design {index}");
        assert!(puncture.path.iter().all(|point| point.gap_stretch.is_some()), "design {index}");
    }
}

/// The coverage of slanted scales changes with the gap as in the closed form.
///
/// Columns that are not measured are omitted.
#[test]
fn gap_changes_match_the_closed_form_of_the_coverage() {
    let text = "name = 'x'\nmeasures = 'coverage'\n[designs]\ngap_over_t = [0.2, 0.4]\nlength_over_t = 0.5\nslant_deg = 60";
    let sweep = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
    let change =
        GapChange::solve(&sweep, "0002", &["critical_force", "coverage"]).expect("a design");
    assert_eq!((change.design.as_str(), change.gap), ("0002", 0.4));
    let [coverage] = change.measures.as_slice() else { panic!("{change:?}") };
    let expected = |gap: f64| {
        let case = Case {
            design: Design { gap, length: 0.5, slant_deg: 60.0, ..Case::default().design },
            ..Case::default()
        };
        case.design.row().expect("a row").coverage()
    };
    assert_eq!(coverage.value, expected(0.4));
    assert_eq!(coverage.changed, [Some(expected(0.9 * 0.4)), Some(expected(1.1 * 0.4))]);
    assert!(coverage.changed[0] > Some(coverage.value));
    assert_eq!(GapChange::solve(&sweep, "0003", &["coverage"]), None);
}

#[test]
fn gap_changes_are_not_solved_for_long_chains() {
    let change = |gaps: u32| {
        let text = format!(
            "name = 'x'\nmeasures = ['coverage', 'flexure']\n[designs]\ngap_over_t = 0.2\nlength_over_t = 0.5\nslant_deg = 0\n[flexure]\nmethod = 'chain'\ngaps = {gaps}"
        );
        GapChange::solve(
            &Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep"),
            "1",
            &["coverage"],
        )
    };
    assert!(change(20).is_some());
    assert_eq!(change(20_000), None);
}

//! Rows do not depend on what else is solved.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use proptest::prelude::*;
use results::columns::design_columns;
use run::Evaluator;
use sweep::Sweep;

/// The axes of a small grid.
fn axes() -> Vec<(&'static str, Vec<f64>)> {
    vec![
        ("gap_over_t", vec![0.1, 0.4]),
        ("length_over_t", vec![0.3, 1.0]),
        ("slant_deg", vec![0.0, 45.0, 75.0]),
    ]
}

/// The rows of the sweep over these axes, in the order in which they are found, without their numbers.
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

    /// The designs that are solved before one, and where it stands, do not change a digit of it.
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

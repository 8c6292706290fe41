//! The row of a design does not depend on other designs, on stored paths or on other columns.

use std::collections::BTreeSet;
use std::iter;
use std::sync::LazyLock;

use proptest::prelude::*;
use results::DesignRow;
use results::columns::{Cell, design_columns, is_along_path, measure_of};
use run::{Evaluator, GapChange, Patience};
use skin::Design;
use sweep::{Case, Measure, Parameter, Sweep};

/// Returns the axes of a small grid of 12 designs.
fn axes() -> Vec<(&'static str, Vec<f64>)> {
    vec![
        ("gap_over_t", vec![0.1, 0.4]),
        ("length_over_t", vec![0.3, 1.0]),
        ("slant_deg", vec![0.0, 45.0, 75.0]),
    ]
}

/// Solves the sweep over these axes, and returns its rows sorted and without design numbers.
fn rows(axes: &[(&str, Vec<f64>)]) -> BTreeSet<Vec<String>> {
    let axes: Vec<_> = axes.iter().map(|(key, values)| format!("{key} = {values:?}")).collect();
    let axes = axes.join("\n");
    let text = format!("name = 'x'\npuncture.scales = 21\n[designs]\n{axes}");
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep");
    let (evaluator, mut columns) = (Evaluator::new(sweep.measures()), design_columns(&sweep));
    columns.retain(|column| column.name != "design");
    columns.sort_by(|a, b| a.name.cmp(&b.name));
    (0..sweep.grid().len())
        .map(|index| {
            let row = evaluator.solve(sweep.grid().number(index), &sweep.grid().case(index)).row;
            columns.iter().map(|column| column.cell(&row).to_string()).collect()
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Shuffled axes and values change the order in which the evaluator solves the designs.
    #[test]
    fn rows_do_not_depend_on_their_order(
        axes in Just(axes()).prop_shuffle().prop_flat_map(|axes| {
            axes.into_iter()
                .map(|(key, values)| (Just(key), Just(values).prop_shuffle()))
                .collect::<Vec<_>>()
        }),
    ) {
        static ROWS: LazyLock<BTreeSet<Vec<String>>> = LazyLock::new(|| rows(&self::axes()));
        prop_assert_eq!(ROWS.len(), 12);
        prop_assert_eq!(rows(&axes), ROWS.clone());
    }
}

/// `Evaluator::row` and `Evaluator::solve` give the same row.
///
/// Only the paths of `solve` contain every fold, and the gap stretch at every point.
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

/// Definitions with free, guided and round needles, friction, failure, and a row across.
const SKINS: [&str; 4] = [
    "[designs]\ngap_over_t = [0.1, 0.5]\nlength_over_t = 0.4\nslant_deg = [0, 45, 70]",
    "[designs]\ngap_over_t = [0.1, 0.5]\nlength_over_t = 0.4\nslant_deg = [45, 70]\n\
     [puncture]\nneedle = 'guided'\nneedle_friction = 0.3\nload_inset_over_t = 0.05\n\
     places = 3\nfailure = true",
    "[designs]\ngap_over_t = 0.2\nlength_over_t = 0.4\nslant_deg = [45, 70]\n\
     [contact]\nfriction = 0.2\n[array]\nacross = true\n[puncture]\nfailure = true",
    "[designs]\ngap_over_t = 0.2\nlength_over_t = 0.8\nslant_deg = 70\n\
     [puncture]\nneedle = 'guided'\nneedle_radius_over_t = 0.3\ncritical_tilt_deg = [5, 10]",
];

/// Calls `check` with each sweep of [`SKINS`] and the index of each of its designs.
fn for_each_skin(mut check: impl FnMut(&Sweep, u64)) {
    for skin in SKINS {
        let text = format!("name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\n{skin}");
        let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep");
        (0..sweep.grid().len()).for_each(|index| check(&sweep, index));
    }
}

/// Rows of the critical state have all values except the values along the path.
#[test]
fn critical_state_rows_omit_only_values_along_the_path() {
    let (mut compared, mut omitted) = (0, BTreeSet::new());
    for_each_skin(|sweep, index| {
        let measures = [sweep.measures(), &[Measure::Sensitivity]].concat();
        let (number, case) = (sweep.grid().number(index), sweep.grid().case(index));
        let whole = Evaluator::new(&measures).row(number, &case);
        let critical = Evaluator::for_columns(&measures, iter::empty()).row(number, &case);
        for column in design_columns(sweep) {
            let [expected, found] = [&whole, &critical].map(|row| column.cell(row));
            if !is_along_path(&column.name) {
                assert_eq!(found.to_string(), expected.to_string(), "{} {index}", column.name);
                compared += 1;
            } else if !matches!(expected, Cell::Empty) {
                // An omitted count is 0, not empty.
                assert!(matches!(found, Cell::Empty | Cell::Count(0)), "{}", column.name);
                omitted.insert(column.name.to_string());
            }
        }
        let mut derivatives = whole.result.sensitivity;
        derivatives.retain(|derivative| !is_along_path(derivative.measure));
        assert_eq!(critical.result.sensitivity, derivatives, "{index}");
    });
    assert!(compared > 500 && omitted.len() > 12, "{compared} {omitted:?}");
}

/// A column has the same value and derivatives if only the parts that it needs are solved.
#[test]
fn a_column_solved_alone_equals_the_column_of_a_whole_row() {
    let unloaded = "[designs]\ngap_over_t = 0.2\nlength_over_t = 0.4\nslant_deg = 60\n\
                    [contact]\nfriction = 0.2\n[flexure]\nunbend = true\n\
                    [puncture]\nplaces = 3\nunload = true\n[array]\nacross = true";
    let bodies = "[designs]\ngap_over_t = 0.2\nlength_over_t = 0.4\nslant_deg = 60\n\
                  [body]\nradius_over_t = 20\nradius_to_over_t = 10";
    let (mut compared, mut omitted) = (0, 0);
    for skin in SKINS.iter().chain(&[unloaded, bodies]) {
        let text = format!("name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\n{skin}");
        let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep");
        let (number, case) = (sweep.grid().number(0), sweep.grid().case(0));
        let whole = Evaluator::new(&[sweep.measures(), &[Measure::Sensitivity]].concat())
            .row(number, &case);
        let columns = design_columns(&sweep);
        for column in &columns {
            let Some(measure) = measure_of(&column.name) else { continue };
            let measures = [measure, Measure::Sensitivity];
            let alone = Evaluator::only_columns(&measures, &[&column.name]);
            let alone = alone.row(number, &case);
            let [expected, found] = [&whole, &alone].map(|row| column.cell(row).to_string());
            assert_eq!(found, expected, "{} of {skin}", column.name);
            let of_column = |row: &DesignRow| {
                let mut derivatives = row.result.sensitivity.clone();
                // Drop derivatives of 0: they are missing if a part of the design is not solved.
                derivatives.retain(|d| d.measure == column.name && d.left != Some(0.0));
                derivatives
            };
            assert_eq!(of_column(&alone), of_column(&whole), "{} of {skin}", column.name);
            compared += usize::from(!expected.is_empty());
            omitted += columns
                .iter()
                .filter(|other| other.cell(&alone).number() != other.cell(&whole).number())
                .count();
        }
    }
    assert!(compared > 100 && omitted > 500, "{compared} {omitted}");
}

/// `GapChange::solve` starts the punctures with changed gaps at the end of the nominal puncture.
///
/// Without this end, `GapChange::beside` follows the paths with changed gaps from rest.
#[test]
fn gap_changes_do_not_depend_on_the_start_of_the_puncture() {
    for_each_skin(|sweep, index| {
        let number = sweep.grid().number(index).to_string();
        let columns =
            ["coverage", "critical_force", "weakest_force", "failure_force", "compliance"];
        let solved = GapChange::solve(sweep, &number, &columns, Patience::Unlimited);
        let solved = solved.expect("a design");
        let measured: Vec<(&str, f64)> =
            solved.measures.iter().map(|change| (change.column.as_str(), change.value)).collect();
        assert!(measured.len() > 2, "{solved:?}");
        let beside = GapChange::beside(sweep, &number, &measured, None, Patience::Unlimited);
        let beside = beside.expect("a design");
        assert_eq!((&beside.design, beside.gap), (&solved.design, solved.gap));
        for (near, followed) in solved.measures.iter().zip(&beside.measures) {
            assert_eq!((&near.column, near.value), (&followed.column, followed.value));
            for (near, followed) in near.changed.iter().zip(followed.changed) {
                let difference = near.zip(followed).map(|(a, b)| (a - b).abs() / b.abs().max(1e-6));
                assert_eq!(near.is_some(), followed.is_some(), "{solved:?} {beside:?}");
                assert!(difference.is_none_or(|d| d < 1e-8), "{near:?} {followed:?}");
            }
        }
    });
}

/// Derivatives with respect to selected parameters do not depend on the other parameters.
#[test]
fn derivatives_by_selected_parameters_do_not_depend_on_the_other_parameters() {
    let keys = ["gap_over_t", "slant_deg", "c1", "needle_friction"];
    let chosen: Vec<&Parameter> = keys.into_iter().filter_map(Parameter::named).collect();
    let mut compared = 0;
    for_each_skin(|sweep, index| {
        let evaluator = Evaluator::new(&[sweep.measures(), &[Measure::Sensitivity]].concat());
        let (number, case) = (sweep.grid().number(index), sweep.grid().case(index));
        let mut all = evaluator.row(number, &case).result.sensitivity;
        all.retain(|derivative| keys.contains(&derivative.parameter));
        let mut some = evaluator.row_and_end(number, &case, Some(&chosen)).0.result.sensitivity;
        // With the prefactor, derivatives with respect to the modulus are returned, too.
        some.retain(|derivative| keys.contains(&derivative.parameter));
        assert_eq!(some, all, "{index}");
        compared += some.len();
    });
    assert!(compared > 300, "{compared}");
}

/// The changes of the coverage agree with its closed form, and unmeasured columns are omitted.
#[test]
fn gap_changes_match_the_closed_form_of_the_coverage() {
    let text = "name = 'x'\nmeasures = 'coverage'\n[designs]\ngap_over_t = [0.2, 0.4]\nlength_over_t = 0.5\nslant_deg = 60";
    let sweep = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
    let change =
        GapChange::solve(&sweep, "0002", &["critical_force", "coverage"], Patience::Milliseconds)
            .expect("a design");
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
    assert_eq!(GapChange::solve(&sweep, "0003", &["coverage"], Patience::Milliseconds), None);
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
            Patience::Milliseconds,
        )
    };
    assert!(change(20).is_some());
    assert_eq!(change(20_000), None);
}

//! Rows do not depend on other designs that are solved.

use std::collections::BTreeSet;
use std::iter;
use std::sync::LazyLock;

use proptest::prelude::*;
use results::DesignRow;
use results::columns::{Cell, design_columns, is_along_path, measure_of};
use run::{Evaluator, GapChange, Patience};
use skin::Design;
use sweep::{Case, Measure, Parameter, Sweep};

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
    (0..sweep.grid().len())
        .map(|index| {
            let row = evaluator.solve(sweep.grid().number(index), &sweep.grid().case(index)).row;
            columns.iter().map(|column| column.cell(&row).to_string()).collect()
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// A row does not depend on the designs solved before it, nor on its position.
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

/// Skins with every needle, friction, failure, a row across and several load positions.
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

/// Calls `check` with the sweep of each skin and each of its cases.
fn for_each_skin(mut check: impl FnMut(&Sweep, u64)) {
    for skin in SKINS {
        let text = format!("name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\n{skin}");
        let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep");
        (0..sweep.grid().len()).for_each(|index| check(&sweep, index));
    }
}

/// Rows for the critical state omit the values along the path, and have all others.
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
                // A count of zero is a number, too.
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

/// A column solved alone has the value and the derivatives that it has among all others.
#[test]
fn a_column_solved_alone_equals_the_column_of_a_whole_row() {
    let unloaded = "[designs]\ngap_over_t = 0.2\nlength_over_t = 0.4\nslant_deg = 60\n\
                    [contact]\nfriction = 0.2\n[flexure]\nunbend = true\n\
                    [puncture]\nplaces = 3\nunload = true\n[array]\nacross = true";
    let bodies = "[designs]\ngap_over_t = 0.2\nlength_over_t = 0.4\nslant_deg = 60\n\
                  [body]\nradius_over_t = 20\nradius_to_over_t = 10";
    let (mut compared, mut left_out) = (0, 0);
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
                // Parameters of a part that is left out have no derivative instead of one of 0.
                derivatives.retain(|d| d.measure == column.name && d.left != Some(0.0));
                derivatives
            };
            assert_eq!(of_column(&alone), of_column(&whole), "{} of {skin}", column.name);
            compared += usize::from(!expected.is_empty());
            left_out += columns
                .iter()
                .filter(|other| other.cell(&alone).number() != other.cell(&whole).number())
                .count();
        }
    }
    assert!(compared > 100 && left_out > 500, "{compared} {left_out}");
}

/// `GapChange::beside` returns the same changes as `GapChange::solve`.
///
/// The latter also solves the nominal design.
#[test]
fn gap_changes_reuse_the_values_of_a_known_design() {
    for_each_skin(|sweep, index| {
        let number = sweep.grid().number(index).to_string();
        let columns =
            ["coverage", "critical_force", "weakest_force", "failure_force", "compliance"];
        let solved = GapChange::solve(sweep, &number, &columns, Patience::Unlimited);
        let solved = solved.expect("a design");
        let measured: Vec<(&str, f64)> =
            solved.measures.iter().map(|change| (change.column.as_str(), change.value)).collect();
        assert!(measured.len() > 2, "{solved:?}");
        let beside = GapChange::beside(sweep, &number, &measured, Patience::Unlimited);
        assert_eq!(beside.as_ref(), Some(&solved));
    });
}

/// Derivatives with respect to some parameters are the same as among all.
#[test]
fn selected_derivatives_equal_the_derivatives_among_all() {
    let keys = ["gap_over_t", "slant_deg", "c1", "needle_friction"];
    let chosen: Vec<&Parameter> = keys.into_iter().filter_map(Parameter::named).collect();
    let mut compared = 0;
    for_each_skin(|sweep, index| {
        let evaluator = Evaluator::new(&[sweep.measures(), &[Measure::Sensitivity]].concat());
        let (number, case) = (sweep.grid().number(index), sweep.grid().case(index));
        let mut all = evaluator.row(number, &case).result.sensitivity;
        all.retain(|derivative| keys.contains(&derivative.parameter));
        let mut some = evaluator.row_and_end(number, &case, Some(&chosen)).0.result.sensitivity;
        // The modulus gives the derivatives with respect to the prefactor of the contact law.
        some.retain(|derivative| keys.contains(&derivative.parameter));
        assert_eq!(some, all, "{index}");
        compared += some.len();
    });
    assert!(compared > 300, "{compared}");
}

/// The coverage of slanted scales changes with the gap as in the closed form.
///
/// Columns that are not measured are omitted.
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

//! The guides to sweeps and results agree with the program.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use optimisation::{DesignGoal, history_columns, optimum_columns};
use ranking::{
    COMPARISON_COLUMNS, Preferences, difference_columns, pareto_columns, quaternary_columns,
    ranking_columns, winner_columns,
};
use results::columns::{
    EVENTS, FLEXURE_EVENTS, FLEXURE_SCALES, FLEXURE_STEPS, LOAD_POSITIONS, SCALES, STEPS,
    design_columns, flexure_path_columns, path_columns, tip_force_columns, value_columns,
};
use results::{
    Column, DERIVATIVE_COLUMNS, MEASURE_COLUMNS, Outcome, RERUN_COLUMNS, failure_detail_columns,
};
use skin::puncture::Needle;
use sweep::{PARAMETERS, Sweep};

/// Parses a sweep.
fn sweep(text: &str) -> Sweep {
    Sweep::parse(text, "x.toml", &[]).expect("a valid sweep")
}

/// Parses a goal.
fn goal(text: &str) -> DesignGoal {
    DesignGoal::parse(text, "x.toml", &[]).expect("a valid goal")
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../.."))
}

fn text(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).expect("a file of the project")
}

fn read(file: &str) -> Sweep {
    Sweep::read(&root().join(file), &[]).expect("a valid sweep")
}

fn columns<R>(columns: &[Column<R>]) -> String {
    let mut table = "| Column | Unit | Meaning |\n|---|---|---|\n".to_owned();
    for column in columns {
        let _ = writeln!(table, "| `{}` | {} | {} |", column.name, column.unit, column.meaning);
    }
    table
}

/// Material of definitions with all columns in physical units.
const MATERIAL: &str = "[material]\nthickness_mm = 1\nsubstrate_modulus_MPa = 1\nmembrane_modulus_MPa = 1\nscale_density_kg_m3 = 1";

/// Requests for additional columns: words of the heading in the guide, and keys of a definition.
const REQUESTS: [(&str, &str); 10] = [
    ("a guided needle", "puncture.needle = 'guided'"),
    ("`puncture.depth_over_t` or `depth_mm`", "puncture.depth_over_t = 0.2"),
    ("`puncture.places`", "puncture.places = 2"),
    ("`puncture.failure = true` or a strength", "puncture.failure = true"),
    ("`puncture.force_N` or `force_over_substrate`", "puncture.force_N = 1"),
    ("`puncture.unload = true`", "puncture.unload = true"),
    ("`flexure.unbend = true`", "flexure.unbend = true"),
    ("`contact.friction`", "contact.friction = 0.1"),
    ("`array.across = true` or a gap across", "array.across = true"),
    ("`body.radius_to_over_t`", "body.radius_over_t = 16\nbody.radius_to_over_t = 30"),
];

/// Returns title and table of the columns that each request adds to `designs.csv`.
fn requested_columns() -> impl Iterator<Item = Section> {
    REQUESTS.into_iter().map(|(words, request)| {
        let [plain, mut added] = ["", request].map(|request| {
            let text = format!("name = 'x'\nimperfection.gap_cv = 0.1\n{request}\n{MATERIAL}");
            design_columns(&sweep(&text))
        });
        let known: HashSet<_> = plain.into_iter().map(|column| column.name).collect();
        added.retain(|column| !known.contains(&column.name));
        (format!("`designs.csv`, with {words} in addition"), columns(&added))
    })
}

/// Title and table of a section of the guide.
type Section = (String, String);

/// Returns sections from their titles and tables.
fn sections<const N: usize>(all: [(&str, String); N]) -> impl Iterator<Item = Section> {
    all.into_iter().map(|(title, table)| (title.to_owned(), table))
}

/// Returns the sections on the columns of `designs.csv`, without requested columns.
fn sections_of_designs() -> impl Iterator<Item = Section> {
    let plain = design_columns(&sweep("name = 'x'"));
    let imperfect = design_columns(&sweep("name = 'x'\nimperfection.gap_cv = 0.1"));
    let mut in_physical_units =
        design_columns(&sweep(&format!("name = 'x'\nimperfection.gap_cv = 0.1\n{MATERIAL}")));
    in_physical_units.retain(|column| !imperfect.iter().any(|of| of.name == column.name));
    let several = design_columns(&sweep("name = 'x'\npuncture.critical_tilt_deg = [5, 10]"));
    sections([
        ("`designs.csv`", columns(&plain)),
        ("`designs.csv`, with imperfections in addition", columns(&imperfect[plain.len()..])),
        (
            "`designs.csv`, with `puncture.critical_tilt_deg = [5, 10]` in addition",
            columns(&several[plain.len()..]),
        ),
        ("`designs.csv`, with a material in addition", columns(&in_physical_units)),
    ])
}

/// Returns the sections on statuses, failures and the tables of single designs.
fn sections_of_single_designs() -> impl Iterator<Item = Section> {
    let mut statuses = "| Status | Meaning |\n|---|---|\n".to_owned();
    for outcome in Outcome::ALL {
        let _ = writeln!(statuses, "| `{outcome}` | {} |", outcome.meaning());
    }
    sections([
        ("Statuses", statuses),
        (
            "`failures.csv`, after the columns that identify the design",
            columns(&failure_detail_columns()),
        ),
        ("`sensitivity.csv`", columns(DERIVATIVE_COLUMNS)),
        ("`reruns.csv`", columns(RERUN_COLUMNS)),
        ("`measures.csv`", columns(MEASURE_COLUMNS)),
        ("`path.csv`", columns(&path_columns(true, true))),
        ("`path.csv`, of a round tip in addition", columns(&tip_force_columns(&[vec![(0, 0.0)]]))),
        ("`events.csv`", columns(EVENTS)),
        ("`places.csv`", columns(LOAD_POSITIONS)),
        ("`scales.csv`", columns(SCALES)),
        ("`steps.csv`", columns(STEPS)),
        ("`flexure_path.csv`", columns(&flexure_path_columns(true))),
        ("`flexure_events.csv`", columns(FLEXURE_EVENTS)),
        ("`flexure_scales.csv`", columns(FLEXURE_SCALES)),
        ("`flexure_steps.csv`", columns(FLEXURE_STEPS)),
    ])
}

/// Returns the sections on the tables of rankings, searches and comparisons.
fn sections_of_rankings_and_searches() -> impl Iterator<Item = Section> {
    let paper = Preferences::paper();
    let geometry = &PARAMETERS[..3].iter().collect::<Vec<_>>();
    let fittest = goal(
        "name = 'x'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n[designs]\nlength_over_t = 1\nslant_deg = 45\n[goal]\nmaximize = 'fitness'",
    );
    let (best, known) = (optimum_columns(&fittest), design_columns(&sweep("name = 'x'")).len());
    let history = history_columns(&goal(
        "name = 'x'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n[designs]\nlength_over_t = 1\nslant_deg = 45\n[goal]\nmaximize = 'coverage'",
    ));
    sections([
        ("`ranking.csv`", columns(&ranking_columns(geometry, &paper))),
        ("`pareto.csv`", columns(&pareto_columns(geometry, &paper))),
        ("`winners.csv`", columns(&winner_columns(geometry, &paper))),
        ("`quaternary.csv`", columns(&quaternary_columns(geometry, &paper))),
        (
            "`optimum.csv` and `front.csv`, after the columns of `designs.csv`",
            columns(&best[known..]),
        ),
        (
            "`history.csv`, between `stage` and `shortfall` the variables and the objectives",
            columns(&history),
        ),
        ("`compare.csv`", columns(COMPARISON_COLUMNS)),
        ("`differences.csv`", columns(&difference_columns(geometry))),
    ])
}

#[test]
fn the_guide_to_the_results_explains_every_column() {
    let mut guide = text("results/README.md");
    guide = guide.split_off(guide.find("### `designs.csv`").expect("the first table"));
    let expected: Vec<_> = sections_of_designs()
        .chain(requested_columns())
        .chain(sections_of_single_designs())
        .chain(sections_of_rankings_and_searches())
        .map(|(title, table)| format!("### {title}\n\n{table}"))
        .collect();
    let expected = expected.join("\n");
    for column in value_columns() {
        let row = format!("\n| `{}` |", column.name);
        assert!(expected.contains(&row), "{}: no entry of REQUESTS requests it", column.name);
    }
    if std::env::var_os("UPDATE_GUIDE").is_some() {
        let file = root().join("results/README.md");
        let before = text("results/README.md").replace(&guide, "");
        std::fs::write(file, before + &expected).expect("the file is writable");
    } else {
        assert_eq!(guide, expected, "UPDATE_GUIDE=1 updates the guide");
    }
}

#[test]
fn the_paper_sweep_lists_every_key_with_its_default() {
    let paper = text("sweeps/paper.toml");
    for parameter in PARAMETERS {
        // Parameters without a default appear as a comment.
        let is_given = parameter.is_given(&sweep::Case::default());
        let remark = if is_given { "" } else { "# " };
        let line = format!("\n{remark}{} = ", parameter.key);
        // A length in mm is only mentioned, because the sweep sets the length divided by the
        // thickness.
        let listed = format!(" {}", parameter.key);
        let is_listed = paper.contains(if parameter.is_in_mm() { &listed } else { &line });
        assert!(is_listed, "{} is missing", parameter.path());
    }
    assert_eq!(read("sweeps/paper.toml").to_toml(), sweep("name = 'paper'").to_toml());
}

#[test]
fn the_other_sweeps_have_the_described_sizes_and_needles() {
    assert_eq!(read("sweeps/paper-as-written.toml").grid().len(), 720);
    assert_eq!(read("sweeps/paper-neo-hookean.toml").grid().len(), 720);
    assert_eq!(read("sweeps/smoke.toml").grid().len(), 12);
    assert_eq!(read("sweeps/sensitivity/coupling.toml").grid().len(), 2 * 6 * 8 * 6);
    assert_eq!(read("sweeps/imperfection.toml").grid().len(), 18);
    assert!(read("sweeps/imperfection.toml").is_imperfect());
    assert!(!read("sweeps/paper.toml").is_imperfect());
    let strong = DesignGoal::read(&root().join("sweeps/goals/strong-and-covered.toml"), &[]);
    assert_eq!(strong.expect("a valid goal").space.intervals().len(), 3);
    // Goals that recommend a design use a guided needle.
    let guided = DesignGoal::read(&root().join("sweeps/goals/strong-under-a-needle.toml"), &[]);
    let of_goal = guided.expect("a valid goal").space.sweep().grid().case(0).punctured();
    let [glove, smoke] = ["sweeps/glove.toml", "sweeps/smoke.toml"]
        .map(|file| read(file).grid().case(0).punctured());
    for puncture in [of_goal, glove, smoke] {
        assert_eq!(puncture.needle, Needle::Guided { friction: 0.3 });
        assert!(puncture.load_position < 1.0);
    }
    assert!(!read("sweeps/paper.toml").is_guided());
}

#[test]
fn the_contribution_guide_names_existing_files_and_code() {
    let guide = text("CONTRIBUTING.md");
    let words = guide.split(|c: char| c.is_whitespace() || "`()[]:,".contains(c));
    let folders = ["crates/", "scripts/", "docs/", "sweeps/", "results/"];
    let paths: Vec<_> =
        words.filter(|word| folders.iter().any(|folder| word.starts_with(folder))).collect();
    assert!(paths.len() > 10, "{paths:?}");
    for path in paths {
        // The examples write these files.
        let is_new = path.ends_with("commands/keys.rs") || path.starts_with("results/paper");
        assert!(root().join(path).exists() || is_new, "{path}");
    }
    for (file, code) in [
        ("crates/study/sweep/tests/sweep/definitions.rs", "fn a_name_alone_is_the_paper_sweep"),
        ("crates/apps/cli/tests/squama/bad_input.rs", "fn errors_suggest_valid_input"),
        ("crates/apps/python/python/squama/_manual.py", "__name__ == \"__main__\""),
    ] {
        assert!(text(file).contains(code), "{file}: {code}");
    }
}

/// The patches contain the code of the examples, and apply to the present source.
///
/// `scripts/check-examples` also builds and tests the result.
#[test]
fn the_examples_of_the_contribution_guide_apply() {
    let guide = text("CONTRIBUTING.md");
    for example in ["column", "parameter", "command"] {
        let file = format!("docs/contributing/{example}.patch");
        // `--reverse` succeeds if the example has been applied to the working tree.
        let applies = [&["--check"][..], &["--check", "--reverse"]].iter().any(|options| {
            let mut git = Command::new("git");
            git.arg("apply").args(*options).arg(&file).current_dir(root());
            git.status().expect("git runs").success()
        });
        assert!(applies, "{file} does not apply");
        let patch = text(&file);
        let added: HashSet<_> =
            patch.lines().filter_map(|line| line.strip_prefix('+')).map(str::trim).collect();
        let title = format!("\n## Example: add a {example}\n");
        let section = guide.split(&title).nth(1).expect("the example");
        let section = section.split("\n## ").next().unwrap_or(section);
        let blocks: Vec<_> = section.split("```").skip(1).step_by(2).collect();
        let code = blocks.iter().filter_map(|block| block.strip_prefix("rust\n"));
        let lines: Vec<_> = code.flat_map(str::lines).map(str::trim).collect();
        assert!(lines.len() > 2, "{example}: {lines:?}");
        for line in lines {
            assert!(line.is_empty() || added.contains(line), "{file} does not add: {line}");
        }
    }
}

#[test]
fn the_address_of_the_project_is_the_same_in_every_file() {
    let manifest = text("Cargo.toml");
    for (key, names) in
        [("homepage", ["url", "Homepage"]), ("repository", ["repository-code", "Repository"])]
    {
        let line = manifest.lines().find(|line| line.starts_with(&format!("{key} = ")));
        let address = line.expect("an address").split('"').nth(1).expect("UTF-8 text");
        let [citation, python] = names;
        assert!(text("CITATION.cff").contains(&format!("\n{citation}: {address}\n")), "{address}");
        let project = text("crates/apps/python/pyproject.toml");
        assert!(project.contains(&format!("\n{python} = \"{address}\"\n")), "{address}");
    }
}

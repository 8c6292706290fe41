//! `squama export`: workbooks of runs, searches and analyses, and write errors.

use crate::{FEW, Place};

#[test]
fn export_writes_the_tables_of_a_run_as_a_workbook() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r --set solver.max_points=3").assert().code(1);
    std::fs::create_dir(place.path("out")).expect("a folder");
    let text = place.prints("export r --xlsx out/x.xlsx");
    insta::assert_snapshot!(text, @r"
    out/x.xlsx
      designs         8 rows
      coverage        8 rows
      critical_force  8 rows
      penetration     8 rows
      compliance      8 rows
      failures        16 rows
    ");
    assert_eq!(place.list("out"), "x.xlsx");
}

/// The fitness in a ranking has no meaning without the criteria and weights in `ranking.toml`.
#[test]
fn rankings_without_preferences_are_rejected() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    place.prints("rank r");
    std::fs::remove_file(place.path("r/ranking.toml")).expect("a file");
    let message = place.refused("export r --xlsx x.xlsx");
    assert!(
        message.contains("ranking.toml: is missing") && message.contains("squama rank r"),
        "{message}"
    );
    assert!(!place.path("x.xlsx").exists());
    place.prints("rank r");
    place.prints("export r --xlsx x.xlsx");
}

#[test]
fn searches_and_analyses_are_exported_but_rejected_as_runs() {
    let place = Place::with(
        "name = 'x'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
         slant_deg = { from = 0, to = 60 }\n[designs]\nlength_over_t = 1\n[goal]\n\
         maximize = ['coverage', 'gap_over_t']\nsamples = 16\npoints = 4\n",
    );
    place.prints("optimise x.toml --out front -q");
    let text = place.prints("export front --xlsx f.xlsx");
    assert!(text.contains("  front") && text.contains("  history"), "{text}");
    let design = "name = 'y'\nmeasures = 'coverage'\ndesigns = { gap_over_t = 0.2, length_over_t = 1, slant_deg = 45 }\n\
                  tolerance.gap_over_t = { batch_sd = 0.02 }\n";
    std::fs::write(place.path("y.toml"), design).expect("writable");
    place.prints("tolerance y.toml --samples 20 --out t -q");
    insta::assert_snapshot!(place.prints("export t --xlsx t.xlsx"), @r"
    t.xlsx
      tolerance          1 row
      tolerance_sources  1 row
    ");
    // The sheet `columns` explains the columns of all other sheets.
    for book in ["f.xlsx", "t.xlsx"] {
        let mut book: calamine::Xlsx<_> =
            calamine::open_workbook(place.path(book)).expect("a workbook");
        let columns = calamine::Reader::worksheet_range(&mut book, "columns").expect("a sheet");
        assert!(columns.height() > 5);
        assert!(columns.cells().all(|(.., cell)| *cell != "no column of squama"));
    }
    insta::assert_snapshot!(place.refused("tolerance front"), @"error: front: holds a Pareto front; choose one design of it with --design, in squama design, draw or make");
    insta::assert_snapshot!(place.refused("make t --out x.stl"), @"error: t: holds an analysis and no designs; give the definition or the results folder of the run");
    insta::assert_snapshot!(place.refused("plot front"), @"error: front: holds a search, not a run; use squama export, or squama report front; its figures are in the folder");
    insta::assert_snapshot!(place.refused("plot t"), @"error: t: holds an analysis, not a run; use squama export; its figures are in the folder");
}

#[test]
fn folders_without_a_run_are_rejected() {
    let place = Place::with(FEW);
    insta::assert_snapshot!(place.refused("export . --xlsx x.xlsx"), @"error: .: contains no designs.csv, expected the folder of a run, a search, a tolerance analysis or a fit");
    insta::assert_snapshot!(place.refused("export . --xlsx x.csv"), @"error: x.csv: a workbook needs a name that ends in .xlsx");
    assert_eq!(place.list("."), "x.toml");
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_an_error_and_leaves_the_old_workbook() {
    let place = Place::with(FEW);
    let many = "designs.slant_deg={from=0,to=75,step=0.5}";
    place
        .squama(&format!("run x.toml -q --out r --set measures=coverage --set {many}"))
        .assert()
        .code(0);
    // Write a workbook first: the export would reject an existing file that squama did not write.
    place.prints("export r --xlsx r/x.xlsx");
    let old = std::fs::read(place.path("r/x.xlsx")).expect("a workbook");
    // The three limits end the export at its start, while rows are written to a temporary file, and
    // at its end.
    for blocks in [1, 20, 60] {
        let message = place.refused_on_a_full_disk(blocks, "export r --xlsx r/x.xlsx");
        assert_eq!(
            message,
            "error: r/x.xlsx: cannot be written (File too large), check free space\n"
        );
        assert!(std::fs::read(place.path("r/x.xlsx")).expect("a workbook") == old);
        assert!(!place.list("r").contains("partial"));
    }
}

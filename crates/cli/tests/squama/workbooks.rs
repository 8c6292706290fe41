//! `squama export`: the workbook of a run, and what happens when it cannot be written.

use crate::{FEW, Place};

#[test]
fn a_run_becomes_a_workbook() {
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

#[test]
fn a_folder_without_a_run_is_refused() {
    let place = Place::with(FEW);
    insta::assert_snapshot!(place.refused("export . --xlsx x.xlsx"), @"error: .: holds no designs.csv, expected the folder of a run");
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
    std::fs::write(place.path("r/x.xlsx"), "old").expect("writable");
    // Full at once, while rows are put aside, and at the very end.
    for blocks in [1, 20, 60] {
        let message = place.refused_on_a_full_disk(blocks, "export r --xlsx r/x.xlsx");
        assert_eq!(
            message,
            "error: r/x.xlsx: cannot be written (File too large), check free space\n"
        );
        assert_eq!(place.read("r/x.xlsx"), "old");
        assert!(!place.list("r").contains("partial"));
    }
}

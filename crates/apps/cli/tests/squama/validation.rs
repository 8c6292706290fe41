//! `squama validate` and its page, `docs/validation.md`.

use crate::agreement::disagreement;
use crate::{Place, long_campaigns};

#[test]
fn the_committed_validation_page_matches_the_output_of_validate() {
    let place = Place::new();
    // `prints` requires exit code 0, which means that every benchmark lies in its band.
    let options = if long_campaigns() { "" } else { "--quick" };
    let printed = place.prints(&format!("validate {options} --out page.md"));
    let page = place.read("page.md");
    assert_eq!(printed, page);
    let committed = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../docs/validation.md");
    let committed = std::fs::read_to_string(committed).expect("a page");
    let (sweeps, searches) =
        committed.split_once("\n## Between the grid points").expect("a section");
    // No grid contains a better design than the optimum of the search over the same ranges.
    assert!(searches.contains("neither equals nor dominates: 0."), "{searches}");
    let gains: Vec<&str> = searches.lines().filter(|line| line.ends_with(" % |")).collect();
    assert!(gains.len() == 5 && gains.iter().all(|row| row.contains("| +")), "{gains:?}");
    let differing = disagreement(&page, if long_campaigns() { &committed } else { sweeps });
    assert_eq!(differing, None, "write the page again with: cargo run --release -- validate");
}

#[test]
fn an_output_path_without_a_file_name_is_rejected() {
    let place = Place::new();
    insta::assert_snapshot!(place.refused("validate --out /"), @"error: --out /: not accepted, expected the name of a file");
}

#[test]
fn a_thicker_membrane_reproduces_the_loss_of_compliance() {
    let settings = "name = 'h'\n[designs]\nwidth_over_t = 3.15\ngaps = 42\nmembrane_thickness_over_t = [0.1, 0.5]\n";
    let place = Place::with(settings);
    let table = place.prints("validate --search x.toml");
    let [thin, thick] = ["0.1", "0.5"].map(|thickness| {
        let setting = format!("membrane_thickness_over_t = {thickness}");
        table.lines().find(|line| line.contains(&setting)).expect("a row")
    });
    assert!(thin.contains("| 17 | 10 |") && thin.contains("C21"), "{table}");
    assert!(thick.contains("| 17 | 11 |") && !thick.contains("C21"), "{table}");
}

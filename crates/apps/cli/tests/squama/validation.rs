//! The validation and its page.

use crate::agreement::disagreement;
use crate::{Place, long_campaigns};

#[test]
fn the_committed_page_matches_the_command() {
    let place = Place::new();
    // Every benchmark lies in its band.
    let options = if long_campaigns() { "" } else { "--quick" };
    let printed = place.prints(&format!("validate {options} --out page.md"));
    let page = place.read("page.md");
    assert_eq!(printed, page);
    let committed = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../docs/validation.md");
    let committed = std::fs::read_to_string(committed).expect("a page");
    let (sweeps, searches) =
        committed.split_once("\n## Between the grid points").expect("a section");
    // No grid has a better design than a search in its box finds.
    assert!(searches.contains("neither equals nor beats 0 of them."), "{searches}");
    let gains: Vec<&str> = searches.lines().filter(|line| line.ends_with(" % |")).collect();
    assert!(gains.len() == 5 && gains.iter().all(|row| row.contains("| +")), "{gains:?}");
    let differing = disagreement(&page, if long_campaigns() { &committed } else { sweeps });
    assert_eq!(differing, None, "write it again with: cargo run --release -- validate");
}

#[test]
fn a_page_without_a_name_is_refused() {
    let place = Place::new();
    insta::assert_snapshot!(place.refused("validate --out /"), @"error: --out /: not accepted, expected the name of a file");
}

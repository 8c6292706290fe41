//! The validation, and the page that says what came out of it.

use crate::Place;
use crate::agreement::disagreement;

#[test]
fn the_committed_page_says_what_the_command_finds() {
    let place = Place::new();
    // Every benchmark lies in its band.
    let printed = place.prints("validate --out page.md");
    let page = place.read("page.md");
    assert_eq!(printed, page);
    // No grid has a better design than a search in its box finds.
    assert!(page.contains("it equals or beats all but 0."), "{page}");
    let (_, between) = page.split_once("## Between the grid points").expect("a section");
    let gains: Vec<&str> = between.lines().filter(|line| line.contains(" % | ")).take(5).collect();
    assert!(gains.len() == 5 && gains.iter().all(|row| !row.contains("| -")), "{gains:?}");
    let committed = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/validation.md");
    let committed = std::fs::read_to_string(committed).expect("a page");
    let differing = disagreement(&page, &committed);
    assert_eq!(differing, None, "write it again with: cargo run --release -- validate");
}

#[test]
fn a_page_without_a_name_is_refused() {
    let place = Place::new();
    insta::assert_snapshot!(place.refused("validate --out /"), @"error: --out /: not accepted, expected the name of a file");
}

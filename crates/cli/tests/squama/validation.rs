//! The validation, and the page that says what came out of it.

use crate::Place;

#[test]
fn the_committed_page_is_what_the_command_writes() {
    let place = Place::new();
    // Every benchmark lies in its band.
    let printed = place.prints("validate --out page.md");
    let page = place.read("page.md");
    assert_eq!(printed, page);
    let committed = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/validation.md");
    let committed = std::fs::read_to_string(committed).expect("a page");
    let differing = page.lines().zip(committed.lines()).find(|(ours, theirs)| ours != theirs);
    assert_eq!(differing, None, "write it again with: cargo run --release -- validate");
    assert_eq!(page, committed);
}

#[test]
fn a_page_without_a_name_is_refused() {
    let place = Place::new();
    let output = place.squama("validate --out /").assert().code(2).get_output().stderr.clone();
    let message = String::from_utf8(output).expect("text");
    insta::assert_snapshot!(message, @"error: --out /: not accepted, expected the name of a file");
}

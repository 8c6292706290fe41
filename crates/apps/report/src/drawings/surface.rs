//! The surface of the substrate where two bases have passed each other.

use contact::Pose;
use geometry::Row;

use super::bodies::corners;
use super::view::View;
use crate::colors::RED;
use crate::svg::{Element, line};

/// Returns the strips of surface that are folded over, in red: each from the right end of a base back to the left end of the next.
pub(super) fn folds(row: &Row, view: &View, poses: &[(i64, Pose)]) -> Element {
    let strip = |[from, to]: [[f64; 2]; 2]| line(view.place(from), view.place(to), RED, 2.6);
    Element::group("folds").containing(folded(row, poses).map(strip))
}

/// Formats in how many gaps the surface is folded over; empty if in none.
pub(super) fn folds_label(row: &Row, poses: &[(i64, Pose)]) -> String {
    match folded(row, poses).count() {
        0 => String::new(),
        1 => ",  surface folded over in 1 gap".to_owned(),
        count => format!(",  surface folded over in {count} gaps"),
    }
}

/// The ends of the strips that are folded over: the base to the right begins before the one to the left ends.
fn folded<'a>(row: &'a Row, poses: &'a [(i64, Pose)]) -> impl Iterator<Item = [[f64; 2]; 2]> + 'a {
    poses.windows(2).filter_map(|pair| {
        let [[_, from, ..], [to, ..]] =
            [&pair[0], &pair[1]].map(|(i, pose)| corners(row, *i as f64, pose));
        (to[0] <= from[0]).then_some([from, to])
    })
}

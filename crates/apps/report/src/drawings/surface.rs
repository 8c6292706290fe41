//! Folds of the substrate surface, where two neighbouring bases cross.

use contact::Pose;
use geometry::{Body, Row};

use super::bodies::corners;
use super::view::View;
use crate::colors::RED;
use crate::svg::{Element, line};

/// Draws the folded strips of the surface in red.
///
/// Each strip runs from the right end of a base back to the left end of the next base.
pub(super) fn folds(row: &Row, body: Body, view: &View, poses: &[(i64, Pose)]) -> Element {
    Element::group("folds").containing(
        folded(row, body, poses).map(|[from, to]| line(view.place(from), view.place(to), RED, 2.6)),
    )
}

/// Returns the end of a caption with the number of gaps with a fold; empty without folds.
pub(super) fn folds_label(row: &Row, poses: &[(i64, Pose)]) -> String {
    match folded(row, Body::default(), poses).count() {
        0 => String::new(),
        1 => ",  surface folded over in 1 gap".to_owned(),
        count => format!(",  surface folded over in {count} gaps"),
    }
}

/// Returns both ends of each strip of surface that is folded.
///
/// A strip is folded if the right base begins left of the end of the left base. On a curved body,
/// displacements along the surface decide, as in the mechanics.
fn folded<'a>(
    row: &'a Row,
    body: Body,
    poses: &'a [(i64, Pose)],
) -> impl Iterator<Item = [[f64; 2]; 2]> + 'a {
    poses.windows(2).filter_map(move |pair| {
        let [[from, to], ends] = [Body::default(), body].map(|body| {
            let [[_, from, ..], [to, ..]] =
                [&pair[0], &pair[1]].map(|(i, pose)| corners(row, body, *i as f64, pose));
            [from, to]
        });
        (to[0] <= from[0]).then_some(ends)
    })
}

//! Tests of cells that are graded towards the edges of a rectangle.

use substrate::Footprint;
use substrate::mesh::{GradedAxis, Mesh};

fn assert_graded(axis: &GradedAxis) {
    let edges = axis.edges();
    assert_eq!(edges.len(), axis.cells() + 1);
    for (k, point) in axis.points().iter().enumerate() {
        assert!(edges[k] < *point && *point < edges[k + 1], "cell {k}: {edges:?}, {point}");
    }
}

#[test]
fn collocation_points_lie_inside_their_cells() {
    for layer in [1e-9, 1e-3, 0.1, 2.0, 1e3] {
        let axis = GradedAxis::graded([-1.0, 1.0], [layer, 2.0], 9);
        assert_graded(&axis);
        assert_eq!((axis.edges()[0], axis.edges()[9]), (-1.0, 1.0));
        assert_graded(&GradedAxis::upper_half(40.0, layer, 7));
    }
}

/// The mapped coordinate `U` of (S4), added from both ends, grows equally across every cell.
#[test]
fn cells_are_equal_in_the_mapped_coordinate() {
    let (layers, length) = ([0.05, 0.7], 2.0);
    let axis = GradedAxis::graded([0.0, length], layers, 8);
    let mapped =
        |s: f64| 2.0 * ((s / layers[0]).sqrt().asinh() - ((length - s) / layers[1]).sqrt().asinh());
    let step = (mapped(length) - mapped(0.0)) / 8.0;
    for k in 0..8 {
        let (low, point, high) = (axis.edges()[k], axis.points()[k], axis.edges()[k + 1]);
        assert!((mapped(high) - mapped(low) - step).abs() < 1e-12);
        assert!((mapped(point) - mapped(low) - 0.5 * step).abs() < 1e-12);
    }
}

#[test]
fn an_upper_half_with_its_mirror_image_is_the_whole_axis() {
    let whole = GradedAxis::graded([-3.0, 3.0], [0.2, 0.2], 10);
    let half = GradedAxis::upper_half(3.0, 0.2, 5);
    for (a, b) in half.mirrored_edges().zip(whole.edges()) {
        assert!((a - b).abs() < 1e-14, "{a}, {b}");
    }
}

/// Cells on both sides of a gap of `1e-3 a` have similar widths; a gap of `1e-17 a` is not
/// resolved.
#[test]
fn cells_on_both_sides_of_a_gap_have_similar_widths() {
    let mesh = Mesh::row(&Footprint::new(1e-3, 2.0, 0.5).unwrap(), 1, 32);
    let here = 1.0 - mesh.middle.edges()[31];
    let there = mesh.neighbours[0].edges()[1] - 1.001;
    assert!(here > 0.0 && here < 1e-3 && (here / there).ln().abs() < 1.0, "{here:e}, {there:e}");
    assert!(mesh.is_resolved());
    assert!(!Mesh::row(&Footprint::new(1e-17, 2.0, 0.5).unwrap(), 1, 4).is_resolved());
}

//! The red areas in drawings are the intersections of the deformed scales.

use contact::Pose;
use skin::Design;
use skin::puncture::RowSnapshot;

use crate::{design, punctured, svg};

type Point = [f64; 2];

fn area(polygon: &[Point]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    0.5 * polygon.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
}

/// Clips a polygon to the left side of the line from `a` to `b`.
fn clipped(polygon: &[Point], a: Point, b: Point) -> Vec<Point> {
    let mut inside = Vec::new();
    for (k, &p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let [s, t] = [p, q].map(|p| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]));
        if s >= 0.0 {
            inside.push(p);
        }
        if (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0) {
            let f = s / (s - t);
            inside.push([0, 1].map(|i| p[i] + f * (q[i] - p[i])));
        }
    }
    inside
}

/// Returns the intersection area of two convex polygons, by clipping `a` at each edge of `b`.
fn intersection_area(a: &[Point; 4], b: &[Point; 4]) -> f64 {
    let edges = (0..4).map(|k| (b[k], b[(k + 1) % 4]));
    area(&edges.fold(a.to_vec(), |polygon, (from, to)| clipped(&polygon, from, to)))
}

/// Returns the corners of every scale, with the origin at the first node.
fn bodies(design: &Design, state: &RowSnapshot) -> Vec<[Point; 4]> {
    let row = design.row().expect("a valid row");
    state
        .scales
        .iter()
        .enumerate()
        .map(|(i, scale)| {
            let [x, y] = scale.displacement;
            let pose = Pose::new(x, y, scale.rotation_deg.to_radians());
            row.scale().corners().map(|corner| {
                let turned = pose.turn(corner);
                [i as f64 * row.pitch() + x + turned.x, y + turned.y]
            })
        })
        .collect()
}

/// Returns index of the left scale, and area in px², of every red polygon in a drawing.
fn red_areas(svg: &str) -> Vec<(usize, f64)> {
    let paths = svg.split("<path d=\"").skip(1).filter(|path| path.contains("data-left=\""));
    let parsed = paths.map(|path| {
        let data = path.split('"').next().expect("data");
        let points: Vec<Point> = data
            .trim_end_matches(" Z")
            .split(['M', 'L'])
            .filter(|part| !part.trim().is_empty())
            .map(|part| {
                let mut numbers = part.split_whitespace().map(|n| n.parse().expect("a number"));
                [numbers.next().expect("an x coordinate"), numbers.next().expect("a y coordinate")]
            })
            .collect();
        let left = path.split("data-left=\"").nth(1).and_then(|rest| rest.split('"').next());
        (left.expect("the index of the left scale").parse().expect("a number"), area(&points).abs())
    });
    parsed.collect()
}

/// Returns the length of `t` in a drawing, px, which is the height of a scale at rest.
fn scale(svg: &str) -> f64 {
    let ghost =
        svg.split("class=\"at-rest\"").nth(1).and_then(|rest| rest.split("<path d=\"").nth(1));
    let numbers: Vec<f64> = ghost
        .and_then(|path| path.split('"').next())
        .expect("an outline")
        .split([' ', 'M', 'L', 'Z'])
        .filter_map(|part| part.parse().ok())
        .collect();
    numbers[1] - numbers[5]
}

/// Asserts that the red area of each pair of neighbours is their intersection.
///
/// Returns the largest intersection, in units of `t²`.
fn agree(slant: f64, modulus: f64) -> f64 {
    let design = design(slant);
    let mut largest: f64 = 0.0;
    for state in punctured(&design, modulus) {
        let drawn = svg(&design, std::slice::from_ref(&state));
        let unit = scale(&drawn).powi(2);
        let bodies = bodies(&design, &state);
        let red = red_areas(&drawn);
        for (left, pair) in bodies.windows(2).enumerate() {
            let expected = intersection_area(&pair[0], &pair[1]);
            let own = red.iter().filter(|(l, _)| *l == left).map(|(_, area)| area / unit);
            let found: f64 = own.sum();
            largest = largest.max(expected);
            // Drawings state the height of a scale to a hundredth of a px.
            assert!(
                (found - expected).abs() <= 2e-3 * expected + 1e-13,
                "slant {slant}, pair {left}: drawn {found:e}, expected {expected:e}"
            );
        }
    }
    largest
}

#[test]
fn overlaps_of_soft_contacts_are_drawn_with_their_areas() {
    for (slant, modulus) in [(0.0, 0.1), (45.0, 2.0), (75.0, 2.0)] {
        let largest = agree(slant, modulus);
        assert!(largest > 1e-7, "slant {slant}: no overlap to compare, {largest:e}");
    }
}

#[test]
fn overlaps_of_nearly_rigid_contacts_are_drawn_with_their_areas() {
    let largest = agree(45.0, 9677.0);
    assert!(largest < 1e-10, "{largest:e}");
}

#[test]
fn every_contact_has_a_halo() {
    let design = design(45.0);
    let states = punctured(&design, 9677.0);
    let state = &states[1];
    assert!(!state.contacts.is_empty());
    let drawn = svg(&design, std::slice::from_ref(state));
    assert_eq!(drawn.matches("fill-opacity=\"0.22\"").count(), state.contacts.len());
}

#[test]
fn snapshots_are_equilibria_at_the_requested_points() {
    let states = punctured(&design(45.0), 9677.0);
    assert!((states[0].displacement - 0.15).abs() < 1e-11);
    assert!((states[1].tilt_deg - 10.0).abs() < 1e-10);
    assert!((states[2].force - 0.05).abs() < 1e-11);
    for state in states {
        // The reactions of the substrate add up to the load. For L/t = 1, both have the same unit.
        let carried: f64 = state.scales.iter().map(|scale| scale.reaction).sum();
        assert!((carried - state.force).abs() < 1e-8 * state.force, "{carried} {}", state.force);
    }
}

#[test]
fn drawings_are_reproducible() {
    let design = design(45.0);
    let [one, other] = [(); 2].map(|()| svg(&design, &punctured(&design, 9677.0)));
    assert_eq!(one, other);
}

#[cfg(feature = "png")]
#[test]
fn images_are_reproducible() {
    let design = design(45.0);
    let [one, other] = [(); 2]
        .map(|()| report::png(&svg(&design, &punctured(&design, 9677.0)), 96.0).expect("an image"));
    assert!(one == other);
}

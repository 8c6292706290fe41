//! Generators of random elements and gaps with large rotations.

use std::f64::consts::TAU;

use membrane::{CorotationalBeam, Ends, GapMembrane, OffsetBeam, RigidArm, Section, Span};
use nalgebra::{DVector, Vector2};
use proptest::prelude::*;

/// Generates an element with stiffnesses of order one.
pub fn beam() -> impl Strategy<Value = CorotationalBeam> {
    (0.3..2.0, 0.2..5.0, 0.02..1.0).prop_filter_map("valid", |(length, axial, bending)| {
        CorotationalBeam::new(length, axial, bending).ok()
    })
}

/// Position and rotation of the first node of a random chain.
type Start = (f64, f64, f64);

/// Element of a random chain: stretch ratio, end rotations, and full turns of the second end.
///
/// The end rotations are relative to the chord.
type Link = (f64, [f64; 2], i32);

fn start() -> impl Strategy<Value = Start> {
    (-4.0..4.0, -4.0..4.0, -20.0..20.0)
}

fn link() -> impl Strategy<Value = Link> {
    (0.7..1.4, prop::array::uniform2(-2.5..2.5), -3..=3)
}

/// Returns the poses of the nodes of a deformed chain of elements.
///
/// `rest` is the length of each element at rest.
fn chain_poses(rest: f64, start: Start, links: &[Link]) -> Vec<[f64; 3]> {
    let mut node = [start.0, start.1, start.2];
    let mut nodes = vec![node];
    for &(stretch, [first, second], turns) in links {
        let chord = node[2] - first;
        let (sin, cos) = chord.sin_cos();
        node[0] += stretch * rest * cos;
        node[1] += stretch * rest * sin;
        node[2] = chord + second + TAU * f64::from(turns);
        nodes.push(node);
    }
    nodes
}

/// Generates an element with its ends rotated by up to 2.5 rad from the chord.
pub fn bent_beam() -> impl Strategy<Value = (CorotationalBeam, Ends)> {
    (beam(), start(), link()).prop_map(|(beam, start, link)| {
        let nodes = chain_poses(beam.length(), start, &[link]);
        (beam, Ends::from_iterator(nodes.concat()))
    })
}

fn arm() -> impl Strategy<Value = RigidArm> {
    (-1.0..1.0, -1.0..1.0).prop_map(|(x, y)| RigidArm::new(Vector2::new(x, y)))
}

/// Generates an element between two random arms, and the poses of the two bodies.
pub fn bent_offset_beam() -> impl Strategy<Value = (OffsetBeam, Ends)> {
    (bent_beam(), arm(), arm()).prop_map(|((beam, ends), first, second)| {
        let levers = [first.lever(ends[2]), second.lever(ends[5])];
        let mut bodies = ends;
        for (lever, start) in levers.iter().zip([0, 3]) {
            bodies[start] -= lever.x;
            bodies[start + 1] -= lever.y;
        }
        (OffsetBeam { beam, arms: [first, second] }, bodies)
    })
}

/// Generates a gap of one to four elements, with displacements far from rest.
pub fn bent_gap() -> impl Strategy<Value = (GapMembrane, DVector<f64>)> {
    let span = (0.0..1.0, 0.5..2.0, -0.3..0.3).prop_map(|(half_base, gap, axis_offset)| Span {
        half_base,
        gap,
        axis_offset,
    });
    let links = proptest::collection::vec(link(), 1..=4);
    (span, start(), links).prop_filter_map("valid", |(span, start, links)| {
        let section = Section::new(1.0, 0.5).ok()?;
        let gap = GapMembrane::new(section, span, links.len()).ok()?;
        let mut nodes = chain_poses(span.gap / links.len() as f64, start, &links);
        to_scale_node(&mut nodes[0], span.half_base, span.axis_offset);
        let last = links.len();
        to_scale_node(&mut nodes[last], -span.half_base, span.axis_offset);
        Some((gap, DVector::from_vec(nodes.concat()) - gap.rest()))
    })
}

/// Replaces the pose of an end of the membrane by the pose of the node of its scale.
///
/// The end is at `(x, −e)` in the frame of the scale, where `e` is `axis_offset`.
fn to_scale_node(pose: &mut [f64; 3], x: f64, axis_offset: f64) {
    let lever = RigidArm::new(Vector2::new(x, -axis_offset)).lever(pose[2]);
    pose[0] -= lever.x;
    pose[1] -= lever.y;
}

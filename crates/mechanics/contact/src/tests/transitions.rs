//! Transitions of [`CornerContact`]: one test per row of its table, and tests of the other cases.

use geometry::Parallelogram;

use super::tips::under_the_base;
use crate::corner_contact::CornerContact::{Corner, Edge, Flush, Open};
use crate::corner_contact::{CornerContact, Force, Transition};
use crate::corners::{Corners, Level};
use crate::gap::CornerEdge::{BottomLeftOnBase, BottomLeftOnRightEdge, BottomRightOnLeftEdge};
use crate::gap::{CornerEdge, Pair, Pose};

/// Returns the transition of a contact at the lower level of [`under_the_base`].
///
/// `short_of_level` is the angle in degrees by which the right scale must rotate until its left
/// side is parallel to the base of the left scale.
fn next(
    contact: CornerContact,
    (force, acts): (Force, bool),
    short_of_level: f64,
    forces: [f64; 3],
) -> Option<Transition> {
    let (pair, [left, right]) = under_the_base(15.0 - short_of_level, 0.3, 0.0);
    let corners = Corners::new(Level::Lower, &pair, [&left, &right]);
    contact.transition(force, acts, &corners, forces)
}

/// Creates the expected transition.
fn to(contact: CornerContact, forces: [f64; 3], valid: Force) -> Transition {
    Transition { contact, forces, valid }
}

const BEGINS: bool = true;
const VANISHES: bool = false;

#[test]
fn an_open_contact_closes_on_the_edge_that_a_corner_faces() {
    for (short, edge) in [(1.0, BottomRightOnLeftEdge), (-1.0, BottomLeftOnBase)] {
        let closed = next(Open, (Force::Own, BEGINS), short, [0.0; 3]);
        assert_eq!(closed, Some(to(Edge(edge), [0.0; 3], Force::Own)));
    }
}

#[test]
fn an_edge_contact_without_force_opens() {
    let opened = next(Edge(BottomLeftOnBase), (Force::Own, VANISHES), -1.0, [0.0; 3]);
    assert_eq!(opened, Some(to(Open, [0.0; 3], Force::Own)));
}

#[test]
fn an_edge_contact_that_reaches_the_end_of_its_edge_becomes_a_corner_contact() {
    for edge in [BottomLeftOnBase, BottomRightOnLeftEdge, BottomLeftOnRightEdge] {
        let reached = next(Edge(edge), (Force::Partner, BEGINS), 1.0, [0.7, 0.0, 0.0]);
        assert_eq!(reached, Some(to(Corner(edge), [0.7, 0.0, 0.0], Force::Partner)));
    }
}

/// At rest the facing sides of equal scales are parallel.
#[test]
fn an_edge_contact_between_parallel_sides_switches_to_the_other_edge_at_the_corner() {
    let pair = Pair::new(Parallelogram::new(0.4, 30.0).unwrap(), 1.0);
    let rest = Pose::new(0.0, 0.0, 0.0);
    let forces = [0.7, 0.0, 0.0];
    for (level, edge, partner) in [
        (Level::Lower, BottomRightOnLeftEdge, BottomLeftOnRightEdge),
        (Level::Lower, BottomLeftOnRightEdge, BottomRightOnLeftEdge),
        (Level::Upper, CornerEdge::TopRightOnLeftEdge, CornerEdge::TopLeftOnRightEdge),
        (Level::Upper, CornerEdge::TopLeftOnRightEdge, CornerEdge::TopRightOnLeftEdge),
    ] {
        let corners = Corners::new(level, &pair, [&rest; 2]);
        let passed = Edge(edge).transition(Force::Partner, BEGINS, &corners, forces);
        assert_eq!(passed, Some(to(Edge(partner), forces, Force::Partner)));
    }
    let (flush, corners) =
        (Flush(BottomRightOnLeftEdge), Corners::new(Level::Lower, &pair, [&rest; 2]));
    assert_eq!(
        flush.transition(Force::Partner, BEGINS, &corners, [0.7, 0.0, 0.2]),
        Some(to(Edge(BottomLeftOnRightEdge), [0.7 + 0.2, 0.0, 0.0], Force::Partner))
    );
}

#[test]
fn an_edge_contact_becomes_flush_if_the_flush_force_begins_to_act() {
    for edge in [BottomLeftOnBase, BottomRightOnLeftEdge] {
        let flush = next(Edge(edge), (Force::Flush, BEGINS), 0.0, [0.7, 0.0, 0.0]);
        assert_eq!(flush, Some(to(Flush(edge), [0.7, 0.0, 0.0], Force::Flush)));
    }
}

#[test]
fn a_corner_contact_without_its_own_force_becomes_the_edge_contact_of_the_partner() {
    for (short, edge, partner) in [
        (1.0, BottomRightOnLeftEdge, BottomLeftOnRightEdge),
        (-1.0, BottomLeftOnBase, BottomLeftOnRightEdge),
        (1.0, BottomLeftOnRightEdge, BottomRightOnLeftEdge),
        (-1.0, BottomLeftOnRightEdge, BottomLeftOnBase),
    ] {
        let changed = next(Corner(edge), (Force::Own, VANISHES), short, [0.0, 0.4, 0.0]);
        assert_eq!(changed, Some(to(Edge(partner), [0.4, 0.0, 0.0], Force::Partner)));
    }
}

#[test]
fn a_corner_contact_without_partner_force_moves_to_the_edge_selected_by_the_inclination() {
    for (short, edge, leaves) in [
        (1.0, BottomLeftOnBase, BottomRightOnLeftEdge),
        (-1.0, BottomRightOnLeftEdge, BottomLeftOnBase),
        (1.0, BottomLeftOnRightEdge, BottomLeftOnRightEdge),
    ] {
        let changed = next(Corner(edge), (Force::Partner, VANISHES), short, [0.7, 0.0, 0.0]);
        assert_eq!(changed, Some(to(Edge(leaves), [0.7, 0.0, 0.0], Force::Partner)));
    }
}

#[test]
fn a_flush_contact_without_its_own_force_continues_at_the_other_end() {
    for (edge, other) in
        [(BottomLeftOnBase, BottomRightOnLeftEdge), (BottomRightOnLeftEdge, BottomLeftOnBase)]
    {
        let changed = next(Flush(edge), (Force::Own, VANISHES), 0.0, [0.0, 0.0, 0.2]);
        assert_eq!(changed, Some(to(Edge(other), [0.2, 0.0, 0.0], Force::Flush)));
    }
}

#[test]
fn a_flush_contact_that_reaches_the_corner_adds_both_forces() {
    let reached = next(Flush(BottomLeftOnBase), (Force::Partner, BEGINS), 0.0, [0.7, 0.0, 0.2]);
    assert_eq!(reached, Some(to(Corner(BottomLeftOnBase), [0.7 + 0.2, 0.0, 0.0], Force::Partner)));
}

#[test]
fn a_flush_contact_without_the_flush_force_returns_to_its_edge() {
    let changed = next(Flush(BottomLeftOnBase), (Force::Flush, VANISHES), 0.0, [0.7, 0.0, 0.0]);
    assert_eq!(changed, Some(to(Edge(BottomLeftOnBase), [0.7, 0.0, 0.0], Force::Flush)));
}

#[test]
fn the_state_stays_the_same_if_a_force_vanishes_that_does_not_act() {
    let edge = Edge(BottomLeftOnBase);
    for (contact, force) in [
        (Open, Force::Own),
        (Open, Force::Partner),
        (Open, Force::Flush),
        (edge, Force::Partner),
        (edge, Force::Flush),
        (Corner(BottomLeftOnBase), Force::Flush),
        (Flush(BottomLeftOnBase), Force::Partner),
    ] {
        let forces = [0.3, 0.0, 0.0];
        assert_eq!(next(contact, (force, VANISHES), 1.0, forces), Some(to(contact, forces, force)));
    }
}

#[test]
fn there_is_no_transition_for_a_force_that_cannot_begin_to_act() {
    let forces = [0.3, 0.0, 0.0];
    for (contact, force) in
        [(Open, Force::Partner), (Open, Force::Flush), (Corner(BottomLeftOnBase), Force::Flush)]
    {
        assert_eq!(next(contact, (force, BEGINS), 1.0, forces), None);
    }
    // An open contact cannot close if no corner faces an edge.
    let pair = Pair::new(Parallelogram::new(0.5, 60.0).unwrap(), 3.0);
    let (far_below, rest) = (Pose::new(0.0, -0.6, 0.0), Pose::new(0.0, 0.0, 0.0));
    let corners = Corners::new(Level::Upper, &pair, [&far_below, &rest]);
    assert_eq!(Open.transition(Force::Own, BEGINS, &corners, [0.0; 3]), None);
}

#[test]
fn each_state_returns_its_acting_forces_and_its_edge() {
    let edge = BottomLeftOnBase;
    assert_eq!((Open.acting(), Open.edge()), ([false, false, false], None));
    assert_eq!((Edge(edge).acting(), Edge(edge).edge()), ([true, false, false], Some(edge)));
    assert_eq!((Corner(edge).acting(), Corner(edge).edge()), ([true, true, false], Some(edge)));
    assert_eq!((Flush(edge).acting(), Flush(edge).edge()), ([true, false, true], Some(edge)));
}

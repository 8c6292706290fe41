//! Drawings of contacts: overlaps in red, halos, and forces along their lines of action.

use skin::Contact;

use super::view::View;
use crate::colors::RED;
use crate::svg::{Element, Spot, arrow, circle, path_data};

/// Length of the arrow of the largest force, px.
pub(super) const LONGEST: f64 = 64.0;
/// Minimum length of an arrow, px. Shorter arrows are omitted.
const SHORTEST: f64 = 2.5;

/// Draws the overlaps without magnification.
///
/// Nearly rigid scales overlap by a millionth of their thickness, so coordinates keep all digits.
pub(super) fn overlaps(view: &View, polygons: &[(usize, Vec<[f64; 2]>)]) -> Element {
    Element::group("overlaps").containing(polygons.iter().map(|(left, points)| {
        Element::new("path")
            .with("d", path_data(&view.all(points), true, |length| length.to_string()))
            .with("fill", RED)
            .with("data-left", left.to_string())
    }))
}

/// Draws a halo and a dot at each contact, so that contacts with tiny overlaps are visible.
///
/// The halo of a slipping contact is a ring.
pub(super) fn halos(view: &View, contacts: &[Contact], radius: f64) -> Element {
    Element::group("contacts").containing(contacts.iter().flat_map(|contact| {
        let center = view.place(contact.point);
        let halo = circle(center, radius);
        [
            if contact.slips == Some(true) {
                halo.with("fill", "none").with("stroke", RED)
            } else {
                halo.with("fill", RED).with("fill-opacity", "0.22")
            },
            circle(center, 0.3 * radius).with("fill", RED),
        ]
    }))
}

/// Draws the forces on both scales of each contact as arrows from the contact point.
///
/// A force of 1 has a length of `unit` px.
pub(super) fn forces(view: &View, contacts: &[Contact], unit: f64) -> Element {
    Element::group("contact-forces").containing(contacts.iter().flat_map(|contact| {
        let from = view.place(contact.point);
        [1.0, -1.0]
            .map(|side| force(from, contact.force.map(|f| side * f), unit))
            .into_iter()
            .flatten()
    }))
}

fn force(from: Spot, force: [f64; 2], unit: f64) -> Option<Element> {
    let to = [from[0] + unit * force[0], from[1] - unit * force[1]];
    let long = unit * force[0].hypot(force[1]) > SHORTEST;
    long.then(|| arrow(from, to, "#8f0013", 1.5))
}

/// Returns the magnitude of the largest contact force.
pub(super) fn largest(contacts: &[Contact]) -> f64 {
    contacts.iter().map(|contact| contact.force[0].hypot(contact.force[1])).fold(0.0, f64::max)
}

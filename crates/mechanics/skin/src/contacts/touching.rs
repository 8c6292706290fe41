//! Corners on edges, with the geometry of their contact forces.

use contact::{COORDINATES, CornerContact, CornerEdge};
use geometry::Vec2;

use super::pair_unknowns::PairUnknowns;
use super::{Contacts, LEVELS, SkinState};

/// Function of the six unknowns of a pair, with its derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PairCoordinate {
    pub(crate) value: f64,
    pub(crate) slopes: [f64; COORDINATES],
    pub(crate) curvature: [[f64; COORDINATES]; COORDINATES],
}

/// A corner on an edge of the neighbour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TouchingEdge {
    /// Number of the contact.
    pub(crate) contact: usize,
    /// Left and right scale of the pair.
    pub(crate) ends: [usize; 2],
    pub(crate) edge: CornerEdge,
    /// Unknown of the force and its value.
    pub(crate) unknown: usize,
    pub(crate) force: f64,
    /// Unknowns of the left and of the right scale.
    pub(crate) at: [usize; COORDINATES],
    /// Position of the corner along the edge, from the node, in the direction of the outward normal
    /// turned by 90° counter-clockwise.
    pub(crate) slide: PairCoordinate,
    /// Rotation of the right scale relative to the left one.
    pub(crate) turn: PairCoordinate,
    /// Outward normal of the edge, in the frame of its scale.
    pub(crate) normal: Vec2,
    /// Corner, in the frame of the scale to which it belongs.
    pub(crate) corner: Vec2,
}

impl Contacts {
    /// Lists the corners that carry a force on an edge.
    pub(crate) fn closed_edges(&self, state: &SkinState) -> Vec<TouchingEdge> {
        let contacts = state.mode.contacts.iter().enumerate();
        contacts
            .filter_map(|(contact, mode)| self.touching_edge(state, contact, mode.edge()?))
            .collect()
    }

    /// Iterates over the corners of a scale or on its edges that carry a force.
    pub(crate) fn closed_edges_of(
        &self,
        state: &SkinState,
        scale: usize,
    ) -> impl Iterator<Item = TouchingEdge> {
        let contacts = state.mode.contacts.iter().enumerate();
        let own = contacts
            .filter(move |(contact, _)| self.ends(Self::pair_of(*contact)).contains(&scale));
        own.filter_map(|(contact, mode)| self.touching_edge(state, contact, mode.edge()?))
    }

    /// Returns the corner that faces an edge at an open contact.
    pub(crate) fn facing_edge(&self, state: &SkinState, contact: usize) -> Option<TouchingEdge> {
        let is_open = state.mode.contacts[contact] == CornerContact::Open;
        self.edge_at(state, contact).filter(|_| is_open)
    }

    /// Returns the corner that rests on an edge or, at an open contact, faces one.
    pub(crate) fn edge_at(&self, state: &SkinState, contact: usize) -> Option<TouchingEdge> {
        if !self.is_whole(Self::pair_of(contact)) {
            return None;
        }
        let edge = state.mode.contacts[contact].edge().or_else(|| {
            let poses = self.pair_poses(&state.z, contact);
            Some(self.corners(contact, &poses).facing()?.0)
        })?;
        self.touching_edge(state, contact, edge)
    }

    /// Lists the contacts of the pairs with one of the scales marked in `bent`.
    pub(crate) fn contacts_beside(&self, bent: &[bool]) -> Vec<usize> {
        self.whole_pairs()
            .filter(|&pair| self.ends(pair).iter().any(|&scale| bent[scale]))
            .flat_map(Self::contacts_of)
            .collect()
    }

    /// Returns the number of the contact of a normal force, or `None` for other constraints.
    pub(crate) fn contact_of_own_force(&self, constraint: usize) -> Option<usize> {
        let (contact, slot) = self.contact_of(constraint);
        (slot == 0).then_some(contact)
    }

    /// Returns the constraint of the normal force of a contact.
    pub(crate) fn own_force(&self, contact: usize) -> usize {
        self.slots * contact
    }

    /// Returns the overlap that bending permits a pair in addition to its contact law.
    ///
    /// `openings` holds the opening of each contact by bending.
    pub(crate) fn pair_slack(openings: &[f64], pair: usize) -> f64 {
        openings[LEVELS.len() * pair..][..LEVELS.len()].iter().copied().fold(0.0, f64::max)
    }

    fn touching_edge(
        &self,
        state: &SkinState,
        contact: usize,
        edge: CornerEdge,
    ) -> Option<TouchingEdge> {
        let index = Self::pair_of(contact);
        let ends = self.ends(index);
        let pair = self.pair(index);
        let [left, right] = self.pair_poses(&state.z, contact);
        let unknowns = self.pair_unknowns(contact);
        let slide = pair.slide(edge, &left, &right);
        let (at, slopes) = unknowns.in_unknowns(&slide.gradient)?;
        let curvature = unknowns.square_in_unknowns(&slide.curvature.hessian());
        let slide = PairCoordinate { value: slide.value, slopes, curvature };
        let turn = PairCoordinate {
            value: right.rotation - left.rotation,
            slopes: [0.0, 0.0, -1.0, 0.0, 0.0, 1.0],
            ..PairCoordinate::default()
        };
        let of_corner = usize::from(!edge.corner_is_left());
        let unknown = self.forces[self.slots * contact];
        Some(TouchingEdge {
            contact,
            ends,
            edge,
            unknown,
            force: state.z[unknown],
            at,
            slide,
            turn,
            normal: pair.normal(edge),
            corner: pair.scales()[of_corner].corner(edge.corner()),
        })
    }
}

impl PairUnknowns {
    /// Returns the six unknowns of the pair in a row, and the derivatives in these unknowns.
    ///
    /// `None` for a strip.
    fn in_unknowns(
        self,
        slopes: &[f64; COORDINATES],
    ) -> Option<([usize; COORDINATES], [f64; COORDINATES])> {
        let at =
            |[left, right]: [usize; 2]| [left, left + 1, left + 2, right, right + 1, right + 2];
        match self {
            Self::Blocks(scales) => Some((at(scales), *slopes)),
            Self::Curved(scales, frame) => {
                Some((at(scales), super::pair_unknowns::local(slopes, &frame)))
            }
            Self::Parts(_) => None,
        }
    }

    fn square_in_unknowns(
        self,
        square: &[[f64; COORDINATES]; COORDINATES],
    ) -> [[f64; COORDINATES]; COORDINATES] {
        match self {
            Self::Curved(_, frame) => super::pair_unknowns::local_square(square, &frame),
            _ => *square,
        }
    }
}

//! Corners in contact with edges, with the geometry of their forces, for elastic scales.

use contact::{COORDINATES, CornerContact, CornerEdge};
use geometry::Vec2;

use super::pair_unknowns::PairUnknowns;
use super::{Contacts, LEVELS, SkinState};

/// Function of the six unknowns of a pair, with first and second derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PairCoordinate {
    pub(crate) value: f64,
    pub(crate) slopes: [f64; COORDINATES],
    pub(crate) curvature: [[f64; COORDINATES]; COORDINATES],
}

/// A corner that touches or faces an edge of a neighbouring scale.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TouchingEdge {
    /// Number of the contact.
    pub(crate) contact: usize,
    /// Left and right scale of the pair.
    pub(crate) ends: [usize; 2],
    pub(crate) edge: CornerEdge,
    /// Index of the unknown normal force.
    pub(crate) unknown: usize,
    /// Value of the normal force.
    pub(crate) force: f64,
    /// Indices of the three unknowns of the left scale and the three of the right scale.
    pub(crate) at: [usize; COORDINATES],
    /// Slip coordinate: position of the corner along the edge.
    ///
    /// It counts from the node of the scale with the edge, in the direction of the outward normal
    /// turned by 90° counter-clockwise.
    pub(crate) slide: PairCoordinate,
    /// Rotation of the right scale minus the rotation of the left scale.
    pub(crate) turn: PairCoordinate,
    /// Outward normal of the edge, in the frame of the scale with the edge.
    pub(crate) normal: Vec2,
    /// Position of the corner, in the frame of the scale with the corner.
    pub(crate) corner: Vec2,
}

impl Contacts {
    /// Lists the closed contacts of all pairs.
    pub(crate) fn closed_edges(&self, state: &SkinState) -> Vec<TouchingEdge> {
        let contacts = state.mode.contacts.iter().enumerate();
        contacts
            .filter_map(|(contact, mode)| self.touching_edge(state, contact, mode.edge()?))
            .collect()
    }

    /// Iterates over the closed contacts of a scale with its neighbours.
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
    ///
    /// `None` if the contact is closed or no corner faces an edge.
    pub(crate) fn facing_edge(&self, state: &SkinState, contact: usize) -> Option<TouchingEdge> {
        let is_open = state.mode.contacts[contact] == CornerContact::Open;
        self.edge_at(state, contact).filter(|_| is_open)
    }

    /// Returns the corner that touches an edge or, at an open contact, faces an edge.
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

    /// Lists the contacts of all pairs in which at least one scale is marked in `bent`.
    pub(crate) fn contacts_beside(&self, bent: &[bool]) -> Vec<usize> {
        self.whole_pairs()
            .filter(|&pair| self.ends(pair).iter().any(|&scale| bent[scale]))
            .flat_map(Self::contacts_of)
            .collect()
    }

    /// Returns the contact with the normal force `λ` at a constraint; `None` for other constraints.
    pub(crate) fn contact_of_own_force(&self, constraint: usize) -> Option<usize> {
        let (contact, slot) = self.contact_of(constraint);
        (slot == 0).then_some(contact)
    }

    /// Returns the constraint number of the normal force `λ` of a contact.
    pub(crate) fn own_force(&self, contact: usize) -> usize {
        self.slots * contact
    }

    /// Returns the overlap that bending of the scales of a pair explains.
    ///
    /// The audit intersects rigid outlines, so it accepts this overlap in addition to the approach
    /// of the contact law. `openings` holds the increase of each gap by bending.
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
    /// Returns the indices of the six unknowns of a pair, and the derivatives in these unknowns.
    ///
    /// `slopes` are derivatives with respect to the coordinates of the pair. `None` for a strip.
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

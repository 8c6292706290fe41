//! Contact states of two corners and the transitions between them.

use crate::corners::Corners;
use crate::gap::CornerEdge;

/// Number of contact forces at one level of a pair.
///
/// Each force is an unknown with a complementarity condition.
pub const FORCES: usize = 3;

/// One of the three contact forces at one level of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Force {
    /// `λ`: own force, between the corner and the edge that are in contact.
    Own,
    /// `λ'`: force of the partner, the contact of the other corner with the other edge.
    Partner,
    /// `λ''`: force of the flush contact, at the other end of two edges that lie flush.
    Flush,
}

impl Force {
    /// The three forces, in the order of arrays with one entry per force.
    pub const ALL: [Self; FORCES] = [Self::Own, Self::Partner, Self::Flush];
}

/// Contact state of two corners at one level of a pair.
///
/// At each level corner `P` of the left scale and corner `Q` of the right scale may touch
/// ([`Corners`]). `P` may rest on an edge of the right scale that ends at `Q`, and `Q` on an edge
/// of the left scale that ends at `P`. `m_A` is the outward normal of the left edge of the right
/// scale, and `m_B` the inward normal of the right edge of the left scale; both point to the left.
/// With `D = P − Q` there are three contacts:
///
/// ```text
/// A,  P on the left edge:              force  λ m_A on P,  gap D·m_A
/// B,  Q on the right edge:             force −λ m_B on Q,  gap D·m_B
/// C,  P on the top or Q on the base:   force along the normal m_C of top or base, gap D·m_C
/// ```
///
/// One of `P` and `Q` is a tip, an acute corner. If the side that ends in the tip has rotated
/// beyond parallel to the neighbour's top or base, C replaces B (upper level) or A (lower level).
///
/// A corner that slides to the end of its edge reaches the other corner. While both corners stay
/// together, the force turns continuously from one normal to the other. The force is then the sum
/// `f` of two contact forces, and the law applies to this sum:
///
/// ```text
/// v ≡ D + δ(|f|) f/|f| = 0,    f = λ m + λ' m'                                     (C5)
/// ```
///
/// `λ`, `m` and `s` are the force, the normal and the edge direction of the own contact, `λ'` and
/// `m'` the force and the normal of its partner. `σ s` with `σ = ±1` points to the end of the edge
/// at which the other corner lies. As complementarity conditions,
///
/// ```text
/// 0 ≤ λ   ⟂   v·m ≥ 0         (closed or open)
/// 0 ≤ λ'  ⟂  −σ v·s ≥ 0       (at the end of the edge or short of it)              (C6)
/// ```
///
/// and `v·m = g + δ(λ)` while `λ' = 0`.
///
/// If the side that ends in the tip is parallel to the neighbour's top or base, both edges lie
/// flush: the neighbour's corner rests on the side, and the tip on the top or base. Both contacts
/// act while the force moves from one contact to the other, and the law applies to the sum of their
/// forces. `β ≥ 0` is the angle between the side and the top or base:
///
/// ```text
/// 0 ≤ λ    ⟂  g + δ(λ + λ'') ≥ 0
/// 0 ≤ λ''  ⟂  β ≥ 0                                                                (C7)
/// ```
///
/// The state changes if a force begins to act (+) or vanishes (−). `e`, `e'` and `e''` are the
/// corner and edge of the own contact, of its partner and of the flush contact. The outgoing path
/// must satisfy the condition of the force in the last column.
///
/// | State | Force | Next state | Forces | Condition of |
/// |---|---|---|---|---|
/// | `Open` | `λ` + | `Edge(e)`, `e` the corner that faces an edge | | `λ` |
/// | `Edge(e)` | `λ` − | `Open` | | `λ` |
/// | `Edge(e)` | `λ'` + | `Corner(e)` | | `λ'` |
/// | `Edge(e)`, sides parallel | `λ'` + | `Edge(e')` | | `λ'` |
/// | `Edge(e)` | `λ''` + | `Flush(e)` | | `λ''` |
/// | `Corner(e)` | `λ` − | `Edge(e')` | `λ ← λ'` | `λ'` |
/// | `Corner(e)` | `λ'` − | `Edge(e)`, by the current inclination of the side | | `λ'` |
/// | `Flush(e)` | `λ` − | `Edge(e'')` | `λ ← λ''` | `λ''` |
/// | `Flush(e)` | `λ'` + | `Corner(e)`, or `Edge(e')` where sides are parallel | `λ ← λ + λ''` | `λ'` |
/// | `Flush(e)` | `λ''` − | `Edge(e)` | | `λ''` |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerContact {
    /// No force acts.
    Open,
    /// A corner rests on an edge: `λ` acts.
    Edge(CornerEdge),
    /// Corner on corner: both corners coincide, `λ` and `λ'` act.
    ///
    /// The value is the corner and edge in contact before the corners coincided.
    Corner(CornerEdge),
    /// A side and the neighbour's top or base lie flush: `λ` and `λ''` act.
    ///
    /// The value is the corner and edge of `λ`.
    Flush(CornerEdge),
}

/// Change of the contact state when a force begins to act or vanishes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    /// Next state.
    pub contact: CornerContact,
    /// Values of the three forces in the next state.
    pub forces: [f64; FORCES],
    /// Force for which the outgoing path must satisfy the condition (C6) or (C7).
    pub valid: Force,
}

impl CornerContact {
    /// Returns the corner and edge of the own force `λ`, or `None` if the contact is open.
    pub fn edge(self) -> Option<CornerEdge> {
        match self {
            Self::Open => None,
            Self::Edge(edge) | Self::Corner(edge) | Self::Flush(edge) => Some(edge),
        }
    }

    /// Returns the corner and edge of the own force `λ` and of the flush force `λ''`.
    ///
    /// `None` for a force that does not act in this state.
    pub fn carrying(self) -> [Option<CornerEdge>; 2] {
        let flush = if let Self::Flush(edge) = self { edge.flush() } else { None };
        [self.edge(), flush]
    }

    /// Returns true for each force that acts in this state, in the order of [`Force::ALL`].
    pub fn acting(self) -> [bool; FORCES] {
        match self {
            Self::Open => [false, false, false],
            Self::Edge(_) => [true, false, false],
            Self::Corner(_) => [true, true, false],
            Self::Flush(_) => [true, false, true],
        }
    }

    /// Returns the transition that occurs when `force` begins to act or vanishes.
    ///
    /// `acts` is true if the force begins to act; `forces` are the current values of all forces.
    /// The result follows the table of [`CornerContact`]. If a force vanishes that does not act,
    /// the state stays the same. `None` if the force cannot begin to act in this state.
    pub fn transition(
        self,
        force: Force,
        acts: bool,
        corners: &Corners,
        forces: [f64; FORCES],
    ) -> Option<Transition> {
        let [own, partner, flush] = forces;
        let (contact, forces, valid) = match (self, force, acts) {
            (Self::Open, Force::Own, true) => {
                // The state `Open` stores no corner, so find the corner that faces an edge now.
                (Self::Edge(corners.facing()?.0), forces, Force::Own)
            }
            (Self::Edge(edge) | Self::Flush(edge), Force::Partner, true) => {
                // In the state corner on corner one contact carries the forces of both contacts
                // of flush edges.
                let forces = [own + flush, partner, 0.0];
                (Self::reached_corner(edge, corners), forces, Force::Partner)
            }
            (Self::Edge(edge), Force::Flush, true) => (Self::Flush(edge), forces, Force::Flush),
            (Self::Edge(_), Force::Own, false) => (Self::Open, forces, Force::Own),
            (Self::Corner(edge), Force::Own, false) => {
                let [_, other] = corners.together(edge);
                // The partner becomes the own contact, so the two forces change places.
                (Self::Edge(other), [partner, own, flush], Force::Partner)
            }
            (Self::Corner(edge), Force::Partner, false) => {
                let [edge, _] = corners.together(edge);
                (Self::Edge(edge), forces, Force::Partner)
            }
            (Self::Flush(edge), Force::Own, false) => {
                (Self::Edge(edge.flush()?), [flush, partner, own], Force::Flush)
            }
            (Self::Flush(edge), Force::Flush, false) => (Self::Edge(edge), forces, Force::Flush),
            (_, force, false) => (self, forces, force),
            _ => return None,
        };
        Some(Transition { contact, forces, valid })
    }

    /// Returns the next state of a corner that has reached the end of its edge.
    fn reached_corner(edge: CornerEdge, corners: &Corners) -> Self {
        if corners.are_sides_parallel() {
            Self::Edge(corners.together(edge)[1])
        } else {
            Self::Corner(edge)
        }
    }
}

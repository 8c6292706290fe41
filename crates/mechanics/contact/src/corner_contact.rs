//! Contact states of two corners and the transitions between them.

use crate::corners::Corners;
use crate::gap::CornerEdge;

/// Contact forces at one level of a pair; each is an unknown with a condition.
pub const FORCES: usize = 3;

/// Force of a contact of two corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Force {
    /// `λ`: force of the corner on the edge on which it arrived.
    Own,
    /// `λ'`: force of the partner, the other corner on the other edge.
    Partner,
    /// `λ''`: force of the flush contact, at the other end of the two edges.
    Flush,
}

impl Force {
    /// The three forces in the order of their numbers.
    pub const ALL: [Self; FORCES] = [Self::Own, Self::Partner, Self::Flush];
}

/// Contact state of two corners at one level of a pair.
///
/// Corner `P` of the left and corner `Q` of the right scale ([`Corners`]) meet here. Each may rest
/// on an edge that ends in the other. With the normals `m_A` (of the right scale's left edge) and
/// `m_B` (inward, of the left scale's right edge), both pointing left, and `D = P − Q`:
///
/// ```text
/// A,  P on the left edge:              force  λ m_A on P,  gap D·m_A
/// B,  Q on the right edge:             force −λ m_B on Q,  gap D·m_B
/// C,  P on the top or Q on the base:   force along the normal m_C of that end, gap D·m_C
/// ```
///
/// C replaces A or B if the side of the tip leans beyond level. A corner that slides to the end of
/// its edge meets the other corner. The force cannot jump from one normal to the other: it turns
/// between them while the corners stay together. Both forces then act, and the law holds along
/// their sum,
///
/// ```text
/// v ≡ D + δ(|f|) f/|f| = 0,    f = λ m + λ' m'                                     (C5)
/// ```
///
/// With the contact's own force `λ`, normal `m` and edge direction `s`, the partner's `λ'` and
/// `m'`, and `σ = ±1` for the end of the edge with the partner, this becomes
///
/// ```text
/// 0 ≤ λ   ⟂   v·m ≥ 0         (closed or open)
/// 0 ≤ λ'  ⟂  −σ v·s ≥ 0       (at the end of the edge or short of it)              (C6)
/// ```
///
/// and `v·m = g + δ(λ)` while `λ' = 0`. If the side of the tip is level with the neighbour's end,
/// they lie flush: the corner rests on the side and the tip on the end. Both contacts act while the
/// force moves from one to the other, and the law holds for their sum. `β ≥ 0` is the angle by
/// which the side is short of level, or beyond level if only the tip rests:
///
/// ```text
/// 0 ≤ λ    ⟂  g + δ(λ + λ'') ≥ 0
/// 0 ≤ λ''  ⟂  β ≥ 0                                                                (C7)
/// ```
///
/// A force that begins to act (+) or vanishes (−) changes the state. `e` is the contact's own
/// corner and edge, `e'` the partner's, `e''` the flush one. The last column names the force with
/// the condition that the outgoing path must satisfy.
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
    /// The two corners coincide: `λ` and `λ'` act.
    ///
    /// The value is the corner and edge in contact before the corners coincided.
    Corner(CornerEdge),
    /// A side and the neighbour's end lie flush: `λ`, at the given edge, and `λ''` act.
    Flush(CornerEdge),
}

/// Result of a force that begins to act or vanishes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    /// Next state.
    pub contact: CornerContact,
    /// Values of the three forces in the next state.
    pub forces: [f64; FORCES],
    /// Force with the condition that the outgoing path must satisfy.
    pub valid: Force,
}

impl CornerContact {
    /// Returns the corner and edge of the force `λ`, or `None` if the contact is open.
    pub fn edge(self) -> Option<CornerEdge> {
        match self {
            Self::Open => None,
            Self::Edge(edge) | Self::Corner(edge) | Self::Flush(edge) => Some(edge),
        }
    }

    /// Returns the corners and edges of the loaded contacts: its own and the flush one.
    pub fn carrying(self) -> [Option<CornerEdge>; 2] {
        let flush = if let Self::Flush(edge) = self { edge.flush() } else { None };
        [self.edge(), flush]
    }

    /// Returns flags of the forces that act.
    pub fn acting(self) -> [bool; FORCES] {
        match self {
            Self::Open => [false, false, false],
            Self::Edge(_) => [true, false, false],
            Self::Corner(_) => [true, true, false],
            Self::Flush(_) => [true, false, true],
        }
    }

    /// Applies the table of transitions to the current `forces`.
    ///
    /// A force that has already vanished changes nothing. `None` if the force cannot act next in
    /// this state.
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
                // An open contact stores no corner, so determine the one that faces an edge at
                // closure.
                (Self::Edge(corners.facing()?.0), forces, Force::Own)
            }
            (Self::Edge(edge) | Self::Flush(edge), Force::Partner, true) => {
                // Corner on corner replaces both contacts of the flush edges.
                let forces = [own + flush, partner, 0.0];
                (Self::reached_corner(edge, corners), forces, Force::Partner)
            }
            (Self::Edge(edge), Force::Flush, true) => (Self::Flush(edge), forces, Force::Flush),
            (Self::Edge(_), Force::Own, false) => (Self::Open, forces, Force::Own),
            (Self::Corner(edge), Force::Own, false) => {
                let [_, other] = corners.together(edge);
                // The remaining force becomes the own force; the vanished one becomes the
                // partner's.
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

    /// Returns the state of a corner that has reached the end of its edge.
    fn reached_corner(edge: CornerEdge, corners: &Corners) -> Self {
        if corners.are_sides_parallel() {
            Self::Edge(corners.together(edge)[1])
        } else {
            Self::Corner(edge)
        }
    }
}

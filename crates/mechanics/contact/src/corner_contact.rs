//! The contact of two corners: its states, and how it passes from one to the next.

use crate::corners::Corners;
use crate::gap::CornerEdge;

/// Contact forces at one level of a pair, each an unknown with a condition of its own.
pub const FORCES: usize = 3;

/// One of the forces of a contact of two corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Force {
    /// `λ`: the force of the corner on the edge on which it came.
    Own,
    /// `λ'`: the force of the partner, the other corner on the other edge.
    Partner,
    /// `λ''`: the force of the flush contact, at the other end of two edges that lie on each other.
    Flush,
}

impl Force {
    /// The three forces, in the order in which they are numbered.
    pub const ALL: [Self; FORCES] = [Self::Own, Self::Partner, Self::Flush];
}

/// The state of the contact of two corners at one level of a pair.
///
/// Two corners meet here, `P` of the left and `Q` of the right scale ([`Corners`]), and each may rest on an
/// edge that ends in the other. With the normals `m_A` (of the right scale's left edge) and `m_B` (inward, of
/// the left scale's right edge), both pointing left, and `D = P − Q`:
///
/// ```text
/// A,  P on the left edge:              force  λ m_A on P,  gap D·m_A
/// B,  Q on the right edge:             force −λ m_B on Q,  gap D·m_B
/// C,  P on the top or Q on the base:   force along the normal m_C of that end, gap D·m_C
/// ```
///
/// C takes the place of A or B where the side of the tip leans beyond level. A corner that slides to the end of its
/// edge meets the other corner. The force cannot jump from one normal to the other: it turns between them while the
/// corners stay together. There both forces act, and the law holds along their sum,
///
/// ```text
/// v ≡ D + δ(|f|) f/|f| = 0,    f = λ m + λ' m'                                     (C5)
/// ```
///
/// With the contact's own force `λ`, normal `m` and edge direction `s`, `λ'` and `m'` those of its partner, and `σ = ±1` for
/// the end of the edge at which the partner waits, this is
///
/// ```text
/// 0 ≤ λ   ⟂   v·m ≥ 0         (closed or open)
/// 0 ≤ λ'  ⟂  −σ v·s ≥ 0       (at the end of the edge or short of it)              (C6)
/// ```
///
/// and `v·m = g + δ(λ)` while `λ' = 0`. While the side of the tip is level with the neighbour's end they lie flush: the
/// corner rests on the side and the tip on the end. Both contacts act while the force moves from one to the other, and
/// the law holds for their sum. With the angle `β ≥ 0` by which the side is short of level, or beyond it where the tip
/// alone rests,
///
/// ```text
/// 0 ≤ λ    ⟂  g + δ(λ + λ'') ≥ 0
/// 0 ≤ λ''  ⟂  β ≥ 0                                                                (C7)
/// ```
///
/// A force that begins to act (+) or vanishes (−) takes the contact to another state. `e` is the contact's own corner
/// and edge, `e'` the partner's, `e''` the flush one; the last column names the force whose condition has to hold as
/// the path goes on.
///
/// | State | Force | Next state | Forces | Condition of |
/// |---|---|---|---|---|
/// | `Open` | `λ` + | `Edge(e)`, `e` the corner that faces an edge | | `λ` |
/// | `Edge(e)` | `λ` − | `Open` | | `λ` |
/// | `Edge(e)` | `λ'` + | `Corner(e)` | | `λ'` |
/// | `Edge(e)`, sides parallel | `λ'` + | `Edge(e')` | | `λ'` |
/// | `Edge(e)` | `λ''` + | `Flush(e)` | | `λ''` |
/// | `Corner(e)` | `λ` − | `Edge(e')` | `λ ← λ'` | `λ'` |
/// | `Corner(e)` | `λ'` − | `Edge(e)`, as the side leans by now | | `λ'` |
/// | `Flush(e)` | `λ` − | `Edge(e'')` | `λ ← λ''` | `λ''` |
/// | `Flush(e)` | `λ'` + | `Corner(e)`, or `Edge(e')` where sides are parallel | `λ ← λ + λ''` | `λ'` |
/// | `Flush(e)` | `λ''` − | `Edge(e)` | | `λ''` |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerContact {
    /// No force acts.
    Open,
    /// A corner rests on an edge: `λ` acts.
    Edge(CornerEdge),
    /// The corners are together: `λ` and `λ'` act. The contact came here as the given one.
    Corner(CornerEdge),
    /// A side and the neighbour's end lie flush: `λ` and `λ''` act, `λ` that of the given one.
    Flush(CornerEdge),
}

/// The result of a force that begins to act or vanishes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    /// The next state.
    pub contact: CornerContact,
    /// The values of the three forces in the next state.
    pub forces: [f64; FORCES],
    /// The force whose condition has to hold as the path goes on.
    pub valid: Force,
}

impl CornerContact {
    /// The corner and edge that the force `λ` belongs to; `None` if the contact is open.
    pub fn edge(self) -> Option<CornerEdge> {
        match self {
            Self::Open => None,
            Self::Edge(edge) | Self::Corner(edge) | Self::Flush(edge) => Some(edge),
        }
    }

    /// The corners and edges of the contacts that carry: its own, and the flush one.
    pub fn carrying(self) -> [Option<CornerEdge>; 2] {
        let flush = if let Self::Flush(edge) = self { edge.flush() } else { None };
        [self.edge(), flush]
    }

    /// Which of the three forces act.
    pub fn acting(self) -> [bool; FORCES] {
        match self {
            Self::Open => [false, false, false],
            Self::Edge(_) => [true, false, false],
            Self::Corner(_) => [true, true, false],
            Self::Flush(_) => [true, false, true],
        }
    }

    /// The transition of the table above, from the values that the `forces` have. A force that has vanished already
    /// changes nothing. `None` if the force cannot act next in this state.
    pub fn transition(
        self,
        force: Force,
        acts: bool,
        corners: &Corners,
        forces: [f64; FORCES],
    ) -> Option<Transition> {
        let to = |contact, forces, valid| Some(Transition { contact, forces, valid });
        let [own, partner, flush] = forces;
        match (self, force, acts) {
            (Self::Open, Force::Own, true) => {
                // An open contact keeps no corner: what faces an edge as it closes counts.
                to(Self::Edge(corners.facing()?.0), forces, Force::Own)
            }
            (Self::Edge(edge) | Self::Flush(edge), Force::Partner, true) => {
                // Together, the corners are where both contacts of flush edges were.
                let forces = [own + flush, partner, 0.0];
                to(Self::reached_corner(edge, corners), forces, Force::Partner)
            }
            (Self::Edge(edge), Force::Flush, true) => to(Self::Flush(edge), forces, Force::Flush),
            (Self::Edge(_), Force::Own, false) => to(Self::Open, forces, Force::Own),
            (Self::Corner(edge), Force::Own, false) => {
                let [_, other] = corners.together(edge);
                // What stays is the own force now, and what has vanished that of the partner.
                to(Self::Edge(other), [partner, own, flush], Force::Partner)
            }
            (Self::Corner(edge), Force::Partner, false) => {
                let [edge, _] = corners.together(edge);
                to(Self::Edge(edge), forces, Force::Partner)
            }
            (Self::Flush(edge), Force::Own, false) => {
                to(Self::Edge(edge.flush()?), [flush, partner, own], Force::Flush)
            }
            (Self::Flush(edge), Force::Flush, false) => to(Self::Edge(edge), forces, Force::Flush),
            (_, force, false) => to(self, forces, force),
            _ => None,
        }
    }

    /// The state of a corner that has reached the end of its edge.
    fn reached_corner(edge: CornerEdge, corners: &Corners) -> Self {
        if corners.are_sides_parallel() {
            Self::Edge(corners.together(edge)[1])
        } else {
            Self::Corner(edge)
        }
    }
}

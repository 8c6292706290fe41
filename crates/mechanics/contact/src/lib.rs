//! Contact between neighbouring scales: a corner of one scale on an edge of the other.
//!
//! Scales are rigid except for a local compliance at their contacts: the force `λ` on a corner and
//! the approach `δ` of both scales obey a power law (Eq. 5 of Shafiei et al. 2021, doi
//! 10.1016/j.jmps.2020.104176). Every contact is a complementarity condition with its force as
//! unknown,
//!
//! ```text
//! 0 ≤ λ  ⟂  g(q) + δ(λ) ≥ 0
//! ```
//!
//! The gap `g` is a function of the poses `q` of both scales. The generalised force of the contact
//! on these poses is `λ ∇g` (Eq. 6).
//!
//! | Type | Role |
//! |---|---|
//! | [`Pose`], [`Pair`] | displacement and rotation of a scale; shapes of two neighbours at rest |
//! | [`CornerEdge`], [`Gap`] | a corner and an edge; the gap between them with its derivatives |
//! | [`Law`], [`ContactLaw`] | constants of the power law; the power law of one design |
//! | [`Approach`] | approach under a force, with its derivative |
//! | [`Level`], [`Corners`] | the two corners that may touch at the tops or bases of a pair |
//! | [`CornerContact`], [`Force`], [`Transition`] | contact state (open, on an edge, corner on corner, flush) and its transitions |
//! | [`CornerResponse`], [`Equation`] | contribution of a contact to a system, with derivatives |
//! | [`ContactStiffness`] | symmetric stiffness of a contact, for stability |
//! | [`overlaps`], [`overlap_polygon`], [`Overlap`] | overlapping scales, for audits and drawings |
//!
//! ```
//! use contact::{ContactLaw, CornerEdge, Law, Pair, Pose};
//! use geometry::Parallelogram;
//!
//! // Two upright blocks have a gap of 0.1; the left block is tilted clockwise by 0.05 radians.
//! let pair = Pair::new(Parallelogram::new(0.5, 0.0)?, 1.1);
//! let (left, right) = (Pose::new(0.0, 0.0, -0.05), Pose::new(0.0, 0.0, 0.0));
//! let gap = pair.gap(CornerEdge::TopRightOnLeftEdge, &left, &right);
//! assert!((gap.value - (0.1 - 0.05_f64.sin() + 0.5 * (1.0 - 0.05_f64.cos()))).abs() < 1e-15);
//!
//! let law = ContactLaw::new(Law::PRINTED, 1.0, 1.0, 7000.0)?;
//! // The approach under a unit force is tiny, because the contact is nearly rigid.
//! assert!(law.approach(1.0).value < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod corner_contact;
mod corners;
mod gap;
mod law;
mod overlap;
mod response;
mod stiffness;
#[cfg(test)]
mod tests;

pub use corner_contact::{CornerContact, FORCES, Force, Transition};
pub use corners::{Corners, Level};
pub use gap::{CornerEdge, Curvature, Gap, Pair, Pose, quarter};
pub use law::{Approach, ContactLaw, Law};
pub use overlap::{Overlap, overlap_polygon, overlaps};
pub use response::{COORDINATES, CornerResponse, Equation};
pub use stiffness::ContactStiffness;

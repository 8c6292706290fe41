//! Soft membrane that connects rigid scales, modelled gap by gap.
//!
//! The membrane is bonded to the bases of the scales and is rigid under them. In each gap it is a
//! thin strip in plane bending, linear elastic with small strains and arbitrarily large rotations.
//! Equilibria are stationary points of the energy
//!
//! `W = ½ ∫ (EA ε² + EI κ²) ds`
//!
//! with the strain `ε` and the curvature `κ` of the membrane axis. Two models of a gap exist: an
//! elastica, discretised by one spectral element, and a chain of co-rotational Euler–Bernoulli
//! elements, in which deformations are measured in a frame that rotates with each element.
//!
//! Lengths are in units of the scale thickness `t`, forces in units of `E_m t²` and moments in
//! units of `E_m t³`; angles are counter-clockwise. The state of an element is the [`NodePose`]
//! `(x, y, φ)` of each end. The state of a gap consists of displacements `(uₓ, u_y, φ)` from rest.
//! Rotations `φ` are unbounded real numbers, so several full turns are possible.
//!
//! | Type | Role |
//! |---|---|
//! | [`Section`] | depth and thickness of the membrane: `EA`, `EI` |
//! | [`CorotationalBeam`] | one element: energies, force, consistent tangent, end moments |
//! | [`RigidArm`] | kinematics of a point that is rigidly attached to a pose |
//! | [`OffsetBeam`] | an element between two rigid arms, as a function of the poses of two bodies |
//! | [`Span`] | dimensions of one gap |
//! | [`GapMembrane`] | the co-rotational elements of one gap, assembled between two scales |
//! | [`Elastica`] | the spectral element of one gap: the limit of infinitely many elements |
//! | [`Membrane`] | common interface of [`GapMembrane`] and [`Elastica`] |
//!
//! ```
//! use membrane::{GapMembrane, Section, Span};
//!
//! // Two cubes of 8 mm are glued 0.8 mm apart on a strip of 1 mm thickness. The right cube is
//! // rotated by 10° about its node.
//! let section = Section::new(1.0, 0.125)?;
//! let gap = GapMembrane::new(section, Span { half_base: 0.5, gap: 0.1, axis_offset: 0.0 }, 1)?;
//! let turned = nalgebra::DVector::from_vec(vec![0.0, 0.0, 0.0, 0.0, 0.0, 10_f64.to_radians()]);
//!
//! let response = gap.response(&turned);
//! assert!(response.bending_energy > 0.0 && response.axial_energy > 0.0);
//! assert!((response.force[1] + response.force[4]).abs() < 1e-15);
//! # Ok::<(), geometry::OutOfRange>(())
//! ```

mod corotational_beam;
mod elastica;
mod gap;
mod lobatto;
mod membrane;
mod rigid_arm;
mod section;

pub use corotational_beam::{CorotationalBeam, Ends, Local, Response, Stiffness};
pub use elastica::{Derivatives, Elastica, GapEnergies};
pub use gap::{GapMembrane, GapResponse, Span};
pub use membrane::Membrane;
pub use rigid_arm::{OffsetBeam, RigidArm};
pub use section::Section;

/// Position and rotation `(x, y, φ)` of a scale or of a node of the membrane.
pub type NodePose = nalgebra::Vector3<f64>;

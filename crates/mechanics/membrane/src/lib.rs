//! Soft membrane that carries the scales, one gap at a time.
//!
//! The membrane is bonded to the bases of rigid scales and is rigid under them. In each gap it is a
//! thin strip in plane bending: linear elastic with small strains, but with large rotations, like
//! the scales. Equilibria make its energy
//!
//! `W = ½ ∫ (EA ε² + EI κ²) ds`
//!
//! stationary, with the stretch `ε` of the axis and its curvature `κ`. Each gap is solved as an
//! elastica by one spectral element, or by co-rotational Euler–Bernoulli elements, with
//! deformations measured in a frame that rotates with the element.
//!
//! Lengths are in units of the scale thickness `t` and forces in units of `E_m t²`, so moments are
//! in units of `E_m t³`; angles are counter-clockwise. Elements take a [`NodePose`] `(x, y, φ)` of
//! each end, a gap the displacements `(uₓ, u_y, φ)` from rest. `φ` is an unbounded real number;
//! half turns and full turns are ordinary states.
//!
//! | Type | Role |
//! |---|---|
//! | [`Section`] | depth and thickness of the membrane: `EA`, `EI` |
//! | [`CorotationalBeam`] | one element: energies, force, consistent tangent, end moments |
//! | [`RigidArm`] | kinematics of a point that is rigidly attached to a pose |
//! | [`OffsetBeam`] | an element between two rigid arms, in terms of the poses that hold them |
//! | [`Span`], [`GapMembrane`] | geometry of one gap; its elements, assembled between two scales |
//! | [`Elastica`] | limit of infinitely many elements: one spectral element per gap |
//! | [`Membrane`] | either of the two, behind one interface |
//!
//! ```
//! use membrane::{GapMembrane, Section, Span};
//!
//! // 8 mm cubes glued 0.8 mm apart on a 1 mm strip; the right one is turned by 10° about its node.
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

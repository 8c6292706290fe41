//! Springs that represent an elastic substrate under a row of rigid rectangles.
//!
//! The rectangles are the bases of the scales. They have the size `2a × b` and the gaps `d`. Each
//! base loads its neighbours through the substrate, a half-space or a layer on a rigid base. Eq.
//! (1) of Shafiei, Pro, Martini and Barthelat (2021, doi 10.1016/j.jmps.2020.104176) describes a
//! row on a half-space by six coefficients `α` and `β`:
//!
//! ```text
//! F_x⁽ⁱ⁾ = E* a  [α_x u_x⁽ⁱ⁾ − β_x (u_x⁽ⁱ⁻¹⁾ + u_x⁽ⁱ⁺¹⁾)]      and the same in y
//! M⁽ⁱ⁾   = E* a³ [α_φ φ⁽ⁱ⁾ − β_φ (φ⁽ⁱ⁻¹⁾ + φ⁽ⁱ⁺¹⁾)]           E* = E_s / (1 − ν²)
//! ```
//!
//! The coefficients are the reactions of three rigid rectangles if the middle rectangle has a unit
//! displacement and its two neighbours are fixed. They depend only on `d/a`, `b/a` and Poisson's
//! ratio `ν` of the substrate. Equations (S1) to (S22), cited in this crate, are derived in
//! `docs/theory/model.md`.
//!
//! | Item | Content |
//! |---|---|
//! | [`Footprint`] | `d/a`, `b/a`, `ν` and thickness of the substrate, checked at construction |
//! | [`Bases`] | dimensions of the bases in any unit, from which a footprint is computed |
//! | [`Springs`] | the six coefficients of Eq. (1) and their estimated error |
//! | [`calibrate`] | computes the springs of a footprint from a table or by boundary elements |
//! | [`RowStiffness`], [`Coupling`], [`Neighbour`] | stiffness with more neighbours and cross terms |
//! | [`FarField`], [`Relief`] | closed-form motion of the scales beyond the last contact |
//! | [`StiffnessSlopes`] | derivatives of the stiffness with respect to the footprint |
//! | [`Calibrations`] | cache that solves each footprint once for all threads |
//! | [`SurfaceStrip`], [`SubstrateLaw`] | stretch and law of the surface between two bases |
//! | [`half_space`] | displacement under a uniformly loaded cell (Boussinesq, Cerruti) |
//! | [`layer`] | effect of a rigid base below a layer on the surface displacement |
//! | [`mesh`] | cells of a rectangle, graded towards its edges |
//! | [`table`] | springs tabulated as Chebyshev polynomials |
//! | [`boundary_element`] | collocation equations and the reactions of the rectangles |
//!
//! On a layer ([`Footprint::on_layer`]) horizontal forces, vertical forces and moments are coupled.
//! On the half-space, normal and tangential tractions are solved separately. This is exact at
//! `ν = 0.5`; at other ratios it neglects the coupling of the tractions (see
//! [`boundary_element::row_reactions`]).
//!
//! ```
//! use substrate::{Calibrations, Footprint};
//!
//! // Square bases of side 2a with gaps of a tenth of the side, on an incompressible substrate.
//! let footprint = Footprint::new(0.2, 2.0, 0.5)?;
//! let springs = Calibrations::default().get(&footprint)?;
//! assert!((springs.direct[1] - 3.376).abs() < 1e-3);
//! assert!((springs.coupling[1] - 1.082).abs() < 1e-3);
//! assert!(springs.error < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod boundary_element;
mod cache;
mod calibrations;
mod extrapolation;
mod far_field;
mod footprint;
pub mod half_space;
pub mod layer;
mod layered;
pub mod mesh;
mod row_solution;
mod row_stiffness;
mod springs;
mod stiffness_slopes;

mod strip;
pub mod table;

pub use boundary_element::Unresolved;
pub use calibrations::{Calibrations, calibrate};
pub use far_field::{FarField, Relief};
pub use footprint::{Bases, Footprint, FootprintParameter};
pub use row_stiffness::{Coupling, NEIGHBOURS, Neighbour, RowStiffness};
pub use springs::{Springs, extrapolated};
pub use stiffness_slopes::StiffnessSlopes;

pub use strip::{SubstrateLaw, SurfaceStrip, neo_hookean, shortening};

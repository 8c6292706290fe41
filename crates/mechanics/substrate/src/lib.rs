//! Springs equivalent to an elastic half-space under a row of rigid rectangles.
//!
//! The bases of the scales, `2a × b` at gaps `d`, rest on a substrate much deeper than they are
//! wide. Each base loads its neighbours through the substrate. Eq. (1) of Shafiei, Pro, Martini and
//! Barthelat (2021, doi 10.1016/j.jmps.2020.104176) condenses this to six coefficients,
//!
//! ```text
//! F_x⁽ⁱ⁾ = E* a  [α_x u_x⁽ⁱ⁾ − β_x (u_x⁽ⁱ⁻¹⁾ + u_x⁽ⁱ⁺¹⁾)]      and the same in y
//! M⁽ⁱ⁾   = E* a³ [α_φ φ⁽ⁱ⁾ − β_φ (φ⁽ⁱ⁻¹⁾ + φ⁽ⁱ⁺¹⁾)]           E* = E_s / (1 − ν²)
//! ```
//!
//! the reactions of three rigid rectangles to a unit displacement of the middle one while its
//! neighbours are fixed. They depend only on `d/a`, `b/a` and `ν`. The equations are numbered
//! (S1)–(S22) here and in `docs/theory/model.md`.
//!
//! | Type | Role |
//! |---|---|
//! | [`Footprint`] | parameters of the springs: `d/a`, `b/a`, `ν`, valid by construction |
//! | [`Bases`] | dimensions behind a footprint, in any unit |
//! | [`Springs`] | the six coefficients and their estimated error |
//! | [`calibrate`] | one footprint to its springs: from a table, elsewhere solved in milliseconds |
//! | [`RowStiffness`], [`Coupling`], [`Neighbour`] | stiffness with more neighbours and cross terms |
//! | [`FarField`], [`Relief`] | motion of the scales beyond the last contact, and their compliance |
//! | [`StiffnessSlopes`] | derivatives of the stiffness of a row with respect to the footprint |
//! | [`Calibrations`] | each footprint solved once, shared by all threads |
//! | [`SurfaceStrip`], [`SubstrateLaw`] | the surface between two bases: its stretch and its law |
//! | [`half_space`] | displacement under a uniformly loaded cell (Boussinesq, Cerruti) |
//! | [`layer`] | contribution of a rigid base below a layer |
//! | [`mesh`] | cells graded towards the edges and the gap |
//! | [`table`] | the springs as polynomials |
//! | [`boundary_element`] | collocation equations and the reactions of the rectangles |
//!
//! [`Footprint::on_layer`] makes the substrate a layer on a rigid base, which couples the force
//! along the row, the force across it and the moment. On the half-space, normal and tangential
//! tractions are treated separately. This is exact at `ν = 0.5` and otherwise neglects their
//! coupling (see [`boundary_element::row_reactions`]).
//!
//! ```
//! use substrate::{Calibrations, Footprint};
//!
//! // Square bases, a tenth of their side apart, on an incompressible substrate.
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

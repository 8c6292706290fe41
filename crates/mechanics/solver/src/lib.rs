//! Equilibrium paths of mixed complementarity systems.
//!
//! `n − 1` equations in `n` unknowns, one of them the load, define a curve of equilibria.
//! Conditions `0 ≤ z_c ⟂ r_c(z) ≥ 0` switch some of the equations on and off, so the curve has
//! kinks. This crate follows the curve from a first equilibrium to the point where the control
//! parameter, a chosen coordinate, reaches its target. It passes load maxima, turning points of the
//! control parameter, and kinks. It contains no mechanics.
//!
//! Each step aims at the first constraint predicted to change sides from the values and slopes of
//! the guards (N5). Newton's method evaluates equations and tangent in one pass and uses the same
//! factors for the point and for the direction of the path. At an event, the outgoing direction
//! solves a complementarity problem of rates (N6).
//!
//! | Type | Role |
//! |---|---|
//! | [`System`] | the problem: equations, tangent, constraints, control parameter |
//! | [`State`] | unknowns, active set, and the mode, which selects the form of the equations |
//! | [`Residual`], [`Control`] | values and sizes of the equations; a coordinate that measures the path |
//! | [`Continuation`], [`Equilibrium`] | iterator over the equilibria; one of them, with its directions |
//! | [`Event`], [`Change`] | changed constraints, extrema of the load, the target |
//! | [`Settings`], [`Termination`] | steps and tolerances; the reason for the end of a path |
//! | [`Peak`], [`Summit`] | the largest value of a quantity along the path, between points, too |
//! | [`Newton`], [`Condition`], [`NewtonFailure`] | one equilibrium, by Newton's method |
//! | [`Tangent`], [`Blocks`], [`BlockMatrix`] | derivatives of a row, in blocks |
//! | [`BlockElimination`] | elimination block by block towards the block of the load |
//! | [`BandMatrix`], [`BandLu`] | linear solves if blocks are not available or not safe |
//! | [`Linearisation`], [`AnchoredPoint`], [`PathAnchor`] | derivatives of a measured point |
//! | [`Neighbours`], [`MovedPoint`] | systems with a perturbed parameter, and their equilibria |
//! | [`TargetPoint`] | end of a path, from which ends of neighbouring paths are found |
//! | [`SkylineMatrix`] | symmetric matrices, and their number of negative eigenvalues |
//! | [`Bracket`] | root finding by false position |
//!
//! ```
//! use solver::{Control, Continuation, Residual, Settings, State, Termination, System, Tangent};
//!
//! /// Softening spring under the load `F = u (1 − u²)`, which has a maximum.
//! struct SnapThrough([Control; 1]);
//!
//! impl System for SnapThrough {
//!     type Mode = ();
//!
//!     fn size(&self) -> usize { 2 }
//!     fn half_bandwidth(&self) -> usize { 1 }
//!     fn load(&self) -> usize { 1 }
//!     fn controls(&self) -> &[Control] { &self.0 }
//!     fn mode_at_rest(&self) {}
//!     fn residual(&self, state: &State, residual: &mut Residual) {
//!         let z = &state.z;
//!         residual.clear(&[1.0, 1.0]);
//!         residual.add(0, z[0] * (1.0 - z[0] * z[0]));
//!         residual.add(0, -z[1]);
//!     }
//!     fn tangent(&self, state: &State, matrix: &mut impl Tangent) {
//!         let z = &state.z;
//!         matrix.add(0, 0, 1.0 - 3.0 * z[0] * z[0]);
//!         matrix.add(0, 1, -1.0);
//!     }
//! }
//!
//! // The control parameter u goes from 0 to 1: the load rises to 2/√27 at u = 1/√3, then falls to 0.
//! let system = SnapThrough([Control { index: 0, scale: 1.0 }]);
//! let rest = State::at_rest(&system);
//! let mut path = Continuation::new(system, rest, Settings::default());
//! let loads: Vec<f64> = path.by_ref().map(|point| point.state.z[1]).collect();
//! assert_eq!(path.termination(), Some(Termination::Reached));
//! let largest = loads.iter().copied().fold(0.0, f64::max);
//! assert!((largest - 2.0 / 27_f64.sqrt()).abs() < 1e-12);
//! assert!(loads.last().is_some_and(|load| load.abs() < 1e-12));
//! ```

mod block_elimination;
mod block_matrix;
mod bracket;
mod check;
mod continuation;
mod event;
mod event_location;
mod interruption;
mod linear;
mod newton;
mod peak;
mod progress;
mod rate_problem;
mod sensitivity;
mod settings;
mod skyline;
mod system;
mod tangent;
mod tangent_solver;
mod target_point;
mod termination;

pub use block_elimination::{BlockElimination, LARGEST_BLOCK, UnsafeBlock};
pub use block_matrix::{BlockMatrix, Blocks, FARTHEST_LINK, LINK};
pub use bracket::Bracket;
pub use check::{WrongDerivative, check_tangent};
pub use continuation::{Continuation, Equilibrium};
pub use event::{Change, Event};
pub use event_location::dip;
pub use interruption::{interrupt_paths, uninterrupted};
pub use linear::{BandLu, BandMatrix, SingularMatrix};
pub use newton::{Condition, Newton, NewtonFailure};
pub use peak::{Peak, Summit};
pub use progress::{PathProgress, report_progress};
pub use sensitivity::{AnchoredPoint, Linearisation, MovedPoint, Neighbours, PathAnchor};
pub use settings::Settings;
pub use skyline::SkylineMatrix;
pub use system::{Control, Residual, State, System};
pub use tangent::Tangent;
pub use target_point::TargetPoint;
pub use termination::Termination;

//! Equilibrium paths of mixed complementarity systems.
//!
//! `n − 1` equations in `n` unknowns, one of them the load, define a curve of equilibria, the path.
//! Constraints `0 ≤ z_c ⟂ r_c(z) ≥ 0` switch some of the equations on and off, so the path has
//! kinks. This crate follows the path from a first equilibrium to the point at which the control
//! parameter, a chosen unknown, reaches its target, also beyond load maxima, turning points of the
//! control parameter, and kinks. The crate is independent of mechanics.
//!
//! Each step aims at the next event, at which a constraint becomes active or inactive. The event is
//! predicted from the values and slopes of the guards (N5). Newton's method evaluates equations and
//! tangent in one pass and uses one factorisation for the point and for the direction of the path.
//! At an event, a complementarity problem of rates (N6) determines the outgoing direction.
//!
//! | Type | Role |
//! |---|---|
//! | [`System`] | interface of a problem: equations, tangent, constraints, control parameter |
//! | [`State`] | unknowns, active set, and the mode, which selects the form of the equations |
//! | [`Residual`] | values of the equations, with the sizes of their terms |
//! | [`Control`] | unknown that measures progress along the path |
//! | [`Continuation`] | iterator over the equilibria of a path |
//! | [`Equilibrium`] | equilibrium of a path, with incoming and outgoing direction |
//! | [`Event`], [`Change`] | change of constraints, extremum of the load, or end of the path |
//! | [`Settings`], [`Termination`] | step sizes and tolerances; reason for the end of a path |
//! | [`Peak`], [`Summit`] | largest value of a quantity on the path, also between its points |
//! | [`Newton`], [`Condition`], [`NewtonFailure`] | Newton's method for a single equilibrium |
//! | [`Tangent`] | interface for assembling derivatives in a matrix |
//! | [`Blocks`], [`BlockMatrix`] | block-tridiagonal matrices |
//! | [`BlockElimination`] | elimination block by block towards the block of the load |
//! | [`BandMatrix`], [`BandLu`] | band matrices, used where block elimination is not safe |
//! | [`AnchoredPoint`], [`PathAnchor`] | point of the path, with the condition that fixes it |
//! | [`Linearisation`] | derivatives of such a point with respect to parameters |
//! | [`Neighbours`], [`MovedPoint`] | systems with a perturbed parameter, and their equilibria |
//! | [`TargetPoint`] | end of a path, as a start for the ends of neighbouring paths |
//! | [`SkylineMatrix`] | symmetric matrices, and their number of negative eigenvalues |
//! | [`Bracket`] | root search by false position |
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
//! // The control parameter u grows from 0 to 1; the load rises to 2/√27 at u = 1/√3 and then falls
//! // to 0.
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

//! Equilibrium paths of mixed complementarity systems.

mod event;
mod linear;
mod newton;
mod path;
mod peak;
mod step;
mod stop;
mod system;

pub use event::{Change, Event};
pub use linear::{BandLu, BandMatrix, SingularMatrix};
pub use newton::{ActiveSet, Condition, Newton, NewtonFailure};
pub use path::{Path, Point};
pub use peak::Peak;
pub use step::Settings;
pub use stop::Stop;
pub use system::{Control, Residual, State, System};

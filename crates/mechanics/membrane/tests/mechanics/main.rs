//! Element and gap against finite differences, symmetries and closed forms.

mod cantilever;
mod elastica;
mod finite_differences;
mod gap;
mod mattiasson_elastica;
mod rigid_motion;
mod roll_up;
mod states;

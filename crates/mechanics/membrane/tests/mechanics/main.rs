//! Tests of elements and gaps by finite differences, symmetries and closed-form solutions.

mod cantilever;
mod elastica;
mod finite_differences;
mod gap;
mod mattiasson_elastica;
mod rigid_motion;
mod roll_up;
mod states;

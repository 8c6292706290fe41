//! Solves designs, one by one or in parallel.

mod across;
pub mod curve;
pub mod evaluator;
pub mod groups;
mod guard;
pub mod interleaved;
mod parts;
mod samples;
mod scatter;
mod sensitivity;
pub mod task;
pub mod work;
pub mod workers;
mod worst_body;

//! The promises of a run: rows that depend on nothing else, journals that survive, committed results.

mod fuzz;
mod journals;
mod reference;
mod rows;
mod sensitivity;

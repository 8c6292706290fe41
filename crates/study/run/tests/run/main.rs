//! Runs: independent rows, damaged journals, derivatives and reference results.

mod across;
mod bare_needle;
mod between;
mod curved_body;
mod fuzz;
mod hunt;
mod journals;
mod reference;
mod rows;
mod sensitivity;

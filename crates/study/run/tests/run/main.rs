//! Tests of runs: independence of rows, damaged journals, derivatives and reference results.

mod across;
mod bare_needle;
mod curved_body;
mod fuzz;
mod journals;
mod mixed_designs;
mod reference;
mod rows;
mod sensitivity;
mod worst_body;

//! Tests of searches with known optima, and of the derivatives that searches use.

mod brute_force;
mod columns;
mod fitness;
mod samples;
mod searches;

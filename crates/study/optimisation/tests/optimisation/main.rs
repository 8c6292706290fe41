//! Searches with known optima, and checks of their components.

mod brute_force;
mod columns;
mod fitness;
mod samples;
mod searches;

//! Searches with known answers, and what they rest on.

mod brute_force;
mod columns;
mod fitness;
mod samples;
mod searches;

//! Searches with known answers, and what they rest on.

mod columns;
mod searches;

//! Matrices of every shape against dense ones.

mod bands;
mod blocks;
mod skyline;

//! Tests of band, block and skyline matrices against dense matrices.

mod bands;
mod blocks;
mod skyline;

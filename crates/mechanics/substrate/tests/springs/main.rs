//! Half-space, boundary elements, and the equivalent springs.

mod convergence;
mod far_field;
mod kernels;
mod layers;
mod meshes;
mod plane_strain;
mod published;
mod rows;
mod shared;
mod slopes;
mod table;

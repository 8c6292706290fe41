//! Tests of the half-space, the boundary elements, the layer and the springs.

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

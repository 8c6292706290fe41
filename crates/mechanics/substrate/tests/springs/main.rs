//! The half-space, its boundary elements, and the springs that stand for it.

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

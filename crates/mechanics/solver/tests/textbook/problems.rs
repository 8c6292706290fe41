//! Problems with known solutions.

mod bratu;
mod one_constraint;
mod smooth;
mod string_over_floor;

use solver::Control;

pub use bratu::Bratu;
pub use one_constraint::{InactiveKink, OneConstraint, bump, corner, kink, two_laws};
pub use smooth::{
    SPRING, Stiff, arch, arch_on_spring, circle, column, jump, parabola, pushed_arch, root, step,
};
pub use string_over_floor::{DEPTH, StringOverFloor};

/// Creates controls from pairs of index and scale.
fn controls(controls: &[(usize, f64)]) -> Vec<Control> {
    controls.iter().map(|&(index, scale)| Control { index, scale }).collect()
}

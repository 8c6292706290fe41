//! The bending of a soft strip with upright blocks, up to their first contact.
//!
//! Blocks of base `2a` at gaps `d`, both over their height `t`, sit on a strip that bends in the gaps alone. A moment `M`
//! turns neighbours by `θ = M d/EI`, so that with `M* = M t/EI`, `κ* = κ t` and the pitch `p = 2a + d`
//!
//! ```text
//! κ* = θ/p,     M*/κ* = p/d
//! ```
//!
//! The tops of the blocks are nearer to the centre of curvature by 1 than the axis of the strip. They meet where the arc
//! of the gap, seen from there, has shrunk to nothing: `θ = d`, that is `M* = 1` and `κ* = d/p`, whatever the length of
//! the blocks. A gap of `m` straight elements is a polygon whose sides keep their length: its ends are
//! `d sin(θ/2)/(m sin(θ/2m))` apart, and the blocks meet where that is `2 sin(θ/2)`: `θ = 2m asin(d/2m)`, which tends
//! to `d` as `1/m²`.

/// Returns the ratio `M*/κ* = p/d` before contact.
pub fn moment_over_curvature(gap: f64, pitch: f64) -> f64 {
    pitch / gap
}

/// The moment `M*` at which blocks meet, whatever their shape.
pub const CONTACT_MOMENT: f64 = 1.0;

/// Returns the curvature `κ* = d/p` at which blocks meet.
pub fn contact_curvature(gap: f64, pitch: f64) -> f64 {
    gap / pitch
}

/// Returns the moment `M* = 2m asin(d/2m)/d` at which blocks meet with `elements` straight elements in a gap.
pub fn contact_moment_of_polygon(gap: f64, elements: usize) -> f64 {
    let m = elements as f64;
    2.0 * m * (gap / (2.0 * m)).asin() / gap
}

#[cfg(test)]
mod tests {
    use super::{CONTACT_MOMENT, contact_moment_of_polygon};

    #[test]
    fn the_polygon_tends_to_the_arc_with_the_square_of_the_elements() {
        let error = |elements| contact_moment_of_polygon(0.5, elements) - CONTACT_MOMENT;
        let order = (error(8) / error(16)).log2();
        assert!((order - 2.0).abs() < 1e-3, "{order}");
    }
}

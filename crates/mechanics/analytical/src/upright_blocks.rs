//! Bending of a soft strip with upright blocks, up to first contact.
//!
//! Blocks of base `2a` at gaps `d`, both over their height `t`, sit on a strip that bends only in
//! the gaps. A moment `M` rotates neighbours relative to each other by `θ = M d/EI`. With
//! `M* = M t/EI`, `κ* = κ t` and the pitch `p = 2a + d`,
//!
//! ```text
//! κ* = θ/p,     M*/κ* = p/d
//! ```
//!
//! The tops of the blocks are closer to the centre of curvature by 1 than the axis of the strip.
//! They meet when the arc of the gap at the level of the tops has shrunk to zero: `θ = d`, hence
//! `M* = 1` and `κ* = d/p` for any block length. A gap of `m` straight elements is a polygon with
//! sides of constant length. Its ends are `d sin(θ/2)/(m sin(θ/2m))` apart, and the blocks meet
//! where this equals `2 sin(θ/2)`: `θ = 2m asin(d/2m)`, which tends to `d` as `1/m²`.

/// Returns the ratio `M*/κ* = p/d` before contact.
pub fn moment_over_curvature(gap: f64, pitch: f64) -> f64 {
    pitch / gap
}

/// Moment `M*` at which blocks of any length meet.
pub const CONTACT_MOMENT: f64 = 1.0;

/// Returns the curvature `κ* = d/p` at which blocks meet.
pub fn contact_curvature(gap: f64, pitch: f64) -> f64 {
    gap / pitch
}

/// Returns the contact moment `M* = 2m asin(d/2m)/d` of a gap.
///
/// The gap has `m = elements` straight elements.
pub fn contact_moment_of_polygon(gap: f64, elements: usize) -> f64 {
    let m = elements as f64;
    2.0 * m * (gap / (2.0 * m)).asin() / gap
}

#[cfg(test)]
mod tests {
    use super::{CONTACT_MOMENT, contact_moment_of_polygon};

    #[test]
    fn the_polygon_tends_to_the_arc_with_the_square_of_the_elements() {
        let [coarse, fine] =
            [8, 16].map(|elements| contact_moment_of_polygon(0.5, elements) - CONTACT_MOMENT);
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 1e-3, "{order}");
    }
}

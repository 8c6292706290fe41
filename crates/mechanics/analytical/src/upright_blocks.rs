//! Bending of a soft strip with upright blocks, up to their first contact.
//!
//! Rigid blocks of height `t` and base `2a` are attached at gaps `d` to a strip, which bends only
//! in the gaps. `a` and `d` are in units of `t`. A moment `M` rotates two neighbours relative to
//! each other by `θ = M* d`. With `M* = M t/EI`, `κ* = κ t` and the pitch `p = 2a + d`,
//!
//! ```text
//! κ* = θ/p,     M*/κ* = p/d
//! ```
//!
//! The tops of the blocks lie one block height above the axis of the strip, on the side of the
//! centre of curvature. Neighbouring blocks touch when the arc of the gap at the level of the tops
//! has shrunk to zero: `θ = d`, hence `M* = 1` and `κ* = d/p` for any block length.
//!
//! A gap of `m` straight elements is a polygon with sides of constant length `d/m`. The distance
//! between the ends of the gap is `d sin(θ/2)/(m sin(θ/2m))`. Blocks touch when this distance
//! equals `2 sin(θ/2)`, at `θ = 2m asin(d/2m)`. The difference from `d` decreases as `1/m²`.

/// Returns the ratio `M*/κ* = p/d` of moment to curvature before contact.
pub fn moment_over_curvature(gap: f64, pitch: f64) -> f64 {
    pitch / gap
}

/// Moment `M*` at which blocks of any length first touch.
pub const CONTACT_MOMENT: f64 = 1.0;

/// Returns the curvature `κ* = d/p` at which blocks first touch.
pub fn contact_curvature(gap: f64, pitch: f64) -> f64 {
    gap / pitch
}

/// Returns the moment `M*` at which blocks first touch if a gap consists of straight elements.
///
/// For `m = elements` elements the moment is `2m asin(d/2m)/d`.
pub fn contact_moment_of_polygon(gap: f64, elements: usize) -> f64 {
    let m = elements as f64;
    2.0 * m * (gap / (2.0 * m)).asin() / gap
}

#[cfg(test)]
mod tests {
    use super::{CONTACT_MOMENT, contact_moment_of_polygon};

    #[test]
    fn the_contact_moment_of_a_polygon_converges_with_second_order() {
        let [coarse, fine] =
            [8, 16].map(|elements| contact_moment_of_polygon(0.5, elements) - CONTACT_MOMENT);
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 1e-3, "{order}");
    }
}

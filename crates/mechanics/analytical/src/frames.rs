//! Limit loads of snap-through frames.

/// First limit load `P L²/EI` of Lee's frame, without stretch.
///
/// A hinged column carries a hinged beam of the same length, with the load at one fifth of the
/// beam.
///
/// S.-L. Lee, F. S. Manuel, E. C. Rossow, *J. Eng. Mech. Div. ASCE* 94 (1968) 521.
pub const LEES_FRAME: f64 = 18.552;

/// Returns the limit load of half a shallow toggle.
///
/// A bar of axial stiffness `axial` connects a hinge with a vertical slide. The slide is `base`
/// away horizontally and `height` above the hinge.
///
/// With the bar length `l`, and `L` at rest, the load is `P = EA (1/l − 1/L) h`. It has its maximum
/// at `l³ = L b²`.
pub fn toggle_limit_load(base: f64, height: f64, axial: f64) -> f64 {
    let rest = base.hypot(height);
    let limit = (rest * base * base).cbrt();
    axial * (1.0 / limit - 1.0 / rest) * (limit * limit - base * base).sqrt()
}

#[cfg(test)]
mod tests {
    use super::toggle_limit_load;

    #[test]
    fn the_limit_load_is_the_largest_of_the_path() {
        let (base, height, axial) = (1.0_f64, 0.2_f64, 1e3);
        let heights = (0..=20_000).map(|k| height * f64::from(k) / 20_000.0);
        let loads = heights.map(|h| axial * (1.0 / base.hypot(h) - 1.0 / base.hypot(height)) * h);
        let largest = loads.fold(0.0, f64::max);
        let limit = toggle_limit_load(base, height, axial);
        assert!(limit >= largest && limit < largest * (1.0 + 1e-8), "{limit} {largest}");
    }
}

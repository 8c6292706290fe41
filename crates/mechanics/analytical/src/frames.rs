//! Limit loads of snap-through frames.

/// First limit load `P L²/EI` of Lee's frame with inextensible members.
///
/// The frame is an L-shape: a vertical column and a horizontal beam, both of length `L` and bending
/// stiffness `EI`, with a rigid joint between them and a hinge at each far end. The load `P` acts
/// downwards on the beam at a distance of `L/5` from the joint.
///
/// S.-L. Lee, F. S. Manuel, E. C. Rossow, *J. Eng. Mech. Div. ASCE* 94 (1968) 521.
pub const LEES_FRAME: f64 = 18.552;

/// Returns the limit load of half a shallow toggle: one inclined bar.
///
/// The lower end of the bar is a fixed hinge. The upper end can move only vertically and carries
/// the downward load. At rest the upper end is `height` above the hinge, at the horizontal distance
/// `base`. The axial stiffness `EA` of the bar is `axial`.
///
/// With the current length `l` of the bar, its length `L` at rest, and the current height `h`, the
/// load is `P = EA (1/l − 1/L) h`. Its maximum is at `l³ = L b²`, where `b` is `base`.
pub fn toggle_limit_load(base: f64, height: f64, axial: f64) -> f64 {
    let rest = base.hypot(height);
    let limit = (rest * base * base).cbrt();
    axial * (1.0 / limit - 1.0 / rest) * (limit * limit - base * base).sqrt()
}

#[cfg(test)]
mod tests {
    use super::toggle_limit_load;

    #[test]
    fn the_limit_load_is_the_largest_load_of_the_path() {
        let (base, height, axial) = (1.0_f64, 0.2_f64, 1e3);
        let heights = (0..=20_000).map(|k| height * f64::from(k) / 20_000.0);
        let loads = heights.map(|h| axial * (1.0 / base.hypot(h) - 1.0 / base.hypot(height)) * h);
        let largest = loads.fold(0.0, f64::max);
        let limit = toggle_limit_load(base, height, axial);
        assert!(limit >= largest && limit < largest * (1.0 + 1e-8), "{limit} {largest}");
    }
}

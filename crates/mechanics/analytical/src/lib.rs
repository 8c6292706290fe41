//! Closed forms and published values, with their sources.
//!
//! Tests and the validation page compare the program with these solutions. This crate depends on no
//! other crate of the workspace, so the solutions share no code with the program.
//!
//! | Module | Problem |
//! |---|---|
//! | [`elastica`] | inextensible cantilever under a transverse tip load, and a strip rolled up |
//! | [`frames`] | limit loads of a toggle and of Lee's frame |
//! | [`half_space`] | rigid rectangles and point loads on an elastic half-space |
//! | [`rotating_plates`] | locking of a beam with thin frictional plates on torsional roots |
//! | [`strips`] | rigid strips on a half-plane: the limit of long rectangles |
//! | [`isolated_scale`] | the puncture of a scale without neighbours |
//! | [`linear_chain`] | a row of scales coupled by the substrate, before the first contact |
//! | [`upright_blocks`] | the bending of a strip with upright blocks, up to their first contact |
//!
//! ```
//! use analytical::elastica;
//!
//! // The tip of a cantilever under P L²/EI = 10 turns by 1.43029 rad (Mattiasson 1981).
//! let tip = elastica::tip(10.0);
//! assert!((tip.rotation - 1.43029).abs() < 5e-6);
//! ```

pub mod elastica;
pub mod frames;
pub mod half_space;
pub mod isolated_scale;
pub mod linear_chain;
pub mod rotating_plates;
pub mod strips;
pub mod upright_blocks;

/// Bisects an interval for the end of the region that satisfies `is_below`.
///
/// Sixty halvings leave an interval below the resolution of a double.
fn bisected([mut low, mut high]: [f64; 2], is_below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if is_below(middle) { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

//! Closed-form solutions and published values, with their sources.
//!
//! The tests and the validation page compare results of the program with these solutions. This
//! crate depends on no other crate of the workspace, so the solutions share no code with the
//! program.
//!
//! | Module | Problem |
//! |---|---|
//! | [`elastica`] | inextensible cantilever under a tip load, and strip rolled up by a moment |
//! | [`frames`] | limit loads of a toggle and of Lee's frame |
//! | [`half_space`] | rigid rectangles and point loads on an elastic half-space |
//! | [`rotating_plates`] | locking of a beam with thin frictional plates on torsional springs |
//! | [`strips`] | rigid strips on an elastic half-plane: the limit of long rectangles |
//! | [`isolated_scale`] | puncture of a scale without neighbours |
//! | [`linear_chain`] | row of scales coupled by the substrate, before the first contact |
//! | [`upright_blocks`] | bending of a strip with upright blocks, up to the first contact |
//!
//! ```
//! use analytical::elastica;
//!
//! // For a load of P L²/EI = 10 the tip of a cantilever rotates by 1.43029 rad (Mattiasson 1981).
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

/// Returns the point in `low..high` at which `is_below` changes from true to false.
///
/// Sixty bisections reduce an interval of length 1 to `1e-18`, below the rounding error of an `f64`
/// of order 1.
fn bisected([mut low, mut high]: [f64; 2], is_below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if is_below(middle) { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

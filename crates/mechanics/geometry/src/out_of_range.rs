//! The error of every parameter that has no mechanical meaning.

/// A parameter outside the range in which it has a meaning.
///
/// The crates that check parameters share this error, so that every message names the quantity, the value that was
/// given and the values that are accepted.
///
/// ```
/// use geometry::OutOfRange;
///
/// let depth = -2.0;
/// let refused = OutOfRange::unless(depth > 0.0, "depth", depth, "a positive length").unwrap_err();
/// assert_eq!(refused.to_string(), "depth is -2, expected a positive length");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{quantity} is {value}, expected {expected}")]
pub struct OutOfRange {
    /// The name of the parameter.
    pub quantity: &'static str,
    /// The value that was given.
    pub value: f64,
    /// The values that are accepted, in words.
    pub expected: &'static str,
}

impl OutOfRange {
    /// Returns an error unless the condition `holds` for `value`.
    ///
    /// # Errors
    /// If `holds` is false.
    pub fn unless(
        holds: bool,
        quantity: &'static str,
        value: f64,
        expected: &'static str,
    ) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self { quantity, value, expected }) }
    }
}

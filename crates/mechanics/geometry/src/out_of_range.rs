//! Error for a parameter outside its valid range.

/// Error for a parameter outside its valid range.
///
/// All crates that check parameters share this error, so that every message names the quantity, the
/// given value and the accepted values.
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
    /// Name of the parameter.
    pub quantity: &'static str,
    /// Given value.
    pub value: f64,
    /// Description of the accepted values.
    pub expected: &'static str,
}

impl OutOfRange {
    /// Returns an error that names `quantity` and `value`, unless `valid` is true.
    ///
    /// `expected` describes the accepted values.
    ///
    /// # Errors
    /// If `valid` is false.
    pub fn unless(
        valid: bool,
        quantity: &'static str,
        value: f64,
        expected: &'static str,
    ) -> Result<(), Self> {
        if valid { Ok(()) } else { Err(Self { quantity, value, expected }) }
    }
}

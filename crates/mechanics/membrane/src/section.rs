//! Cross-section of the membrane.

use geometry::OutOfRange;

/// Returns `value` if it is positive and finite, otherwise an error.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<f64, OutOfRange> {
    let positive = value > 0.0 && value.is_finite();
    OutOfRange::unless(positive, quantity, value, "a positive finite number")?;
    Ok(value)
}

/// Rectangular cross-section of depth `b` (out of the plane) and thickness `h`.
///
/// Lengths are in units of `t` and forces in units of `E_m t²`, so the modulus is 1 and
///
/// ```text
/// EA = b h,     EI = b h³/12                                                    (M1)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    depth: f64,
    thickness: f64,
}

impl Section {
    /// Creates a section of depth `b` and thickness `h`, both in units of `t`.
    ///
    /// # Errors
    /// If the depth or the thickness is not positive and finite.
    pub fn new(depth: f64, thickness: f64) -> Result<Self, OutOfRange> {
        Ok(Self {
            depth: positive("depth of the membrane", depth)?,
            thickness: positive("thickness of the membrane", thickness)?,
        })
    }

    /// Returns the thickness `h`, in units of `t`.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Returns the axial stiffness `EA` (M1), in units of `E_m t²`.
    pub fn axial_stiffness(&self) -> f64 {
        self.depth * self.thickness
    }

    /// Returns the bending stiffness `EI` (M1), in units of `E_m t⁴`.
    pub fn bending_stiffness(&self) -> f64 {
        self.depth * self.thickness.powi(3) / 12.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stiffnesses_of_a_section_agree_with_the_closed_form() -> Result<(), OutOfRange> {
        let section = Section::new(2.0, 0.5)?;
        assert!((section.axial_stiffness() - 1.0).abs() < 1e-15);
        assert!((section.bending_stiffness() - 2.0 * 0.125 / 12.0).abs() < 1e-15);
        Ok(())
    }

    #[test]
    fn the_error_message_names_the_quantity_and_the_given_value() {
        let message = Section::new(1.0, -0.5).map_err(|error| error.to_string());
        let expected = "thickness of the membrane is -0.5, expected a positive finite number";
        assert_eq!(message, Err(expected.into()));
        assert!(Section::new(f64::INFINITY, 0.1).is_err());
        assert!(Section::new(f64::NAN, 0.1).is_err());
    }
}

//! Variables: parameters that a search or a random draw varies, within bounds or from a list.

use crate::case::Case;
use crate::parameter::Parameter;
use crate::scalar::Scalar;
use text::number;

/// A parameter in the section `[variables]` of a definition.
///
/// The designs of the grid do not fix its value. An optimisation searches for the best value, and a
/// global sensitivity analysis draws the value at random.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    pub(crate) parameter: &'static Parameter,
    pub(crate) values: VariableValues,
}

/// The values that a variable may have.
#[derive(Clone, Debug, PartialEq)]
pub enum VariableValues {
    /// Any number from a lower bound (first) to an upper bound (second).
    Between(f64, f64),
    /// One value of this list, which has at least two values.
    OneOf(Vec<Scalar>),
}

impl Variable {
    /// Returns the parameter that varies.
    pub fn parameter(&self) -> &'static Parameter {
        self.parameter
    }

    /// Returns the values that the parameter may have.
    pub fn values(&self) -> &VariableValues {
        &self.values
    }

    /// Returns the value at `fraction` (0 to 1) of the range.
    ///
    /// For a list, every value has an equal part of the range.
    ///
    /// ```
    /// use sweep::{Scalar, Sweep};
    ///
    /// let text = "name = 'x'\n[variables]\ngap_over_t = { from = 0.1, to = 0.5 }\nlength_over_t = [0.2, 1]";
    /// let sweep = Sweep::parse(text, "x.toml", &[])?;
    /// let at = |x| sweep.variables().iter().map(|v| v.at(x).to_string()).collect::<Vec<_>>();
    /// assert_eq!(at(0.25), ["0.2", "0.2"]);
    /// assert_eq!(at(1.0), ["0.5", "1"]);
    /// # Ok::<(), sweep::InvalidDefinition>(())
    /// ```
    pub fn at(&self, fraction: f64) -> Scalar {
        match &self.values {
            VariableValues::Between(from, to) => Scalar::Number(from + fraction * (to - from)),
            VariableValues::OneOf(values) => {
                let index = (fraction * values.len() as f64) as usize;
                // A `fraction` of 1 gives an index beyond the list; it belongs to the last value.
                values[index.min(values.len() - 1)]
            }
        }
    }

    /// Sets the parameter of this variable to `value` in `case`.
    pub fn set(&self, case: &mut Case, value: Scalar) {
        self.parameter.set(case, value);
    }

    /// Returns the values as written in a definition.
    pub fn to_toml(&self) -> String {
        match &self.values {
            VariableValues::Between(from, to) => {
                format!("{{ from = {}, to = {} }}", number::text(*from), number::text(*to))
            }
            VariableValues::OneOf(values) => {
                let values: Vec<_> = values.iter().map(|value| value.to_toml()).collect();
                format!("[{}]", values.join(", "))
            }
        }
    }
}

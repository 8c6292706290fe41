//! Manufacturing deviations from the nominal design.

use crate::case::Case;
use crate::parameter::{Parameter, Role, key, length};
use text::number;

/// Deviation of a parameter from its nominal value.
///
/// One part is common to all scales of a batch, one part varies from scale to scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    pub(crate) parameter: &'static Parameter,
    pub(crate) batch: Option<BatchDeviation>,
    pub(crate) scale_sd: Option<f64>,
}

/// Distribution of a deviation common to all scales of a batch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BatchDeviation {
    /// Normal distribution with this standard deviation.
    Normal(f64),
    /// Uniform distribution within this distance to either side.
    Uniform(f64),
}

impl BatchDeviation {
    /// Returns the standard deviation.
    pub fn standard_deviation(self) -> f64 {
        match self {
            Self::Normal(deviation) => deviation,
            // The variance of a uniform distribution is a third of its half-width squared.
            Self::Uniform(most) => most / 3.0_f64.sqrt(),
        }
    }
}

impl Deviation {
    /// Returns the parameter.
    ///
    /// For a deviation in mm this is the length over the thickness.
    pub fn parameter(&self) -> &'static Parameter {
        self.parameter.over_t().unwrap_or(self.parameter)
    }

    /// Returns the key in the definition: the parameter, or the same length in mm.
    pub fn key(&self) -> String {
        self.parameter.key.to_owned()
    }

    /// Returns the required keys: the parameter without default, and the thickness.
    pub(crate) fn needs(&self) -> impl Iterator<Item = &'static str> {
        let own = (!self.parameter().is_given(&Case::default())).then_some(self.parameter().key);
        own.into_iter().chain(self.parameter.is_in_mm().then_some(key::THICKNESS))
    }

    /// Returns the deviation common to all scales of a batch.
    pub fn batch(&self) -> Option<BatchDeviation> {
        self.batch
    }

    /// Returns the standard deviation from scale to scale.
    ///
    /// It is in the unit of the parameter.
    pub fn scale_sd(&self, case: &Case) -> Option<f64> {
        Some(self.scale_sd? / self.unit(case)?)
    }

    /// Returns the case with the parameter changed by `by`.
    ///
    /// `by` is in the unit of this deviation. The value may leave its bounds. A deviation of the
    /// thickness keeps all other lengths in mm, and a deviation of a modulus keeps modulus and
    /// strengths of the scales.
    pub fn moved(&self, case: &Case, by: f64) -> Option<Case> {
        match self.parameter.key {
            key::THICKNESS => length::with_thickness(case, case.material.thickness_mm? + by),
            key::SUBSTRATE_MODULUS => {
                let (mut moved, modulus) = (*case, case.material.substrate_modulus_mpa?);
                moved.material.substrate_modulus_mpa = Some(modulus + by);
                // Without values in MPa only these ratios keep modulus and strengths of the scales.
                let factor = modulus / (modulus + by);
                moved.puncture.contact_modulus_over_substrate *= factor;
                moved.strengths.scale = moved.strengths.scale.map(|strength| strength * factor);
                moved.strengths.bond = moved.strengths.bond.map(|strength| strength * factor);
                Some(moved)
            }
            key::MEMBRANE_MODULUS => {
                let (mut moved, modulus) = (*case, case.material.membrane_modulus_mpa?);
                moved.material.membrane_modulus_mpa = Some(modulus + by);
                moved.flexure.contact_modulus_over_membrane *= modulus / (modulus + by);
                Some(moved)
            }
            _ => self.parameter.moved(case, by),
        }
    }

    /// Changes `case` as [`Self::moved`] does. `None` if a parameter leaves its bounds.
    pub fn applied(&self, case: &Case, by: f64) -> Option<Case> {
        let moved = self.moved(case, by)?;
        let is_made =
            Parameter::with(Role::Made).all(|parameter| parameter.contains(parameter.get(&moved)));
        (is_made && moved.has_valid_load_position()).then_some(moved)
    }

    /// Returns one unit of the parameter in the unit of the deviation.
    fn unit(&self, case: &Case) -> Option<f64> {
        if self.parameter.is_in_mm() { case.material.thickness_mm } else { Some(1.0) }
    }

    /// Returns the deviation as written in a definition.
    pub fn to_toml(&self) -> String {
        let batch = self.batch.map(|batch| match batch {
            BatchDeviation::Normal(deviation) => format!("batch_sd = {}", number::text(deviation)),
            BatchDeviation::Uniform(most) => format!("batch_within = {}", number::text(most)),
        });
        let scale = self.scale_sd.map(|sd| format!("scale_sd = {}", number::text(sd)));
        let both: Vec<_> = batch.into_iter().chain(scale).collect();
        format!("{{ {} }}", both.join(", "))
    }
}

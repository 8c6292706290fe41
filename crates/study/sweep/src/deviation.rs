//! Manufacturing deviations from the nominal design.

use crate::case::Case;
use crate::parameter::{Parameter, Role, key, length};
use text::number;

/// Deviation of a parameter from its nominal value.
///
/// The deviation has two parts: `batch` is common to all scales of a batch, and `scale_sd` is the
/// standard deviation of the part that varies from scale to scale.
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
    /// Uniform distribution between minus and plus this half-width.
    Uniform(f64),
}

impl BatchDeviation {
    /// Returns the standard deviation.
    pub fn standard_deviation(self) -> f64 {
        match self {
            Self::Normal(deviation) => deviation,
            // The variance of a uniform distribution is a third of its half-width squared.
            Self::Uniform(half_width) => half_width / 3.0_f64.sqrt(),
        }
    }
}

impl Deviation {
    /// Returns the parameter that deviates.
    ///
    /// For a deviation in mm, returns the parameter of the same length divided by the thickness.
    pub fn parameter(&self) -> &'static Parameter {
        self.parameter.over_t().unwrap_or(self.parameter)
    }

    /// Returns the key of the deviation in the definition, e.g. `gap_over_t` or `gap_mm`.
    pub fn key(&self) -> String {
        self.parameter.key.to_owned()
    }

    /// Returns the keys of the parameters that the definition must also give.
    ///
    /// These are the parameter that deviates, if it has no default, and the thickness, if the
    /// deviation is in mm.
    pub(crate) fn needs(&self) -> impl Iterator<Item = &'static str> {
        let own = (!self.parameter().is_given(&Case::default())).then_some(self.parameter().key);
        own.into_iter().chain(self.parameter.is_in_mm().then_some(key::THICKNESS))
    }

    /// Returns the part of the deviation that is common to all scales of a batch, if there is one.
    pub fn batch(&self) -> Option<BatchDeviation> {
        self.batch
    }

    /// Returns the standard deviation from scale to scale, in the unit of [`Self::parameter`].
    ///
    /// `None` if the parameter does not vary from scale to scale.
    pub fn scale_sd(&self, case: &Case) -> Option<f64> {
        Some(self.scale_sd? / self.unit(case)?)
    }

    /// Returns the case with the parameter increased by `by`; `None` if it has no value.
    ///
    /// `by` is in the unit of this deviation. The value may leave its bounds. A deviation of the
    /// thickness keeps all other lengths in mm. A deviation of the modulus of substrate or membrane
    /// keeps the modulus of the scales and the strengths of scales and bonds.
    pub fn moved(&self, case: &Case, by: f64) -> Option<Case> {
        match self.parameter.key {
            key::THICKNESS => length::with_thickness(case, case.material.thickness_mm? + by),
            key::SUBSTRATE_MODULUS => {
                let (mut moved, modulus) = (*case, case.material.substrate_modulus_mpa?);
                moved.material.substrate_modulus_mpa = Some(modulus + by);
                // The ratios change so that the modulus of the scales and the strengths, numerators
                // of the ratios, stay constant.
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

    /// Returns the case with the parameter increased by `by`, within the bounds of all parameters.
    ///
    /// Like [`Self::moved`], but returns `None` if a parameter leaves its bounds.
    pub fn applied(&self, case: &Case, by: f64) -> Option<Case> {
        let moved = self.moved(case, by)?;
        let is_valid = Parameter::with(Role::Toleranced)
            .all(|parameter| parameter.contains(parameter.get(&moved)));
        (is_valid && moved.has_valid_load_position()).then_some(moved)
    }

    /// Returns the unit of the parameter in the unit of the deviation: the thickness in mm, or 1.
    fn unit(&self, case: &Case) -> Option<f64> {
        if self.parameter.is_in_mm() { case.material.thickness_mm } else { Some(1.0) }
    }

    /// Returns the deviation as written in a definition.
    pub fn to_toml(&self) -> String {
        let batch = self.batch.map(|batch| match batch {
            BatchDeviation::Normal(deviation) => format!("batch_sd = {}", number::text(deviation)),
            BatchDeviation::Uniform(width) => format!("batch_within = {}", number::text(width)),
        });
        let scale = self.scale_sd.map(|sd| format!("scale_sd = {}", number::text(sd)));
        let both: Vec<_> = batch.into_iter().chain(scale).collect();
        format!("{{ {} }}", both.join(", "))
    }
}

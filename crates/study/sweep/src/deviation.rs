//! How far what is made differs from what is drawn.

use crate::case::Case;
use crate::parameter::{Parameter, Role, key, length};
use text::number;

/// How a parameter differs from its value in the definition: in common for all scales of a batch, and from scale to scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    pub(crate) parameter: &'static Parameter,
    pub(crate) batch: Option<BatchDeviation>,
    pub(crate) scale_sd: Option<f64>,
}

/// The distribution of a deviation that all scales of a batch share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BatchDeviation {
    /// Normal, of this standard deviation.
    Normal(f64),
    /// Equally likely everywhere up to this far to either side.
    Uniform(f64),
}

impl BatchDeviation {
    /// The standard deviation.
    pub fn standard_deviation(self) -> f64 {
        match self {
            Self::Normal(deviation) => deviation,
            // The variance of a uniform distribution is a third of its half-width squared.
            Self::Uniform(most) => most / 3.0_f64.sqrt(),
        }
    }
}

impl Deviation {
    /// The parameter; that over the thickness if the deviation is in mm.
    pub fn parameter(&self) -> &'static Parameter {
        self.parameter.over_t().unwrap_or(self.parameter)
    }

    /// The key in the definition: that of the parameter, or of the same length in mm.
    pub fn key(&self) -> String {
        self.parameter.key.to_owned()
    }

    /// The keys without which the deviation has no meaning: its own, unless it has a value by default, and the thickness.
    pub(crate) fn needs(&self) -> impl Iterator<Item = &'static str> {
        let own = (!self.parameter().is_given(&Case::default())).then_some(self.parameter().key);
        own.into_iter().chain(self.parameter.is_in_mm().then_some(key::THICKNESS))
    }

    /// The deviation that all scales of a batch share.
    pub fn batch(&self) -> Option<BatchDeviation> {
        self.batch
    }

    /// The standard deviation from scale to scale in the unit of the parameter, for the designs of a thickness.
    pub fn scale_sd(&self, case: &Case) -> Option<f64> {
        Some(self.scale_sd? / self.unit(case)?)
    }

    /// The case whose parameter differs `by` so much, in the unit of this deviation; it may leave its bounds.
    ///
    /// A thickness differs while the other lengths stay as long as they are drawn, in mm, and a modulus differs while that of the
    /// scales stays.
    pub fn moved(&self, case: &Case, by: f64) -> Option<Case> {
        match self.parameter.key {
            key::THICKNESS => length::with_thickness(case, case.material.thickness_mm? + by),
            key::SUBSTRATE_MODULUS => {
                let (mut moved, modulus) = (*case, case.material.substrate_modulus_mpa?);
                moved.material.substrate_modulus_mpa = Some(modulus + by);
                // Without `scale_modulus_MPa` nothing else holds the modulus of the scales.
                moved.puncture.contact_modulus_over_substrate *= modulus / (modulus + by);
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

    /// Moves `case` as [`Self::moved`] does; `None` if a parameter leaves its bounds.
    pub fn applied(&self, case: &Case, by: f64) -> Option<Case> {
        let moved = self.moved(case, by)?;
        let is_made =
            Parameter::with(Role::Made).all(|parameter| parameter.contains(parameter.get(&moved)));
        (is_made && moved.load_can_stand()).then_some(moved)
    }

    /// One unit of the parameter in the unit of the deviation.
    fn unit(&self, case: &Case) -> Option<f64> {
        if self.parameter.is_in_mm() { case.material.thickness_mm } else { Some(1.0) }
    }

    /// The deviations as a definition writes them.
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

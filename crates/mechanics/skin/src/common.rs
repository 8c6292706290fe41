//! Parameters that puncture and bending share.

use contact::Law;
use solver::Settings;

/// Parameters that the puncture and the bending of a design share: the contact law and the solver's settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Common {
    /// Contact law between scales.
    pub law: Law,
    /// Coefficient of friction `μ` between two scales.
    pub friction: f64,
    /// Steps and tolerances with which paths are followed.
    pub solver: Settings,
    /// Whether everything is noted that a table or a drawing of the path shows. Measures need neither the stretches of the gaps at
    /// every point nor the folds behind the first.
    pub whole_path: bool,
}

impl Default for Common {
    /// The law as Shafiei et al. (2021) print it.
    fn default() -> Self {
        Self { law: Law::PRINTED, friction: 0.0, solver: Settings::default(), whole_path: true }
    }
}

/// Whether nothing is known: such a part of measures is not written.
pub(crate) fn is_default<T: Default + PartialEq>(part: &T) -> bool {
    *part == T::default()
}

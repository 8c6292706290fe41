//! Parameters shared by puncture and bending.

use contact::Law;
use solver::Settings;

/// Contact law, friction and solver settings shared by puncture and bending.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Common {
    /// Contact law between scales.
    pub law: Law,
    /// Coefficient of friction `μ` between scales.
    pub friction: f64,
    /// Step sizes and tolerances of path following.
    pub solver: Settings,
    /// True to record everything that path tables and drawings show.
    ///
    /// These are the gap stretches at every point and all folds. Measures need only the first fold.
    pub whole_path: bool,
}

impl Default for Common {
    /// Uses the contact law as printed by Shafiei et al. (2021).
    fn default() -> Self {
        Self { law: Law::PRINTED, friction: 0.0, solver: Settings::default(), whole_path: true }
    }
}

/// Returns true if all fields are empty; such a group of measures is not written.
pub(crate) fn is_default<T: Default + PartialEq>(part: &T) -> bool {
    *part == T::default()
}

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
    /// Extent of the record of a puncture path.
    pub detail: PathDetail,
}

/// Extent of the record of a puncture path. The path itself does not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum PathDetail {
    /// The measures of the critical state, of the first fold and of failure.
    ///
    /// Measures of other points have no value: the largest load and stiffness, first contact,
    /// the stiffness at rest, stability and snaps.
    Critical,
    /// All measures.
    Measures,
    /// Everything that path tables and drawings show.
    ///
    /// In addition to all measures: gap stretches and energies at every point, and all folds.
    #[default]
    Whole,
}

impl Default for Common {
    /// Uses the contact law as printed by Shafiei et al. (2021).
    fn default() -> Self {
        Self {
            law: Law::PRINTED,
            friction: 0.0,
            solver: Settings::default(),
            detail: PathDetail::Whole,
        }
    }
}

/// Returns true if all fields are empty; such a group of measures is not written.
pub(crate) fn is_default<T: Default + PartialEq>(part: &T) -> bool {
    *part == T::default()
}

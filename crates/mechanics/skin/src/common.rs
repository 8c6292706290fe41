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
    /// Which measures and point data of a path are computed.
    pub detail: PathDetail,
}

/// Which measures and point data of a puncture, or of bending of a sample, are computed.
///
/// The equilibria of a puncture do not depend on this choice. Bending of a design always computes
/// all data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum PathDetail {
    /// Only the measures of the critical state and of failure.
    ///
    /// Folds of the surface are located only for failure. The measures at the first fold have no
    /// value otherwise, and the largest force without a fold never has one.
    End,
    /// Only the measures of the critical state, of the first fold and of failure.
    ///
    /// All other measures have no value: largest load and stiffness, first contact, stiffness at
    /// rest, stability and snaps. In bending of a sample, the measures that depend on the final
    /// rotation have no value: largest moment, axial energy, membrane strain and friction work.
    Critical,
    /// All measures, without the point data of [`Self::Whole`].
    Measures,
    /// All measures, and the gap stretches, energies and folds at every point of the path.
    ///
    /// Path tables and drawings need this data.
    #[default]
    Whole,
}

impl Default for Common {
    /// Returns settings without friction, with the contact law as printed in Shafiei et al. (2021).
    fn default() -> Self {
        Self {
            law: Law::PRINTED,
            friction: 0.0,
            solver: Settings::default(),
            detail: PathDetail::Whole,
        }
    }
}

/// Returns true if a group of measures has its default value, i.e. no values.
///
/// Serialisation omits such groups.
pub(crate) fn is_default<T: Default + PartialEq>(group: &T) -> bool {
    *group == T::default()
}

//! Measures at tilts that a path passes.

use serde::{Deserialize, Serialize};

use super::system::Chain;
use crate::contacts::SkinState;

/// The measures of a puncture at a tilt that its path passes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TiltMeasures {
    /// `F*`.
    pub force: f64,
    /// `u*` of the punctured point.
    pub displacement: f64,
    /// Depth of the deepest base corner of any scale, over `t`.
    pub penetration: f64,
}

impl TiltMeasures {
    pub(super) fn new(chain: &Chain, state: &SkinState) -> Self {
        Self {
            force: chain.force(state),
            displacement: chain.depth(&state.z),
            penetration: chain.penetration(&state.z),
        }
    }
}

//! Measures of one path at each of several critical tilts.
//!
//! The path ends at the largest critical tilt, which is the target of the solver in `system.rs`, or
//! for a guided needle a constraint in `needle/forces.rs`. `Case::punctured` in `study/sweep`
//! derives the tilts of a free needle from its friction.

use serde::{Deserialize, Serialize};

use super::system::Chain;
use crate::contacts::SkinState;

/// Measures of a puncture at one of several critical tilts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TiltMeasures {
    /// Load `F*`.
    pub force: f64,
    /// Depth `u*` of the loaded point.
    pub displacement: f64,
    /// Depth of the deepest base corner of any scale, in units of `t`.
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

//! Measures at tilts that a path passes.

use serde::{Deserialize, Serialize};
use solver::Path;

use super::NumberList;
use super::system::Chain;
use crate::contacts::{SkinPoint, SkinState};
use crate::crossing::Crossing;
use crate::record::Skin;

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

/// Takes measures where a path first comes to each of some tilts: equilibria of their own, not interpolated.
pub(super) struct TiltWatch {
    tilts: NumberList,
    measures: Vec<Option<TiltMeasures>>,
}

impl TiltWatch {
    pub(super) fn new(tilts: NumberList) -> Self {
        Self { tilts, measures: vec![None; tilts.len()] }
    }

    /// Takes the measures at the tilts between two points of the path.
    pub(super) fn follow(&mut self, path: &mut Path<Chain>, from: &SkinPoint, to: &SkinPoint) {
        for (&tilt, measures) in self.tilts.as_slice().iter().zip(&mut self.measures) {
            if measures.is_none() {
                let quantity = |chain: &Chain, state: &SkinState| chain.angle_deg(state);
                let state = Crossing { quantity, value: tilt }.between(path, from, to);
                *measures = state.map(|state| TiltMeasures::new(path.system(), &state));
            }
        }
    }

    /// The measures at each tilt; `None` where the path did not get there.
    pub(super) fn finish(self) -> Vec<Option<TiltMeasures>> {
        self.measures
    }
}

impl TiltMeasures {
    fn new(chain: &Chain, state: &SkinState) -> Self {
        Self {
            force: chain.force(state),
            displacement: chain.depth(&state.z),
            penetration: chain.penetration(&state.z),
        }
    }
}

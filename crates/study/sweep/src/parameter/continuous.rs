//! Changes of numeric parameters by small steps, and the size of these steps, for derivatives.

use super::Bound::{Excluded, Included};
use super::{Parameter, ParameterKind, key, length};
use crate::case::Case;
use crate::scalar::Scalar;

/// Minimum coefficient of friction for derivatives.
///
/// Below this value, a difference step would make the friction negative.
const LEAST_FRICTION: f64 = 1e-4;

impl Parameter {
    /// Returns this parameter's value in `case`; `None` if another key defines it.
    fn written_value(&self, case: &Case) -> Option<Scalar> {
        let alternative = self.instead().map(|alternative| alternative.get(case));
        // If the alternative is a word, such as `auto` or `none`, this parameter is used.
        let follows = alternative.is_some_and(|value| !matches!(value, Scalar::Word(_)));
        (!follows).then(|| self.get(case))
    }

    /// Returns the case with this numeric parameter increased by `by`, in its unit.
    ///
    /// The value may leave its bounds. A change of a length in mm also changes the length over the
    /// thickness. `None` if the parameter is not a number, not given, or defined by an alternative.
    pub fn moved(&self, case: &Case, by: f64) -> Option<Case> {
        let mut moved = *case;
        if let Some(of) = self.over_t().filter(|_| !self.is_given(case)) {
            return of.moved(case, by / case.material.thickness_mm?);
        }
        match &self.kind {
            ParameterKind::Number { field, .. } | ParameterKind::SignedNumber { field, .. } => {
                *field(&mut moved) += by;
            }
            ParameterKind::OptionalNumber { field, .. } => *field(&mut moved).as_mut()? += by,
            ParameterKind::Numbers { set, .. } => {
                set(&mut moved, Scalar::Number(self.written_value(case)?.number()? + by));
            }
            _ => return None,
        }
        length::keep_in_step(&mut moved, self);
        Some(moved)
    }

    /// Returns the reference size for changes of this numeric parameter in `case`.
    ///
    /// The size is the magnitude of the value. If the range includes zero, it is at least 1, or
    /// 0.05 for a curvature. `None` if the parameter is not a number, not given, defined by an
    /// alternative, or a friction of almost zero.
    pub fn size(&self, case: &Case) -> Option<f64> {
        let (ParameterKind::Number { range, .. }
        | ParameterKind::SignedNumber { size: range, .. }
        | ParameterKind::OptionalNumber { range, .. }
        | ParameterKind::Numbers { range, .. }) = &self.kind
        else {
            return None;
        };
        let value = match self.over_t() {
            Some(_) => self.millimetres(case)?.abs(),
            None => self.written_value(case)?.number()?.abs(),
        };
        let is_friction = self.key == key::FRICTION
            || (self.key == key::NEEDLE_FRICTION && case.puncture.needle.is_guided());
        if is_friction && value < LEAST_FRICTION {
            // Without friction a path has no slip directions, so it cannot predict the effect of a
            // small friction.
            return None;
        }
        // If the range starts above zero, the value is not near zero, so a fraction of the value is
        // a valid step.
        let may_vanish = match range.low {
            Excluded(low) => low < 0.0,
            Included(low) => low <= 0.0,
        };
        // For a curvature use 0.05, the curvature of a forearm, instead of 1: changes much smaller
        // than 1 already close the gap between two scales.
        let least = if self.key == key::CURVATURE { 0.05 } else { 1.0 };
        Some(if may_vanish { value.max(least) } else { value })
    }
}

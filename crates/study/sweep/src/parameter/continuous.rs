//! Parameters that change continuously: what has derivatives with respect to them, and cases near one.

use super::Bound::{Excluded, Included};
use super::{Parameter, ParameterKind, Scalar, key, length};
use crate::case::Case;

/// Friction smaller than this has no derivatives: a step of differences would lead below zero.
const LEAST_FRICTION: f64 = 1e-4;

impl Parameter {
    /// Returns the value of this parameter in `case`, or `None` if an alternative key defines it.
    fn written_value(&self, case: &Case) -> Option<Scalar> {
        let first = self.instead().map(|first| first.get(case));
        // A word such as `auto` or `none` leaves the value to this parameter.
        let follows = first.is_some_and(|value| !matches!(value, Scalar::Word(_)));
        (!follows).then(|| self.get(case))
    }

    /// The case in which this parameter, a number, is larger `by` so much; it may leave its bounds. `None` if the parameter is no
    /// number, not given, or follows from its alternative. A length in mm moves the one over the thickness.
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

    /// The size by which a change of this parameter, a number, in `case` is small or not: its value, or 1 if it may vanish and
    /// is smaller. `None` if the parameter is no number, not given, or follows from its alternative.
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
        if self.key == key::FRICTION && value < LEAST_FRICTION {
            // A path of scales that do not rub knows nothing of how they slip, and so not what a little friction does.
            return None;
        }
        // A range that begins above zero has no place where a part of the value would be no step.
        let may_vanish = match range.low {
            Excluded(low) => low < 0.0,
            Included(low) => low <= 0.0,
        };
        Some(if may_vanish { value.max(1.0) } else { value })
    }
}

//! The row of a design near a solved one, by the derivatives of its measures.
//!
//! This is how columns have derivatives without rules of their own. Nobody has told that of `critical_force_N`, which is `F* E t²`.
//! But where `F*` is 0.4 and falls by 2 for each unit of the gap, the row of a gap that is 0.001 larger has `F*` = 0.398, and every
//! column can be read off that row, in newtons, over a mass or as a margin: its difference over 0.001 is its derivative.

use skin::flexure::FlexureMeasures;
use sweep::{Case, Measure, PARAMETERS, Parameter, Role};

use super::design_result::DesignResult;
use super::parameter_derivative::ParameterDerivative;
use super::row::DesignRow;
use super::sample_statistics::SampleStatistics;
use crate::columns::measured_value;
use crate::columns::values::VALUES;

/// Which of the two one-sided derivatives a row is extrapolated by; away from kinks they are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlopeSide {
    /// The derivatives where parameters decrease.
    Left,
    /// The derivatives where parameters increase.
    Right,
    /// The derivative on the side to which each parameter moves.
    Ahead,
}

/// A parameter that is larger `by` so much.
struct MovedParameter<'p> {
    parameter: &'p Parameter,
    by: f64,
}

impl DesignRow {
    /// The row of a neighbouring case, its measures extrapolated by their derivatives: `m + Σ Δq dm/dq`. A column of such rows
    /// has the derivatives of the column, whatever it makes of measures and parameters.
    ///
    /// A measure that depends on what changes and has no derivatives does not exist in the row, nor does one at a kink without
    /// the side that is asked for. A parameter by which a measure has none, though it has others, has no part in it. Counts stay.
    #[must_use]
    pub fn extrapolated(&self, to: &Case, side: SlopeSide) -> Self {
        self.changed(to, &changes(&self.case, to), side)
    }

    /// As [`Self::extrapolated`], of the case whose `parameter` is larger `by` so much; `None` if the parameter is no number.
    pub fn extrapolated_by(&self, parameter: &Parameter, by: f64, side: SlopeSide) -> Option<Self> {
        let to = parameter.moved(&self.case, by)?;
        // A length in mm, or a thickness, moves lengths over the thickness; measures have their derivatives by those.
        let changes = if parameter.has(Role::Continuous) {
            vec![MovedParameter { parameter, by }]
        } else {
            changes(&self.case, &to)
        };
        Some(self.changed(&to, &changes, side))
    }

    fn changed(&self, to: &Case, changes: &[MovedParameter<'_>], side: SlopeSide) -> Self {
        // First whatever the change has a part in is taken away; then what has derivatives comes
        // back. So no value of the old case stays in the row by oversight.
        let mut row = Self { case: *to, result: self.result.without_dependents(changes), ..*self };
        let derivatives = &self.result.sensitivity;
        for of_measure in derivatives.chunk_by(|one, next| one.measure == next.measure) {
            if let Some(value) = row.result.value_mut(of_measure[0].measure) {
                *value = extrapolated(of_measure, changes, side);
            }
        }
        row
    }

    /// The row with another value of a continuous measure; `None` if no such measure has that name, or it was not asked for.
    pub fn with_value(&self, measure: &str, value: f64) -> Option<Self> {
        let mut row = self.clone();
        *row.result.value_mut(measure)? = Some(value);
        Some(row)
    }
}

/// The parameters that differ between two cases.
fn changes(from: &Case, to: &Case) -> Vec<MovedParameter<'static>> {
    let change = |parameter: &'static Parameter| {
        let by = parameter.get(to).number()? - parameter.get(from).number()?;
        (by != 0.0).then_some(MovedParameter { parameter, by })
    };
    PARAMETERS.iter().filter_map(change).collect()
}

/// A measure that has these derivatives.
fn extrapolated(
    derivatives: &[ParameterDerivative],
    changes: &[MovedParameter<'_>],
    side: SlopeSide,
) -> Option<f64> {
    let part = |MovedParameter { parameter, by }: &MovedParameter<'_>| {
        let derivative = derivatives.iter().find(|d| d.parameter == parameter.key);
        derivative.map_or(Some(0.0), |derivative| Some(by * side.slope(derivative, *by)?))
    };
    let change: Option<f64> = changes.iter().map(part).sum();
    Some(derivatives[0].value + change?)
}

impl SlopeSide {
    /// The derivative on this side.
    fn slope(self, derivative: &ParameterDerivative, by: f64) -> Option<f64> {
        let is_left = self == Self::Left || (self == Self::Ahead && by < 0.0);
        if is_left { derivative.left } else { derivative.right }
    }
}

impl DesignResult {
    /// The result without the values that depend on what changes.
    fn without_dependents(&self, changes: &[MovedParameter<'_>]) -> Self {
        let depends = |measure: Measure| {
            let sections = measure.sections();
            changes.iter().any(|change| sections.contains(&change.parameter.section))
        };
        let mut result = Self {
            // These belong to the design that was solved: nobody knows them of its neighbour.
            samples: SampleStatistics::default(),
            sensitivity: Vec::new(),
            settings: String::new(),
            failures: Vec::new(),
            ..self.clone()
        };
        if depends(Measure::Coverage) {
            result.coverage = None;
        }
        if depends(Measure::Puncture) {
            // Measures at tilts on the way have no derivatives that could move them.
            result.at_tilts.clear();
            let of_puncture =
                VALUES.iter().filter(|value| value.measure() == Some(Measure::Puncture));
            for value in of_puncture {
                if let Some(number) = value.number_mut(&mut result) {
                    *number = None;
                }
            }
        }
        if depends(Measure::Flexure)
            && let Some(flexure) = &mut result.flexure
        {
            // Whether scales touch is no number that a derivative moves.
            let contact = flexure.measures.contact;
            flexure.measures = FlexureMeasures { contact, ..FlexureMeasures::default() };
        }
        result
    }

    /// The value of the continuous measure of that name, to be changed; `None` if there is none, or it was not asked for.
    fn value_mut(&mut self, measure: &str) -> Option<&mut Option<f64>> {
        measured_value(measure)?.number_mut(self)
    }
}

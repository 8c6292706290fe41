//! Linear extrapolation of a table row to a neighbouring design.
//!
//! The derivative of any column follows from extrapolated rows, without a rule per column. For
//! example, `critical_force_N` is `F* E* L t`. If `F*` is 0.4 and falls by 2 per unit of the gap,
//! the row for a gap larger by 0.001 has `F*` = 0.398, and every column can be computed from this
//! row: in newtons, per mass, or as a margin. The difference of a column in the two rows, divided
//! by 0.001, is its derivative.

use skin::flexure::FlexureMeasures;
use sweep::{Case, Measure, PARAMETERS, Parameter, Role};

use super::design_result::DesignResult;
use super::parameter_derivative::ParameterDerivative;
use super::row::DesignRow;
use super::sample_statistics::SampleStatistics;
use crate::columns::measured_value;
use crate::columns::measured_value::{MeasuredValue, Value};
use crate::columns::values::VALUES;

/// Relative change of a parameter to find the other parameters that change with this parameter.
const STEP: f64 = 1e-6;

/// The one-sided derivative that is used for extrapolation.
///
/// Left- and right-sided derivatives agree except at kinks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlopeSide {
    /// Derivative for decreasing parameters.
    Left,
    /// Derivative for increasing parameters.
    Right,
    /// Derivative on the side to which each parameter moves.
    Ahead,
}

/// A parameter, and the amount by which it increases.
struct MovedParameter<'p> {
    parameter: &'p Parameter,
    by: f64,
}

impl DesignRow {
    /// Returns the row of a neighbouring case, extrapolated by the derivatives.
    ///
    /// A measure `m` becomes `m + Σ Δq dm/dq` with the changes `Δq` of the parameters. Differences
    /// of extrapolated rows give the derivative of any column, which may be any function of
    /// measures and parameters.
    ///
    /// A measure that depends on a changed parameter loses its value if it has no derivatives, or
    /// if it has a kink and the derivative on `side` is missing. A measure with derivatives, but
    /// none with respect to a changed parameter, does not depend on this parameter. Counts are
    /// unchanged.
    #[must_use]
    pub fn extrapolated(&self, to: &Case, side: SlopeSide) -> Self {
        self.changed(to, &changes(&self.case, to), side)
    }

    /// Returns the parameters that change if `parameter` changes, including `parameter` itself.
    ///
    /// [`Self::extrapolated_by`] needs derivatives with respect to these parameters only.
    pub fn changed_by(case: &Case, parameter: &'static Parameter) -> Vec<&'static Parameter> {
        if parameter.has(Role::Continuous) {
            return vec![parameter];
        }
        neighbours(case, parameter).flat_map(|to| changed_parameters(case, &to)).collect()
    }

    /// Returns the row extrapolated to the case with `parameter` increased by `by`.
    ///
    /// `None` if the parameter is not a number.
    pub fn extrapolated_by(&self, parameter: &Parameter, by: f64, side: SlopeSide) -> Option<Self> {
        let to = parameter.moved(&self.case, by)?;
        // A length in mm or a thickness changes ratios of lengths to the thickness. Measures have
        // derivatives with respect to these ratios only.
        let changes = if parameter.has(Role::Continuous) {
            vec![MovedParameter { parameter, by }]
        } else {
            changes(&self.case, &to)
        };
        Some(self.changed(&to, &changes, side))
    }

    fn changed(&self, to: &Case, changes: &[MovedParameter<'_>], side: SlopeSide) -> Self {
        // First remove all values that depend on the change, then restore the values with
        // derivatives. Thus no value of the old case remains by mistake.
        let mut row = Self { case: *to, result: self.result.without_dependents(changes), ..*self };
        let derivatives = &self.result.sensitivity;
        for of_measure in derivatives.chunk_by(|one, next| one.measure == next.measure) {
            if let Some(value) = row.result.value_mut(of_measure[0].measure) {
                *value = extrapolated(of_measure, changes, side);
            }
        }
        row
    }

    /// Returns the row with `value` as the value of the continuous measure `measure`.
    ///
    /// `None` if there is no continuous measure of this name, or it was not requested.
    pub fn with_value(&self, measure: &str, value: f64) -> Option<Self> {
        let mut row = self.clone();
        *row.result.value_mut(measure)? = Some(value);
        Some(row)
    }
}

/// Returns the cases with a slightly smaller and a slightly larger `parameter`.
pub fn neighbours(case: &Case, parameter: &Parameter) -> impl Iterator<Item = Case> {
    let step = parameter.size(case).map(|size| STEP * size);
    let steps = step.into_iter().flat_map(|step| [-step, step]);
    steps.filter_map(|by| parameter.moved(case, by))
}

/// Returns the parameters that differ between two cases.
pub fn changed_parameters(from: &Case, to: &Case) -> Vec<&'static Parameter> {
    changes(from, to).into_iter().map(|moved| moved.parameter).collect()
}

/// Returns the parameters that differ between two cases, with their differences.
fn changes(from: &Case, to: &Case) -> Vec<MovedParameter<'static>> {
    PARAMETERS
        .iter()
        .filter_map(|parameter| {
            let by = parameter.get(to).number()? - parameter.get(from).number()?;
            (by != 0.0).then_some(MovedParameter { parameter, by })
        })
        .collect()
}

/// Returns the extrapolated value of the measure with these derivatives.
fn extrapolated(
    derivatives: &[ParameterDerivative],
    changes: &[MovedParameter<'_>],
    side: SlopeSide,
) -> Option<f64> {
    let change: Option<f64> = changes
        .iter()
        .map(|MovedParameter { parameter, by }| {
            let derivative = derivatives.iter().find(|d| d.parameter == parameter.key);
            derivative.map_or(Some(0.0), |derivative| Some(by * side.slope(derivative, *by)?))
        })
        .sum();
    Some(derivatives[0].value + change?)
}

impl SlopeSide {
    /// Returns the derivative on this side, for a change `by` of the parameter.
    fn slope(self, derivative: &ParameterDerivative, by: f64) -> Option<f64> {
        let is_left = self == Self::Left || (self == Self::Ahead && by < 0.0);
        if is_left { derivative.left } else { derivative.right }
    }
}

impl DesignResult {
    /// Returns the result without the values that depend on the changed parameters.
    fn without_dependents(&self, changes: &[MovedParameter<'_>]) -> Self {
        let depends = |measure: Measure| {
            let sections = measure.sections();
            changes.iter().any(|change| sections.contains(&change.parameter.section))
        };
        let mut result = Self {
            // These values are known only for the solved design, not for its neighbour.
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
            // Measures at tilts below the critical tilt have no derivatives.
            result.at_tilts.clear();
            let of_puncture =
                VALUES.iter().filter(|value| value.measure() == Some(Measure::Puncture));
            for value in of_puncture {
                if let Some(number) = result.number_mut(value) {
                    *number = None;
                }
            }
        }
        if depends(Measure::Flexure)
            && let Some(flexure) = &mut result.flexure
        {
            // Keep the field `contact`, which states whether contacts close: it has no derivative.
            let contact = flexure.measures.contact;
            flexure.measures = FlexureMeasures { contact, ..FlexureMeasures::default() };
        }
        result
    }

    /// Returns the value of a continuous measure by name.
    ///
    /// `None` if there is no such measure, or it was not requested.
    fn value_mut(&mut self, measure: &str) -> Option<&mut Option<f64>> {
        self.number_mut(measured_value(measure)?)
    }

    /// Returns the value of the continuous measure `of`; `None` if it was not requested.
    fn number_mut(&mut self, of: &MeasuredValue) -> Option<&mut Option<f64>> {
        match of.value {
            Value::Coverage => Some(&mut self.coverage),
            Value::Puncture(field) => self.puncture.as_mut().map(|p| field(&mut p.measures)),
            Value::Flexure(field) => self.flexure.as_mut().map(|f| field(&mut f.measures)),
            _ => None,
        }
    }
}

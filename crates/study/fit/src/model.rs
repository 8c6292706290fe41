//! The curves that a skin would have, with their derivatives with respect to what is sought.

use rayon::prelude::*;
use results::Outcome;
use run::{CurvePoints, Evaluator};
use skin::CurvePoint;
use sweep::{Case, Parameter, Scalar};

use crate::definition::{FitDefinition, Source, TestCurve, Unknown};
use crate::measured_curve::Test;

/// A curve of the model at the places of a measured one.
#[derive(Clone, Debug)]
pub(crate) struct ModelCurve {
    pub(crate) values: Vec<f64>,
    /// For each unknown the derivatives of all values.
    pub(crate) rates: Vec<Vec<f64>>,
    /// Points before the needle touches, where there is no force.
    pub(crate) before: usize,
    /// Points beyond the end of the path, which have its last value.
    pub(crate) beyond: usize,
    /// Derivatives that are differences of whole solutions, since those along the path are not known.
    pub(crate) differenced: usize,
}

/// Where a point of a measured curve stands on that of a skin.
enum Place {
    /// Before the needle touches, where there is no force.
    Before,
    /// At this place, in the units of the model.
    On(f64, CurvePoint),
    Beyond,
}

/// Step of the differences of units, which are formulas, as a part of the range.
const STEP: f64 = 1e-6;

/// Step of the differences of whole solutions, as a part of the range. Their error is that of an equilibrium, some `1e-9`.
const SOLVED_STEP: f64 = 1e-4;

impl FitDefinition {
    /// The curves for some values of the unknowns.
    pub(crate) fn model(
        &self,
        evaluator: &Evaluator,
        values: &[f64],
    ) -> Result<Vec<ModelCurve>, Outcome> {
        let curves = self.curves.par_iter().enumerate();
        curves.map(|(k, curve)| self.model_curve(evaluator, (k, curve), values)).collect()
    }

    /// The skin that a curve is of, or that of the definition.
    pub(crate) fn case(&self, curve: Option<&TestCurve>, values: &[f64]) -> Case {
        let mut case = curve.map_or_else(|| self.sweep.grid().case(0), |curve| curve.case);
        for (unknown, &value) in self.unknowns.iter().zip(values) {
            if let Some(parameter) = unknown.of(curve) {
                case = parameter.put(&case, Scalar::Number(value));
            }
        }
        case
    }

    fn model_curve(
        &self,
        evaluator: &Evaluator,
        (number, curve): (usize, &TestCurve),
        values: &[f64],
    ) -> Result<ModelCurve, Outcome> {
        let case = self.case(Some(curve), values);
        let units = curve.units(&case);
        let zero = [0, 1].map(|axis| {
            let of = Source::Offset(number, axis);
            let found = self.unknowns.iter().zip(values).find(|(u, _)| u.source == of);
            found.map_or(0.0, |(_, &value)| value)
        });
        let sought: Vec<_> = self.unknowns.iter().filter_map(|u| u.of(Some(curve))).collect();
        let measured = curve.measured.points.iter();
        let wanted: Vec<f64> = measured.map(|point| (point[0] - zero[0]) / units[0]).collect();
        // Those on the curve alone, in their order: each then takes the next that was found.
        let touching: Vec<f64> = wanted.iter().copied().filter(|place| *place > 0.0).collect();
        let found = solve(evaluator, curve.measured.test, &case, &sought, &touching)?;
        let last = last(&touching, &found);
        let mut found = found.into_iter();
        let place = |at: f64| match (at > 0.0).then(|| found.next().flatten()) {
            None => Place::Before,
            Some(None) => Place::Beyond,
            Some(Some(point)) => Place::On(at, point),
        };
        let places: Vec<_> = wanted.into_iter().map(place).collect();
        let value = |place: &Place| match place {
            Place::Before => zero[1],
            Place::On(_, point) => zero[1] + units[1] * point.value,
            // Compared with its last value, and counted: the user is told to leave them out.
            Place::Beyond => zero[1] + units[1] * last,
        };
        let mut model = ModelCurve {
            values: places.iter().map(value).collect(),
            rates: Vec::new(),
            before: places.iter().filter(|place| matches!(place, Place::Before)).count(),
            beyond: places.iter().filter(|place| matches!(place, Place::Beyond)).count(),
            differenced: 0,
        };
        let mut known = 0;
        for (unknown, &value) in self.unknowns.iter().zip(values) {
            let rates = match unknown.source {
                Source::Offset(of, 1) if of == number => vec![1.0; places.len()],
                Source::Offset(of, _) if of == number => {
                    on_curve(&places, |_, point| -units[1] * point.slope / units[0])
                }
                Source::Parameter(parameter) if !curve.own.contains(&parameter) => {
                    // Points have rates only for what this curve follows, in the order of unknowns.
                    known += 1;
                    let by = By { curve, case: &case, unknown, parameter, value };
                    let own =
                        by.own_rates(evaluator, &places, known - 1, &mut model.differenced)?;
                    by.with_units(units, &places, &own)
                }
                // Offsets of other curves, and what this specimen has a value of its own for.
                _ => vec![0.0; places.len()],
            };
            model.rates.push(rates);
        }
        Ok(model)
    }
}

/// A function of the points on the curve, 0 elsewhere.
fn on_curve(places: &[Place], f: impl Fn(f64, &CurvePoint) -> f64) -> Vec<f64> {
    let of = |place: &Place| if let Place::On(at, point) = place { f(*at, point) } else { 0.0 };
    places.iter().map(of).collect()
}

/// A parameter that a curve is differentiated by.
struct By<'a> {
    curve: &'a TestCurve,
    case: &'a Case,
    unknown: &'a Unknown,
    parameter: &'static Parameter,
    value: f64,
}

impl By<'_> {
    /// The derivatives in the units of the model, the `k`-th of the points; differences of whole solutions where they are not known.
    fn own_rates(
        &self,
        evaluator: &Evaluator,
        places: &[Place],
        k: usize,
        differenced: &mut usize,
    ) -> Result<Vec<f64>, Outcome> {
        let mut rates = on_curve(places, |_, point| point.rates[k].unwrap_or(f64::NAN));
        let unknown: Vec<_> = (0..rates.len()).filter(|&i| rates[i].is_nan()).collect();
        if unknown.is_empty() {
            return Ok(rates);
        }
        *differenced += unknown.len();
        let at = on_curve(places, |at, _| at);
        let at: Vec<_> = unknown.iter().map(|&i| at[i]).collect();
        let step = SOLVED_STEP * (self.unknown.to - self.unknown.from);
        let ends = [self.value - step, self.value + step];
        // From one side at an end of the range: a friction below 0 has no skin.
        let ends = ends.map(|end| end.clamp(self.unknown.from, self.unknown.to));
        let [below, above] = ends.map(|end| {
            let moved = self.parameter.put(self.case, Scalar::Number(end));
            solve(evaluator, self.curve.measured.test, &moved, &[], &at)
        });
        for ((i, below), above) in unknown.into_iter().zip(below?).zip(above?) {
            let rise = below.zip(above).map(|(below, above)| above.value - below.value);
            // A point to which only one of the two paths comes tells nothing.
            rates[i] = rise.map_or(0.0, |rise| rise / (ends[1] - ends[0]));
        }
        Ok(rates)
    }

    /// The derivatives in the units of the curve, which may depend on the parameter, too: with them the place on the curve moves.
    fn with_units(&self, units: [f64; 2], places: &[Place], own: &[f64]) -> Vec<f64> {
        let step = STEP * (self.unknown.to - self.unknown.from);
        let at = |by: f64| Some(self.curve.units(&self.parameter.moved(self.case, by)?));
        let sides = at(-step).zip(at(step));
        let rise = |k: usize| sides.map_or(0.0, |(low, high)| (high[k] - low[k]) / (2.0 * step));
        let moved = on_curve(places, |at, point| {
            rise(1) * point.value - units[1] * point.slope * at * rise(0) / units[0]
        });
        moved.into_iter().zip(own).map(|(moved, own)| moved + units[1] * own).collect()
    }
}

impl Unknown {
    /// The parameter that is sought and that a curve does not have a value of its own for.
    fn of(&self, curve: Option<&TestCurve>) -> Option<&'static Parameter> {
        match self.source {
            Source::Parameter(p) => Some(p).filter(|p| curve.is_none_or(|c| !c.own.contains(p))),
            Source::Offset(..) => None,
        }
    }
}

fn solve(
    evaluator: &Evaluator,
    test: Test,
    case: &Case,
    sought: &[&'static Parameter],
    places: &[f64],
) -> Result<CurvePoints, Outcome> {
    match test {
        Test::Puncture => evaluator.force_curve(case, sought, places),
        Test::Bending => evaluator.moment_curve(case, sought, places),
    }
}

/// The value of the farthest point that the path comes to.
fn last(places: &[f64], points: &CurvePoints) -> f64 {
    let reached = places.iter().zip(points).filter_map(|(place, p)| Some((place, p.as_ref()?)));
    reached.max_by(|a, b| a.0.total_cmp(b.0)).map_or(0.0, |(_, point)| point.value)
}

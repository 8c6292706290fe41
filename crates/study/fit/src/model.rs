//! Curves of the model, with derivatives with respect to the unknowns.

use rayon::prelude::*;
use results::Outcome;
use run::{CurvePoints, Evaluator};
use skin::CurvePoint;
use sweep::{Case, Parameter, Scalar};

use crate::definition::{FitDefinition, Source, TestCurve, Unknown};
use crate::measured_curve::Test;

/// Model values at the points of a measured curve.
#[derive(Clone, Debug)]
pub(crate) struct ModelCurve {
    pub(crate) values: Vec<f64>,
    /// Derivatives of all values, for each unknown.
    pub(crate) rates: Vec<Vec<f64>>,
    /// Number of points before the needle touches, where the force is zero.
    pub(crate) before: usize,
    /// Number of points beyond the end of the path. They have its last value.
    pub(crate) beyond: usize,
    /// Number of derivatives from finite differences, because the path provides none.
    pub(crate) differenced: usize,
}

/// Position of a measured point on the model curve.
enum Place {
    /// Before the needle touches, where the force is zero.
    Before,
    /// Displacement or curvature in model units, and the point of the model there.
    On(f64, CurvePoint),
    /// Beyond the end of the path.
    Beyond,
}

/// Step of finite differences of units, as a fraction of the range.
///
/// Units are smooth formulas.
const STEP: f64 = 1e-6;

/// Step of finite differences of solutions, as a fraction of the range.
///
/// Equilibria are accurate to about `1e-9`, so differences are accurate to about `1e-5`.
const SOLVED_STEP: f64 = 1e-4;

impl FitDefinition {
    /// Computes the model curves for given values of the unknowns.
    pub(crate) fn model(
        &self,
        evaluator: &Evaluator,
        values: &[f64],
    ) -> Result<Vec<ModelCurve>, Outcome> {
        let curves = self.curves.par_iter().enumerate();
        curves.map(|(k, curve)| self.model_curve(evaluator, (k, curve), values)).collect()
    }

    /// Returns the specimen of a curve, or the design of the definition for `None`.
    ///
    /// The design has the means of parameters that differ from specimen to specimen.
    pub(crate) fn case(&self, curve: Option<(usize, &TestCurve)>, values: &[f64]) -> Case {
        let mut case = curve.map_or_else(|| self.sweep.grid().case(0), |(_, curve)| curve.case);
        for (unknown, &value) in self.unknowns.iter().zip(values) {
            if let Some(parameter) = unknown.of(curve) {
                case = parameter.put(&case, Scalar::Number(value));
            }
        }
        if curve.is_none() {
            for (parameter, members) in self.specimens() {
                let mean = members.iter().map(|j| values[*j]).sum::<f64>() / members.len() as f64;
                case = parameter.put(&case, Scalar::Number(mean));
            }
        }
        case
    }

    /// Returns the parameters that differ from specimen to specimen, with their unknowns by index.
    pub(crate) fn specimens(&self) -> Vec<(&'static Parameter, Vec<usize>)> {
        let mut specimens: Vec<(&'static Parameter, Vec<usize>)> = Vec::new();
        for (j, unknown) in self.unknowns.iter().enumerate() {
            let Source::Specimen(parameter, _) = unknown.source else { continue };
            match specimens.iter_mut().find(|(other, _)| *other == parameter) {
                Some((_, members)) => members.push(j),
                None => specimens.push((parameter, vec![j])),
            }
        }
        specimens
    }

    fn model_curve(
        &self,
        evaluator: &Evaluator,
        (number, curve): (usize, &TestCurve),
        values: &[f64],
    ) -> Result<ModelCurve, Outcome> {
        let case = self.case(Some((number, curve)), values);
        let units = curve.units(&case);
        let zero = [0, 1].map(|axis| {
            let of = Source::Offset(number, axis);
            let found = self.unknowns.iter().zip(values).find(|(u, _)| u.source == of);
            found.map_or(0.0, |(_, &value)| value)
        });
        let sought: Vec<_> =
            self.unknowns.iter().filter_map(|u| u.of(Some((number, curve)))).collect();
        let measured = curve.measured.points.iter();
        let wanted: Vec<f64> = measured.map(|point| (point[0] - zero[0]) / units[0]).collect();
        let (loading, unloading) = wanted.split_at(wanted.len() - curve.unloading);
        let turn = (curve.turn - zero[0]) / units[0];
        let path = Path { evaluator, test: curve.measured.test, turn };
        let [touching, back] = [loading, unloading].map(touching);
        let found = path.solve(&case, &sought, [&touching, &back])?;
        let last = last(&touching, &found);
        let places = places(&wanted, found, touching.len());
        let modelled = places.iter().map(|place| match place {
            Place::Before => zero[1],
            Place::On(_, point) => zero[1] + units[1] * point.value,
            // Compare with the last value. The report counts these points and advises to exclude
            // them.
            Place::Beyond => zero[1] + units[1] * last,
        });
        let mut model = ModelCurve {
            values: modelled.collect(),
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
                _ => match unknown.of(Some((number, curve))) {
                    Some(parameter) => {
                        // `point.rates` holds only the unknowns that change this curve, in the
                        // order of unknowns.
                        known += 1;
                        let by = By { curve, case: &case, unknown, parameter, value };
                        let own =
                            by.own_rates(&path, &places, known - 1, &mut model.differenced)?;
                        by.with_units(units, &places, &own)
                    }
                    // Offsets and specimens of other curves, and parameters that this specimen sets
                    // itself.
                    None => vec![0.0; places.len()],
                },
            };
            model.rates.push(rates);
        }
        Ok(model)
    }
}

/// Evaluates `f` at points on the curve, and returns 0 elsewhere.
fn on_curve(places: &[Place], f: impl Fn(f64, &CurvePoint) -> f64) -> Vec<f64> {
    places
        .iter()
        .map(|place| if let Place::On(at, point) = place { f(*at, point) } else { 0.0 })
        .collect()
}

/// Derivative of a curve with respect to a parameter.
struct By<'a> {
    curve: &'a TestCurve,
    case: &'a Case,
    unknown: &'a Unknown,
    parameter: &'static Parameter,
    value: f64,
}

impl By<'_> {
    /// Returns the derivatives in model units, with index `k` in `point.rates`.
    ///
    /// Missing derivatives are replaced with differences of two solutions.
    fn own_rates(
        &self,
        path: &Path,
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
        let loading = places.len() - self.curve.unloading;
        let (on, back): (Vec<usize>, Vec<usize>) = unknown.iter().partition(|i| **i < loading);
        let [on, back] = [on, back].map(|of| of.into_iter().map(|i| at[i]).collect::<Vec<_>>());
        let step = SOLVED_STEP * (self.unknown.to - self.unknown.from);
        let ends = [self.value - step, self.value + step];
        // One-sided at an end of the range, because values beyond it may be invalid (friction < 0).
        let ends = ends.map(|end| end.clamp(self.unknown.from, self.unknown.to));
        let [below, above] = ends.map(|end| {
            let moved = self.parameter.put(self.case, Scalar::Number(end));
            path.solve(&moved, &[], [&on, &back])
        });
        for ((i, below), above) in unknown.into_iter().zip(below?).zip(above?) {
            let rise = below.zip(above).map(|(below, above)| above.value - below.value);
            // If only one of the two paths reaches the point, the difference is undefined.
            rates[i] = rise.map_or(0.0, |rise| rise / (ends[1] - ends[0]));
        }
        Ok(rates)
    }

    /// Converts derivatives to the units of the curve.
    ///
    /// The units may depend on the parameter, too. The point then also moves along the curve.
    fn with_units(&self, units: [f64; 2], places: &[Place], own: &[f64]) -> Vec<f64> {
        let step = STEP * (self.unknown.to - self.unknown.from);
        let sides =
            [-step, step].map(|by| Some(self.curve.units(&self.parameter.moved(self.case, by)?)));
        let rises = match sides {
            [Some(low), Some(high)] => [0, 1].map(|k| (high[k] - low[k]) / (2.0 * step)),
            _ => [0.0; 2],
        };
        let moved = on_curve(places, |at, point| {
            rises[1] * point.value - units[1] * point.slope * at * rises[0] / units[0]
        });
        moved.into_iter().zip(own).map(|(moved, own)| moved + units[1] * own).collect()
    }
}

impl Unknown {
    /// Returns the fitted parameter of a curve, unless the curve sets it itself.
    fn of(&self, curve: Option<(usize, &TestCurve)>) -> Option<&'static Parameter> {
        match (self.source, curve) {
            (Source::Parameter(p), None) => Some(p),
            (Source::Parameter(p), Some((_, curve))) => (!curve.own.contains(&p)).then_some(p),
            (Source::Specimen(p, of), Some((number, _))) => (of == number).then_some(p),
            (Source::Specimen(..), None) | (Source::Offset(..), _) => None,
        }
    }
}

/// The path of a test, which turns back at a displacement or curvature.
struct Path<'a> {
    evaluator: &'a Evaluator,
    test: Test,
    turn: f64,
}

impl Path<'_> {
    /// Solves for points on the loading branch, then on the unloading branch.
    ///
    /// Points of the unloading branch have no derivatives.
    fn solve(
        &self,
        case: &Case,
        sought: &[&'static Parameter],
        [loading, unloading]: [&[f64]; 2],
    ) -> Result<CurvePoints, Outcome> {
        let Self { evaluator, test, turn } = *self;
        let mut points = match test {
            _ if loading.is_empty() => Vec::new(),
            Test::Puncture => evaluator.force_curve(case, sought, loading)?,
            Test::Bending => evaluator.moment_curve(case, sought, loading)?,
        };
        if !unloading.is_empty() {
            let mut back = match test {
                Test::Puncture => evaluator.unloading_force_curve(case, turn, unloading)?,
                Test::Bending => evaluator.unloading_moment_curve(case, turn, unloading)?,
            };
            for point in back.iter_mut().flatten() {
                point.rates.resize(sought.len(), None);
            }
            points.append(&mut back);
        }
        Ok(points)
    }
}

/// Returns the positive displacements or curvatures, which lie on the path.
fn touching(wanted: &[f64]) -> Vec<f64> {
    wanted.iter().copied().filter(|place| *place > 0.0).collect()
}

/// Returns the positions of measured points, from the points found on the path.
///
/// The first `loading` points found are on the loading branch.
fn places(wanted: &[f64], found: CurvePoints, loading: usize) -> Vec<Place> {
    let mut found = found.into_iter().enumerate();
    let mut places = Vec::new();
    for &at in wanted {
        let found = if at > 0.0 { found.next() } else { None };
        places.push(match found {
            Some((_, Some(point))) => Place::On(at, point),
            Some((k, None)) if k < loading => Place::Beyond,
            // The needle does not touch yet, or no longer below the residual displacement.
            None | Some(_) => Place::Before,
        });
    }
    places
}

/// Returns the value at the farthest point that the path reaches.
fn last(places: &[f64], points: &CurvePoints) -> f64 {
    let reached = places.iter().zip(points).filter_map(|(place, p)| Some((place, p.as_ref()?)));
    reached.max_by(|a, b| a.0.total_cmp(b.0)).map_or(0.0, |(_, point)| point.value)
}

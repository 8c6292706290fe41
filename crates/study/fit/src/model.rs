//! Force and moment curves of the model, and their derivatives with respect to the unknowns.

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
    /// Derivatives of `values`, one vector per unknown.
    pub(crate) rates: Vec<Vec<f64>>,
    /// Number of points without load, before contact or after unloading.
    ///
    /// Their value is the offset of force or moment.
    pub(crate) before: usize,
    /// Number of points beyond the end of the path. They have the last value of the path.
    pub(crate) beyond: usize,
    /// Number of derivatives from finite differences, because the path provides none.
    pub(crate) differenced: usize,
}

/// Position of a measured point relative to the solved path.
enum Position {
    /// The skin carries no load: before contact, or after unloading.
    Before,
    /// On the path: displacement or curvature in model units, and the solved point.
    On(f64, CurvePoint),
    /// Beyond the end of the path.
    Beyond,
}

/// Step for derivatives of the units of a curve, as a fraction of the range of the unknown.
///
/// The units are smooth formulas, so a small step is accurate.
const STEP: f64 = 1e-6;

/// Step for finite differences of solved paths, as a fraction of the range of the unknown.
///
/// Equilibria are accurate to about `1e-9`, so these differences are accurate to about `1e-5`.
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

    /// Returns the case of a curve's specimen, with the given values of the unknowns.
    ///
    /// For `None`, returns the design of the definition. If a parameter differs from specimen to
    /// specimen, the design has the mean of its values.
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

    /// Returns the parameters that differ from specimen to specimen.
    ///
    /// Each parameter is paired with the indices of its unknowns, one per specimen.
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

    /// Computes model values for measured curve `number`, with derivatives for all unknowns.
    fn model_curve(
        &self,
        evaluator: &Evaluator,
        (number, curve): (usize, &TestCurve),
        values: &[f64],
    ) -> Result<ModelCurve, Outcome> {
        let solved = self.solve_curve(evaluator, (number, curve), values)?;
        let positions = solved.positions.iter();
        let mut model = ModelCurve {
            values: solved.values(),
            rates: Vec::new(),
            before: positions.clone().filter(|p| matches!(p, Position::Before)).count(),
            beyond: positions.filter(|p| matches!(p, Position::Beyond)).count(),
            differenced: 0,
        };
        // `point.rates` has entries only for unknowns that are parameters of this curve. `index`
        // counts these entries.
        let mut index = 0;
        for (unknown, &value) in self.unknowns.iter().zip(values) {
            let rates = match unknown.of(Some((number, curve))) {
                Some(parameter) => {
                    let by = ParameterRates { solved: &solved, unknown, parameter, value };
                    let rates = by.model_rates(index, &mut model.differenced)?;
                    index += 1;
                    by.with_units(&rates)
                }
                None => solved.offset_rates(unknown.source),
            };
            model.rates.push(rates);
        }
        Ok(model)
    }

    /// Solves the model at the displacements or curvatures of measured curve `number`.
    fn solve_curve<'a>(
        &self,
        evaluator: &'a Evaluator,
        (number, curve): (usize, &'a TestCurve),
        values: &[f64],
    ) -> Result<SolvedCurve<'a>, Outcome> {
        let case = self.case(Some((number, curve)), values);
        let units = curve.units(&case);
        let offsets = [0, 1].map(|axis| {
            let of = Source::Offset(number, axis);
            let found = self.unknowns.iter().zip(values).find(|(u, _)| u.source == of);
            found.map_or(0.0, |(_, &value)| value)
        });
        let parameters: Vec<_> =
            self.unknowns.iter().filter_map(|u| u.of(Some((number, curve)))).collect();
        let measured = curve.measured.points.iter();
        let wanted: Vec<f64> = measured.map(|point| (point[0] - offsets[0]) / units[0]).collect();
        let (loading, unloading) = wanted.split_at(wanted.len() - curve.unloading);
        let turn = (curve.turn - offsets[0]) / units[0];
        let path = Path { evaluator, test: curve.measured.test, turn };
        let [touching, back] = [loading, unloading].map(touching);
        let found = path.solve(&case, &parameters, [&touching, &back])?;
        let last = last(&touching, &found);
        let positions = positions(&wanted, found, touching.len());
        Ok(SolvedCurve { number, curve, case, units, offsets, path, positions, last })
    }
}

/// A measured curve with the solved points of the model.
struct SolvedCurve<'a> {
    /// Index of the curve in the definition.
    number: usize,
    curve: &'a TestCurve,
    case: Case,
    /// Size of one model unit on each axis, in the units of the measured curve.
    units: [f64; 2],
    /// Offset of each axis, in the units of the measured curve.
    offsets: [f64; 2],
    path: Path<'a>,
    /// Position of each measured point relative to the solved path.
    positions: Vec<Position>,
    /// Force or moment at the last measured point that the loading path reaches, in model units.
    last: f64,
}

impl SolvedCurve<'_> {
    /// Returns the model values at the measured points, in the units of the curve.
    fn values(&self) -> Vec<f64> {
        let Self { units, offsets, .. } = self;
        let values = self.positions.iter().map(|position| match position {
            Position::Before => offsets[1],
            Position::On(_, point) => offsets[1] + units[1] * point.value,
            // Use the last value of the path. The report counts these points and recommends
            // excluding them from the fit.
            Position::Beyond => offsets[1] + units[1] * self.last,
        });
        values.collect()
    }

    /// Returns the derivatives with respect to an unknown that is not a parameter of this curve.
    ///
    /// The derivatives are nonzero only if the unknown is an offset of this curve.
    fn offset_rates(&self, source: Source) -> Vec<f64> {
        match source {
            Source::Offset(of, 1) if of == self.number => vec![1.0; self.positions.len()],
            Source::Offset(of, _) if of == self.number => {
                self.on_curve(|_, point| -self.units[1] * point.slope / self.units[0])
            }
            _ => vec![0.0; self.positions.len()],
        }
    }

    /// Evaluates `f` at the measured points on the path. Other measured points have the value 0.
    fn on_curve(&self, f: impl Fn(f64, &CurvePoint) -> f64) -> Vec<f64> {
        let values = self.positions.iter().map(|position| match position {
            Position::On(at, point) => f(*at, point),
            Position::Before | Position::Beyond => 0.0,
        });
        values.collect()
    }
}

/// Differentiates the values of a solved curve with respect to a fitted parameter.
struct ParameterRates<'a> {
    solved: &'a SolvedCurve<'a>,
    unknown: &'a Unknown,
    parameter: &'static Parameter,
    /// Value of the parameter at which the curve was solved.
    value: f64,
}

impl ParameterRates<'_> {
    /// Returns the derivatives of force or moment at constant position, in model units.
    ///
    /// `k` is the index of the parameter in `point.rates`. Derivatives that the path does not
    /// provide are replaced by differences of two solutions, and counted in `differenced`.
    fn model_rates(&self, k: usize, differenced: &mut usize) -> Result<Vec<f64>, Outcome> {
        let SolvedCurve { curve, case, path, positions, .. } = self.solved;
        let mut rates = self.solved.on_curve(|_, point| point.rates[k].unwrap_or(f64::NAN));
        let unknown: Vec<_> = (0..rates.len()).filter(|&i| rates[i].is_nan()).collect();
        if unknown.is_empty() {
            return Ok(rates);
        }
        *differenced += unknown.len();
        let at = self.solved.on_curve(|at, _| at);
        let loading = positions.len() - curve.unloading;
        let (on, back): (Vec<usize>, Vec<usize>) = unknown.iter().partition(|i| **i < loading);
        let [on, back] = [on, back].map(|of| of.into_iter().map(|i| at[i]).collect::<Vec<_>>());
        let step = SOLVED_STEP * (self.unknown.to - self.unknown.from);
        let ends = [self.value - step, self.value + step];
        // At an end of the range the difference is one-sided, because values beyond the range may
        // be invalid (friction < 0).
        let ends = ends.map(|end| end.clamp(self.unknown.from, self.unknown.to));
        let [below, above] = ends.map(|end| {
            let moved = self.parameter.put(case, Scalar::Number(end));
            path.solve(&moved, &[], [&on, &back])
        });
        for ((i, below), above) in unknown.into_iter().zip(below?).zip(above?) {
            let rise = below.zip(above).map(|(below, above)| above.value - below.value);
            // If either path ends before this point, no difference exists: assume 0.
            rates[i] = rise.map_or(0.0, |rise| rise / (ends[1] - ends[0]));
        }
        Ok(rates)
    }

    /// Converts derivatives from model units to the units of the measured curve.
    ///
    /// `rates` are derivatives at constant position in model units. If the units depend on the
    /// parameter, a measured point changes its position in model units; this effect is added.
    fn with_units(&self, rates: &[f64]) -> Vec<f64> {
        let SolvedCurve { curve, case, units, .. } = self.solved;
        let step = STEP * (self.unknown.to - self.unknown.from);
        let sides = [-step, step].map(|by| Some(curve.units(&self.parameter.moved(case, by)?)));
        let rises = match sides {
            [Some(low), Some(high)] => [0, 1].map(|k| (high[k] - low[k]) / (2.0 * step)),
            _ => [0.0; 2],
        };
        let moved = self.solved.on_curve(|at, point| {
            rises[1] * point.value - units[1] * point.slope * at * rises[0] / units[0]
        });
        moved.into_iter().zip(rates).map(|(moved, rate)| moved + units[1] * rate).collect()
    }
}

impl Unknown {
    /// Returns the parameter that this unknown changes in the case of a curve.
    ///
    /// `None` for offsets, parameters of other specimens, and parameters that the table of the
    /// curve sets. If `curve` is `None`, the case is the design of the definition.
    fn of(&self, curve: Option<(usize, &TestCurve)>) -> Option<&'static Parameter> {
        match (self.source, curve) {
            (Source::Parameter(p), None) => Some(p),
            (Source::Parameter(p), Some((_, curve))) => (!curve.fixed.contains(&p)).then_some(p),
            (Source::Specimen(p, of), Some((number, _))) => (of == number).then_some(p),
            (Source::Specimen(..), None) | (Source::Offset(..), _) => None,
        }
    }
}

/// Solver of the loading and unloading path of a test.
struct Path<'a> {
    evaluator: &'a Evaluator,
    test: Test,
    /// Displacement or curvature at which unloading begins, in model units.
    turn: f64,
}

impl Path<'_> {
    /// Returns the points at the given positions on the loading and unloading branches.
    ///
    /// Points of the loading branch are first. Points of the unloading branch have no derivatives.
    fn solve(
        &self,
        case: &Case,
        parameters: &[&'static Parameter],
        [loading, unloading]: [&[f64]; 2],
    ) -> Result<CurvePoints, Outcome> {
        let Self { evaluator, test, turn } = *self;
        let mut points = match test {
            _ if loading.is_empty() => Vec::new(),
            Test::Puncture => evaluator.force_curve(case, parameters, loading)?,
            Test::Bending => evaluator.moment_curve(case, parameters, loading)?,
        };
        if !unloading.is_empty() {
            let mut back = match test {
                Test::Puncture => evaluator.unloading_force_curve(case, turn, unloading)?,
                Test::Bending => evaluator.unloading_moment_curve(case, turn, unloading)?,
            };
            for point in back.iter_mut().flatten() {
                point.rates.resize(parameters.len(), None);
            }
            points.append(&mut back);
        }
        Ok(points)
    }
}

/// Returns the positive displacements or curvatures. Other values cannot lie on the path.
fn touching(wanted: &[f64]) -> Vec<f64> {
    wanted.iter().copied().filter(|at| *at > 0.0).collect()
}

/// Returns the position of each measured point relative to the solved path.
///
/// `found` has an entry for each positive value in `wanted`; its first `loading` entries belong to
/// the loading branch.
fn positions(wanted: &[f64], found: CurvePoints, loading: usize) -> Vec<Position> {
    let mut found = found.into_iter().enumerate();
    let mut positions = Vec::new();
    for &at in wanted {
        let found = if at > 0.0 { found.next() } else { None };
        positions.push(match found {
            Some((_, Some(point))) => Position::On(at, point),
            Some((k, None)) if k < loading => Position::Beyond,
            // The skin carries no load: before contact, or below the residual displacement.
            None | Some(_) => Position::Before,
        });
    }
    positions
}

/// Returns the force or moment at the largest position in `wanted` that the path reaches.
///
/// Returns 0 if the path reaches none of them.
fn last(wanted: &[f64], points: &CurvePoints) -> f64 {
    let reached = wanted.iter().zip(points).filter_map(|(at, point)| Some((at, point.as_ref()?)));
    reached.max_by(|a, b| a.0.total_cmp(b.0)).map_or(0.0, |(_, point)| point.value)
}

//! Derivatives of the measures of a design with respect to its continuous parameters.

use geometry::{OutOfRange, RowChange};
use results::ParameterDerivative;
use results::columns::name;
use skin::flexure::{self, Flexure, FlexureInput};
use skin::puncture::{self, FailureMode, Puncture, PunctureEnd, PunctureInput, PunctureMeasures};
use skin::{Derivative, Neighbours, PathDetail};
use substrate::{RowStiffness, StiffnessSlopes};
use sweep::{Case, Measure, PARAMETERS, Parameter, Role};

/// Step of finite differences of explicit functions, relative to the size of a parameter.
// The optimum for central differences is 6e-6, the cube root of the rounding error. A third of this
// optimum reaches fewer nearby kinks.
pub(super) const STEP: f64 = 2e-6;

/// Parameters with respect to which measures are differentiated.
#[derive(Clone, Copy, Debug)]
pub(super) enum Wanted<'a> {
    /// All continuous parameters.
    All,
    /// Only these parameters.
    Only(&'a [&'static Parameter]),
}

impl Wanted<'_> {
    fn contains(self, parameter: &Parameter) -> bool {
        let Self::Only(parameters) = self else { return true };
        parameters.iter().any(|listed| {
            // The derivative with respect to the prefactor follows from the derivative with respect
            // to a modulus, see `with_prefactor`.
            let gives_prefactor = listed.key == PREFACTOR && MODULI.contains(&parameter.key);
            listed.key == parameter.key || gives_prefactor
        })
    }

    /// Returns the wanted continuous parameters on which the measure `of` of `case` depends.
    fn parameters(self, case: &Case, of: Measure) -> Vec<&'static Parameter> {
        let belongs = |p: &&Parameter| {
            p.has(Role::Continuous) && of.sections().contains(&p.section) && self.contains(p)
        };
        PARAMETERS.iter().filter(belongs).filter(|p| p.size(case).is_some()).collect()
    }
}

/// Keys of the prefactor of the contact law, and of the moduli that multiply the prefactor.
const PREFACTOR: &str = "c1";
const MODULI: [&str; 2] = ["contact_modulus_over_substrate", "contact_modulus_over_membrane"];

/// Returns the wanted parameters of a measure, each with its variation of the input.
///
/// The prefactor of the contact law is omitted, because forces depend only on its product with the
/// modulus: [`with_prefactor`] computes its derivatives from the derivatives with respect to the
/// modulus. If the first failure is requested, the prefactor is included, because the deflection of
/// the scales depends on the modulus, too.
fn variations<P>(
    case: &Case,
    wanted: Wanted<'_>,
    of: Measure,
    variation: impl Fn(&'static Parameter) -> Option<Neighbours<P>>,
) -> (Vec<&'static Parameter>, Vec<Neighbours<P>>) {
    let bends = of == Measure::Puncture && case.punctured().failure.is_some();
    let solved = wanted.parameters(case, of).into_iter().filter(|p| p.key != PREFACTOR || bends);
    solved.filter_map(|parameter| Some((parameter, variation(parameter)?))).unzip()
}

/// Adds derivatives with respect to the prefactor of the contact law.
///
/// These derivatives are computed from the derivatives with respect to the modulus. The derivatives
/// of each measure are sorted in the order of [`PARAMETERS`].
fn with_prefactor(case: &Case, solved: &[ParameterDerivative]) -> Vec<ParameterDerivative> {
    let c1 = case.common.law.c1;
    let of_measure = |of: &[ParameterDerivative]| {
        let is_known = of.iter().any(|derivative| derivative.parameter == PREFACTOR);
        let by_modulus = of.iter().find(|derivative| MODULI.contains(&derivative.parameter));
        let mut all = of.to_vec();
        all.extend(by_modulus.filter(|_| !is_known).map(|by_modulus| {
            let scaled = |derivative: Option<f64>| derivative.map(|d| d * by_modulus.at / c1);
            let (left, right) = (scaled(by_modulus.left), scaled(by_modulus.right));
            ParameterDerivative { parameter: PREFACTOR, at: c1, left, right, ..by_modulus.clone() }
        }));
        all.sort_by_key(|of| PARAMETERS.iter().position(|p| p.key == of.parameter));
        all
    };
    solved.chunk_by(|one, next| one.measure == next.measure).flat_map(of_measure).collect()
}

/// Solves the puncture of `case` and differentiates its measures.
pub(super) fn puncture(
    case: &Case,
    wanted: Wanted<'_>,
    slopes: &StiffnessSlopes,
) -> Result<(Puncture, Vec<ParameterDerivative>), OutOfRange> {
    let (parameters, variations) = punctured_variations(case, wanted, slopes);
    let input = punctured(case, slopes.stiffness.clone());
    let (puncture, derivatives) = puncture::differentiate(&input, &variations)?;
    Ok((puncture, with_prefactor(case, &named(case, &parameters, derivatives))))
}

/// Solves the puncture of `case` from the path end of a similar design, like [`puncture()`].
///
/// Returns `None` if the path must be followed from rest.
pub(super) fn puncture_near(
    case: &Case,
    wanted: Wanted<'_>,
    slopes: &StiffnessSlopes,
    end: &PunctureEnd,
) -> Result<Option<(Puncture, Vec<ParameterDerivative>)>, OutOfRange> {
    let (parameters, variations) = punctured_variations(case, wanted, slopes);
    let input = punctured(case, slopes.stiffness.clone());
    let near = puncture::differentiate_near(&input, &variations, end)?;
    Ok(near.map(|(puncture, derivatives)| {
        (puncture, with_prefactor(case, &named(case, &parameters, derivatives)))
    }))
}

/// Returns the wanted parameters of a puncture, each with its variation of the input.
fn punctured_variations(
    case: &Case,
    wanted: Wanted<'_>,
    slopes: &StiffnessSlopes,
) -> (Vec<&'static Parameter>, Vec<Neighbours<PunctureInput>>) {
    variations(case, wanted, Measure::Puncture, |parameter| {
        Varied { case, parameter, slopes: Some(slopes) }.variation(Varied::punctured)
    })
}

/// Solves the row across of `case` and differentiates its critical force.
pub(super) fn across(
    case: &Case,
    wanted: Wanted<'_>,
    slopes: &StiffnessSlopes,
) -> Result<(Puncture, Vec<ParameterDerivative>), OutOfRange> {
    let across = case.across().unwrap_or(*case);
    let ForceDerivatives { puncture, parameters, mut derivatives } =
        ForceDerivatives::of(case, wanted, &across, slopes, Varied::punctured_across)?;
    let factor = case.across_factor();
    for derivative in &mut derivatives {
        let parameter = parameters[derivative.parameter];
        let rate = Varied { case, parameter, slopes: Some(slopes) }.factor_rate();
        let by_factor = rate * derivative.value;
        derivative.left = derivative.left.map(|slope| factor * slope + by_factor);
        derivative.right = derivative.right.map(|slope| factor * slope + by_factor);
        derivative.value *= factor;
        derivative.measure = name::FORCE_ACROSS;
    }
    Ok((puncture, with_prefactor(case, &named(case, &parameters, derivatives))))
}

/// Critical force of another row of a case, with derivatives with respect to parameters of the
/// case.
struct ForceDerivatives {
    puncture: Puncture,
    parameters: Vec<&'static Parameter>,
    derivatives: Vec<Derivative>,
}

impl ForceDerivatives {
    /// Solves `solved`, another row of `case`, and differentiates its critical force.
    ///
    /// `vary` returns the input of this row after a change of a parameter of `case`.
    fn of<'a>(
        case: &'a Case,
        wanted: Wanted<'_>,
        solved: &Case,
        slopes: &'a StiffnessSlopes,
        vary: impl Fn(&Varied<'a>, f64) -> Option<PunctureInput>,
    ) -> Result<Self, OutOfRange> {
        let (parameters, variations) = variations(case, wanted, Measure::Puncture, |parameter| {
            Varied { case, parameter, slopes: Some(slopes) }.variation(&vary)
        });
        let solved = solved.with_detail(PathDetail::Critical);
        let input = punctured(&solved, slopes.stiffness.clone());
        let (puncture, mut derivatives) = puncture::differentiate(&input, &variations)?;
        derivatives.retain(|derivative| derivative.measure == name::CRITICAL_FORCE);
        Ok(Self { puncture, parameters, derivatives })
    }
}

/// Differentiates the critical force on a body between the two radii of `case`.
///
/// `fraction` is the position of this body in the range of curvatures. The fraction is kept
/// constant, because the derivative of the force with respect to the fraction is zero at a minimum
/// inside the range.
pub(super) fn between(
    case: &Case,
    wanted: Wanted<'_>,
    fraction: f64,
    slopes: &StiffnessSlopes,
) -> Result<Vec<ParameterDerivative>, OutOfRange> {
    let on_body = case.on_body_between(fraction).unwrap_or(*case);
    let ForceDerivatives { parameters, mut derivatives, .. } =
        ForceDerivatives::of(case, wanted, &on_body, slopes, |varied, by| {
            varied.punctured_between(fraction, by)
        })?;
    for derivative in &mut derivatives {
        derivative.measure = name::WORST_FORCE_BETWEEN;
    }
    Ok(with_prefactor(case, &named(case, &parameters, derivatives)))
}

/// Relative difference below which two forces count as equal.
pub(super) const TIE: f64 = 1e-7;

/// Adds derivatives of `force_any_direction`, and of `failure_force` if the row across fails first.
pub(super) fn choose_direction(
    measures: &PunctureMeasures,
    derivatives: &mut Vec<ParameterDerivative>,
) {
    let across: Vec<_> = of_measure(name::FORCE_ACROSS, derivatives);
    if measures.failure.mode == Some(FailureMode::Across) {
        derivatives.retain(|derivative| derivative.measure != name::FAILURE_FORCE);
        let failing = across.iter().cloned();
        derivatives
            .extend(failing.map(|of| ParameterDerivative { measure: name::FAILURE_FORCE, ..of }));
    }
    let Some(least) = measures.across.any_direction else { return };
    // If the row across has no critical force, the row along is the weaker one.
    let force_across = measures.across.force.unwrap_or(f64::INFINITY);
    let along = match measures.weakest.force {
        Some(_) => name::WEAKEST_FORCE,
        None => name::CRITICAL_FORCE,
    };
    let along = of_measure(along, derivatives);
    let force_along = along.first().map_or(f64::INFINITY, |derivative| derivative.value);
    let is_tie = (force_along - force_across).abs() <= TIE * least.abs();
    let weaker = if force_across < force_along { across } else { along };
    derivatives.extend(weaker.into_iter().map(|derivative| ParameterDerivative {
        measure: name::FORCE_ANY_DIRECTION,
        // At a tie the derivatives of both directions differ, so the measure has a kink.
        kink: derivative.kink.clone().or(is_tie.then(|| "the other direction is as weak".into())),
        left: derivative.left.filter(|_| !is_tie),
        right: derivative.right.filter(|_| !is_tie),
        ..derivative
    }));
}

/// Returns the derivatives that belong to a measure.
fn of_measure(measure: &str, derivatives: &[ParameterDerivative]) -> Vec<ParameterDerivative> {
    derivatives.iter().filter(|derivative| derivative.measure == measure).cloned().collect()
}

/// Solves the bending of `case` and differentiates its measures.
pub(super) fn flexure(
    case: &Case,
    wanted: Wanted<'_>,
) -> Result<(Flexure, Vec<ParameterDerivative>), OutOfRange> {
    let (parameters, variations) = variations(case, wanted, Measure::Flexure, |p| {
        Varied { case, parameter: p, slopes: None }.variation(Varied::bent)
    });
    let (flexure, derivatives) = flexure::differentiate(&bent(case), &variations)?;
    Ok((flexure, with_prefactor(case, &named(case, &parameters, derivatives))))
}

/// Returns the derivatives of the coverage of `case`.
pub(super) fn coverage(case: &Case, wanted: Wanted<'_>) -> Vec<ParameterDerivative> {
    let Ok(row) = case.design.row() else { return Vec::new() };
    let parameters = wanted.parameters(case, Measure::Coverage);
    if !case.body().is_flat() {
        let derivatives = parameters.iter().enumerate();
        let derivatives = derivatives.map(|(index, of)| coverage_difference(case, index, of));
        return named(case, &parameters, derivatives.collect());
    }
    let half_base = case.design.half_base() / case.design.length;
    let shift = row.scale().slant().cos().powi(-2) * 1.0_f64.to_radians();
    let derivative = |(parameter, key): (usize, &str)| {
        let change = match key {
            "gap_over_t" => RowChange { gap: 1.0, ..RowChange::default() },
            "length_over_t" => RowChange { half_base, ..RowChange::default() },
            "slant_deg" => RowChange { shift, ..RowChange::default() },
            _ => return coverage_difference(case, parameter, parameters[parameter]),
        };
        let RowChange { gap, half_base, shift } = change;
        let back = RowChange { gap: -gap, half_base: -half_base, shift: -shift };
        let [left, right] = [-row.coverage_rate(&back), row.coverage_rate(&change)];
        // Rounding makes the rates `left` and `right` differ by about 1e-15. A scale that enters or
        // leaves the line makes them differ by much more.
        let smooth = (left - right).abs() <= 1e-9;
        Derivative {
            measure: name::COVERAGE,
            parameter,
            value: row.coverage(),
            left: Some(left),
            right: Some(if smooth { left } else { right }),
            kink: (!smooth).then(|| "another scale under the line".to_owned()),
        }
    };
    let keys = parameters.iter().map(|parameter| parameter.key).enumerate();
    named(case, &parameters, keys.map(derivative).collect())
}

/// Differentiates the coverage by one-sided finite differences of second order.
fn coverage_difference(case: &Case, index: usize, parameter: &Parameter) -> Derivative {
    let [left, right] = [-1.0, 1.0].map(|side| coverage_rate(case, parameter, side));
    // The tolerance covers rounding errors of the coverage divided by the step.
    let smooth = left.zip(right).is_none_or(|(left, right)| (left - right).abs() <= 1e-7);
    Derivative {
        measure: name::COVERAGE,
        parameter: index,
        value: coverage_beside(case, parameter, 0.0).unwrap_or(f64::NAN),
        left,
        right: if smooth { left } else { right },
        kink: (!smooth).then(|| "another scale under the line".to_owned()),
    }
}

/// Computes the derivative of the coverage for a decreasing (`side` = −1) or increasing (1)
/// parameter.
fn coverage_rate(case: &Case, parameter: &Parameter, side: f64) -> Option<f64> {
    let step = side * STEP * parameter.size(case)?;
    let [here, next, second] =
        [0.0, 1.0, 2.0].map(|steps| coverage_beside(case, parameter, steps * step));
    Some((4.0 * next? - second? - 3.0 * here?) / (2.0 * step))
}

/// Computes the coverage after adding `by` to a parameter.
fn coverage_beside(case: &Case, parameter: &Parameter, by: f64) -> Option<f64> {
    let moved = parameter.moved(case, by)?;
    Some(moved.design.leaning_row().ok()?.coverage_on(moved.body()))
}

/// Adds the key and the value of its parameter to each derivative.
pub(super) fn named(
    case: &Case,
    parameters: &[&'static Parameter],
    derivatives: Vec<Derivative>,
) -> Vec<ParameterDerivative> {
    derivatives
        .into_iter()
        .filter_map(|derivative| {
            let parameter = parameters[derivative.parameter];
            let value = parameter.get(case).number()?;
            Some(ParameterDerivative::new(parameter.key, value, derivative))
        })
        .collect()
}

/// Returns the puncture problem of `case` on a substrate with the given stiffness.
pub(super) fn punctured(case: &Case, stiffness: RowStiffness) -> PunctureInput {
    let Case { design, common, .. } = *case;
    let parameters = case.punctured();
    PunctureInput { design, stiffness, common, parameters, perturbed: None }
}

pub(super) fn bent(case: &Case) -> FlexureInput {
    let Case { design, common, flexure: parameters, .. } = *case;
    FlexureInput { design, common, parameters }
}

/// A case with one parameter that is varied.
pub(super) struct Varied<'a> {
    pub(super) case: &'a Case,
    pub(super) parameter: &'static Parameter,
    pub(super) slopes: Option<&'a StiffnessSlopes>,
}

impl Varied<'_> {
    /// Returns the inputs with the parameter below and above its value, for finite differences.
    pub(super) fn variation<P>(
        &self,
        of: impl Fn(&Self, f64) -> Option<P>,
    ) -> Option<Neighbours<P>> {
        let step = STEP * self.parameter.size(self.case)?;
        let [below, above] = [-step, step].map(|by| of(self, by));
        Some(Neighbours { below: below?, above: above?, step })
    }

    pub(super) fn punctured(&self, by: f64) -> Option<PunctureInput> {
        let moved = self.parameter.moved(self.case, by)?;
        Some(punctured(&moved, self.stiffness(&moved)?))
    }

    /// Returns the input of a row on a body between the two radii after adding `by` to the
    /// parameter.
    fn punctured_between(&self, fraction: f64, by: f64) -> Option<PunctureInput> {
        let moved = self.parameter.moved(self.case, by)?;
        Some(punctured(&moved.on_body_between(fraction)?, self.stiffness(&moved)?))
    }

    /// Returns the input of the row across after adding `by` to the parameter.
    fn punctured_across(&self, by: f64) -> Option<PunctureInput> {
        let moved = self.parameter.moved(self.case, by)?.across()?;
        let nominal = self.case.across()?;
        let stiffness = self.slopes?.moved(&nominal.bases(), &moved.bases()).ok()?;
        Some(punctured(&moved, stiffness))
    }

    /// Computes the derivative of the factor that normalises the force across like the force along.
    fn factor_rate(&self) -> f64 {
        let factors = self
            .variation(|varied, by| Some(varied.parameter.moved(varied.case, by)?.across_factor()));
        factors.map_or(0.0, |of| (of.above - of.below) / (2.0 * of.step))
    }

    pub(super) fn bent(&self, by: f64) -> Option<FlexureInput> {
        Some(bent(&self.parameter.moved(self.case, by)?))
    }

    /// Returns the stiffness for the case `moved`, extrapolated linearly from the case itself.
    fn stiffness(&self, moved: &Case) -> Option<RowStiffness> {
        // Extrapolate in the dimensions of the bases, which several parameters change: lengths in
        // units of the thickness, lengths in mm, and a thickness in mm.
        self.slopes?.moved(&self.case.bases(), &moved.bases()).ok()
    }
}

//! Forces and moments at given points of a path, with derivatives with respect to parameters.

use skin::{CurvePoint, Neighbours, flexure, puncture};
use sweep::{Case, Parameter};

use super::evaluator::Evaluator;
use super::guard::solved;
use super::sensitivity::{Varied, bent, punctured};
use results::Outcome;

/// Points of a curve; `None` for a point beyond the end of the path.
pub type CurvePoints = Vec<Option<CurvePoint>>;

impl Evaluator {
    /// Returns the puncture force `F*` at each of the displacements `u*`.
    ///
    /// Each point has derivatives with respect to `parameters`.
    ///
    /// # Errors
    ///
    /// If the springs cannot be computed, or the case has no mechanical meaning.
    pub fn force_curve(
        &self,
        case: &Case,
        parameters: &[&'static Parameter],
        displacements: &[f64],
    ) -> Result<CurvePoints, Outcome> {
        let slopes = self.slopes(case)?;
        let variation = |&parameter: &&'static Parameter| {
            Varied { case, parameter, slopes: Some(&slopes) }.variation(Varied::punctured)
        };
        let (exists, variations) = existing(parameters.iter().map(variation));
        let input = punctured(case, slopes.stiffness.clone());
        let curve = solved(|| puncture::force_curve(&input, &variations, displacements))?;
        Ok(with_all_parameters(curve, &exists))
    }

    /// Returns the puncture force `F*` at each of the displacements `u*` during unloading.
    ///
    /// Unloading begins at the displacement `turn`. The points have no derivatives.
    ///
    /// # Errors
    ///
    /// If the springs cannot be computed, or the case has no mechanical meaning.
    pub fn unloading_force_curve(
        &self,
        case: &Case,
        turn: f64,
        displacements: &[f64],
    ) -> Result<CurvePoints, Outcome> {
        let input = punctured(case, self.slopes(case)?.stiffness.clone());
        solved(|| puncture::unloading_curve(&input, turn, displacements))
    }

    /// Returns the bending moment `M*` at each of the curvatures `κ*` during unloading.
    ///
    /// Unloading begins at the curvature `turn`. The points have no derivatives.
    ///
    /// # Errors
    ///
    /// If the case has no mechanical meaning.
    pub fn unloading_moment_curve(
        &self,
        case: &Case,
        turn: f64,
        curvatures: &[f64],
    ) -> Result<CurvePoints, Outcome> {
        solved(|| flexure::unloading_curve(&bent(case), turn, curvatures))
    }

    /// Returns the bending moment `M*` at each of the curvatures `κ*`.
    ///
    /// Each point has derivatives with respect to `parameters`.
    ///
    /// # Errors
    ///
    /// If the case has no mechanical meaning.
    pub fn moment_curve(
        &self,
        case: &Case,
        parameters: &[&'static Parameter],
        curvatures: &[f64],
    ) -> Result<CurvePoints, Outcome> {
        let (exists, variations) =
            existing(parameters.iter().map(|&parameter| {
                Varied { case, parameter, slopes: None }.variation(Varied::bent)
            }));
        let curve = solved(|| flexure::moment_curve(&bent(case), &variations, curvatures))?;
        Ok(with_all_parameters(curve, &exists))
    }
}

/// Returns, for each variation, whether it exists, and a list of the existing variations.
fn existing<P>(
    variations: impl Iterator<Item = Option<Neighbours<P>>>,
) -> (Vec<bool>, Vec<Neighbours<P>>) {
    let all: Vec<_> = variations.collect();
    (all.iter().map(Option::is_some).collect(), all.into_iter().flatten().collect())
}

/// Expands the derivatives of each point to one entry for each parameter.
///
/// The entry is `None` for a parameter without a variation.
fn with_all_parameters(mut curve: CurvePoints, exists: &[bool]) -> CurvePoints {
    for point in curve.iter_mut().flatten() {
        let mut rates = std::mem::take(&mut point.rates).into_iter();
        point.rates = exists
            .iter()
            .map(|&exists| if exists { rates.next().flatten() } else { None })
            .collect();
    }
    curve
}

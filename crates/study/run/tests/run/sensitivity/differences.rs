//! Finite differences of complete solutions, with which derivatives are compared.

use std::cell::RefCell;
use std::collections::HashMap;

use results::DesignResult;
use run::Evaluator;
use sweep::{Case, Measure, Parameter};

use super::TOLERANCE;

/// Direction in parameter space: parameters with their rates.
pub type Direction = [(&'static Parameter, f64)];

/// Finite differences of the measures of one design.
pub struct Differences<'a> {
    case: &'a Case,
    /// Evaluator of all solutions, so that the springs of equal footprints are computed once.
    evaluator: Evaluator,
    /// Results by direction and number of steps.
    solved: RefCell<HashMap<(String, i32), DesignResult>>,
}

/// Length of the smallest step, as a factor of the rates of a direction.
const STEP: f64 = 1.25e-5;

/// Step lengths as multiples of the smallest step.
///
/// Short steps avoid nearby kinks, long steps reduce rounding errors. Each estimate uses a step and
/// its double, so the first three estimates share solutions.
const STEPS: [i32; 5] = [128, 64, 32, 8, 1];

/// Relative difference of estimates with successive steps below which a measure counts as smooth.
const AGREE: f64 = 1e-4;

/// Rounding error of a difference, divided by the measure.
///
/// It contains the rounding errors of the solver and of the subtraction.
const NOISE: f64 = 1e-7;

/// Relative accuracy of maxima that are located numerically, such as the largest stiffness.
///
/// The search for a maximum stops when three values agree to 1e-10.
const SEARCHED: f64 = 2e-10;

impl<'a> Differences<'a> {
    pub fn of(case: &'a Case) -> Self {
        Self::of_measures(case, &Measure::USUAL)
    }

    /// Creates the differences of the given kinds of measures only.
    pub fn of_measures(case: &'a Case, measures: &[Measure]) -> Self {
        let evaluator = Evaluator::new(measures);
        Self { case, evaluator, solved: RefCell::default() }
    }

    /// Returns the error of a directional derivative `ours`, divided by `ours`.
    ///
    /// The reference is a central difference, computed with several step lengths. Returns the first
    /// error below the tolerance, or else the smallest error. Returns `None` if the measure has a
    /// kink or no value near the design.
    pub fn off(&self, measure: &str, along: &Direction, ours: f64) -> Option<f64> {
        let at = |steps: i32| self.value(measure, along, steps);
        let mut estimates = STEPS.into_iter().filter_map(|steps| {
            let difference = |steps: i32| -> Option<f64> {
                Some((at(steps)? - at(-steps)?) / (2.0 * f64::from(steps) * STEP))
            };
            let (fine, rough) = (difference(steps)?, difference(2 * steps)?);
            Some((fine + (fine - rough) / 3.0, f64::from(steps) * STEP))
        });
        // The difference of estimates with successive steps measures their accuracy. If these
        // estimates do not agree, there is a kink between the solutions.
        let (mut rough, _) = estimates.next()?;
        let mut offs = estimates.filter_map(|(fine, step)| {
            let pair = [std::mem::replace(&mut rough, fine), fine];
            let spread = (pair[0] - fine).abs() / ours.abs().max(1e-300);
            let off = pair.map(|estimate| self.distance(measure, estimate, ours, step));
            let nearest = off.into_iter().flatten().reduce(f64::min)?;
            (spread <= AGREE || nearest == 0.0).then_some((nearest - spread).max(0.0))
        });
        // Shorter steps are used only if no longer step gives a sufficiently small error.
        let first = offs.next()?;
        if first <= TOLERANCE { Some(first) } else { Some(offs.fold(first, f64::min)) }
    }

    /// Returns the error of a directional derivative `ours` compared with a one-sided difference.
    ///
    /// The difference is computed with several step lengths. Returns the first error below the
    /// tolerance, or else the smallest error.
    pub fn off_one_sided(&self, measure: &str, along: &Direction, ours: f64) -> Option<f64> {
        let at = |steps: i32| self.value(measure, along, steps);
        let offs = STEPS.iter().filter_map(|&steps| {
            let difference = |h: i32| -> Option<f64> {
                let rise = -3.0 * at(0)? + 4.0 * at(h)? - at(2 * h)?;
                Some(rise / (2.0 * f64::from(h) * STEP))
            };
            let (fine, rough) = (difference(steps)?, difference(2 * steps)?);
            self.distance(measure, fine + (fine - rough) / 3.0, ours, f64::from(steps) * STEP)
        });
        let mut smallest: Option<f64> = None;
        for off in offs {
            smallest = Some(smallest.map_or(off, |smallest| smallest.min(off)));
            if off <= TOLERANCE {
                break;
            }
        }
        smallest
    }

    fn distance(&self, measure: &str, difference: f64, ours: f64, step: f64) -> Option<f64> {
        let is_searched = ["max_stiffness", "compliance"].contains(&measure);
        let part = NOISE + if is_searched { SEARCHED / step } else { 0.0 };
        let noise = part * self.value(measure, &[], 0)?.abs();
        Some(((ours - difference).abs() - noise).max(0.0) / ours.abs().max(1e-300))
    }

    fn value(&self, measure: &str, along: &Direction, steps: i32) -> Option<f64> {
        let along = if steps == 0 { &[] } else { along };
        let key = along.iter().map(|(parameter, rate)| format!("{} {rate:e} ", parameter.key));
        let mut solved = self.solved.borrow_mut();
        let result = solved.entry((key.collect(), steps)).or_insert_with(|| {
            let moved = along.iter().try_fold(*self.case, |case, (parameter, rate)| {
                parameter.moved(&case, f64::from(steps) * STEP * rate)
            });
            self.evaluator.solve(super::designs::number(), &moved.unwrap()).row.result
        });
        value(result, measure)
    }
}

/// Returns the value of the measure `name`, or `None` if it has no value.
pub fn value(result: &DesignResult, name: &str) -> Option<f64> {
    let puncture = result.puncture.map(|puncture| puncture.measures);
    let flexure = result.flexure.map(|flexure| flexure.measures);
    match name {
        "coverage" => result.coverage,
        "critical_force" => puncture?.critical_force,
        "peak_force" => puncture?.peak_force,
        "critical_displacement" => puncture?.critical_displacement,
        "penetration" => puncture?.penetration,
        "sink" => puncture?.sink,
        "first_contact_displacement" => puncture?.first_contact_displacement,
        "initial_stiffness" => puncture?.initial_stiffness,
        "max_stiffness" => puncture?.max_stiffness,
        "secant_stiffness" => puncture?.secant_stiffness,
        "gap_stretch_min" => puncture?.gap_stretch_min,
        "gap_stretch_max" => puncture?.gap_stretch_max,
        "fold_force" => puncture?.fold_force,
        "fold_displacement" => puncture?.fold_displacement,
        "fold_tilt_deg" => puncture?.fold_tilt_deg,
        "sound_force" => puncture?.sound_force,
        "peak_displacement" => puncture?.peak_displacement,
        "peak_tilt_deg" => puncture?.peak_tilt_deg,
        "load_stability_force" => puncture?.load_stability_force,
        "depth_stability_force" => puncture?.depth_stability_force,
        "weakest_force" => puncture?.weakest.force,
        "failure_force" => puncture?.failure.force,
        "force_across" => puncture?.across.force,
        "force_any_direction" => puncture?.across.any_direction,
        "scale_stress_max" => puncture?.failure.scale_stress,
        "scale_deflection_max" => puncture?.failure.scale_deflection,
        "bond_stress_max" => puncture?.failure.bond_stress,
        "tissue_pressure_max" => puncture?.failure.tissue_pressure,
        "tissue_pressure_at_force" => puncture?.tissue_pressure_at_force,
        "clearance" => puncture?.failure.clearance,
        "compliance" => flexure?.compliance,
        "initial_compliance" => flexure?.initial_compliance,
        "first_contact_curvature" => flexure?.first_contact_curvature,
        "contact_curvature" => flexure?.contact_curvature,
        "max_moment" => flexure?.max_moment,
        "axial_energy_share" => flexure?.axial_energy_share,
        "membrane_strain_max" => flexure?.membrane_strain_max,
        other => panic!("{other}"),
    }
}

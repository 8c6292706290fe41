//! Centred differences of whole solutions.

use std::cell::RefCell;
use std::collections::HashMap;

use results::DesignResult;
use run::Evaluator;
use sweep::{Case, Measure, Parameter};

/// Differences of the solutions of designs near one.
pub struct Differences<'a> {
    case: &'a Case,
    solved: RefCell<HashMap<(&'static str, i32), DesignResult>>,
}

/// The smallest step, as a part of a parameter; others are its multiples.
const STEP: f64 = 5e-5;

/// Steps, as multiples: a short one for designs near a kink, longer ones for derivatives that drown in round-off.
const STEPS: [i32; 3] = [32, 8, 2];

impl<'a> Differences<'a> {
    pub fn of(case: &'a Case) -> Self {
        Self { case, solved: RefCell::default() }
    }

    /// How far a derivative is from the difference that is nearest to it, relative to it. `None` if the measure does not exist.
    pub fn off(&self, measure: &str, parameter: &'static Parameter, ours: f64) -> Option<f64> {
        let size = parameter.size(self.case)?;
        let at = |steps: i32| self.value(measure, parameter, steps);
        let offs = STEPS.iter().filter_map(|&steps| {
            let difference = |steps: i32| -> Option<f64> {
                let width = 2.0 * f64::from(steps) * STEP * size;
                Some((at(steps)? - at(-steps)?) / width)
            };
            let (fine, rough) = (difference(steps)?, difference(2 * steps)?);
            let difference = fine + (fine - rough) / 3.0;
            let noise = 1e-8 * at(0)?.abs() / size;
            Some(((ours - difference).abs() - noise).max(0.0) / ours.abs().max(1e-300))
        });
        offs.reduce(f64::min)
    }

    fn value(&self, measure: &str, parameter: &'static Parameter, steps: i32) -> Option<f64> {
        let mut solved = self.solved.borrow_mut();
        let result = solved.entry((parameter.key, steps)).or_insert_with(|| {
            let size = parameter.size(self.case).unwrap();
            let case = parameter.moved(self.case, f64::from(steps) * STEP * size).unwrap();
            solve(&case)
        });
        value(result, measure)
    }
}

fn solve(case: &Case) -> DesignResult {
    Evaluator::new(&Measure::USUAL).solve(super::designs::number(), case).row.result
}

/// The measure of that name.
pub fn value(result: &DesignResult, name: &str) -> Option<f64> {
    let puncture = result.puncture.map(|puncture| puncture.measures)?;
    let flexure = result.flexure.map(|flexure| flexure.measures)?;
    match name {
        "coverage" => result.coverage,
        "critical_force" => puncture.critical_force,
        "peak_force" => puncture.peak_force,
        "critical_displacement" => puncture.critical_displacement,
        "penetration" => puncture.penetration,
        "sink" => puncture.sink,
        "first_contact_displacement" => puncture.first_contact_displacement,
        "initial_stiffness" => puncture.initial_stiffness,
        "max_stiffness" => puncture.max_stiffness,
        "secant_stiffness" => puncture.secant_stiffness,
        "compliance" => flexure.compliance,
        "initial_compliance" => flexure.initial_compliance,
        "first_contact_curvature" => flexure.first_contact_curvature,
        "max_moment" => flexure.max_moment,
        "axial_energy_share" => flexure.axial_energy_share,
        "membrane_strain_max" => flexure.membrane_strain_max,
        other => panic!("{other}"),
    }
}

//! Derivatives with respect to gaps and slants of single scales.

use run::Evaluator;
use skin::puncture;
use substrate::{Calibrations, Coupling, RowStiffness};
use sweep::{Case, Measure};

use super::designs::random_case;

fn force(case: &Case, stiffness: &RowStiffness) -> Option<f64> {
    let Case { design, common, puncture: parameters, .. } = case;
    puncture::solve(design, stiffness.clone(), common, parameters).ok()?.measures.critical_force
}

/// On a fixed substrate, derivatives for single scales add up to the derivative for all scales.
#[test]
fn derivatives_for_single_scales_add_up_to_the_common_derivative() {
    let mut compared = 0;
    for k in 0..8 {
        let case = random_case(k);
        let footprint = case.footprint().expect("a footprint");
        let stiffness =
            Calibrations::default().row(&footprint, Coupling::Nearest).expect("a stiffness");
        let scatter = Evaluator::new(&[Measure::Puncture]).scatter(&case);
        for key in ["gap_over_t", "slant_deg"] {
            let single =
                scatter.iter().filter(|d| d.measure == "critical_force" && d.parameter == key);
            let slopes: Option<Vec<f64>> =
                single.map(results::ParameterDerivative::derivative).collect();
            let Some(slopes) = slopes.filter(|slopes| !slopes.is_empty()) else { continue };
            let moved = |by: f64| {
                let mut case = case;
                match key {
                    "gap_over_t" => case.design.gap += by,
                    _ => case.design.slant_deg += by,
                }
                force(&case, &stiffness)
            };
            let unit = if key == "gap_over_t" { case.design.gap } else { 1.0 };
            let step = 1e-5 * unit;
            let Some((above, below)) = moved(step).zip(moved(-step)) else { continue };
            let (sum, whole) = (slopes.iter().sum::<f64>(), (above - below) / (2.0 * step));
            let size = slopes.iter().map(|slope| slope.abs()).sum::<f64>();
            // If the force hardly changes, its differences consist of rounding errors.
            let allowed = 1e-5 * size + 1e-8 * above.abs() / unit;
            assert!((sum - whole).abs() < allowed, "{key} {k}: {sum} {whole}");
            compared += 1;
        }
    }
    assert!(compared >= 10, "{compared}");
}

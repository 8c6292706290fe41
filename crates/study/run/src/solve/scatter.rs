//! Derivatives of measures with respect to gaps and slants of single scales.

use geometry::OutOfRange;
use results::ParameterDerivative;
use results::columns::name;
use skin::Neighbours;
use skin::flexure::whole_gaps;
use skin::puncture::{self, PerturbedScale, PunctureInput};
use substrate::RowStiffness;
use sweep::{Case, Parameter};

use super::sensitivity::{self, STEP, Wanted, named};

/// Maximum number of scales with a varied gap and slant on each side of the punctured scale.
///
/// Scales farther away have a negligible effect.
const FARTHEST: usize = 60;

/// Keys of the parameters that scatter from scale to scale.
const SCATTERED: [&str; 2] = ["gap_over_t", "slant_deg"];

/// Measures of bending that depend only on the first gap to close.
const OF_FIRST_GAP: [&str; 2] = [name::FIRST_CONTACT_CURVATURE, name::CONTACT_CURVATURE];

/// Returns the nonzero derivatives of puncture measures with respect to single gaps and slants.
///
/// The gap and the slant of each scale near the punctured one are varied. The substrate does not
/// change, as for imperfect rows.
pub(super) fn puncture(
    case: &Case,
    stiffness: &RowStiffness,
) -> Result<Vec<ParameterDerivative>, OutOfRange> {
    let input = sensitivity::punctured(case, stiffness.clone());
    // The path without variations shows how many scales of the row are affected.
    let (nominal, _) = puncture::differentiate(&input, &[])?;
    let farthest = nominal.measures.scales.min(FARTHEST) as i32;
    let (mut parameters, mut variations) = (Vec::new(), Vec::new());
    for parameter in SCATTERED.into_iter().filter_map(Parameter::named) {
        for offset in -farthest..=farthest {
            parameters.push(parameter);
            variations.extend(one_scale(case, &input, parameter, offset));
        }
    }
    let (_, derivatives) = puncture::differentiate(&input, &variations)?;
    let mut derivatives = named(case, &parameters, derivatives);
    // Omit scales without effect, so that zeros do not fill the journal.
    derivatives.retain(|derivative| derivative.left != Some(0.0) || derivative.kink.is_some());
    Ok(derivatives)
}

/// Returns the puncture inputs with the gap or slant of a single scale varied by ± one step.
///
/// `offset` is the number of scales from the punctured scale to the right, negative to the left.
fn one_scale(
    case: &Case,
    input: &PunctureInput,
    parameter: &'static Parameter,
    offset: i32,
) -> Option<Neighbours<PunctureInput>> {
    let step = STEP * parameter.size(case)?;
    let perturbed = |by: f64| match parameter.key {
        "gap_over_t" => PerturbedScale { offset, gap: by, slant_deg: 0.0 },
        _ => PerturbedScale { offset, gap: 0.0, slant_deg: by },
    };
    let [below, above] =
        [-step, step].map(|by| PunctureInput { perturbed: Some(perturbed(by)), ..input.clone() });
    Some(Neighbours { below, above, step })
}

/// Returns the derivatives of bending measures with respect to scatter of gaps and slants.
///
/// All gaps have the same effect in pure bending, so one derivative represents all gaps. For
/// independent deviations of `n` gaps this derivative is `1/√n` of the derivative with respect to a
/// common deviation. The number of gaps is fixed. Measures that depend on the first gap to close
/// have a kink if all gaps are equal.
pub(super) fn flexure(case: &Case) -> Result<Vec<ParameterDerivative>, OutOfRange> {
    let gaps = whole_gaps(&case.design.row()?, &case.flexure);
    let mut fixed = *case;
    // Fix the number of gaps: a change of the gap could otherwise change this number, which is a
    // jump.
    fixed.flexure.gaps = Some(gaps);
    let (_, mut derivatives) = sensitivity::flexure(&fixed, Wanted::All)?;
    derivatives.retain(|derivative| SCATTERED.contains(&derivative.parameter));
    let factor = (gaps as f64).sqrt().recip();
    for derivative in &mut derivatives {
        if OF_FIRST_GAP.contains(&derivative.measure) {
            (derivative.left, derivative.right) = (None, None);
            derivative.kink = Some("one gap closes before the others".to_owned());
        }
        derivative.left = derivative.left.map(|slope| factor * slope);
        derivative.right = derivative.right.map(|slope| factor * slope);
    }
    Ok(derivatives)
}

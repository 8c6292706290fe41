//! Warnings about a solved design, as sentences for users.

use results::{DesignRow, Outcome};
use skin::puncture::PunctureMeasures;
use sweep::{Case, Sweep};
use text::number::rounded;

use crate::curved_body::curved_body_warning;
use crate::gap_change::GapChange;

/// Largest strain for which the small-strain law of the membrane is valid.
const LARGE_STRAIN: f64 = 0.2;

/// Width in mm of the line that common printers extrude.
///
/// Narrower gaps are closed by the print, and thinner walls are not printed.
const NOZZLE_MM: f64 = 0.4;

/// Largest overhang from the vertical that printers build without supports, degrees.
const OVERHANG_DEG: f64 = 45.0;

/// Returns all warnings about a design: validity of its results, curved bodies, and printing.
///
/// `radius_mm` is the required bend radius. `change` holds the measures with other gaps.
pub fn design_warnings(
    sweep: &Sweep,
    row: &DesignRow,
    radius_mm: Option<f64>,
    change: Option<&GapChange>,
) -> Vec<String> {
    let mut sentences = validity_warnings(&row.case, row, radius_mm, change);
    sentences.extend(curved_body_warning(sweep, row));
    sentences.extend(printing_warnings(&row.case));
    sentences
}

/// Returns warnings about the validity of the results of a design.
///
/// `radius_mm` is the required bend radius; without it the strain is judged at the end of the
/// bending path. `change` holds the measures with other gaps.
pub fn validity_warnings(
    case: &Case,
    row: &DesignRow,
    radius_mm: Option<f64>,
    change: Option<&GapChange>,
) -> Vec<String> {
    let mut sentences = Vec::new();
    let ends = [
        ("needle", row.result.puncture.as_ref().map(|p| p.outcome)),
        ("bending", row.result.flexure.as_ref().map(|f| f.outcome)),
    ];
    for (load, outcome) in ends {
        if let Some(outcome) = outcome.filter(|outcome| *outcome != Outcome::Complete) {
            sentences.push(format!("The path of the {load} ends early: {outcome}."));
        }
    }
    if let Some(puncture) = &row.result.puncture {
        sentences.extend(puncture_warnings(case, &puncture.measures));
    }
    sentences.extend(strain_warning(case, row, radius_mm));
    sentences.extend(change.into_iter().flat_map(cliffs));
    sentences
}

fn puncture_warnings(case: &Case, measures: &PunctureMeasures) -> Vec<String> {
    let mut sentences = Vec::new();
    // Without a critical force the path ended early, for which there is another warning.
    if let (Some(fold), Some(force)) = (measures.fold_force, measures.critical_force) {
        let percent = 100.0 * fold / force;
        sentences.push(format!("Beyond {percent:.0} % of the critical force, the modelled surface folds, which is physically impossible: results at larger forces are not valid."));
    }
    // A round tip normally touches the next scale while it still rests on the first, so this
    // warning applies to sharp tips only.
    let is_sharp = case.punctured().needle_radius.is_none_or(|radius| radius == 0.0);
    if let Some(tilt) = measures.passage.passing_tilt_deg.filter(|_| is_sharp) {
        sentences.push(format!(
            "At a tilt of {tilt:.1}° the needle reaches the end of the face on which it was set down (a corner, or the notch beside the next scale) and continues from there."
        ));
    }
    if let (Some(depth), Some(thickness)) =
        (measures.critical_displacement.filter(|depth| *depth > 1.0), case.material.thickness_mm)
    {
        sentences.push(format!(
            "The needle is {} mm deep at the critical tilt, deeper than the scales are thick ({} mm).",
            rounded(depth * thickness, 3),
            rounded(thickness, 3)
        ));
    }
    sentences
}

/// Returns a sentence if the strain of the membrane is too large for its small-strain law.
fn strain_warning(case: &Case, row: &DesignRow, radius_mm: Option<f64>) -> Option<String> {
    let required = radius_mm.zip(case.material.thickness_mm);
    let strain = match required {
        // Until scales touch, only the membrane in the gaps bends.
        Some((radius, thickness)) => {
            let curvature = case.pitch() / case.design.gap * thickness / radius;
            0.5 * case.flexure.membrane_thickness * curvature
        }
        None => row.result.flexure.as_ref()?.measures.membrane_strain_max?,
    };
    let bent = match radius_mm {
        Some(radius) => format!("Bent round {} mm", rounded(radius, 3)),
        None => format!("Bent by {}°", rounded(case.flexure.max_end_rotation_deg, 3)),
    };
    (strain > LARGE_STRAIN).then(|| {
        format!(
            "{bent}, the membrane is strained by {:.0} %, beyond the {:.0} % of its small-strain law.",
            100.0 * strain,
            100.0 * LARGE_STRAIN
        )
    })
}

/// Returns a sentence for each measure with a cliff when the gap changes by a tenth.
fn cliffs(change: &GapChange) -> impl Iterator<Item = String> {
    change.measures.iter().filter(|measure| measure.cliffs().contains(&true)).map(|measure| {
        let [smaller, larger] = measure.changed.map(|changed| {
            changed.map_or("without a value".to_owned(), |changed| {
                format!("{:.2} times as large", changed / measure.value)
            })
        });
        format!(
            "Sensitive to the gap: with a gap 10 % smaller or larger, the {} is {smaller} or {larger}.",
            measure.column.replace('_', " ")
        )
    })
}

/// Returns warnings about printing a design, or none if the definition has no thickness in mm.
fn printing_warnings(case: &Case) -> Vec<String> {
    let Some(thickness) = case.material.thickness_mm else { return Vec::new() };
    let slant = case.design.slant_deg.abs();
    let upright = slant.to_radians().cos();
    let mut sentences = Vec::new();
    let clearance = case.design.row().map(|row| row.clearance_on(case.body()) * thickness);
    if let Ok(clearance) = clearance
        && clearance < NOZZLE_MM
    {
        sentences.push(format!(
            "The faces of two scales are {} mm apart, less than a nozzle of {NOZZLE_MM} mm: prints may fuse them.",
            rounded(clearance, 3)
        ));
    }
    if slant > OVERHANG_DEG {
        sentences.push(format!(
            "The scales overhang by {}° from the vertical: above {OVERHANG_DEG}° a filament printer needs supports.",
            rounded(slant, 3)
        ));
    }
    let walls = [
        ("scales", 2.0 * case.design.half_base() * thickness * upright),
        ("scales", thickness),
        ("membrane", case.flexure.membrane_thickness * thickness),
    ];
    for (part, wall) in walls {
        if wall < NOZZLE_MM {
            let is = if part == "membrane" { "is" } else { "are" };
            sentences.push(format!(
                "The {part} {is} only {} mm thick, less than a nozzle of {NOZZLE_MM} mm.",
                rounded(wall, 3)
            ));
        }
    }
    sentences
}

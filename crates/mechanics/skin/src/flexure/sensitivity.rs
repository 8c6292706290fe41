//! Derivatives of the measures of bending.

use geometry::OutOfRange;
use solver::{Continuation, Neighbours};

use super::first_contact::{contact_curvature_of_row, curvature_derivatives};
use super::measures::larger;
use super::mesh::Resolution;
use super::problem::{Bent, FlexureProblem};
use super::strip::Strip;
use super::{Flexure, FlexureParameters};
use crate::contacts::Contacts;
use crate::path_location::PathLocation;
use crate::record::{PathFunction, Record, Skin};
use crate::sensitivity::{
    self, Curve, CurvePoint, Derivative, MeasuredPoint, MeasuredQuantity, curve_point, derivatives,
    end, first_contact, missing, quantity, rest,
};
use crate::unloading::unloaded;
use crate::{Common, Design, Status};

/// Complete input of bending a design.
#[derive(Clone, Debug)]
pub struct FlexureInput {
    /// The design.
    pub design: Design,
    /// Contact law and solver settings.
    pub common: Common,
    /// The parameters of bending.
    pub parameters: FlexureParameters,
}

/// Functions with a maximum on the path that is a measure, except the stiffness.
pub(super) const FOLLOWED: [PathFunction<Strip>; 2] = [
    |strip, state, _| strip.normalised_moment(&state.z),
    |strip, state, _| strip.largest_strain(state),
];
/// Index of the moment in [`FOLLOWED`].
const MOMENT: usize = 0;
/// Index of the membrane strain in [`FOLLOWED`].
const STRAIN: usize = 1;

/// Relative distance between the curvatures of first contact and of the end of bending.
///
/// If the distance is larger, a difference step of a few millionths of a parameter cannot change
/// whether scales touch before the end.
const NEARLY: f64 = 1e-3;

/// Bends a strip like [`solve`](super::solve), and differentiates its measures.
///
/// Returns the derivatives with respect to the parameter of each variation. The list is empty if
/// the path was not completed.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn differentiate(
    input: &FlexureInput,
    variations: &[Neighbours<FlexureInput>],
) -> Result<(Flexure, Vec<Derivative>), OutOfRange> {
    let FlexureInput { design, common, parameters } = input;
    let problem = FlexureProblem::even(design, common, parameters)?;
    let (mut bent, resolution) = problem.resolved(&FOLLOWED, &[])?;
    let derivatives = match bent.status {
        Status::Complete => {
            let mut derivatives = problem.derivatives(&mut bent, resolution, variations)?;
            derivatives.extend(curvature_derivatives(input, variations)?);
            derivatives
        }
        _ => Vec::new(),
    };
    Ok((problem.flexure(bent), derivatives))
}

/// Curve of the moment `M*` over the curvature `κ*`.
const MOMENT_OVER_CURVATURE: Curve<Strip> = [
    |strip, state, _, _| strip.curvature(&state.z),
    |strip, state, _, _| strip.normalised_moment(&state.z),
];

/// Computes the moment `M*` at given curvatures `κ*`, with a derivative for each variation.
///
/// Follows the path to the largest curvature. `None` for a curvature that the path does not reach.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn moment_curve(
    input: &FlexureInput,
    variations: &[Neighbours<FlexureInput>],
    curvatures: &[f64],
) -> Result<Vec<Option<CurvePoint>>, OutOfRange> {
    let (input, rotations) = bent_to(input, curvatures)?;
    let FlexureInput { design, common, parameters } = &input;
    let problem = FlexureProblem::even(design, common, parameters)?;
    let (bent, resolution) = problem.resolved(&[], &rotations)?;
    // The final rotation scales the control parameter, so perturbed inputs need the same value.
    let end = parameters.max_end_rotation_deg;
    let strips = Neighbours::map_all(variations, |other| {
        let parameters = FlexureParameters { max_end_rotation_deg: end, ..other.parameters };
        strip(&FlexureInput { parameters, ..other.clone() }, resolution)
    })?;
    let system = bent.path.system();
    Ok(bent
        .requested_points
        .into_iter()
        .map(|found| {
            let point = found?;
            // In bending, derivatives of the position at which a contact sticks are not available.
            let known =
                if Contacts::stick_slip_counts(&point.state)[0] > 0 { &[][..] } else { &strips };
            let mut on_curve =
                curve_point(system, &point, known, &common.solver, MOMENT_OVER_CURVATURE);
            on_curve.rates.resize(strips.len(), None);
            Some(on_curve)
        })
        .collect())
}

/// Computes the moment `M*` at given curvatures of the unloading path, without derivatives.
///
/// Unloading begins at the curvature `turn`. `None` for curvatures below the residual curvature,
/// and for all curvatures if the loading path does not reach `turn`.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn unloading_curve(
    input: &FlexureInput,
    turn: f64,
    curvatures: &[f64],
) -> Result<Vec<Option<CurvePoint>>, OutOfRange> {
    let (input, rotations) = bent_to(input, &[turn])?;
    let FlexureInput { design, common, parameters } = &input;
    let problem = FlexureProblem::even(design, common, parameters)?;
    let (mut bent, _) = problem.resolved(&[], &rotations)?;
    let locations = curvatures.iter().map(|&value| PathLocation {
        quantity: |strip: &Strip, state| strip.curvature(&state.z),
        value,
    });
    let turn = bent.requested_points.swap_remove(0);
    Ok(unloaded(&mut bent.path, turn, locations, &common.solver, MOMENT_OVER_CURVATURE))
}

/// Returns the input for bending a strip to the largest one of the given `curvatures`.
///
/// Also returns the rotation of each end at each curvature, in radians.
fn bent_to(
    input: &FlexureInput,
    curvatures: &[f64],
) -> Result<(FlexureInput, Vec<f64>), OutOfRange> {
    let FlexureInput { design, common, parameters } = input;
    // `κ* length` is the relative rotation of the ends, which is twice the rotation of each end.
    let length = FlexureProblem::even(design, common, parameters)?.length();
    let rotations: Vec<_> = curvatures.iter().map(|curvature| 0.5 * curvature * length).collect();
    // Use the largest magnitude, because rotations are negative with the scales on the outside.
    let farthest = rotations.iter().copied().fold(0.0, larger);
    // Bend slightly further, so that round-off does not put the last curvature beyond the end.
    let end = (1.001 * farthest.to_degrees()).clamp(-180.0, 180.0);
    let parameters = FlexureParameters { max_end_rotation_deg: end, ..*parameters };
    Ok((FlexureInput { parameters, ..input.clone() }, rotations))
}

/// Builds the strip of an input with the given resolution of its membranes.
fn strip(input: &FlexureInput, resolution: Resolution) -> Result<Strip, OutOfRange> {
    let FlexureInput { design, common, parameters } = input;
    FlexureProblem::of_row(design.leaning_row()?, design, common, parameters)?.strip(resolution)
}

impl FlexureProblem<'_> {
    fn derivatives(
        &self,
        bent: &mut Bent,
        resolution: Resolution,
        variations: &[Neighbours<FlexureInput>],
    ) -> Result<Vec<Derivative>, OutOfRange> {
        let spots = self.measured_points(&bent.record, &mut bent.path);
        let strips = Neighbours::map_all(variations, |input| strip(input, resolution))?;
        let strip = bent.path.system();
        let (sticking, free): (Vec<_>, Vec<_>) = spots.into_iter().partition(|spot| {
            spot.point
                .as_ref()
                .is_some_and(|point| Contacts::stick_slip_counts(&point.state)[0] > 0)
        });
        let unknown = missing(strip, &sticking, variations.len());
        let mut derivatives = derivatives(strip, free, &strips, &self.common.solver);
        derivatives.extend(differences(unknown, variations, resolution)?);
        if bent.record.touching.is_none() {
            self.mark_touching(&mut derivatives, variations)?;
        }
        Ok(derivatives)
    }

    /// Removes derivatives of the compliance if a parameter step makes scales touch at the end.
    ///
    /// The compliance jumps at first contact, so it has no derivative there.
    fn mark_touching(
        &self,
        derivatives: &mut [Derivative],
        variations: &[Neighbours<FlexureInput>],
    ) -> Result<(), OutOfRange> {
        // If first contact is far from the end of bending, no parameter step causes contact.
        let ratio = self.contact_curvature.map(|curvature| curvature / self.end_curvature());
        if !ratio.is_some_and(|ratio| (ratio - 1.0).abs() < NEARLY) {
            return Ok(());
        }
        for derivative in derivatives.iter_mut().filter(|of| of.measure == "compliance") {
            let Neighbours { below, above, .. } = &variations[derivative.parameter];
            if touches(below)? || touches(above)? {
                (derivative.left, derivative.right) = (None, None);
                derivative.kink.get_or_insert_with(|| "scales touch".to_owned());
            }
        }
        Ok(())
    }

    /// Lists the points of the path at which measures are evaluated, with these measures.
    fn measured_points(
        &self,
        record: &Record<Strip>,
        path: &mut Continuation<Strip>,
    ) -> Vec<MeasuredPoint<Strip>> {
        let settings = &self.common.solver;
        let touching =
            record.touching.as_ref().and_then(|point| first_contact(path.system(), point));
        let stiffest = match touching {
            Some(_) => {
                let stiffest = record.stiffness_summit(path);
                sensitivity::summit(stiffest, path, Strip::stiffness, settings)
            }
            // Without contact the stiffness is constant.
            None => Some(rest(path.system())),
        };
        let highest = record.highest_point(MOMENT);
        let moment = sensitivity::summit(highest.as_ref(), path, FOLLOWED[MOMENT], settings);
        let strained = record.summit(path, STRAIN);
        let strain = sensitivity::summit(strained.as_ref(), path, FOLLOWED[STRAIN], settings);
        let strip = path.system();
        let points = [
            (stiffest, compliance("compliance")),
            (Some(rest(strip)), compliance("initial_compliance")),
            (touching, quantity("first_contact_curvature", |s, state, _, _| s.curvature(&state.z))),
            (moment, quantity("max_moment", |s, state, _, _| s.normalised_moment(&state.z))),
            (
                Some(end(path)),
                quantity("axial_energy_share", |s, state, _, _| s.axial_energy_share(state)),
            ),
            (strain, quantity("membrane_strain_max", |s, state, _, _| s.largest_strain(state))),
        ];
        points.map(|(point, quantity)| MeasuredPoint::new(point, [quantity])).into()
    }
}

/// Returns true if the scales of a strip touch before the end of bending.
fn touches(input: &FlexureInput) -> Result<bool, OutOfRange> {
    let FlexureInput { design, common, parameters } = input;
    let row = design.leaning_row()?;
    let touching = contact_curvature_of_row(&row, parameters);
    let end = FlexureProblem::of_row(row, design, common, parameters)?.end_curvature();
    Ok(touching.is_some_and(|curvature| curvature <= end))
}

/// Fills `unknown` derivatives at points with sticking contacts by differences of whole solutions.
///
/// In bending, derivatives of the position at which a contact sticks are not available.
fn differences(
    mut unknown: Vec<Derivative>,
    variations: &[Neighbours<FlexureInput>],
    resolution: Resolution,
) -> Result<Vec<Derivative>, OutOfRange> {
    let Some(last) = unknown.iter().map(|derivative| derivative.parameter).max() else {
        return Ok(unknown);
    };
    for (parameter, variation) in variations.iter().enumerate().take(last + 1) {
        // Use the same resolution: its change would dominate the difference.
        let (below, above) =
            (measured(&variation.below, resolution)?, measured(&variation.above, resolution)?);
        for derivative in unknown.iter_mut().filter(|of| of.parameter == parameter) {
            let slopes = [(&below, -1.0), (&above, 1.0)].map(|(nearby, sign)| {
                let (_, value) = nearby.iter().find(|(of, _)| *of == derivative.measure)?;
                Some(sign * (value - derivative.value) / variation.step)
            });
            [derivative.left, derivative.right] = slopes;
            derivative.kink =
                Some("a contact sticks: difference of whole solutions on each side".to_owned());
        }
    }
    Ok(unknown)
}

/// Bends a strip with the given resolution, and returns the names and values of its measures.
///
/// The list is empty if the path is incomplete.
fn measured(
    input: &FlexureInput,
    resolution: Resolution,
) -> Result<Vec<(&'static str, f64)>, OutOfRange> {
    let FlexureInput { design, common, parameters } = input;
    let problem = FlexureProblem::of_row(design.leaning_row()?, design, common, parameters)?;
    let mut bent = problem.bend(resolution, &FOLLOWED, &[])?;
    // Without measures this side of the parameter has no derivative.
    if bent.status != Status::Complete {
        return Ok(Vec::new());
    }
    let spots = problem.measured_points(&bent.record, &mut bent.path);
    let strip = bent.path.system();
    Ok(spots
        .iter()
        .flat_map(|spot| {
            spot.point.as_ref().map_or_else(Vec::new, |point| {
                spot.quantities.iter().map(|of| (of.measure, of.at(strip, point))).collect()
            })
        })
        .collect())
}

fn compliance(measure: &'static str) -> MeasuredQuantity<Strip> {
    let quantity = quantity(measure, |strip: &Strip, state, direction, _| {
        strip.normalised_stiffness(strip.stiffness(state, direction)).recip()
    });
    MeasuredQuantity { depends_on_direction: true, ..quantity }
}

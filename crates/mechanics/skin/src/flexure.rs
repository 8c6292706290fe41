//! Pure bending of a strip: a membrane that carries scales.

mod accuracy;
mod first_contact;
mod frame;
mod gap_by_gap;
mod gap_curve;
mod gap_order;
mod measures;
mod mesh;
mod point;
mod problem;
mod sensitivity;
mod snapshot;
mod strip;
#[cfg(test)]
mod tests;

use std::collections::HashSet;

use frame::{Step, displacements, frames};
use geometry::{OutOfRange, Row};
use problem::FlexureProblem;

use crate::arrangement::Arrangement;
use crate::record::{ContactEvent, Iteration};
use crate::{Common, ContactChange, Design, Sample, Status, Unloading};

pub use first_contact::contact_curvature;
pub use gap_by_gap::BentSample;
pub use measures::FlexureMeasures;
pub use mesh::MembraneMesh;
pub use point::FlexurePoint;
pub use sensitivity::{FlexureInput, differentiate, moment_curve, unloading_curve};
pub use snapshot::{StripSnapshot, snapshots};

/// Selects the gaps of a strip that are solved together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// A single gap. In pure bending equal gaps have equal deformations.
    ///
    /// Unequal gaps are solved separately, because all gaps carry the same moment.
    UnitCell,
    /// All gaps of the strip in one system of equations.
    Chain,
}

/// Parameters of bending other than the design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexureParameters {
    /// Modulus of the contact law divided by the modulus of the membrane, `E_ct/E_m`.
    pub contact_modulus_over_membrane: f64,
    /// Gaps that are solved together: unit cell or chain.
    pub method: Method,
    /// Length `L_whole/t` of the strip; not used if the number of gaps is given.
    pub membrane_length: f64,
    /// Number of gaps of the strip; `None` to derive it from the length.
    pub gaps: Option<usize>,
    /// Thickness `h/t` of the membrane.
    pub membrane_thickness: f64,
    /// Depth of the membrane axis below the bases of the scales, in units of `t`.
    pub membrane_axis_offset: f64,
    /// Discretisation of the membrane in each gap.
    pub elements_per_gap: MembraneMesh,
    /// Rotation of each end at which bending stops, degrees.
    ///
    /// Positive with the scales on the inside of the bend, negative with the scales on the outside.
    pub max_end_rotation_deg: f64,
    /// True to follow also the unloading path, from the end of the loading path to zero moment.
    pub unload: bool,
}

impl Default for FlexureParameters {
    /// Returns the parameters of Shafiei et al. (2021).
    ///
    /// Their scales have `E_ct = 3 GPa` and are 8 mm thick. Their membrane has `E_m = 4.5 MPa` and
    /// is 1 mm thick.
    fn default() -> Self {
        Self {
            contact_modulus_over_membrane: 667.0,
            method: Method::UnitCell,
            membrane_length: 100.0,
            gaps: None,
            membrane_thickness: 0.125,
            membrane_axis_offset: 0.0,
            elements_per_gap: MembraneMesh::Auto,
            max_end_rotation_deg: 180.0,
            unload: false,
        }
    }
}

/// Result of bending a strip.
#[derive(Clone, Debug)]
pub struct Flexure {
    /// Outcome of the path, including the audit of its end.
    pub status: Status,
    /// The measures of bending.
    pub measures: FlexureMeasures,
    /// Every equilibrium of the path, from rest to its end.
    pub path: Vec<FlexurePoint>,
    /// Every contact event, in the order of the path.
    pub events: Vec<ContactEvent<FlexurePoint>>,
    /// Every Newton iteration, in the order of the path.
    pub history: Vec<Iteration>,
    /// The unloading path, if requested and if the loading path was completed.
    pub unloading: Option<Unloading<FlexurePoint>>,
    /// Number of gaps of the strip, rounded to an integer.
    pub gaps: usize,
    /// Relative poses of neighbouring scales in the solved gaps, at every point of the path.
    steps: Vec<Vec<Step>>,
    row: Arrangement,
}

impl Flexure {
    /// Returns true if friction acts between the scales.
    pub fn has_friction(&self) -> bool {
        self.path.iter().any(|point| point.friction_work.is_some())
    }

    /// Returns the width of the range of curvatures `κ*` in which the gaps close.
    ///
    /// The range extends from the first contact in any gap to the first contact in the gap that
    /// closes last. Its width is 0 for a perfect strip; `None` without contact.
    pub fn closing_range(&self) -> Option<f64> {
        let mut closed = HashSet::new();
        let closings = self.events.iter().filter(|event| event.change == ContactChange::Closed);
        // A gap may close at two levels, and again after opening: keep only its first closing.
        let first = closings.filter(|event| closed.insert(event.left_scale));
        let mut curvatures = first.map(|event| event.point.curvature);
        let start = curvatures.next()?;
        Some(curvatures.last().unwrap_or(start) - start)
    }

    /// Returns displacements `x`, `y` and rotation of every scale at point number `point`.
    ///
    /// Displacements are in units of `t`, rotations are counter-clockwise in radians. The first
    /// scale is fixed. `None` if the path has fewer points.
    pub fn shape(&self, point: usize) -> Option<Vec<[f64; 3]>> {
        let frames = frames(self.steps.get(point)?, self.gaps, &self.row);
        Some(displacements(&frames, &self.row))
    }
}

/// Returns the number of gaps `n` of a strip, at least 1.
///
/// It is `n = L_whole/p` unless the parameters give a number. The unit cell does not need an
/// integer `n`: in pure bending the angle between neighbouring scales is `Φ/n`, with the relative
/// rotation `Φ` of both ends. Chains and imperfect strips have [`whole_gaps`].
pub fn gaps(row: &Row, parameters: &FlexureParameters) -> f64 {
    let by_length = parameters.membrane_length / row.pitch();
    parameters.gaps.map_or(by_length, |gaps| gaps as f64).max(1.0)
}

/// Returns the number of gaps of a chain: the number of [`gaps`], rounded.
pub fn whole_gaps(row: &Row, parameters: &FlexureParameters) -> usize {
    // The cast saturates only for strips that would not fit in memory.
    gaps(row, parameters).round() as usize
}

/// Bends the strip of a `design` from rest to the largest rotation of its ends.
///
/// # Errors
/// If a length, a modulus, or a constant of the contact law is not positive.
pub fn solve(
    design: &Design,
    common: &Common,
    parameters: &FlexureParameters,
) -> Result<Flexure, OutOfRange> {
    FlexureProblem::even(design, common, parameters)?.solve()
}

/// Bends an imperfect strip with the gaps and slants of `sample`.
///
/// The strip has as many gaps as the chain of the design. Its curvature is the relative rotation of
/// its ends divided by its actual length. With [`Method::UnitCell`] each gap is solved separately.
/// If this fails, for example because a moment decreases along the path, or if unloading is
/// requested, the assembled chain is solved instead.
///
/// # Errors
/// As [`solve`], or if a scale of the sample overlaps its neighbour in every draw.
pub fn bend_sample(
    design: &Design,
    common: &Common,
    parameters: &FlexureParameters,
    sample: &Sample,
) -> Result<BentSample, OutOfRange> {
    let problem = FlexureProblem::sample(design, common, parameters, sample)?;
    let is_apart = parameters.method == Method::UnitCell && !parameters.unload;
    if let Some(bent) = is_apart.then(|| gap_by_gap::solve(&problem)).transpose()?.flatten() {
        return Ok(bent);
    }
    Ok(BentSample::from(&problem.solve()?))
}

/// Bends the assembled chain of an imperfect strip, and returns its path.
///
/// # Errors
/// As [`bend_sample`].
pub fn solve_sample(
    design: &Design,
    common: &Common,
    parameters: &FlexureParameters,
    sample: &Sample,
) -> Result<Flexure, OutOfRange> {
    FlexureProblem::sample(design, common, parameters, sample)?.solve()
}

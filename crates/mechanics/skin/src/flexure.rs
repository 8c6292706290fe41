//! Pure bending of a membrane that carries scales.

mod accuracy;
mod first_contact;
mod frame;
mod gap_by_gap;
mod gap_curve;
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

/// Gaps of a strip that are solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// One gap: in pure bending equal gaps deform alike.
    ///
    /// Gaps that differ are solved separately, under the moment that all share.
    UnitCell,
    /// All gaps of the strip, assembled.
    Chain,
}

/// Parameters of bending other than the design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexureParameters {
    /// `E_ct / E_m`.
    pub contact_modulus_over_membrane: f64,
    /// Unit cell or chain.
    pub method: Method,
    /// Length `L_whole/t` of the strip, unless the number of gaps is given.
    pub membrane_length: f64,
    /// Number of gaps of the strip; `None` for as many as its length holds.
    pub gaps: Option<usize>,
    /// Thickness `h/t` of the membrane.
    pub membrane_thickness: f64,
    /// Depth of the membrane axis below the bases of the scales, over `t`.
    pub membrane_axis_offset: f64,
    /// Discretisation of the membrane in a gap.
    pub elements_per_gap: MembraneMesh,
    /// Rotation of each end at which bending ends, degrees.
    ///
    /// Negative if the strip bends in the opposite direction, with the scales on the outside.
    pub max_end_rotation_deg: f64,
    /// True to remove the moment again at the end.
    pub unload: bool,
}

impl Default for FlexureParameters {
    /// The values of Shafiei et al. (2021).
    ///
    /// The scales have `E_ct = 3 GPa` and are 8 mm thick. The membrane has `E_m = 4.5 MPa` and is 1
    /// mm thick.
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

/// A strip after bending.
#[derive(Clone, Debug)]
pub struct Flexure {
    /// How the path ended, and whether its end is valid.
    pub status: Status,
    /// The measures of the bending.
    pub measures: FlexureMeasures,
    /// Every equilibrium of the path, from rest.
    pub path: Vec<FlexurePoint>,
    /// Every contact event, in order.
    pub events: Vec<ContactEvent<FlexurePoint>>,
    /// Every Newton iteration.
    pub history: Vec<Iteration>,
    /// The unloading path, if requested and if the loading path was completed.
    pub unloading: Option<Unloading<FlexurePoint>>,
    /// Number of gaps of the strip, rounded.
    pub gaps: usize,
    /// Relative poses of the solved gaps at every point of the path.
    steps: Vec<Vec<Step>>,
    row: Arrangement,
}

impl Flexure {
    /// Returns true if friction acts between the scales.
    pub fn has_friction(&self) -> bool {
        self.path.iter().any(|point| point.friction_work.is_some())
    }

    /// Returns the range of `κ*` over which the gaps close.
    ///
    /// It extends from the first contact in any gap to the first contact in the gap that closes
    /// last. 0 in a perfect strip, `None` without contact.
    pub fn closing_range(&self) -> Option<f64> {
        let mut closed = HashSet::new();
        let closings = self.events.iter().filter(|event| event.change == ContactChange::Closed);
        // A gap may close at both levels, and again after opening: keep its first closing.
        let first = closings.filter(|event| closed.insert(event.left_scale));
        let mut curvatures = first.map(|event| event.point.curvature);
        let start = curvatures.next()?;
        Some(curvatures.last().unwrap_or(start) - start)
    }

    /// Returns the displacement (over `t`) and rotation of every scale.
    ///
    /// Rotations are counter-clockwise, in radians. The first scale is at rest. `None` if the path
    /// has no such point.
    pub fn shape(&self, point: usize) -> Option<Vec<[f64; 3]>> {
        let frames = frames(self.steps.get(point)?, self.gaps, &self.row);
        Some(displacements(&frames, &self.row))
    }
}

/// Returns the number of gaps of a strip, at least 1.
///
/// It is `n = L_whole/p` unless a number is given. In pure bending every gap turns by the same
/// angle, so the unit cell does not need an integer: the angle between its scales is `2 Φ/n`.
/// Chains and imperfect strips have [`whole_gaps`].
pub fn gaps(row: &Row, parameters: &FlexureParameters) -> f64 {
    let by_length = parameters.membrane_length / row.pitch();
    parameters.gaps.map_or(by_length, |gaps| gaps as f64).max(1.0)
}

/// Returns the number of gaps of a chain: [`gaps`], rounded.
pub fn whole_gaps(row: &Row, parameters: &FlexureParameters) -> usize {
    // The cast saturates, which does not matter for strips that fit in memory.
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
/// It has as many gaps as the chain of the design, and curvature is measured over its actual
/// length. With [`Method::UnitCell`] each gap is solved separately; where that fails, because
/// moments decrease along the path or unloading is requested, the assembled chain is solved
/// instead.
///
/// # Errors
/// As [`solve`], or if no sample without overlapping scales is found.
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

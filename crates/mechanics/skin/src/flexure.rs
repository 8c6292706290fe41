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
pub use sensitivity::{FlexureInput, differentiate, moment_curve};
pub use snapshot::{StripSnapshot, snapshots};

/// The part of a strip that is solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// One gap: in pure bending every gap deforms alike. Of gaps that differ each by itself, under the moment that all share.
    UnitCell,
    /// Every gap of the strip, assembled.
    Chain,
}

/// Parameters of bending besides the design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexureParameters {
    /// `E_ct / E_m`.
    pub contact_modulus_over_membrane: f64,
    /// One gap or all.
    pub method: Method,
    /// Length `L_whole/t` of the strip, unless its gaps are given.
    pub membrane_length: f64,
    /// Number of gaps of the strip; `None` for as many as its length holds.
    pub gaps: Option<usize>,
    /// Thickness `h/t` of the membrane.
    pub membrane_thickness: f64,
    /// Depth of the membrane's axis below the bases of the scales, over `t`.
    pub membrane_axis_offset: f64,
    /// How the membrane of a gap is resolved.
    pub elements_per_gap: MembraneMesh,
    /// Rotation of each end at which bending ends, degrees. Below zero the strip bends the other way, the scales on the
    /// outside.
    pub max_end_rotation_deg: f64,
    /// Whether the moment is taken away again at the end.
    pub unload: bool,
}

impl Default for FlexureParameters {
    /// The values of Shafiei et al. (2021): scales of `E_ct = 3 GPa`, 8 mm thick, on a membrane of
    /// `E_m = 4.5 MPa`, 1 mm thick.
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

/// A strip that was bent.
#[derive(Clone, Debug)]
pub struct Flexure {
    /// How the path ended, and whether its end can be trusted.
    pub status: Status,
    /// The measures of the bending.
    pub measures: FlexureMeasures,
    /// Every equilibrium of the path, from rest.
    pub path: Vec<FlexurePoint>,
    /// Every contact event, in order.
    pub events: Vec<ContactEvent<FlexurePoint>>,
    /// Every Newton iteration.
    pub history: Vec<Iteration>,
    /// The way back, where it is asked for and the path came to its end.
    pub unloading: Option<Unloading<FlexurePoint>>,
    /// Gaps of the strip, rounded to a whole number.
    pub gaps: usize,
    /// The gaps that were solved for, at every point of the path.
    steps: Vec<Vec<Step>>,
    row: Arrangement,
}

impl Flexure {
    /// Whether scales rub on each other.
    pub fn has_friction(&self) -> bool {
        self.path.iter().any(|point| point.friction_work.is_some())
    }

    /// Range of `κ*` over which the gaps close: from the first contact in any of them to the first contact
    /// in the last of those that close. 0 in a perfect strip, `None` without contact.
    pub fn closing_range(&self) -> Option<f64> {
        let mut closed = HashSet::new();
        let closings = self.events.iter().filter(|event| event.change == ContactChange::Closed);
        // A gap may close at both levels, and again after it has opened: its first closing counts.
        let first = closings.filter(|event| closed.insert(event.left_scale));
        let mut curvatures = first.map(|event| event.point.curvature);
        let start = curvatures.next()?;
        Some(curvatures.last().unwrap_or(start) - start)
    }

    /// Displacement (over `t`) and rotation (radians, counter-clockwise) of every scale of the
    /// strip at a point of the path, the first scale at rest. `None` if there is no such point.
    pub fn shape(&self, point: usize) -> Option<Vec<[f64; 3]>> {
        let frames = frames(self.steps.get(point)?, self.gaps, &self.row);
        Some(displacements(&frames, &self.row))
    }
}

/// Returns the number of gaps `n = L_whole/p` of a strip, or the number that is given; at least 1.
///
/// In pure bending every gap turns by the same angle, so the unit cell needs no whole number: the angle between its scales is
/// `2 Φ/n`. A chain, and a strip of imperfect gaps, has [`whole_gaps`].
pub fn gaps(row: &Row, parameters: &FlexureParameters) -> f64 {
    let by_length = parameters.membrane_length / row.pitch();
    parameters.gaps.map_or(by_length, |gaps| gaps as f64).max(1.0)
}

/// Returns the number of gaps of a chain: [`gaps`], rounded.
pub fn whole_gaps(row: &Row, parameters: &FlexureParameters) -> usize {
    // Saturates; a strip with more gaps than a machine word counts does not exist.
    gaps(row, parameters).round() as usize
}

/// Bends the strip of a `design` from rest until its ends have turned by the largest rotation.
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

/// Bends an imperfect strip as [`solve`] does: gaps and slants are those of `sample`. There are as many gaps as in the chain of the
/// design, and the curvature counts over the length that they have. By [`Method::UnitCell`] each gap is solved by itself; where that does
/// not do, because moments fall or are taken away again, the chain of all is.
///
/// # Errors
/// As [`solve`], or if the scales cannot be made to stand clear of each other.
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

/// The chain of all gaps of an imperfect strip, bent as [`bend_sample`] does, with its path.
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

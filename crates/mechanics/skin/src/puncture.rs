//! Puncture of a row of scales on an elastic substrate.

mod adaptive_row;
mod beam;
mod bending;
mod ending;
mod exterior_motion;
mod failure;
mod load_positions;
mod measures;
mod needle;
mod neo_hookean;
mod number_list;
mod observers;
mod parameters;
mod path_end;
mod point;
mod problem;
mod row_exterior;
mod row_layout;
mod rows;
mod sensitivity;
mod single_scale;
mod snap;
mod snapshot;
mod stability;
mod surface_fold;
mod system;
#[cfg(test)]
mod tests;
mod tilt_measures;

use contact::{Pose, overlaps};
use geometry::{Body, OutOfRange};
use problem::{Followed, Problem};
use rows::Rows;
use substrate::RowStiffness;

use crate::record::{ContactEvent, Iteration};
use crate::{Common, Design, Sample, Status, Unloading};

pub use failure::{FailureMeasures, FailureMode};
pub use load_positions::{LoadPosition, Weakest, load_positions};
pub use measures::{AcrossMeasures, BetweenMeasures, PunctureMeasures};
pub use needle::{CriticalEvent, Passage, TipForces};
pub use number_list::{MOST_NUMBERS, NumberList};
pub use parameters::{Bending, Needle, PunctureParameters, RowLength, Strengths};
pub use path_end::{PunctureEnd, differentiate_near, solve_near};
pub use point::{PuncturePoint, ScaleState};
pub use sensitivity::{PunctureInput, differentiate, force_curve, unloading_curve};
pub use single_scale::PerturbedScale;
pub use snap::Snap;
pub use snapshot::{At, RowSnapshot, Snapshots, snapshots, snapshots_to_end};
pub use stability::Instability;
pub use surface_fold::{Fold, GapStretch};
pub use tilt_measures::TiltMeasures;

/// Name of the quantity in the error for a round tip that reaches over too many scales.
pub const TIP_REACH: &str = "radius of the needle divided by the pitch of the row";

/// Name of the quantity in the error for displacements that do not decay along a row.
pub const DIRECT_STIFFNESS: &str = "direct stiffness of the substrate";

/// Largest number of scales of a row with [`RowLength::Auto`].
pub const LONGEST_ROW: usize = 4001;

/// Result of a puncture.
#[derive(Clone, Debug)]
pub struct Puncture {
    /// Outcome of the path, including the audit of its end.
    pub status: Status,
    /// The measures of the puncture.
    pub measures: PunctureMeasures,
    /// Measures at each of the [`PunctureParameters::tilts_deg()`].
    ///
    /// `None` if the path did not reach the tilt.
    pub at_tilts: Vec<Option<TiltMeasures>>,
    /// Every equilibrium of the path, from rest to its end.
    pub path: Vec<PuncturePoint>,
    /// Instability at every point of the path.
    ///
    /// At a contact event it is evaluated with the contacts after the event.
    pub instability: Vec<Instability>,
    /// Forces of a round tip at every point of the path; empty for other needles.
    pub tip_forces: Vec<TipForces>,
    /// Every contact event, in the order of the path.
    pub events: Vec<ContactEvent<PuncturePoint>>,
    /// Every snap-through under prescribed, increasing depth, in the order of the path.
    pub snaps: Vec<Snap>,
    /// Every folding or unfolding of the surface in a gap, in the order of the path.
    pub folds: Vec<Fold>,
    /// State of every scale at the end of the path.
    pub scales: Vec<ScaleState>,
    /// Every Newton iteration, in the order of the path.
    pub history: Vec<Iteration>,
    /// The unloading path, if requested and if the loading path was completed.
    pub unloading: Option<Unloading<PuncturePoint>>,
    /// Results at each of the [`PunctureParameters::places`] load positions.
    pub places: Vec<LoadPosition>,
    /// The end of the path, if the ends of similar designs can be solved from it.
    pub end: Option<PunctureEnd>,
}

impl Puncture {
    /// Returns true if friction acts between the scales.
    pub fn has_friction(&self) -> bool {
        self.path.iter().any(|point| point.friction_work.is_some())
    }
}

/// Solves the puncture of the middle scale of a row from rest to the critical tilt.
///
/// The `substrate` is given by its [`Springs`](substrate::Springs), or by the stiffness of a row
/// with full coupling.
///
/// # Errors
/// If a length, a modulus or a constant of the contact law is not positive, or another parameter
/// is out of its range.
pub fn solve(
    design: &Design,
    substrate: impl Into<RowStiffness>,
    common: &Common,
    parameters: &PunctureParameters,
) -> Result<Puncture, OutOfRange> {
    Problem::new(Rows::Even(design.row()?), design, substrate.into(), common, parameters)?.solve()
}

/// Solves the puncture of an imperfect row with the gaps and slants of `sample`.
///
/// The substrate has the stiffness of the design without scatter.
///
/// # Errors
/// As [`solve`], or if a scale of the sample overlaps its neighbour in every draw.
pub fn solve_sample(
    design: &Design,
    substrate: impl Into<RowStiffness>,
    common: &Common,
    parameters: &PunctureParameters,
    sample: &Sample,
) -> Result<Puncture, OutOfRange> {
    Problem::new(Rows::Sample(sample), design, substrate.into(), common, parameters)?.solve()
}

/// Returns true if neighbouring scales overlap at rest on a concave body.
///
/// # Errors
/// If a length of the design is not positive, or its slant is out of range.
pub fn overlaps_at_rest(design: &Design, body: Body) -> Result<bool, OutOfRange> {
    if body.curvature >= 0.0 {
        return Ok(false);
    }
    let row = design.leaning_row()?;
    let frames = [0.0, row.pitch()].map(|arc| body.frame(arc));
    let poses = frames.map(|frame| Pose::new(0.0, 0.0, -frame.angle));
    Ok(!overlaps(|i| (*row.scale(), frames[i].origin), &poses).is_empty())
}

/// Computes the curvature `t/R` of the concave body on which neighbours just touch at rest.
///
/// The curvature is negative. Bisection determines it to `1e-9`. `None` if neighbours do not
/// overlap even on a concave body of radius `t`.
///
/// # Errors
/// If a length of the design is not positive, or its slant is out of range.
pub fn touching_curvature(design: &Design) -> Result<Option<f64>, OutOfRange> {
    let (mut apart, mut touching) = (0.0, -1.0);
    if !overlaps_at_rest(design, Body { curvature: touching })? {
        return Ok(None);
    }
    while apart - touching > 1e-9 {
        let middle = 0.5 * (apart + touching);
        if overlaps_at_rest(design, Body { curvature: middle })? {
            touching = middle;
        } else {
            apart = middle;
        }
    }
    Ok(Some(touching))
}

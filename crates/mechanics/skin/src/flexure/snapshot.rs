//! Snapshots of a bent strip at given end rotations.

use contact::Pose;
use geometry::OutOfRange;

use super::FlexureParameters;
use super::frame::{displacements, frames, place};
use super::problem::FlexureProblem;
use super::strip::Strip;
use crate::arrangement::Arrangement;
use crate::contacts::{Contact, SkinState};
use crate::record::Skin;
use crate::{Common, Design};

/// Number of intervals at which the membrane axis is sampled, for each element or spectral element.
const INTERVALS: usize = 12;

/// Geometry and contacts of a strip in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct StripSnapshot {
    /// Curvature `κ*`.
    pub curvature: f64,
    /// Moment `M*`.
    pub moment: f64,
    /// Rotation of each end, degrees.
    pub end_rotation_deg: f64,
    /// Displacements `x`, `y` (in units of `t`) and rotation of every scale.
    ///
    /// Rotations are counter-clockwise, in radians. The first scale is fixed.
    pub scales: Vec<[f64; 3]>,
    /// Points of the deformed membrane axis in every gap, in units of `t`.
    ///
    /// They are relative to the node of the first scale.
    pub membrane: Vec<Vec<[f64; 2]>>,
    /// Every closed contact; forces in units of `E_m t²`.
    pub contacts: Vec<Contact>,
}

/// Solves the bending of `design`, and returns a snapshot at each of the given end rotations.
///
/// Each snapshot is an equilibrium, not an interpolation; `None` if the path does not reach this
/// rotation.
///
/// # Errors
/// If a length, a modulus, or a constant of the contact law is not positive.
pub fn snapshots(
    design: &Design,
    common: &Common,
    parameters: &FlexureParameters,
    end_rotations_deg: &[f64],
) -> Result<Vec<Option<StripSnapshot>>, OutOfRange> {
    let problem = FlexureProblem::even(design, common, parameters)?;
    let rotations: Vec<f64> = end_rotations_deg.iter().map(|angle| angle.to_radians()).collect();
    // Refine as for the measures, so that drawings agree with the reported numbers.
    let (bent, _) = problem.resolved(&[], &rotations)?;
    let (row, strip) = (&problem.row, bent.path.system());
    Ok(bent
        .requested_points
        .into_iter()
        .map(|point| Some(snapshot(row, strip, &point?.state)))
        .collect())
}

/// Builds the snapshot of the whole strip from a state of the solved gaps.
fn snapshot(row: &Arrangement, strip: &Strip, state: &SkinState) -> StripSnapshot {
    let (solved, gaps) = (strip.gaps(), strip.whole_gaps());
    let frames = frames(&strip.steps(&state.z), gaps, row);
    let axes: Vec<_> = (0..solved).map(|gap| strip.axis(state, gap, INTERVALS)).collect();
    let contacts = strip.contacts.closed_contacts(state);
    // Repeat the solved gap of a unit cell; a chain has a single copy.
    let copies = (0..gaps / solved).flat_map(|copy| {
        contacts.iter().map(move |contact| (copy * solved + contact.left, contact))
    });
    StripSnapshot {
        curvature: strip.curvature(&state.z),
        moment: strip.normalised_moment(&state.z),
        end_rotation_deg: strip.angle_deg(state),
        scales: displacements(&frames, row),
        membrane: frames[..gaps]
            .iter()
            .enumerate()
            .map(|(i, frame)| {
                axes[i % solved].iter().map(|&point| place(frame, point).into()).collect()
            })
            .collect(),
        contacts: copies.map(|(left, contact)| placed(&frames[left], left, contact)).collect(),
    }
}

/// Transforms a contact from the frame of its left scale to the frame of the strip.
fn placed(frame: &Pose, left: usize, contact: &Contact) -> Contact {
    Contact {
        left,
        right: left + 1,
        point: place(frame, contact.point.into()).into(),
        force: frame.turn(contact.force.into()).into(),
        ..*contact
    }
}

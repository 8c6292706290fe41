//! A row of scales as it stands at chosen places of its path.

use geometry::OutOfRange;
use solver::Stop;

use super::system::Chain;
use super::{
    Problem, Puncture, PunctureParameters, RowStiffness, Rows, ScaleState, Status, scales,
};
use crate::contacts::{Contact, SkinState};
use crate::path_location::PathLocation;
use crate::record::Skin;
use crate::{Common, Design};

/// Tilt beyond which a path is not followed for the sake of a snapshot, degrees.
const STEEPEST_DEG: f64 = 80.0;

/// Moves the end of a path to a larger tilt if it came to its end and was too `short` for the places that were looked for.
pub(super) fn farther(tilt_deg: &mut f64, status: Status, short: bool) -> bool {
    let may_go_on = status == Status::Complete && short && *tilt_deg < STEEPEST_DEG;
    if may_go_on {
        // Every try follows a whole path again, so the end moves in few large steps.
        *tilt_deg = (2.0 * *tilt_deg).min(STEEPEST_DEG);
    }
    may_go_on
}

/// A place of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    /// Where the punctured point has first moved down by `u*`.
    Displacement(f64),
    /// Where the load has first grown to this `F*`.
    Force(f64),
    /// Where the punctured scale has first tilted by this angle, clockwise, degrees.
    Tilt(f64),
}

impl At {
    /// The quantity that has a value at this place, and the value.
    pub(super) fn location(self) -> PathLocation<Chain> {
        let quantity: fn(&Chain, &SkinState) -> f64 = match self {
            Self::Displacement(_) => |chain, state| chain.depth(&state.z),
            Self::Force(_) => |chain, state| chain.force(state),
            Self::Tilt(_) => |chain, state| chain.angle_deg(state),
        };
        let (Self::Displacement(value) | Self::Force(value) | Self::Tilt(value)) = self;
        PathLocation { quantity, value }
    }
}

/// A row of scales in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct RowSnapshot {
    /// `u*` of the punctured point, downward.
    pub displacement: f64,
    /// `F*`.
    pub force: f64,
    /// Tilt of the punctured scale, clockwise, degrees.
    pub tilt_deg: f64,
    /// Lowest point of the tip of a guided needle, over `t`, from the node of the punctured scale at rest; `None` of a free one.
    pub tip: Option<[f64; 2]>,
    /// Every scale, from the left.
    pub scales: Vec<ScaleState>,
    /// Every closed contact; forces over `E* t²`.
    pub contacts: Vec<Contact>,
}

/// A puncture with snapshots.
#[derive(Clone, Debug)]
pub struct Snapshots {
    /// The puncture, followed as far as the snapshots need.
    pub puncture: Puncture,
    /// A snapshot for each place; `None` where the path does not get there.
    pub at: Vec<Option<RowSnapshot>>,
    /// The last state of the path.
    pub end: RowSnapshot,
    /// Whether the path comes to its end, the critical state, whatever the audit finds there.
    pub is_critical: bool,
}

/// Solves the puncture of `design` at the places `at`: each is an equilibrium of its own, not
/// interpolated. The path goes on beyond the critical tilt if a place lies there.
///
/// # Errors
/// If a length, a modulus or a constant of the contact law is not positive.
pub fn snapshots(
    design: &Design,
    substrate: impl Into<RowStiffness>,
    common: &Common,
    parameters: &PunctureParameters,
    at: &[At],
) -> Result<Snapshots, OutOfRange> {
    let stiffness = substrate.into();
    let mut parameters = *parameters;
    loop {
        let solved = snapshots_to_end(design, stiffness.clone(), common, &parameters, at)?;
        let is_short = solved.at.iter().any(Option::is_none);
        if !farther(&mut parameters.critical_tilt_deg, solved.puncture.status, is_short) {
            return Ok(solved);
        }
    }
}

/// Solves the puncture of `design` as [`snapshots`] does, but ends the path where [`solve`](super::solve) ends it: it does not get to a
/// place beyond.
///
/// # Errors
/// As [`snapshots`].
pub fn snapshots_to_end(
    design: &Design,
    substrate: impl Into<RowStiffness>,
    common: &Common,
    parameters: &PunctureParameters,
    at: &[At],
) -> Result<Snapshots, OutOfRange> {
    let row = design.row()?;
    let problem = Problem::new(Rows::Even(row), design, substrate.into(), common, parameters)?;
    let mut followed = problem.follow(&[], at)?;
    let found = std::mem::take(&mut followed.watch.requested.points);
    let chain = followed.path.system();
    let snapshot = |state: &SkinState| snapshot(chain, row.pitch(), state);
    let at = found.iter().map(|point| Some(snapshot(&point.as_ref()?.state))).collect();
    let end = snapshot(&followed.path.point().state);
    let is_critical =
        followed.path.stop() == Some(Stop::Reached) && followed.status != Status::Untilted;
    Ok(Snapshots { puncture: followed.puncture(false), at, end, is_critical })
}

fn snapshot(chain: &Chain, pitch: f64, state: &SkinState) -> RowSnapshot {
    // Contacts count from the first scale that is solved for, a snapshot from the first of the row.
    let [before, _] = chain.exterior.scales_to_ends();
    let in_row = |contact: Contact| {
        let [x, y] = contact.point;
        let point = [x + before as f64 * pitch, y];
        Contact { left: contact.left + before, right: contact.right + before, point, ..contact }
    };
    RowSnapshot {
        displacement: chain.depth(&state.z),
        force: chain.force(state),
        tilt_deg: chain.angle_deg(state),
        tip: chain.needle.as_ref().map(|needle| needle.lowest(&state.z).into()),
        scales: scales(chain, state),
        contacts: chain.contacts.closed_contacts(state).into_iter().map(in_row).collect(),
    }
}

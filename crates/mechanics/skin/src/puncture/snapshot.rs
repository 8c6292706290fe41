//! Snapshots of a row at chosen points of its path.

use geometry::OutOfRange;
use solver::Termination;

use super::point::scales;
use super::system::Chain;
use super::{
    FailureMode, Problem, Puncture, PunctureEnd, PunctureParameters, RowStiffness, Rows,
    ScaleState, Status,
};
use crate::contacts::{Contact, SkinState};
use crate::path_location::PathLocation;
use crate::record::Skin;
use crate::{Common, Design};

/// Largest tilt to which a path is extended for a snapshot, degrees.
const STEEPEST_DEG: f64 = 80.0;

/// Raises the critical tilt if the path does not reach all requested points (`is_short`).
///
/// Returns true if the tilt was raised and the path has to be followed again.
pub(super) fn raise_tilt(tilt_deg: &mut f64, status: Status, is_short: bool) -> bool {
    let is_raised = status == Status::Complete && is_short && *tilt_deg < STEEPEST_DEG;
    if is_raised {
        // Each attempt follows the whole path again, so raise the tilt in few large steps.
        *tilt_deg = (2.0 * *tilt_deg).min(STEEPEST_DEG);
    }
    is_raised
}

/// First point of a path at which a quantity reaches a given value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    /// The loaded point has moved down by this `u*`.
    Displacement(f64),
    /// The load has reached this `F*`.
    Force(f64),
    /// The punctured scale has tilted by this angle in either direction, degrees.
    Tilt(f64),
    /// A scale reaches its limit of breaking, bending, debonding or perforation.
    ///
    /// The path is not extended beyond the critical tilt to reach this limit. Other failure modes
    /// have no such point.
    Limit(FailureMode),
}

impl At {
    /// Returns the quantity and its value at this point.
    pub(super) fn location(self) -> PathLocation<Chain> {
        let quantity: fn(&Chain, &SkinState) -> f64 = match self {
            Self::Displacement(_) => |chain, state| chain.depth(&state.z),
            Self::Force(_) => |chain, state| chain.force(state),
            Self::Tilt(_) => |chain, state| chain.angle_deg(state).abs(),
            Self::Limit(FailureMode::Break) => {
                |chain, state| chain.utilisation(state, FailureMode::Break)
            }
            Self::Limit(FailureMode::Bend) => {
                |chain, state| chain.utilisation(state, FailureMode::Bend)
            }
            Self::Limit(FailureMode::Debond) => {
                |chain, state| chain.utilisation(state, FailureMode::Debond)
            }
            Self::Limit(FailureMode::Perforate) => {
                |chain, state| chain.utilisation(state, FailureMode::Perforate)
            }
            Self::Limit(_) => |_, _| 0.0,
        };
        let value = match self {
            Self::Displacement(value) | Self::Force(value) => value,
            Self::Tilt(tilt) => tilt.abs(),
            Self::Limit(_) => 1.0,
        };
        PathLocation { quantity, value }
    }
}

/// A row of scales in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct RowSnapshot {
    /// Displacement `u*` of the loaded point, positive downward.
    pub displacement: f64,
    /// Load `F*`.
    pub force: f64,
    /// Tilt of the punctured scale, positive clockwise, degrees.
    pub tilt_deg: f64,
    /// Lowest point of the tip of a guided needle, in units of `t`; `None` for a free needle.
    ///
    /// It is relative to the node of the punctured scale at rest.
    pub tip: Option<[f64; 2]>,
    /// Every scale, from the left.
    pub scales: Vec<ScaleState>,
    /// Every closed contact, with forces in units of `E* t²`.
    pub contacts: Vec<Contact>,
}

/// Result of a puncture with snapshots.
#[derive(Clone, Debug)]
pub struct Snapshots {
    /// The puncture; its path reaches as far as the snapshots require.
    pub puncture: Puncture,
    /// One snapshot for each requested point; `None` if the path does not reach the point.
    pub at: Vec<Option<RowSnapshot>>,
    /// Snapshot at the end of the path.
    pub end: RowSnapshot,
    /// True if the path reaches the critical tilt or event, even if the audit rejects its end.
    pub is_critical: bool,
}

/// Solves the puncture of `design` with snapshots at the points `at`.
///
/// Each snapshot is an equilibrium, not an interpolation. If necessary, the path is extended beyond
/// the critical tilt, up to 80°.
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
    // Only the loading path has snapshots.
    let mut parameters = PunctureParameters { unload: false, ..*parameters };
    loop {
        let solved = snapshots_to_end(design, stiffness.clone(), common, &parameters, at)?;
        let mut found = at.iter().zip(&solved.at);
        let is_short = found.any(|(at, found)| found.is_none() && !matches!(at, At::Limit(_)));
        if !raise_tilt(&mut parameters.critical_tilt_deg, solved.puncture.status, is_short) {
            return Ok(solved);
        }
    }
}

/// Solves the puncture with snapshots, up to the same end as [`solve`](super::solve).
///
/// Snapshots beyond this end are `None`. If `parameters` request unloading, the puncture includes
/// its unloading path.
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
    let at = found
        .iter()
        .map(|point| Some(snapshot(chain, row.pitch(), &point.as_ref()?.state)))
        .collect();
    let end = snapshot(chain, row.pitch(), &followed.path.point().state);
    let is_critical = followed.path.termination() == Some(Termination::Reached)
        && followed.status != Status::Untilted;
    let path_end = PunctureEnd::new(&problem, &followed);
    let puncture = Puncture { end: path_end, ..followed.puncture(parameters.unload) };
    Ok(Snapshots { puncture, at, end, is_critical })
}

/// Creates the snapshot of a state.
fn snapshot(chain: &Chain, pitch: f64, state: &SkinState) -> RowSnapshot {
    // Contacts refer to the first solved scale, but snapshots to the first scale of the row, with
    // `before` scales in between.
    let [before, _] = chain.exterior.scales_to_ends();
    let frame = chain.contacts.body.frame(before as f64 * pitch);
    RowSnapshot {
        displacement: chain.depth(&state.z),
        force: chain.force(state),
        tilt_deg: chain.angle_deg(state),
        tip: chain.needle.as_ref().map(|needle| needle.lowest(&state.z).into()),
        scales: scales(chain, state),
        contacts: chain
            .contacts
            .closed_contacts(state)
            .into_iter()
            .map(|contact| {
                let point = frame.outward(contact.point.into()) + frame.origin;
                Contact {
                    left: contact.left + before,
                    right: contact.right + before,
                    point: point.into(),
                    force: frame.outward(contact.force.into()).into(),
                    ..contact
                }
            })
            .collect(),
    }
}

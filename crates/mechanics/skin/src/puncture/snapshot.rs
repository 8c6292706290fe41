//! Snapshots of a row at chosen points of its path.

use geometry::OutOfRange;
use solver::Termination;

use super::point::scales;
use super::system::Chain;
use super::{
    FailureMode, Problem, Puncture, PunctureParameters, RowStiffness, Rows, ScaleState, Status,
};
use crate::contacts::{Contact, SkinState};
use crate::path_location::PathLocation;
use crate::record::Skin;
use crate::{Common, Design};

/// Largest tilt to which a path is extended for a snapshot, degrees.
const STEEPEST_DEG: f64 = 80.0;

/// Raises the critical tilt if a path was too `short` for the requested points.
///
/// Returns true if the path should be followed again.
pub(super) fn farther(tilt_deg: &mut f64, status: Status, short: bool) -> bool {
    let may_go_on = status == Status::Complete && short && *tilt_deg < STEEPEST_DEG;
    if may_go_on {
        // Each try follows the whole path again, so take few large steps.
        *tilt_deg = (2.0 * *tilt_deg).min(STEEPEST_DEG);
    }
    may_go_on
}

/// Point of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    /// Where the loaded point has first moved down by `u*`.
    Displacement(f64),
    /// Where the load has first reached this `F*`.
    Force(f64),
    /// Where the punctured scale has first tilted by this angle in either direction, degrees.
    Tilt(f64),
    /// Where a limit of a scale is first reached: breaking, bending, debonding or perforation.
    ///
    /// The path is not extended for it. Other modes of failure are no limits of a scale.
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
                |chain, state| chain.fraction(state, FailureMode::Break)
            }
            Self::Limit(FailureMode::Bend) => {
                |chain, state| chain.fraction(state, FailureMode::Bend)
            }
            Self::Limit(FailureMode::Debond) => {
                |chain, state| chain.fraction(state, FailureMode::Debond)
            }
            Self::Limit(FailureMode::Perforate) => {
                |chain, state| chain.fraction(state, FailureMode::Perforate)
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
    /// `u*` of the loaded point, downward.
    pub displacement: f64,
    /// `F*`.
    pub force: f64,
    /// Tilt of the punctured scale, clockwise, degrees.
    pub tilt_deg: f64,
    /// Lowest point of the tip of a guided needle, over `t`; `None` for a free needle.
    ///
    /// It is relative to the node of the punctured scale at rest.
    pub tip: Option<[f64; 2]>,
    /// Every scale, from the left.
    pub scales: Vec<ScaleState>,
    /// Every closed contact; forces over `E* t²`.
    pub contacts: Vec<Contact>,
}

/// Result of a puncture with snapshots.
#[derive(Clone, Debug)]
pub struct Snapshots {
    /// The puncture, followed as far as the snapshots require.
    pub puncture: Puncture,
    /// One snapshot per requested point; `None` if the path does not reach it.
    pub at: Vec<Option<RowSnapshot>>,
    /// The last state of the path.
    pub end: RowSnapshot,
    /// True if the path reaches the critical state, regardless of the audit.
    pub is_critical: bool,
}

/// Solves the puncture of `design` with snapshots at the points `at`.
///
/// Each snapshot is an equilibrium, not an interpolation. The path is extended beyond the critical
/// tilt if necessary.
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
        if !farther(&mut parameters.critical_tilt_deg, solved.puncture.status, is_short) {
            return Ok(solved);
        }
    }
}

/// Solves the puncture with snapshots, ending where [`solve`](super::solve) does.
///
/// Points beyond that end are `None`. With `unload` the puncture has its unloading path, too.
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
    Ok(Snapshots { puncture: followed.puncture(parameters.unload), at, end, is_critical })
}

fn snapshot(chain: &Chain, pitch: f64, state: &SkinState) -> RowSnapshot {
    // Contacts count from the first solved scale, snapshots from the first scale of the row.
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

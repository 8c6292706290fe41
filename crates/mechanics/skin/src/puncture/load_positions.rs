//! Punctures at several load positions, and the position with the smallest force.
//!
//! The positions span the top from its left to its right corner; for a round tip also the region
//! between two scales.

use geometry::OutOfRange;
use serde::{Deserialize, Serialize};
use solver::Neighbours;
use substrate::RowStiffness;

use super::needle::CriticalEvent;
use super::path_end::PlaceEnd;
use super::sensitivity::{CRITICAL_FORCE, PunctureInput};
use super::{Followed, Problem, Puncture, PunctureEnd, PunctureParameters, Rows};
use crate::record::Skin;
use crate::sensitivity::Derivative;
use crate::{Common, Design, PathDetail, Status};

/// Relative difference below which two forces count as equal.
///
/// For example, the forces at both corners of an upright scale are equal. Computed forces have a
/// relative error of about 1e-9.
const TIE: f64 = 1e-7;

/// Relative difference below which derivatives count as equal.
const SAME: f64 = 1e-6;

/// Result of a puncture at one of several load positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadPosition {
    /// Position on the top: 0 is the left corner, 1 the right corner.
    ///
    /// For a round tip it may exceed 1.
    pub position: f64,
    /// Status of the path at this load position.
    pub status: Status,
    /// `F*` at the critical tilt in either direction, or when the needle is through.
    pub force: Option<f64>,
    /// Displacement `u*` at this force.
    pub displacement: Option<f64>,
    /// Tilt of the punctured scale at this force, positive clockwise, degrees.
    pub tilt_deg: Option<f64>,
    /// Critical event of a guided needle; `None` for a free needle.
    pub critical_event: Option<CriticalEvent>,
    /// Largest `F*` of the path.
    ///
    /// `None` if the load does not tilt the scale at all, as in the middle of an upright scale.
    pub largest_force: Option<f64>,
}

/// Smallest force of several load positions.
///
/// Empty if there are no positions, or if the force at a position is unknown and may be smaller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Weakest {
    /// `F*` at the weakest position.
    pub force: Option<f64>,
    /// Load position with the smallest force; of several equal forces, the leftmost position.
    #[serde(rename = "place")]
    pub position: Option<f64>,
}

impl Weakest {
    /// Selects the weakest of the load positions `places`.
    ///
    /// # Errors
    /// If the path at a position ended before its load reached the smallest force of all others,
    /// because this position may be weaker. The error is the status of the first such position.
    pub fn from_positions(places: &[LoadPosition]) -> Result<Self, Status> {
        let Some(force) = places.iter().filter_map(|place| place.force).reduce(f64::min) else {
            return places.first().map_or(Ok(Self::default()), |place| Err(place.status));
        };
        match places.iter().find(|place| {
            place.force.is_none()
                && place.largest_force.is_some_and(|largest_force| largest_force < force)
        }) {
            Some(unknown) => Err(unknown.status),
            None => Ok(Self {
                force: Some(force),
                position: places.iter().find(|place| is_tied(place, force)).map(|p| p.position),
            }),
        }
    }
}

/// Returns true if the force at a position equals the smallest `force`.
fn is_tied(place: &LoadPosition, force: f64) -> bool {
    place.force.is_some_and(|of| of <= force * (1.0 + TIE))
}

impl PunctureParameters {
    /// Returns `count` equally spaced load positions: 0 is the left corner of the top, 1 the right.
    pub fn positions(&self, count: usize, design: &Design) -> Vec<f64> {
        // The positions of a round tip span one pitch. The end of this pitch is equivalent to its
        // start on the next scale, so omit the end.
        let pitch = 1.0 + design.gap / (2.0 * design.half_base());
        // The top is as wide as the base.
        let (last, width) = match self.needle_radius {
            Some(_) => (count as f64, pitch),
            None => (count.saturating_sub(1) as f64, 1.0),
        };
        (0..count).map(|k| k as f64 * width / last).collect()
    }

    /// Returns the parameters for another load position.
    fn at_position(&self, position: f64) -> Self {
        Self {
            load_position: position,
            // Only forces at the end are compared, so remove all other requests.
            tilts_before_deg: None,
            places: None,
            depth: None,
            force: None,
            unload: false,
            failure: None,
            ..*self
        }
    }
}

/// Solves the puncture at each load position that `parameters` request.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn load_positions(
    design: &Design,
    substrate: impl Into<RowStiffness>,
    common: &Common,
    parameters: &PunctureParameters,
) -> Result<Vec<LoadPosition>, OutOfRange> {
    let rows = Rows::Even(design.row()?);
    let problem = Problem::new(rows, design, substrate.into(), common, parameters)?;
    Ok(problem.load_positions(None, None)?.places)
}

/// Punctures at several load positions, and the ends of their paths.
pub(super) struct LoadPositions {
    pub(super) places: Vec<LoadPosition>,
    /// Path ends as starts for similar designs.
    ///
    /// Empty if the punctures themselves started from a similar design, and unless only critical
    /// measures are computed.
    pub(super) ends: Vec<PlaceEnd>,
}

/// A followed path, and its end if it may be a start for similar designs.
pub(super) type OwnPath<'a> = (&'a Followed, Option<&'a PunctureEnd>);

impl LoadPosition {
    fn new(position: f64, followed: &Followed) -> Self {
        let (points, path, status) = (&followed.watch.record.path, &followed.path, followed.status);
        let end = path.system().path_point(path.point());
        let end = (status == Status::Complete).then_some(end);
        let tilts_nothing = status == Status::Untilted && points.len() == 1;
        Self {
            position,
            status,
            force: end.map(|point| point.force),
            displacement: end.map(|point| point.displacement),
            tilt_deg: end.map(|point| point.tilt_deg),
            critical_event: followed.passage.critical_event,
            largest_force: points
                .iter()
                .map(|point| point.force)
                .reduce(f64::max)
                .filter(|_| !tilts_nothing),
        }
    }
}

impl Problem<'_> {
    /// Solves the puncture at each requested load position.
    ///
    /// `own` is the path of the puncture itself, which is used at its own load position. If `near`,
    /// the end of a similar design, is given, each position starts from the end of the similar
    /// design at the same position. Positions at which the similar design is much stronger than at
    /// its weakest position are then omitted.
    pub(super) fn load_positions(
        &self,
        own: Option<OwnPath>,
        near: Option<&PunctureEnd>,
    ) -> Result<LoadPositions, OutOfRange> {
        let positions = self.parameters.positions(self.parameters.places.unwrap_or(0), self.design);
        let keeps_ends = near.is_none() && self.common.detail == PathDetail::Critical;
        // All positions together may use the work of one path.
        let mut remaining_work = self.common.solver.max_work;
        let (mut places, mut ends) = (Vec::new(), Vec::new());
        for position in positions {
            if near.is_some_and(|near| !near.may_be_weakest(position)) {
                continue;
            }
            let own = own.filter(|_| self.serves_position(position));
            let (place, end) = if let Some((followed, end)) = own {
                (LoadPosition::new(position, followed), end.cloned())
            } else {
                let parameters = self.parameters.at_position(position);
                let mut problem = self.with(&parameters);
                problem.common.solver.max_work = remaining_work;
                let start = near.and_then(|near| near.at_place(position));
                let followed = problem.follow_from(start)?;
                remaining_work = remaining_work.saturating_sub(followed.path.work());
                let end = keeps_ends.then(|| PunctureEnd::new(&problem, &followed)).flatten();
                (LoadPosition::new(position, &followed), end)
            };
            if keeps_ends {
                ends.push(PlaceEnd { position, force: place.force, end });
            }
            places.push(place);
        }
        Ok(LoadPositions { places, ends })
    }

    /// Returns true if the path of the puncture itself can be used at a load position.
    fn serves_position(&self, position: f64) -> bool {
        // A path that was followed for failure modes is not used. Other requests only locate points
        // of the path.
        position == self.parameters.load_position && self.parameters.failure.is_none()
    }

    /// Finds the end of the path from `start`; if this fails, follows the path from rest.
    fn follow_from(&self, start: Option<&PunctureEnd>) -> Result<Followed, OutOfRange> {
        match start.map(|start| self.end_near(start)).transpose()?.flatten() {
            Some(found) => Ok(found),
            None => self.follow(&[], &[]),
        }
    }

    /// Returns this problem with other parameters, for the measures of the critical state.
    fn with<'p>(&'p self, parameters: &'p PunctureParameters) -> Problem<'p> {
        let (stiffness, endless) = (self.stiffness.clone(), self.endless.clone());
        let detail = self.common.detail.min(PathDetail::Critical);
        let common = Common { detail, ..self.common };
        Problem { stiffness, endless, common, parameters, ..*self }
    }

    /// Differentiates the smallest force over the load positions of a `puncture`.
    ///
    /// `own` are the derivatives of the puncture itself. Punctures at other positions start from
    /// `ends`, which may belong to a similar design. If several positions are equally weak, a
    /// change of the parameter makes one of them the weakest, so the one-sided derivatives may
    /// differ.
    pub(super) fn at_weakest(
        &self,
        puncture: &Puncture,
        ends: Option<&PunctureEnd>,
        variations: &[Neighbours<PunctureInput>],
        own: &[Derivative],
    ) -> Result<Vec<Derivative>, OutOfRange> {
        let places = &puncture.places;
        let Ok(Weakest { force: Some(force), .. }) = Weakest::from_positions(places) else {
            return Ok(Vec::new());
        };
        let mut weakest = Vec::new();
        for place in places.iter().filter(|place| is_tied(place, force)) {
            let here = if self.serves_position(place.position) {
                own.to_vec()
            } else {
                let end = ends.and_then(|ends| ends.at_place(place.position));
                self.slopes_at(place.position, end, variations)?
            };
            let here = here.into_iter().filter(|of| of.measure == CRITICAL_FORCE);
            let here: Vec<_> =
                here.map(|of| Derivative { measure: "weakest_force", ..of }).collect();
            weakest = if weakest.is_empty() {
                here
            } else {
                weakest.iter().zip(&here).map(|(one, other)| least(one, other)).collect()
            };
        }
        Ok(weakest)
    }

    /// Differentiates the measures of the puncture at a load position.
    fn slopes_at(
        &self,
        position: f64,
        end: Option<&PunctureEnd>,
        variations: &[Neighbours<PunctureInput>],
    ) -> Result<Vec<Derivative>, OutOfRange> {
        let parameters = self.parameters.at_position(position);
        let moved = |input: &PunctureInput| {
            let parameters = input.parameters.at_position(position);
            Ok::<_, OutOfRange>(PunctureInput { parameters, ..input.clone() })
        };
        let variations = Neighbours::map_all(variations, moved)?;
        let problem = self.with(&parameters);
        let mut followed = problem.follow_from(end)?;
        problem.derivatives(&mut followed, &variations)
    }
}

/// Returns the derivative of the minimum of two equal forces, given the derivatives of both.
fn least(one: &Derivative, other: &Derivative) -> Derivative {
    let both = |a: Option<f64>, b: Option<f64>, of: fn(f64, f64) -> f64| Some(of(a?, b?));
    // If the parameter decreases, the force with the larger slope becomes the smaller one.
    let left = both(one.left, other.left, f64::max);
    let right = both(one.right, other.right, f64::min);
    let is_smooth = left
        .zip(right)
        .is_some_and(|(left, right)| (left - right).abs() <= SAME * left.abs().max(right.abs()));
    let kink = (!is_smooth).then(|| "another load position is as weak".to_owned());
    Derivative { left, right: if is_smooth { left } else { right }, kink, ..one.clone() }
}

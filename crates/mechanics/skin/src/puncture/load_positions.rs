//! Where does a load get through? The same puncture with the load at other places of the top, from its left corner to its right; with a
//! round tip at those between two scales, too.

use geometry::OutOfRange;
use serde::{Deserialize, Serialize};
use solver::{Neighbours, Stop};
use substrate::RowStiffness;

use super::needle::CriticalEvent;
use super::sensitivity::{CRITICAL_FORCE, PunctureInput};
use super::{At, Problem, Puncture, PunctureParameters, Rows};
use crate::record::Skin;
use crate::sensitivity::Derivative;
use crate::{Common, Design, Status};

/// Forces that differ by less than this part are those of one skin pushed at two places that are alike, as the corners of an upright
/// scale: the tolerance of paths leaves some 1e-9.
const TIE: f64 = 1e-7;

/// Derivatives that differ by less than this part are the same.
const SAME: f64 = 1e-6;

/// A puncture with the load at one of several places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadPosition {
    /// Place of the load on the top: 0 its left, 1 its right corner; of a round tip also beyond.
    pub position: f64,
    /// How its path ended.
    pub status: Status,
    /// `F*` where the scale is critically tilted, either way, or a guided needle is through.
    pub force: Option<f64>,
    /// `u*` there.
    pub displacement: Option<f64>,
    /// Tilt of the punctured scale there, clockwise, degrees.
    pub tilt_deg: Option<f64>,
    /// Which of the two it was, under a guided needle.
    pub critical_event: Option<CriticalEvent>,
    /// Largest `F*` of its path; `None` where the load tilts nothing from the first step on, as in the middle of an upright scale.
    pub borne: Option<f64>,
}

/// The smallest force over several places of the load; nothing if there are none, or if one of them is in the way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Weakest {
    /// `F*` at the weakest place.
    pub force: Option<f64>,
    /// The weakest place, of several the first from the left.
    pub place: Option<f64>,
}

impl Weakest {
    /// The weakest of `places`.
    ///
    /// # Errors
    /// The status of the first place whose path ended early, before it had borne as much as the weakest of the others: there the skin
    /// may be weaker than anywhere else.
    pub fn from_positions(places: &[LoadPosition]) -> Result<Self, Status> {
        let Some(force) = places.iter().filter_map(|place| place.force).reduce(f64::min) else {
            return places.first().map_or(Ok(Self::default()), |place| Err(place.status));
        };
        let is_open = |place: &&LoadPosition| {
            place.force.is_none() && place.borne.is_some_and(|borne| borne < force)
        };
        match places.iter().find(is_open) {
            Some(open) => Err(open.status),
            None => Ok(Self {
                force: Some(force),
                place: tied(places, force).next().map(|p| p.position),
            }),
        }
    }
}

/// The places with that force.
fn tied(places: &[LoadPosition], force: f64) -> impl Iterator<Item = &LoadPosition> {
    places.iter().filter(move |place| place.force.is_some_and(|of| of <= force * (1.0 + TIE)))
}

/// The sense in which the scale tilts under a free load, which ends its path on one side only.
const CLOCKWISE: f64 = 1.0;
const COUNTER_CLOCKWISE: f64 = -1.0;

impl PunctureParameters {
    /// The same puncture with the load elsewhere.
    fn at_place(&self, position: f64, sense: f64) -> Self {
        Self {
            load_position: position,
            // A tilt below zero turns the control round, and with it the end of the path.
            critical_tilt_deg: sense * self.critical_tilt_deg,
            // Only the force at the end is compared, and a place has no places of its own.
            tilts_before_deg: None,
            places: None,
            depth: None,
            unload: false,
            ..*self
        }
    }
}

/// The puncture at each of the places that `parameters` ask for.
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
    Problem::new(rows, design, substrate.into(), common, parameters)?.load_positions()
}

impl Puncture {
    /// The puncture with what was found at other places of the load.
    pub(super) fn with_places(mut self, places: Vec<LoadPosition>) -> Self {
        self.measures.weakest = Weakest::from_positions(&places).unwrap_or_default();
        Self { places, ..self }
    }
}

impl Problem<'_> {
    /// The puncture at each of the places that are asked for.
    pub(super) fn load_positions(&self) -> Result<Vec<LoadPosition>, OutOfRange> {
        let count = self.parameters.places.unwrap_or(0);
        // A round tip may stand anywhere. A pitch further right it stands as before, on the next scale: that place is not tried again.
        let pitch = 1.0 + self.design.gap / (2.0 * self.design.half_base());
        // Positions count in tops, which are as wide as bases.
        let (last, width) = match self.parameters.needle_radius {
            Some(_) => (count as f64, pitch),
            None => (count.saturating_sub(1) as f64, 1.0),
        };
        (0..count).map(|k| self.at_place(k as f64 * width / last)).collect()
    }

    fn at_place(&self, position: f64) -> Result<LoadPosition, OutOfRange> {
        let clockwise = self.pushed(position, CLOCKWISE)?;
        // A load left of the middle may tilt the scale the other way from the first step on: clockwise it would have to pull.
        let pulls = clockwise.status == Status::Stopped(Stop::Unloaded);
        if pulls && clockwise.borne <= Some(0.0) {
            return self.pushed(position, COUNTER_CLOCKWISE);
        }
        Ok(clockwise)
    }

    fn pushed(&self, position: f64, sense: f64) -> Result<LoadPosition, OutOfRange> {
        let parameters = self.parameters.at_place(position, sense);
        // These parameters are not checked: nobody may ask for a tilt below zero.
        let problem = self.with(&parameters);
        // A path to one side may come to the critical tilt of the other first. Under a guided needle both end it anyway.
        let other_way = [At::Tilt(-parameters.critical_tilt_deg)];
        let markers = if parameters.needle.is_guided() { &[][..] } else { &other_way };
        let followed = problem.follow(&[], markers)?;
        let (points, path) = (&followed.watch.record.path, &followed.path);
        let tilted = followed.watch.requested.points.first().and_then(Option::as_ref);
        // The path went on behind that place, and its status tells of another state.
        let status = match tilted {
            Some(point) => Status::audited(path.system(), &point.state),
            None => followed.status,
        };
        let end = path.system().path_point(tilted.unwrap_or(path.point()));
        let end = (status == Status::Complete).then_some(end);
        let tilts_nothing = status == Status::Untilted && points.len() == 1;
        Ok(LoadPosition {
            position,
            status,
            force: end.map(|point| point.force),
            displacement: end.map(|point| point.displacement),
            tilt_deg: end.map(|point| point.tilt_deg),
            critical_event: followed.passage.critical_event,
            borne: points
                .iter()
                .map(|point| point.force)
                .reduce(f64::max)
                .filter(|_| !tilts_nothing),
        })
    }

    /// The same problem with other parameters of the load.
    fn with<'p>(&'p self, parameters: &'p PunctureParameters) -> Problem<'p> {
        let (stiffness, endless) = (self.stiffness.clone(), self.endless.clone());
        Problem { stiffness, endless, parameters, ..*self }
    }

    /// The derivatives of the smallest force over `places`: those of the force at the weakest. Where several are as weak, any change makes
    /// one of them the weakest, so that the sides differ.
    pub(super) fn at_weakest(
        &self,
        places: &[LoadPosition],
        variations: &[Neighbours<PunctureInput>],
    ) -> Result<Vec<Derivative>, OutOfRange> {
        let Ok(Weakest { force: Some(force), .. }) = Weakest::from_positions(places) else {
            return Ok(Vec::new());
        };
        let mut weakest = Vec::new();
        for place in tied(places, force) {
            let here = self.slopes_at(place, variations)?;
            weakest = if weakest.is_empty() {
                here
            } else {
                weakest.iter().zip(&here).map(|(one, other)| least(one, other)).collect()
            };
        }
        Ok(weakest)
    }

    fn slopes_at(
        &self,
        place: &LoadPosition,
        variations: &[Neighbours<PunctureInput>],
    ) -> Result<Vec<Derivative>, OutOfRange> {
        let is_other_way = !self.parameters.needle.is_guided() && place.tilt_deg < Some(0.0);
        let sense = if is_other_way { COUNTER_CLOCKWISE } else { CLOCKWISE };
        let parameters = self.parameters.at_place(place.position, sense);
        let moved = |input: &PunctureInput| {
            let parameters = input.parameters.at_place(place.position, sense);
            Ok::<_, OutOfRange>(PunctureInput { parameters, ..input.clone() })
        };
        let variations = Neighbours::map_all(variations, moved)?;
        let (_, derivatives) = self.with(&parameters).differentiated(&variations)?;
        let of_force = derivatives.into_iter().filter(|of| of.measure == CRITICAL_FORCE);
        Ok(of_force.map(|of| Derivative { measure: "weakest_force", ..of }).collect())
    }
}

/// The derivative of the smaller of two forces that are equal here.
fn least(one: &Derivative, other: &Derivative) -> Derivative {
    let both = |a: Option<f64>, b: Option<f64>, of: fn(f64, f64) -> f64| Some(of(a?, b?));
    // Where the parameter falls, the force with the larger slope becomes the smaller one.
    let left = both(one.left, other.left, f64::max);
    let right = both(one.right, other.right, f64::min);
    let is_smooth = left
        .zip(right)
        .is_some_and(|(left, right)| (left - right).abs() <= SAME * left.abs().max(right.abs()));
    let kink = (!is_smooth).then(|| "another place is as weak".to_owned());
    Derivative { left, right: if is_smooth { left } else { right }, kink, ..one.clone() }
}

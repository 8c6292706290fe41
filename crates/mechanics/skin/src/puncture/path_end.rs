//! Ends of paths, from which punctures of similar designs are solved without following their paths.

use geometry::OutOfRange;
use solver::{Continuation, Neighbours, TargetPoint};
use substrate::RowStiffness;

use super::exterior_motion::Reach;
use super::observers::PathObservers;
use super::row_layout::RowLayout;
use super::surface_fold::{FoldObserver, is_folded};
use super::system::Chain;
use super::{
    Bending, Followed, LONGEST_ROW, Needle, Passage, Problem, Puncture, PunctureInput,
    PunctureParameters, Rows,
};
use crate::contacts::{SkinMode, SkinPoint};
use crate::sensitivity::Derivative;
use crate::{Design, PathDetail, Status};

/// Smallest stretch at which a gap may stop narrowing on a path with a usable end.
///
/// If a gap almost folds and opens again, it may fold on the path of a similar design.
const LEAST_STRETCH: f64 = 0.05;

/// Smallest magnitude of the lever ([`Problem::lever`]) of a puncture with a usable end.
///
/// A load close to the middle of the base hardly tilts the scale at first. Only the path then shows
/// the direction in which the scale tilts.
const LEAST_LEVER: f64 = 0.1;

/// Number of steps from a similar design to the requested one, if one step fails.
const STEPS: u8 = 8;

/// Largest force of a load position that is solved, relative to the force at the weakest position.
///
/// Both forces belong to a similar design. A position with a larger force is assumed not to be the
/// weakest one. In 3,000 random pairs of designs with differences of up to 15 % and 6°, both
/// designs had the same weakest position.
const COMPARABLE: f64 = 1.1;

/// Largest magnitude of the stretch of a gap at a located fold.
const CLOSE: f64 = 1e-12;

/// Smallest fraction of the critical tilt at which folds are searched from the end of a path.
///
/// Between an earlier fold and the end, other gaps may fold and open again.
const EARLIEST_FOLD: f64 = 0.8;

/// Largest number of Newton steps from the end of a path to a fold before the end.
const MOST_FOLD_STEPS: usize = 8;

/// End of the path of a completed puncture, as a start for punctures of similar designs.
///
/// The ends of similar designs follow by Newton's method, without following their paths. This
/// requires [`PathDetail::Critical`], because other measures belong to points before the end, and
/// because gaps that almost fold are also close to other branches. Similar designs may have
/// [`PathDetail::End`]. Friction, guided needles and failure modes depend on the whole path.
#[derive(Clone, Debug)]
pub struct PunctureEnd {
    /// Layout of the solved part of the row.
    layout: RowLayout,
    /// Layout of the whole row; `None` for a row without ends.
    whole: Option<RowLayout>,
    point: TargetPoint<SkinMode>,
    design: Design,
    /// [`Problem::lever`] of the load.
    lever: f64,
    stiffness: RowStiffness,
    /// Ends of the punctures at the requested load positions.
    places: Vec<PlaceEnd>,
}

/// Force and path end of a puncture at one of several load positions.
#[derive(Clone, Debug)]
pub(super) struct PlaceEnd {
    pub(super) position: f64,
    /// `F*` at the critical tilt; `None` if the path did not reach it.
    pub(super) force: Option<f64>,
    /// End of the path; `None` if it is not usable.
    pub(super) end: Option<PunctureEnd>,
}

impl PunctureEnd {
    fn at(problem: &Problem, layout: RowLayout, point: TargetPoint<SkinMode>) -> Self {
        Self {
            layout,
            whole: problem.whole(),
            point,
            design: *problem.design,
            lever: problem.lever(),
            stiffness: problem.stiffness.clone(),
            places: Vec::new(),
        }
    }

    /// Adds the ends of the punctures at the requested load positions.
    pub(super) fn with_places(self, places: Vec<PlaceEnd>) -> Self {
        Self { places, ..self }
    }

    /// Returns the end of the path at a load position; `None` without a usable end.
    pub(super) fn at_place(&self, position: f64) -> Option<&Self> {
        self.places.iter().find(|place| place.position == position)?.end.as_ref()
    }

    /// Returns true if a load position may be the weakest one of a similar design.
    pub(super) fn may_be_weakest(&self, position: f64) -> bool {
        let forces = self.places.iter().filter_map(|place| place.force);
        let weakest = forces.fold(f64::INFINITY, f64::min);
        let place = self.places.iter().find(|place| place.position == position);
        place.and_then(|place| place.force).is_none_or(|force| force <= COMPARABLE * weakest)
    }

    /// Returns the end of a path as a start for similar designs.
    ///
    /// `None` if an event before the end may be different on the path of a similar design.
    pub(super) fn new(problem: &Problem, followed: &Followed) -> Option<Self> {
        let Followed { watch, path, status, .. } = followed;
        let has_folds = problem.common.detail == PathDetail::Critical;
        if !has_folds || !problem.has_end() || *status != Status::Complete {
            return None;
        }
        let is_dip_wide = watch.folds.least_dip >= LEAST_STRETCH;
        // If the tilt reverses on this path, a similar design may reach the critical tilt on
        // another branch. Require a monotonic tilt.
        let side = problem.lever().signum();
        let is_monotonic = watch.record.path.is_sorted_by_key(|point| side * point.tilt_deg);
        if !(is_dip_wide && is_monotonic) {
            return None;
        }
        Some(Self::at(problem, path.system().layout, TargetPoint::of_path(path)?))
    }
}

/// Solves a puncture like [`solve`](super::solve), but from the `end` of a similar design.
///
/// `None` if the end of the requested path cannot be found from `end`, or if an event along this
/// path may change the result. The measures agree with a solution along the whole path up to the
/// tolerance of Newton's method.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn solve_near(
    input: &PunctureInput,
    end: &PunctureEnd,
) -> Result<Option<Puncture>, OutOfRange> {
    let problem = Problem::of_input(input)?;
    problem.end_near(end)?.map(|found| problem.result_near(found, end)).transpose()
}

/// Solves a puncture like [`solve_near`], and differentiates its measures.
///
/// The derivatives are those that [`differentiate`](super::differentiate) returns.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn differentiate_near(
    input: &PunctureInput,
    variations: &[Neighbours<PunctureInput>],
    end: &PunctureEnd,
) -> Result<Option<(Puncture, Vec<Derivative>)>, OutOfRange> {
    let problem = Problem::of_input(input)?;
    let Some(mut found) = problem.end_near(end)? else { return Ok(None) };
    let mut derivatives = problem.derivatives(&mut found, variations)?;
    let puncture = problem.result_near(found, end)?;
    derivatives.extend(problem.at_weakest(&puncture, Some(end), variations, &derivatives)?);
    Ok(Some((puncture, derivatives)))
}

impl PunctureParameters {
    /// Returns true if the critical measures depend only on the end of the path.
    ///
    /// Every measure of [`PathDetail::Critical`] then belongs to the end or to a fold of the
    /// surface. Only such punctures, without friction between scales, have a [`PunctureEnd`].
    pub fn depend_on_end_only(&self) -> bool {
        self.needle == Needle::Free
            && self.bending == Bending::Rigid
            && !self.unload
            && self.failure.is_none()
            && self.depth.is_none()
            && self.force.is_none()
            && self.tilts_before_deg.is_none()
    }
}

impl Problem<'_> {
    /// Returns true if the end of the path may be a start for similar designs.
    fn has_end(&self) -> bool {
        self.common.detail <= PathDetail::Critical
            && matches!(self.rows, Rows::Even(_))
            && self.law.friction() == 0.0
            && self.parameters.depend_on_end_only()
            && self.lever().abs() >= LEAST_LEVER
    }

    /// Computes the lever of the load about the node at rest, in units of the width of the base.
    ///
    /// It is positive if the load tilts the scale clockwise.
    fn lever(&self) -> f64 {
        let Design { slant_deg, .. } = self.design;
        let shift = slant_deg.to_radians().tan() / (2.0 * self.design.half_base());
        shift + self.parameters.load_position - 0.5
    }

    /// Finds the end of the path from the `end` of a similar design; `None` if this fails.
    pub(super) fn end_near(&self, end: &PunctureEnd) -> Result<Option<Followed>, OutOfRange> {
        // Rows on curved bodies may differ in their numbers of scales, because pitches differ.
        let has_same_tilt = self.lever() * end.lever > 0.0;
        if !self.has_end() || self.whole() != end.whole || !has_same_tilt {
            return Ok(None);
        }
        let found = match self.point_near(end)? {
            None if *self.design != end.design => self.point_in_steps(end)?,
            found => found,
        };
        let Some((chain, point)) = found else { return Ok(None) };
        // A needle cannot pull, so an end with a negative load is not valid.
        let is_valid = chain.force(&point.state) > 0.0
            && Status::audited(&chain, &point.state) == Status::Complete;
        if !is_valid {
            return Ok(None);
        }
        let Some(folds) = self.folds_before(&chain, end, &point) else { return Ok(None) };
        let path = Continuation::new(chain, point.state, self.common.solver);
        let watch = PathObservers::new(&path, self.parameters, &[], &[]);
        let watch = PathObservers { folds, ..watch };
        let (passage, status) = (Passage::default(), Status::Complete);
        Ok(Some(Followed { watch, passage, path, status }))
    }

    /// Finds the equilibrium at the critical tilt in equal steps from a similar design.
    fn point_in_steps(&self, end: &PunctureEnd) -> Result<Option<(Chain, SkinPoint)>, OutOfRange> {
        let mut near = PunctureEnd {
            point: end.point.clone(),
            stiffness: end.stiffness.clone(),
            places: Vec::new(),
            ..*end
        };
        for step in 1..STEPS {
            let fraction = f64::from(step) / f64::from(STEPS);
            let design = end.design.towards(self.design, fraction);
            // Designs in between only provide starting points, so interpolate their substrates
            // instead of computing them.
            let [from, to] = [&end.stiffness, &self.stiffness];
            let stiffness = from.clone() * (1.0 - fraction) + to.clone() * fraction;
            let rows = Rows::Even(design.row()?);
            let problem = Problem::new(rows, &design, stiffness, &self.common, self.parameters)?;
            let Some((chain, point)) = problem.point_near(&near)? else { return Ok(None) };
            let point = near.point.moved_to(point.state);
            near = PunctureEnd { layout: chain.layout, point, ..near };
        }
        self.point_near(&near)
    }

    /// Finds the equilibrium at the critical tilt, and extends the row if contact reaches its ends.
    fn point_near(&self, end: &PunctureEnd) -> Result<Option<(Chain, SkinPoint)>, OutOfRange> {
        let (mut chain, mut near) = (self.part(end.layout)?, end.point.clone());
        loop {
            let Some(point) = near.of_neighbour(&chain, &self.common.solver) else {
                return Ok(None);
            };
            let reach = chain.reach(&point.state);
            if !reach.contains(&Reach::Beyond) {
                return Ok(Some((chain, point)));
            }
            let longer = chain.layout.grown(reach, LONGEST_ROW);
            let longer = self.whole().map_or(longer, |whole| longer.within(whole));
            if longer == chain.layout {
                return Ok(None);
            }
            let longer = self.part(longer)?;
            near = near.moved_to(longer.extended(&chain, &point).state);
            chain = longer;
        }
    }

    /// Returns the end of a path that was `found` from the `end` of a similar design.
    pub(super) fn moved_end(&self, found: &Followed, end: &PunctureEnd) -> PunctureEnd {
        let point = end.point.moved_to(found.path.point().state.clone());
        PunctureEnd::at(self, found.path.system().layout, point)
    }

    /// Builds the result of an end that was `found` from `near`, the end of a similar design.
    fn result_near(&self, found: Followed, near: &PunctureEnd) -> Result<Puncture, OutOfRange> {
        // Without its folds, the end is no start for other designs.
        let has_folds = self.common.detail == PathDetail::Critical;
        let end = has_folds.then(|| self.moved_end(&found, near));
        self.with_positions(found, end, Some(near))
    }

    /// Finds the first fold of the surface before the end of the path at `point`.
    ///
    /// `None` if this fold is too far from the end. A gap that has folded is assumed to stay
    /// folded, so a surface without folds at the end has never folded.
    fn folds_before(
        &self,
        chain: &Chain,
        end: &PunctureEnd,
        point: &SkinPoint,
    ) -> Option<FoldObserver> {
        if !chain.measures_folds() {
            return Some(FoldObserver::default());
        }
        let (mut first, mut nearest) = (None, (1.0, point.clone()));
        // At the fold of one gap, another gap may be folded already. Continue with this gap.
        while let Some(pair) =
            chain.gap_below(&nearest.1.state, first.map_or(0.0, |_| -2.0 * CLOSE))
        {
            nearest = self.fold_of(chain, end, pair, nearest)?;
            first = Some(pair);
        }
        let Some(pair) = first else {
            // Folds beyond the solved part cannot be located, so reject them.
            let least = chain.gap_stretches(&point.state).map_or(1.0, |stretch| stretch.min);
            return (!is_folded(least)).then(FoldObserver::default);
        };
        Some(FoldObserver::after(chain, pair, nearest.1))
    }

    /// Finds the fold of a gap by Newton's method, from a later point.
    ///
    /// Points are given with their fraction of the critical tilt.
    fn fold_of(
        &self,
        chain: &Chain,
        end: &PunctureEnd,
        pair: usize,
        (mut fraction, mut point): (f64, SkinPoint),
    ) -> Option<(f64, SkinPoint)> {
        for _ in 0..MOST_FOLD_STEPS {
            let off = chain.gap_stretch(&point.state, pair);
            if off.abs() <= CLOSE {
                return Some((fraction, point));
            }
            fraction -= off / chain.gap_stretch_rate(&point.state, &point.arriving, pair);
            if !(EARLIEST_FOLD..=1.0).contains(&fraction) {
                return None;
            }
            point = end.point.before_target(chain, &point.state, fraction, &self.common.solver)?;
        }
        None
    }
}

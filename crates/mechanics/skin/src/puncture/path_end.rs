//! Ends of paths, from which punctures of neighbouring designs are solved without their paths.

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

/// Least stretch of a gap at a minimum along a path with a usable end.
///
/// A gap that almost folds and opens again may fold on the path of a neighbour.
const LEAST_STRETCH: f64 = 0.05;

/// Least lever of the load at rest, in widths of the top, of a puncture with a usable end.
///
/// A load above the middle of the base hardly tilts the scale at first. The scale may then tilt
/// either way, which only the path decides.
const LEAST_LEVER: f64 = 0.1;

/// Number of steps from a similar design to the requested one, if one step fails.
const STEPS: u8 = 8;

/// Force over the force at the weakest load position up to which a position may be the weakest of a
/// similar design.
///
/// In 3,000 random pairs of designs up to 15 % and 6° apart the weakest position was the same.
const COMPARABLE: f64 = 1.1;

/// A fold is located if the stretch of its gap is below this.
const CLOSE: f64 = 1e-12;

/// Fraction of the critical tilt before which folds are not searched from the end.
///
/// Other gaps may fold and open again between an earlier fold and the end.
const EARLIEST_FOLD: f64 = 0.8;

/// Largest number of Newton steps from the end of a path to a fold before it.
const MOST_FOLD_STEPS: usize = 8;

/// End of the path of a completed puncture.
///
/// It is a start for punctures of similar designs: their ends follow by Newton's method, without
/// their paths. Only [`PathDetail::Critical`] has it, because other measures belong to points before
/// the end. The history of friction, of a guided needle and of failure also needs the whole path.
#[derive(Clone, Debug)]
pub struct PunctureEnd {
    layout: RowLayout,
    /// Layout of the whole row; `None` if the row has no end.
    whole: Option<RowLayout>,
    point: TargetPoint<SkinMode>,
    design: Design,
    /// [`Problem::lever`] of the load.
    lever: f64,
    stiffness: RowStiffness,
    /// The punctures at the requested load positions.
    places: Vec<PlaceEnd>,
}

/// Puncture at one of several load positions, and its end.
#[derive(Clone, Debug)]
pub(super) struct PlaceEnd {
    pub(super) position: f64,
    /// `F*` at the critical tilt.
    pub(super) force: Option<f64>,
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

    /// Adds the punctures at the requested load positions.
    pub(super) fn with_places(self, places: Vec<PlaceEnd>) -> Self {
        Self { places, ..self }
    }

    /// Returns the end at a load position.
    pub(super) fn at_place(&self, position: f64) -> Option<&Self> {
        self.places.iter().find(|place| place.position == position)?.end.as_ref()
    }

    /// Returns true if a load position of a similar design may be the weakest.
    pub(super) fn may_be_weakest(&self, position: f64) -> bool {
        let forces = self.places.iter().filter_map(|place| place.force);
        let weakest = forces.fold(f64::INFINITY, f64::min);
        let place = self.places.iter().find(|place| place.position == position);
        place.and_then(|place| place.force).is_none_or(|force| force <= COMPARABLE * weakest)
    }

    /// Returns the end of a path, unless an event before it may change the result of a neighbour.
    pub(super) fn new(problem: &Problem, followed: &Followed) -> Option<Self> {
        let Followed { watch, path, status, .. } = followed;
        if !problem.has_end() || *status != Status::Complete {
            return None;
        }
        let folds_for_good = watch.folds.least_dip >= LEAST_STRETCH;
        // A tilt that reverses may reach its critical value on another branch of a neighbour.
        let side = problem.lever().signum();
        let tilts_on = watch.record.path.is_sorted_by_key(|point| side * point.tilt_deg);
        if !(folds_for_good && tilts_on) {
            return None;
        }
        Some(Self::at(problem, path.system().layout, TargetPoint::of_path(path)?))
    }
}

/// Solves a puncture like [`solve`](super::solve), but from the `end` of a similar design.
///
/// `None` if the end of the design cannot be found from there, or if an event along its path may
/// change the result. The measures agree with a solution along the whole path, up to the tolerance
/// of Newton's method.
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
/// As [`differentiate`](super::differentiate), but from the `end` of a similar design.
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
    /// Returns true if the critical measures depend on the end of the path only.
    ///
    /// Every measure of [`PathDetail::Critical`] then belongs to the end or to a fold of the
    /// surface. Without friction, only such punctures have a [`PunctureEnd`].
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
    fn has_end(&self) -> bool {
        self.common.detail == PathDetail::Critical
            && matches!(self.rows, Rows::Even(_))
            && self.law.friction() == 0.0
            && self.parameters.depend_on_end_only()
            && self.lever().abs() >= LEAST_LEVER
    }

    /// Computes the lever of the load about the middle of the base at rest, in widths of the top.
    ///
    /// Positive if the load tilts the scale clockwise.
    fn lever(&self) -> f64 {
        let Design { slant_deg, .. } = self.design;
        let shift = slant_deg.to_radians().tan() / (2.0 * self.design.half_base());
        shift + self.parameters.load_position - 0.5
    }

    /// Finds the end of the path from the `end` of a similar design.
    pub(super) fn end_near(&self, end: &PunctureEnd) -> Result<Option<Followed>, OutOfRange> {
        // A curved body carries more or fewer scales as their pitch changes.
        let tilts_the_same_way = self.lever() * end.lever > 0.0;
        if !self.has_end() || self.whole() != end.whole || !tilts_the_same_way {
            return Ok(None);
        }
        let found = match self.point_near(end)? {
            None if *self.design != end.design => self.point_in_steps(end)?,
            found => found,
        };
        let Some((chain, point)) = found else { return Ok(None) };
        // The needle only pushes.
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

    /// Finds the equilibrium at the critical tilt in equal steps of the design.
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
            // Designs in between only provide starting points, so interpolate their substrates.
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

    /// Finds the equilibrium at the critical tilt, on a row that is long enough for it.
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

    /// Builds the result of an end that was found from the end of a similar design.
    fn result_near(&self, found: Followed, near: &PunctureEnd) -> Result<Puncture, OutOfRange> {
        let end = self.moved_end(&found, near);
        self.with_positions(found, Some(end), Some(near))
    }

    /// Finds the first fold of the surface before the end at `point`.
    ///
    /// `None` if it is far from there. Gaps that fold stay folded, so a surface that is open at the
    /// end has never folded.
    fn folds_before(
        &self,
        chain: &Chain,
        end: &PunctureEnd,
        point: &SkinPoint,
    ) -> Option<FoldObserver> {
        let (mut first, mut nearest) = (None, (1.0, point.clone()));
        // Where one gap folds, another one may have folded already.
        while let Some(pair) =
            chain.gap_below(&nearest.1.state, first.map_or(0.0, |_| -2.0 * CLOSE))
        {
            nearest = self.fold_of(chain, end, pair, nearest)?;
            first = Some(pair);
        }
        let Some(pair) = first else {
            // Gaps beyond the solved part do not fold unless it grows.
            let least = chain.gap_stretches(&point.state).map_or(1.0, |stretch| stretch.min);
            return (!is_folded(least)).then(FoldObserver::default);
        };
        Some(FoldObserver::after(chain, pair, nearest.1))
    }

    /// Finds the fold of a gap by Newton's method.
    ///
    /// Starts from a later point and its fraction of the critical tilt.
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

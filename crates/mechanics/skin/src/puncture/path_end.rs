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

/// Least load position of a puncture with a usable end.
///
/// A load farther to the left hardly tilts the scale at first, at some slant. The scale may then
/// tilt either way, which only the path decides.
const LEAST_POSITION: f64 = 0.6;

/// Numbers of steps from a similar design to the requested one, tried in turn.
const STEPS: [u8; 2] = [1, 8];

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
    stiffness: RowStiffness,
}

impl PunctureEnd {
    fn at(problem: &Problem, layout: RowLayout, point: TargetPoint<SkinMode>) -> Self {
        let (design, stiffness) = (*problem.design, problem.stiffness.clone());
        Self { layout, whole: problem.whole(), point, design, stiffness }
    }

    /// Returns the end of a path, unless an event before it may change the result of a neighbour.
    pub(super) fn new(problem: &Problem, followed: &Followed) -> Option<Self> {
        let Followed { watch, path, status, .. } = followed;
        if !problem.has_end() || *status != Status::Complete {
            return None;
        }
        let folds_for_good = watch.folds.least_dip >= LEAST_STRETCH;
        // A tilt that reverses may reach its critical value on another branch of a neighbour.
        let tilts_on = watch.record.path.is_sorted_by_key(|point| point.tilt_deg);
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
    let problem = input.problem(&input.design, input.stiffness.clone())?;
    Ok(problem.end_near(input, end)?.map(|found| problem.result_near(found, end)))
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
    let problem = input.problem(&input.design, input.stiffness.clone())?;
    let Some(mut found) = problem.end_near(input, end)? else { return Ok(None) };
    let derivatives = problem.derivatives(&mut found, variations)?;
    Ok(Some((problem.result_near(found, end), derivatives)))
}

impl PunctureInput {
    /// Sets up the problem of a design with the parameters of this input.
    fn problem<'a>(
        &'a self,
        design: &'a Design,
        stiffness: RowStiffness,
    ) -> Result<Problem<'a>, OutOfRange> {
        let rows = Rows::Even(design.row()?);
        Problem::new(rows, design, stiffness, &self.common, &self.parameters)
    }

    /// Moves an end towards the design of this input in equal steps, up to the last one.
    fn approached(&self, end: &PunctureEnd, steps: u8) -> Result<Option<PunctureEnd>, OutOfRange> {
        let mut near = end.clone();
        for step in 1..steps {
            let fraction = f64::from(step) / f64::from(steps);
            let design = end.design.towards(&self.design, fraction);
            // The substrate of a design in between only serves as a start.
            let [from, to] = [&end.stiffness, &self.stiffness];
            let stiffness = from.clone() * (1.0 - fraction) + to.clone() * fraction;
            let problem = self.problem(&design, stiffness)?;
            let Some((chain, point)) = problem.point_near(&near)? else { return Ok(None) };
            let point = near.point.moved_to(point.state);
            near = PunctureEnd { layout: chain.layout, point, ..near };
        }
        Ok(Some(near))
    }
}

impl PunctureParameters {
    /// Returns true if the critical measures depend on the end of the path only.
    ///
    /// Every measure of [`PathDetail::Critical`] then belongs to the end or to a fold of the
    /// surface, and similar designs tilt the same way. Without friction, only such punctures have a
    /// [`PunctureEnd`].
    pub fn depend_on_end_only(&self) -> bool {
        self.needle == Needle::Free
            && self.bending == Bending::Rigid
            && !self.unload
            && self.load_position >= LEAST_POSITION
            && self.failure.is_none()
            && self.places.is_none()
            && self.depth.is_none()
            && self.force.is_none()
            && self.tilts_before_deg.is_none()
    }
}

impl Problem<'_> {
    fn has_end(&self) -> bool {
        self.detail == PathDetail::Critical
            && matches!(self.rows, Rows::Even(_))
            && self.law.friction() == 0.0
            && self.parameters.depend_on_end_only()
    }

    /// Finds the end of the path from the `end` of a similar design.
    fn end_near(
        &self,
        input: &PunctureInput,
        end: &PunctureEnd,
    ) -> Result<Option<Followed>, OutOfRange> {
        // A curved body carries more or fewer scales as their pitch changes.
        if !self.has_end() || self.whole() != end.whole {
            return Ok(None);
        }
        let mut found = None;
        for steps in STEPS {
            let near = input.approached(end, steps)?;
            found = near.map(|near| self.point_near(&near)).transpose()?.flatten();
            if found.is_some() {
                break;
            }
        }
        let Some((chain, point)) = found else { return Ok(None) };
        // The needle only pushes.
        let is_valid = chain.force(&point.state) > 0.0
            && Status::audited(&chain, &point.state) == Status::Complete;
        if !is_valid {
            return Ok(None);
        }
        let Some(folds) = self.folds_before(&chain, end, &point) else { return Ok(None) };
        let path = Continuation::new(chain, point.state, self.settings);
        let watch = PathObservers::new(&path, self.parameters, &[], &[]);
        let watch = PathObservers { folds, ..watch };
        let (passage, status) = (Passage::default(), Status::Complete);
        Ok(Some(Followed { watch, passage, path, status }))
    }

    /// Finds the equilibrium at the critical tilt, on a row that is long enough for it.
    fn point_near(&self, end: &PunctureEnd) -> Result<Option<(Chain, SkinPoint)>, OutOfRange> {
        let (mut chain, mut near) = (self.part(end.layout)?, end.point.clone());
        loop {
            let Some(point) = near.of_neighbour(&chain, &self.settings) else { return Ok(None) };
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

    /// Builds the result of an end that was found from the `end` of a similar design.
    fn result_near(&self, found: Followed, end: &PunctureEnd) -> Puncture {
        let point = end.point.moved_to(found.path.point().state.clone());
        let end = Some(PunctureEnd::at(self, found.path.system().layout, point));
        Puncture { end, ..found.puncture(false) }
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
            point = end.point.before_target(chain, &point.state, fraction, &self.settings)?;
        }
        None
    }
}

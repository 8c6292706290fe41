//! Bending of a strip with unequal gaps, in which each gap is solved separately.

use geometry::OutOfRange;
use solver::{Bracket, Newton};

use super::accuracy::{Sums, largest_change};
use super::gap_curve::{GapCurve, Knot};
use super::gap_order::GapOrder;
use super::mesh::Resolution;
use super::problem::{FlexureProblem, LOCKED};
use super::{Flexure, FlexureMeasures};
use crate::contacts::Contacts;
use crate::{PathDetail, Status};

/// Relative tolerance of the moment at which the strip reaches its final rotation.
const CLOSE: f64 = 1e-12;

/// Predicted relative gain below which the search for the largest stiffness stops.
const FLAT: f64 = 1e-11;

/// Distance from the stiffest point at which the strip is checked not to be stiffer.
///
/// It is relative to the distance from the stiffest point to the next breakpoint.
const BESIDE: f64 = 1e-3;

/// Relative increase of the stiffness that counts in this check.
const STIFFER: f64 = 1e-9;

/// Maximum number of iterations of a search. Most searches need at most a quarter of them.
const ROUNDS: usize = 50;

/// Largest factor by which one iteration raises the moment.
///
/// Extrapolation with the compliance before a gap closes would overshoot.
const FARTHER: f64 = 2.0;

/// Factor of the final rotation at which the final moment is estimated.
///
/// Interpolation up to the final moment is more accurate than extrapolation.
const BEYOND: f64 = 1.02;

/// Ratio of two compliances beyond which the larger one needs no exact value.
const MUCH_SOFTER: f64 = 1.05;

/// Largest relative change by refinement of a state that is only audited.
const AUDITED: f64 = 0.01;

/// Divisor of the largest step size if there is friction.
const FRICTION_REFINEMENT: f64 = 4.0;

/// Number of golden-section steps that predict the stiffest point between two breakpoints.
const SECTIONS: usize = 30;

/// Result of bending a sample of an imperfect strip.
#[derive(Clone, Copy, Debug)]
pub struct BentSample {
    /// Outcome of the path, including the audit of its end.
    pub status: Status,
    /// The measures of bending.
    pub measures: FlexureMeasures,
    /// Width of the range of curvatures in which the gaps close, as [`Flexure::closing_range`].
    pub closing_range: Option<f64>,
    /// Number of equilibria on the path of the chain, or on the paths of all separate gaps.
    pub points: usize,
    /// Number of Newton iterations that computed these equilibria.
    pub iterations: usize,
}

impl From<&Flexure> for BentSample {
    fn from(flexure: &Flexure) -> Self {
        Self {
            status: flexure.status,
            measures: flexure.measures,
            closing_range: flexure.closing_range(),
            points: flexure.path.len(),
            iterations: flexure.history.len(),
        }
    }
}

/// Bends a strip by solving each of its gaps separately.
///
/// In pure bending every cut carries the same moment and no force, so the gaps interact only
/// through the moment. While the moment grows, the rotations `θᵢ` of the gaps and their compliances
/// add up:
///
/// ```text
/// Φ(M) = Σ θᵢ(M),    dΦ/dM = Σ dθᵢ/dM                                                       (F7)
/// ```
///
/// `None` if a gap does not reach the final moment, or if its moment or rotation decreases before.
/// Then the chain of all gaps has to be solved.
pub(super) fn solve(problem: &FlexureProblem) -> Result<Option<BentSample>, OutOfRange> {
    let usual = problem.coarsest(PathDetail::Whole);
    let mut resolution = problem.coarsest(problem.common.detail);
    // The state of a gap with friction depends on its path from rest.
    let mut skips = problem.common.friction == 0.0;
    loop {
        let is_early = resolution.is_coarser_than(usual);
        match UnevenStrip::new(problem, resolution, skips)?.bend() {
            Some(bent) if bent.status == Status::Complete => {
                let Some(finer) = resolution.better(bent.measures.error) else {
                    return Ok(Some(bent));
                };
                resolution = finer;
            }
            // Confirm a failure with the usual membrane and with the paths of all gaps from rest.
            _ if skips || is_early => {
                skips = false;
                resolution = if is_early { usual } else { resolution };
            }
            failed => return Ok(failed),
        }
    }
}

/// A strip of unequal gaps, with the moment–rotation curve of each gap.
struct UnevenStrip<'a> {
    problem: &'a FlexureProblem<'a>,
    resolution: Resolution,
    gaps: Vec<GapCurve>,
    order: GapOrder,
    /// True if only the paths of the extreme gaps are followed, where they permit it.
    skips: bool,
}

impl<'a> UnevenStrip<'a> {
    fn new(
        problem: &'a FlexureProblem,
        resolution: Resolution,
        skips: bool,
    ) -> Result<Self, OutOfRange> {
        let mut settings = problem.common.solver;
        if problem.common.friction > 0.0 {
            // The accuracy of the dissipation depends on the step size. The path of a single gap
            // has fewer points than the path of the chain, which stops at the events of all gaps.
            settings.max_step /= FRICTION_REFINEMENT;
        }
        let gaps = (0..problem.solved)
            .map(|gap| Ok(GapCurve::new(problem.gap(gap, resolution)?, settings)))
            .collect::<Result<_, _>>()?;
        let order = GapOrder::new(&problem.row, problem.solved);
        Ok(Self { problem, resolution, gaps, order, skips })
    }

    /// Bends the strip to its final rotation; `None` if the gaps cannot be solved separately.
    fn bend(&mut self) -> Option<BentSample> {
        let beyond = self.pass_end()?;
        if self.problem.common.detail <= PathDetail::Critical {
            let status = self.status(beyond);
            let points = self.points(beyond)?;
            // The strip has not reached its final rotation at any of these points.
            let has_all = self.rotation(points.farthest()) <= self.whole();
            if status == Status::Complete
                && has_all
                && self.error(&points, &[beyond]).is_none_or(|error| error <= AUDITED)
            {
                let error = self.error(&points, &[points.stiffest]);
                let measures = self.early_measures(&points, error);
                return Some(self.bent(status, (measures, &points), beyond));
            }
        }
        let end = self.end(beyond)?;
        let points = self.points(end)?;
        let status = self.status(end);
        let error = self.error(&points, &[points.stiffest, end]);
        let measures = self.early_measures(&points, error);
        let measures = self.with_final_measures(measures, end);
        Some(self.bent(status, (measures, &points), end))
    }

    /// Builds the result of a strip that was bent up to the moment `end`.
    fn bent(
        &self,
        status: Status,
        (measures, points): (FlexureMeasures, &Points),
        end: f64,
    ) -> BentSample {
        let is_complete = status == Status::Complete;
        let closings =
            points.closings.map(|closings| closings.map(|moment| self.curvature(moment)));
        BentSample {
            status,
            measures: if is_complete { measures } else { measures.without_final_values() },
            closing_range: closings.map(|[first, last]| last - first),
            points: self.gaps.iter().map(|gap| gap.knots_to(end).len()).sum(),
            iterations: self.gaps.iter().map(|gap| gap.iterations).sum(),
        }
    }

    /// Audits all gaps under the final moment.
    fn status(&self, end: f64) -> Status {
        let audited =
            self.knots(end).map(|(gap, knot)| Status::audited(gap.strip(), &knot.point.state));
        // As for the chain, interpenetration takes precedence over a contact off its edge.
        audited.fold(Status::Complete, |one, other| {
            if one == Status::Complete || other == Status::Interpenetration { other } else { one }
        })
    }

    /// Solves the strip at its first and last closing and where it is stiffest, up to `end`.
    fn points(&mut self, end: f64) -> Option<Points> {
        let closings = self.gaps.iter().filter_map(GapCurve::first_closing);
        let closings: Vec<_> = closings.filter(|closing| *closing <= end).collect();
        let first = closings.iter().copied().reduce(f64::min);
        let last = closings.iter().copied().reduce(f64::max);
        let closings = first.zip(last).map(<[f64; 2]>::from);
        // At the first closing all other gaps are open, and (F8) is exact for their arcs.
        if let Some([_, last]) = closings {
            self.solve_at(last)?;
        }
        // Without contact the stiffness is constant, so any moment serves.
        let stiffest = if first.is_some() { self.stiffest(end)? } else { 0.0 };
        Some(Points { closings, stiffest })
    }

    /// Computes the measures that do not depend on the end of bending.
    fn early_measures(&self, points: &Points, error: Option<f64>) -> FlexureMeasures {
        let problem = self.problem;
        let [compliance, initial_compliance] =
            [self.least_compliance(points.stiffest), self.compliance(0.0)]
                .map(|compliance| compliance * problem.bending_stiffness() / problem.length());
        let measures = FlexureMeasures {
            compliance: Some(compliance),
            initial_compliance: Some(initial_compliance),
            contact: Some(points.closings.is_some()),
            first_contact_curvature: points.closings.map(|[first, _]| self.curvature(first)),
            error,
            contact_curvature: problem.contact_curvature,
            gaps: problem.gaps,
            ..FlexureMeasures::default()
        };
        measures.in_closed_form(problem.row.gap_fraction())
    }

    /// Adds the measures of the whole path up to the moment `end`.
    fn with_final_measures(&mut self, measures: FlexureMeasures, end: f64) -> FlexureMeasures {
        let problem = self.problem;
        let friction_work = (problem.common.friction > 0.0)
            .then(|| self.gaps.iter_mut().map(|gap| gap.friction_work(end)).sum());
        let mut sums = Sums::default();
        self.knots(end).for_each(|(gap, knot)| sums.add(gap.strip(), knot));
        let measures = FlexureMeasures {
            max_moment: Some(self.direction() * end / problem.bending_stiffness()),
            axial_energy_share: Some(sums.axial_energy / sums.energy),
            membrane_strain_max: self
                .gaps
                .iter()
                .map(|gap| gap.largest_strain(end))
                .reduce(f64::max),
            friction_work,
            locking_curvature: self.locking(end).map(|moment| self.curvature(moment)),
            ..measures
        };
        measures.in_closed_form(problem.row.gap_fraction())
    }

    /// Extends all curves to a moment at which the strip has passed its final rotation.
    fn pass_end(&mut self) -> Option<f64> {
        let whole = self.whole();
        let estimate = self.estimated_end(whole);
        let mut highest = estimate.unwrap_or(whole / self.compliance(0.0));
        for _ in 0..ROUNDS {
            self.extend_to(highest)?;
            let missing = whole - self.rotation(highest);
            if missing <= 0.0 {
                return Some(highest);
            }
            let step = missing / self.compliance(highest);
            highest += (BEYOND * step).min((FARTHER - 1.0) * highest);
        }
        None
    }

    /// Finds the moment, at most `highest`, at which the strip reaches its final rotation.
    fn end(&mut self, highest: f64) -> Option<f64> {
        let whole = self.whole();
        for _ in 0..ROUNDS {
            let moment = moment_at(whole, highest, |moment| self.rotation(moment));
            self.solve_at(moment)?;
            let off = whole - self.rotation(moment);
            if off.abs() <= CLOSE * moment * self.compliance(moment) {
                return Some(moment);
            }
        }
        None
    }

    /// Estimates the moment at which the strip reaches its final rotation.
    ///
    /// Follows the first gap until it rotates by slightly more than the mean of all gaps.
    fn estimated_end(&mut self, whole: f64) -> Option<f64> {
        let rotation = BEYOND * whole / self.gaps.len() as f64;
        let gap = &mut self.gaps[self.order.first];
        let highest = gap.follow_to_rotation(rotation)?;
        Some(moment_at(rotation, highest, |moment| gap.rotation(moment)))
    }

    /// Extends the curves of all gaps to a moment, and solves for their equilibria there.
    fn extend_to(&mut self, moment: f64) -> Option<()> {
        for &gap in &self.order.extremes {
            self.gaps[gap].follow_to(moment)?;
        }
        if self.skips {
            self.extend_beside_extremes(moment)?;
        }
        self.gaps.iter_mut().try_for_each(|gap| gap.follow_to(moment))?;
        self.solve_at(moment)
    }

    /// Extends the curves of all gaps without following their paths, if the extreme gaps permit it.
    ///
    /// The path of a gap is followed only up to first contact. `None` as for
    /// [`GapCurve::follow_to`].
    fn extend_beside_extremes(&mut self, moment: f64) -> Option<()> {
        for &pair in &self.order.pairs {
            let [gap, similar] = self.gaps.get_disjoint_mut(pair).ok()?;
            gap.close_beside(similar, moment)?;
        }
        if !self.softens_after_closing(moment) {
            return Some(());
        }
        for &gap in &self.order.extremes {
            self.gaps[gap].solve_at(moment)?;
        }
        for &pair in &self.order.pairs {
            let [gap, similar] = self.gaps.get_disjoint_mut(pair).ok()?;
            // If this fails, the caller follows the path of the gap.
            gap.skip_to(similar, moment);
        }
        Some(())
    }

    /// Returns true if the extreme gaps are stiffest when the last gap closes.
    ///
    /// Otherwise the search for the stiffest state needs all points of all paths.
    fn softens_after_closing(&self, end: f64) -> bool {
        let closings = self.gaps.iter().filter_map(GapCurve::first_closing);
        let Some(last) = closings.filter(|closing| *closing <= end).reduce(f64::max) else {
            return true;
        };
        let extremes = self.order.extremes.iter().map(|&gap| &self.gaps[gap]);
        let knots = extremes.clone().flat_map(|gap| gap.knots_to(end)).map(|knot| knot.moment);
        let mut moments: Vec<_> = knots.filter(|moment| *moment > last).chain([end]).collect();
        moments.sort_unstable_by(f64::total_cmp);
        let at_closing = compliances(extremes.clone(), last)[1];
        let mut previous = at_closing;
        moments.into_iter().all(|moment| {
            let next = compliances(extremes.clone(), moment)[1];
            let softens = next >= previous * (1.0 - FLAT) || next >= MUCH_SOFTER * at_closing;
            previous = next;
            softens
        })
    }

    /// Returns the curvature `κ*` of the strip under a moment.
    fn curvature(&self, moment: f64) -> f64 {
        self.direction() * self.rotation(moment) / self.problem.length()
    }

    /// Finds the moment at which the strip is stiffest, and solves all gaps there.
    ///
    /// `None` if the strip is stiffer between two breakpoints, where (F8) does not predict it.
    fn stiffest(&mut self, end: f64) -> Option<f64> {
        let mut best = (0.0, f64::INFINITY);
        for _ in 0..ROUNDS {
            let (moment, promised) = self.promising(end);
            if promised >= best.1 * (1.0 - FLAT) {
                break;
            }
            self.solve_at(moment)?;
            let found = self.least_compliance(moment);
            if found < best.1 {
                best = (moment, found);
            }
            if found == promised {
                // All gaps had been solved there, so the next prediction would be the same.
                break;
            }
        }
        let breakpoints = self.breakpoints(end);
        let before = breakpoints.iter().rfind(|breakpoint| **breakpoint < best.0);
        let behind = breakpoints.iter().find(|breakpoint| **breakpoint > best.0);
        for (compliance, breakpoint) in self.compliances(best.0).into_iter().zip([before, behind]) {
            // If the best point is an event, check only its stiff side.
            let is_stiff = compliance <= best.1 * (1.0 + FLAT);
            if let Some(breakpoint) = breakpoint.filter(|_| is_stiff) {
                let beside = best.0 + BESIDE * (breakpoint - best.0);
                self.solve_at(beside)?;
                if self.least_compliance(beside) < best.1 * (1.0 - STIFFER) {
                    return None;
                }
            }
        }
        Some(best.0)
    }

    /// Returns the moments, in ascending order, between which the compliance is smooth.
    ///
    /// These are the events of all gaps, at which the compliance may jump. The equilibria of the
    /// first gap in the order are added as samples.
    fn breakpoints(&self, end: f64) -> Vec<f64> {
        let one = self.gaps[self.order.first].knots_to(end).iter();
        let all = self.gaps.iter().flat_map(|gap| gap.knots_to(end));
        let breakpoints = one.chain(all.filter(|knot| knot.is_event())).map(|knot| knot.moment);
        let mut breakpoints: Vec<_> = breakpoints.collect();
        breakpoints.sort_unstable_by(f64::total_cmp);
        breakpoints.dedup();
        breakpoints
    }

    /// Predicts by (F8) the moment of least compliance, and returns it with this compliance.
    fn promising(&self, end: f64) -> (f64, f64) {
        let breakpoints = self.breakpoints(end);
        let found = breakpoints.iter().map(|&moment| (moment, self.least_compliance(moment)));
        let best = found.reduce(lesser).unwrap_or((0.0, f64::INFINITY));
        let number = breakpoints.partition_point(|moment| *moment < best.0);
        let beside = breakpoints[number.saturating_sub(1)..].windows(2).take(2);
        let inside = beside.map(|segment| self.least_within([segment[0], segment[1]]));
        // Prefer a breakpoint if a point between breakpoints is not better by more than round-off.
        inside.filter(|(_, value)| *value < best.1 * (1.0 - FLAT)).fold(best, lesser)
    }

    /// Minimises the compliance between two neighbouring breakpoints by golden-section search.
    ///
    /// Returns the moment and the compliance.
    fn least_within(&self, [mut low, mut high]: [f64; 2]) -> (f64, f64) {
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let mut inner = [high - golden * (high - low), low + golden * (high - low)]
            .map(|moment| (moment, self.compliance(moment)));
        for _ in 0..SECTIONS {
            let is_below = inner[0].1 < inner[1].1;
            *(if is_below { &mut high } else { &mut low }) = inner[usize::from(is_below)].0;
            let step = golden * (high - low);
            let moment = if is_below { high - step } else { low + step };
            let value = (moment, self.compliance(moment));
            inner = if is_below { [value, inner[0]] } else { [inner[1], value] };
        }
        if inner[0].1 < inner[1].1 { inner[0] } else { inner[1] }
    }

    /// Returns the moment of the last contact change if the strip is locked at the moment `end`.
    ///
    /// A strip is locked if contacts stick and make it [`LOCKED`] times as stiff as at rest.
    fn locking(&self, end: f64) -> Option<f64> {
        let sticks =
            self.knots(end).any(|(_, knot)| Contacts::stick_slip_counts(&knot.point.state)[0] > 0);
        let stiffened = self.compliance(0.0) / self.compliance(end);
        let knots = self.gaps.iter().flat_map(|gap| gap.knots_to(end));
        let changes = knots.filter(|knot| knot.is_event()).map(|knot| knot.moment);
        changes.reduce(f64::max).filter(|_| sticks && stiffened >= LOCKED)
    }

    /// Estimates the largest discretisation error at some moments; `None` if it is not estimated.
    fn error(&self, points: &Points, moments: &[f64]) -> Option<f64> {
        let finer = self.resolution.finer()?;
        if points.closings.is_none() {
            // Without contact the membranes are arcs, which every resolution represents exactly.
            return Some(0.0);
        }
        // If a state has no solution on the finer membrane, its error counts as infinite.
        let errors =
            moments.iter().map(|moment| self.change(finer, *moment).unwrap_or(f64::INFINITY));
        errors.reduce(f64::max)
    }

    /// Computes the largest relative change of any measure on a finer membrane at a moment.
    ///
    /// The strip is represented by the gaps with the least and the largest width, clearance and
    /// slant, and one gap near the mean.
    fn change(&self, finer: Resolution, moment: f64) -> Option<f64> {
        let (mut ours, mut theirs, mut newton) = (Sums::default(), Sums::default(), None);
        for &number in &self.order.extremes {
            let gap = &self.gaps[number];
            let strip = self.problem.gap(number, finer).ok()?;
            let newton = newton.get_or_insert_with(|| Newton::new(&strip));
            let knot = gap.resolved(moment, &strip, newton)?;
            theirs.add(&strip, &knot);
            ours.add(gap.strip(), gap.knot(moment)?);
        }
        // Compare both membranes at the same end rotation: correct the moment of the finer one.
        let theirs_there = moment - (theirs.rotation - ours.rotation) / theirs.compliance;
        largest_change(ours.quantities(moment), theirs.quantities(theirs_there))
    }

    /// Solves all gaps under a moment that their paths have already passed.
    fn solve_at(&mut self, moment: f64) -> Option<()> {
        self.gaps.iter_mut().try_for_each(|gap| gap.solve_at(moment))
    }

    /// Returns the magnitude of the final rotation of the strip.
    fn whole(&self) -> f64 {
        self.problem.end_rotation().abs()
    }

    /// Returns 1 with the scales on the inside of the bend, −1 with the scales on the outside.
    fn direction(&self) -> f64 {
        self.problem.end_rotation().signum()
    }

    fn rotation(&self, moment: f64) -> f64 {
        self.gaps.iter().map(|gap| gap.rotation(moment)).sum()
    }

    /// Returns the compliances of the strip just below and just above a moment.
    fn compliances(&self, moment: f64) -> [f64; 2] {
        compliances(self.gaps.iter(), moment)
    }

    /// Returns the compliance just above a moment.
    fn compliance(&self, moment: f64) -> f64 {
        self.compliances(moment)[1]
    }

    /// Returns the smaller one of the compliances just below and just above a moment.
    fn least_compliance(&self, moment: f64) -> f64 {
        least(self.compliances(moment))
    }

    /// Iterates over the gaps, each with its equilibrium under a moment that was solved for.
    fn knots(&self, moment: f64) -> impl Iterator<Item = (&GapCurve, &Knot)> {
        self.gaps.iter().filter_map(move |gap| Some((gap, gap.knot(moment)?)))
    }
}

/// Returns the sums of the compliances of some gaps just below and just above a moment.
fn compliances<'a>(gaps: impl Iterator<Item = &'a GapCurve>, moment: f64) -> [f64; 2] {
    gaps.map(|gap| gap.compliances(moment))
        .fold([0.0; 2], |sums, of_gap| [sums[0] + of_gap[0], sums[1] + of_gap[1]])
}

/// Returns the smaller one of two compliances.
fn least([below, above]: [f64; 2]) -> f64 {
    below.min(above)
}

/// Returns the moment at which an increasing `rotation_at` reaches a rotation.
///
/// Returns `highest` if the rotation is not reached up to this moment.
fn moment_at(rotation: f64, highest: f64, rotation_at: impl Fn(f64) -> f64) -> f64 {
    let at_highest = rotation_at(highest) - rotation;
    if at_highest <= 0.0 {
        return highest;
    }
    let mut bracket = Bracket::new((0.0, -rotation), (highest, at_highest));
    // Regula falsi may move only one end of the bracket, so stop when the iterate no longer
    // changes, not when the bracket is narrow.
    let mut moment = highest;
    for _ in 0..ROUNDS {
        // Curves may end at `highest`, which round-off of the secant may exceed.
        let next = bracket.secant().min(highest);
        let value = rotation_at(next) - rotation;
        if value == 0.0 || (next - moment).abs() <= f64::EPSILON * highest {
            return next;
        }
        bracket.narrow(next, value);
        moment = next;
    }
    moment
}

/// Returns the `(moment, value)` pair of lesser value; the first one if both are equal.
fn lesser(one: (f64, f64), other: (f64, f64)) -> (f64, f64) {
    if other.1 < one.1 { other } else { one }
}

/// Moments at which a strip is solved.
struct Points {
    /// First contact in the gap that closes first, and in the gap that closes last.
    closings: Option<[f64; 2]>,
    /// Moment of the largest stiffness; 0 if no gap closes.
    stiffest: f64,
}

impl Points {
    /// Returns the largest moment.
    fn farthest(&self) -> f64 {
        self.closings.map_or(self.stiffest, |[_, last]| last.max(self.stiffest))
    }
}

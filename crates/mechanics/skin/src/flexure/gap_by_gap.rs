//! Bending of a strip with unequal gaps, in which each gap is solved separately.

use geometry::OutOfRange;
use membrane::GapEnergies;
use solver::{Bracket, Newton};

use super::accuracy::{Quantities, largest_change};
use super::gap_curve::{GapCurve, KinkSide, Knot};
use super::mesh::Resolution;
use super::problem::{FlexureProblem, LOCKED};
use super::strip::Strip;
use super::{Flexure, FlexureMeasures};
use crate::Status;
use crate::contacts::Contacts;

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
    let mut resolution = problem.coarsest();
    loop {
        let mut strip = UnevenStrip::new(problem, resolution)?;
        let Some(bent) = strip.bend() else { return Ok(None) };
        let Some(finer) = resolution.better(bent.measures.error) else { return Ok(Some(bent)) };
        resolution = finer;
    }
}

/// A strip of unequal gaps, with the moment–rotation curve of each gap.
struct UnevenStrip<'a> {
    problem: &'a FlexureProblem<'a>,
    resolution: Resolution,
    gaps: Vec<GapCurve>,
}

impl<'a> UnevenStrip<'a> {
    fn new(problem: &'a FlexureProblem, resolution: Resolution) -> Result<Self, OutOfRange> {
        let mut settings = problem.common.solver;
        if problem.common.friction > 0.0 {
            // The accuracy of the dissipation depends on the step size. The path of a single gap
            // has fewer points than the path of the chain, which stops at the events of all gaps.
            settings.max_step /= FRICTION_REFINEMENT;
        }
        let gaps = (0..problem.solved)
            .map(|gap| Ok(GapCurve::new(problem.gap(gap, resolution)?, settings)))
            .collect::<Result<_, _>>()?;
        Ok(Self { problem, resolution, gaps })
    }

    /// Bends the strip to its final rotation; `None` if the gaps cannot be solved separately.
    fn bend(&mut self) -> Option<BentSample> {
        let end = self.end()?;
        let (measures, closing_range) = self.measures(end)?;
        let status = self.status(end);
        let is_complete = status == Status::Complete;
        Some(BentSample {
            status,
            measures: if is_complete { measures } else { measures.without_final_values() },
            closing_range,
            points: self.gaps.iter().map(|gap| gap.knots_to(end).len()).sum(),
            iterations: self.gaps.iter().map(|gap| gap.iterations).sum(),
        })
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

    /// Computes the measures of the strip bent up to the moment `end`.
    ///
    /// Also returns the width of the range of curvatures in which its gaps close.
    fn measures(&mut self, end: f64) -> Option<(FlexureMeasures, Option<f64>)> {
        let problem = self.problem;
        let closings = self.gaps.iter().filter_map(GapCurve::first_closing);
        let closings: Vec<_> = closings.filter(|closing| *closing <= end).collect();
        let first = closings.iter().copied().reduce(f64::min);
        let last = closings.iter().copied().reduce(f64::max);
        let locking = self.locking(end);
        [first, last, locking]
            .into_iter()
            .flatten()
            .try_for_each(|moment| self.solve_at(moment))?;
        // Without contact the stiffness is constant, so any moment serves.
        let stiffest = if first.is_some() { self.stiffest(end)? } else { 0.0 };
        let error = match self.resolution.finer() {
            // Without contact the membranes are arcs, which every resolution represents exactly.
            Some(_) if first.is_none() => Some(0.0),
            finer => finer.map(|finer| self.error(finer, stiffest, end)),
        };
        let friction_work = (problem.common.friction > 0.0)
            .then(|| self.gaps.iter_mut().map(|gap| gap.friction_work(end)).sum());
        let [first_contact, last_contact, locking] =
            [first, last, locking].map(|moment| Some(self.curvature(moment?)));
        let [compliance, initial_compliance] =
            [self.least_compliance(stiffest), self.compliance(0.0, KinkSide::Behind)]
                .map(|compliance| compliance * problem.bending_stiffness() / problem.length());
        let mut sums = Sums::default();
        self.knots(end).for_each(|(gap, knot)| sums.add(gap.strip(), knot));
        let gaps = self.gaps.iter();
        let measures = FlexureMeasures {
            compliance: Some(compliance),
            initial_compliance: Some(initial_compliance),
            contact: Some(first.is_some()),
            first_contact_curvature: first_contact,
            max_moment: Some(self.direction() * end / problem.bending_stiffness()),
            axial_energy_share: Some(sums.axial_energy / sums.energy),
            membrane_strain_max: gaps.clone().map(|gap| gap.largest_strain(end)).reduce(f64::max),
            error,
            friction_work,
            locking_curvature: locking,
            contact_curvature: problem.contact_curvature,
            gaps: problem.gaps,
            ..FlexureMeasures::default()
        };
        let closing_range = last_contact.zip(first_contact).map(|(last, first)| last - first);
        Some((measures.in_closed_form(problem.row.gap_fraction()), closing_range))
    }

    /// Finds the moment at which the strip reaches its final rotation.
    fn end(&mut self) -> Option<f64> {
        let whole = self.problem.end_rotation().abs();
        let mut highest = whole / self.compliance(0.0, KinkSide::Behind);
        for _ in 0..ROUNDS {
            self.gaps.iter_mut().try_for_each(|gap| gap.follow_to(highest))?;
            let moment = self.moment_at(whole, highest);
            let compliance = self.compliance(moment, KinkSide::Behind);
            if whole - self.rotation(moment) > CLOSE * moment * compliance {
                // The highest moment so far does not reach the final rotation.
                let missing = (whole - self.rotation(moment)) / compliance;
                highest += missing.min((FARTHER - 1.0) * highest);
                continue;
            }
            self.solve_at(moment)?;
            let off = whole - self.rotation(moment);
            if off.abs() <= CLOSE * moment * self.compliance(moment, KinkSide::Behind) {
                return Some(moment);
            }
        }
        None
    }

    /// Returns the curvature `κ*` of the strip under a moment.
    fn curvature(&self, moment: f64) -> f64 {
        self.direction() * self.rotation(moment) / self.problem.length()
    }

    /// Returns the moment at which the curves, interpolated by (F8), reach a rotation of the strip.
    ///
    /// Returns `highest` if the rotation is not reached up to this moment.
    fn moment_at(&self, rotation: f64, highest: f64) -> f64 {
        let at_highest = self.rotation(highest) - rotation;
        if at_highest <= 0.0 {
            return highest;
        }
        let mut bracket = Bracket::new((0.0, -rotation), (highest, at_highest));
        // Regula falsi may move only one end of the bracket, so stop when the iterate no longer
        // changes, not when the bracket is narrow.
        let mut moment = highest;
        for _ in 0..ROUNDS {
            let next = bracket.secant();
            let value = self.rotation(next) - rotation;
            if value == 0.0 || (next - moment).abs() <= f64::EPSILON * highest {
                return next;
            }
            bracket.narrow(next, value);
            moment = next;
        }
        moment
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
        }
        let breakpoints = self.breakpoints(end);
        let before = breakpoints.iter().rfind(|breakpoint| **breakpoint < best.0);
        let behind = breakpoints.iter().find(|breakpoint| **breakpoint > best.0);
        for (side, breakpoint) in [(KinkSide::Before, before), (KinkSide::Behind, behind)] {
            // If the best point is an event, check only its stiff side.
            let is_stiff = self.compliance(best.0, side) <= best.1 * (1.0 + FLAT);
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
    /// first gap are added as samples.
    fn breakpoints(&self, end: f64) -> Vec<f64> {
        let one = self.gaps.first().into_iter().flat_map(|gap| gap.knots_to(end));
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
            .map(|moment| (moment, self.compliance(moment, KinkSide::Before)));
        for _ in 0..SECTIONS {
            let is_below = inner[0].1 < inner[1].1;
            *(if is_below { &mut high } else { &mut low }) = inner[usize::from(is_below)].0;
            let step = golden * (high - low);
            let moment = if is_below { high - step } else { low + step };
            let value = (moment, self.compliance(moment, KinkSide::Before));
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
        let stiffened =
            self.compliance(0.0, KinkSide::Behind) / self.compliance(end, KinkSide::Behind);
        let knots = self.gaps.iter().flat_map(|gap| gap.knots_to(end));
        let changes = knots.filter(|knot| knot.is_event()).map(|knot| knot.moment);
        changes.reduce(f64::max).filter(|_| sticks && stiffened >= LOCKED)
    }

    /// Estimates the discretisation error at the moments `stiffest` and `end`.
    fn error(&self, finer: Resolution, stiffest: f64, end: f64) -> f64 {
        let moments = [stiffest, end].into_iter().skip(usize::from(stiffest == end));
        // If a state has no solution on the finer membrane, its error counts as infinite.
        moments
            .map(|moment| self.change(finer, moment).unwrap_or(f64::INFINITY))
            .fold(0.0, f64::max)
    }

    fn change(&self, finer: Resolution, moment: f64) -> Option<f64> {
        let (mut ours, mut theirs, mut newton) = (Sums::default(), Sums::default(), None);
        for (number, gap) in self.gaps.iter().enumerate() {
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

    /// Returns 1 with the scales on the inside of the bend, −1 with the scales on the outside.
    fn direction(&self) -> f64 {
        self.problem.end_rotation().signum()
    }

    fn rotation(&self, moment: f64) -> f64 {
        self.gaps.iter().map(|gap| gap.rotation(moment)).sum()
    }

    fn compliance(&self, moment: f64, side: KinkSide) -> f64 {
        self.gaps.iter().map(|gap| gap.compliance(moment, side)).sum()
    }

    /// Returns the smaller one of the compliances just below and just above a moment.
    fn least_compliance(&self, moment: f64) -> f64 {
        self.compliance(moment, KinkSide::Before).min(self.compliance(moment, KinkSide::Behind))
    }

    /// Iterates over the gaps, each with its equilibrium under a moment that was solved for.
    fn knots(&self, moment: f64) -> impl Iterator<Item = (&GapCurve, &Knot)> {
        self.gaps.iter().filter_map(move |gap| Some((gap, gap.knot(moment)?)))
    }
}

/// Returns the `(moment, value)` pair of lesser value; the first one if both are equal.
fn lesser(one: (f64, f64), other: (f64, f64)) -> (f64, f64) {
    if other.1 < one.1 { other } else { one }
}

/// Sums of quantities of all gaps under one moment; the strain is the largest of all gaps.
#[derive(Default)]
struct Sums {
    rotation: f64,
    compliance: f64,
    axial_energy: f64,
    energy: f64,
    strain: f64,
}

impl Sums {
    fn add(&mut self, strip: &Strip, knot: &Knot) {
        let state = &knot.point.state;
        let GapEnergies { axial, bending } = strip.membrane_energy(state);
        self.rotation += knot.rotation;
        self.compliance += knot.compliance();
        self.axial_energy += axial;
        self.energy += axial + bending + strip.contacts.energy(state);
        self.strain = self.strain.max(strip.largest_strain(state));
    }

    fn quantities(&self, moment: f64) -> Quantities {
        [moment, self.compliance.recip(), self.axial_energy / self.energy, self.strain]
    }
}

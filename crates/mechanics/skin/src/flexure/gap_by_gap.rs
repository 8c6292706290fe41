//! A strip whose gaps differ, bent gap by gap.

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

/// The moment is known where a correction of its rotation would change it by less than this part.
const CLOSE: f64 = 1e-12;

/// A search for the largest stiffness ends where it promises to gain less than this part of it.
const FLAT: f64 = 1e-11;

/// Part of the way to the next place at which it is looked whether the strip becomes stiffer still beside the stiffest one, and by which
/// part of it that counts.
const BESIDE: f64 = 1e-3;
const STIFFER: f64 = 1e-9;

/// Rounds after which a search has failed. Few need a quarter of them.
const ROUNDS: usize = 50;

/// By how much the moment is raised at most before the gaps are asked again: where they close, their slopes say too much.
const FARTHER: f64 = 2.0;

/// Steps of gaps that rub are so many times as short.
const RUBBING: f64 = 4.0;

/// Places within a segment at which the largest stiffness is looked for, before it is solved for: golden sections.
const SECTIONS: usize = 30;

/// A sample of an imperfect strip that was bent.
#[derive(Clone, Copy, Debug)]
pub struct BentSample {
    /// How the path ended, and whether its end can be trusted.
    pub status: Status,
    /// The measures of the bending.
    pub measures: FlexureMeasures,
    /// As [`Flexure::closing_range`].
    pub closing_range: Option<f64>,
    /// Equilibria of the path of the strip, or of the paths of its gaps.
    pub points: usize,
    /// Newton iterations along them.
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

/// Bends a strip gap by gap. In pure bending every cut carries the same moment and no force, so a gap knows of the others by the moment
/// alone, and under a moment that only grows their rotations and compliances add up:
///
/// ```text
/// Φ(M) = Σ θᵢ(M),    dΦ/dM = Σ dθᵢ/dM                                                       (F7)
/// ```
///
/// `None` where a gap does not bear the moment to which the strip bends, or turns back before: then the gaps act on each other, and the
/// chain of all has to be solved.
pub(super) fn solve(problem: &FlexureProblem) -> Result<Option<BentSample>, OutOfRange> {
    let mut resolution = problem.coarsest();
    loop {
        let mut strip = UnevenStrip::new(problem, resolution)?;
        let Some(bent) = strip.bend() else { return Ok(None) };
        let Some(finer) = resolution.better(bent.measures.error) else { return Ok(Some(bent)) };
        resolution = finer;
    }
}

/// The gaps of a strip, and the sums over them.
struct UnevenStrip<'a> {
    problem: &'a FlexureProblem<'a>,
    resolution: Resolution,
    gaps: Vec<GapCurve>,
}

impl<'a> UnevenStrip<'a> {
    fn new(problem: &'a FlexureProblem, resolution: Resolution) -> Result<Self, OutOfRange> {
        let mut settings = problem.common.solver;
        if problem.common.friction > 0.0 {
            // The work of friction is as good as steps are short. The chain of all has a point for every event of any gap.
            settings.max_step /= RUBBING;
        }
        let curve = |gap| Ok(GapCurve::new(problem.gap(gap, resolution)?, settings));
        let gaps = (0..problem.solved).map(curve).collect::<Result<_, _>>()?;
        Ok(Self { problem, resolution, gaps })
    }

    /// Bends the strip to its end. `None` where the gaps cannot be solved apart.
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

    /// The status of the strip under a moment at which its bending ends.
    fn status(&self, end: f64) -> Status {
        let audited =
            self.knots(end).map(|(gap, knot)| Status::audited(gap.strip(), &knot.point.state));
        // As of the chain of all: that scales are within each other says more than that one is beyond an edge.
        let worst = |one, other| {
            if one == Status::Complete || other == Status::Interpenetration { other } else { one }
        };
        audited.fold(Status::Complete, worst)
    }

    /// The measures of a strip that bends up to a moment, and the range of curvatures over which its gaps close.
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
        // Before scales touch the strip bends to arcs, as stiff everywhere as at rest: there is no maximum to look for.
        let stiffest = if first.is_some() { self.stiffest(end)? } else { 0.0 };
        let error = match self.resolution.finer() {
            // Arcs are exact in every resolution.
            Some(_) if first.is_none() => Some(0.0),
            finer => finer.map(|finer| self.error(finer, stiffest, end)),
        };
        let rotated = |moment: f64| self.direction() * self.rotation(moment);
        let curvature = |moment: Option<f64>| Some(rotated(moment?) / problem.length());
        let of_strip =
            |compliance: f64| compliance * problem.bending_stiffness() / problem.length();
        let mut sums = Sums::default();
        self.knots(end).for_each(|(gap, knot)| sums.add(gap.strip(), knot));
        let gaps = self.gaps.iter();
        let measures = FlexureMeasures {
            compliance: Some(of_strip(self.least_compliance(stiffest))),
            initial_compliance: Some(of_strip(self.compliance(0.0, KinkSide::Behind))),
            contact: Some(first.is_some()),
            first_contact_curvature: curvature(first),
            max_moment: Some(self.direction() * end / problem.bending_stiffness()),
            axial_energy_share: Some(sums.axial_energy / sums.energy),
            membrane_strain_max: gaps.clone().map(|gap| gap.largest_strain(end)).reduce(f64::max),
            error,
            friction_work: (problem.common.friction > 0.0)
                .then(|| gaps.map(|gap| gap.friction_work(end)).sum()),
            locking_curvature: curvature(locking),
            contact_curvature: problem.contact_curvature,
            gaps: problem.gaps,
            ..FlexureMeasures::default()
        };
        let closing_range = curvature(last).zip(curvature(first)).map(|(last, first)| last - first);
        Some((measures.in_closed_form(problem.row.share_of_gaps()), closing_range))
    }

    /// The moment under which the strip has turned as far as it is to be bent.
    fn end(&mut self) -> Option<f64> {
        let whole = self.problem.end_rotation().abs();
        let mut highest = whole / self.compliance(0.0, KinkSide::Behind);
        for _ in 0..ROUNDS {
            self.gaps.iter_mut().try_for_each(|gap| gap.follow_to(highest))?;
            let moment = self.moment_at(whole, highest);
            let compliance = self.compliance(moment, KinkSide::Behind);
            if whole - self.rotation(moment) > CLOSE * moment * compliance {
                // Even the highest moment does not turn it so far.
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

    /// The moment of a rotation, about (F8); the highest one where that does not turn the strip so far.
    fn moment_at(&self, rotation: f64, highest: f64) -> f64 {
        let off = |moment: f64| self.rotation(moment) - rotation;
        let at_highest = off(highest);
        if at_highest <= 0.0 {
            return highest;
        }
        let mut bracket = Bracket::new((0.0, -rotation), (highest, at_highest));
        // The false position nears from one side: it is done where it stands still, not where the bracket is narrow.
        let mut moment = highest;
        for _ in 0..ROUNDS {
            let next = bracket.secant();
            let value = off(next);
            if value == 0.0 || (next - moment).abs() <= f64::EPSILON * highest {
                return next;
            }
            bracket.narrow(next, value);
            moment = next;
        }
        moment
    }

    /// The moment at which the strip is stiffest, solved for. `None` where that is no event and not the end, but a place between, which
    /// (F8) does not find.
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
        let places = self.places(end);
        let before = places.iter().rfind(|place| **place < best.0);
        let behind = places.iter().find(|place| **place > best.0);
        for (side, place) in [(KinkSide::Before, before), (KinkSide::Behind, behind)] {
            // At an event the strip may be softer on one side anyway.
            let is_stiff = self.compliance(best.0, side) <= best.1 * (1.0 + FLAT);
            if let Some(place) = place.filter(|_| is_stiff) {
                let beside = best.0 + BESIDE * (place - best.0);
                self.solve_at(beside)?;
                if self.least_compliance(beside) < best.1 * (1.0 - STIFFER) {
                    return None;
                }
            }
        }
        Some(best.0)
    }

    /// Moments between which the compliance is smooth. Between events the sum is as smooth as one of its terms: the equilibria of one gap
    /// are places enough.
    fn places(&self, end: f64) -> Vec<f64> {
        let one = self.gaps.first().into_iter().flat_map(|gap| gap.knots_to(end));
        let all = self.gaps.iter().flat_map(|gap| gap.knots_to(end));
        let places = one.chain(all.filter(|knot| knot.is_event())).map(|knot| knot.moment);
        let mut places: Vec<_> = places.collect();
        places.sort_unstable_by(f64::total_cmp);
        places.dedup();
        places
    }

    /// Where the compliance is least, about (F8), and how large it is there.
    fn promising(&self, end: f64) -> (f64, f64) {
        let places = self.places(end);
        let less = |one: (f64, f64), other: (f64, f64)| if other.1 < one.1 { other } else { one };
        let found = places.iter().map(|&moment| (moment, self.least_compliance(moment)));
        let best = found.reduce(less).unwrap_or((0.0, f64::INFINITY));
        let number = places.partition_point(|moment| *moment < best.0);
        let beside = places[number.saturating_sub(1)..].windows(2).take(2);
        let inside = beside.map(|segment| self.least_within([segment[0], segment[1]]));
        // Of what is the same up to round-off the place that is known.
        inside.filter(|(_, value)| *value < best.1 * (1.0 - FLAT)).fold(best, less)
    }

    /// The least compliance between two neighbouring moments of the gaps, by golden sections.
    fn least_within(&self, [mut low, mut high]: [f64; 2]) -> (f64, f64) {
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let value = |moment: f64| (moment, self.compliance(moment, KinkSide::Before));
        let mut inner = [high - golden * (high - low), low + golden * (high - low)].map(value);
        for _ in 0..SECTIONS {
            if inner[0].1 < inner[1].1 {
                high = inner[1].0;
                inner = [value(high - golden * (high - low)), inner[0]];
            } else {
                low = inner[0].0;
                inner = [inner[1], value(low + golden * (high - low))];
            }
        }
        if inner[0].1 < inner[1].1 { inner[0] } else { inner[1] }
    }

    /// The moment of the last change of a contact, if contacts stick at the end and hold the strip.
    fn locking(&self, end: f64) -> Option<f64> {
        let sticks =
            self.knots(end).any(|(_, knot)| Contacts::stick_slip_counts(&knot.point.state)[0] > 0);
        let stiffened =
            self.compliance(0.0, KinkSide::Behind) / self.compliance(end, KinkSide::Behind);
        let knots = self.gaps.iter().flat_map(|gap| gap.knots_to(end));
        let changes = knots.filter(|knot| knot.is_event()).map(|knot| knot.moment);
        changes.reduce(f64::max).filter(|_| sticks && stiffened >= LOCKED)
    }

    /// The largest change of any measure with a finer resolution, under the moment at which the strip is stiffest and at its end.
    fn error(&self, finer: Resolution, stiffest: f64, end: f64) -> f64 {
        let moments = [stiffest, end].into_iter().skip(usize::from(stiffest == end));
        // A state that cannot be solved with the finer resolution is not resolved.
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
        // Both are compared where the ends have turned alike.
        let theirs_there = moment - (theirs.rotation - ours.rotation) / theirs.compliance;
        largest_change(ours.quantities(moment), theirs.quantities(theirs_there))
    }

    /// Solves all gaps under a moment that they have borne.
    fn solve_at(&mut self, moment: f64) -> Option<()> {
        self.gaps.iter_mut().try_for_each(|gap| gap.solve_at(moment))
    }

    /// 1, or −1 where the strip bends to the outside.
    fn direction(&self) -> f64 {
        self.problem.end_rotation().signum()
    }

    fn rotation(&self, moment: f64) -> f64 {
        self.gaps.iter().map(|gap| gap.rotation(moment)).sum()
    }

    fn compliance(&self, moment: f64, side: KinkSide) -> f64 {
        self.gaps.iter().map(|gap| gap.compliance(moment, side)).sum()
    }

    /// The lesser of the compliances on either side of a moment.
    fn least_compliance(&self, moment: f64) -> f64 {
        self.compliance(moment, KinkSide::Before).min(self.compliance(moment, KinkSide::Behind))
    }

    /// The gaps with their equilibria under a moment that was solved for.
    fn knots(&self, moment: f64) -> impl Iterator<Item = (&GapCurve, &Knot)> {
        self.gaps.iter().filter_map(move |gap| Some((gap, gap.knot(moment)?)))
    }
}

/// What adds up over the gaps under one moment; of the strain the largest counts.
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

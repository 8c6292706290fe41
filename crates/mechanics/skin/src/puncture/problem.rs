//! Setup of a puncture and the solution of its path.

use contact::ContactLaw;
use geometry::OutOfRange;
use solver::{Continuation, Settings, Termination};
use substrate::{FarField, RowStiffness, SubstrateLaw};

use super::adaptive_row::AdaptiveRowPath;
use super::bending::BENDING_UNKNOWNS;
use super::load_positions::LoadPositions;
use super::needle::{self, NEEDLE_UNKNOWNS};
use super::observers::PathObservers;
use super::point::scales;
use super::row_exterior::{Beyond, RowExterior};
use super::row_layout::RowLayout;
use super::rows::Rows;
use super::surface_fold::FoldObserver;
use super::system::Chain;
use super::{
    At, Bending, CriticalEvent, DIRECT_STIFFNESS, FailureMode, LONGEST_ROW, Passage, Puncture,
    PunctureEnd, PunctureInput, PunctureMeasures, PunctureParameters, PuncturePoint, RowLength,
    TIP_REACH, TiltMeasures, Weakest, ending, failure, overlaps_at_rest,
};
use crate::contacts::pair_constraints;
use crate::path_location::PointLocator;
use crate::record::{PathFunction, Record};
use crate::{Common, Design, Status, Unloading};

/// Tilt below which the punctured scale counts as not tilted, degrees.
///
/// It is larger than the round-off of a symmetric row.
const STRAIGHT_DEG: f64 = 1e-6;

/// Factors of the largest step for the second and third attempt to follow a path.
const FINER_STEPS: [f64; 2] = [0.25, 0.05];

/// Final depth, divided by the largest depth, up to which a path counts as back at rest.
const NEAR_REST: f64 = 0.01;

/// Largest distance between scales that may touch each other, in pitches.
///
/// Contacts over more than 3 pitches were never observed. Each additional pitch adds six unknowns
/// for each scale.
const FARTHEST_CONTACT: usize = 8;

/// A path followed to its end.
pub(super) struct Followed {
    /// Points and quantities recorded along the path.
    pub(super) watch: PathObservers,
    pub(super) passage: Passage,
    pub(super) path: Continuation<Chain>,
    pub(super) status: Status,
}

impl Followed {
    /// Returns true if the path reversed and ended close to the state of rest.
    fn is_back_at_rest(&self) -> bool {
        if !matches!(self.status, Status::Stopped(Termination::Unloaded | Termination::Jumps)) {
            return false;
        }
        let path = &self.watch.record.path;
        let farthest = path.iter().map(|point| point.displacement.abs()).fold(0.0, f64::max);
        path.last().is_some_and(|last| last.displacement.abs() <= NEAR_REST * farthest)
    }

    /// Builds the result of the puncture.
    ///
    /// If `unload` is true and the path is complete, the unloading path is followed as well.
    pub(super) fn puncture(self, unload: bool) -> Puncture {
        let Self { watch, passage, mut path, status } = self;
        let PathObservers { record, snaps, folds, failure, tilts, depth, force, .. } = watch;
        let at_tip = watch.passage;
        let FoldObserver { folds, .. } = folds;
        let path = &mut path;
        let mut measures = PunctureMeasures::new(&record, &folds, path);
        measures.passage = passage;
        if let Some(failure) = failure {
            let at_end = failure_at_end(status, passage.critical_event);
            measures.failure = failure.measures(path, at_end);
        }
        add_requested(&mut measures, [&depth, &force], path, status);
        let (instability, snaps) = if path.system().is_critical_only() {
            (Vec::new(), Vec::new())
        } else {
            snaps.finish(path, &mut measures)
        };
        let mut measures = match status {
            Status::Complete => measures,
            _ => measures.without_final_values(),
        };
        let chain = path.system();
        let scales = scales(chain, &path.point().state);
        // Tip forces are recorded when the path leaves a point, so those at the end are missing.
        let mut tip_forces = at_tip.tip_forces;
        tip_forces.extend(chain.tip_forces(&path.point().state));
        let at_tilts = tilts
            .points
            .into_iter()
            .map(|point| Some(TiltMeasures::new(chain, &point?.state)))
            .collect();
        let Record { path: points, events, history, work, .. } = record;
        // Unload last: unloading moves the path away from the end, which has been evaluated above.
        let unloading =
            (unload && status == Status::Complete).then(|| Unloading::follow(path, work));
        if let Some(unloading) = &unloading {
            measures.remains = unloading.remains(|point: &PuncturePoint| point.displacement);
        }
        Puncture {
            status,
            measures,
            at_tilts,
            path: points,
            instability,
            tip_forces,
            events,
            snaps,
            folds,
            scales,
            history,
            unloading,
            places: Vec::new(),
            end: None,
        }
    }
}

/// Adds the force at the requested `depth`, and the pressure at the requested `force`.
fn add_requested(
    measures: &mut PunctureMeasures,
    [depth, force]: [&PointLocator<Chain>; 2],
    path: &Continuation<Chain>,
    status: Status,
) {
    let loaded = force.points.first().and_then(Option::as_ref);
    measures.tissue_pressure_at_force =
        loaded.map(|point| path.system().tissue_pressure(&point.state));
    measures.force_at_depth = depth.points.first().and_then(|deep| {
        // If the critical tilt comes before this depth, report the force at the critical tilt.
        let end = Some(path.point()).filter(|_| status == Status::Complete);
        Some(path.system().force(&deep.as_ref().or(end)?.state))
    });
}

/// Returns the mode of failure at the end of a path; `None` if the path ended early.
fn failure_at_end(status: Status, event: Option<CriticalEvent>) -> Option<FailureMode> {
    match status {
        Status::Complete => Some(event.map_or(FailureMode::Tilt, FailureMode::from)),
        Status::Bent => Some(FailureMode::Bend),
        _ => None,
    }
}

/// A puncture to be solved: row, substrate, contact law and parameters.
pub(super) struct Problem<'a> {
    pub(super) rows: Rows<'a>,
    pub(super) design: &'a Design,
    pub(super) stiffness: RowStiffness,
    /// Far field beyond the solved part of an endless row, lengths in units of `t`.
    ///
    /// `None` for a finite row.
    pub(super) endless: Option<FarField>,
    pub(super) law: ContactLaw,
    pub(super) common: Common,
    pub(super) parameters: &'a PunctureParameters,
}

impl<'a> Problem<'a> {
    pub(super) fn new(
        rows: Rows<'a>,
        design: &'a Design,
        stiffness: RowStiffness,
        common: &Common,
        parameters: &'a PunctureParameters,
    ) -> Result<Self, OutOfRange> {
        parameters.check()?;
        let (curvature, overlap) =
            (parameters.curvature, overlaps_at_rest(design, parameters.body())?);
        let expected = "a curvature at which neighbouring scales do not overlap at rest";
        OutOfRange::unless(!overlap, "curvature of the body", curvature, expected)?;
        let is_rigid = parameters.bending == Bending::Rigid;
        let friction = common.friction;
        let expected = "0 for elastic scales";
        OutOfRange::unless(is_rigid || friction == 0.0, "friction of scales", friction, expected)?;
        let is_guided = parameters.needle.is_guided();
        let (name, expected) = ("guided needle", "0 (a free needle) with elastic scales");
        OutOfRange::unless(is_rigid || !is_guided, name, f64::from(is_guided), expected)?;
        Self::unchecked(rows, design, stiffness, common, parameters)
    }

    /// Sets up the problem of an even row.
    pub(super) fn of_input(input: &'a PunctureInput) -> Result<Self, OutOfRange> {
        let PunctureInput { design, stiffness, common, parameters, .. } = input;
        Self::new(Rows::Even(design.row()?), design, stiffness.clone(), common, parameters)
    }

    /// Sets up the problem without checking the ranges of the parameters.
    ///
    /// Difference quotients at the end of a range need values slightly beyond it.
    pub(super) fn unchecked(
        rows: Rows<'a>,
        design: &'a Design,
        stiffness: RowStiffness,
        common: &Common,
        parameters: &'a PunctureParameters,
    ) -> Result<Self, OutOfRange> {
        // The modulus ratio refers to `E_s`, forces to `E* = E_s/(1 − ν²)`.
        let plane_modulus = 1.0 - parameters.poisson_ratio.powi(2);
        let modulus = parameters.contact_modulus_over_substrate * plane_modulus;
        let law = ContactLaw::new(common.law, design.length, design.width, modulus)?
            .with_friction(common.friction)?;
        let endless = match parameters.scales {
            RowLength::Auto => Some(far_field(design, &stiffness, None).ok_or(OutOfRange {
                quantity: DIRECT_STIFFNESS,
                value: stiffness.direct[0],
                expected: "more than its couplings with all neighbours together",
            })?),
            RowLength::Scales(_) => None,
        };
        let common = *common;
        let problem = Self { rows, design, stiffness, endless, law, common, parameters };
        let radius_over_pitch = parameters.needle_radius.map(|radius| radius / problem.pitch());
        let is_in_reach = radius_over_pitch.is_none() || problem.reach().is_some();
        OutOfRange::unless(is_in_reach, TIP_REACH, radius_over_pitch.unwrap_or(0.0), "at most 62")?;
        Ok(problem)
    }

    pub(super) fn solve(&self) -> Result<Puncture, OutOfRange> {
        self.result(self.follow(&[], &[])?)
    }

    /// Builds the result of a path that was followed from rest.
    pub(super) fn result(&self, followed: Followed) -> Result<Puncture, OutOfRange> {
        let end = PunctureEnd::new(self, &followed);
        self.with_positions(followed, end, None)
    }

    /// Builds the result of a path, with the punctures at other load positions.
    ///
    /// Each of these punctures starts from the end of a similar design in `near`, if possible.
    pub(super) fn with_positions(
        &self,
        followed: Followed,
        end: Option<PunctureEnd>,
        near: Option<&PunctureEnd>,
    ) -> Result<Puncture, OutOfRange> {
        let LoadPositions { places, ends } =
            self.load_positions(Some((&followed, end.as_ref())), near)?;
        let mut puncture = followed.puncture(self.parameters.unload);
        puncture.measures.weakest = Weakest::from_positions(&places).unwrap_or_default();
        Ok(Puncture { end: end.map(|end| end.with_places(ends)), places, ..puncture })
    }

    /// Builds the initial system; also returns the largest number of scales of the solved part.
    ///
    /// A scale may touch the nearest `contact_reach` scales on its right.
    pub(super) fn start(&self, contact_reach: usize) -> Result<(Chain, usize), OutOfRange> {
        let contacts = contact_reach * pair_constraints(&self.law);
        let Some(whole) = self.whole() else {
            let first = self.endless.as_ref().map(|far| self.first_layout(far, contacts));
            return Ok((self.part(first.unwrap_or_default())?, LONGEST_ROW));
        };
        // The far field of a finite row exists only for coupling with direct neighbours, and it
        // replaces neo-Hookean bars only approximately. Solve the whole row in these cases.
        let is_linear = self.parameters.substrate_law == SubstrateLaw::Linear;
        let far = self.far_field(Some(1)).filter(|_| is_linear);
        let layout = far.map_or(whole, |far| self.first_layout(&far, contacts).within(whole));
        Ok((self.part(RowLayout { contacts, ..layout })?, whole.scales()))
    }

    /// Returns the initial layout of the solved part of a row with a far field beyond it.
    fn first_layout(&self, far: &FarField, contacts: usize) -> RowLayout {
        let (neighbours, law) = (self.stiffness.neighbours.len(), self.parameters.substrate_law);
        let layout = RowLayout::first(far, neighbours, law);
        let layout = layout.at_least(self.reach().map_or(0, |reach| reach + 1));
        RowLayout { needle: self.needle_unknowns(), contacts, ..layout }
    }

    /// Counts the unknowns of the needle or of elastic scales, which follow the load.
    fn needle_unknowns(&self) -> usize {
        match self.reach() {
            Some(reach) => needle::unknowns(reach, self.parameters.needle.has_friction()),
            None if self.parameters.needle.is_guided() => NEEDLE_UNKNOWNS,
            None if self.parameters.bending == Bending::Elastic => BENDING_UNKNOWNS,
            None => 0,
        }
    }

    /// Returns the number of scales on each side that a round tip may reach.
    ///
    /// `None` for other needles.
    pub(super) fn reach(&self) -> Option<usize> {
        self.parameters.needle_radius.and_then(|radius| needle::reach(radius, self.pitch()))
    }

    /// Returns the distance between neighbouring nodes along the body, in units of `t`.
    pub(super) fn pitch(&self) -> f64 {
        2.0 * self.design.half_base() + self.design.gap
    }

    /// Returns the layout of a whole finite row; `None` for a row without ends.
    ///
    /// On a curved body a row ends where its normals turn by more than 80° from the load.
    pub(super) fn whole(&self) -> Option<RowLayout> {
        let on_body = self.parameters.body().scales_beside(self.pitch());
        let sides = match self.parameters.scales {
            RowLength::Scales(scales) => {
                // An even number of scales leaves one more scale on the right than on the left.
                let left = (scales - 1) / 2;
                let right = scales - 1 - left;
                let on_body = on_body.unwrap_or(scales);
                Some([left.min(on_body), right.min(on_body)])
            }
            // A row on a body with room for more scales than the longest row counts as endless.
            RowLength::Auto => on_body.filter(|side| 2 * side < LONGEST_ROW).map(|side| [side; 2]),
        };
        let (needle, contacts) = (self.needle_unknowns(), 0);
        sides.map(|[left, right]| RowLayout { left, right, needle, contacts })
    }

    /// Follows the path of the puncture, and repeats this with smaller steps if it returns to rest.
    ///
    /// Only one branch leaves the state at rest, so a path that returns to rest has reversed at an
    /// event, where round-off decided on its direction.
    pub(super) fn follow(
        &self,
        functions: &[PathFunction<Chain>],
        requested: &[At],
    ) -> Result<Followed, OutOfRange> {
        let mut followed = self.follow_once(functions, requested)?;
        for factor in FINER_STEPS {
            if !followed.is_back_at_rest() {
                break;
            }
            let max_step = factor * self.common.solver.max_step;
            let solver = Settings { max_step, ..self.common.solver };
            let common = Common { solver, ..self.common };
            let (stiffness, endless) = (self.stiffness.clone(), self.endless.clone());
            let finer = Problem { stiffness, endless, common, ..*self };
            followed = finer.follow_once(functions, requested)?;
        }
        Ok(followed)
    }

    /// Follows the path until it ends, and locates the `requested` points.
    ///
    /// Initially each scale may touch its direct neighbours. If the audit finds overlap with a more
    /// distant scale, which happens in at most one row in a hundred, the path is followed again
    /// with a larger contact reach. Using the larger reach from the start would multiply the run
    /// time of every path.
    fn follow_once(
        &self,
        functions: &[PathFunction<Chain>],
        requested: &[At],
    ) -> Result<Followed, OutOfRange> {
        let mut contact_reach = 1;
        loop {
            let (start, longest) = self.start(contact_reach)?;
            let followed = self.follow_row(start, longest, functions, requested)?;
            let path = &followed.path;
            let beyond = match followed.status {
                Status::Interpenetration => {
                    path.system().contacts.overlapping_beyond_reach(&path.point().state)
                }
                _ => None,
            };
            match beyond.filter(|&pitches| pitches <= FARTHEST_CONTACT) {
                // The audit finds overlaps only beyond the contact reach, so the reach grows in
                // every iteration.
                Some(pitches) => contact_reach = pitches,
                None => return Ok(followed),
            }
        }
    }

    /// Returns true if the load is in the middle of a scale of an even, upright row.
    ///
    /// Such a load pushes the scale straight down. At a bifurcation only round-off can make the
    /// path leave this symmetric branch.
    fn is_balanced(&self) -> bool {
        matches!(self.rows, Rows::Even(_))
            && self.design.slant_deg == 0.0
            && self.parameters.load_position == 0.5
    }

    /// Follows the path of a row until it ends.
    ///
    /// The solved part may grow up to `longest` scales.
    pub(super) fn follow_row(
        &self,
        chain: Chain,
        longest: usize,
        functions: &[PathFunction<Chain>],
        requested: &[At],
    ) -> Result<Followed, OutOfRange> {
        let mut growing = AdaptiveRowPath::new(self, chain, longest);
        let mut watch = PathObservers::new(&growing.path, self.parameters, functions, requested);
        let mut is_bent = false;
        while let Some(mut segment) = growing.next()? {
            if let Some(bent) = failure::bent_within(&mut growing.path, &segment) {
                let chain = growing.path.system().clone();
                growing.path.continue_with(chain, bent);
                (segment.to, is_bent) = (growing.path.point().clone(), true);
            }
            watch.follow(&mut growing.path, &segment);
            if is_bent {
                break;
            }
        }
        // Extend the points recorded on shorter rows: from here on they are evaluated with the
        // equations of the final row.
        watch.lengthen(&growing);
        let path = growing.path;
        let mut passage = watch.passage.finish(path.system(), &path.point().state);
        let is_untilted = self.is_balanced()
            || (self.parameters.needle.is_guided() && passage.critical_event.is_none());
        // The path of a scale that is pushed straight down may stop at a bifurcation.
        let points = &watch.record.path;
        let is_straight =
            || points.len() > 1 && points.iter().all(|at| at.tilt_deg.abs() < STRAIGHT_DEG);
        let status = match Status::of(&path, path.termination().unwrap_or(Termination::Reached)) {
            // A row that should have grown further has no valid end.
            _ if !growing.is_long_enough => Status::RowLimit,
            _ if is_bent => Status::Bent,
            Status::Complete if path.system().ends_at_a_corner(&path.point().state) => {
                Status::OffEdge
            }
            // An upright scale loaded in its middle does not tilt even in the first step.
            Status::Stopped(Termination::Singular) if watch.record.path.len() == 1 => {
                Status::Untilted
            }
            Status::Complete if is_untilted => Status::Untilted,
            Status::Stopped(Termination::NoConvergence | Termination::Jumps)
                if passage.critical_event.is_none() && is_straight() =>
            {
                Status::Untilted
            }
            status => ending::classify(status, &watch.record.path),
        };
        // If the load returns to zero as the tip reaches the foot of a face, the path ends early
        // and the needle is not through.
        passage.critical_event = passage.critical_event.filter(|_| status == Status::Complete);
        Ok(Followed { watch, passage, path, status })
    }

    /// Builds the system of the part of the row with this `layout`.
    pub(super) fn part(&self, layout: RowLayout) -> Result<Chain, OutOfRange> {
        let whole = self.whole();
        let scales = [
            whole.map(|whole| whole.left - layout.left),
            whole.map(|whole| whole.right - layout.right),
        ];
        let beyond = scales.map(|scales| match scales {
            Some(0) => None,
            _ => Some(Beyond { far: self.far_field(scales)?, scales }),
        });
        let Self { design, stiffness, law, parameters, .. } = self;
        let exterior = RowExterior::new(self.rows, layout, beyond, parameters.body())?;
        let row = self.rows.row(layout)?;
        let mut chain = Chain::new(row, stiffness, *law, layout, exterior, parameters, design);
        chain.detail = self.common.detail;
        Ok(chain)
    }

    /// Computes the far field of the scales beyond one end of the solved part.
    ///
    /// `scales` is their number, or `None` for an infinite row. Returns `None` if the far field
    /// has no closed form.
    pub(super) fn far_field(&self, scales: Option<usize>) -> Option<FarField> {
        match scales {
            // The infinite far field does not depend on the solved part, so it is computed once.
            None => self.endless.clone(),
            _ => far_field(self.design, &self.stiffness, scales),
        }
    }
}

/// Computes the far field of `scales` scales, or of an infinite row for `None`.
///
/// Lengths are in units of `t`. Returns `None` without a closed form.
fn far_field(design: &Design, stiffness: &RowStiffness, scales: Option<usize>) -> Option<FarField> {
    stiffness.with_lengths_over(design.half_base()).far_field(scales)
}

//! Puncture of a row of scales on an elastic half-space.

mod adaptive_row;
mod beam;
mod bending;
mod ending;
mod failure;
mod load_positions;
mod measures;
mod needle;
mod neo_hookean;
mod number_list;
mod observers;
mod path_end;
mod point;
mod row_exterior;
mod sensitivity;
mod single_scale;
mod snap;
mod snapshot;
mod stability;
mod surface_fold;
mod system;
#[cfg(test)]
mod tests;
mod tilts;

use adaptive_row::AdaptiveRowPath;
use bending::BENDING_UNKNOWNS;
use contact::{ContactLaw, Pose, overlaps};
use geometry::{Body, OutOfRange, Row};
use needle::NEEDLE_UNKNOWNS;
use observers::PathObservers;
use point::scales;
use row_exterior::{Beyond, RowExterior};
use solver::{Continuation, Settings, Termination};
use substrate::{FarField, RowStiffness, SubstrateLaw};
use surface_fold::FoldObserver;
use system::{Chain, RowLayout};

use crate::arrangement::Arrangement;
use crate::contacts::pair_constraints;
use crate::record::{ContactEvent, Iteration, PathFunction, Record};
use crate::{Common, Design, PathDetail, Sample, Status, Unloading};

pub use failure::{FailureMeasures, FailureMode, Strengths};
pub use load_positions::{LoadPosition, Weakest, load_positions};
pub use measures::{AcrossMeasures, BetweenMeasures, PunctureMeasures};
pub(crate) use needle::NeedleMode;
pub use needle::{CriticalEvent, Needle, Passage, TipForces};
pub use number_list::{MOST_NUMBERS, NumberList};
pub use path_end::{PunctureEnd, differentiate_near, solve_near};
pub use point::{PuncturePoint, ScaleState};
pub use sensitivity::{PunctureInput, differentiate, force_curve, unloading_curve};
pub use single_scale::PerturbedScale;
pub use snap::Snap;
pub use snapshot::{At, RowSnapshot, Snapshots, snapshots, snapshots_to_end};
pub use stability::Instability;
pub use surface_fold::{Fold, GapStretch};
pub use tilts::TiltMeasures;

/// Tilt below which a scale under a guided needle counts as not tilted, degrees.
///
/// It covers the round-off of a symmetric row.
const STRAIGHT_DEG: f64 = 1e-6;

/// Factors on the largest step with which a path is followed again, in turn.
const FINER_STEPS: [f64; 2] = [0.25, 0.05];

/// Depth, relative to the largest one, below which a path is back at rest.
const NEAR_REST: f64 = 0.01;

/// Quantity of the error for a round tip that reaches over too many scales.
pub const TIP_REACH: &str = "radius of the needle over the pitch of the row";

/// Quantity of the error for a row with displacements that do not decay.
pub const DIRECT_STIFFNESS: &str = "direct stiffness of the substrate";

/// Longest row of [`RowLength::Auto`].
pub const LONGEST_ROW: usize = 4001;

/// Largest distance in pitches of touching scales.
///
/// None beyond 3 were observed, and each pitch adds six unknowns per scale.
const FARTHEST_CONTACT: usize = 8;

/// Response of the scales to the forces on them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bending {
    /// Scales are rigid, as in the paper.
    #[default]
    Rigid,
    /// Scales bend as linear beams with the modulus `E_ct`.
    ///
    /// The path ends where a tip has turned by 5° relative to its base.
    Elastic,
}

/// Number of scales in the row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowLength {
    /// A row without ends.
    ///
    /// The scales within reach of contact are unknowns, more as contact spreads along the path; the
    /// scales beyond follow in closed form as a linear chain. Without such a closed form the row
    /// grows until its ends move by at most `1e-6`.
    Auto,
    /// This many, with the middle one (the left of two) punctured.
    Scales(usize),
}

/// Parameters of a puncture other than design and substrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunctureParameters {
    /// Poisson's ratio `ν` of the substrate.
    pub poisson_ratio: f64,
    /// `E_ct / E_s`.
    pub contact_modulus_over_substrate: f64,
    /// Row length.
    pub scales: RowLength,
    /// Load position on the top of the punctured scale: 0 the left, 1 the right corner.
    ///
    /// A round tip may be beyond, between two scales.
    pub load_position: f64,
    /// Critical tilt `φ_c` of the punctured scale at which the puncture ends, degrees.
    pub critical_tilt_deg: f64,
    /// Constitutive law of the substrate surface between two bases.
    pub substrate_law: SubstrateLaw,
    /// Smaller critical tilts at which measures are also taken, degrees.
    ///
    /// `critical_tilt_deg` is added to them. `None`: no measures at tilts.
    pub tilts_before_deg: Option<NumberList>,
    /// Constraint on the needle.
    pub needle: Needle,
    /// Tip radius of a guided needle, over `t`; `None` for a sharp one.
    pub needle_radius: Option<f64>,
    /// Depth `u*` at which to report the force as well.
    pub depth: Option<f64>,
    /// Force `F*` at which to report the pressure on the tissue as well.
    pub force: Option<f64>,
    /// True to remove the load again at the end.
    pub unload: bool,
    /// Strengths of scales and bonds, if the first failure is sought.
    pub failure: Option<Strengths>,
    /// Number of load positions to compare, at least two.
    ///
    /// They span the top from its left to its right corner, or one pitch for a round tip.
    pub places: Option<usize>,
    /// Curvature `t/R` of the body below: positive for a convex one, 0 for a flat one.
    pub curvature: f64,
    /// Rigid or elastic scales.
    pub bending: Bending,
}

impl Default for PunctureParameters {
    /// Values of Shafiei et al. (2021).
    ///
    /// `E_ct = 3 GPa` on a substrate of `E_s = 310 kPa`.
    fn default() -> Self {
        Self {
            poisson_ratio: 0.5,
            contact_modulus_over_substrate: 9677.0,
            scales: RowLength::Auto,
            load_position: 1.0,
            critical_tilt_deg: 10.0,
            substrate_law: SubstrateLaw::Linear,
            tilts_before_deg: None,
            needle: Needle::Free,
            needle_radius: None,
            depth: None,
            force: None,
            unload: false,
            failure: None,
            places: None,
            curvature: 0.0,
            bending: Bending::Rigid,
        }
    }
}

/// Result of a puncture.
#[derive(Clone, Debug)]
pub struct Puncture {
    /// How the path ended, and whether its end is valid.
    pub status: Status,
    /// The measures of the puncture.
    pub measures: PunctureMeasures,
    /// Measures at each of [`PunctureParameters::tilts_deg()`].
    ///
    /// `None` if the path did not reach the tilt.
    pub at_tilts: Vec<Option<TiltMeasures>>,
    /// Every equilibrium of the path, from rest.
    pub path: Vec<PuncturePoint>,
    /// Instability at every point of the path.
    ///
    /// It is evaluated with the contacts of the outgoing branch.
    pub instability: Vec<Instability>,
    /// Forces of a round tip at every point of the path; empty for other needles.
    pub tip_forces: Vec<TipForces>,
    /// Every contact event, in order.
    pub events: Vec<ContactEvent<PuncturePoint>>,
    /// Every snap of a row under a monotonically descending needle, in order.
    pub snaps: Vec<Snap>,
    /// Every folding or unfolding of the surface in a gap, in order.
    pub folds: Vec<Fold>,
    /// Every scale at the end of the path.
    pub scales: Vec<ScaleState>,
    /// Every Newton iteration.
    pub history: Vec<Iteration>,
    /// The unloading path, if requested and if the loading path was completed.
    pub unloading: Option<Unloading<PuncturePoint>>,
    /// The puncture at each of the [`PunctureParameters::places`] load positions.
    pub places: Vec<LoadPosition>,
    /// The end of the path, if punctures of similar designs can start from it.
    pub end: Option<PunctureEnd>,
}

impl Puncture {
    /// Returns true if friction acts between the scales.
    pub fn has_friction(&self) -> bool {
        self.path.iter().any(|point| point.friction_work.is_some())
    }
}

/// Solves the puncture of the middle scale from rest to the critical tilt.
///
/// The `substrate` is given by its [`Springs`](substrate::Springs) or by the stiffness of a whole
/// row.
///
/// # Errors
/// If a length, a modulus or a constant of the contact law is not positive, or another parameter
/// is out of its range.
pub fn solve(
    design: &Design,
    substrate: impl Into<RowStiffness>,
    common: &Common,
    parameters: &PunctureParameters,
) -> Result<Puncture, OutOfRange> {
    Problem::new(Rows::Even(design.row()?), design, substrate.into(), common, parameters)?.solve()
}

/// Solves the puncture of an imperfect row with the gaps and slants of `sample`.
///
/// The substrate is computed for the design without scatter.
///
/// # Errors
/// As [`solve`], or if no sample without overlapping scales is found.
pub fn solve_sample(
    design: &Design,
    substrate: impl Into<RowStiffness>,
    common: &Common,
    parameters: &PunctureParameters,
    sample: &Sample,
) -> Result<Puncture, OutOfRange> {
    Problem::new(Rows::Sample(sample), design, substrate.into(), common, parameters)?.solve()
}

/// Returns true if neighbouring scales overlap at rest on a concave body.
///
/// # Errors
/// If a length of the design is not positive, or its slant is out of range.
pub fn overlaps_at_rest(design: &Design, body: Body) -> Result<bool, OutOfRange> {
    if body.curvature >= 0.0 {
        return Ok(false);
    }
    let row = design.leaning_row()?;
    let frames = [0.0, row.pitch()].map(|arc| body.frame(arc));
    let poses = frames.map(|frame| Pose::new(0.0, 0.0, -frame.angle));
    Ok(!overlaps(|i| (*row.scale(), frames[i].origin), &poses).is_empty())
}

/// Computes the curvature of a concave body on which neighbouring scales touch at rest, by
/// bisection to `1e-9`; `None` if they do not touch down to a radius of `t`.
///
/// # Errors
/// If a length of the design is not positive, or its slant is out of range.
pub fn touching_curvature(design: &Design) -> Result<Option<f64>, OutOfRange> {
    let (mut apart, mut touching) = (0.0, -1.0);
    if !overlaps_at_rest(design, Body { curvature: touching })? {
        return Ok(None);
    }
    while apart - touching > 1e-9 {
        let middle = 0.5 * (apart + touching);
        if overlaps_at_rest(design, Body { curvature: middle })? {
            touching = middle;
        } else {
            apart = middle;
        }
    }
    Ok(Some(touching))
}

/// Source of rows of any length.
#[derive(Clone, Copy)]
enum Rows<'a> {
    Even(Row),
    Odd(Row, PerturbedScale),
    Sample(&'a Sample),
}

impl Rows<'_> {
    fn row(self, layout: RowLayout) -> Result<Arrangement, OutOfRange> {
        Ok(match self {
            Self::Even(row) => Arrangement::Even(row),
            Self::Odd(row, odd) => Arrangement::Uneven(odd.within(&row, layout)?),
            Self::Sample(sample) => Arrangement::Uneven(sample.row(layout.left, layout.right)?),
        })
    }
}

impl PunctureParameters {
    /// Returns the body below the row.
    pub(crate) fn body(&self) -> Body {
        Body { curvature: self.curvature }
    }

    /// Iterates over the measured tilts, degrees, with the critical one last.
    pub fn tilts_deg(&self) -> impl Iterator<Item = f64> {
        let before = self.tilts_before_deg.iter().flat_map(NumberList::as_slice).copied();
        before.chain(self.tilts_before_deg.map(|_| self.critical_tilt_deg))
    }

    fn check(&self) -> Result<(), OutOfRange> {
        let scales = match self.scales {
            RowLength::Auto => 1.0,
            RowLength::Scales(scales) => scales as f64,
        };
        let tilt = self.critical_tilt_deg;
        let (ratio, position) = (self.poisson_ratio, self.load_position);
        let depth = self.depth.unwrap_or(1.0);
        let force = self.force.unwrap_or(1.0);
        let radius = self.needle_radius.unwrap_or(0.0);
        let places = self.places.unwrap_or(2) as f64;
        let curvature = self.curvature;
        // Each rule states the valid range, so that NaN violates it.
        let rules = [
            (tilt > 0.0 && tilt < 90.0, "critical tilt", tilt, "an angle between 0° and 90°"),
            ((0.0..=0.5).contains(&ratio), "poisson's ratio", ratio, "a ratio from 0 to 0.5"),
            (position.is_finite(), "load position", position, "a number"),
            (depth > 0.0, "depth", depth, "a length above 0"),
            (force > 0.0, "force", force, "a force above 0"),
            (radius >= 0.0, "needle radius", radius, "a length"),
            (
                radius == 0.0 || self.needle.is_guided(),
                "needle radius",
                radius,
                "0 unless the needle is guided",
            ),
            (places >= 2.0, "number of places", places, "at least 2"),
            (scales >= 1.0, "number of scales", scales, "at least 1"),
            (curvature.is_finite(), "curvature of the body", curvature, "a number"),
        ];
        let mut rules = rules.into_iter();
        rules.try_for_each(|(holds, quantity, value, expected)| {
            OutOfRange::unless(holds, quantity, value, expected)
        })
    }
}

/// A path followed to its end.
struct Followed {
    watch: PathObservers,
    passage: Passage,
    path: Continuation<Chain>,
    status: Status,
}

impl Followed {
    /// Returns true if the path ended where it began.
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
    /// With `unload` also follows the unloading path.
    fn puncture(self, unload: bool) -> Puncture {
        let Self { watch, passage, mut path, status } = self;
        let PathObservers { record, needle, folds, failure, tilts, depth, force, .. } = watch;
        let at_tip = watch.passage;
        let FoldObserver { folds, .. } = folds;
        let path = &mut path;
        let mut measures = PunctureMeasures::new(&record, &folds, path);
        measures.passage = passage;
        if let Some(failure) = failure {
            let at_end = passage.critical_event.map_or(FailureMode::Tilt, FailureMode::from);
            let at_end = match status {
                Status::Complete => Some(at_end),
                Status::Bent => Some(FailureMode::Bend),
                _ => None,
            };
            measures.failure = failure.measures(path, at_end);
        }
        let loaded = force.points.first().and_then(Option::as_ref);
        measures.tissue_pressure_at_force =
            loaded.map(|point| path.system().tissue_pressure(&point.state));
        // The outer option tells whether a depth was requested, the inner one whether it was
        // reached.
        let deep = depth.points.first().map(|found| found.as_ref().map(|deep| &deep.state));
        // A skin that fails before this depth carries no more than its final force.
        let end = || (status == Status::Complete).then(|| &path.point().state);
        measures.force_at_depth =
            deep.and_then(|deep| Some(path.system().force(deep.or_else(end)?)));
        let (instability, snaps) = if path.system().is_critical_only() {
            (Vec::new(), Vec::new())
        } else {
            needle.finish(path, &mut measures)
        };
        let mut measures = match status {
            Status::Complete => measures,
            _ => measures.without_final_values(),
        };
        let chain = path.system();
        let scales = scales(chain, &path.point().state);
        // Observers record points when the path leaves them, so the last point is missing.
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

struct Problem<'a> {
    rows: Rows<'a>,
    design: &'a Design,
    stiffness: RowStiffness,
    /// Far field beyond the solved part of an endless row, lengths over `t`.
    ///
    /// `None` for a finite row.
    endless: Option<FarField>,
    law: ContactLaw,
    settings: Settings,
    detail: PathDetail,
    parameters: &'a PunctureParameters,
}

impl<'a> Problem<'a> {
    fn new(
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
        let (name, expected) = ("guided needle on elastic scales", "0, a free needle");
        OutOfRange::unless(is_rigid || !is_guided, name, f64::from(is_guided), expected)?;
        Self::unchecked(rows, design, stiffness, common, parameters)
    }

    /// Sets up the problem with parameters that may slightly exceed their ranges.
    fn unchecked(
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
        let Common { solver: settings, detail, .. } = *common;
        let problem = Self { rows, design, stiffness, endless, law, settings, detail, parameters };
        let radius = parameters.needle_radius;
        let is_in_reach = radius.is_none() || problem.reach().is_some();
        let expected = "at most 62 pitches of the row";
        OutOfRange::unless(is_in_reach, TIP_REACH, radius.unwrap_or(0.0), expected)?;
        Ok(problem)
    }

    fn solve(&self) -> Result<Puncture, OutOfRange> {
        self.result(self.follow(&[], &[])?)
    }

    /// Builds the result of a path that was followed from rest.
    fn result(&self, followed: Followed) -> Result<Puncture, OutOfRange> {
        let end = PunctureEnd::new(self, &followed);
        let puncture = followed.puncture(self.parameters.unload);
        Ok(Puncture { end, ..puncture }.with_places(self.load_positions()?))
    }

    /// Builds the initial system; returns it with the longest row it may grow to.
    ///
    /// A scale may touch up to `contact_reach` scales on its right.
    fn start(&self, contact_reach: usize) -> Result<(Chain, usize), OutOfRange> {
        let contacts = contact_reach * pair_constraints(&self.law);
        let law = self.parameters.substrate_law;
        let first = |far: &FarField| {
            let layout = RowLayout::first(far, self.stiffness.neighbours.len(), law);
            let layout = layout.at_least(self.reach().map_or(0, |reach| reach + 1));
            RowLayout { needle: self.needle_unknowns(), contacts, ..layout }
        };
        let Some(whole) = self.whole() else {
            let first = self.endless.as_ref().map(first);
            return Ok((self.part(first.unwrap_or_default())?, LONGEST_ROW));
        };
        // The far fields of bars and of springs agree only approximately, and far couplings have
        // no closed form in front of an end.
        let far = self.far_field(Some(1)).filter(|_| law == SubstrateLaw::Linear);
        let layout = far.map_or(whole, |far| first(&far).within(whole));
        Ok((self.part(RowLayout { contacts, ..layout })?, whole.scales()))
    }

    /// Counts the unknowns of the needle behind the load.
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
    fn reach(&self) -> Option<usize> {
        self.parameters.needle_radius.and_then(|radius| needle::reach(radius, self.pitch()))
    }

    /// Returns the distance of two nodes along the body, over `t`.
    fn pitch(&self) -> f64 {
        2.0 * self.design.half_base() + self.design.gap
    }

    /// Returns the layout of a whole finite row.
    ///
    /// A row ends at the latest where a curved body turns away.
    fn whole(&self) -> Option<RowLayout> {
        let on_body = self.parameters.body().scales_beside(self.pitch());
        let sides = match self.parameters.scales {
            RowLength::Scales(scales) => {
                // With an even number one more scale is on the right.
                let left = (scales - 1) / 2;
                let right = scales - 1 - left;
                let on_body = on_body.unwrap_or(scales);
                Some([left.min(on_body), right.min(on_body)])
            }
            // A body with more scales than the longest row counts as endless.
            RowLength::Auto => on_body.filter(|side| 2 * side < LONGEST_ROW).map(|side| [side; 2]),
        };
        let (needle, contacts) = (self.needle_unknowns(), 0);
        sides.map(|[left, right]| RowLayout { left, right, needle, contacts })
    }

    /// Follows the path of the puncture, with smaller steps if it turns around.
    ///
    /// Only one branch leaves the state at rest, so a path that returns there has turned around at
    /// an event, where round-off decided on its direction.
    fn follow(
        &self,
        functions: &[PathFunction<Chain>],
        places: &[At],
    ) -> Result<Followed, OutOfRange> {
        let mut followed = self.follow_once(functions, places)?;
        for factor in FINER_STEPS {
            if !followed.is_back_at_rest() {
                break;
            }
            let max_step = factor * self.settings.max_step;
            let settings = Settings { max_step, ..self.settings };
            let (stiffness, endless) = (self.stiffness.clone(), self.endless.clone());
            let finer = Problem { stiffness, endless, settings, ..*self };
            followed = finer.follow_once(functions, places)?;
        }
        Ok(followed)
    }

    /// Follows the path until it ends, and locates the points requested in `places`.
    ///
    /// Initially each scale may touch its direct neighbours. If the audit finds overlap with a more
    /// distant scale, which happens in at most one row in a hundred, the path is followed again
    /// with a larger contact reach. Using the larger reach from the start would multiply the run
    /// time of every path.
    fn follow_once(
        &self,
        functions: &[PathFunction<Chain>],
        places: &[At],
    ) -> Result<Followed, OutOfRange> {
        let mut contact_reach = 1;
        loop {
            let (start, longest) = self.start(contact_reach)?;
            let followed = self.follow_row(start, longest, functions, places)?;
            let path = &followed.path;
            let beyond = || path.system().contacts.meeting_beyond(&path.point().state);
            let beyond = (followed.status == Status::Interpenetration).then(beyond).flatten();
            match beyond.filter(|&pitches| pitches <= FARTHEST_CONTACT) {
                // Overlaps found lie beyond the reach, so it grows in every iteration.
                Some(pitches) => contact_reach = pitches,
                None => return Ok(followed),
            }
        }
    }

    /// Returns true if the load is in the middle of a scale of an even, upright row.
    ///
    /// It pushes the scale straight down. Beyond a bifurcation the path may leave the symmetric
    /// branch, but only by round-off.
    fn is_balanced(&self) -> bool {
        matches!(self.rows, Rows::Even(_))
            && self.design.slant_deg == 0.0
            && self.parameters.load_position == 0.5
    }

    /// Follows the path of a row until it ends.
    ///
    /// The solved part may grow up to `longest`.
    fn follow_row(
        &self,
        chain: Chain,
        longest: usize,
        functions: &[PathFunction<Chain>],
        places: &[At],
    ) -> Result<Followed, OutOfRange> {
        let mut growing = AdaptiveRowPath::new(self, chain, longest);
        let mut watch = PathObservers::new(&growing.path, self.parameters, functions, places);
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
        // Extend the points recorded on shorter rows, because they are evaluated on the final row
        // from here on.
        watch.lengthen(&growing);
        let path = growing.path;
        let mut passage = watch.passage.finish(path.system(), &path.point().state);
        let is_untilted = self.is_balanced()
            || (self.parameters.needle.is_guided() && passage.critical_event.is_none());
        // At some load the path of a scale pushed in its middle bifurcates.
        let points = &watch.record.path;
        let is_straight =
            || points.len() > 1 && points.iter().all(|at| at.tilt_deg.abs() < STRAIGHT_DEG);
        let status = match Status::of(&path, path.termination().unwrap_or(Termination::Reached)) {
            // A row that should have grown further has no valid end.
            _ if !growing.has_room => Status::RowLimit,
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
        // A load that vanishes at the foot of a face ends the path before the needle is through.
        passage.critical_event = passage.critical_event.filter(|_| status == Status::Complete);
        Ok(Followed { watch, passage, path, status })
    }

    /// Builds the system of a part of the row.
    fn part(&self, layout: RowLayout) -> Result<Chain, OutOfRange> {
        let whole = self.whole();
        let scales = |side: fn(RowLayout) -> usize| whole.map(|whole| side(whole) - side(layout));
        let beyond = [scales(|row| row.left), scales(|row| row.right)].map(|scales| {
            if scales == Some(0) {
                None
            } else {
                Some(Beyond { far: self.far_field(scales)?, scales })
            }
        });
        let Self { design, stiffness, law, parameters, .. } = self;
        let exterior = RowExterior::new(self.rows, layout, beyond, parameters.body())?;
        let row = self.rows.row(layout)?;
        let mut chain = Chain::new(row, stiffness, *law, layout, exterior, parameters, design);
        chain.detail = self.detail;
        Ok(chain)
    }

    /// Computes the far field of `scales` scales beyond an end, or of an infinite row.
    fn far_field(&self, scales: Option<usize>) -> Option<FarField> {
        match scales {
            // The infinite far field does not depend on the solved part, so it is computed once.
            None => self.endless.clone(),
            _ => far_field(self.design, &self.stiffness, scales),
        }
    }
}

/// Computes the far field with lengths over `t`, of a finite or infinite row.
fn far_field(design: &Design, stiffness: &RowStiffness, scales: Option<usize>) -> Option<FarField> {
    stiffness.with_lengths_over(design.half_base()).far_field(scales)
}

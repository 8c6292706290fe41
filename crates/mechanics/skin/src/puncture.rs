//! Puncture of a row of scales on an elastic half-space.

mod adaptive_row;
mod ending;
mod load_positions;
mod measures;
mod needle;
mod neo_hookean;
mod number_list;
mod observers;
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
use contact::ContactLaw;
use geometry::{OutOfRange, Row};
use needle::NEEDLE_UNKNOWNS;
use observers::PathObservers;
use point::scales;
use row_exterior::{Beyond, RowExterior};
use solver::{Path, Settings, Stop};
use substrate::{FarField, RowStiffness, SubstrateLaw};
use surface_fold::FoldObserver;
use system::{Chain, RowLayout};

use crate::arrangement::Arrangement;
use crate::contacts::{SkinPoint, pair_constraints};
use crate::record::{ContactEvent, Iteration, PathFunction, Record};
use crate::{Common, Design, Sample, Status, Unloading};

pub use load_positions::{LoadPosition, Weakest, load_positions};
pub use measures::PunctureMeasures;
pub(crate) use needle::NeedleMode;
pub use needle::{CriticalEvent, Needle, Passage, TipForces};
pub use number_list::{MOST_NUMBERS, NumberList};
pub use point::{PuncturePoint, ScaleState};
pub use sensitivity::{PunctureInput, differentiate, force_curve};
pub use single_scale::PerturbedScale;
pub use snap::Snap;
pub use snapshot::{At, RowSnapshot, Snapshots, snapshots, snapshots_to_end};
pub use stability::Instability;
pub use surface_fold::{Fold, GapStretch};
pub use tilts::TiltMeasures;

/// Tilt below which a scale under a guided needle is pushed straight down, degrees: round-off of a symmetric row.
const STRAIGHT_DEG: f64 = 1e-6;

/// Longest row that [`RowLength::Auto`] takes.
pub const LONGEST_ROW: usize = 4001;

/// How many pitches apart scales may be that meet. None were seen beyond 3, and each pitch takes another six unknowns of every scale.
const FARTHEST_CONTACT: usize = 8;

/// Number of scales in the row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowLength {
    /// A row without ends: as many scales are solved for as contact reaches, more as it spreads along the path, and those beyond
    /// move as a linear chain does, in closed form. Where nothing is known of those beyond, the row grows until its ends move by
    /// no more than `1e-6`.
    Auto,
    /// This many, the middle one (of an even number the left of the two) punctured.
    Scales(usize),
}

/// Parameters of a puncture besides the design and its substrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunctureParameters {
    /// Poisson's ratio `ν` of the substrate.
    pub poisson_ratio: f64,
    /// `E_ct / E_s`.
    pub contact_modulus_over_substrate: f64,
    /// Row length.
    pub scales: RowLength,
    /// Place of the load on the top of the punctured scale: 0 its left, 1 its right corner. A round tip may stand beyond, between two scales.
    pub load_position: f64,
    /// Tilt `φ_c` of the punctured scale at which the puncture ends, degrees.
    pub critical_tilt_deg: f64,
    /// How the substrate answers where the surface between two bases is stretched.
    pub substrate_law: SubstrateLaw,
    /// Tilts on the way to the critical one, degrees, at which measures are taken, as at that one; `None`: measures at no tilt are asked for.
    pub tilts_before_deg: Option<NumberList>,
    /// How the needle is held.
    pub needle: Needle,
    /// Radius of the tip of a guided needle, over `t`; `None` of a sharp one.
    pub needle_radius: Option<f64>,
    /// Depth `u*` at which the force is measured besides.
    pub depth: Option<f64>,
    /// Whether the load is taken away again at the end.
    pub unload: bool,
    /// Places of the load that are tried besides, from the left corner of the top to the right one, or over a pitch with a round tip: at
    /// least two.
    pub places: Option<usize>,
}

impl Default for PunctureParameters {
    /// The values of Shafiei et al. (2021): scales of `E_ct = 3 GPa` on a substrate of `E_s = 310 kPa`.
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
            unload: false,
            places: None,
        }
    }
}

/// A solved puncture.
#[derive(Clone, Debug)]
pub struct Puncture {
    /// How the path ended, and whether its end can be trusted.
    pub status: Status,
    /// The measures of the puncture.
    pub measures: PunctureMeasures,
    /// The measures at each of [`PunctureParameters::tilts_deg()`]; `None` where the path did not get there.
    pub at_tilts: Vec<Option<TiltMeasures>>,
    /// Every equilibrium of the path, from rest.
    pub path: Vec<PuncturePoint>,
    /// The instability of every equilibrium of the path, with the contacts with which the path leaves it.
    pub instability: Vec<Instability>,
    /// The forces of a round tip at every equilibrium of the path; nothing of another needle.
    pub tip_forces: Vec<TipForces>,
    /// Every contact event, in order.
    pub events: Vec<ContactEvent<PuncturePoint>>,
    /// Every snap of a row under a needle that only goes deeper, in order.
    pub snaps: Vec<Snap>,
    /// Every gap in which the surface folds over or unfolds, in order.
    pub folds: Vec<Fold>,
    /// Every scale at the end of the path.
    pub scales: Vec<ScaleState>,
    /// Every Newton iteration.
    pub history: Vec<Iteration>,
    /// The way back, where it is asked for and the path came to its end.
    pub unloading: Option<Unloading<PuncturePoint>>,
    /// The puncture at each of so many places of the load as [`PunctureParameters::places`] says.
    pub places: Vec<LoadPosition>,
}

impl Puncture {
    /// Whether scales rub on each other.
    pub fn has_friction(&self) -> bool {
        self.path.iter().any(|point| point.friction_work.is_some())
    }
}

/// Follows the puncture of the middle scale of a row of `design` from rest to the critical tilt, on a
/// `substrate` that is given by its [`Springs`](substrate::Springs) or by the stiffness of the whole row.
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

/// Follows the puncture of an imperfect row as [`solve`] does: gaps and slants are those of `sample`, the substrate stays
/// that of the design.
///
/// # Errors
/// As [`solve`], or if the scales cannot be made to stand clear of each other.
pub fn solve_sample(
    design: &Design,
    substrate: impl Into<RowStiffness>,
    common: &Common,
    parameters: &PunctureParameters,
    sample: &Sample,
) -> Result<Puncture, OutOfRange> {
    Problem::new(Rows::Sample(sample), design, substrate.into(), common, parameters)?.solve()
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
    /// The tilts at which measures are taken, degrees, the critical one last.
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
        let radius = self.needle_radius.unwrap_or(0.0);
        let places = self.places.unwrap_or(2) as f64;
        // Each rule says what holds, so that a value which is no number breaks it.
        let rules = [
            (tilt > 0.0 && tilt < 90.0, "critical tilt", tilt, "an angle between 0° and 90°"),
            ((0.0..=0.5).contains(&ratio), "poisson's ratio", ratio, "a ratio from 0 to 0.5"),
            (position.is_finite(), "load position", position, "a number"),
            (depth > 0.0, "depth", depth, "a length above 0"),
            (radius >= 0.0, "needle radius", radius, "a length"),
            (
                radius == 0.0 || self.needle.is_guided(),
                "needle radius",
                radius,
                "that of a needle that is guided",
            ),
            (places >= 2.0, "number of places", places, "at least 2"),
            (scales >= 1.0, "number of scales", scales, "at least 1"),
        ];
        let mut rules = rules.into_iter();
        rules.try_for_each(|(holds, quantity, value, expected)| {
            OutOfRange::unless(holds, quantity, value, expected)
        })
    }
}

/// A path that was followed to its end.
struct Followed {
    watch: PathObservers,
    passage: Passage,
    path: Path<Chain>,
    status: Status,
}

impl Followed {
    /// The result of the puncture; with `unload` the path is turned back at its end.
    fn puncture(self, unload: bool) -> Puncture {
        let Self { watch, passage, mut path, status } = self;
        let PathObservers { record, needle, folds, passage: at_tip, tilts, depth, .. } = watch;
        let FoldObserver { folds, .. } = folds;
        let path = &mut path;
        let mut measures = PunctureMeasures::new(&record, &folds, path);
        measures.passage = passage;
        // The outer option says whether a depth was asked for, the inner whether it was reached.
        let deep = depth.points.first().map(|found| found.as_ref().map(|deep| &deep.state));
        // A skin that gives way before it is so deep bears no more than it does there.
        let end = || (status == Status::Complete).then(|| &path.point().state);
        measures.force_at_depth =
            deep.and_then(|deep| Some(path.system().force(deep.or_else(end)?)));
        let (instability, snaps) = needle.finish(path, &mut measures);
        let mut measures = match status {
            Status::Complete => measures,
            _ => measures.without_final_values(),
        };
        let chain = path.system();
        let scales = scales(chain, &path.point().state);
        // The watch notes points that the path leaves: the last one it never left.
        let mut tip_forces = at_tip.tip_forces;
        tip_forces.extend(chain.tip_forces(&path.point().state));
        let at_tilt = |point: Option<SkinPoint>| Some(TiltMeasures::new(chain, &point?.state));
        let at_tilts = tilts.points.into_iter().map(at_tilt).collect();
        let Record { path: points, events, history, work, .. } = record;
        // The way back moves the path, so all that is told of the end has been taken before.
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
        }
    }
}

struct Problem<'a> {
    rows: Rows<'a>,
    design: &'a Design,
    stiffness: RowStiffness,
    /// Beyond the ends of a part of an endless row, lengths over `t`; `None` for a row that ends.
    endless: Option<FarField>,
    law: ContactLaw,
    settings: Settings,
    whole_path: bool,
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
        Self::unchecked(rows, design, stiffness, common, parameters)
    }

    /// The problem with parameters that may lie a little beyond the ends of their ranges.
    fn unchecked(
        rows: Rows<'a>,
        design: &'a Design,
        stiffness: RowStiffness,
        common: &Common,
        parameters: &'a PunctureParameters,
    ) -> Result<Self, OutOfRange> {
        // The ratio of moduli is over `E_s`, forces are over `E* = E_s/(1 − ν²)`.
        let plane_modulus = 1.0 - parameters.poisson_ratio.powi(2);
        let modulus = parameters.contact_modulus_over_substrate * plane_modulus;
        let law = ContactLaw::new(common.law, design.length, design.width, modulus)?
            .with_friction(common.friction)?;
        let endless = match parameters.scales {
            RowLength::Auto => Some(far_field(design, &stiffness, None).ok_or(OutOfRange {
                quantity: "direct stiffness of the substrate",
                value: stiffness.direct[0],
                expected: "more than its couplings with all neighbours together",
            })?),
            RowLength::Scales(_) => None,
        };
        let Common { solver: settings, whole_path, .. } = *common;
        let problem =
            Self { rows, design, stiffness, endless, law, settings, whole_path, parameters };
        let radius = parameters.needle_radius;
        let is_in_reach = radius.is_none() || problem.reach().is_some();
        let expected = "at most 62 pitches of the row";
        OutOfRange::unless(is_in_reach, "needle radius", radius.unwrap_or(0.0), expected)?;
        Ok(problem)
    }

    fn solve(&self) -> Result<Puncture, OutOfRange> {
        let puncture = self.follow(&[], &[])?.puncture(self.parameters.unload);
        Ok(puncture.with_places(self.load_positions()?))
    }

    /// The system with which the path begins, in which a scale may meet as many on its right as `contact_reach` says, and the longest
    /// row that it may grow to.
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
        // Bars are as good as springs to a part of the displacements only, and far couplings have no closed form before an end.
        let far = self.far_field(Some(1)).filter(|_| law == SubstrateLaw::Linear);
        let layout = far.map_or(whole, |far| first(&far).within(whole));
        Ok((self.part(RowLayout { contacts, ..layout })?, whole.scales()))
    }

    /// Unknowns of the needle behind the load.
    fn needle_unknowns(&self) -> usize {
        match self.reach() {
            Some(reach) => needle::unknowns(reach, self.parameters.needle.has_friction()),
            None if self.parameters.needle.is_guided() => NEEDLE_UNKNOWNS,
            None => 0,
        }
    }

    /// Scales on each side of the punctured one that a round tip may come to; `None` of another needle.
    fn reach(&self) -> Option<usize> {
        let pitch = 2.0 * self.design.half_base() + self.design.gap;
        self.parameters.needle_radius.and_then(|radius| needle::reach(radius, pitch))
    }

    /// All of a row that ends.
    fn whole(&self) -> Option<RowLayout> {
        match self.parameters.scales {
            RowLength::Scales(scales) => {
                // Of an even number one more stands on the right.
                let left = (scales - 1) / 2;
                let (needle, contacts) = (self.needle_unknowns(), 0);
                Some(RowLayout { left, right: scales - 1 - left, needle, contacts })
            }
            RowLength::Auto => None,
        }
    }

    /// Follows the path until it ends, and notes where it comes to `places`.
    ///
    /// Each scale may meet its neighbours. Where another one is found to have come into it, which a row does once in a hundred at most, the
    /// path is followed again with contacts as far as that: with them from the start each path would take several times as long.
    fn follow(
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
                // What was found lies beyond the reach, so the reach grows with every turn.
                Some(pitches) => contact_reach = pitches,
                None => return Ok(followed),
            }
        }
    }

    /// Follows the path of a row until it ends. A part of a longer row may grow up to the `longest`.
    fn follow_row(
        &self,
        chain: Chain,
        longest: usize,
        functions: &[PathFunction<Chain>],
        places: &[At],
    ) -> Result<Followed, OutOfRange> {
        let mut growing = AdaptiveRowPath::new(self, chain, longest);
        let mut watch = PathObservers::new(&growing.path, self.parameters, functions, places);
        while let Some(segment) = growing.next()? {
            watch.follow(&mut growing.path, &segment);
        }
        // What was kept of shorter rows is looked at, from here on, on the row as it is in the end.
        watch.lengthen(&growing);
        let path = growing.path;
        let mut passage = watch.passage.finish(path.system(), &path.point().state);
        let is_untilted = self.parameters.needle.is_guided() && passage.critical_event.is_none();
        // A scale that is pushed in its middle may go either way from some load on: there its path branches.
        let is_straight = || watch.record.path.iter().all(|at| at.tilt_deg.abs() < STRAIGHT_DEG);
        let status = match Status::of(&path, path.stop().unwrap_or(Stop::Reached)) {
            // A row that should have grown further ends where mechanics says nothing.
            _ if !growing.has_room => Status::RowLimit,
            // Not even the first step tilts a scale that is upright and loaded in its middle.
            Status::Stopped(Stop::Singular) if watch.record.path.len() == 1 => Status::Untilted,
            Status::Complete if is_untilted => Status::Untilted,
            Status::Stopped(Stop::NoConvergence | Stop::Jumps) if is_untilted && is_straight() => {
                Status::Untilted
            }
            status => ending::classify(status, &watch.record.path),
        };
        // A load that comes back to zero at the foot of a face ends the path before the needle is through.
        passage.critical_event = passage.critical_event.filter(|_| status == Status::Complete);
        Ok(Followed { watch, passage, path, status })
    }

    /// The system of a part of the row.
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
        let exterior = RowExterior::new(self.rows, layout, beyond)?;
        let (row, length) = (self.rows.row(layout)?, self.design.length);
        let Self { stiffness, law, parameters, .. } = self;
        let mut chain = Chain::new(row, stiffness, *law, layout, exterior, parameters, length);
        chain.whole_path = self.whole_path;
        Ok(chain)
    }

    /// The effect of so many scales beyond an end, or of a row without end.
    fn far_field(&self, scales: Option<usize>) -> Option<FarField> {
        match scales {
            // It does not depend on the part that is solved for, so it is made once.
            None => self.endless.clone(),
            _ => far_field(self.design, &self.stiffness, scales),
        }
    }
}

/// The far field of a row of so many scales, or of one without end, with lengths over `t`.
fn far_field(design: &Design, stiffness: &RowStiffness, scales: Option<usize>) -> Option<FarField> {
    stiffness.with_lengths_over(design.half_base()).far_field(scales)
}

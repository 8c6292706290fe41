//! Setup and solution of a bending problem with adaptive resolution.

use contact::ContactLaw;
use geometry::{OutOfRange, Row};
use membrane::{Membrane, Section, Span};
use solver::{Continuation, Settings, Termination};

use super::accuracy::change;
use super::first_contact::{contact_curvature, first_of_gaps};
use super::frame::Step;
use super::mesh::Resolution;
use super::strip::{Strip, StripExtent};
use super::{Flexure, FlexureMeasures, FlexureParameters, FlexurePoint, Method, gaps, whole_gaps};
use crate::arrangement::Arrangement;
use crate::contacts::{Contacts, SkinPoint, SkinState};
use crate::path_location::{PathLocation, PointLocator};
use crate::record::{PathFunction, Record};
use crate::{Common, Design, PathDetail, Sample, Status, Unloading};

/// A strip bent to the end of its path.
pub(crate) struct Bent {
    pub(crate) record: Record<Strip>,
    pub(crate) path: Continuation<Strip>,
    pub(crate) status: Status,
    /// Largest relative change of any measure on a finer membrane; `None` if not estimated.
    error: Option<f64>,
    /// Relative poses of neighbours in the solved gaps, at every point of the path.
    steps: Vec<Vec<Step>>,
    /// Equilibria at the requested end rotations; `None` for a rotation that was not reached.
    pub(crate) requested_points: Vec<Option<SkinPoint>>,
}

/// Input of a bending problem, with the undeformed strip.
pub(crate) struct FlexureProblem<'a> {
    pub(crate) common: &'a Common,
    parameters: &'a FlexureParameters,
    pub(crate) row: Arrangement,
    half_base: f64,
    section: Section,
    law: ContactLaw,
    /// Number of gaps `n` of the whole strip.
    pub(crate) gaps: f64,
    /// Number of gaps that are solved together: one for a unit cell.
    pub(super) solved: usize,
    /// Curvature of first contact in closed form; `None` if it is unknown or scales cannot touch.
    pub(super) contact_curvature: Option<f64>,
}

impl<'a> FlexureProblem<'a> {
    /// Sets up the strip of a design with equal gaps.
    pub(crate) fn even(
        design: &Design,
        common: &'a Common,
        parameters: &'a FlexureParameters,
    ) -> Result<Self, OutOfRange> {
        let contact_curvature = contact_curvature(design, parameters)?;
        Ok(Self { contact_curvature, ..Self::of_row(design.row()?, design, common, parameters)? })
    }

    /// Sets up the strip of an even `row`, without its curvature of first contact.
    ///
    /// The row may have negative slants. The other parameters are taken from `design`.
    pub(crate) fn of_row(
        row: Row,
        design: &Design,
        common: &'a Common,
        parameters: &'a FlexureParameters,
    ) -> Result<Self, OutOfRange> {
        let (gaps, solved) = match parameters.method {
            Method::UnitCell => (gaps(&row, parameters), 1),
            Method::Chain => {
                let whole = whole_gaps(&row, parameters);
                (whole as f64, whole)
            }
        };
        Self::new(design, common, parameters, Arrangement::Even(row), gaps, solved)
    }

    /// Sets up an imperfect strip with all its gaps.
    pub(crate) fn sample(
        design: &Design,
        common: &'a Common,
        parameters: &'a FlexureParameters,
        sample: &Sample,
    ) -> Result<Self, OutOfRange> {
        let gaps = whole_gaps(&design.row()?, parameters);
        let row = sample.row(0, gaps)?;
        let contact_curvature = first_of_gaps(&row, parameters);
        let row = Arrangement::Uneven(row);
        let problem = Self::new(design, common, parameters, row, gaps as f64, gaps)?;
        Ok(Self { contact_curvature, ..problem })
    }

    pub(crate) fn new(
        design: &Design,
        common: &'a Common,
        parameters: &'a FlexureParameters,
        row: Arrangement,
        gaps: f64,
        solved: usize,
    ) -> Result<Self, OutOfRange> {
        let modulus = parameters.contact_modulus_over_membrane;
        Ok(Self {
            common,
            parameters,
            row,
            half_base: design.half_base(),
            section: Section::new(design.width, parameters.membrane_thickness)?,
            law: ContactLaw::new(common.law, design.length, design.width, modulus)?
                .with_friction(common.friction)?,
            gaps,
            solved,
            contact_curvature: None,
        })
    }

    /// Returns the curvature `κ*` at the end of bending.
    pub(super) fn end_curvature(&self) -> f64 {
        self.end_rotation() / self.length()
    }

    /// Returns the length of the strip between the first and the last node.
    pub(super) fn length(&self) -> f64 {
        self.gaps * self.row.mean_pitch()
    }

    /// Returns the relative rotation of the ends at the end of bending, radians.
    pub(super) fn end_rotation(&self) -> f64 {
        // The parameter is the rotation of each end, half of the relative rotation.
        2.0 * self.parameters.max_end_rotation_deg.to_radians()
    }

    /// Returns the bending stiffness `E_m I_m` of the membrane, in units of `E_m t⁴`.
    pub(super) fn bending_stiffness(&self) -> f64 {
        self.section.bending_stiffness()
    }

    /// Builds the solved part of the strip with the given resolution of its membranes.
    pub(crate) fn strip(&self, resolution: Resolution) -> Result<Strip, OutOfRange> {
        // Equal gaps share one membrane.
        let unlike = match &self.row {
            Arrangement::Even(_) => 1,
            Arrangement::Uneven(_) => self.solved,
        };
        let membranes =
            (0..unlike).map(|gap| self.membrane(gap, resolution)).collect::<Result<_, _>>()?;
        let repeats = self.gaps / self.solved as f64;
        let rotation = self.end_rotation() / repeats;
        let extent = StripExtent { gaps: self.solved, repeats, rotation, farthest: 1.0 };
        Ok(Strip::new(self.row.clone(), membranes, self.law, self.section, extent))
    }

    /// Builds a strip that consists of one gap of an uneven strip and its two scales.
    pub(super) fn gap(&self, gap: usize, resolution: Resolution) -> Result<Strip, OutOfRange> {
        let membranes = vec![self.membrane(gap, resolution)?];
        // Before contact the rotation of each gap is proportional to its length.
        let free_length = self.row.gap_fraction() * self.length();
        let share = self.row.gap(gap) / free_length;
        let rotation = share * self.end_rotation();
        let extent = StripExtent { gaps: 1, repeats: 1.0, rotation, farthest: share.recip() };
        Ok(Strip::new(self.row.pair(gap)?, membranes, self.law, self.section, extent))
    }

    fn membrane(&self, gap: usize, resolution: Resolution) -> Result<Membrane, OutOfRange> {
        let (half_base, axis_offset) = (self.half_base, self.parameters.membrane_axis_offset);
        resolution.membrane(self.section, Span { half_base, gap: self.row.gap(gap), axis_offset })
    }

    /// Bends the strip; refines the membrane until the discretisation error is acceptable.
    pub(crate) fn solve(&self) -> Result<Flexure, OutOfRange> {
        Ok(self.flexure(self.resolved(&[], &[])?.0))
    }

    /// Returns the initial resolution for measures of this `detail`.
    pub(super) fn coarsest(&self, detail: PathDetail) -> Resolution {
        self.parameters.elements_per_gap.coarsest(detail)
    }

    /// Bends the strip; refines the membrane until the discretisation error is acceptable.
    ///
    /// Also tracks the maxima of `functions` along the path, and locates the equilibria at
    /// `end_rotations` (rotation of each end, radians). Returns the final resolution, too.
    pub(crate) fn resolved(
        &self,
        functions: &[PathFunction<Strip>],
        end_rotations: &[f64],
    ) -> Result<(Bent, Resolution), OutOfRange> {
        let mut resolution = self.coarsest(PathDetail::Whole);
        loop {
            let bent = self.bend(resolution, functions, end_rotations)?;
            // A path that stopped early is not refined.
            let error = bent.error.filter(|_| bent.status == Status::Complete);
            // If the largest order is not sufficient, its error is reported with the measures.
            let Some(finer) = resolution.better(error) else { return Ok((bent, resolution)) };
            resolution = finer;
        }
    }

    pub(super) fn bend(
        &self,
        resolution: Resolution,
        functions: &[PathFunction<Strip>],
        end_rotations: &[f64],
    ) -> Result<Bent, OutOfRange> {
        let strip = self.strip(resolution)?;
        let rest = SkinState::at_rest(&strip);
        let alike = matches!(self.row, Arrangement::Even(_));
        let mut steps = vec![strip.steps(&rest.z)];
        let solver = self.common.solver;
        let settings = Settings { max_work: solver.max_work / WORK_PER_UNKNOWN, ..solver };
        let mut path = Continuation::new(strip, rest, settings);
        let mut record = Record::new(&path, functions);
        let repeats = path.system().repeats;
        let mut locator = PointLocator::new(
            &path,
            end_rotations.iter().map(|&rotation| PathLocation {
                quantity: |strip: &Strip, state| strip.rotation(&state.z),
                value: 2.0 * rotation / repeats,
            }),
        );
        let mut flush = false;
        loop {
            let from = path.point_shared();
            let Some(point) = path.next() else { break };
            // If sides lie flush in all equal gaps, a larger moment only moves the contact force
            // from one end of the side to the other end. The strip does not bend further.
            flush = alike && Contacts::flush(&point.state);
            if flush {
                break;
            }
            locator.follow(&mut path, &from, &point);
            record.visit(&mut path, &from, &point);
            steps.push(path.system().steps(&point.state.z));
        }
        // After the break above the path has no stop reason of its own.
        let stop = if flush { Some(Termination::Singular) } else { path.termination() };
        let status = match Status::of(&path, stop.unwrap_or(Termination::Reached)) {
            Status::Stopped(stop) if stop.is_numerical() && (flush || locks(&record.path)) => {
                Status::Locked
            }
            Status::Stopped(stop)
                if stop.is_numerical()
                    && alike
                    && self.parameters.method == Method::Chain
                    && ends_at_largest_moment(&record.path) =>
            {
                Status::LimitPoint
            }
            status => status,
        };
        let error = self.error(resolution, &path, &record)?;
        Ok(Bent { record, path, status, error, steps, requested_points: locator.points })
    }

    /// Builds the result of bending, and unloads the strip if requested.
    pub(crate) fn flexure(&self, bent: Bent) -> Flexure {
        let Bent { record, mut path, status, error, steps, .. } = bent;
        // Computed values agree with the closed forms only up to round-off. Designs without contact
        // should have exactly the compliance `d/p`.
        let measures =
            FlexureMeasures::new(&record, &mut path).in_closed_form(self.row.gap_fraction());
        let measures =
            FlexureMeasures { error, contact_curvature: self.contact_curvature, ..measures };
        let measures = match status {
            Status::Complete => measures,
            _ => measures.without_final_values(),
        };
        let (gaps, row) = (path.system().whole_gaps(), self.row.clone());
        let Record { path: points, events, history, work, .. } = record;
        let unload = self.parameters.unload && status == Status::Complete;
        // Unload after evaluating the measures, because unloading moves the path from its end.
        let unloading = unload.then(|| Unloading::follow(&mut path, work));
        let remains =
            unloading.as_ref().map(|back| back.remains(|point: &FlexurePoint| point.curvature));
        let measures = FlexureMeasures { remains: remains.unwrap_or_default(), ..measures };
        Flexure { status, measures, path: points, events, history, unloading, gaps, steps, row }
    }

    /// Estimates the largest relative change of any measure on the next finer membrane.
    ///
    /// `None` for co-rotational elements, which are not refined.
    fn error(
        &self,
        resolution: Resolution,
        path: &Continuation<Strip>,
        record: &Record<Strip>,
    ) -> Result<Option<f64>, OutOfRange> {
        let Some(finer) = resolution.finer() else { return Ok(None) };
        if record.first_contact().is_none() {
            // Without contact the membranes are arcs, which every resolution represents exactly.
            return Ok(Some(0.0));
        }
        let finer = self.strip(finer)?;
        let settings = &self.common.solver;
        // If a state has no solution on the finer membrane, its error counts as infinite.
        let end = &path.point().state;
        // Skip the stiffest state if it is the end of the path, as is often the case.
        let before =
            record.stiffness.point().map(|point| &point.state).filter(|state| *state != end);
        Ok(before
            .into_iter()
            .chain([end])
            .map(|state| change(path.system(), &finer, state, settings).unwrap_or(f64::INFINITY))
            .reduce(f64::max))
    }
}

/// Ratio of the stiffness to the stiffness at rest from which a strip counts as locked.
pub(super) const LOCKED: f64 = 100.0;

/// Membrane strain far beyond the validity of the small-strain law.
const BEYOND_LAW: f64 = 1.0;

/// Computing time for an unknown of a strip divided by the time for an unknown of a punctured row.
///
/// The value is rounded. Strips are slower because each gap has a membrane, and because many of
/// their tangents need row exchanges.
const WORK_PER_UNKNOWN: u64 = 3;

/// Ratio of the stiffness to the stiffness at rest below which the moment counts as maximal.
const LEVEL: f64 = 1e-3;

/// Returns true if the moment reaches a maximum at the end of a path.
///
/// Beyond the maximum the bending of several equal gaps localises: one gap bends further, the
/// others open. The path bifurcates at the maximum, so Newton's method fails.
fn ends_at_largest_moment(path: &[FlexurePoint]) -> bool {
    let ends = path.first().zip(path.last());
    ends.is_some_and(|(first, last)| last.stiffness.abs() <= LEVEL * first.stiffness)
}

/// Returns true if the scales lock a strip at the end of its path.
///
/// The strip is then much stiffer than at rest, or bends further only with a membrane strain far
/// beyond the validity of the law.
fn locks(path: &[FlexurePoint]) -> bool {
    let ends = path.first().zip(path.last());
    ends.is_some_and(|(first, last)| {
        // Use the magnitude: the stiffness of a locked strip may be negative, because its rotation
        // may decrease.
        last.stiffness.abs() >= LOCKED * first.stiffness || last.membrane_strain >= BEYOND_LAW
    })
}

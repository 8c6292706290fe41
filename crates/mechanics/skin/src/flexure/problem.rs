//! The problem of bending a strip, and its solution with a resolution that suffices.

use contact::ContactLaw;
use geometry::{OutOfRange, Row};
use membrane::{Membrane, Section, Span};
use solver::{Path, Stop};

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
use crate::{Common, Design, Sample, Status, Unloading};

/// A strip that was bent to the end of its path.
pub(crate) struct Bent {
    pub(crate) record: Record<Strip>,
    pub(crate) path: Path<Strip>,
    pub(crate) status: Status,
    /// The largest change of any measure with a finer resolution; `None` where there is none.
    error: Option<f64>,
    steps: Vec<Vec<Step>>,
    /// The equilibria at the end rotations that were asked for.
    pub(crate) requested_points: Vec<Option<SkinPoint>>,
}

/// A strip to be bent.
pub(crate) struct FlexureProblem<'a> {
    pub(crate) common: &'a Common,
    parameters: &'a FlexureParameters,
    pub(crate) row: Arrangement,
    half_base: f64,
    section: Section,
    law: ContactLaw,
    /// Gaps `n` of the whole strip.
    pub(crate) gaps: f64,
    /// Gaps that are solved for.
    pub(super) solved: usize,
    /// The curvature of first contact of a design whose measures are asked for, or of a sample.
    pub(super) contact_curvature: Option<f64>,
}

impl<'a> FlexureProblem<'a> {
    /// The strip of a design.
    pub(crate) fn even(
        design: &Design,
        common: &'a Common,
        parameters: &'a FlexureParameters,
    ) -> Result<Self, OutOfRange> {
        let contact_curvature = contact_curvature(design, parameters)?;
        Ok(Self { contact_curvature, ..Self::of_row(design.row()?, design, common, parameters)? })
    }

    /// The strip of a design with this row.
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

    /// A sample of the strip, with all its gaps.
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

    /// The mean curvature at the end of bending.
    pub(super) fn end_curvature(&self) -> f64 {
        self.end_rotation() / self.length()
    }

    /// Length of the strip, from the node of the first scale to that of the last.
    pub(super) fn length(&self) -> f64 {
        self.gaps * self.row.mean_pitch()
    }

    /// The rotation of the ends against each other at the end of bending, radians.
    pub(super) fn end_rotation(&self) -> f64 {
        // The parameter is the rotation of each end.
        2.0 * self.parameters.max_end_rotation_deg.to_radians()
    }

    /// `E_m I_m`, over `E_m t⁴`.
    pub(super) fn bending_stiffness(&self) -> f64 {
        self.section.bending_stiffness()
    }

    /// The strip with this resolution.
    pub(crate) fn strip(&self, resolution: Resolution) -> Result<Strip, OutOfRange> {
        // Gaps that are alike share one membrane.
        let unlike = match &self.row {
            Arrangement::Even(_) => 1,
            Arrangement::Uneven(_) => self.solved,
        };
        let membrane = |gap| self.membrane(gap, resolution);
        let membranes = (0..unlike).map(membrane).collect::<Result<_, _>>()?;
        let repeats = self.gaps / self.solved as f64;
        let rotation = self.end_rotation() / repeats;
        let extent = StripExtent { gaps: self.solved, repeats, rotation, farthest: 1.0 };
        Ok(Strip::new(self.row.clone(), membranes, self.law, self.section, extent))
    }

    /// One of the gaps of a strip in which they differ, with its two scales.
    pub(super) fn gap(&self, gap: usize, resolution: Resolution) -> Result<Strip, OutOfRange> {
        let membranes = vec![self.membrane(gap, resolution)?];
        // Without contact every gap turns in proportion to its length.
        let free_length = self.row.share_of_gaps() * self.length();
        let share = self.row.gap(gap) / free_length;
        let rotation = share * self.end_rotation();
        let extent = StripExtent { gaps: 1, repeats: 1.0, rotation, farthest: share.recip() };
        Ok(Strip::new(self.row.pair(gap)?, membranes, self.law, self.section, extent))
    }

    fn membrane(&self, gap: usize, resolution: Resolution) -> Result<Membrane, OutOfRange> {
        let (half_base, axis_offset) = (self.half_base, self.parameters.membrane_axis_offset);
        resolution.membrane(self.section, Span { half_base, gap: self.row.gap(gap), axis_offset })
    }

    /// Bends the strip, with finer and finer resolution until it suffices.
    pub(crate) fn solve(&self) -> Result<Flexure, OutOfRange> {
        Ok(self.flexure(self.resolved(&[], &[])?.0))
    }

    /// The resolution to begin with.
    pub(super) fn coarsest(&self) -> Resolution {
        self.parameters.elements_per_gap.coarsest()
    }

    /// The strip bent with the resolution that suffices, the largest values of some functions followed, with the equilibria at some
    /// rotations of each end.
    pub(crate) fn resolved(
        &self,
        functions: &[PathFunction<Strip>],
        end_rotations: &[f64],
    ) -> Result<(Bent, Resolution), OutOfRange> {
        let mut resolution = self.coarsest();
        loop {
            let bent = self.bend(resolution, functions, end_rotations)?;
            // A path that stopped early has no error, and no finer membrane is tried for it.
            let error = bent.error.filter(|_| bent.status == Status::Complete);
            // At the finest usual resolution the error stays, and is told with the measures.
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
        let mut path = Path::new(strip, rest, self.common.solver);
        let mut record = Record::new(&path, functions);
        let repeats = path.system().repeats;
        let turned = |&rotation: &f64| PathLocation {
            quantity: |strip: &Strip, state| strip.rotation(&state.z),
            value: 2.0 * rotation / repeats,
        };
        let mut locator = PointLocator::new(&path, end_rotations.iter().map(turned));
        let mut flush = false;
        loop {
            let from = path.point_shared();
            let Some(point) = path.next() else { break };
            // Where a side lies flush in every gap at once, the moment moves the force from one end of it to the
            // other and nothing else moves: the path stands still in all that measures it.
            flush = alike && Contacts::flush(&point.state);
            if flush {
                break;
            }
            locator.follow(&mut path, &from, &point);
            record.visit(&mut path, &from, &point);
            steps.push(path.system().steps(&point.state.z));
        }
        // The path was left while it could have gone on, so it has no reason of its own.
        let stop = if flush { Some(Stop::Singular) } else { path.stop() };
        let status = match Status::of(&path, stop.unwrap_or(Stop::Reached)) {
            Status::Stopped(stop) if stop.is_numerical() && (flush || locks(&record.path)) => {
                Status::Locked
            }
            status => status,
        };
        let error = self.error(resolution, &path, &record)?;
        Ok(Bent { record, path, status, error, steps, requested_points: locator.points })
    }

    /// The result of a strip that was bent.
    pub(crate) fn flexure(&self, bent: Bent) -> Flexure {
        let Bent { record, mut path, status, error, steps, .. } = bent;
        // Computed values agree with the closed forms up to round-off, and designs that do not
        // touch shall have `d/p` to the last bit.
        let measures =
            FlexureMeasures::new(&record, &mut path).in_closed_form(self.row.share_of_gaps());
        let measures =
            FlexureMeasures { error, contact_curvature: self.contact_curvature, ..measures };
        let measures = match status {
            Status::Complete => measures,
            _ => measures.without_final_values(),
        };
        let (gaps, row) = (path.system().whole_gaps(), self.row.clone());
        let Record { path: points, events, history, work, .. } = record;
        let unload = self.parameters.unload && status == Status::Complete;
        // The way back leaves the end at which measures are taken, so it comes last.
        let unloading = unload.then(|| Unloading::follow(&mut path, work));
        let remains =
            unloading.as_ref().map(|back| back.remains(|point: &FlexurePoint| point.curvature));
        let measures = FlexureMeasures { remains: remains.unwrap_or_default(), ..measures };
        Flexure { status, measures, path: points, events, history, unloading, gaps, steps, row }
    }

    /// The largest change of any measure with a finer resolution; `None` where there is none.
    fn error(
        &self,
        resolution: Resolution,
        path: &Path<Strip>,
        record: &Record<Strip>,
    ) -> Result<Option<f64>, OutOfRange> {
        let Some(finer) = resolution.finer() else { return Ok(None) };
        if record.first_contact().is_none() {
            // Arcs are exact in every resolution.
            return Ok(Some(0.0));
        }
        let finer = self.strip(finer)?;
        let settings = &self.common.solver;
        // A state that cannot be solved with the finer resolution is not resolved.
        let change =
            |state| change(path.system(), &finer, state, settings).unwrap_or(f64::INFINITY);
        let end = &path.point().state;
        // A strip is often stiffest at its end.
        let before =
            record.stiffness.point().map(|point| &point.state).filter(|state| *state != end);
        Ok(before.into_iter().chain([end]).map(change).reduce(f64::max))
    }
}

/// A strip that is so many times as stiff as at rest is held by its scales alone.
pub(super) const LOCKED: f64 = 100.0;

/// A strain of a membrane of which its law, for small strains, says nothing.
const BEYOND_LAW: f64 = 1.0;

/// Whether scales lock a strip at the end of its path: next to nothing turns there, or only by a membrane that is torn.
fn locks(path: &[FlexurePoint]) -> bool {
    let ends = path.first().zip(path.last());
    ends.is_some_and(|(first, last)| {
        // What turns back turns next to nothing, too: the sign of the stiffness does not matter.
        last.stiffness.abs() >= LOCKED * first.stiffness || last.membrane_strain >= BEYOND_LAW
    })
}

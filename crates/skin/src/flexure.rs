//! Pure bending of a membrane that carries scales.

mod frame;
mod measures;
mod point;
mod snapshot;
mod strip;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod uneven_tests;

use std::collections::HashSet;

use contact::ContactLaw;
use frame::{Frame, Step};
use geometry::Row;
use membrane::{GapMembrane, Section, Span};
use solver::{Path, Settings, Stop};
use strip::{Extent, Strip};

use crate::arrangement::Arrangement;
use crate::contacts::{Contacts, State};
use crate::record::{ContactEvent, Iteration, Record};
use crate::{Common, ContactChange, Design, InvalidDesign, Sample, Status};

pub use measures::Measures;
pub use point::PathPoint;
pub use snapshot::{Snapshot, snapshots};

/// The part of a strip that is solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// One gap: in pure bending every gap deforms alike.
    UnitCell,
    /// Every gap of the strip, assembled.
    Chain,
}

/// Parameters of bending besides the design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// `E_ct / E_m`.
    pub contact_modulus_over_membrane: f64,
    /// One gap or all.
    pub method: Method,
    /// Length `L_whole/t` of the strip.
    pub membrane_length: f64,
    /// Thickness `h/t` of the membrane.
    pub membrane_thickness: f64,
    /// Depth of the membrane's axis below the bases of the scales, over `t`.
    pub membrane_axis_offset: f64,
    /// Beam elements per gap.
    pub elements_per_gap: usize,
    /// Rotation of each end at which bending ends, degrees.
    pub max_end_rotation_deg: f64,
}

impl Default for Parameters {
    /// The values of Shafiei et al. (2021): scales of `E_ct = 3 GPa`, 8 mm thick, on a membrane of
    /// `E_m = 4.5 MPa`, 1 mm thick.
    fn default() -> Self {
        Self {
            contact_modulus_over_membrane: 667.0,
            method: Method::UnitCell,
            membrane_length: 100.0,
            membrane_thickness: 0.125,
            membrane_axis_offset: 0.0,
            elements_per_gap: 1,
            max_end_rotation_deg: 180.0,
        }
    }
}

/// A strip that was bent.
#[derive(Clone, Debug)]
pub struct Flexure {
    /// How the path ended, and whether its end can be trusted.
    pub status: Status,
    /// The measures of the bending.
    pub measures: Measures,
    /// Every equilibrium of the path, from rest.
    pub path: Vec<PathPoint>,
    /// Every contact event, in order.
    pub events: Vec<ContactEvent<PathPoint>>,
    /// Every Newton iteration.
    pub history: Vec<Iteration>,
    /// Gaps of the strip.
    pub gaps: usize,
    /// The gaps that were solved for, at every point of the path.
    steps: Vec<Vec<Step>>,
    row: Arrangement,
}

impl Flexure {
    /// Range of `κ*` over which the gaps close: from the first contact in any of them to the first contact
    /// in the last of those that close. 0 in a perfect strip, `None` without contact.
    pub fn closing_range(&self) -> Option<f64> {
        let mut closed = HashSet::new();
        let closings = self.events.iter().filter(|event| event.change == ContactChange::Closed);
        let first = closings.filter(|event| closed.insert(event.left_scale));
        let mut curvatures = first.map(|event| event.point.curvature);
        let start = curvatures.next()?;
        Some(curvatures.last().unwrap_or(start) - start)
    }

    /// Displacement (over `t`) and rotation (radians, counter-clockwise) of every scale of the
    /// strip at a point of the path, the first scale at rest. `None` if there is no such point.
    pub fn shape(&self, point: usize) -> Option<Vec<[f64; 3]>> {
        let frames = Frame::strip(self.steps.get(point)?, self.gaps, &self.row);
        let displacement = |(i, frame): (usize, &Frame)| frame.displacement(i, &self.row);
        Some(frames.iter().enumerate().map(displacement).collect())
    }
}

/// Number of gaps `n = round(L_whole/p)` of a strip, at least 1.
pub fn gaps(row: &Row, membrane_length: f64) -> usize {
    // Saturates; a strip with more gaps than a machine word counts does not exist.
    ((membrane_length / row.pitch()).round() as usize).max(1)
}

/// Bends the strip of a `design` from rest until its ends have turned by the largest rotation.
///
/// # Errors
/// If a length, a modulus, or a constant of the contact law is not positive.
pub fn solve(
    design: &Design,
    common: &Common,
    parameters: &Parameters,
) -> Result<Flexure, InvalidDesign> {
    Ok(Problem::even(design, common, parameters)?.solve())
}

/// Bends an imperfect strip as [`solve`] does: gaps and slants are those of `sample`. Its gaps deform each in
/// its own way, so the chain of all is solved, whatever [`Parameters::method`] says. There are as many
/// gaps as in the strip of the design, and the curvature counts over the length that they
/// have.
///
/// # Errors
/// As [`solve`], or if the scales cannot be made to stand clear of each other.
pub fn solve_sample(
    design: &Design,
    common: &Common,
    parameters: &Parameters,
    sample: &Sample,
) -> Result<Flexure, InvalidDesign> {
    Ok(Problem::sample(design, common, parameters, sample)?.solve())
}

/// A strip to be bent.
struct Problem {
    row: Arrangement,
    strip: Strip,
    settings: Settings,
}

impl Problem {
    /// The strip of a design.
    fn even(
        design: &Design,
        common: &Common,
        parameters: &Parameters,
    ) -> Result<Self, InvalidDesign> {
        let row = design.row()?;
        let gaps = gaps(&row, parameters.membrane_length);
        let solved = match parameters.method {
            Method::UnitCell => 1,
            Method::Chain => gaps,
        };
        Self::new(design, common, parameters, Arrangement::Even(row), [gaps, solved])
    }

    /// A sample of the strip, with all its gaps.
    fn sample(
        design: &Design,
        common: &Common,
        parameters: &Parameters,
        sample: &Sample,
    ) -> Result<Self, InvalidDesign> {
        let gaps = gaps(&design.row()?, parameters.membrane_length);
        let row = Arrangement::Uneven(sample.row(0, gaps)?);
        Self::new(design, common, parameters, row, [gaps; 2])
    }

    /// A strip of so many gaps, of which so many are solved for.
    fn new(
        design: &Design,
        common: &Common,
        parameters: &Parameters,
        row: Arrangement,
        [gaps, solved]: [usize; 2],
    ) -> Result<Self, InvalidDesign> {
        let section = Section::new(design.width, parameters.membrane_thickness)?;
        let membrane = |gap: usize| {
            let span = Span {
                half_base: design.half_base(),
                gap: row.gap(gap),
                axis_offset: parameters.membrane_axis_offset,
            };
            GapMembrane::new(section, span, parameters.elements_per_gap)
        };
        let unlike = match &row {
            Arrangement::Even(_) => 1,
            Arrangement::Uneven(_) => solved,
        };
        let membranes = (0..unlike).map(membrane).collect::<Result<_, _>>()?;
        let modulus = parameters.contact_modulus_over_membrane;
        let law = ContactLaw::new(common.law, design.length, design.width, modulus)?;
        let whole = 2.0 * parameters.max_end_rotation_deg.to_radians();
        let rotation = whole * solved as f64 / gaps as f64;
        let extent = Extent { gaps: solved, repeats: gaps / solved, rotation };
        let strip = Strip::new(row.clone(), membranes, law, section, extent);
        Ok(Self { row, strip, settings: common.solver })
    }

    fn solve(self) -> Flexure {
        let Self { row, strip, settings } = self;
        let rest = State::at_rest(&strip);
        let alike = matches!(row, Arrangement::Even(_));
        let mut steps = vec![strip.steps(&rest.z)];
        let mut path = Path::new(strip, rest, settings);
        let mut record = Record::new(&path);
        let mut flush = false;
        while let Some(point) = path.next() {
            // Where a side lies flush in every gap at once, the moment moves the force from one end of it to the
            // other and nothing else moves: the path stands still in all that measures it.
            flush = alike && Contacts::flush(&point.state);
            if flush {
                break;
            }
            record.visit(&mut path, &point);
            steps.push(path.system().steps(&point.state.z));
        }
        let stop = if flush { Some(Stop::Singular) } else { path.stop() };
        let status = Status::of(&path, stop.unwrap_or(Stop::Reached));
        let measures = Measures::new(&record, &mut path);
        let measures = match status {
            Status::Complete => measures,
            _ => measures.without_final_values(),
        };
        let Record { path, events, history, .. } = record;
        Flexure { status, measures, path, events, history, gaps: measures.gaps, steps, row }
    }
}

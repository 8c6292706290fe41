//! Puncture of a row of scales on an elastic half-space.

mod measures;
mod point;
mod snapshot;
mod system;
#[cfg(test)]
mod tests;

use contact::{ContactLaw, Law};
use geometry::{OutOfRange, Row};
use point::scales;
use solver::{Path, Settings, Stop};
use substrate::RowStiffness;
use system::{Chain, Layout};

use crate::arrangement::Arrangement;
use crate::contacts::{Contacts, State};
use crate::record::{ContactEvent, Iteration, Record};
use crate::{Design, InvalidDesign, Sample, Status};

pub use measures::Measures;
pub use point::{PathPoint, ScaleState};
pub use snapshot::{At, Snapshot, Snapshots, snapshots};

/// Longest row that [`RowLength::Auto`] takes.
pub const LONGEST_ROW: usize = 4001;

/// An end scale of a row that is long enough has moved by less than this (over `t`; radians).
const STILL: f64 = 1e-6;

/// Number of scales in the row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowLength {
    /// As many as the deformation needs: on the whole path no end scale touches its neighbour
    /// or moves by more than `1e-6`.
    Auto,
    /// This many, the middle one (of an even number the left of the two) punctured.
    Scales(usize),
}

/// Parameters of a puncture besides the design and its substrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Poisson's ratio `ν` of the substrate.
    pub poisson_ratio: f64,
    /// Contact law between scales.
    pub law: Law,
    /// `E_ct / E_s`.
    pub contact_modulus_over_substrate: f64,
    /// Row length.
    pub scales: RowLength,
    /// Place of the load on the top of the punctured scale: 0 its left, 1 its right corner.
    pub load_position: f64,
    /// Tilt `φ_c` of the punctured scale at which the puncture ends, degrees.
    pub critical_tilt_deg: f64,
    /// Path following.
    pub solver: Settings,
}

impl Default for Parameters {
    /// The values of Shafiei et al. (2021): scales of `E_ct = 3 GPa` on a substrate of `E_s = 310 kPa`.
    fn default() -> Self {
        Self {
            poisson_ratio: 0.5,
            law: Law::PRINTED,
            contact_modulus_over_substrate: 9677.0,
            scales: RowLength::Auto,
            load_position: 1.0,
            critical_tilt_deg: 10.0,
            solver: Settings::default(),
        }
    }
}

/// A solved puncture.
#[derive(Clone, Debug)]
pub struct Puncture {
    /// How the path ended, and whether its end can be trusted.
    pub status: Status,
    /// The measures of the puncture.
    pub measures: Measures,
    /// Every equilibrium of the path, from rest.
    pub path: Vec<PathPoint>,
    /// Every contact event, in order.
    pub events: Vec<ContactEvent<PathPoint>>,
    /// Every scale at the end of the path.
    pub scales: Vec<ScaleState>,
    /// Every Newton iteration.
    pub history: Vec<Iteration>,
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
    parameters: &Parameters,
) -> Result<Puncture, InvalidDesign> {
    Problem::new(Rows::Even(design.row()?), design, substrate.into(), parameters)?.solve()
}

/// Follows the puncture of an imperfect row as [`solve`] does: gaps and slants are those of `sample`, the substrate stays
/// that of the design.
///
/// # Errors
/// As [`solve`], or if the scales cannot be made to stand clear of each other.
pub fn solve_sample(
    design: &Design,
    substrate: impl Into<RowStiffness>,
    parameters: &Parameters,
    sample: &Sample,
) -> Result<Puncture, InvalidDesign> {
    Problem::new(Rows::Sample(sample), design, substrate.into(), parameters)?.solve()
}

/// Source of rows of any length.
#[derive(Clone, Copy)]
enum Rows<'a> {
    Even(Row),
    Sample(&'a Sample),
}

impl Rows<'_> {
    fn row(self, layout: Layout) -> Result<Arrangement, InvalidDesign> {
        Ok(match self {
            Self::Even(row) => Arrangement::Even(row),
            Self::Sample(sample) => Arrangement::Uneven(sample.row(layout.left, layout.right)?),
        })
    }
}

impl Parameters {
    fn check(&self) -> Result<(), OutOfRange> {
        let scales = match self.scales {
            RowLength::Auto => 1.0,
            RowLength::Scales(scales) => scales as f64,
        };
        let tilt = self.critical_tilt_deg;
        let (ratio, position) = (self.poisson_ratio, self.load_position);
        let rules = [
            (tilt > 0.0 && tilt < 90.0, "critical tilt", tilt, "an angle between 0° and 90°"),
            ((0.0..=0.5).contains(&ratio), "poisson's ratio", ratio, "a ratio from 0 to 0.5"),
            (position.is_finite(), "load position", position, "a number"),
            (scales >= 1.0, "number of scales", scales, "at least 1"),
        ];
        match rules.into_iter().find(|(holds, ..)| !holds) {
            Some((_, quantity, value, expected)) => Err(OutOfRange { quantity, value, expected }),
            None => Ok(()),
        }
    }
}

/// The ends of a row that the deformation has reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Reached {
    left: bool,
    right: bool,
}

impl Reached {
    fn any(self) -> bool {
        self.left || self.right
    }
}

struct Problem<'a> {
    rows: Rows<'a>,
    design: &'a Design,
    stiffness: RowStiffness,
    law: ContactLaw,
    parameters: &'a Parameters,
}

impl<'a> Problem<'a> {
    fn new(
        rows: Rows<'a>,
        design: &'a Design,
        stiffness: RowStiffness,
        parameters: &'a Parameters,
    ) -> Result<Self, InvalidDesign> {
        parameters.check()?;
        let plane_modulus = 1.0 - parameters.poisson_ratio.powi(2);
        let modulus = parameters.contact_modulus_over_substrate * plane_modulus;
        let law = ContactLaw::new(parameters.law, design.length, design.width, modulus)?;
        Ok(Self { rows, design, stiffness, law, parameters })
    }

    fn solve(&self) -> Result<Puncture, InvalidDesign> {
        match self.parameters.scales {
            RowLength::Scales(scales) => {
                let left = (scales - 1) / 2;
                let layout = Layout { left, right: scales - 1 - left };
                Ok(self.follow(layout, |_| false)?.0)
            }
            RowLength::Auto => self.grow(LONGEST_ROW),
        }
    }

    /// Lengthens the row on the sides that the deformation reaches until it reaches neither, or the
    /// row is as long as the `longest`.
    fn grow(&self, longest: usize) -> Result<Puncture, InvalidDesign> {
        let mut layout = self.first_layout();
        loop {
            let (mut puncture, reached) = self.follow(layout, Reached::any)?;
            if !reached.any() {
                return Ok(puncture);
            }
            let longer = layout.doubled(reached.left, reached.right, longest);
            if longer == layout {
                puncture.status = Status::RowLimit;
                puncture.measures = puncture.measures.without_final_values();
                return Ok(puncture);
            }
            layout = longer;
        }
    }

    /// The row that suffices while no scales touch: a displacement of the punctured scale decays
    /// along the chain by the root below 1 of `β (r + 1/r) = α`, where `β` stands for all neighbours
    /// on a side.
    fn first_layout(&self) -> Layout {
        let RowStiffness { direct, neighbours, .. } = &self.stiffness;
        let side = |k: usize| neighbours.iter().map(|n| n.direct[k] / direct[k]).sum::<f64>();
        let slowest = (0..3).map(|k| 2.0 * side(k).abs()).fold(0.0, f64::max);
        let decay = (1.0 - (1.0 - slowest.min(1.0).powi(2)).sqrt()) / slowest;
        // A coupling so strong that the estimate fails starts from a long row.
        let side = (4_u8..100).find(|&n| decay.powi(i32::from(n)) <= 0.1 * STILL);
        let side = side.map_or(100, usize::from);
        Layout { left: side, right: side }
    }

    /// Follows the path on a given row until it ends, or until `give_up` says so of the ends reached.
    fn follow(
        &self,
        layout: Layout,
        give_up: impl Fn(Reached) -> bool,
    ) -> Result<(Puncture, Reached), InvalidDesign> {
        let chain = self.chain(layout)?;
        let rest = State::at_rest(&chain);
        let mut path = Path::new(chain, rest, self.parameters.solver);
        let mut record = Record::new(&path);
        let mut reached = Reached::default();
        while let Some(point) = path.next() {
            record.visit(&mut path, &point);
            reached = reached_ends(path.system(), &point.state);
            if give_up(reached) {
                break;
            }
        }
        let status = Status::of(&path, path.stop().unwrap_or(Stop::Reached));
        Ok((self.puncture(record, &mut path, status), reached))
    }

    /// The system of a row.
    fn chain(&self, layout: Layout) -> Result<Chain, InvalidDesign> {
        let Self { stiffness, law, parameters, .. } = self;
        let row = self.rows.row(layout)?;
        let tilt = parameters.critical_tilt_deg.to_radians();
        let length = self.design.length;
        Ok(Chain::new(row, stiffness, *law, layout, parameters.load_position, tilt, length))
    }

    fn puncture(&self, record: Record<Chain>, path: &mut Path<Chain>, status: Status) -> Puncture {
        let modulus = 1.0 / (1.0 - self.parameters.poisson_ratio.powi(2));
        let measures = Measures::new(&record, path, modulus);
        let measures = match status {
            Status::Complete => measures,
            _ => measures.without_final_values(),
        };
        let scales = scales(path.system(), &path.point().state);
        let Record { path, events, history, .. } = record;
        Puncture { status, measures, path, events, scales, history }
    }
}

fn reached_ends(chain: &Chain, state: &State) -> Reached {
    let last = chain.layout.scales() - 1;
    let moved = |scale| chain.displacement(&state.z, scale).iter().any(|u| u.abs() > STILL);
    let touching: Vec<bool> = Contacts::touching(state).collect();
    Reached {
        left: moved(0) || touching.first() == Some(&true),
        right: moved(last) || touching.last() == Some(&true),
    }
}

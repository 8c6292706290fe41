//! What is written down while a strip is bent.

use contact::{CornerContact, CornerEdge};
use solver::{Path, Peak};

use super::frame::Step;
use super::strip::Strip;
use super::{Flexure, Measures, Status};
use crate::ContactChange;
use crate::arrangement::Arrangement;
use crate::contacts::{Contacts, Point, State};

/// One equilibrium of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// `κ*`.
    pub curvature: f64,
    /// `M*`.
    pub moment: f64,
    /// `dM*/dκ*` of the path that goes on from here.
    pub stiffness: f64,
    /// Rotation of each end, degrees.
    pub end_rotation_deg: f64,
    /// Bending energy of the membrane of the whole strip, over `E_m t³`.
    pub bending_energy: f64,
    /// Axial energy of the membrane, over `E_m t³`.
    pub axial_energy: f64,
    /// Energy of the contacts, over `E_m t³`.
    pub contact_energy: f64,
    /// Closed contacts of the strip, rounded to whole gaps.
    pub contacts: usize,
    /// Largest strain `|ε| + ½ h |κ|` at the surface of the membrane.
    pub membrane_strain: f64,
}

/// A contact that opens, closes or passes a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Path point at which it happens.
    pub point: PathPoint,
    /// Gap, from 0; `None` where every gap does the same.
    pub gap: Option<usize>,
    /// Which corner meets which edge.
    pub corner_edge: CornerEdge,
    /// What the contact does.
    pub change: ContactChange,
}

/// One Newton iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Point of the path that it led to, from 1.
    pub step: usize,
    /// Iteration within the step, from 0.
    pub iteration: usize,
    /// Largest scaled residual.
    pub residual: f64,
    /// Rotation of each end at the point, degrees.
    pub end_rotation_deg: f64,
}

/// Collects path, events and measures while a strip is bent.
pub(crate) struct Record {
    row: Arrangement,
    /// Mean pitch `p`.
    pitch: f64,
    /// Gaps `n` of the strip.
    gaps: f64,
    /// `E_m I_m`, over `E_m t⁴`.
    bending_stiffness: f64,
    path: Vec<PathPoint>,
    events: Vec<Event>,
    history: Vec<Iteration>,
    steps: Vec<Vec<Step>>,
    stiffness: Peak<Vec<CornerContact>>,
    /// Contacts of the last point.
    before: Vec<CornerContact>,
}

impl Record {
    pub(crate) fn new(
        path: &mut Path<Strip>,
        row: Arrangement,
        gaps: f64,
        bending_stiffness: f64,
    ) -> Self {
        let mut record = Self {
            pitch: row.mean_pitch(),
            row,
            gaps,
            bending_stiffness,
            path: Vec::new(),
            events: Vec::new(),
            history: Vec::new(),
            steps: Vec::new(),
            stiffness: Peak::default(),
            before: path.point().state.mode.clone(),
        };
        record.add(path);
        record
    }

    pub(crate) fn visit(&mut self, path: &mut Path<Strip>, point: &Point) {
        let residuals = path.take_history();
        let step = self.path.len();
        let here = self.add(path);
        self.history.extend(residuals.into_iter().enumerate().map(|(iteration, residual)| {
            Iteration { step, iteration, residual, end_rotation_deg: here.end_rotation_deg }
        }));
        if let Some(solver::Event::Changed(changes)) = &point.event {
            let all_solved = path.system().gaps() == self.whole_gaps();
            self.events.extend(changes.iter().filter_map(|change| {
                let gap = Contacts::left_of(change.constraint);
                let gap = all_solved.then_some(gap);
                let corner_edge = Contacts::corner_edge(&point.state.mode, change.constraint)
                    .or_else(|| Contacts::corner_edge(&self.before, change.constraint))?;
                Some(Event {
                    point: here,
                    gap,
                    corner_edge,
                    change: ContactChange::of(&point.state, *change),
                })
            }));
        }
        self.before.clone_from(&point.state.mode);
    }

    fn add(&mut self, path: &Path<Strip>) -> PathPoint {
        let (strip, point) = (path.system(), path.point());
        let here = self.point(strip, &point.state, &point.leaving);
        self.path.push(here);
        self.steps.push(strip.steps(&point.state.z));
        self.stiffness.visit(path, |strip: &Strip, _, direction| strip.stiffness(direction));
        here
    }

    /// Gaps of the strip for each gap that is solved for.
    fn repeats(&self, strip: &Strip) -> f64 {
        self.gaps / strip.gaps() as f64
    }

    /// Gaps of the strip, rounded.
    fn whole_gaps(&self) -> usize {
        self.gaps.round() as usize
    }

    /// From `dM/dΦ` of the gaps that are solved for to `dM*/dκ*`: `M* = M/(E_m I_m)` and
    /// `κ* = Φ/(n p)`, in units of `t`.
    fn normalised(&self, strip: &Strip, stiffness: f64) -> f64 {
        stiffness * strip.gaps() as f64 * self.pitch / self.bending_stiffness
    }

    fn point(&self, strip: &Strip, state: &State, direction: &[f64]) -> PathPoint {
        let repeats = self.repeats(strip);
        let rotation = strip.rotation(&state.z);
        let [bending_energy, axial_energy, contact_energy] =
            strip.energies(state).map(|energy| energy * repeats);
        PathPoint {
            curvature: rotation / (strip.gaps() as f64 * self.pitch),
            moment: strip.moment(&state.z) / self.bending_stiffness,
            stiffness: self.normalised(strip, strip.stiffness(direction)),
            end_rotation_deg: 0.5 * (rotation * repeats).to_degrees(),
            bending_energy,
            axial_energy,
            contact_energy,
            contacts: self.whole_gaps() / strip.gaps() * Contacts::closed(state),
            membrane_strain: strip.largest_strain(state),
        }
    }

    /// The states whose measures the resolution of the membrane changes most: where the moment rises most steeply, and the
    /// last one.
    pub(crate) fn decisive_states<'a>(&'a self, path: &'a Path<Strip>) -> Vec<&'a State> {
        let steepest = self.stiffness.point().map(|point| &point.state);
        steepest.into_iter().chain([&path.point().state]).collect()
    }

    /// Whether scales have touched.
    pub(crate) fn touched(&self) -> bool {
        self.events.iter().any(|event| event.change == ContactChange::Closed)
    }

    pub(crate) fn finish(
        self,
        path: &mut Path<Strip>,
        status: Status,
        error: Option<f64>,
    ) -> Flexure {
        let mut measures = Measures { error, ..self.measures(path) };
        if status != Status::Complete {
            measures = measures.without_final_values();
        }
        let gaps = self.whole_gaps();
        let Self { row, path, events, history, steps, .. } = self;
        Flexure { status, measures, path, events, history, gaps, steps, row }
    }

    fn measures(&self, path: &mut Path<Strip>) -> Measures {
        let stiffest =
            self.stiffness.refined(path, |strip: &Strip, _, direction| strip.stiffness(direction));
        let strip = path.system();
        let first = self.events.iter().find(|event| event.change == ContactChange::Closed);
        let end = self.path.last();
        let share = end.map(|end| {
            end.axial_energy / (end.bending_energy + end.axial_energy + end.contact_energy)
        });
        Measures {
            compliance: stiffest.map(|stiffness| self.normalised(strip, stiffness).recip()),
            initial_compliance: self.path.first().map(|start| start.stiffness.recip()),
            contact: Some(first.is_some()),
            first_contact_curvature: first.map(|event| event.point.curvature),
            max_moment: self.path.iter().map(|point| point.moment).reduce(f64::max),
            axial_energy_share: share.filter(|share| share.is_finite()),
            membrane_strain_max: self.path.iter().map(|p| p.membrane_strain).reduce(f64::max),
            error: None,
            gaps: self.gaps,
        }
    }
}

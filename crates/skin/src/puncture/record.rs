//! What is written down along the path.

use contact::{CornerContact, CornerEdge};
use solver::{Path, Peak};

use super::system::Chain;
use super::{Measures, Puncture, Status};
use crate::ContactChange;
use crate::contacts::{Contacts, Point, State};

/// One equilibrium of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// `u*` of the punctured point, downward.
    pub displacement: f64,
    /// `F*`.
    pub force: f64,
    /// Tilt of the punctured scale, clockwise, degrees.
    pub tilt_deg: f64,
    /// Closed contacts.
    pub contacts: usize,
    /// Elastic energy of the substrate, over `E* t³`.
    pub substrate_energy: f64,
    /// Elastic energy of the contacts, over `E* t³`. With that of the substrate it is the work
    /// `∫ F du` of the load.
    pub contact_energy: f64,
}

/// A contact that opens or closes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Path point at which it happens.
    pub point: PathPoint,
    /// Left scale of the pair; 0 is the punctured one, positive to the right.
    pub left_scale: i64,
    /// Which corner meets which edge.
    pub corner_edge: CornerEdge,
    /// What the contact does.
    pub change: ContactChange,
}

/// One scale at the end of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleState {
    /// 0 is the punctured scale, positive to the right.
    pub scale: i64,
    /// Displacement of the node, over `t`.
    pub displacement: [f64; 2],
    /// Rotation, counter-clockwise, degrees.
    pub rotation_deg: f64,
    /// Vertical reaction of the substrate on the scale, upward, over `E* t²`.
    pub reaction: f64,
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
    /// Tilt of the punctured scale at the point, degrees.
    pub tilt_deg: f64,
}

/// Collects path, events and measures while a path is followed.
pub(crate) struct Record {
    /// `L/t`.
    length: f64,
    path: Vec<PathPoint>,
    events: Vec<Event>,
    history: Vec<Iteration>,
    stiffness: Peak<Vec<CornerContact>>,
    initial_stiffness: f64,
    /// Contacts of the last point.
    before: Vec<CornerContact>,
}

impl Record {
    pub(crate) fn new(path: &mut Path<Chain>, length: f64) -> Self {
        let start = path.point().clone();
        let chain = path.system();
        let mut record = Self {
            length,
            path: Vec::new(),
            events: Vec::new(),
            history: Vec::new(),
            stiffness: Peak::default(),
            initial_stiffness: stiffness(chain, &start.state, &start.leaving),
            before: start.state.mode.clone(),
        };
        record.path.push(record.point(chain, &start.state));
        record.stiffness.visit(path, stiffness);
        record
    }

    pub(crate) fn visit(&mut self, path: &mut Path<Chain>, point: &Point) {
        let residuals = path.take_history();
        let chain = path.system();
        let here = self.point(chain, &point.state);
        let step = self.path.len();
        self.path.push(here);
        self.stiffness.visit(path, stiffness);
        self.history.extend(residuals.into_iter().enumerate().map(|(iteration, residual)| {
            Iteration { step, iteration, residual, tilt_deg: here.tilt_deg }
        }));
        if let Some(solver::Event::Changed(changes)) = &point.event {
            self.events.extend(changes.iter().filter_map(|change| {
                let left_scale = chain.layout.number(Contacts::left_of(change.constraint));
                let corner_edge = Contacts::corner_edge(&point.state.mode, change.constraint)
                    .or_else(|| Contacts::corner_edge(&self.before, change.constraint))?;
                Some(Event {
                    point: here,
                    left_scale,
                    corner_edge,
                    change: ContactChange::of(&point.state, *change),
                })
            }));
        }
        self.before.clone_from(&point.state.mode);
    }

    /// Takes the points that are kept to those of a longer row.
    pub(crate) fn extend(&mut self, extended: impl Fn(&Point) -> Point, here: &Point) {
        self.stiffness.replace_points(extended);
        self.before.clone_from(&here.state.mode);
    }

    fn point(&self, chain: &Chain, state: &State) -> PathPoint {
        let z = &state.z;
        let (substrate_energy, contact_energy) = chain.energies(state);
        PathPoint {
            displacement: chain.depth(z),
            force: z[chain.layout.load()] / self.length,
            tilt_deg: -chain.displacement(z, chain.layout.left)[2].to_degrees(),
            contacts: Contacts::closed(state),
            substrate_energy,
            contact_energy,
        }
    }

    pub(crate) fn finish(
        self,
        path: &mut Path<Chain>,
        status: Status,
        poisson_ratio: f64,
    ) -> Puncture {
        let mut measures = self.measures(path, 1.0 / (1.0 - poisson_ratio.powi(2)));
        if status != Status::Complete {
            measures = measures.without_final_values();
        }
        let scales = scales(path.system(), &path.point().state);
        let Self { path, events, history, .. } = self;
        Puncture { status, measures, path, events, scales, history }
    }

    /// `modulus` is `E*/E_s`: stiffness is measured in `E_s t`, the force in `E* t²`.
    fn measures(&self, path: &mut Path<Chain>, modulus: f64) -> Measures {
        let max_stiffness = self.stiffness.refined(path, stiffness);
        let chain = path.system();
        let z = &path.point().state.z;
        let end = self.point(chain, &path.point().state);
        let nodes = (0..chain.layout.scales()).map(|i| -chain.displacement(z, i)[1]);
        let first_contact = self.events.iter().find(|event| event.change == ContactChange::Closed);
        Measures {
            critical_force: Some(end.force),
            peak_force: self.path.iter().map(|point| point.force).reduce(f64::max),
            critical_displacement: Some(end.displacement),
            penetration: (0..chain.layout.scales())
                .map(|i| chain.base_depth(z, i))
                .reduce(f64::max),
            sink: nodes.reduce(f64::max),
            first_contact_displacement: first_contact.map(|event| event.point.displacement),
            contacts: Some(end.contacts),
            engaged_scales: Some(engaged(
                &Contacts::touching(&path.point().state).collect::<Vec<_>>(),
            )),
            scales: chain.layout.scales(),
            initial_stiffness: Some(modulus * self.initial_stiffness),
            max_stiffness: max_stiffness.map(|k| modulus * k),
            secant_stiffness: Some(modulus * end.force * self.length / end.displacement),
        }
    }
}

/// Tangent stiffness `dF/du` of the punctured point, over `E* t`.
fn stiffness(chain: &Chain, state: &State, direction: &[f64]) -> f64 {
    direction[chain.layout.load()] / chain.depth_slope(&state.z, direction)
}

/// Scales that touch a neighbour, from which pairs are `touching`.
fn engaged(touching: &[bool]) -> usize {
    let touches = |pair: Option<usize>| pair.is_some_and(|pair| touching.get(pair) == Some(&true));
    (0..=touching.len()).filter(|&i| touches(Some(i)) || touches(i.checked_sub(1))).count()
}

pub(super) fn scales(chain: &Chain, state: &State) -> Vec<ScaleState> {
    (0..chain.layout.scales())
        .map(|i| {
            let [x, y, rotation] = chain.displacement(&state.z, i);
            ScaleState {
                scale: chain.layout.number(i),
                displacement: [x, y],
                rotation_deg: rotation.to_degrees(),
                reaction: chain.reaction(&state.z, i)[1],
            }
        })
        .collect()
}

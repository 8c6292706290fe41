//! The record of a path, of a row that is punctured or of a strip that is bent.

use std::cell::OnceCell;
use std::sync::Arc;

use contact::CornerEdge;
use solver::{Change, Path, Peak, Summit, System};

use crate::contacts::{ContactChange, Contacts, SkinMode, SkinPoint, SkinState};

/// A contact that changes its state: it opens, closes or passes a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEvent<P> {
    /// The point of the path at which it happens.
    pub point: P,
    /// Left scale of the pair: in a row 0 is the punctured scale, in a strip the first one, and numbers rise to the
    /// right. `None` where every pair does the same.
    pub left_scale: Option<i64>,
    /// Right scale of the pair: in nearly every row the next one.
    pub right_scale: Option<i64>,
    /// Which corner meets which edge.
    pub corner_edge: CornerEdge,
    /// The change of the contact.
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
    /// Control parameter at the point, degrees: tilt of the punctured scale, or rotation of each end of a strip.
    pub angle_deg: f64,
}

/// A row or a strip of scales whose path is recorded.
pub(crate) trait Skin: System<Mode = SkinMode> {
    /// The numbers that are recorded of an equilibrium.
    type PathPoint: Copy;

    /// The contacts of the scales.
    fn contacts(&self) -> &Contacts;

    /// The numbers to record of an equilibrium.
    fn path_point(&self, point: &SkinPoint) -> Self::PathPoint;

    /// Notes in the numbers of a point what friction between neighbours has taken up to there.
    fn note_friction(&self, point: &mut Self::PathPoint, work: f64);

    /// Whether friction acts anywhere on the path.
    fn has_friction(&self) -> bool {
        self.contacts().has_friction()
    }

    /// What friction at the tip of a needle takes between two neighbouring points, as [`Contacts::friction_work`] does.
    fn tip_work(&self, _from: &SkinPoint, _to: &SkinPoint, _spans: [f64; 2]) -> f64 {
        0.0
    }

    /// Elastic energy, of all that the load works on.
    fn stored(&self, state: &SkinState) -> f64;

    /// How often all that is solved for is there.
    fn repeats(&self) -> f64 {
        1.0
    }

    /// The control parameter, degrees.
    fn angle_deg(&self, state: &SkinState) -> f64;

    /// Derivative of the load with respect to what the load moves, along a direction of the path.
    fn stiffness(&self, state: &SkinState, direction: &[f64]) -> f64;

    /// Number of a scale as people count them; `None` where every pair does the same.
    fn number(&self, scale: usize) -> Option<i64>;

    /// Whether any two scales that may meet overlap by more than the approach of their contacts.
    fn interpenetrates(&self, state: &SkinState) -> bool;

    /// Whether a contact is about to pass an end of what it lies on, where the model knows nothing to go on with.
    fn passes_an_end(&self, at: &SkinPoint) -> bool {
        self.contacts().off_edge(&at.state) || self.contacts().passes_an_end(at)
    }
}

/// What friction has taken along a path, of what is solved for.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Between neighbours.
    between_scales: f64,
    /// At the tip of a needle.
    at_tip: f64,
}

impl Work {
    /// Adds what is taken between two neighbouring points.
    pub(crate) fn add<S: Skin>(&mut self, path: &Path<S>, from: &SkinPoint, to: &SkinPoint) {
        let skin = path.system();
        if skin.has_friction() {
            let spans = path.spans(from, to);
            self.between_scales += skin.contacts().friction_work(from, to, spans);
            self.at_tip += skin.tip_work(from, to, spans);
        }
    }

    /// Notes in the numbers of a point what neighbours have taken up to there.
    pub(crate) fn note<S: Skin>(&self, skin: &S, point: &mut S::PathPoint) {
        if skin.contacts().has_friction() {
            skin.note_friction(point, skin.repeats() * self.between_scales);
        }
    }

    pub(crate) fn taken(&self) -> f64 {
        self.between_scales + self.at_tip
    }
}

/// A function of a skin, an equilibrium and the direction of the path there.
pub(crate) type PathFunction<S> = fn(&S, &SkinState, &[f64]) -> f64;

/// Points, events and iterations of a path, and its largest stiffness.
pub(crate) struct Record<S: Skin> {
    pub(crate) path: Vec<S::PathPoint>,
    pub(crate) events: Vec<ContactEvent<S::PathPoint>>,
    pub(crate) history: Vec<Iteration>,
    /// What friction has taken so far.
    pub(crate) work: Work,
    /// The stiffness at the beginning of the path.
    pub(crate) initial_stiffness: f64,
    /// The largest stiffness at its points.
    pub(crate) stiffness: Peak<SkinMode>,
    /// The largest stiffness between the points too, once it has been searched.
    stiffness_summit: OnceCell<Option<Summit<SkinMode>>>,
    /// Further functions of which the largest value is searched.
    followed: Vec<(PathFunction<S>, Peak<SkinMode>)>,
    /// The equilibrium at which the first contact closes.
    pub(crate) touching: Option<SkinPoint>,
}

impl<S: Skin> Record<S> {
    /// The record of a path that is at its beginning, which follows the largest values of some functions besides.
    pub(crate) fn new(path: &Path<S>, functions: &[PathFunction<S>]) -> Self {
        let (skin, start) = (path.system(), path.point());
        let mut record = Self {
            path: vec![skin.path_point(start)],
            events: Vec::new(),
            history: Vec::new(),
            work: Work::default(),
            // At rest load and displacement vanish: the direction alone tells their ratio.
            initial_stiffness: skin.stiffness(&start.state, &start.leaving),
            stiffness: Peak::default(),
            stiffness_summit: OnceCell::new(),
            followed: functions.iter().map(|&f| (f, Peak::default())).collect(),
            touching: None,
        };
        record.visit_peaks(path, None);
        record
    }

    /// Records the `point` that the path has come to, `from` the one before.
    pub(crate) fn visit(&mut self, path: &mut Path<S>, from: &Arc<SkinPoint>, point: &SkinPoint) {
        let residuals = path.take_history();
        let (mut here, step) = (path.system().path_point(point), self.path.len());
        // The segment is added before the point is noted, which tells the work up to it.
        self.work.add(path, from, point);
        let skin = path.system();
        self.work.note(skin, &mut here);
        let angle_deg = skin.angle_deg(&point.state);
        let iteration = |(iteration, residual)| Iteration { step, iteration, residual, angle_deg };
        self.history.extend(residuals.into_iter().enumerate().map(iteration));
        if let Some(solver::Event::Changed(changes)) = &point.event {
            let event =
                |&change: &Change| Self::event(skin, [&from.state, &point.state], here, change);
            let events: Vec<_> = changes.iter().filter_map(event).collect();
            if self.touching.is_none()
                && events.iter().any(|event| event.change == ContactChange::Closed)
            {
                // The whole equilibrium is kept, because derivatives are taken at it.
                self.touching = Some(point.clone());
            }
            self.events.extend(events);
        }
        self.path.push(here);
        self.visit_peaks(path, Some(from));
    }

    fn visit_peaks(&mut self, path: &Path<S>, from: Option<&Arc<SkinPoint>>) {
        // The path has gone on: what was the summit before need not be it any more.
        self.stiffness_summit.take();
        self.stiffness.visit(path, from, S::stiffness);
        for (f, peak) in &mut self.followed {
            peak.visit(path, from, *f);
        }
    }

    /// Takes the points that are kept for maxima to those of a longer row.
    pub(crate) fn replace_points(&mut self, new: impl Fn(&SkinPoint) -> SkinPoint) {
        for (_, peak) in &mut self.followed {
            peak.replace_points(&new);
        }
        // A summit that was searched before has its points on the shorter row.
        self.stiffness_summit.take();
        self.stiffness.replace_points(new);
    }

    /// The event of a force that has changed sides between two states.
    fn event(
        skin: &S,
        [before, after]: [&SkinState; 2],
        point: S::PathPoint,
        change: Change,
    ) -> Option<ContactEvent<S::PathPoint>> {
        let contacts = skin.contacts();
        if change.constraint >= contacts.forces.len() {
            // A guided needle has changes of its own.
            return None;
        }
        let corner_edge = |mode| contacts.corner_edge(mode, change.constraint);
        let [left, right] = contacts.scales_of(change.constraint);
        Some(ContactEvent {
            point,
            left_scale: skin.number(left),
            right_scale: skin.number(right),
            // A contact that has opened had its corner and edge before.
            corner_edge: corner_edge(&after.mode).or_else(|| corner_edge(&before.mode))?,
            change: ContactChange::classify(contacts, after, change),
        })
    }

    /// The point at which scales first touch.
    pub(crate) fn first_contact(&self) -> Option<&S::PathPoint> {
        let closed = |event: &&ContactEvent<_>| event.change == ContactChange::Closed;
        self.events.iter().find(closed).map(|event| &event.point)
    }

    /// The largest stiffness and its place.
    pub(crate) fn stiffness_summit(&self, path: &mut Path<S>) -> Option<&Summit<S::Mode>> {
        // The search solves for equilibria, so the measure and its derivatives share one.
        self.stiffness_summit.get_or_init(|| self.stiffness.summit(path, S::stiffness)).as_ref()
    }

    /// The largest value of a function that is followed, by its index, at the points of the path, and its place: that of a load is
    /// one of them.
    pub(crate) fn highest_point(&self, followed: usize) -> Option<Summit<S::Mode>> {
        self.followed.get(followed)?.1.at_points()
    }

    /// The largest value of a function that is followed, by its index, and its place.
    pub(crate) fn summit(&self, path: &mut Path<S>, followed: usize) -> Option<Summit<S::Mode>> {
        let (f, peak) = self.followed.get(followed)?;
        peak.summit(path, *f)
    }
}

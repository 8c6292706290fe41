//! Record of the path of a row or a strip.

use std::cell::OnceCell;
use std::sync::Arc;

use contact::CornerEdge;
use solver::{Change, Continuation, Peak, Summit, System};

use crate::contacts::{ContactChange, Contacts, Dissipation, SkinMode, SkinPoint, SkinState};

/// Contact state change: it opens, closes, passes a corner, sticks or slips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEvent<P> {
    /// Path point of the event.
    pub point: P,
    /// Left scale of the pair; `None` if all pairs behave alike.
    ///
    /// Numbered to the right from the punctured scale or from the first scale of a strip.
    pub left_scale: Option<i64>,
    /// Right scale of the pair: nearly always the neighbour.
    pub right_scale: Option<i64>,
    /// Corner and edge that touch.
    pub corner_edge: CornerEdge,
    /// Change of the contact.
    pub change: ContactChange,
}

/// One Newton iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Index of the path point to which the iteration led, from 1.
    pub step: usize,
    /// Iteration within the step, from 0.
    pub iteration: usize,
    /// Largest scaled residual.
    pub residual: f64,
    /// Control parameter at the point, degrees.
    ///
    /// Tilt of the punctured scale, or rotation of each end of a strip.
    pub angle_deg: f64,
}

/// A row or a strip of scales with a recorded path.
pub(crate) trait Skin: System<Mode = SkinMode> {
    /// Numbers recorded per equilibrium.
    type PathPoint: Copy;

    /// Returns the contacts of the scales.
    fn contacts(&self) -> &Contacts;

    /// Computes the numbers to record for an equilibrium.
    fn path_point(&self, point: &SkinPoint) -> Self::PathPoint;

    /// Stores the accumulated dissipation between neighbours in a recorded point.
    fn note_friction(&self, point: &mut Self::PathPoint, work: f64);

    /// Returns true if friction acts anywhere.
    fn has_friction(&self) -> bool {
        self.contacts().has_friction()
    }

    /// Computes the needle-tip dissipation, like [`Contacts::friction_work`].
    fn tip_work(&self, _from: &SkinPoint, _to: &SkinPoint, _spans: [f64; 2]) -> Dissipation {
        Dissipation::default()
    }

    /// Computes the elastic energy of the whole system.
    fn stored(&self, state: &SkinState) -> f64;

    /// Returns the number of copies of the solved part in the whole system.
    fn repeats(&self) -> f64 {
        1.0
    }

    /// Returns the control parameter, degrees.
    fn angle_deg(&self, state: &SkinState) -> f64;

    /// Computes the derivative of the load by its displacement, along a path direction.
    fn stiffness(&self, state: &SkinState, direction: &[f64]) -> f64;

    /// Returns the number of a scale in reports; `None` if all pairs behave alike.
    fn number(&self, scale: usize) -> Option<i64>;

    /// Returns true if scales that may touch overlap beyond their contact approach.
    fn interpenetrates(&self, state: &SkinState) -> bool;

    /// Returns true if a contact is about to pass an end of its edge.
    ///
    /// The model has no contact beyond that end.
    fn passes_an_end(&self, at: &SkinPoint) -> bool {
        self.contacts().off_edge(&at.state) || self.contacts().passes_an_end(at)
    }
}

/// Frictional dissipation along a path, per solved part.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Between scales.
    between_scales: f64,
    /// At the tip of a needle.
    at_tip: f64,
}

/// Largest difference between cubics and the trapezoidal rule within one segment.
///
/// It is relative to the dissipation so far. For 4400 random designs the error of `loop_work` is
/// then below 0.2 %.
const BEND: f64 = 0.005;

/// Maximum number of bisections of a segment.
const BISECTIONS: usize = 8;

impl Work {
    /// Adds the dissipation between two neighbouring points.
    pub(crate) fn add<S: Skin>(
        &mut self,
        path: &mut Continuation<S>,
        from: &SkinPoint,
        to: &SkinPoint,
    ) {
        if path.system().has_friction() {
            self.add_segment(path, from, to, BISECTIONS);
        }
    }

    /// Adds the dissipation along a segment, and bisects it where the dissipation is not smooth.
    fn add_segment<S: Skin>(
        &mut self,
        path: &mut Continuation<S>,
        from: &SkinPoint,
        to: &SkinPoint,
        bisections: usize,
    ) {
        let skin = path.system();
        let spans = path.spans(from, to);
        let between_scales = skin.contacts().friction_work(from, to, spans);
        let at_tip = skin.tip_work(from, to, spans);
        let allowed = BEND * (self.total() + between_scales.value + at_tip.value).abs();
        let is_smooth = [between_scales, at_tip]
            .iter()
            .all(|part| (part.value - part.trapezoid).abs() <= allowed);
        if !is_smooth
            && bisections > 0
            && let Some(middle) = path.between(from, to, 0.5)
        {
            self.add_segment(path, from, &middle, bisections - 1);
            self.add_segment(path, &middle, to, bisections - 1);
            return;
        }
        self.between_scales += between_scales.value;
        self.at_tip += at_tip.value;
    }

    /// Stores the dissipation between scales in a recorded point.
    pub(crate) fn note<S: Skin>(&self, skin: &S, point: &mut S::PathPoint) {
        if skin.contacts().has_friction() {
            skin.note_friction(point, skin.repeats() * self.between_scales);
        }
    }

    /// Returns the dissipation between scales and at the needle tip.
    pub(crate) fn total(&self) -> f64 {
        self.between_scales + self.at_tip
    }
}

/// A function of skin, equilibrium and path direction.
pub(crate) type PathFunction<S> = fn(&S, &SkinState, &[f64]) -> f64;

/// Points, events and iterations of a path, and maxima of functions along it.
pub(crate) struct Record<S: Skin> {
    pub(crate) path: Vec<S::PathPoint>,
    pub(crate) events: Vec<ContactEvent<S::PathPoint>>,
    pub(crate) history: Vec<Iteration>,
    /// Dissipation so far.
    pub(crate) work: Work,
    /// Stiffness at the start of the path.
    pub(crate) initial_stiffness: f64,
    /// Largest stiffness at the recorded points.
    pub(crate) stiffness: Peak<SkinMode>,
    /// Largest stiffness at and between the recorded points; empty until it is searched.
    stiffness_summit: OnceCell<Option<Summit<SkinMode>>>,
    /// Further functions with a tracked maximum.
    followed: Vec<(PathFunction<S>, Peak<SkinMode>)>,
    /// Equilibrium at which the first contact closes.
    pub(crate) touching: Option<SkinPoint>,
    /// The equilibrium of the first contact, in the form stored in the path.
    first_contact: Option<S::PathPoint>,
}

impl<S: Skin> Record<S> {
    /// Starts the record of a path, and tracks the maxima of some `functions`.
    pub(crate) fn new(path: &Continuation<S>, functions: &[PathFunction<S>]) -> Self {
        let (skin, start) = (path.system(), path.point());
        let mut record = Self {
            path: vec![skin.path_point(start)],
            events: Vec::new(),
            history: Vec::new(),
            work: Work::default(),
            // At rest load and displacement vanish, so only the direction gives their ratio.
            initial_stiffness: skin.stiffness(&start.state, &start.leaving),
            stiffness: Peak::default(),
            stiffness_summit: OnceCell::new(),
            followed: functions.iter().map(|&f| (f, Peak::default())).collect(),
            touching: None,
            first_contact: None,
        };
        record.visit_peaks(path, None);
        record
    }

    /// Records a new `point`, with `from` as its predecessor.
    pub(crate) fn visit(
        &mut self,
        path: &mut Continuation<S>,
        from: &Arc<SkinPoint>,
        point: &SkinPoint,
    ) {
        let residuals = path.take_history();
        let (mut here, step) = (path.system().path_point(point), self.path.len());
        // Add the segment first: the recorded point includes its dissipation.
        self.work.add(path, from, point);
        let skin = path.system();
        self.work.note(skin, &mut here);
        let angle_deg = skin.angle_deg(&point.state);
        self.history.extend(
            residuals.into_iter().enumerate().map(|(iteration, residual)| Iteration {
                step,
                iteration,
                residual,
                angle_deg,
            }),
        );
        if let Some(solver::Event::Changed(changes)) = &point.event {
            let event =
                |&change: &Change| Self::event(skin, [&from.state, &point.state], here, change);
            let events: Vec<_> = changes.iter().filter_map(event).collect();
            // With friction, corners that meet may stick or be handed over without a closing event.
            if self.touching.is_none() && Contacts::closed(&point.state) > 0 {
                // Keep the whole equilibrium, because derivatives are taken at it.
                self.touching = Some(point.clone());
                self.first_contact = Some(here);
            }
            self.events.extend(events);
        }
        self.path.push(here);
        self.visit_peaks(path, Some(from));
    }

    fn visit_peaks(&mut self, path: &Continuation<S>, from: Option<&Arc<SkinPoint>>) {
        // The path has grown, so a cached maximum may be outdated.
        self.stiffness_summit.take();
        self.stiffness.visit(path, from, S::stiffness);
        for (f, peak) in &mut self.followed {
            peak.visit(path, from, *f);
        }
    }

    /// Extends the points kept for maxima to a longer row.
    pub(crate) fn replace_points(&mut self, new: impl Fn(&SkinPoint) -> SkinPoint) {
        for (_, peak) in &mut self.followed {
            peak.replace_points(&new);
        }
        // A cached maximum has its points on the shorter row.
        self.stiffness_summit.take();
        self.stiffness.replace_points(new);
    }

    /// Describes the event of a changed force between two states.
    fn event(
        skin: &S,
        [before, after]: [&SkinState; 2],
        point: S::PathPoint,
        change: Change,
    ) -> Option<ContactEvent<S::PathPoint>> {
        let contacts = skin.contacts();
        if change.constraint >= contacts.forces.len() {
            // Needle events are not contact events.
            return None;
        }
        // An opened contact has its corner and edge only in the previous state.
        let corner_edge = [after, before]
            .into_iter()
            .find_map(|state| contacts.corner_edge(&state.mode, change.constraint))?;
        let [left, right] = contacts.scales_of(change.constraint);
        Some(ContactEvent {
            point,
            left_scale: skin.number(left),
            right_scale: skin.number(right),
            corner_edge,
            change: ContactChange::classify(contacts, after, change),
        })
    }

    /// Returns the point of first contact.
    pub(crate) fn first_contact(&self) -> Option<&S::PathPoint> {
        self.first_contact.as_ref()
    }

    /// Returns the largest stiffness and its location.
    pub(crate) fn stiffness_summit(&self, path: &mut Continuation<S>) -> Option<&Summit<S::Mode>> {
        // The search solves for equilibria, so share its result between measure and derivatives.
        self.stiffness_summit.get_or_init(|| self.stiffness.summit(path, S::stiffness)).as_ref()
    }

    /// Returns the largest value of a tracked function at recorded points, and where.
    ///
    /// Extrema of the load are recorded points, so this suffices for the load.
    pub(crate) fn highest_point(&self, followed: usize) -> Option<Summit<S::Mode>> {
        self.followed.get(followed)?.1.at_points()
    }

    /// Returns the largest value of a tracked function, and its location.
    pub(crate) fn summit(
        &self,
        path: &mut Continuation<S>,
        followed: usize,
    ) -> Option<Summit<S::Mode>> {
        let (f, peak) = self.followed.get(followed)?;
        peak.summit(path, *f)
    }
}

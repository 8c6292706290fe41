//! Record of the path of a row or a strip: points, events, iterations, dissipation and maxima.

use std::cell::OnceCell;
use std::sync::Arc;

use contact::CornerEdge;
use solver::{Change, Continuation, Peak, Summit, System};

use crate::contacts::{ContactChange, Contacts, Dissipation, SkinMode, SkinPoint, SkinState};

/// Change of a contact: it opens, closes, passes a corner, begins to stick or begins to slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEvent<P> {
    /// Path point of the event.
    pub point: P,
    /// Number of the left scale of the pair; `None` if all pairs behave alike.
    ///
    /// Numbers increase to the right. Number 0 is the punctured scale or the first scale of a
    /// strip.
    pub left_scale: Option<i64>,
    /// Number of the right scale of the pair, nearly always the neighbour of the left scale.
    pub right_scale: Option<i64>,
    /// Corner and edge in contact.
    pub corner_edge: CornerEdge,
    /// New state of the contact.
    pub change: ContactChange,
}

/// One Newton iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Index of the path point for which the iteration was done; the first solved point has 1.
    pub step: usize,
    /// Number of the iteration within the step, from 0.
    pub iteration: usize,
    /// Largest of the residuals, each divided by the size of its equation (N2).
    pub residual: f64,
    /// Control parameter at the path point, degrees.
    ///
    /// This is the tilt of the punctured scale, or the rotation of each end of a strip.
    pub angle_deg: f64,
}

/// A punctured row or a bent strip of scales with a recorded path.
pub(crate) trait Skin: System<Mode = SkinMode> {
    /// Values recorded for each equilibrium.
    type PathPoint: Copy;

    /// Returns the contacts of the scales.
    fn contacts(&self) -> &Contacts;

    /// Computes the values to record for an equilibrium.
    fn path_point(&self, point: &SkinPoint) -> Self::PathPoint;

    /// Stores in a recorded point the frictional dissipation between scales since rest.
    fn note_friction(&self, point: &mut Self::PathPoint, work: f64);

    /// Returns true if friction acts between scales or at the needle.
    fn has_friction(&self) -> bool {
        self.contacts().has_friction()
    }

    /// Computes the frictional dissipation at the needle tip between two points.
    ///
    /// The arguments have the same meaning as in [`Contacts::friction_work`].
    fn tip_work(&self, _from: &SkinPoint, _to: &SkinPoint, _spans: [f64; 2]) -> Dissipation {
        Dissipation::default()
    }

    /// Computes the elastic energy of the whole system.
    fn stored(&self, state: &SkinState) -> f64;

    /// Returns how often the solved part is repeated in the whole row or strip.
    ///
    /// In a strip of equal gaps one gap is solved, and the result is the number of gaps. Otherwise
    /// the result is 1.
    fn repeats(&self) -> f64 {
        1.0
    }

    /// Returns the control parameter, degrees.
    fn angle_deg(&self, state: &SkinState) -> f64;

    /// Computes the derivative of the load with respect to its displacement, along `direction`.
    fn stiffness(&self, state: &SkinState, direction: &[f64]) -> f64;

    /// Returns the number of a scale in reports; `None` if all pairs behave alike.
    fn number(&self, scale: usize) -> Option<i64>;

    /// Returns true if two scales overlap by more than the approach of their contacts.
    fn interpenetrates(&self, state: &SkinState) -> bool;

    /// Returns true if a contact lies beyond an end of its edge or is about to pass this end.
    ///
    /// The contact model does not cover positions beyond the end.
    fn passes_an_end(&self, at: &SkinPoint) -> bool {
        self.contacts().off_edge(&at.state) || self.contacts().passes_an_end(at)
    }
}

/// Frictional dissipation of the solved part, from rest to the current point of a path.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Dissipation between scales.
    between_scales: f64,
    /// Dissipation at the tip of a needle.
    at_tip: f64,
}

/// Largest accepted difference between two integration rules for the dissipation of a segment.
///
/// The rules are cubics and the trapezoidal rule. The difference is relative to the dissipation
/// since rest. With this limit the error of `loop_work` is below 0.2 % for 4400 random designs.
const RULE_DIFFERENCE: f64 = 0.005;

/// Maximum number of successive bisections of a segment.
const BISECTIONS: usize = 8;

impl Work {
    /// Adds the dissipation between two neighbouring points of a path.
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

    /// Adds the dissipation of the segment between two points.
    ///
    /// Bisects the segment if the two integration rules differ by more than [`RULE_DIFFERENCE`].
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
        let allowed = RULE_DIFFERENCE * (self.total() + between_scales.value + at_tip.value).abs();
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

    /// Stores the dissipation between scales of the whole row or strip in a recorded point.
    pub(crate) fn note<S: Skin>(&self, skin: &S, point: &mut S::PathPoint) {
        if skin.contacts().has_friction() {
            skin.note_friction(point, skin.repeats() * self.between_scales);
        }
    }

    /// Returns the sum of the dissipation between scales and at the needle tip.
    pub(crate) fn total(&self) -> f64 {
        self.between_scales + self.at_tip
    }
}

/// A function of skin, state and path direction.
pub(crate) type PathFunction<S> = fn(&S, &SkinState, &[f64]) -> f64;

/// Points, events and iterations of a path, and maxima of functions along it.
pub(crate) struct Record<S: Skin> {
    pub(crate) path: Vec<S::PathPoint>,
    pub(crate) events: Vec<ContactEvent<S::PathPoint>>,
    pub(crate) history: Vec<Iteration>,
    /// Dissipation from rest to the last point.
    pub(crate) work: Work,
    /// Stiffness at the start of the path.
    pub(crate) initial_stiffness: f64,
    /// Largest stiffness at the recorded points.
    pub(crate) stiffness: Peak<SkinMode>,
    /// Cached result of the search for the largest stiffness at and between the recorded points.
    stiffness_summit: OnceCell<Option<Summit<SkinMode>>>,
    /// Functions other than the stiffness, each with its largest value at the recorded points.
    followed: Vec<(PathFunction<S>, Peak<SkinMode>)>,
    /// Equilibrium at which the first contact closes.
    pub(crate) touching: Option<SkinPoint>,
    /// Recorded values of the equilibrium `touching`.
    first_contact: Option<S::PathPoint>,
}

impl<S: Skin> Record<S> {
    /// Starts the record at the current point of `path`, and tracks the maxima of `functions`.
    pub(crate) fn new(path: &Continuation<S>, functions: &[PathFunction<S>]) -> Self {
        let (skin, start) = (path.system(), path.point());
        let mut record = Self {
            path: vec![skin.path_point(start)],
            events: Vec::new(),
            history: Vec::new(),
            work: Work::default(),
            // At rest load and displacement vanish, so the stiffness follows from the direction.
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

    /// Records the current `point` of `path`; `from` is the point before it.
    pub(crate) fn visit(
        &mut self,
        path: &mut Continuation<S>,
        from: &Arc<SkinPoint>,
        point: &SkinPoint,
    ) {
        let residuals = path.take_history();
        let (mut here, step) = (path.system().path_point(point), self.path.len());
        // Add the dissipation of this segment first: the recorded point stores the sum since rest.
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
            // Count closed contacts instead of looking for a closing event: with friction, two
            // corners that touch may stick without a closing event.
            if self.touching.is_none() && Contacts::closed(&point.state) > 0 {
                // Derivatives at first contact need the whole equilibrium.
                self.touching = Some(point.clone());
                self.first_contact = Some(here);
            }
            self.events.extend(events);
        }
        self.path.push(here);
        self.visit_peaks(path, Some(from));
    }

    fn visit_peaks(&mut self, path: &Continuation<S>, from: Option<&Arc<SkinPoint>>) {
        // The new point may exceed the cached maximum.
        self.stiffness_summit.take();
        self.stiffness.visit(path, from, S::stiffness);
        for (f, peak) in &mut self.followed {
            peak.visit(path, from, *f);
        }
    }

    /// Replaces the points stored for maxima by points of a longer row.
    ///
    /// `new` converts a point of the shorter row to the longer row.
    pub(crate) fn replace_points(&mut self, new: impl Fn(&SkinPoint) -> SkinPoint) {
        for (_, peak) in &mut self.followed {
            peak.replace_points(&new);
        }
        // The cached maximum refers to points of the shorter row.
        self.stiffness_summit.take();
        self.stiffness.replace_points(new);
    }

    /// Describes the change of one contact force between the states before and after an event.
    ///
    /// `None` if the constraint belongs to the needle.
    fn event(
        skin: &S,
        [before, after]: [&SkinState; 2],
        point: S::PathPoint,
        change: Change,
    ) -> Option<ContactEvent<S::PathPoint>> {
        let contacts = skin.contacts();
        if change.constraint >= contacts.forces.len() {
            // Needle constraints follow the contact constraints.
            return None;
        }
        // If the contact opened, only the state before the event has its corner and edge.
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

    /// Returns the recorded point of first contact; `None` without contact.
    pub(crate) fn first_contact(&self) -> Option<&S::PathPoint> {
        self.first_contact.as_ref()
    }

    /// Returns the largest stiffness on the path and its point.
    pub(crate) fn stiffness_summit(&self, path: &mut Continuation<S>) -> Option<&Summit<S::Mode>> {
        // The search is slow, because it solves for equilibria. Cache its result for the measure
        // and its derivatives.
        self.stiffness_summit.get_or_init(|| self.stiffness.summit(path, S::stiffness)).as_ref()
    }

    /// Returns the largest value of a tracked function at the recorded points, and its point.
    ///
    /// `followed` is the index of the function. Searching only the recorded points suffices for the
    /// load, because the extrema of the load are recorded points.
    pub(crate) fn highest_point(&self, followed: usize) -> Option<Summit<S::Mode>> {
        self.followed.get(followed)?.1.at_points()
    }

    /// Returns the largest value of a tracked function on the whole path, and its point.
    ///
    /// Also searches between the recorded points. `followed` is the index of the function.
    pub(crate) fn summit(
        &self,
        path: &mut Continuation<S>,
        followed: usize,
    ) -> Option<Summit<S::Mode>> {
        let (f, peak) = self.followed.get(followed)?;
        peak.summit(path, *f)
    }
}

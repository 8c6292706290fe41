//! Curve of the rotation of one gap over its moment, solved on demand.

use solver::{Change, Continuation, Event, Newton, Settings, System as _};

use super::strip::Strip;
use crate::contacts::{Contacts, SkinPoint, SkinState};
use crate::record::Work;

/// Relative decrease of moment or rotation between equilibria that counts as round-off.
const ROUND_OFF: f64 = 1e-12;

/// Tolerance of Newton's method for states that enter no result.
///
/// They are states on a finer membrane, for an error estimate, and states beyond the end of bending,
/// which limit the range of (F8). The last iteration converges quadratically, so the error of the
/// state is far smaller than the tolerance.
const ESTIMATED: f64 = 1e-6;

/// Equilibrium of a gap; moment and rotation are positive in the direction of bending.
#[derive(Debug)]
pub(super) struct Knot {
    pub(super) point: SkinPoint,
    pub(super) moment: f64,
    pub(super) rotation: f64,
    /// Compliances `dθ/dM` of the incoming and of the outgoing branch.
    compliances: [f64; 2],
}

impl Knot {
    fn new(strip: &Strip, point: SkinPoint) -> Self {
        let direction = strip.direction();
        Self {
            moment: direction * strip.moment(&point.state.z),
            rotation: direction * strip.rotation(&point.state.z),
            compliances: [&point.arriving, &point.leaving]
                .map(|along| strip.rotation(along) / strip.moment(along)),
            point,
        }
    }

    /// Returns the compliance `dθ/dM` of the outgoing branch.
    pub(super) fn compliance(&self) -> f64 {
        self.compliances[1]
    }

    /// Returns true if a contact changes at this equilibrium.
    pub(super) fn is_event(&self) -> bool {
        matches!(self.point.event, Some(Event::Changed(_)))
    }

    /// Returns true if moment and rotation grow from `before` to this equilibrium and beyond.
    fn is_regular_after(&self, before: &Self) -> bool {
        let rises = [(self.moment, before.moment), (self.rotation, before.rotation)];
        rises.into_iter().all(|(now, before)| now >= before - ROUND_OFF * before)
            && self.compliances.iter().all(|compliance| *compliance > 0.0 && compliance.is_finite())
    }
}

/// The curve of a gap: its equilibria ("knots") sorted by moment.
///
/// The knots are points of the path of the gap, and further equilibria between these points that
/// are solved for at given moments. Between two knots, with the rotations `θ`, the compliances
/// `c = dθ/dM` and the secant `s = Δθ/ΔM`, the rotation is approximately
///
/// ```text
/// θ₁ + Δθ [s x² + c₁ x (1 − x)]/[s + (c₁ + c₂ − 2s) x (1 − x)],    x = (M − M₁)/ΔM           (F8)
/// ```
///
/// This rational interpolant is monotone for any stiffening of the gap (Gregory & Delbourgo 1982,
/// doi 10.1093/imanum/2.2.123). It only predicts at which moments to solve, and enters no result.
#[derive(Debug)]
pub(super) struct GapCurve {
    path: Continuation<Strip>,
    knots: Vec<Knot>,
    /// Moment up to which the path has been followed.
    followed: f64,
    pub(super) iterations: usize,
}

impl GapCurve {
    /// Starts the curve at rest.
    pub(super) fn new(strip: Strip, settings: Settings) -> Self {
        let rest = SkinState::at_rest(&strip);
        let path = Continuation::new(strip, rest, settings);
        let knots = vec![Knot::new(path.system(), path.point().clone())];
        Self { path, knots, followed: 0.0, iterations: 0 }
    }

    pub(super) fn strip(&self) -> &Strip {
        self.path.system()
    }

    /// Follows the path until the gap carries at least the given moment.
    ///
    /// `None` if the path ends earlier. Also `None` if the moment or the rotation decreases,
    /// because then the moment does not determine the state of the gap.
    pub(super) fn follow_to(&mut self, moment: f64) -> Option<()> {
        if self.knots.last()?.moment < moment {
            // Equilibria beyond the path would not be in order with further points of the path.
            self.knots.retain(|knot| knot.moment <= self.followed);
            while self.followed < moment {
                self.follow()?;
            }
        }
        Some(())
    }

    /// Follows the path until the gap rotates by at least `rotation`, and returns its moment there.
    ///
    /// `None` as for [`Self::follow_to`].
    pub(super) fn follow_to_rotation(&mut self, rotation: f64) -> Option<f64> {
        while self.knots.last()?.rotation < rotation {
            self.follow()?;
        }
        Some(self.followed)
    }

    /// Follows the path up to first contact, or to at least a moment if this is earlier.
    ///
    /// Starts from the first contact of a `similar` gap if possible. `None` as for
    /// [`Self::follow_to`].
    pub(super) fn close_beside(&mut self, similar: &Self, moment: f64) -> Option<()> {
        if self.followed == 0.0 && self.step_to_closing(similar).is_some() {
            return Some(());
        }
        while self.followed < moment && self.first_closing().is_none() {
            self.follow()?;
        }
        Some(())
    }

    /// Steps from rest to first contact, starting from the first contact of a `similar` gap.
    ///
    /// Without contact the membrane is an arc, so no other event lies between. Returns `None`
    /// without a step if this fails.
    fn step_to_closing(&mut self, similar: &Self) -> Option<()> {
        let closing = similar.closing()?;
        let Some(Event::Changed(changes)) = &closing.point.event else { return None };
        let &[Change { constraint, activated: true }] = changes.as_slice() else { return None };
        let near =
            SkinState { z: closing.point.state.z.clone(), ..self.knots[0].point.state.clone() };
        let point = self.path.step_to_event(near, constraint)?;
        self.append(point)
    }

    /// Follows the path by one point; `None` as for [`Self::follow_to`].
    fn follow(&mut self) -> Option<()> {
        let point = self.path.next()?;
        self.append(point)
    }

    /// Appends a point of the path to the knots; `None` as for [`Self::follow_to`].
    fn append(&mut self, point: SkinPoint) -> Option<()> {
        self.iterations += self.path.take_history().len();
        let last = self.knots.last()?;
        let knot = Knot::new(self.path.system(), point);
        if !knot.is_regular_after(last) {
            return None;
        }
        self.followed = knot.moment.max(last.moment);
        self.knots.push(Knot { moment: self.followed, ..knot });
        Some(())
    }

    /// Solves for the equilibrium under a moment beyond the end of the curve.
    ///
    /// Starts from the equilibrium of a `similar` gap under this moment. `None` if the contacts of
    /// this equilibrium differ from the contacts at the end of the followed path, if Newton's
    /// method fails, or if the equilibrium is not valid.
    pub(super) fn skip_to(&mut self, similar: &Self, moment: f64) -> Option<()> {
        let last = self.knots.last().filter(|last| last.moment < moment)?;
        let (here, near) = (&self.path.point().state, &similar.knot(moment)?.point.state);
        let is_alike =
            near.active == here.active && self.strip().is_same_form(&near.mode, &here.mode);
        if !is_alike {
            return None;
        }
        let guess = SkinState { z: near.z.clone(), ..here.clone() };
        let condition = self.strip().under_moment(moment);
        let point = self.path.solved_ahead(guess, &condition, ESTIMATED)?;
        let knot = Knot { moment, ..Knot::new(self.path.system(), point) };
        knot.is_regular_after(last).then(|| self.knots.push(knot))
    }

    /// Solves for the equilibrium under a moment that the path has already passed.
    ///
    /// `None` if Newton's method fails or converges to another branch.
    pub(super) fn solve_at(&mut self, moment: f64) -> Option<()> {
        let next = self.knots.partition_point(|knot| knot.moment < moment);
        let [from, to] = [self.knots.get(next.checked_sub(1)?)?, self.knots.get(next)?];
        if to.moment == moment {
            return Some(());
        }
        let segment = Segment { from, to };
        let (guess, [low, high]) =
            (segment.state(self.strip(), moment), [from.rotation, to.rotation]);
        let condition = self.strip().under_moment(moment);
        let point = self.path.solved(guess, &condition)?;
        let knot = Knot { moment, ..Knot::new(self.path.system(), point) };
        // A rotation outside the segment means that Newton's method found another branch.
        let rotation = knot.rotation.clamp(low, high);
        let is_inside = (rotation - knot.rotation).abs() <= ROUND_OFF * high;
        is_inside.then(|| self.knots.insert(next, Knot { rotation, ..knot }))
    }

    /// Returns the equilibria with moments up to the given moment.
    pub(super) fn knots_to(&self, moment: f64) -> &[Knot] {
        &self.knots[..self.knots.partition_point(|knot| knot.moment <= moment)]
    }

    /// Returns the last equilibrium at exactly this moment; `None` if none was solved for.
    pub(super) fn knot(&self, moment: f64) -> Option<&Knot> {
        self.knots_to(moment).last().filter(|knot| knot.moment == moment)
    }

    /// Returns the moment of first contact; `None` if the gap has not closed so far.
    pub(super) fn first_closing(&self) -> Option<f64> {
        self.closing().map(|knot| knot.moment)
    }

    /// Returns the equilibrium of first contact.
    fn closing(&self) -> Option<&Knot> {
        self.knots.iter().find(|knot| Contacts::closed(&knot.point.state) > 0)
    }

    /// Returns the rotation `θ` under a moment, from an equilibrium or interpolated by (F8).
    pub(super) fn rotation(&self, moment: f64) -> f64 {
        match self.find(moment) {
            Ok([knot, _]) => knot.rotation,
            Err(segment) => segment.rotation(moment),
        }
    }

    /// Returns the compliances `dθ/dM` just below and just above a moment.
    ///
    /// They are the compliances of an equilibrium or interpolated by (F8).
    pub(super) fn compliances(&self, moment: f64) -> [f64; 2] {
        match self.find(moment) {
            Ok([first, last]) => [first.compliances[0], last.compliances[1]],
            Err(segment) => [segment.compliance(moment); 2],
        }
    }

    /// Finds the first and the last equilibrium at a moment, or else the segment that contains it.
    fn find(&self, moment: f64) -> Result<[&Knot; 2], Segment<'_>> {
        let next = self.knots.partition_point(|knot| knot.moment < moment);
        let here = self.knots[next..].partition_point(|knot| knot.moment <= moment);
        match here {
            0 => Err(Segment { from: &self.knots[next - 1], to: &self.knots[next] }),
            _ => Ok([next, next + here - 1].map(|number| &self.knots[number])),
        }
    }

    /// Computes the frictional dissipation from rest to a moment that was solved for.
    pub(super) fn friction_work(&mut self, moment: f64) -> f64 {
        let mut work = Work::default();
        let end = self.knots_to(moment).len();
        for pair in self.knots[..end].windows(2) {
            work.add(&mut self.path, &pair[0].point, &pair[1].point);
        }
        work.total()
    }

    /// Returns the largest membrane strain from rest to a moment.
    pub(super) fn largest_strain(&self, moment: f64) -> f64 {
        let knots = self.knots_to(moment).iter();
        knots.map(|knot| self.strip().largest_strain(&knot.point.state)).fold(0.0, f64::max)
    }

    /// Solves the equilibrium under a moment again with a finer membrane.
    ///
    /// `None` if no equilibrium was solved for at this moment, or if Newton's method fails.
    pub(super) fn resolved(&self, moment: f64, finer: &Strip, newton: &mut Newton) -> Option<Knot> {
        let mut state = self.strip().transferred(&self.knot(moment)?.point.state, finer)?;
        let condition = finer.under_moment(moment);
        let settings = Settings { tolerance: ESTIMATED, ..Settings::default() };
        let arriving = newton.solve(finer, &mut state, &condition, &settings).ok()?;
        let leaving = arriving.clone();
        Some(Knot::new(finer, SkinPoint { state, arriving, leaving, event: None }))
    }
}

/// Part of a curve between two neighbouring equilibria.
struct Segment<'a> {
    from: &'a Knot,
    to: &'a Knot,
}

impl Segment<'_> {
    /// Returns `ΔM`, `Δθ`, and the coordinate `x` of a moment, as in (F8).
    fn coordinates(&self, moment: f64) -> [f64; 3] {
        let width = self.to.moment - self.from.moment;
        [width, self.to.rotation - self.from.rotation, (moment - self.from.moment) / width]
    }

    /// Returns `s`, `c₁`, `c₂` and the denominator of (F8).
    fn terms(&self, [width, turn, x]: [f64; 3]) -> [f64; 4] {
        let [secant, start, end] = [turn / width, self.from.compliances[1], self.to.compliances[0]];
        [secant, start, end, secant + (start + end - 2.0 * secant) * x * (1.0 - x)]
    }

    fn rotation(&self, moment: f64) -> f64 {
        let coordinates @ [_, turn, x] = self.coordinates(moment);
        let [secant, start, _, below] = self.terms(coordinates);
        self.from.rotation + turn * (secant * x * x + start * x * (1.0 - x)) / below
    }

    fn compliance(&self, moment: f64) -> f64 {
        let coordinates @ [_, _, x] = self.coordinates(moment);
        let [secant, start, end, below] = self.terms(coordinates);
        let y = 1.0 - x;
        (secant / below).powi(2) * (end * x * x + 2.0 * secant * x * y + start * y * y)
    }

    /// Predicts the state under a moment: each unknown is a cubic polynomial of the rotation.
    ///
    /// Unknowns are smoother as functions of the rotation than of the moment if the gap stiffens.
    fn state(&self, strip: &Strip, moment: f64) -> SkinState {
        let Self { from, to } = self;
        let turn = to.rotation - from.rotation;
        let x = (self.rotation(moment) - from.rotation) / turn;
        let [start, end] = [&from.point.leaving, &to.point.arriving]
            .map(|along| turn * strip.direction() / strip.rotation(along));
        let mut state = from.point.state.clone();
        for (k, z) in state.z.iter_mut().enumerate() {
            let rise = to.point.state.z[k] - *z;
            let [begin, finish] =
                [start * from.point.leaving[k] - rise, end * to.point.arriving[k] - rise];
            *z += x * (rise + (1.0 - x) * (begin * (1.0 - x) - finish * x));
        }
        state
    }
}

//! The maximum of a quantity along the path, between its points too.

use std::sync::Arc;

use crate::continuation::{Continuation, Equilibrium};
use crate::sensitivity::slope_along;
use crate::system::{State, System};

/// A search ends where it promises to gain less than this part of the value.
const FLAT: f64 = 1e-11;

/// How far from a kink a slope is taken, as a part of the segment: at the kink itself a force that begins or ceases to act may
/// change infinitely fast.
const NEAR: f64 = 1e-4;

/// How many times the search comes closer to a kink, each time a tenth as far from it as before.
const CLOSER: usize = 4;

/// A search ends after this many rounds. It rarely needs a quarter of them.
const ROUNDS: usize = 40;

/// A segment that begins or ends at a kink is searched if an end of it has at least this part of the largest value: a force
/// that has just begun to act may hide a maximum between two points that are both lower than the highest one. Those that were
/// seen rise by less than a hundredth above their ends.
const PROMISING: f64 = 0.95;

/// Follows the largest value that a function of a system, an equilibrium and its path direction takes.
///
/// The function is smooth along the path between kinks, and the length of the direction makes no difference to it. At a kink the
/// direction has two values, and the function is evaluated with both.
#[derive(Clone, Debug)]
pub struct Peak<M = ()> {
    best: Option<Best<M>>,
    /// Promising segments between kinks.
    kinks: Vec<KinkSegment<M>>,
}

/// A segment of the path that begins or ends at a kink.
#[derive(Clone, Debug)]
struct KinkSegment<M> {
    from: Arc<Equilibrium<M>>,
    to: Arc<Equilibrium<M>>,
    /// The larger value of its ends.
    value: f64,
}

/// The point with the largest value so far, and its neighbours.
#[derive(Clone, Debug)]
struct Best<M> {
    value: f64,
    before: Option<Arc<Equilibrium<M>>>,
    point: Arc<Equilibrium<M>>,
    after: Option<Arc<Equilibrium<M>>>,
}

impl<M> Default for Peak<M> {
    fn default() -> Self {
        Self { best: None, kinks: Vec::new() }
    }
}

impl<M> Peak<M> {
    /// Takes the point that `path` has come to into account, which came `from` the point before, if there is one.
    pub fn visit<S>(
        &mut self,
        path: &Continuation<S>,
        from: Option<&Arc<Equilibrium<M>>>,
        f: impl Fn(&S, &State<M>, &[f64]) -> f64,
    ) where
        S: System<Mode = M>,
    {
        let here = Arc::clone(&path.point);
        let at = |direction: &[f64]| f(&path.system, &here.state, direction);
        // At a kink the larger of both counts: a stiffness is largest just before a contact opens, or just after one
        // closes.
        let value = at(&here.arriving).max(at(&here.leaving));
        let kink = from.filter(|from| from.event.is_some() || here.event.is_some());
        if let Some(from) = kink.map(Arc::clone) {
            let value = at(&here.arriving).max(f(&path.system, &from.state, &from.leaving));
            self.kinks.push(KinkSegment { from, to: Arc::clone(&here), value });
        }
        if self.best.as_ref().is_none_or(|best| value > best.value) {
            let (before, point) = (from.cloned(), Arc::clone(&here));
            self.best = Some(Best { value, before, point, after: None });
        } else if let Some(best) = &mut self.best {
            best.after.get_or_insert_with(|| Arc::clone(&here));
        }
        let least = self.best.as_ref().map_or(0.0, |best| PROMISING * best.value);
        // What was promising need not be any more once a larger value was seen; kept, segments would grow with the
        // path.
        self.kinks.retain(|segment| segment.value >= least);
    }

    /// The point with the largest value of those visited. `None` if none was.
    pub fn point(&self) -> Option<&Equilibrium<M>> {
        self.best.as_ref().map(|best| &*best.point)
    }

    /// Replaces the points that are kept, where the path has gone on with another system, before maxima are looked for on it.
    pub fn replace_points(&mut self, new: impl Fn(&Equilibrium<M>) -> Equilibrium<M>) {
        let best = self.best.iter_mut().flat_map(|best| {
            [Some(&mut best.point), best.before.as_mut(), best.after.as_mut()].into_iter().flatten()
        });
        let kinks = self.kinks.iter_mut().flat_map(|segment| [&mut segment.from, &mut segment.to]);
        // A point where segments meet stays one point: by that those are known that need not be searched twice.
        let mut replaced: Vec<[Arc<Equilibrium<M>>; 2]> = Vec::new();
        for point in best.chain(kinks) {
            let known = replaced.iter().find(|[old, _]| Arc::ptr_eq(old, point));
            let by = known.map_or_else(|| Arc::new(new(point)), |[_, by]| Arc::clone(by));
            replaced.push([std::mem::replace(point, Arc::clone(&by)), by]);
        }
    }

    /// The largest value at the points visited, with its place. `None` if none was.
    pub fn at_points(&self) -> Option<Summit<M>> {
        let Best { value, before, point, .. } = self.best.as_ref()?;
        let (point, before) = (Arc::clone(point), before.clone());
        Some(Summit { value: *value, point, before, is_inside: false })
    }

    /// The largest value on the path, the segments next to the best of the points visited, and promising ones next to
    /// kinks, included, with its place. `None` if none was visited. Away from kinks, steps must be small enough for the highest
    /// maximum to show at a point beside it.
    pub fn summit<S>(
        &self,
        path: &mut Continuation<S>,
        f: impl Fn(&S, &State<M>, &[f64]) -> f64,
    ) -> Option<Summit<M>>
    where
        S: System<Mode = M>,
    {
        let Best { before, point, after, .. } = self.best.as_ref()?;
        let visited = self.at_points()?;
        let segments = [before.as_ref().zip(Some(point)), Some(point).zip(after.as_ref())];
        let kinks = self.kinks.iter().filter(|segment| {
            // Those next to the best point are searched anyway.
            !Arc::ptr_eq(&segment.from, point) && !Arc::ptr_eq(&segment.to, point)
        });
        let kinks = kinks.map(|segment| (&segment.from, &segment.to));
        let inside = segments.into_iter().flatten().chain(kinks);
        Some(inside.fold(visited, |best, (from, to)| {
            let maximum = Segment::new(path, from, to, &f).maximum(best.value);
            maximum.filter(|next| next.value > best.value).unwrap_or(best)
        }))
    }
}

/// The largest value of a quantity along a path, and the point at which it is taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Summit<M = ()> {
    /// The largest value.
    pub value: f64,
    /// The point.
    pub point: Arc<Equilibrium<M>>,
    /// The point of the path before it, where it is itself one of its points. `None` at the beginning.
    pub before: Option<Arc<Equilibrium<M>>>,
    /// Whether the point lies between points of the path.
    pub is_inside: bool,
}

/// A place on a segment of the path, as a part of the segment, with the value there and its derivative by the place.
#[derive(Clone, Copy, Debug)]
struct SegmentSample {
    place: f64,
    value: f64,
    slope: f64,
}

/// A segment of a path that is searched for a maximum of `f`.
struct Segment<'a, S: System, F> {
    path: &'a mut Continuation<S>,
    from: &'a Equilibrium<S::Mode>,
    to: &'a Equilibrium<S::Mode>,
    f: &'a F,
    /// Points by their places: both ends, and those inside that were solved for.
    known: Vec<(f64, Equilibrium<S::Mode>)>,
    /// The largest value inside, and the number of its point.
    highest: Option<(f64, usize)>,
}

impl<'a, S, F> Segment<'a, S, F>
where
    S: System,
    F: Fn(&S, &State<S::Mode>, &[f64]) -> f64,
{
    fn new(
        path: &'a mut Continuation<S>,
        from: &'a Equilibrium<S::Mode>,
        to: &'a Equilibrium<S::Mode>,
        f: &'a F,
    ) -> Self {
        // The end with the active set and the mode of the segment.
        // At an event the point holds what the path goes on with, which is not what it came with.
        let State { active, mode, .. } = from.state.clone();
        let state = State { z: to.state.z.clone(), active, mode };
        let (arriving, leaving) = (to.arriving.clone(), to.arriving.clone());
        let end = Equilibrium { state, arriving, leaving, event: None };
        Self { path, from, to, f, known: vec![(0.0, from.clone()), (1.0, end)], highest: None }
    }

    /// The maximum inside, if there is one that may be as high as `least`.
    ///
    /// The cubic through the values and slopes at both ends of a bracket tells whether it has a maximum inside, and where to
    /// look next. A force that has just begun to act may raise the function within a small part of a segment: the slope near
    /// its end shows that.
    ///
    /// ```text
    ///            top of the cubic
    ///               ,-·-.
    ///    low ,-'     |     `-.          The sample at the top takes the place of the end on whose side
    ///      ·'        |        `·. high  of the maximum it lies: low while f rises there, else high.
    ///   ───┼─────────┼──────────┼───
    /// ```
    fn maximum(mut self, least: f64) -> Option<Summit<S::Mode>> {
        let bracket = [self.end(0.0, least)?, self.end(1.0, least)?];
        self.search(bracket, least)?;
        let (value, number) = self.highest?;
        let (_, point) = self.known.swap_remove(number);
        Some(Summit { value, point: Arc::new(point), before: None, is_inside: true })
    }

    /// Looks for the maximum within a bracket. `None` where Newton's method does not get to a place.
    fn search(&mut self, [mut low, mut high]: [SegmentSample; 2], least: f64) -> Option<()> {
        for _ in 0..ROUNDS {
            // No top inside: the larger end is the maximum, and it has been visited.
            let Some(top) = low.top(&high) else { break };
            let reached = self.highest.map_or(f64::NEG_INFINITY, |(value, _)| value);
            // The cubic promises little: either another segment is higher, or this one has given what it has.
            if top.value < PROMISING * least || top.value - reached <= FLAT * top.value.abs() {
                break;
            }
            let inside = self.inside(top.place)?;
            // The larger end of the bracket stays until a place inside is higher.
            let is_lower = inside.value < low.value.max(high.value);
            let rises = if is_lower { low.value < high.value } else { inside.slope > 0.0 };
            *(if rises { &mut low } else { &mut high }) = inside;
        }
        Some(())
    }

    /// An end of the bracket, the lower or the upper one.
    fn end(&mut self, place: f64, least: f64) -> Option<SegmentSample> {
        let is_lower = place == 0.0;
        let Equilibrium { state, arriving, leaving, event } =
            if is_lower { self.from } else { self.to };
        let direction = if is_lower { leaving } else { arriving };
        match event {
            Some(_) => self.beside(place, state, direction, least),
            None => self.at_end(place, state, direction),
        }
    }

    /// The sample beside a kink. Where the function seems to have a maximum between the two it is looked for, closer and closer
    /// to the kink.
    fn beside(
        &mut self,
        kink: f64,
        state: &State<S::Mode>,
        direction: &[f64],
        least: f64,
    ) -> Option<SegmentSample> {
        let value = (self.f)(&self.path.system, state, direction);
        let inwards = 1.0 - 2.0 * kink;
        let beside = self.inside(kink + inwards * NEAR)?;
        let (mut outer, mut way) = (beside, NEAR);
        for _ in 0..CLOSER {
            // Whether the parabola through both falls from the kink on.
            let falls = 2.0 * (outer.value - value) <= inwards * outer.slope * way;
            if falls || inwards * outer.slope >= 0.0 {
                break;
            }
            way *= 0.1;
            let inner = self.inside(kink + inwards * way)?;
            if inwards * inner.slope > 0.0 {
                self.search(if kink == 0.0 { [inner, outer] } else { [outer, inner] }, least)?;
            }
            outer = inner;
        }
        Some(beside)
    }

    /// The sample at an end that is no kink.
    fn at_end(
        &mut self,
        place: f64,
        state: &State<S::Mode>,
        direction: &[f64],
    ) -> Option<SegmentSample> {
        let condition = self.path.condition(self.from);
        let Continuation { newton, system, .. } = &mut *self.path;
        // The slope needs the factors of the tangent at this very point.
        newton.tangent(system, state, &condition).ok()?;
        Some(self.sample(place, state, direction))
    }

    /// The sample at a place inside, reached from the nearest point that is known.
    fn inside(&mut self, place: f64) -> Option<SegmentSample> {
        let away = |known: &&(f64, Equilibrium<S::Mode>)| (known.0 - place).abs();
        let nearest = self.known.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        let near = nearest.map_or(self.from, |(_, point)| point);
        let point = self.path.between_from(self.from, self.to, place, near);
        // From a near point Newton's method is quick, but a point beside a kink may lead it to the other side; the
        // beginning of the segment does not.
        let point = point.or_else(|| self.path.between(self.from, self.to, place))?;
        let sample = self.sample(place, &point.state, &point.arriving);
        if self.highest.is_none_or(|(value, _)| sample.value > value) {
            self.highest = Some((sample.value, self.known.len()));
        }
        self.known.push((place, point));
        Some(sample)
    }

    /// The sample at a point at which the tangent was factorised last.
    fn sample(&mut self, place: f64, state: &State<S::Mode>, direction: &[f64]) -> SegmentSample {
        let Self { path, from, to, f, .. } = self;
        let value = f(&path.system, state, direction);
        let slope = slope_along(&path.system, &mut path.newton, state, direction, f);
        SegmentSample { place, value, slope: path.rate_in(from, to, direction) * slope }
    }
}

impl SegmentSample {
    /// The maximum of the cubic between two samples; `None` if it has none between them.
    fn top(&self, high: &Self) -> Option<Self> {
        let width = high.place - self.place;
        let (rise, start, end) = (high.value - self.value, width * self.slope, width * high.slope);
        // value + start x + square x² + cube x³
        let (square, cube) = (3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise);
        let root = (square * square - 3.0 * cube * start).sqrt();
        let x =
            // Of two forms of the root the one without a difference of near numbers.
            if square > 0.0 { -(square + root) / (3.0 * cube) } else { start / (root - square) };
        let value = self.value + x * (start + x * (square + x * cube));
        let place = self.place + x * width;
        (0.0 < x && x < 1.0).then_some(Self { place, value, slope: 0.0 })
    }
}

//! Search for the maximum of a quantity along the path, also between its points.

use std::sync::Arc;

use crate::continuation::{Continuation, Equilibrium};
use crate::sensitivity::slope_along;
use crate::system::{State, System};

/// Relative increase of the maximum below which a search ends.
const FLAT: f64 = 1e-11;

/// Distance from a kink at which a slope is evaluated, as a fraction of the segment.
///
/// At the kink itself the rate of a force that begins or ceases to act may be infinite.
const NEAR: f64 = 1e-4;

/// Maximum number of samples closer to a kink, each at a tenth of the previous distance.
const CLOSER: usize = 4;

/// Maximum number of iterations of a search. Most searches need at most a quarter of them.
const ROUNDS: usize = 40;

/// Fraction of the largest value so far that a segment next to a kink must reach for a search.
///
/// If a force has just begun to act, a segment may contain the maximum although both of its ends
/// are lower than another point. In observed cases such a maximum exceeds the ends of the segment
/// by less than 1 %.
const PROMISING: f64 = 0.95;

/// Candidates for the maximum of a function along a path.
///
/// The function depends on system, equilibrium and path direction. It must be smooth along the path
/// between kinks, and must not depend on the length of the direction. At a kink it is evaluated
/// with the incoming and the outgoing direction.
#[derive(Clone, Debug)]
pub struct Peak<M = ()> {
    /// Point with the largest value so far.
    best: Option<Best<M>>,
    /// Segments next to kinks that may contain the maximum.
    kinks: Vec<KinkSegment<M>>,
}

/// Segment of the path that begins or ends at a kink.
#[derive(Clone, Debug)]
struct KinkSegment<M> {
    from: Arc<Equilibrium<M>>,
    to: Arc<Equilibrium<M>>,
    /// Larger of the values at the two ends of the segment.
    value: f64,
}

/// Point with the largest value so far, with the points before and after it.
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
    /// Evaluates `f` at the current point of `path` and updates the maximum.
    ///
    /// `from` is the previous point, if any.
    pub fn visit<S>(
        &mut self,
        path: &Continuation<S>,
        from: Option<&Arc<Equilibrium<M>>>,
        f: impl Fn(&S, &State<M>, &[f64]) -> f64,
    ) where
        S: System<Mode = M>,
    {
        let here = Arc::clone(&path.point);
        let [arriving, leaving] = [&here.arriving, &here.leaving]
            .map(|direction| f(&path.system, &here.state, direction));
        // At a kink, use the larger value, because a stiffness is largest just before a contact
        // opens or just after a contact closes.
        let value = arriving.max(leaving);
        let kink = from.filter(|from| from.event.is_some() || here.event.is_some());
        if let Some(from) = kink.map(Arc::clone) {
            let value = arriving.max(f(&path.system, &from.state, &from.leaving));
            self.kinks.push(KinkSegment { from, to: Arc::clone(&here), value });
        }
        self.compare(value, from, &here);
        let least = self.best.as_ref().map_or(0.0, |best| PROMISING * best.value);
        // Remove segments that can no longer contain the maximum, so that their number does not
        // grow with the path.
        self.kinks.retain(|segment| segment.value >= least);
    }

    /// Updates the maximum by the `value` of the function at the current point of `path`.
    ///
    /// Use this only for continuous functions that do not depend on the path direction. Segments
    /// next to kinks are searched only at the best point.
    pub fn visit_value<S>(
        &mut self,
        path: &Continuation<S>,
        from: Option<&Arc<Equilibrium<M>>>,
        value: f64,
    ) where
        S: System<Mode = M>,
    {
        self.compare(value, from, &path.point);
    }

    /// Stores the point `here` if the value at `here` is the largest so far.
    fn compare(
        &mut self,
        value: f64,
        from: Option<&Arc<Equilibrium<M>>>,
        here: &Arc<Equilibrium<M>>,
    ) {
        if self.best.as_ref().is_none_or(|best| value > best.value) {
            let (before, point) = (from.cloned(), Arc::clone(here));
            self.best = Some(Best { value, before, point, after: None });
        } else if let Some(best) = &mut self.best {
            best.after.get_or_insert_with(|| Arc::clone(here));
        }
    }

    /// Returns the visited point with the largest value, or `None` before the first visit.
    pub fn point(&self) -> Option<&Equilibrium<M>> {
        self.best.as_ref().map(|best| &*best.point)
    }

    /// Converts all stored points to another system that continues the path.
    ///
    /// `new` converts a point. Call this before searching for maxima on the continued path.
    pub fn replace_points(&mut self, new: impl Fn(&Equilibrium<M>) -> Equilibrium<M>) {
        let best = self.best.iter_mut().flat_map(|best| {
            [Some(&mut best.point), best.before.as_mut(), best.after.as_mut()].into_iter().flatten()
        });
        let kinks = self.kinks.iter_mut().flat_map(|segment| [&mut segment.from, &mut segment.to]);
        // Two segments that share a point must still share it, because `summit` compares pointers.
        let mut replaced: Vec<[Arc<Equilibrium<M>>; 2]> = Vec::new();
        for point in best.chain(kinks) {
            let known = replaced.iter().find(|[old, _]| Arc::ptr_eq(old, point));
            let by = known.map_or_else(|| Arc::new(new(point)), |[_, by]| Arc::clone(by));
            replaced.push([std::mem::replace(point, Arc::clone(&by)), by]);
        }
    }

    /// Returns the largest value at a visited point, or `None` before the first visit.
    pub fn at_points(&self) -> Option<Summit<M>> {
        let Best { value, before, point, .. } = self.best.as_ref()?;
        let (point, before) = (Arc::clone(point), before.clone());
        Some(Summit { value: *value, point, before, is_inside: false })
    }

    /// Returns the largest value on the path, or `None` before the first visit.
    ///
    /// Searches the segments next to the best visited point, and the stored segments next to kinks.
    /// Away from kinks, the steps must be so small that a visited point next to the maximum has the
    /// largest visited value.
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
            // The segments next to the best point are already in `segments`.
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

/// Largest value of a quantity along a path, and the point with this value.
#[derive(Clone, Debug, PartialEq)]
pub struct Summit<M = ()> {
    /// Largest value.
    pub value: f64,
    /// Point with this value.
    pub point: Arc<Equilibrium<M>>,
    /// Previous point of the path, if `point` is a point of the path but not the first one.
    pub before: Option<Arc<Equilibrium<M>>>,
    /// True if `point` lies between two points of the path.
    pub is_inside: bool,
}

/// Value of the function at a fraction of a segment, and its derivative by the fraction.
#[derive(Clone, Copy, Debug)]
struct SegmentSample {
    fraction: f64,
    value: f64,
    slope: f64,
}

/// Segment of a path that is searched for a maximum of `f`.
struct Segment<'a, S: System, F> {
    path: &'a mut Continuation<S>,
    from: &'a Equilibrium<S::Mode>,
    to: &'a Equilibrium<S::Mode>,
    f: &'a F,
    /// Fraction and equilibrium of each solved point, including both ends.
    known: Vec<(f64, Equilibrium<S::Mode>)>,
    /// Largest value at an inner point, and the index of this point in `known`.
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
        // The end of the segment gets the active set and mode of the segment, because at an event
        // the point `to` has the outgoing active set and mode.
        let State { active, mode, .. } = from.state.clone();
        let state = State { z: to.state.z.clone(), active, mode };
        let (arriving, leaving) = (to.arriving.clone(), to.arriving.clone());
        let end = Equilibrium { state, arriving, leaving, event: None };
        Self { path, from, to, f, known: vec![(0.0, from.clone()), (1.0, end)], highest: None }
    }

    /// Returns the largest value inside the segment, if it may exceed `least`.
    ///
    /// The next sample is the maximum of the cubic with the values and slopes at both ends of a
    /// bracket. If the cubic has no maximum inside, the search ends. If the function rises only
    /// within a small part of the segment, because a force has just begun to act, the slope near
    /// this end of the segment reveals the rise.
    ///
    /// ```text
    ///            top of the cubic
    ///               ,-·-.
    ///    low ,-'     |     `-.          The sample replaces the end on its side of the maximum:
    ///      ·'        |        `·. high  low while f increases at the sample, else high.
    ///   ───┼─────────┼──────────┼───
    /// ```
    fn maximum(mut self, least: f64) -> Option<Summit<S::Mode>> {
        let bracket = [self.end(0.0, least)?, self.end(1.0, least)?];
        self.search(bracket, least)?;
        let (value, number) = self.highest?;
        let (_, point) = self.known.swap_remove(number);
        Some(Summit { value, point: Arc::new(point), before: None, is_inside: true })
    }

    /// Searches a bracket for the maximum and updates `highest`. `None` if Newton's method fails.
    fn search(&mut self, [mut low, mut high]: [SegmentSample; 2], least: f64) -> Option<()> {
        for _ in 0..ROUNDS {
            // If the cubic has no maximum inside, an end of the bracket is the maximum.
            let Some(top) = low.top(&high) else { break };
            let reached = self.highest.map_or(f64::NEG_INFINITY, |(value, _)| value);
            // Stop if another segment has a larger value, or if this search has converged.
            if top.value < PROMISING * least || top.value - reached <= FLAT * top.value.abs() {
                break;
            }
            let inside = self.inside(top.fraction)?;
            // Keep the larger end of the bracket until an inner sample exceeds it.
            let is_lower = inside.value < low.value.max(high.value);
            let rises = if is_lower { low.value < high.value } else { inside.slope > 0.0 };
            *(if rises { &mut low } else { &mut high }) = inside;
        }
        Some(())
    }

    /// Evaluates the sample for the lower (0) or upper (1) end of the initial bracket.
    fn end(&mut self, fraction: f64, least: f64) -> Option<SegmentSample> {
        let is_lower = fraction == 0.0;
        let Equilibrium { state, arriving, leaving, event } =
            if is_lower { self.from } else { self.to };
        let direction = if is_lower { leaving } else { arriving };
        match event {
            Some(_) => self.beside(fraction, state, direction, least),
            None => self.at_end(fraction, state, direction),
        }
    }

    /// Evaluates a sample next to a kink at the end `kink` (0 or 1) of the segment.
    ///
    /// If a maximum may lie between kink and sample, also searches closer to the kink.
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
        let (mut outer, mut distance) = (beside, NEAR);
        for _ in 0..CLOSER {
            // True if the parabola through kink and sample, with the slope of the sample, decreases
            // away from the kink.
            let falls = 2.0 * (outer.value - value) <= inwards * outer.slope * distance;
            if falls || inwards * outer.slope >= 0.0 {
                break;
            }
            distance *= 0.1;
            let inner = self.inside(kink + inwards * distance)?;
            if inwards * inner.slope > 0.0 {
                self.search(if kink == 0.0 { [inner, outer] } else { [outer, inner] }, least)?;
            }
            outer = inner;
        }
        Some(beside)
    }

    /// Evaluates the sample at an end of the segment without a kink.
    fn at_end(
        &mut self,
        fraction: f64,
        state: &State<S::Mode>,
        direction: &[f64],
    ) -> Option<SegmentSample> {
        let condition = self.path.condition(self.from);
        let Continuation { newton, system, .. } = &mut *self.path;
        // `sample` requires the factors of the tangent at this point.
        newton.tangent(system, state, &condition).ok()?;
        Some(self.sample(fraction, state, direction))
    }

    /// Solves for an inner point of the segment, starting from the nearest solved point.
    ///
    /// Returns the sample there. `None` if Newton's method fails.
    fn inside(&mut self, fraction: f64) -> Option<SegmentSample> {
        let distances = self.known.iter().map(|(other, point)| ((other - fraction).abs(), point));
        let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
        let near = nearest.map_or(self.from, |(_, point)| point);
        let point = self.path.between_from(self.from, self.to, fraction, near);
        // From a near point Newton's method needs fewer iterations. If the near point is next to a
        // kink, the iteration may fail; it is then repeated from the start of the segment.
        let point = point.or_else(|| self.path.between(self.from, self.to, fraction))?;
        let sample = self.sample(fraction, &point.state, &point.arriving);
        if self.highest.is_none_or(|(value, _)| sample.value > value) {
            self.highest = Some((sample.value, self.known.len()));
        }
        self.known.push((fraction, point));
        Some(sample)
    }

    /// Evaluates value and slope at a point, to which the last factorised tangent must belong.
    fn sample(
        &mut self,
        fraction: f64,
        state: &State<S::Mode>,
        direction: &[f64],
    ) -> SegmentSample {
        let Self { path, from, to, f, .. } = self;
        let value = f(&path.system, state, direction);
        let slope = slope_along(&path.system, &mut path.newton, state, direction, f);
        SegmentSample { fraction, value, slope: path.rate_in(from, to, direction) * slope }
    }
}

impl SegmentSample {
    /// Returns the maximum, between `self` and `high`, of the cubic through both samples.
    ///
    /// The cubic has the values and slopes of the samples. `None` if there is no maximum between
    /// them.
    fn top(&self, high: &Self) -> Option<Self> {
        let width = high.fraction - self.fraction;
        let (rise, start, end) = (high.value - self.value, width * self.slope, width * high.slope);
        // Coefficients of the cubic value + start x + square x² + cube x³.
        let (square, cube) = (3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise);
        let root = (square * square - 3.0 * cube * start).sqrt();
        let x =
            // Use the form of the root that does not subtract nearly equal numbers.
            if square > 0.0 { -(square + root) / (3.0 * cube) } else { start / (root - square) };
        let value = self.value + x * (start + x * (square + x * cube));
        let fraction = self.fraction + x * width;
        (0.0 < x && x < 1.0).then_some(Self { fraction, value, slope: 0.0 })
    }
}

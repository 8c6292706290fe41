//! The maximum of a quantity along the path, between its points too.

use std::sync::Arc;

use crate::path::{Path, Point};
use crate::system::{State, System};

/// A search ends where the three highest values agree to this part.
const FLAT: f64 = 1e-10;

/// A search ends where the place of the maximum is known to this part of the first bracket: near a maximum the value
/// is then off by the square of it.
const CLOSE: f64 = 2e-6;

/// A search ends after this many evaluations. Brent's method rarely needs half as many.
const EVALUATIONS: usize = 40;

/// How far from the larger end of a segment a search begins, as a part of the segment.
const NEAR: f64 = 0.05;

/// How many times a search begins, each time a tenth as far from the end as before, if the segment begins at a kink.
const CLOSER: usize = 4;

/// A segment that begins or ends at a kink is searched if an end of it has at least this part of the largest value: a force
/// that has just begun to act may hide a maximum between two points that are both lower than the highest one. Those that were
/// seen rise by less than a hundredth above their ends.
const PROMISING: f64 = 0.95;

/// The smaller part of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Follows the largest value that a function of a system, an equilibrium and its path direction takes.
///
/// At a kink the direction has two values, and the function is evaluated with both.
#[derive(Clone, Debug)]
pub struct Peak<M = ()> {
    best: Option<Best<M>>,
    last: Option<Arc<Point<M>>>,
    /// Promising segments between kinks.
    kinks: Vec<KinkSegment<M>>,
}

/// A segment of the path that begins or ends at a kink.
#[derive(Clone, Debug)]
struct KinkSegment<M> {
    from: Arc<Point<M>>,
    to: Arc<Point<M>>,
    /// The larger value of its ends.
    value: f64,
}

/// The point with the largest value so far, and its neighbours.
#[derive(Clone, Debug)]
struct Best<M> {
    value: f64,
    before: Option<Arc<Point<M>>>,
    point: Arc<Point<M>>,
    after: Option<Arc<Point<M>>>,
}

impl<M> Default for Peak<M> {
    fn default() -> Self {
        Self { best: None, last: None, kinks: Vec::new() }
    }
}

impl<M> Peak<M> {
    /// Takes the point that `path` has come to into account.
    pub fn visit<S>(&mut self, path: &Path<S>, f: impl Fn(&S, &State<M>, &[f64]) -> f64)
    where
        S: System<Mode = M>,
    {
        let here = Arc::clone(&path.point);
        let at = |direction: &[f64]| f(&path.system, &here.state, direction);
        let value = at(&here.arriving).max(at(&here.leaving));
        let kink = self.last.as_ref().filter(|last| last.event.is_some() || here.event.is_some());
        if let Some(from) = kink.map(Arc::clone) {
            let value = at(&here.arriving).max(f(&path.system, &from.state, &from.leaving));
            self.kinks.push(KinkSegment { from, to: Arc::clone(&here), value });
        }
        if self.best.as_ref().is_none_or(|best| value > best.value) {
            let (before, point) = (self.last.take(), Arc::clone(&here));
            self.best = Some(Best { value, before, point, after: None });
        } else if let Some(best) = &mut self.best {
            best.after.get_or_insert_with(|| Arc::clone(&here));
        }
        self.last = Some(here);
        let least = self.best.as_ref().map_or(0.0, |best| PROMISING * best.value);
        self.kinks.retain(|segment| segment.value >= least);
    }

    /// The point with the largest value of those visited. `None` if none was.
    pub fn point(&self) -> Option<&Point<M>> {
        self.best.as_ref().map(|best| &*best.point)
    }

    /// Replaces the points that are kept, where the path has gone on with another system.
    pub fn replace_points(&mut self, new: impl Fn(&Point<M>) -> Point<M>) {
        let best = self.best.iter_mut().flat_map(|best| {
            [Some(&mut best.point), best.before.as_mut(), best.after.as_mut()].into_iter().flatten()
        });
        let kinks = self.kinks.iter_mut().flat_map(|segment| [&mut segment.from, &mut segment.to]);
        for point in best.chain(&mut self.last).chain(kinks) {
            *point = Arc::new(new(point));
        }
    }

    /// The largest value on the path, the segments next to the best of the points visited, and promising ones next to
    /// kinks, included. `None` if none was visited. Away from kinks, steps must be small enough for the highest maximum to
    /// show at a point beside it.
    pub fn refined<S>(
        &self,
        path: &mut Path<S>,
        f: impl Fn(&S, &State<M>, &[f64]) -> f64,
    ) -> Option<f64>
    where
        S: System<Mode = M>,
    {
        Some(self.summit(path, f)?.value)
    }

    /// The largest value as [`Peak::refined`] finds it, with its place.
    pub fn summit<S>(
        &self,
        path: &mut Path<S>,
        f: impl Fn(&S, &State<M>, &[f64]) -> f64,
    ) -> Option<Summit<M>>
    where
        S: System<Mode = M>,
    {
        let Best { value, before, point, after } = self.best.as_ref()?;
        let visited = Summit {
            value: *value,
            point: Arc::clone(point),
            before: before.clone(),
            is_inside: false,
        };
        let segments = [before.as_ref().zip(Some(point)), Some(point).zip(after.as_ref())];
        let kinks = self.kinks.iter().filter(|segment| {
            // Those next to the best point are searched anyway.
            !Arc::ptr_eq(&segment.from, point) && !Arc::ptr_eq(&segment.to, point)
        });
        let kinks = kinks.map(|segment| (&segment.from, &segment.to));
        let inside = segments.into_iter().flatten().chain(kinks);
        let maxima = inside.filter_map(|(from, to)| segment_maximum(path, from, to, &f));
        Some(maxima.fold(visited, |best, next| if next.value > best.value { next } else { best }))
    }
}

/// The largest value of a quantity along a path, and the point at which it is taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Summit<M = ()> {
    /// The largest value.
    pub value: f64,
    /// The point.
    pub point: Arc<Point<M>>,
    /// The point of the path before it, where it is itself one of its points. `None` at the beginning.
    pub before: Option<Arc<Point<M>>>,
    /// Whether the point lies between points of the path.
    pub is_inside: bool,
}

/// A place on a segment of the path, as a part of the segment, and the value there.
#[derive(Clone, Copy, Debug)]
struct Sample {
    place: f64,
    value: f64,
}

/// The maximum inside a segment, if there is one.
fn segment_maximum<S: System>(
    path: &mut Path<S>,
    from: &Point<S::Mode>,
    to: &Point<S::Mode>,
    f: &impl Fn(&S, &State<S::Mode>, &[f64]) -> f64,
) -> Option<Summit<S::Mode>> {
    let start = Sample { place: 0.0, value: f(&path.system, &from.state, &from.leaving) };
    let end = Sample { place: 1.0, value: f(&path.system, &to.state, &to.arriving) };
    let mut nearest = from.clone();
    let mut highest = f64::NEG_INFINITY;
    let mut at = |place: f64| {
        let point = path.between_from(from, to, place, &nearest)?;
        let value = f(&path.system, &point.state, &point.arriving);
        if value >= highest {
            (highest, nearest) = (value, point);
        }
        Some(Sample { place, value })
    };
    let kinks = [from, to].map(|point| point.event.is_some());
    let mut search = bracket(&mut at, [start, end], kinks)?;
    for _ in 0..EVALUATIONS {
        let Some(place) = search.next_place() else { break };
        search.take(at(place)?);
    }
    let value = search.x.value;
    Some(Summit { value, point: Arc::new(nearest), before: None, is_inside: true })
}

/// A bracket of the maximum: where the function rises from the larger end, or, between kinks, anywhere inside.
fn bracket(
    at: &mut impl FnMut(f64) -> Option<Sample>,
    ends: [Sample; 2],
    kinks: [bool; 2],
) -> Option<Brent> {
    let at_an_end = bracket_at_the_larger_end(at, ends, kinks[0]);
    at_an_end.or_else(|| kinks.contains(&true).then(|| hidden_bracket(at, ends)).flatten())
}

/// A bracket that begins or ends at the larger end, if the function rises from there.
///
/// A force that has just begun to act may raise the function within a small part of the segment, so
/// behind a kink the search goes on towards the start.
fn bracket_at_the_larger_end(
    at: &mut impl FnMut(f64) -> Option<Sample>,
    [start, end]: [Sample; 2],
    kink: bool,
) -> Option<Brent> {
    if start.value <= end.value {
        let inside = at(1.0 - NEAR)?;
        return (inside.value > end.value).then(|| Brent::new([start, end], inside));
    }
    let (mut beyond, mut place) = (end, NEAR);
    for _ in 0..if kink { CLOSER } else { 1 } {
        let inside = at(place)?;
        if inside.value > start.value {
            return Some(Brent::new([start, beyond], inside));
        }
        (beyond, place) = (inside, 0.1 * place);
    }
    None
}

/// A bracket around the highest of a few places inside, if it is higher than the places beside it.
fn hidden_bracket(
    at: &mut impl FnMut(f64) -> Option<Sample>,
    [start, end]: [Sample; 2],
) -> Option<Brent> {
    // Near the larger end the search has begun already, and has found that the function falls from there.
    let samples = if start.value <= end.value {
        [start, at(NEAR)?, at(0.5)?, end]
    } else {
        [start, at(0.5)?, at(1.0 - NEAR)?, end]
    };
    let higher =
        |beside: &&[Sample]| beside[1].value > beside[0].value && beside[1].value > beside[2].value;
    let tops = samples.windows(3).filter(higher);
    let top = tops.max_by(|a, b| a[1].value.total_cmp(&b[1].value))?;
    Some(Brent::new([top[0], top[2]], top[1]))
}

/// The search for a maximum by parabolas and golden sections, in the letters of Brent 1973, *Algorithms for Minimization
/// without Derivatives*, ch. 5 (isbn 978-0-486-41998-5).
struct Brent {
    /// The maximum lies between `a` and `b`.
    a: f64,
    b: f64,
    /// The highest, the second and the third highest sample.
    x: Sample,
    w: Sample,
    v: Sample,
    /// The last step, and the one before it.
    d: f64,
    e: f64,
    /// Places closer than this count as the same.
    tolerance: f64,
}

impl Brent {
    fn new([low, high]: [Sample; 2], x: Sample) -> Self {
        let (w, v) = if low.value > high.value { (low, high) } else { (high, low) };
        let length = high.place - low.place;
        Self {
            a: low.place,
            b: high.place,
            x,
            w,
            v,
            d: length,
            e: length,
            tolerance: CLOSE * length,
        }
    }

    /// The next place to look at; `None` if the bracket is narrow enough.
    fn next_place(&mut self) -> Option<f64> {
        let (x, middle) = (self.x.place, 0.5 * (self.a + self.b));
        let narrow = (x - middle).abs() <= 2.0 * self.tolerance - 0.5 * (self.b - self.a);
        if narrow || self.x.value - self.v.value <= FLAT * self.x.value.abs() {
            return None;
        }
        if let Some(step) = self.vertex() {
            (self.d, self.e) = (step, self.d);
        } else {
            let larger = if x < middle { self.b - x } else { self.a - x };
            (self.d, self.e) = (GOLDEN * larger, larger);
        }
        Some(x + self.d.abs().max(self.tolerance).copysign(self.d))
    }

    /// Step to the vertex of the parabola through the three samples, where that converges.
    fn vertex(&self) -> Option<f64> {
        let [(x, fx), (w, fw), (v, fv)] =
            [self.x, self.w, self.v].map(|sample| (sample.place, sample.value));
        let (r, q) = ((x - w) * (fx - fv), (x - v) * (fx - fw));
        let step = -0.5 * ((x - v) * q - (x - w) * r) / (q - r);
        let inside = self.a + self.tolerance < x + step && x + step < self.b - self.tolerance;
        (inside && step.abs() < 0.5 * self.e.abs()).then_some(step)
    }

    /// Takes a new sample `u` into account.
    fn take(&mut self, u: Sample) {
        let (inner, outer) = if u.value >= self.x.value { (u, self.x) } else { (self.x, u) };
        let end = if outer.place > inner.place { &mut self.b } else { &mut self.a };
        *end = outer.place;
        if u.value >= self.x.value {
            (self.x, self.w, self.v) = (u, self.x, self.w);
        } else if u.value >= self.w.value {
            (self.w, self.v) = (u, self.w);
        } else if u.value >= self.v.value {
            self.v = u;
        }
    }
}

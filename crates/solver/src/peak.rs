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

/// The smaller part of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Follows the largest value that a function of a system, an equilibrium and its path direction takes.
///
/// At a kink the direction has two values, and the function is evaluated with both.
#[derive(Clone, Debug)]
pub struct Peak<M = ()> {
    best: Option<Best<M>>,
    last: Option<Arc<Point<M>>>,
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
        Self { best: None, last: None }
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
        if self.best.as_ref().is_none_or(|best| value > best.value) {
            let (before, point) = (self.last.take(), Arc::clone(&here));
            self.best = Some(Best { value, before, point, after: None });
        } else if let Some(best) = &mut self.best {
            best.after.get_or_insert_with(|| Arc::clone(&here));
        }
        self.last = Some(here);
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
        for point in best.chain(&mut self.last) {
            *point = Arc::new(new(point));
        }
    }

    /// The largest value on the path, the segments next to the best of the points visited included. `None` if none was
    /// visited. Steps must be small enough for the highest maximum to show at a point beside it.
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
        let inside = segments.into_iter().flatten();
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
    let mut search = bracket(&mut at, [start, end], from.event.is_some())?;
    for _ in 0..EVALUATIONS {
        let Some(place) = search.next_place() else { break };
        search.take(at(place)?);
    }
    let value = search.x.value;
    Some(Summit { value, point: Arc::new(nearest), before: None, is_inside: true })
}

/// A bracket of the maximum, where the function rises from the larger end.
///
/// A force that has just begun to act may raise the function within a small part of the segment, so
/// behind a kink the search goes on towards the start.
fn bracket(
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

//! The maximum of a quantity along the path, between its points too.

use std::sync::Arc;

use crate::path::{Path, Point};
use crate::system::{State, System};

/// A search ends where the best three values agree to this part, or where the place is known to `CLOSE` of
/// the first bracket, or after so many evaluations.
const FLAT: f64 = 1e-10;
const CLOSE: f64 = 1e-5;
const EVALUATIONS: usize = 40;

/// How far from the larger end of a segment a search begins; and how many times, each a tenth as far, where
/// the segment begins at a kink.
const NEAR: f64 = 0.05;
const CLOSER: usize = 4;

/// The smaller part of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Follows the largest value that a function of a system, an equilibrium and its path direction takes.
///
/// At a kink the direction has two values, and the function is evaluated with both.
#[derive(Clone, Debug)]
pub struct Peak<S> {
    best: Option<f64>,
    /// The best point and its neighbours, as far as there are any.
    around: Vec<Visited<S>>,
    /// Whether the one after the best is among them.
    complete: bool,
    /// The last point, unless it stands in `around`.
    last: Option<Visited<S>>,
}

/// A point, and the system with which the path goes on from there: it changes at events.
#[derive(Clone, Debug)]
struct Visited<S> {
    point: Arc<Point>,
    system: Arc<S>,
}

impl<S> Default for Peak<S> {
    fn default() -> Self {
        Self { best: None, around: Vec::new(), complete: false, last: None }
    }
}

impl<S: System> Peak<S> {
    /// Takes the point that `path` has come to into account.
    pub fn visit(&mut self, path: &Path<S>, f: impl Fn(&S, &State, &[f64]) -> f64) {
        let here = Visited { point: Arc::clone(&path.point), system: Arc::clone(&path.system) };
        let at = |direction: &[f64]| f(&here.system, &here.point.state, direction);
        let value = at(&here.point.arriving).max(at(&here.point.leaving));
        if self.best.is_none_or(|best| value > best) {
            self.best = Some(value);
            let before = self.last.take().or_else(|| self.around.pop());
            self.around.clear();
            self.around.extend(before.into_iter().chain([here]));
            self.complete = false;
        } else if self.complete {
            self.last = Some(here);
        } else {
            self.around.push(here);
            self.complete = true;
        }
    }

    /// The largest value at the points visited.
    pub fn sampled(&self) -> Option<f64> {
        self.best
    }

    /// The largest value on the path, that is, between the points next to the best one too. Steps
    /// must be small enough for the highest maximum to show at a point beside it.
    pub fn refined(&self, path: &Path<S>, f: impl Fn(&S, &State, &[f64]) -> f64) -> Option<f64> {
        let inside = self.around.windows(2).filter_map(|ends| {
            let mut path = path.with_system(Arc::clone(&ends[0].system));
            segment_maximum(&mut path, &ends[0].point, &ends[1].point, &f)
        });
        inside.chain(self.best).reduce(f64::max)
    }
}

/// The maximum inside a segment, where there is one.
fn segment_maximum<S: System>(
    path: &mut Path<S>,
    from: &Point,
    to: &Point,
    f: &impl Fn(&S, &State, &[f64]) -> f64,
) -> Option<f64> {
    let system = Arc::clone(&path.system);
    let f = |point: &Point, direction: &[f64]| f(&system, &point.state, direction);
    let ends = [(0.0, f(from, &from.leaving)), (1.0, f(to, &to.arriving))];
    let mut nearest = from.clone();
    let mut highest = f64::NEG_INFINITY;
    let mut at = |x: f64| {
        let point = path.between_from(from, to, x, &nearest)?;
        let value = f(&point, &point.arriving);
        if value >= highest {
            (highest, nearest) = (value, point);
        }
        Some((x, value))
    };
    let mut search = bracket(&mut at, ends, from.event.is_some())?;
    for _ in 0..EVALUATIONS {
        let Some(x) = search.next_place() else { break };
        search.take(at(x)?);
    }
    Some(search.best.1)
}

/// A bracket of the maximum, where the function rises from the larger end.
///
/// A force that has just begun to act may raise the function within a small part of the segment, so
/// behind a kink the search goes on towards the start.
fn bracket(
    at: &mut impl FnMut(f64) -> Option<(f64, f64)>,
    [start, end]: [(f64, f64); 2],
    kink: bool,
) -> Option<Search> {
    if start.1 <= end.1 {
        let inside = at(1.0 - NEAR)?;
        return (inside.1 > end.1).then(|| Search::new([start, end], inside));
    }
    let (mut beyond, mut x) = (end, NEAR);
    for _ in 0..if kink { CLOSER } else { 1 } {
        let inside = at(x)?;
        if inside.1 > start.1 {
            return Some(Search::new([start, beyond], inside));
        }
        (beyond, x) = (inside, 0.1 * x);
    }
    None
}

/// The search for a maximum by parabolas and golden sections (Brent 1973, isbn 978-0-486-41998-5, ch. 5).
struct Search {
    /// Bracket of the maximum.
    bracket: [f64; 2],
    /// The three highest places so far, with their values.
    best: (f64, f64),
    second: (f64, f64),
    third: (f64, f64),
    /// The last step and the one before.
    steps: [f64; 2],
    /// Places closer than this are the same.
    close: f64,
}

impl Search {
    fn new(ends: [(f64, f64); 2], inside: (f64, f64)) -> Self {
        let [low, high] = ends;
        let (second, third) = if low.1 > high.1 { (low, high) } else { (high, low) };
        let length = high.0 - low.0;
        Self {
            bracket: [low.0, high.0],
            best: inside,
            second,
            third,
            steps: [length; 2],
            close: CLOSE * length,
        }
    }

    /// The next place to look at; `None` where the bracket is narrow enough.
    fn next_place(&mut self) -> Option<f64> {
        let [low, high] = self.bracket;
        let (x, middle) = (self.best.0, 0.5 * (low + high));
        let narrow = (x - middle).abs() <= 2.0 * self.close - 0.5 * (high - low);
        if narrow || self.best.1 - self.third.1 <= FLAT * self.best.1.abs() {
            return None;
        }
        let step = self.vertex().unwrap_or_else(|| self.golden());
        self.steps = [step, self.steps[0]];
        Some(x + step.abs().max(self.close).copysign(step))
    }

    /// Step to the vertex of the parabola through the three places, where that converges.
    fn vertex(&self) -> Option<f64> {
        let [(x, f), (w, g), (v, h)] = [self.best, self.second, self.third];
        let (r, q) = ((x - w) * (f - h), (x - v) * (f - g));
        let step = -0.5 * ((x - v) * q - (x - w) * r) / (q - r);
        let [low, high] = self.bracket;
        let inside = low + self.close < x + step && x + step < high - self.close;
        (inside && step.abs() < 0.5 * self.steps[1].abs()).then_some(step)
    }

    /// Step into the larger part of the bracket.
    fn golden(&mut self) -> f64 {
        let [low, high] = self.bracket;
        let x = self.best.0;
        let larger = if x < 0.5 * (low + high) { high - x } else { low - x };
        self.steps[0] = larger;
        GOLDEN * larger
    }

    fn take(&mut self, new: (f64, f64)) {
        let (outer, inner) = if new.1 >= self.best.1 { (self.best, new) } else { (new, self.best) };
        self.bracket[usize::from(outer.0 > inner.0)] = outer.0;
        if new.1 >= self.best.1 {
            (self.best, self.second, self.third) = (new, self.best, self.second);
        } else if new.1 >= self.second.1 {
            (self.second, self.third) = (new, self.second);
        } else if new.1 >= self.third.1 {
            self.third = new;
        }
    }
}

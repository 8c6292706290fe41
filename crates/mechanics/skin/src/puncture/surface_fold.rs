//! Gaps of the surface of the substrate: how far they are stretched along the path, and where they fold over.

use solver::{Bracket, Path, dip};

use super::PuncturePoint;
use super::system::Chain;
use crate::contacts::{SkinPoint, SkinState};
use crate::record::Skin;

/// A gap counts as closed where its stretch is off zero by less than this.
const CLOSE: f64 = 1e-12;

/// Evaluations after which the bracket of a fold is as narrow as an `f64` allows.
const EVALUATIONS: usize = 100;

/// Stretch of the tightest and of the widest gap of a row (V1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapStretch {
    /// Smallest stretch; the surface is folded over where it is not above zero.
    pub min: f64,
    /// Largest stretch.
    pub max: f64,
}

/// The surface of the substrate folds over in a gap, or unfolds: two bases pass each other (V2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// The point of the path at which the gap has vanished. It lies between points that were recorded.
    pub point: PuncturePoint,
    /// Left scale of the gap: 0 is the punctured one, positive to the right.
    pub left_scale: i64,
    /// Whether the surface folds over there; else it unfolds.
    pub folds: bool,
    /// Contact events before it.
    pub events_before: usize,
}

impl Fold {
    /// Short name of what happens, as in tables.
    pub fn name(&self) -> &'static str {
        if self.folds { "folded" } else { "unfolded" }
    }
}

/// A sign change of the stretch of a gap within a segment of the path.
struct FoldCrossing {
    /// Left scale of the gap.
    pair: usize,
    folds: bool,
    /// Parts of the segment between which it lies, with the stretch there.
    bracket: Bracket,
}

/// The folds of a path, and the equilibrium of the first.
#[derive(Default)]
pub(super) struct FoldObserver {
    pub(super) folds: Vec<Fold>,
    pub(super) first: Option<SkinPoint>,
}

impl FoldObserver {
    /// Looks for folds on the segment between two neighbouring points of a path; `events_before` contact events were before it.
    pub(super) fn follow(
        &mut self,
        path: &mut Path<Chain>,
        [from, to]: [&SkinPoint; 2],
        events_before: usize,
    ) {
        // Measures need the first fold alone: a sweep does not solve for the others.
        if self.first.is_some() && !path.system().whole_path {
            return;
        }
        let crossings = crossings(path, from, to);
        let located = |crossing: FoldCrossing| (crossing.locate(path, from, to), crossing);
        let mut places: Vec<_> = crossings.into_iter().map(located).collect();
        // Gaps were looked at one by one, and the path meets their folds in an order of its own.
        places.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
        for ((_, point), FoldCrossing { pair, folds, .. }) in places {
            let chain = path.system();
            let (left_scale, here) = (chain.layout.number(pair), chain.path_point(&point));
            self.folds.push(Fold { point: here, left_scale, folds, events_before });
            self.first.get_or_insert(point);
        }
    }
}

/// The sign changes of all gaps between two neighbouring points: by the stretch at both, and, where it has the same sign, where
/// its slopes say that it changes in between and back.
fn crossings(path: &mut Path<Chain>, from: &SkinPoint, to: &SkinPoint) -> Vec<FoldCrossing> {
    let spans = path.spans(from, to);
    let mut crossings = Vec::new();
    for pair in 0..path.system().layout.scales() - 1 {
        let chain = path.system();
        let [start, end] = [&from.state, &to.state].map(|state| chain.gap_stretch(state, pair));
        if is_folded(start) != is_folded(end) {
            let bracket = Bracket::new((0.0, start), (1.0, end));
            crossings.push(FoldCrossing { pair, folds: is_folded(end), bracket });
            continue;
        }
        // A dip is one towards zero from above, so that a folded gap is looked at upside down.
        let sign = if is_folded(start) { -1.0 } else { 1.0 };
        let slopes = [
            spans[0] * chain.gap_stretch_rate(&from.state, &from.leaving, pair),
            spans[1] * chain.gap_stretch_rate(&to.state, &to.arriving, pair),
        ];
        let Some(place) = dip([start, end].map(|g| sign * g), slopes.map(|g| sign * g)) else {
            continue;
        };
        let Some(inside) = path.between(from, to, place) else { continue };
        let stretch = path.system().gap_stretch(&inside.state, pair);
        // The slopes only suspect a dip: the equilibrium there decides.
        if is_folded(stretch) != is_folded(start) {
            let inside = (place, stretch);
            let [before, after] =
                [Bracket::new((0.0, start), inside), Bracket::new(inside, (1.0, end))];
            crossings.push(FoldCrossing { pair, folds: is_folded(stretch), bracket: before });
            crossings.push(FoldCrossing { pair, folds: is_folded(end), bracket: after });
        }
    }
    crossings
}

fn is_folded(stretch: f64) -> bool {
    stretch <= 0.0
}

impl FoldCrossing {
    /// The equilibrium at which the gap vanishes, and its place. If Newton's method fails, the last equilibrium that was found.
    fn locate(&self, path: &mut Path<Chain>, from: &SkinPoint, to: &SkinPoint) -> (f64, SkinPoint) {
        let mut bracket = self.bracket;
        let mut near = (0.0, from.clone());
        for _ in 0..EVALUATIONS {
            let place = bracket.secant();
            // From the last equilibrium that was found, which is the nearest that is known.
            let Some(point) = path.between_from(from, to, place, &near.1) else { break };
            let stretch = path.system().gap_stretch(&point.state, self.pair);
            near = (place, point);
            if stretch.abs() <= CLOSE || bracket.width() < f64::EPSILON {
                break;
            }
            bracket.narrow(place, stretch);
        }
        near
    }
}

impl Chain {
    /// Stretch of the gap to the right of a scale.
    pub(super) fn gap_stretch(&self, state: &SkinState, scale: usize) -> f64 {
        let [left, right] = [scale, scale + 1].map(|i| self.displacement(&state.z, i));
        self.strip(scale).stretch(left, right)
    }

    /// Derivative of [`Chain::gap_stretch`] along a direction.
    fn gap_stretch_rate(&self, state: &SkinState, direction: &[f64], scale: usize) -> f64 {
        let of = |z: &[f64]| [scale, scale + 1].map(|i| self.displacement(z, i));
        self.strip(scale).stretch_rate(of(&state.z), of(direction))
    }

    /// Stretch of the tightest and of the widest gap, those beyond the ends of a part of an endless row included; `None` for a
    /// single scale.
    pub(super) fn gap_stretches(&self, state: &SkinState) -> Option<GapStretch> {
        let within = (0..self.layout.scales() - 1).map(|pair| self.gap_stretch(state, pair));
        let all = within.chain(self.stretches_beyond(&state.z));
        let extremes = |so_far: Option<GapStretch>, g: f64| {
            let GapStretch { min, max } = so_far.unwrap_or(GapStretch { min: g, max: g });
            Some(GapStretch { min: min.min(g), max: max.max(g) })
        };
        all.fold(None, extremes)
    }
}

//! Stretch of the gaps of the surface along the path, and points at which the surface folds.

use solver::{Bracket, Continuation, dip};
use substrate::shortening;

use super::PuncturePoint;
use super::system::Chain;
use crate::contacts::{SkinPoint, SkinState};
use crate::record::Skin;

/// Largest stretch at which a gap counts as closed.
///
/// While the corners of two bases touch, the stretch is zero up to round-off.
const CLOSE: f64 = 1e-12;

/// Rate of the stretch along the path up to which a gap does not count as narrowing.
const NO_RATE: f64 = 1e-9;

/// Number of evaluations after which a bracket is as narrow as an `f64` allows.
const EVALUATIONS: usize = 100;

/// Stretch of the tightest and of the widest gap of a row (V1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapStretch {
    /// Smallest stretch; the surface is folded if it is zero or negative.
    pub min: f64,
    /// Largest stretch.
    pub max: f64,
}

/// Folding or unfolding of the surface in a gap, where two bases cross (V2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// Equilibrium at which the gap has zero width, located between recorded points.
    pub point: PuncturePoint,
    /// Number of the scale on the left of the gap: 0 is the punctured one, positive to the right.
    pub left_scale: i64,
    /// True if the surface folds over, false if it unfolds.
    pub folds: bool,
    /// Number of contact events before the fold.
    pub events_before: usize,
}

impl Fold {
    /// Returns the short name used in tables.
    pub fn name(&self) -> &'static str {
        if self.folds { "folded" } else { "unfolded" }
    }
}

/// Sign change of the stretch of a gap within a path segment.
struct FoldCrossing {
    /// Index of the scale on the left of the gap.
    pair: usize,
    /// True if the gap folds, false if it unfolds.
    folds: bool,
    /// Fractions of the segment on both sides of the sign change, with the stretch at each.
    bracket: Bracket,
}

/// Finds the folds of the surface while a path is followed.
pub(super) struct FoldObserver {
    pub(super) folds: Vec<Fold>,
    /// Equilibrium at the first fold.
    pub(super) first: Option<SkinPoint>,
    /// Smallest stretch at which a gap stopped narrowing, folded or not.
    ///
    /// Infinite if no gap stopped narrowing.
    pub(super) least_dip: f64,
}

impl Default for FoldObserver {
    fn default() -> Self {
        Self { folds: Vec::new(), first: None, least_dip: f64::INFINITY }
    }
}

impl FoldObserver {
    /// Finds the folds on a path segment; `events_before` contact events precede the segment.
    pub(super) fn follow(
        &mut self,
        path: &mut Continuation<Chain>,
        [from, to]: [&SkinPoint; 2],
        events_before: usize,
    ) {
        // Unless the whole path is recorded, only the first fold is needed.
        let is_known = self.first.is_some() && !path.system().is_recorded_whole();
        if is_known && !path.system().is_critical_only() {
            return;
        }
        // With critical measures, watch all gaps up to the end of the path. If a gap almost folds
        // and opens again, this end is not used as a start for similar designs.
        let crossings = self.crossings(path, from, to);
        if is_known {
            return;
        }
        let mut located: Vec<_> = crossings
            .into_iter()
            .map(|crossing| (crossing.locate(path, from, to), crossing))
            .collect();
        // Crossings are listed by gap; sort them along the path.
        located.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
        for ((_, point), FoldCrossing { pair, folds, .. }) in located {
            let chain = path.system();
            let (left_scale, here) = (chain.layout.number(pair), chain.path_point(&point));
            self.folds.push(Fold { point: here, left_scale, folds, events_before });
            self.first.get_or_insert(point);
        }
    }

    /// Creates an observer with a known `first` fold, of the gap to the right of scale `pair`.
    pub(super) fn after(chain: &Chain, pair: usize, first: SkinPoint) -> Self {
        let (left_scale, point) = (chain.layout.number(pair), chain.path_point(&first));
        let fold = Fold { point, left_scale, folds: true, events_before: 0 };
        Self { folds: vec![fold], first: Some(first), ..Self::default() }
    }

    /// Finds the sign changes of all gap stretches between two neighbouring points.
    ///
    /// If the stretch has the same sign at both points, its slopes indicate whether it passes zero
    /// twice in between.
    fn crossings(
        &mut self,
        path: &mut Continuation<Chain>,
        from: &SkinPoint,
        to: &SkinPoint,
    ) -> Vec<FoldCrossing> {
        let spans = path.spans(from, to);
        let mut crossings = Vec::new();
        let mut left = base_positions(path.system(), [from, to], 0);
        for pair in 0..path.system().layout.scales() - 1 {
            let (chain, right) =
                (path.system(), base_positions(path.system(), [from, to], pair + 1));
            let strip = chain.strip(pair);
            let [start, end] = [0, 1].map(|k| {
                let (apart, shortened) =
                    (right[k].x - left[k].x, left[k].shortened + right[k].shortened);
                strip.stretch_by(apart, shortened)
            });
            left = right;
            if chain.is_critical_only() {
                self.note_dip(chain, [from, to], pair, [start, end]);
            }
            if is_folded(start) != is_folded(end) {
                let bracket = bracket((0.0, start), (1.0, end));
                crossings.push(FoldCrossing { pair, folds: is_folded(end), bracket });
                continue;
            }
            // `dip` detects minima below zero of positive functions, so change the sign of the
            // stretch of a folded gap.
            let sign = if is_folded(start) { -1.0 } else { 1.0 };
            let falling =
                sign * spans[0] * chain.gap_stretch_rate(&from.state, &from.leaving, pair);
            // Compute the slope at the end only if the stretch decreases at the start.
            if falling >= 0.0 {
                continue;
            }
            let rising = sign * spans[1] * chain.gap_stretch_rate(&to.state, &to.arriving, pair);
            let ends = [start, end].map(|g| sign * g);
            let Some(fraction) = dip(ends, [falling, rising]) else { continue };
            let Some(inside) = path.between(from, to, fraction) else { continue };
            let stretch = path.system().gap_stretch(&inside.state, pair);
            // The slopes only suggest a sign change. Solve for the equilibrium to confirm it.
            if is_folded(stretch) != is_folded(start) {
                let inside = (fraction, stretch);
                let [before, after] = [bracket((0.0, start), inside), bracket(inside, (1.0, end))];
                crossings.push(FoldCrossing { pair, folds: is_folded(stretch), bracket: before });
                crossings.push(FoldCrossing { pair, folds: is_folded(end), bracket: after });
            }
        }
        crossings
    }

    /// Records the stretch of a gap that stops narrowing within a segment or at its end.
    ///
    /// `stretch` holds its values at both ends.
    fn note_dip(
        &mut self,
        chain: &Chain,
        [from, to]: [&SkinPoint; 2],
        pair: usize,
        stretch: [f64; 2],
    ) {
        let rates = [(&from.state, &from.leaving), (&to.state, &to.arriving)]
            .map(|(state, direction)| chain.gap_stretch_rate(state, direction, pair));
        let stops = rates[1] > 0.0
            || (to.event.is_some()
                && chain.gap_stretch_rate(&to.state, &to.leaving, pair) > -NO_RATE);
        if (rates[0] < 0.0 || rates[1] < 0.0) && stops {
            self.least_dip = stretch.into_iter().fold(self.least_dip, f64::min);
        }
    }
}

/// Position of a base along the row, relative to its position at rest.
#[derive(Clone, Copy)]
struct BasePosition {
    /// Displacement of the node along the row.
    x: f64,
    /// [`shortening`] of each half of the base.
    shortened: f64,
}

/// Returns the positions of the base of a scale at both ends of a segment.
fn base_positions(chain: &Chain, ends: [&SkinPoint; 2], scale: usize) -> [BasePosition; 2] {
    ends.map(|point| {
        let [x, _, rotation] = chain.displacement(&point.state.z, scale);
        BasePosition { x, shortened: shortening(rotation) }
    })
}

/// Returns true if a gap with this stretch is folded.
pub(super) fn is_folded(stretch: f64) -> bool {
    stretch <= CLOSE
}

/// Brackets the closing or opening of a gap between two points of a segment.
///
/// Each point is a fraction of the segment with the stretch at this fraction.
fn bracket(low: (f64, f64), high: (f64, f64)) -> Bracket {
    // The stretch of a closed gap may be positive by round-off, but false position needs opposite
    // signs or a zero.
    let [low, high] =
        [low, high].map(|(fraction, g)| (fraction, if g.abs() <= CLOSE { 0.0 } else { g }));
    Bracket::new(low, high)
}

impl FoldCrossing {
    /// Solves for the equilibrium with zero gap, and returns it with its fraction of the segment.
    ///
    /// If Newton's method fails, returns the last equilibrium found.
    fn locate(
        &self,
        path: &mut Continuation<Chain>,
        from: &SkinPoint,
        to: &SkinPoint,
    ) -> (f64, SkinPoint) {
        let mut bracket = self.bracket;
        let mut near = (0.0, from.clone());
        for _ in 0..EVALUATIONS {
            let fraction = bracket.secant();
            // Start from the previous equilibrium, which is the nearest known one.
            let Some(point) = path.between_from(from, to, fraction, &near.1) else { break };
            let stretch = path.system().gap_stretch(&point.state, self.pair);
            near = (fraction, point);
            if stretch.abs() <= CLOSE || bracket.width() < f64::EPSILON {
                break;
            }
            bracket.narrow(fraction, stretch);
        }
        near
    }
}

impl Chain {
    /// Computes the stretch of the gap to the right of a scale.
    pub(super) fn gap_stretch(&self, state: &SkinState, scale: usize) -> f64 {
        let [left, right] = [scale, scale + 1].map(|i| self.displacement(&state.z, i));
        self.strip(scale).stretch(left, right)
    }

    /// Returns the first gap with a stretch of at most `limit`: the scale on its left.
    pub(super) fn gap_below(&self, state: &SkinState, limit: f64) -> Option<usize> {
        (0..self.layout.scales() - 1).find(|&pair| self.gap_stretch(state, pair) <= limit)
    }

    /// Computes the derivative of [`Chain::gap_stretch`] along a direction of the unknowns.
    pub(super) fn gap_stretch_rate(
        &self,
        state: &SkinState,
        direction: &[f64],
        scale: usize,
    ) -> f64 {
        let poses = [self.displacement(&state.z, scale), self.displacement(&state.z, scale + 1)];
        let rates = [self.displacement(direction, scale), self.displacement(direction, scale + 1)];
        self.strip(scale).stretch_rate(poses, rates)
    }

    /// Computes the stretch of the tightest and of the widest gap.
    ///
    /// Includes the gaps beyond the solved part of a longer row. `None` for a single scale.
    pub(super) fn gap_stretches(&self, state: &SkinState) -> Option<GapStretch> {
        let within = (0..self.layout.scales() - 1).map(|pair| self.gap_stretch(state, pair));
        let all = within.chain(self.stretches_beyond(&state.z));
        all.fold(None, |so_far: Option<GapStretch>, g: f64| {
            let GapStretch { min, max } = so_far.unwrap_or(GapStretch { min: g, max: g });
            Some(GapStretch { min: min.min(g), max: max.max(g) })
        })
    }
}

//! The teeth of coverage: pieces of the space in which it is smooth.
//!
//! With the reach `S = tan α`, the pitch `p` and the gap `d`, all over `t`, the coverage rises to the peak `k` of its teeth and falls
//! behind it,
//!
//! ```text
//! λ = 1 − k d/S,   (k − 1) p + d ≤ S ≤ k p;        λ = k (p − d)/S,   k p ≤ S ≤ k p + d                 (O8)
//! ```
//!
//! so `λ ≤ 1 − d/p`, with equality at the peaks alone. A requirement on coverage cuts the space into slivers round the peaks, a few per
//! cent apart, and a search along derivatives stays in the one where it begins.

use std::collections::BTreeMap;

use ranking::Requirement;
use results::{DesignResult, DesignRow};
use sweep::{Case, DesignNumber, Parameter};

use crate::fill;
use crate::judge::Judge;
use crate::slopes::Slopes;
use crate::space::{DesignSpace, SpacePoint};

/// A place on the border of two pieces, but for round-off of a step that was to end there, counts as part of both.
const BORDER: f64 = 1e-7;

/// Points from which peaks are looked for.
const POINTS: usize = 256;

/// Points on each peak that are solved.
const EACH: usize = 6;

/// A point that falls this much short of what is known in closed form is not solved.
const HOPELESS: f64 = 0.25;

/// Points on a peak that are solved are apart by this share of some interval.
const APART: f64 = 0.05;

/// Bisections that find a peak on an interval, well within [`BORDER`].
const BISECTIONS: usize = 40;

/// One side of a peak of coverage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tooth {
    /// The number `k` of the peak.
    pub peak: u32,
    /// Whether coverage rises with the slant here.
    rising: bool,
}

/// Reach, gap and pitch of a row, over the thickness.
#[derive(Clone, Copy)]
struct Lengths {
    reach: f64,
    gap: f64,
    pitch: f64,
}

impl Lengths {
    fn of(case: &Case) -> Option<Self> {
        let row = case.design.row().ok()?;
        Some(Self { reach: row.scale().shift(), gap: row.gap(), pitch: row.pitch() })
    }

    /// `S/p`, a whole number at the peaks.
    fn place(self) -> f64 {
        self.reach / self.pitch
    }
}

impl Tooth {
    /// The pieces that a design belongs to: one, or those on both sides of a border.
    pub fn beside(case: &Case) -> Vec<Self> {
        let Some(lengths) = Lengths::of(case) else { return Vec::new() };
        let whole = lengths.place().floor() as u32;
        let sides = |peak| [true, false].map(|rising| Self { peak, rising });
        let near = [whole, whole + 1].into_iter().flat_map(sides);
        let holds = |tooth: &Self| tooth.borders(lengths).iter().all(|beyond| *beyond <= BORDER);
        near.filter(holds).collect()
    }

    /// How far a design is beyond the two borders; not above 0 within.
    fn borders(self, lengths: Lengths) -> [f64; 2] {
        let (place, open) = (lengths.place(), lengths.gap / lengths.pitch);
        let peak = f64::from(self.peak);
        let [from, to] = if self.rising { [peak - 1.0 + open, peak] } else { [peak, peak + open] };
        [from - place, place - to]
    }

    /// The number of its borders.
    pub const BORDERS: usize = 2;

    /// How far a design is beyond a border.
    pub fn beyond(self, border: usize, case: &Case) -> Option<f64> {
        Lengths::of(case).map(|lengths| self.borders(lengths)[border])
    }

    /// The derivatives of how far a design is within a border.
    pub fn border_slopes(self, border: usize, case: &Case, parameter: &Parameter) -> Slopes {
        let at = |by, _| Some(-self.beyond(border, &parameter.moved(case, by)?)?);
        Slopes::between(parameter.size(case), at)
    }

    /// The coverage of this piece, continued beyond its borders (O8).
    fn coverage(self, case: &Case) -> Option<f64> {
        let Lengths { reach, gap, pitch } = Lengths::of(case)?;
        let peak = f64::from(self.peak);
        Some(if self.rising { 1.0 - peak * gap / reach } else { peak * (pitch - gap) / reach })
    }

    /// Continues the coverage of a row and its derivatives smoothly beyond the borders.
    pub fn continue_coverage(self, row: &mut DesignRow) {
        row.result.coverage = self.coverage(&row.case);
        differentiate(row, "coverage", |case| self.coverage(case));
    }
}

/// The part `d/p` of the pitch that the gap takes; `None` of a row that cannot be.
pub(crate) fn open_share(case: &Case) -> Option<f64> {
    Lengths::of(case).map(|lengths| lengths.gap / lengths.pitch)
}

/// Continues the compliance of strips that do not touch, `d/p`, beyond where they do.
pub(crate) fn continue_compliance(row: &mut DesignRow) {
    if let Some(flexure) = &mut row.result.flexure {
        flexure.measures.compliance = open_share(&row.case);
    }
    differentiate(row, "compliance", open_share);
}

/// Puts a smooth function of the case in the place of a measure with derivatives.
fn differentiate(row: &mut DesignRow, measure: &str, value: impl Fn(&Case) -> Option<f64>) {
    let Some(here) = value(&row.case) else { return };
    for of in row.result.sensitivity.iter_mut().filter(|of| of.measure == measure) {
        let Some(parameter) = Parameter::named(of.parameter) else { continue };
        let at = |by, _| value(&parameter.moved(&row.case, by)?);
        let slopes = Slopes::between(parameter.size(&row.case), at);
        (of.left, of.right, of.value, of.kink) = (slopes.left, slopes.right, here, None);
    }
}

/// Points on every peak of coverage that the space has, those first that fall least short of the requirements that are known in closed form.
pub(crate) fn points_on_peaks(space: &DesignSpace, judge: &Judge, seed: u64) -> Vec<SpacePoint> {
    let number = space.sweep().grid().number(0);
    let mut on_peaks: BTreeMap<u32, Vec<(f64, SpacePoint)>> = BTreeMap::new();
    for point in fill::points(space, POINTS, seed) {
        for interval in 0..point.shares.len() {
            for (peak, found) in peaks_along(space, &point, interval) {
                let shortfall = known_shortfall(judge, &space.case(&found), number);
                on_peaks.entry(peak).or_default().push((shortfall, found));
            }
        }
    }
    on_peaks.into_values().flat_map(spread).collect()
}

/// The points on peaks that are reached from `point` along an interval.
fn peaks_along(space: &DesignSpace, point: &SpacePoint, interval: usize) -> Vec<(u32, SpacePoint)> {
    let at = |share: f64| {
        let mut moved = point.clone();
        moved.shares[interval] = share;
        moved
    };
    let place = |share| Lengths::of(&space.case(&at(share))).map(Lengths::place);
    let Some((first, last)) = place(0.0).zip(place(1.0)) else { return Vec::new() };
    let (low, high) = (first.min(last), first.max(last));
    // The place `S/p` grows or falls all along an interval, whichever length it is.
    let on_peak = |peak: u32| {
        let (mut below, mut above) = if first < last { (0.0, 1.0) } else { (1.0, 0.0) };
        for _ in 0..BISECTIONS {
            let middle = f64::midpoint(below, above);
            let is_below = place(middle)? < f64::from(peak);
            *(if is_below { &mut below } else { &mut above }) = middle;
        }
        Some((peak, at(above)))
    };
    (low.floor() as u32 + 1..=high.floor() as u32).filter_map(on_peak).collect()
}

/// How far a design on a peak falls short of what is known of its requirements without solving it: coverage, parameters, masses, and
/// that no compliance is above `d/p`.
fn known_shortfall(judge: &Judge, case: &Case, number: DesignNumber) -> f64 {
    let Some(open) = open_share(case) else { return f64::INFINITY };
    let result = DesignResult { coverage: Some(1.0 - open), ..DesignResult::default() };
    let margin = |(requirement, value): (&Requirement, Option<f64>)| {
        let is_compliance = COMPLIANCES.contains(&requirement.column.as_str());
        let bound = || (is_compliance && requirement.direction() > 0.0).then_some(open);
        value.or_else(bound).map_or(0.0, |value| requirement.margin(value).min(0.0))
    };
    -judge.known(case, number, result).into_iter().map(margin).sum::<f64>()
}

/// Columns that are at most `d/p`: a strip that bends is never less stiff than at rest, where its gaps alone bend.
pub(crate) const COMPLIANCES: [&str; 2] = ["compliance", "initial_compliance"];

/// The first of some points by their shortfalls that are apart from each other.
fn spread(mut points: Vec<(f64, SpacePoint)>) -> Vec<SpacePoint> {
    points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut chosen: Vec<SpacePoint> = Vec::new();
    for (shortfall, point) in points {
        if shortfall <= HOPELESS
            && chosen.len() < EACH
            && chosen.iter().all(|other| other.distance(&point) >= APART)
        {
            chosen.push(point);
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweep::Sweep;

    fn case(gap: f64, length: f64, slant: f64) -> Case {
        let text = format!(
            "name = 'x'\n[designs]\ngap_over_t = {gap}\nlength_over_t = {length}\nslant_deg = {slant}"
        );
        Sweep::parse(&text, "x.toml", &[]).expect("a sweep").grid().case(0)
    }

    #[test]
    fn a_piece_has_the_coverage_of_its_designs() {
        let mut peaks = Vec::new();
        for slant in 1..75 {
            let case = case(0.13, 0.31, f64::from(slant));
            let coverage = case.design.row().expect("a row").coverage();
            let pieces = Tooth::beside(&case);
            assert_eq!(pieces.len(), 1, "{slant}");
            let of_piece = pieces[0].coverage(&case).expect("a coverage");
            assert!((of_piece - coverage).abs() < 1e-12, "{slant}: {of_piece} {coverage}");
            peaks.push(pieces[0].peak);
        }
        peaks.dedup();
        assert_eq!(peaks, [0, 1, 2, 3, 4, 5, 6, 7, 8]);
    }

    #[test]
    fn a_peak_belongs_to_both_of_its_sides() {
        let slant = 0.88_f64.atan().to_degrees();
        let sides = Tooth::beside(&case(0.13, 0.31, slant));
        assert_eq!(sides.iter().map(|side| side.peak).collect::<Vec<_>>(), [2, 2]);
        assert_ne!(sides[0].rising, sides[1].rising);
    }
}

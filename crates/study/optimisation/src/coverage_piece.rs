//! Coverage branches: parts of the space in which the coverage is smooth.
//!
//! With the reach `S = tan α`, the pitch `p` and the gap `d`, all divided by `t`, the coverage has
//! a peak at `S = k p` for each integer `k`. The coverage rises before and falls after each peak:
//!
//! ```text
//! λ = 1 − k d/S,   (k − 1) p + d ≤ S ≤ k p;     λ = k (p − d)/S,   k p ≤ S ≤ k p + d     (O8)
//! ```
//!
//! So `λ ≤ 1 − d/p`, with equality only at the peaks. Designs that meet a requirement on coverage
//! are in narrow, separate strips around the peaks, a few per cent of the space wide. A gradient
//! search cannot leave the strip in which it starts.

use results::DesignRow;
use results::columns::name;
use sweep::{Case, Parameter};

use crate::slopes::Slopes;

/// Distance from a border, in `S/p`, within which a point belongs to the branches on both sides.
///
/// The distance exceeds the round-off of a step that ends on the border.
const BORDER: f64 = 1e-7;

/// Names of the columns that have the upper bound `d/p`.
///
/// At rest only the gaps bend, so the compliance is `d/p`. A bent strip is never more compliant.
pub(crate) const COMPLIANCES: [&str; 2] = [name::COMPLIANCE, name::INITIAL_COMPLIANCE];

/// A coverage branch: one side of a coverage peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoveragePiece {
    /// Number `k` of the peak.
    pub peak: u32,
    /// True if the coverage increases with the slant.
    rising: bool,
}

/// Reach, gap and pitch of a row, divided by the thickness of a scale.
#[derive(Clone, Copy)]
struct Lengths {
    reach: f64,
    gap: f64,
    pitch: f64,
}

impl Lengths {
    /// Returns the lengths of a case.
    ///
    /// `None` for an impossible row, and on a curved body, where branches have no closed form.
    fn of(case: &Case) -> Option<Self> {
        let row = case.design.row().ok().filter(|_| case.body().is_flat())?;
        Some(Self { reach: row.scale().shift(), gap: row.gap(), pitch: row.pitch() })
    }

    /// Returns the reach divided by the pitch, `S/p`, which is an integer at each peak.
    fn reach_over_pitch(self) -> f64 {
        self.reach / self.pitch
    }
}

impl CoveragePiece {
    /// Returns the branches that contain a design: one, or two if the design is on a border.
    ///
    /// Empty for an impossible row and on a curved body.
    pub fn beside(case: &Case) -> Vec<Self> {
        let Some(lengths) = Lengths::of(case) else { return Vec::new() };
        let whole = lengths.reach_over_pitch().floor() as u32;
        // A design is between the peaks `whole` and `whole + 1`, so check the branches of both
        // peaks.
        let near = [whole, whole + 1]
            .into_iter()
            .flat_map(|peak| [true, false].map(|rising| Self { peak, rising }));
        near.filter(|piece| piece.borders(lengths).iter().all(|beyond| *beyond <= BORDER)).collect()
    }

    /// Returns the distances in `S/p` beyond the lower and the upper border of the branch.
    ///
    /// Both distances are negative inside the branch.
    fn borders(self, lengths: Lengths) -> [f64; 2] {
        let (reach, open) = (lengths.reach_over_pitch(), lengths.gap / lengths.pitch);
        let peak = f64::from(self.peak);
        let [from, to] = if self.rising { [peak - 1.0 + open, peak] } else { [peak, peak + open] };
        [from - reach, reach - to]
    }

    /// Number of borders of a branch.
    pub const BORDERS: usize = 2;

    /// Returns the distance of a case beyond a border, in `S/p`; negative inside the branch.
    ///
    /// `border` is 0 for the lower and 1 for the upper border.
    pub fn beyond(self, border: usize, case: &Case) -> Option<f64> {
        Lengths::of(case).map(|lengths| self.borders(lengths)[border])
    }

    /// Returns the derivatives of the distance from a border, which is positive inside the branch.
    pub fn border_slopes(self, border: usize, case: &Case, parameter: &Parameter) -> Slopes {
        Slopes::between(parameter.size(case), |by, _| {
            Some(-self.beyond(border, &parameter.moved(case, by)?)?)
        })
    }

    /// Returns the coverage by the formula of this branch (O8), also beyond its borders.
    fn coverage(self, case: &Case) -> Option<f64> {
        let Lengths { reach, gap, pitch } = Lengths::of(case)?;
        let peak = f64::from(self.peak);
        Some(if self.rising { 1.0 - peak * gap / reach } else { peak * (pitch - gap) / reach })
    }

    /// Replaces coverage and its derivatives in `row` by the formula of this branch.
    ///
    /// The coverage is then smooth across the borders of the branch.
    pub fn continue_coverage(self, row: &mut DesignRow) {
        row.result.coverage = self.coverage(&row.case);
        differentiate(row, name::COVERAGE, |case| self.coverage(case));
    }
}

/// Returns the reach over the pitch, `S/p`, which is an integer at each peak.
pub(crate) fn reach_over_pitch(case: &Case) -> Option<f64> {
    Lengths::of(case).map(Lengths::reach_over_pitch)
}

/// Returns the fraction `d/p` of the pitch that the gap occupies.
///
/// `None` for an impossible row.
pub(crate) fn open_share(case: &Case) -> Option<f64> {
    case.design.row().ok().map(|row| row.gap() / row.pitch())
}

/// Replaces the compliance and its derivatives in `row` by `d/p`, the value without contact.
///
/// The compliance is then smooth across the border at which scales begin to touch.
pub(crate) fn continue_compliance(row: &mut DesignRow) {
    if let Some(flexure) = &mut row.result.flexure {
        flexure.measures.compliance = open_share(&row.case);
    }
    differentiate(row, name::COMPLIANCE, open_share);
}

/// Replaces the derivatives of `measure` in `row` by the derivatives of `value`, a smooth function.
fn differentiate(row: &mut DesignRow, measure: &str, value: impl Fn(&Case) -> Option<f64>) {
    let Some(here) = value(&row.case) else { return };
    for of in row.result.sensitivity.iter_mut().filter(|of| of.measure == measure) {
        let Some(parameter) = Parameter::named(of.parameter) else { continue };
        let slopes = Slopes::between(parameter.size(&row.case), |by, _| {
            value(&parameter.moved(&row.case, by)?)
        });
        (of.left, of.right, of.value, of.kink) = (slopes.left, slopes.right, here, None);
    }
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
    fn branches_reproduce_the_coverage() {
        let mut peaks = Vec::new();
        for slant in 1..75 {
            let case = case(0.13, 0.31, f64::from(slant));
            let coverage = case.design.row().expect("a row").coverage();
            let pieces = CoveragePiece::beside(&case);
            assert_eq!(pieces.len(), 1, "{slant}");
            let of_piece = pieces[0].coverage(&case).expect("a coverage");
            assert!((of_piece - coverage).abs() < 1e-12, "{slant}: {of_piece} {coverage}");
            peaks.push(pieces[0].peak);
        }
        peaks.dedup();
        assert_eq!(peaks, [0, 1, 2, 3, 4, 5, 6, 7, 8]);
    }

    #[test]
    fn design_on_a_peak_belongs_to_both_adjacent_branches() {
        let slant = 0.88_f64.atan().to_degrees();
        let sides = CoveragePiece::beside(&case(0.13, 0.31, slant));
        assert_eq!(sides.iter().map(|side| side.peak).collect::<Vec<_>>(), [2, 2]);
        assert_ne!(sides[0].rising, sides[1].rising);
    }
}

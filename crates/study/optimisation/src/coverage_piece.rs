//! Coverage branches: parts of the space in which the coverage is smooth.
//!
//! With the reach `S = tan α`, the pitch `p` and the gap `d`, all over `t`, the coverage rises to
//! each peak `k` and falls beyond it,
//!
//! ```text
//! λ = 1 − k d/S,   (k − 1) p + d ≤ S ≤ k p;     λ = k (p − d)/S,   k p ≤ S ≤ k p + d     (O8)
//! ```
//!
//! so `λ ≤ 1 − d/p`, with equality at the peaks alone. A requirement on coverage splits the space
//! into narrow strips around the peaks, a few per cent apart, and a gradient search stays in the
//! strip where it starts.

use results::DesignRow;
use results::columns::name;
use sweep::{Case, Parameter};

use crate::slopes::Slopes;

/// Tolerance within which a point on a border belongs to both branches.
///
/// It exceeds the round-off of a step that ends on the border.
const BORDER: f64 = 1e-7;

/// Columns with the upper bound `d/p`.
///
/// A bent strip is never less stiff than at rest, where only the gaps bend.
pub(crate) const COMPLIANCES: [&str; 2] = [name::COMPLIANCE, name::INITIAL_COMPLIANCE];

/// A coverage branch: one side of a coverage peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoveragePiece {
    /// Number `k` of the peak.
    pub peak: u32,
    /// True if the coverage increases with the slant.
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
    /// `None` for an impossible row and on a curved body, where branches have no closed form.
    fn of(case: &Case) -> Option<Self> {
        let row = case.design.row().ok().filter(|_| case.body().is_flat())?;
        Some(Self { reach: row.scale().shift(), gap: row.gap(), pitch: row.pitch() })
    }

    /// Returns the reach over the pitch, `S/p`, an integer at the peaks.
    fn reach_over_pitch(self) -> f64 {
        self.reach / self.pitch
    }
}

impl CoveragePiece {
    /// Returns the branches that contain a design: one, or two on a border.
    pub fn beside(case: &Case) -> Vec<Self> {
        let Some(lengths) = Lengths::of(case) else { return Vec::new() };
        let whole = lengths.reach_over_pitch().floor() as u32;
        // Each point lies between two peaks; near a border both branches qualify.
        let near = [whole, whole + 1]
            .into_iter()
            .flat_map(|peak| [true, false].map(|rising| Self { peak, rising }));
        near.filter(|piece| piece.borders(lengths).iter().all(|beyond| *beyond <= BORDER)).collect()
    }

    /// Returns the excess over the two borders; at most 0 inside.
    fn borders(self, lengths: Lengths) -> [f64; 2] {
        let (reach, open) = (lengths.reach_over_pitch(), lengths.gap / lengths.pitch);
        let peak = f64::from(self.peak);
        let [from, to] = if self.rising { [peak - 1.0 + open, peak] } else { [peak, peak + open] };
        [from - reach, reach - to]
    }

    /// Number of borders of a branch.
    pub const BORDERS: usize = 2;

    /// Returns the excess over one border.
    pub fn beyond(self, border: usize, case: &Case) -> Option<f64> {
        Lengths::of(case).map(|lengths| self.borders(lengths)[border])
    }

    /// Returns the derivatives of the distance inside a border.
    pub fn border_slopes(self, border: usize, case: &Case, parameter: &Parameter) -> Slopes {
        Slopes::between(parameter.size(case), |by, _| {
            Some(-self.beyond(border, &parameter.moved(case, by)?)?)
        })
    }

    /// Returns the coverage of this branch, continued beyond its borders (O8).
    fn coverage(self, case: &Case) -> Option<f64> {
        let Lengths { reach, gap, pitch } = Lengths::of(case)?;
        let peak = f64::from(self.peak);
        Some(if self.rising { 1.0 - peak * gap / reach } else { peak * (pitch - gap) / reach })
    }

    /// Continues the coverage of a row and its derivatives beyond the borders.
    pub fn continue_coverage(self, row: &mut DesignRow) {
        row.result.coverage = self.coverage(&row.case);
        differentiate(row, name::COVERAGE, |case| self.coverage(case));
    }
}

/// Returns the reach over the pitch, `S/p`, which is an integer at each peak.
pub(crate) fn reach_over_pitch(case: &Case) -> Option<f64> {
    Lengths::of(case).map(Lengths::reach_over_pitch)
}

/// Returns the fraction `d/p` of the pitch taken by the gap.
///
/// `None` for an impossible row.
pub(crate) fn open_share(case: &Case) -> Option<f64> {
    case.design.row().ok().map(|row| row.gap() / row.pitch())
}

/// Continues the compliance `d/p` of strips without contact beyond contact.
pub(crate) fn continue_compliance(row: &mut DesignRow) {
    if let Some(flexure) = &mut row.result.flexure {
        flexure.measures.compliance = open_share(&row.case);
    }
    differentiate(row, name::COMPLIANCE, open_share);
}

/// Replaces the derivatives of a measure with derivatives of a smooth function.
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
    fn a_peak_belongs_to_both_adjacent_branches() {
        let slant = 0.88_f64.atan().to_degrees();
        let sides = CoveragePiece::beside(&case(0.13, 0.31, slant));
        assert_eq!(sides.iter().map(|side| side.peak).collect::<Vec<_>>(), [2, 2]);
        assert_ne!(sides[0].rising, sides[1].rising);
    }
}

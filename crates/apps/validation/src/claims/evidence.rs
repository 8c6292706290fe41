//! The evidence for the verdicts. It consists of numbers, so that tests can construct it.

use std::collections::BTreeMap;
use std::fmt;

use super::statistics::{DesignParameter, DesignValue};
use super::{digits, named};
use crate::study::MeasuredDesign;

/// Relative difference below which two values count as equal.
///
/// The values of equivalent designs differ by the round-off of their paths.
const EQUAL: f64 = 1e-6;

/// Maximum number of equal designs that are listed.
const LISTED: usize = 3;

/// The evidence for the verdicts on all claims.
#[derive(Clone, Debug, Default)]
pub(crate) struct Evidence {
    /// Every design of the study.
    pub(crate) designs: Vec<MeasuredDesign>,
    /// The punctures of Fig. 6b, sorted by slant, with `L/t = 1` and `d/t = 0.1`.
    pub(crate) by_slant: Vec<PunctureCurve>,
    /// The punctures of Fig. 6d, sorted by length, with `d/t = 0.1` and 45°.
    pub(crate) by_length: Vec<PunctureCurve>,
    /// The punctures of Fig. 6f, sorted by gap, with `L/t = 0.5` and 45°.
    pub(crate) by_gap: Vec<PunctureCurve>,
    /// The rows of Fig. 9 with slants of 0° and 75°, under the same force.
    pub(crate) loaded: Option<[LoadedRow; 2]>,
    /// Stiffness of two blocks just after first contact, divided by the stiffness just before.
    pub(crate) kink: Option<f64>,
    /// The strips of Figs. 10c and 11b, sorted by slant, with `L/t = 1` and `d/t = 0.1`.
    pub(crate) strips: Vec<BentStrip>,
    /// A strip of upright scales with a length of ten thicknesses.
    pub(crate) short_strip: Option<BentStrip>,
    /// The best design for equal weights.
    pub(crate) balanced: Option<Balanced>,
}

/// A puncture up to the end of the curves in Fig. 6.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PunctureCurve {
    pub(crate) design: MeasuredDesign,
    /// `dF*/du*` at rest.
    pub(crate) initial_slope: Option<f64>,
    /// `u*` and `F*` at the first contact.
    pub(crate) contact: Option<[f64; 2]>,
    /// The end of the curve.
    pub(crate) end: Option<CurveEnd>,
    /// Largest angle between the strongest contact force and the horizontal along the curve,
    /// degrees.
    pub(crate) contact_angle_deg: Option<f64>,
}

/// The state at the end of a curve.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CurveEnd {
    /// `u*`.
    pub(crate) displacement: f64,
    /// `F*`.
    pub(crate) force: f64,
    /// Tilt of the punctured scale, degrees.
    pub(crate) tilt_deg: f64,
    /// Depth of the deepest base corner, divided by `t`.
    pub(crate) penetration: f64,
}

impl PunctureCurve {
    /// Returns the mean slope `ΔF*/Δu*` from rest to the first contact.
    pub(crate) fn slope_before_contact(&self) -> Option<f64> {
        let [displacement, force] = self.contact?;
        Some(force / displacement)
    }

    /// Returns the mean slope `ΔF*/Δu*` from the first contact to the end.
    pub(crate) fn slope_after_contact(&self) -> Option<f64> {
        let ([displacement, force], end) = (self.contact?, self.end?);
        Some((end.force - force) / (end.displacement - displacement))
    }
}

/// The state of a row under a given force.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LoadedRow {
    /// `F*`.
    pub(crate) force: f64,
    /// `u*`.
    pub(crate) displacement: f64,
    /// Number of scales that carry at least a twentieth of the force.
    pub(crate) carrying: usize,
    /// Number of scales in contact with a neighbour.
    pub(crate) touching: usize,
}

/// A strip at the end of its bending path.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BentStrip {
    pub(crate) slant: f64,
    /// Largest ratio of axial to bending energy of the membrane before contact.
    pub(crate) axial_before: f64,
    /// Ratio of axial to bending energy of the membrane at the end.
    pub(crate) axial_at_end: f64,
    /// Slope `dM*/dκ*` at the end, divided by the largest slope after contact.
    ///
    /// `None` without contact, or if the path stops early.
    pub(crate) softening: Option<f64>,
}

/// The best design for equal weights.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Balanced {
    /// The best design.
    pub(crate) best: MeasuredDesign,
    /// The fitness of the best design.
    pub(crate) fitness: f64,
    /// Percentage of the weightings for which the design `best` wins.
    pub(crate) share: f64,
    /// Percentage of the weightings for which the optimum printed in the paper wins.
    pub(crate) share_of_printed: f64,
}

impl From<Balanced> for BestDesigns {
    fn from(balanced: Balanced) -> Self {
        Self { designs: vec![balanced.best], value: balanced.fitness }
    }
}

/// The design with the largest value, or several designs with equal values.
#[derive(Clone, Debug)]
pub(crate) struct BestDesigns {
    pub(crate) designs: Vec<MeasuredDesign>,
    pub(crate) value: f64,
}

impl fmt::Display for BestDesigns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut equals: Vec<_> = self.designs.iter().take(LISTED).map(named).collect();
        if self.designs.len() > LISTED {
            equals.push(format!("{} more", self.designs.len() - LISTED));
        }
        let equally = if equals.len() > 1 { " equally" } else { "" };
        write!(f, "{}{equally}, {}", equals.join(" and "), digits(self.value))
    }
}

impl Evidence {
    /// Returns the design with these parameters.
    pub(crate) fn design(&self, gap: f64, length: f64, slant: f64) -> Option<&MeasuredDesign> {
        // Numbers are compared exactly, because tables hold all digits of the grid.
        self.designs.iter().find(|d| (d.gap, d.length, d.slant) == (gap, length, slant))
    }

    /// Returns the designs with the largest value of all designs that have a value.
    pub(crate) fn best(
        &self,
        among: impl Fn(&MeasuredDesign) -> bool,
        value: DesignValue,
    ) -> Option<BestDesigns> {
        let valued =
            || self.designs.iter().filter(|d| among(d)).filter_map(|d| Some((*d, value(d)?)));
        let largest = valued().map(|(_, value)| value).reduce(f64::max)?;
        let equal = valued().filter(|(_, value)| *value >= largest - EQUAL * largest.abs());
        Some(BestDesigns { designs: equal.map(|(design, _)| design).collect(), value: largest })
    }

    /// Returns the values on each line of designs that differ only in the parameter `along`.
    ///
    /// The values of a line are sorted by this parameter. Only designs of the figures are included.
    pub(crate) fn lines(
        &self,
        along: DesignParameter,
        fixed: [DesignParameter; 2],
        value: DesignValue,
    ) -> Vec<Vec<Option<f64>>> {
        let mut lines = BTreeMap::<[u64; 2], Vec<(f64, Option<f64>)>>::new();
        for design in self.designs.iter().filter(|design| design.is_in_figures()) {
            // The bits of positive numbers have the same order as the numbers.
            let key = fixed.map(|parameter| parameter(design).to_bits());
            lines.entry(key).or_default().push((along(design), value(design)));
        }
        let ordered = lines.into_values().map(|mut line| {
            line.sort_by(|a, b| a.0.total_cmp(&b.0));
            line.into_iter().map(|(_, value)| value).collect()
        });
        ordered.collect()
    }
}

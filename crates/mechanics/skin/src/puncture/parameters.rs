//! Parameters of a puncture.

use geometry::{Body, OutOfRange};
use substrate::SubstrateLaw;

use super::number_list::NumberList;

/// Free or guided motion of the needle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Needle {
    /// A dead load at a fixed point of the scale; it moves sideways with this point.
    ///
    /// Shafiei et al. (2021) use this load.
    #[default]
    Free,
    /// A tip guided straight down, with this coefficient of friction.
    Guided {
        /// `μ_n`; 0 for a frictionless needle.
        friction: f64,
    },
}

impl Needle {
    /// Returns true if the tip has a fixed position along the row.
    pub fn is_guided(self) -> bool {
        self != Self::Free
    }

    /// Returns true if the needle is guided and has friction.
    pub fn has_friction(self) -> bool {
        matches!(self, Self::Guided { friction } if friction > 0.0)
    }
}

/// Rigid scales, or elastic scales that bend under the forces on them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bending {
    /// Scales are rigid, as in the paper.
    #[default]
    Rigid,
    /// Scales bend as linear beams with the modulus `E_ct`.
    ///
    /// The path ends where a tip has turned by 5° relative to its base.
    Elastic,
}

/// Number of scales in the row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowLength {
    /// A row without ends.
    ///
    /// The scales that contact has reached, and a few more, are unknowns. Their number grows as
    /// contact spreads along the path. The scales beyond follow in closed form as a linear chain.
    Auto,
    /// A row of this number of scales.
    ///
    /// The middle scale is punctured; of an even number, the left one of the two middle scales.
    Scales(usize),
}

/// Strengths of a skin, in units of `E_s`.
///
/// A failure mode is not judged if the strength that it needs is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strengths {
    /// Strength of the scales in bending; for perforation also their yield stress.
    pub scale: Option<f64>,
    /// Strength of the bond between a scale and the substrate.
    pub bond: Option<f64>,
}

/// Parameters of a puncture besides the design and the stiffness of the substrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunctureParameters {
    /// Poisson's ratio `ν` of the substrate.
    pub poisson_ratio: f64,
    /// Contact modulus of the scales divided by the modulus of the substrate, `E_ct/E_s`.
    pub contact_modulus_over_substrate: f64,
    /// Number of scales in the row.
    pub scales: RowLength,
    /// Load position on the top of the punctured scale: 0 the left, 1 the right corner.
    ///
    /// A round tip may have a position below 0 or above 1, between two scales.
    pub load_position: f64,
    /// Critical tilt `φ_c` of the punctured scale at which the puncture ends, degrees.
    pub critical_tilt_deg: f64,
    /// Constitutive law of the substrate surface between two bases.
    pub substrate_law: SubstrateLaw,
    /// Tilts below `critical_tilt_deg` at which measures are reported as well, degrees.
    ///
    /// If given, measures at `critical_tilt_deg` follow in the same list.
    pub tilts_before_deg: Option<NumberList>,
    /// Free or guided motion of the needle.
    pub needle: Needle,
    /// Tip radius of a guided needle, in units of `t`; `None` for a sharp one.
    pub needle_radius: Option<f64>,
    /// Depth `u*` at which the force is reported as well.
    pub depth: Option<f64>,
    /// Force `F*` at which the pressure on the tissue is reported as well.
    pub force: Option<f64>,
    /// True to remove the load at the end of the path and follow the unloading path.
    pub unload: bool,
    /// Strengths of scales and bonds; `None` if failure is not evaluated.
    pub failure: Option<Strengths>,
    /// Number of load positions to compare, at least two.
    ///
    /// They span the top from its left to its right corner, or one pitch for a round tip.
    pub places: Option<usize>,
    /// Curvature `t/R` of the body below: positive for a convex one, 0 for a flat one.
    pub curvature: f64,
    /// Rigid or elastic scales.
    pub bending: Bending,
}

impl Default for PunctureParameters {
    /// Returns the values of Shafiei et al. (2021).
    ///
    /// The contact modulus is 3 `GPa` on a substrate of 310 kPa.
    fn default() -> Self {
        Self {
            poisson_ratio: 0.5,
            contact_modulus_over_substrate: 9677.0,
            scales: RowLength::Auto,
            load_position: 1.0,
            critical_tilt_deg: 10.0,
            substrate_law: SubstrateLaw::Linear,
            tilts_before_deg: None,
            needle: Needle::Free,
            needle_radius: None,
            depth: None,
            force: None,
            unload: false,
            failure: None,
            places: None,
            curvature: 0.0,
            bending: Bending::Rigid,
        }
    }
}

impl PunctureParameters {
    /// Returns the body below the row.
    pub(crate) fn body(&self) -> Body {
        Body { curvature: self.curvature }
    }

    /// Iterates over the tilts at which measures are reported, degrees; the critical one is last.
    ///
    /// Empty if `tilts_before_deg` is `None`.
    pub fn tilts_deg(&self) -> impl Iterator<Item = f64> {
        let before = self.tilts_before_deg.iter().flat_map(NumberList::as_slice).copied();
        before.chain(self.tilts_before_deg.map(|_| self.critical_tilt_deg))
    }

    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        let scales = match self.scales {
            RowLength::Auto => 1.0,
            RowLength::Scales(scales) => scales as f64,
        };
        let tilt = self.critical_tilt_deg;
        let (ratio, position) = (self.poisson_ratio, self.load_position);
        let depth = self.depth.unwrap_or(1.0);
        let force = self.force.unwrap_or(1.0);
        let radius = self.needle_radius.unwrap_or(0.0);
        let places = self.places.unwrap_or(2) as f64;
        let curvature = self.curvature;
        // Each rule states the valid range, so that NaN violates it.
        let rules = [
            (tilt > 0.0 && tilt < 90.0, "critical tilt", tilt, "an angle between 0° and 90°"),
            ((0.0..=0.5).contains(&ratio), "poisson's ratio", ratio, "a ratio from 0 to 0.5"),
            (position.is_finite(), "load position", position, "a finite number"),
            (depth > 0.0, "depth", depth, "a positive length"),
            (force > 0.0, "force", force, "a positive force"),
            (radius >= 0.0, "needle radius", radius, "a length of at least 0"),
            (
                radius == 0.0 || self.needle.is_guided(),
                "needle radius",
                radius,
                "0 unless the needle is guided",
            ),
            (places >= 2.0, "number of load positions", places, "at least 2"),
            (scales >= 1.0, "number of scales", scales, "at least 1"),
            (curvature.is_finite(), "curvature of the body", curvature, "a finite number"),
        ];
        let mut rules = rules.into_iter();
        rules.try_for_each(|(holds, quantity, value, expected)| {
            OutOfRange::unless(holds, quantity, value, expected)
        })
    }
}

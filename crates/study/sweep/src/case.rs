//! The case of one design: all parameters from which the design is solved.

use geometry::{Body, OutOfRange};
use skin::flexure;
use skin::puncture::{self, Needle, PunctureParameters, Strengths};
use skin::{Base, Common, Design, Imperfection, PathDetail};
use substrate::{Bases, Coupling, Footprint};

use crate::material::Material;
use crate::scalar::Scalar;

/// All parameters from which one design is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Geometry of the row: gap, length, slant, base and width.
    pub design: Design,
    /// Contact law and solver settings, shared by puncture and bending.
    pub common: Common,
    /// Parameters of the puncture.
    pub puncture: puncture::PunctureParameters,
    /// Coefficient of friction between needle and scale: a number or a list of numbers.
    ///
    /// The critical tilts of a free needle are the arctangents of these numbers. `None`: not given.
    pub needle_friction: Option<Scalar>,
    /// Distance of the load from the top right corner, inward, divided by the thickness.
    ///
    /// `None` if `puncture.load_position` gives the position of the load.
    pub load_inset: Option<f64>,
    /// Strengths over the modulus of the substrate.
    pub strengths: Strengths,
    /// Whether to find the first failure even if no strength is given.
    pub judge_failure: bool,
    /// Force of the needle, over `E_s t²`, at which the pressure on the tissue is measured.
    pub needle_force: Option<f64>,
    /// Force of the needle in N, if the definition gives it in N.
    pub needle_force_n: Option<f64>,
    /// Whether the row across (perpendicular to this row) is also solved.
    pub across: bool,
    /// Gap of the row across, divided by the thickness. `None`: equal to the gap of this row.
    pub gap_across: Option<f64>,
    /// Parameters of bending.
    pub flexure: flexure::FlexureParameters,
    /// Thickness of the substrate divided by the scale thickness. `None` for a half-space.
    pub tissue_thickness: Option<f64>,
    /// Radius of the body below the skin, divided by the scale thickness.
    ///
    /// Negative for a concave body. `None` if `puncture.curvature` gives the curvature.
    pub body_radius: Option<f64>,
    /// Radius of the last body of a range of bodies, divided by the scale thickness.
    ///
    /// The range starts at the body of this case. `None`: the range contains only this body.
    pub body_radius_to: Option<f64>,
    /// Neighbours that the substrate couples to a scale: the nearest, or all relevant ones.
    pub coupling: Coupling,
    /// Random scatter of the gaps and slants of imperfect rows.
    pub imperfection: Imperfection,
    /// Number and seed of the imperfect rows, which are solved if gaps or slants scatter.
    pub samples: Samples,
    /// Thickness, moduli, strengths and density in physical units; each is optional.
    pub material: Material,
    /// Lengths given in mm, from which the ratios of these lengths to the thickness follow.
    pub in_mm: Millimetres,
}

/// Lengths that a definition gives in mm; `None` if a length is not given in mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Millimetres {
    /// Gap between neighbouring bases.
    pub gap: Option<f64>,
    /// Length of a scale.
    pub length: Option<f64>,
    /// Pitch: base plus gap.
    pub pitch: Option<f64>,
    /// Whether the pitch determines the length of a scale (true) or the gap (false).
    pub pitch_determines_length: bool,
    /// Out-of-plane width of the scales.
    pub width: Option<f64>,
    /// Thickness of the substrate.
    pub tissue_thickness: Option<f64>,
    /// Distance of the load from the right corner of the top.
    pub load_inset: Option<f64>,
    /// Gap between neighbouring scales across the row.
    pub gap_across: Option<f64>,
    /// Radius of the tip of a guided needle.
    pub needle_radius: Option<f64>,
    /// Radius of the body below the skin.
    pub radius: Option<f64>,
    /// Radius of the last body of a range of bodies.
    pub radius_to: Option<f64>,
    /// Depth of the punctured point at which `force_at_depth` is measured.
    pub depth: Option<f64>,
    /// Length of the membrane.
    pub membrane_length: Option<f64>,
    /// Thickness of the membrane.
    pub membrane_thickness: Option<f64>,
    /// Depth of the axis of the membrane below the bases.
    pub membrane_axis_offset: Option<f64>,
}

/// Number of imperfect rows to solve, and seed of their random gaps and slants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Samples {
    /// Number of rows.
    pub count: usize,
    /// Seed of the random gaps and slants.
    pub seed: usize,
}

/// Maximum inset of the load in the row across, divided by the length of the top of a scale.
const MAX_INSET: f64 = 0.5 - 1e-8;

impl Case {
    /// Returns the parameters of the puncture for the solver.
    ///
    /// Lengths are divided by the thickness.
    ///
    /// The needle friction is the friction of a guided needle; for a free needle its arctangents
    /// are the critical tilts. An inset of more than half the top places the load at the middle of
    /// the top. A load position on the next scale is moved back to the left corner of that scale.
    pub fn punctured(&self) -> puncture::PunctureParameters {
        // Limit the position here, not in the case, because the limit depends on gap and length,
        // which may be axes.
        let top = 2.0 * self.design.half_base();
        let position = self.puncture.load_position.min(1.0 + self.design.gap / top);
        let load_position = self.load_inset.map_or(position, |inset| (1.0 - inset / top).max(0.5));
        let seeks_failure = self.judge_failure
            || self.needle_force.is_some()
            || self.strengths != Strengths::default();
        let failure = seeks_failure.then_some(self.strengths);
        let curvature = self.body().curvature;
        // `F*` is in units of `E_s/(1 − ν²) L t`.
        let plane_strain = 1.0 - self.puncture.poisson_ratio.powi(2);
        let force = self.needle_force.map(|force| force * plane_strain / self.design.length);
        let mut punctured =
            PunctureParameters { load_position, failure, curvature, force, ..self.puncture };
        match (self.needle_friction, &mut punctured.needle) {
            (Some(Scalar::Number(given)), Needle::Guided { friction }) => *friction = given,
            (Some(given), Needle::Free) => {
                set_tilts(&mut punctured, given, |friction| friction.atan().to_degrees());
            }
            _ => {}
        }
        punctured
    }

    /// Returns the body below the skin. Lengths are divided by the thickness.
    pub fn body(&self) -> Body {
        Body { curvature: self.body_radius.map_or(self.puncture.curvature, f64::recip) }
    }

    /// Returns this case with `detail` as the amount of data recorded along its paths.
    #[must_use]
    pub fn with_detail(&self, detail: PathDetail) -> Self {
        Self { common: Common { detail, ..self.common }, ..*self }
    }

    /// Returns this case on a body of its range of radii; `None` if the case has no such range.
    ///
    /// The curvature is linear in `fraction`: 0 is the body of this case, 1 the body of radius
    /// `body_radius_to`. The returned case requests only the critical force.
    pub fn on_body_between(&self, fraction: f64) -> Option<Self> {
        let [from, to] = [self.body().curvature, self.body_radius_to?.recip()];
        Some(self.for_critical_force(from + fraction * (to - from)))
    }

    /// Returns this case on a body with the given curvature, requesting only the critical force.
    ///
    /// Lengths in mm are removed, because they describe the row and the body of this case.
    fn for_critical_force(&self, curvature: f64) -> Self {
        let puncture = PunctureParameters {
            curvature,
            tilts_before_deg: None,
            depth: None,
            force: None,
            places: None,
            unload: false,
            ..self.puncture
        };
        Self {
            puncture,
            strengths: Strengths::default(),
            judge_failure: false,
            needle_force: None,
            needle_force_n: None,
            across: false,
            gap_across: None,
            body_radius: None,
            body_radius_to: None,
            imperfection: Imperfection::default(),
            in_mm: Millimetres::default(),
            ..*self
        }
    }

    /// Returns the pitch of the row, base plus gap, divided by the thickness.
    pub fn pitch(&self) -> f64 {
        2.0 * self.design.half_base() + self.design.gap
    }

    /// Returns the coverage of the row on its body.
    ///
    /// # Errors
    ///
    /// If a length of the design is not positive, or its slant is out of range.
    pub fn coverage(&self) -> Result<f64, OutOfRange> {
        let (row, body) = (self.design.row()?, self.body());
        Ok(if body.is_flat() { row.coverage() } else { row.coverage_on(body) })
    }

    /// Returns the case of the row across (perpendicular to this row), if it is requested.
    ///
    /// The scales of the row across are upright blocks, with base and width of this row exchanged.
    /// Needle, tissue and friction are unchanged. The load keeps its distance from the nearest
    /// edge; a needle between two scales is placed on the edge. The row across ignores the slant of
    /// this row and the tilts along this row, and its body is flat.
    pub fn across(&self) -> Option<Self> {
        if !self.across && self.gap_across.is_none() {
            return None;
        }
        let design = Design {
            gap: self.gap_across.unwrap_or(self.design.gap),
            length: self.design.width,
            slant_deg: 0.0,
            base: Base::L,
            width: 2.0 * self.design.half_base(),
        };
        let position = self.puncture.load_position;
        let from_corner = position.min(1.0 - position).max(0.0) * design.width;
        let inset = self.load_inset.unwrap_or(from_corner);
        // Keep the load off the exact middle of the scale: a load at the middle does not tilt the
        // scale, and this equilibrium is unstable.
        let load_inset = Some(inset.min(MAX_INSET * design.length));
        Some(Self { design, load_inset, ..self.for_critical_force(0.0) })
    }

    /// Returns the factor that converts `F*` of the row across to `F*` of this row.
    ///
    /// `F*` is a force divided by the length of a scale. A scale of the row across has the width of
    /// this row as its length.
    pub fn across_factor(&self) -> f64 {
        self.design.width / self.design.length
    }

    /// Returns true if the load position is valid for the needle.
    ///
    /// Only a needle with a round tip may be between two scales, at a position above 1.
    pub fn has_valid_load_position(&self) -> bool {
        self.puncture.load_position <= 1.0 || self.puncture.needle_radius.is_some()
    }

    /// Returns the dimensions of bases and substrate, which determine the springs.
    ///
    /// Lengths are divided by the thickness.
    pub fn bases(&self) -> Bases {
        Bases {
            half_width: self.design.half_base(),
            gap: self.design.gap,
            width: self.design.width,
            poisson_ratio: self.puncture.poisson_ratio,
            thickness: self.tissue_thickness,
        }
    }

    /// Returns the footprint of the bases.
    ///
    /// # Errors
    ///
    /// If the ratio of two lengths of the design exceeds the range of `f64`, or the substrate is
    /// too thin for its springs.
    pub fn footprint(&self) -> Result<Footprint, OutOfRange> {
        self.bases().footprint()
    }
}

/// Sets the tilts at which a puncture is measured, from a number or an ascending list.
///
/// `tilt` converts each number to a tilt in degrees. The last tilt is the critical tilt, which ends
/// the puncture; the puncture is also measured at the earlier tilts.
pub(crate) fn set_tilts(
    puncture: &mut puncture::PunctureParameters,
    given: Scalar,
    tilt: fn(f64) -> f64,
) {
    let tilts = match given {
        Scalar::Number(number) => Some((tilt(number), None)),
        // `tilt` is an increasing function, so the list stays ascending.
        Scalar::List(numbers) => {
            numbers.map(tilt).split_last().map(|(last, others)| (last, Some(others)))
        }
        Scalar::Count(_) | Scalar::Word(_) => None,
    };
    if let Some((last, before)) = tilts {
        (puncture.critical_tilt_deg, puncture.tilts_before_deg) = (last, before);
    }
}

impl Default for Case {
    /// Returns the first design of the paper sweep.
    fn default() -> Self {
        Self {
            design: Design { gap: 0.1, length: 0.025, slant_deg: 0.0, base: Base::L, width: 1.0 },
            common: Common::default(),
            puncture: puncture::PunctureParameters::default(),
            needle_friction: None,
            load_inset: None,
            strengths: Strengths::default(),
            judge_failure: false,
            needle_force: None,
            needle_force_n: None,
            across: false,
            gap_across: None,
            flexure: flexure::FlexureParameters::default(),
            tissue_thickness: None,
            body_radius: None,
            body_radius_to: None,
            coupling: Coupling::Nearest,
            imperfection: Imperfection::default(),
            samples: Samples { count: 100, seed: 1 },
            material: Material::default(),
            in_mm: Millimetres::default(),
        }
    }
}

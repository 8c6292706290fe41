//! The case of one design: everything that it is solved with.

use geometry::OutOfRange;
use skin::flexure;
use skin::puncture::{self, Needle};
use skin::{Base, Common, Design, Imperfection};
use substrate::{Bases, Coupling, Footprint};

use crate::material::Material;
use crate::parameter::Scalar;

/// One design with everything that it is solved with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// The geometry.
    pub design: Design,
    /// The contact law and the solver's settings, of puncture and bending.
    pub common: Common,
    /// The other parameters of the puncture.
    pub puncture: puncture::PunctureParameters,
    /// The friction between needle and scale: of a free needle the critical tilts follow from it, instead of those of the puncture.
    pub needle_friction: Option<Scalar>,
    /// How far inside the top right corner the load stands, unless its place is given as a part of the top.
    pub load_inset: Option<f64>,
    /// The other parameters of bending.
    pub flexure: flexure::FlexureParameters,
    /// The thickness of the substrate, over that of the scales; `None` of a half-space.
    pub tissue_thickness: Option<f64>,
    /// The neighbours of a scale that the substrate couples it with.
    pub coupling: Coupling,
    /// The scatter of gaps and slants.
    pub imperfection: Imperfection,
    /// The imperfect rows that are solved if they scatter at all.
    pub samples: Samples,
    /// The material of the skin, in physical units, as far as that is given.
    pub material: Material,
    /// The lengths that are given in mm: those over the thickness follow from them.
    pub in_mm: Millimetres,
}

/// The lengths that are given in mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Millimetres {
    /// The gap between neighbouring bases.
    pub gap: Option<f64>,
    /// The length of a scale.
    pub length: Option<f64>,
    /// Base and gap together.
    pub pitch: Option<f64>,
    /// Whether the pitch says how long a scale is, rather than how wide its gap.
    pub pitch_says_length: bool,
    /// The width of the scales.
    pub width: Option<f64>,
    /// The thickness of the substrate.
    pub tissue_thickness: Option<f64>,
    /// The distance of the load from the right corner of the top.
    pub load_inset: Option<f64>,
    /// The radius of the tip of a guided needle.
    pub needle_radius: Option<f64>,
    /// The depth at which the force is measured besides.
    pub depth: Option<f64>,
    /// The length of the membrane.
    pub membrane_length: Option<f64>,
    /// The thickness of the membrane.
    pub membrane_thickness: Option<f64>,
    /// The depth of the axis of the membrane below the bases.
    pub membrane_axis_offset: Option<f64>,
}

/// The imperfect rows that are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Samples {
    /// The number of rows.
    pub count: usize,
    /// Seed of their random numbers.
    pub seed: usize,
}

impl Case {
    /// The parameters of the puncture as it is solved, lengths over the thickness, with what friction says of needle and tilts. A load that would stand beyond the middle of a narrow top stands in it,
    /// and one that would stand on the next scale on its left corner.
    pub fn punctured(&self) -> puncture::PunctureParameters {
        // Only here, for the case keeps what was asked: along axes of gap and length the place
        // moves.
        let top = 2.0 * self.design.half_base();
        let inside = |inset: f64| (1.0 - inset / top).max(0.5);
        let position = self.puncture.load_position.min(1.0 + self.design.gap / top);
        let load_position = self.load_inset.map_or(position, inside);
        let mut punctured = puncture::PunctureParameters { load_position, ..self.puncture };
        match (self.needle_friction, &mut punctured.needle) {
            (Some(Scalar::Number(given)), Needle::Guided { friction }) => *friction = given,
            (Some(given), Needle::Free) => {
                set_tilts(&mut punctured, given, |friction| friction.atan().to_degrees());
            }
            _ => {}
        }
        punctured
    }

    /// Whether the load stands on a top, or with a round tip that may stand between two.
    pub fn load_can_stand(&self) -> bool {
        self.puncture.load_position <= 1.0 || self.puncture.needle_radius.is_some()
    }

    /// The bases and the substrate, on which the springs depend, with lengths over the thickness.
    pub fn bases(&self) -> Bases {
        Bases {
            half_width: self.design.half_base(),
            gap: self.design.gap,
            width: self.design.width,
            poisson_ratio: self.puncture.poisson_ratio,
            thickness: self.tissue_thickness,
        }
    }

    /// The footprint of the bases.
    ///
    /// # Errors
    /// If the lengths of the design are too far apart for their ratios to be an `f64`, or the substrate is too thin for its springs.
    pub fn footprint(&self) -> Result<Footprint, OutOfRange> {
        self.bases().footprint()
    }
}

/// Gives a puncture the tilts that are made of a number, or of a list, whose last one is critical and the others on its way.
pub(crate) fn set_tilts(
    puncture: &mut puncture::PunctureParameters,
    given: Scalar,
    tilt: fn(f64) -> f64,
) {
    let tilts = match given {
        Scalar::Number(number) => Some((tilt(number), None)),
        // A rising function keeps the order of a list.
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
    /// The first design of the paper sweep.
    fn default() -> Self {
        Self {
            design: Design { gap: 0.1, length: 0.025, slant_deg: 0.0, base: Base::L, width: 1.0 },
            common: Common::default(),
            puncture: puncture::PunctureParameters::default(),
            needle_friction: None,
            load_inset: None,
            flexure: flexure::FlexureParameters::default(),
            tissue_thickness: None,
            coupling: Coupling::Nearest,
            imperfection: Imperfection::default(),
            samples: Samples { count: 100, seed: 1 },
            material: Material::default(),
            in_mm: Millimetres::default(),
        }
    }
}

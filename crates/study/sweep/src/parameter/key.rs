//! The keys of the parameters that code names.

/// The gap between neighbouring bases.
pub const GAP: &str = "gap_over_t";

/// The length of a scale.
pub const LENGTH: &str = "length_over_t";

/// The distance from scale to scale, in mm.
pub const PITCH: &str = "pitch_mm";

/// The slant of the scales.
pub const SLANT: &str = "slant_deg";

/// The radius of the tip of a needle.
pub const NEEDLE_RADIUS: &str = "needle_radius_over_t";
/// The width of the scales.
pub const WIDTH: &str = "width_over_t";

/// Poisson's ratio of the substrate.
pub const POISSON_RATIO: &str = "poisson_ratio";

/// The tilt at which a puncture ends.
pub const CRITICAL_TILT: &str = "critical_tilt_deg";

/// The place of the load, as a part of the top.
pub const LOAD_POSITION: &str = "load_position";

/// The distance of the load from the right corner of the top.
pub const LOAD_INSET: &str = "load_inset_over_t";

/// How the needle is held.
pub const NEEDLE: &str = "needle";

/// Whether the load is taken away at the end of a puncture.
pub const UNLOAD: &str = "unload";

/// Whether the moment is taken away at the end of bending.
pub const UNBEND: &str = "unbend";

/// The friction between needle and scale.
pub const NEEDLE_FRICTION: &str = "needle_friction";

/// The coefficient of friction between two scales.
pub const FRICTION: &str = "friction";

/// The depth at which the force is measured besides.
pub const DEPTH: &str = "depth_over_t";
/// The same in mm.
pub const DEPTH_MM: &str = "depth_mm";

/// The places of the load that are tried.
pub const PLACES: &str = "places";

/// The thickness of the tissue.
pub const TISSUE: &str = "tissue_thickness_over_t";

/// The length of the membrane.
pub const MEMBRANE_LENGTH: &str = "membrane_length_over_t";

/// The thickness of the membrane.
pub const MEMBRANE_THICKNESS: &str = "membrane_thickness_over_t";

/// The depth of the axis of the membrane below the bases of the scales.
pub const MEMBRANE_AXIS: &str = "membrane_axis_offset_over_t";

/// The thickness of the scales.
pub const THICKNESS: &str = "thickness_mm";

/// The modulus of the substrate.
pub const SUBSTRATE_MODULUS: &str = "substrate_modulus_MPa";

/// The modulus of the scales.
pub const SCALE_MODULUS: &str = "scale_modulus_MPa";

/// The modulus of the scales in contact over that of the substrate.
pub const CONTACT_OVER_SUBSTRATE: &str = "contact_modulus_over_substrate";

/// The modulus of the scales in contact over that of the membrane.
pub const CONTACT_OVER_MEMBRANE: &str = "contact_modulus_over_membrane";

/// The modulus of the membrane.
pub const MEMBRANE_MODULUS: &str = "membrane_modulus_MPa";

/// The density of the scales.
pub const DENSITY: &str = "scale_density_kg_m3";

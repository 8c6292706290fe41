//! Keys of the parameters that code refers to.

/// Gap between neighbouring bases.
pub const GAP: &str = "gap_over_t";

/// Length of a scale.
pub const LENGTH: &str = "length_over_t";

/// Distance from scale to scale, in mm.
pub const PITCH: &str = "pitch_mm";

/// Slant of the scales.
pub const SLANT: &str = "slant_deg";

/// Radius of the needle tip.
pub const NEEDLE_RADIUS: &str = "needle_radius_over_t";

/// Curvature of the body.
pub const CURVATURE: &str = "curvature_times_t";

/// Radius of the body.
pub const RADIUS: &str = "radius_over_t";

/// Radius of the body in mm.
pub const RADIUS_MM: &str = "radius_mm";

/// Other end of the range of radii.
pub const RADIUS_TO: &str = "radius_to_over_t";

/// Other end of the range of radii in mm.
pub const RADIUS_TO_MM: &str = "radius_to_mm";

/// Width of the scales.
pub const WIDTH: &str = "width_over_t";

/// Rigid or elastic scales.
pub const BENDING: &str = "bending";

/// Poisson's ratio of the substrate.
pub const POISSON_RATIO: &str = "poisson_ratio";

/// Tilt at which a puncture ends.
pub const CRITICAL_TILT: &str = "critical_tilt_deg";

/// Load position, as a fraction of the top.
pub const LOAD_POSITION: &str = "load_position";

/// Distance of the load from the right corner of the top.
pub const LOAD_INSET: &str = "load_inset_over_t";

/// Kind of needle: free or guided.
pub const NEEDLE: &str = "needle";

/// Whether the load is removed at the end of a puncture.
pub const UNLOAD: &str = "unload";

/// Whether the moment is removed at the end of bending.
pub const UNBEND: &str = "unbend";

/// Friction between needle and scale.
pub const NEEDLE_FRICTION: &str = "needle_friction";

/// Coefficient of friction between two scales.
pub const FRICTION: &str = "friction";

/// Additional depth at which the force is measured.
pub const DEPTH: &str = "depth_over_t";
/// Additional depth at which the force is measured, in mm.
pub const DEPTH_MM: &str = "depth_mm";

/// Force of the needle at which the pressure on the tissue is measured.
pub const NEEDLE_FORCE: &str = "force_over_substrate";

/// Force of the needle at which the pressure on the tissue is measured, in N.
pub const NEEDLE_FORCE_N: &str = "force_N";

/// Number of load positions that are evaluated.
pub const PLACES: &str = "places";

/// Thickness of the tissue.
pub const TISSUE: &str = "tissue_thickness_over_t";

/// Thickness of the tissue in mm.
pub const TISSUE_MM: &str = "tissue_thickness_mm";

/// Length of the membrane.
pub const MEMBRANE_LENGTH: &str = "membrane_length_over_t";

/// Thickness of the membrane.
pub const MEMBRANE_THICKNESS: &str = "membrane_thickness_over_t";

/// Depth of the axis of the membrane below the bases.
pub const MEMBRANE_AXIS: &str = "membrane_axis_offset_over_t";

/// Thickness of the scales.
pub const THICKNESS: &str = "thickness_mm";

/// Modulus of the substrate.
pub const SUBSTRATE_MODULUS: &str = "substrate_modulus_MPa";

/// Modulus of the scales.
pub const SCALE_MODULUS: &str = "scale_modulus_MPa";

/// Modulus of the scales in contact over the modulus of the substrate.
pub const CONTACT_OVER_SUBSTRATE: &str = "contact_modulus_over_substrate";

/// Modulus of the scales in contact over the modulus of the membrane.
pub const CONTACT_OVER_MEMBRANE: &str = "contact_modulus_over_membrane";

/// Whether to find the first failure even if no strength is given.
pub const FAILURE: &str = "failure";

/// Strength of the scales over the modulus of the substrate.
pub const SCALE_STRENGTH_OVER_SUBSTRATE: &str = "scale_strength_over_substrate";

/// Strength of the bonds over the modulus of the substrate.
pub const BOND_STRENGTH_OVER_SUBSTRATE: &str = "bond_strength_over_substrate";

/// Strength of the scales.
pub const SCALE_STRENGTH: &str = "scale_strength_MPa";

/// Strength of the bonds.
pub const BOND_STRENGTH: &str = "bond_strength_MPa";

/// Whether the row across is solved with the gap of the row along.
pub const ACROSS: &str = "across";

/// Gap between neighbouring scales across the row.
pub const GAP_ACROSS: &str = "gap_across_over_t";
/// Gap between neighbouring scales across the row, in mm.
pub const GAP_ACROSS_MM: &str = "gap_across_mm";

/// Modulus of the membrane.
pub const MEMBRANE_MODULUS: &str = "membrane_modulus_MPa";

/// Density of the scales.
pub const DENSITY: &str = "scale_density_kg_m3";

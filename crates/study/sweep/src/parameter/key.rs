//! Keys of the parameters that code refers to. The text at each key describes its parameter.
//!
//! Moduli and strengths are in `MPa`. Lengths are divided by the thickness of the scales unless
//! their keys end in `_mm`.

/// Gap between neighbouring bases.
pub const GAP: &str = "gap_over_t";

/// Length of a scale.
pub const LENGTH: &str = "length_over_t";

/// Pitch of the row, base plus gap, in mm.
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

/// Radius of the last body of a range of bodies.
pub const RADIUS_TO: &str = "radius_to_over_t";

/// Radius of the last body of a range of bodies, in mm.
pub const RADIUS_TO_MM: &str = "radius_to_mm";

/// Out-of-plane width of the scales.
pub const WIDTH: &str = "width_over_t";

/// Rigid or elastic scales.
pub const BENDING: &str = "bending";

/// Poisson's ratio of the substrate.
pub const POISSON_RATIO: &str = "poisson_ratio";

/// Tilt at which a puncture ends.
pub const CRITICAL_TILT: &str = "critical_tilt_deg";

/// Load position on the top of a scale, from 0 (left corner) to 1 (right corner).
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

/// Depth of the punctured point at which `force_at_depth` is measured.
pub const DEPTH: &str = "depth_over_t";
/// Depth of the punctured point at which `force_at_depth` is measured, in mm.
pub const DEPTH_MM: &str = "depth_mm";

/// Force of the needle at which the pressure on the tissue is measured, divided by `E_s t²`.
pub const NEEDLE_FORCE: &str = "force_over_substrate";

/// Force of the needle at which the pressure on the tissue is measured, in N.
pub const NEEDLE_FORCE_N: &str = "force_N";

/// Number of load positions that are evaluated.
pub const PLACES: &str = "places";

/// Thickness of the substrate (tissue).
pub const TISSUE: &str = "tissue_thickness_over_t";

/// Thickness of the substrate (tissue) in mm.
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

/// Modulus of the scales in contact divided by the modulus of the substrate.
pub const CONTACT_OVER_SUBSTRATE: &str = "contact_modulus_over_substrate";

/// Modulus of the scales in contact divided by the modulus of the membrane.
pub const CONTACT_OVER_MEMBRANE: &str = "contact_modulus_over_membrane";

/// Whether to find the first failure even if no strength is given.
pub const FAILURE: &str = "failure";

/// Strength of the scales divided by the modulus of the substrate.
pub const SCALE_STRENGTH_OVER_SUBSTRATE: &str = "scale_strength_over_substrate";

/// Strength of the bonds divided by the modulus of the substrate.
pub const BOND_STRENGTH_OVER_SUBSTRATE: &str = "bond_strength_over_substrate";

/// Strength of the scales.
pub const SCALE_STRENGTH: &str = "scale_strength_MPa";

/// Strength of the bonds.
pub const BOND_STRENGTH: &str = "bond_strength_MPa";

/// Whether the row across, perpendicular to the row along, is also solved.
pub const ACROSS: &str = "across";

/// Gap between neighbouring scales of the row across.
pub const GAP_ACROSS: &str = "gap_across_over_t";
/// Gap between neighbouring scales of the row across, in mm.
pub const GAP_ACROSS_MM: &str = "gap_across_mm";

/// Modulus of the membrane.
pub const MEMBRANE_MODULUS: &str = "membrane_modulus_MPa";

/// Density of the scales.
pub const DENSITY: &str = "scale_density_kg_m3";

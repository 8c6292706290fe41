//! The material of a skin, in physical units.

/// Thickness, moduli, strengths and density of a skin; `None` if a value is not given.
///
/// The solvers use only dimensionless ratios, so every value is optional.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Material {
    /// Thickness `t` of the scales, mm.
    pub thickness_mm: Option<f64>,
    /// Modulus `E_s` of the substrate, in `MPa`.
    pub substrate_modulus_mpa: Option<f64>,
    /// Modulus `E_m` of the membrane, in `MPa`.
    pub membrane_modulus_mpa: Option<f64>,
    /// Modulus `E_ct` of the scales in contact, in `MPa`.
    ///
    /// The contact ratios `E_ct/E_s` and `E_ct/E_m` follow from this modulus.
    pub scale_modulus_mpa: Option<f64>,
    /// Bending strength of the scales, in `MPa`.
    pub scale_strength_mpa: Option<f64>,
    /// Strength of the bonds between scales and substrate, in `MPa`.
    pub bond_strength_mpa: Option<f64>,
    /// Density `ρ` of the scales, kg/m³.
    pub scale_density_kg_m3: Option<f64>,
}

//! Conversion of dimensionless values to millimetres, newtons and kilograms.

use skin::Design;
use sweep::{Case, Sweep, key};

/// The kind of a dimensionless value. It defines the conversion to physical units.
///
/// The equations are (U1)–(U7) and (U9) of `docs/theory/model.md`, with the thickness `t`, the
/// moduli `E_s` and `E_m`, the width `b`, and `I_m = b h³/12` of the membrane:
///
/// ```text
/// length           u  = u* t                                                           (U1)
/// force            F  = F* E_s/(1 − ν²) (L/t) t²                                       (U2)
/// force per width  F/b                                                                 (U3)
/// stiffness        K  = K* E_s t                                                       (U4)
/// moment           M  = M* E_m I_m/t                                                   (U5)
/// rigidity         E_m I_m/C_f*                                                        (U6)
/// bend radius      R  = t/κ*                                                           (U7)
/// stress           σ  = σ* E_s                                                         (U9)
/// ```
///
/// Lengths are in mm and moduli in `MPa`, so forces are in N.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Length, in units of `t`.
    Length,
    /// Puncture force.
    Force,
    /// Puncture force per width of the scales.
    ForcePerWidth,
    /// Puncture stiffness.
    Stiffness,
    /// Bending moment.
    Moment,
    /// Flexural rigidity, from a compliance.
    Rigidity,
    /// Bend radius, from a curvature.
    Radius,
    /// Stress of a scale or a bond.
    Stress,
    /// Pressure on the tissue.
    Pressure,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 9] = [
        Self::Length,
        Self::Force,
        Self::ForcePerWidth,
        Self::Stiffness,
        Self::Moment,
        Self::Rigidity,
        Self::Radius,
        Self::Stress,
        Self::Pressure,
    ];

    /// Returns the physical unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Length | Self::Radius => "mm",
            Self::Force => "N",
            Self::ForcePerWidth | Self::Stiffness => "N/mm",
            Self::Moment => "N mm",
            Self::Rigidity => "N mm^2",
            Self::Stress => "MPa",
            Self::Pressure => "kPa",
        }
    }

    /// Returns the unit as a suffix of column names.
    pub(crate) fn suffix(self) -> &'static str {
        match self {
            Self::Length | Self::Radius => "mm",
            Self::Force => "N",
            // Column names contain neither `/` nor spaces, so N/mm and N mm have the same suffix.
            // The unit of the column distinguishes them.
            Self::ForcePerWidth | Self::Stiffness | Self::Moment => "N_mm",
            Self::Rigidity => "N_mm2",
            Self::Stress => "MPa",
            Self::Pressure => "kPa",
        }
    }

    /// Returns true if the quantity is the inverse of the dimensionless value.
    pub(crate) fn is_inverse(self) -> bool {
        matches!(self, Self::Rigidity | Self::Radius)
    }

    /// Returns the keys of the material parameters that the conversion needs.
    pub fn needs(self) -> &'static [&'static str] {
        match self {
            Self::Length | Self::Radius => &[key::THICKNESS],
            Self::Force | Self::ForcePerWidth | Self::Stiffness => {
                &[key::THICKNESS, key::SUBSTRATE_MODULUS]
            }
            Self::Moment | Self::Rigidity => &[key::THICKNESS, key::MEMBRANE_MODULUS],
            Self::Stress | Self::Pressure => &[key::SUBSTRATE_MODULUS],
        }
    }

    /// Returns true if a sweep gives all material parameters that the conversion needs.
    pub(crate) fn is_given(self, sweep: &Sweep) -> bool {
        self.needs().iter().all(|key| sweep.gives(key))
    }

    /// Converts the dimensionless `value` of a case to the physical unit.
    ///
    /// `None` if the material lacks a required value, or if the result is the inverse of 0.
    ///
    /// ```
    /// use results::Quantity;
    /// use sweep::Sweep;
    ///
    /// let text = "name = 'x'\nmaterial.thickness_mm = 1\nmaterial.substrate_modulus_MPa = 0.31\n\
    ///             designs.gap_over_t = 0.1\ndesigns.length_over_t = 0.1\ndesigns.slant_deg = 75";
    /// let case = Sweep::parse(text, "x.toml", &[])?.grid().case(0);
    /// // 22.4 · 0.31 MPa/(1 − 0.5²) · 0.1 · (1 mm)²
    /// let force = Quantity::Force.physical(22.4, &case).expect("a force");
    /// assert!((force - 0.925_866_666_666_666_6).abs() < 1e-12);
    /// assert_eq!(Quantity::Rigidity.physical(0.5, &case), None);
    /// # Ok::<(), sweep::InvalidDefinition>(())
    /// ```
    pub fn physical(self, value: f64, case: &Case) -> Option<f64> {
        let material = &case.material;
        if let Self::Stress | Self::Pressure = self {
            let stress = value * material.substrate_modulus_mpa?;
            // 1 MPa is 1000 kPa.
            return Some(if self == Self::Stress { stress } else { 1e3 * stress });
        }
        let thickness = material.thickness_mm?;
        let physical = match self {
            Self::Length => value * thickness,
            Self::Force => value * force_unit(case)?,
            Self::ForcePerWidth => value * force_unit(case)? / (case.design.width * thickness),
            Self::Stiffness => value * material.substrate_modulus_mpa? * thickness,
            Self::Moment => value * bending_stiffness(case)? / thickness,
            Self::Rigidity => bending_stiffness(case)? / value,
            Self::Radius => thickness / value,
            Self::Stress | Self::Pressure => return None,
        };
        physical.is_finite().then_some(physical)
    }
}

/// Returns the units of displacement, force and energy of a puncture, in mm, N and mJ.
///
/// `None` if the material lacks a required value.
pub fn puncture_units(case: &Case) -> Option<[f64; 3]> {
    let (length, force) =
        (Quantity::Length.physical(1.0, case)?, Quantity::Force.physical(1.0, case)?);
    // Energies are over `E_s/(1 − ν²) t³`, forces over `E_s/(1 − ν²) L t`.
    Some([length, force, force / case.design.length * length])
}

/// Returns the units of curvature, moment and energy of bending, in 1/mm, N mm and mJ.
///
/// `None` if the material lacks a required value.
pub fn bending_units(case: &Case) -> Option<[f64; 3]> {
    // Energies of bending are over `E_m t³`, moments over `E_m I_m/t`.
    let (length, modulus) =
        (Quantity::Length.physical(1.0, case)?, case.material.membrane_modulus_mpa?);
    Some([length.recip(), Quantity::Moment.physical(1.0, case)?, modulus * length.powi(3)])
}

/// Returns the unit of puncture forces, `E_s/(1 − ν²) L t`, in N.
fn force_unit(case: &Case) -> Option<f64> {
    let (thickness, modulus) = (case.material.thickness_mm?, case.material.substrate_modulus_mpa?);
    let plane_strain = modulus / (1.0 - case.puncture.poisson_ratio.powi(2));
    Some(plane_strain * case.design.length * thickness * thickness)
}

/// Returns the bending stiffness `E_m I_m` of the membrane, in N mm².
fn bending_stiffness(case: &Case) -> Option<f64> {
    let (thickness, modulus) = (case.material.thickness_mm?, case.material.membrane_modulus_mpa?);
    let (width, height) = (case.design.width, case.flexure.membrane_thickness);
    // The second moment of area has four lengths over `t`, so multiply it by `t⁴`.
    Some(modulus * width * height.powi(3) / 12.0 * thickness.powi(4))
}

/// Material keys required for the areal mass.
pub(crate) const MASS_NEEDS: [&str; 2] = [key::THICKNESS, key::DENSITY];

/// Returns the mass of the scales per area of the skin, in kg/m².
///
/// The mass is the density times the area of a parallelogram (base times thickness), divided by the
/// pitch: `ρ 2a t/p` (U8). `None` if thickness or density is not given.
pub fn areal_mass(case: &Case) -> Option<f64> {
    let (thickness, density) = (case.material.thickness_mm?, case.material.scale_density_kg_m3?);
    let base = 2.0 * Design::half_base(&case.design);
    // 1 kg/m³ times 1 mm is 1e-3 kg/m².
    Some(density * base / (base + case.design.gap) * thickness * 1e-3)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sweep::Material;

    use super::*;

    fn case() -> Case {
        let mut case = Case::default();
        case.design.gap = 0.1;
        case.design.length = 0.5;
        case.design.width = 2.0;
        case.flexure.membrane_thickness = 0.25;
        case.material = Material {
            thickness_mm: Some(2.0),
            substrate_modulus_mpa: Some(0.3),
            membrane_modulus_mpa: Some(4.5),
            scale_modulus_mpa: Some(3000.0),
            scale_density_kg_m3: Some(1200.0),
            ..Material::default()
        };
        case
    }

    #[track_caller]
    fn close(found: Option<f64>, expected: f64) {
        let found = found.expect("a value");
        assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} {expected}");
    }

    #[test]
    fn quantities_agree_with_hand_calculations() {
        let case = case();
        close(Quantity::Length.physical(0.3, &case), 0.6);
        // 3 · 0.3/(1 − 0.25) · 0.5 · 4 = 2.4 N, on a width of 4 mm.
        close(Quantity::Force.physical(3.0, &case), 2.4);
        close(Quantity::ForcePerWidth.physical(3.0, &case), 0.6);
        close(Quantity::Stiffness.physical(5.0, &case), 3.0);
        // b = 4 mm, h = 0.5 mm: I = 4 · 0.125/12 = 1/24 mm⁴, E I = 0.1875 N mm².
        close(Quantity::Moment.physical(2.0, &case), 0.1875);
        close(Quantity::Rigidity.physical(0.5, &case), 0.375);
        close(Quantity::Radius.physical(0.25, &case), 8.0);
        close(Quantity::Stress.physical(20.0, &case), 6.0);
        close(Quantity::Pressure.physical(0.1, &case), 30.0);
        // 1200 kg/m³ · 0.5/0.6 · 0.002 m.
        close(areal_mass(&case), 2.0);
    }

    #[test]
    fn missing_material_gives_no_value() {
        let bare = Case { material: Material::default(), ..case() };
        assert!(Quantity::ALL.iter().all(|quantity| quantity.physical(1.0, &bare).is_none()));
        assert_eq!(areal_mass(&bare), None);
        assert_eq!(Quantity::Radius.physical(0.0, &case()), None);
    }

    proptest! {
        /// A change of units rescales every quantity by its dimension.
        #[test]
        fn quantities_scale_with_their_dimensions(
            length in 0.01_f64..100.0, force in 0.01_f64..100.0, value in 0.01_f64..100.0,
        ) {
            let mut other = case();
            let stress = |modulus: Option<f64>| modulus.map(|modulus| modulus * force / (length * length));
            let material = case().material;
            other.material = Material {
                thickness_mm: material.thickness_mm.map(|thickness| thickness * length),
                substrate_modulus_mpa: stress(material.substrate_modulus_mpa),
                membrane_modulus_mpa: stress(material.membrane_modulus_mpa),
                scale_modulus_mpa: stress(material.scale_modulus_mpa),
                scale_strength_mpa: None,
                bond_strength_mpa: None,
                scale_density_kg_m3: material.scale_density_kg_m3,
            };
            let dimensions = [
                length, force, force / length, force / length, force * length,
                force * length * length, length, force / (length * length),
                force / (length * length),
            ];
            for (quantity, dimension) in Quantity::ALL.into_iter().zip(dimensions) {
                let values = [case(), other].map(|case| quantity.physical(value, &case).expect("a value"));
                prop_assert!((values[1] / values[0] / dimension - 1.0).abs() < 1e-12, "{quantity:?}");
            }
            let masses = [case(), other].map(|case| areal_mass(&case).expect("a mass"));
            prop_assert!((masses[1] / masses[0] / length - 1.0).abs() < 1e-12);
        }
    }
}

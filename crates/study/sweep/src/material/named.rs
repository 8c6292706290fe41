//! Table of named materials.
//!
//! `docs/materials.md` shows the same values with their ranges and sources; a test compares both.

use crate::parameter::key;

/// A named material, and the values that it supplies to `[material]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedMaterial {
    /// Name in a definition.
    pub name: &'static str,
    /// Keys of `[material]` with the supplied values.
    pub values: &'static [(&'static str, f64)],
}

/// Lists scales as `name: modulus, strength in MPa, density in kg/m³`.
macro_rules! scales {
    ($($name:literal: $modulus:literal, $strength:literal, $density:literal;)*) => {
        &[$(NamedMaterial {
            name: $name,
            values: &[
                (key::SCALE_MODULUS, $modulus),
                (key::SCALE_STRENGTH, $strength),
                (key::DENSITY, $density),
            ],
        }),*]
    };
}

/// Materials of scales.
pub const SCALE_MATERIALS: &[NamedMaterial] = scales! {
    "PLA": 3000.0, 50.0, 1250.0;
    "PETG": 2000.0, 45.0, 1270.0;
    "ABS": 2400.0, 33.0, 1040.0;
    "nylon": 1650.0, 46.0, 930.0;
    "resin": 2500.0, 50.0, 1180.0;
    "TPU": 60.0, 25.0, 1220.0;
    "alumina": 416_000.0, 380.0, 3980.0;
    "glass": 70_000.0, 45.0, 2500.0;
    "bone": 15_000.0, 150.0, 1900.0;
    "fish scale": 750.0, 40.0, 1300.0;
};

/// Materials of the substrate.
///
/// Living tissue has no bond strength: it depends on the adhesive.
pub const TISSUE_MATERIALS: &[NamedMaterial] = &[
    NamedMaterial {
        name: "silicone",
        values: &[(key::SUBSTRATE_MODULUS, 0.3), (key::BOND_STRENGTH, 0.1)],
    },
    NamedMaterial {
        name: "polyurethane",
        values: &[(key::SUBSTRATE_MODULUS, 0.31), (key::BOND_STRENGTH, 0.3)],
    },
    NamedMaterial {
        name: "foam",
        values: &[(key::SUBSTRATE_MODULUS, 0.1), (key::BOND_STRENGTH, 0.05)],
    },
    NamedMaterial { name: "skin", values: &[(key::SUBSTRATE_MODULUS, 0.1)] },
    NamedMaterial { name: "muscle", values: &[(key::SUBSTRATE_MODULUS, 0.015)] },
];

/// Keys of `[material]` that name a material, with the known materials.
pub(crate) const NAMES: [(&str, &[NamedMaterial]); 2] =
    [("scale", SCALE_MATERIALS), ("tissue", TISSUE_MATERIALS)];

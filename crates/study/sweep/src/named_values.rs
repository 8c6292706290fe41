//! Tables of named materials and bodies.
//!
//! `docs/materials.md` and `docs/bodies.md` list the same values with their sources. Tests compare
//! these documents with the tables.

use crate::parameter::key;

/// A named material or body, and the values that it supplies to a definition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedValues {
    /// Name in a definition.
    pub name: &'static str,
    /// Keys of parameters, each with the supplied value.
    pub values: &'static [(&'static str, f64)],
}

/// Creates a table of scale materials from lines with the name, and modulus, strength and density.
///
/// Modulus and strength are in `MPa`, the density is in kg/m³.
macro_rules! scales {
    ($($name:literal: $modulus:literal, $strength:literal, $density:literal;)*) => {
        &[$(NamedValues {
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
pub const SCALE_MATERIALS: &[NamedValues] = scales! {
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
/// Living tissue has no bond strength in this table, because its strength depends on the adhesive.
pub const TISSUE_MATERIALS: &[NamedValues] = &[
    NamedValues {
        name: "silicone",
        values: &[(key::SUBSTRATE_MODULUS, 0.3), (key::BOND_STRENGTH, 0.1)],
    },
    NamedValues {
        name: "polyurethane",
        values: &[(key::SUBSTRATE_MODULUS, 0.31), (key::BOND_STRENGTH, 0.3)],
    },
    NamedValues {
        name: "foam",
        values: &[(key::SUBSTRATE_MODULUS, 0.1), (key::BOND_STRENGTH, 0.05)],
    },
    NamedValues { name: "skin", values: &[(key::SUBSTRATE_MODULUS, 0.1)] },
    NamedValues { name: "muscle", values: &[(key::SUBSTRATE_MODULUS, 0.015)] },
];

/// Creates a table of bodies from lines with the name, and radius and tissue thickness in mm.
macro_rules! bodies {
    ($($name:literal: $radius:literal, $tissue:literal;)*) => {
        &[$(NamedValues {
            name: $name,
            values: &[(key::RADIUS_MM, $radius), (key::TISSUE_MM, $tissue)],
        }),*]
    };
}

/// Bodies below a skin, with their radius and thickness of tissue.
pub const BODIES: &[NamedValues] = bodies! {
    "finger": 10.0, 5.0;
    "forearm": 45.0, 20.0;
    "thigh": 99.0, 40.0;
    "torso": 145.0, 30.0;
};

/// A key with a name as its value, such as `material.scale = "PLA"`.
pub(crate) struct NameKey {
    /// Section of the key.
    pub section: &'static str,
    /// Key within its section.
    pub key: &'static str,
    /// Known names with their values.
    pub known: &'static [NamedValues],
}

impl NameKey {
    /// Returns the known name that equals `name`, in upper or lower case, with its values.
    pub fn find(&self, name: &str) -> Option<&'static NamedValues> {
        self.known.iter().find(|known| known.name.eq_ignore_ascii_case(name))
    }
}

/// Keys with names of materials or bodies as their values.
///
/// The first key of a section may also be given as the value of the whole section. An example is
/// `material = "PLA"`.
pub(crate) const NAME_KEYS: [NameKey; 3] = [
    NameKey { section: "material", key: "scale", known: SCALE_MATERIALS },
    NameKey { section: "material", key: "tissue", known: TISSUE_MATERIALS },
    NameKey { section: "body", key: "name", known: BODIES },
];

/// Returns the key that a name as the value of a whole section sets, as in `material = "PLA"`.
///
/// `None` if a name cannot be the value of the section.
pub(crate) fn short_name_key(section: &str) -> Option<&'static NameKey> {
    NAME_KEYS.iter().find(|name| name.section == section)
}

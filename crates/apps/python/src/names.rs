//! Keywords that name the materials of a skin or the body below it.

use sweep::{BODIES, NamedValues, SCALE_MATERIALS, TISSUE_MATERIALS};

/// A keyword that names a material or body.
pub struct Name {
    pub keyword: &'static str,
    /// Section of the key in a definition.
    pub section: &'static str,
    /// Key in a definition.
    pub key: &'static str,
    /// Possible names, with the values that they supply.
    pub known: &'static [NamedValues],
}

pub const NAMES: [Name; 3] = [
    Name { keyword: "scale", section: "material", key: "scale", known: SCALE_MATERIALS },
    Name { keyword: "tissue", section: "material", key: "tissue", known: TISSUE_MATERIALS },
    Name { keyword: "body", section: "body", key: "name", known: BODIES },
];
